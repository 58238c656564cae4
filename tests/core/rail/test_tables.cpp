#include "tests/core/rail/test_tables.h"

#include <utility>
#include <vector>

namespace railcast {

LabelTable RailLabels() {
  std::vector<Label> labels;
  for (const char* name :
       {"rail",         "sleeper",        "ballast",        "ground",     "grass",
        "tree",         "contact_wire",   "messenger_wire", "dropper",    "mast",
        "cantilever",   "wagon",          "person",         "pole",       "object",
        "ego",          "platform",       "noise_wall",     "fence",      "retaining_wall",
        "cable_trough", "tunnel",         "bridge",         "third_rail", "slab_track",
        "signal",       "board",          "balise",         "relay_box",  "buffer_stop",
        "road",         "level_crossing", "building",       "derailer",   "furniture",
        "switch",       "point_machine",  "bush",           "train",      "road_vehicle",
        "animal"}) {
    Label label;
    label.id = static_cast<std::uint32_t>(labels.size() + 1);
    label.name = name;
    labels.push_back(label);
  }
  return LabelTable(std::move(labels));
}

MaterialLibrary RailMaterials() {
  std::vector<Material> materials;
  for (const char* name : {"rail_head",
                           "rail_side",
                           "rusty_steel",
                           "concrete",
                           "wood",
                           "ballast",
                           "soil",
                           "grass",
                           "leaf",
                           "bark",
                           "copper_wire",
                           "bronze_wire",
                           "galvanised_steel",
                           "ceramic",
                           "wagon_paint",
                           "wheel_steel",
                           "tank_paint",
                           "skin",
                           "clothing",
                           "grey_paint",
                           "white_paint",
                           "masonry",
                           "plastic",
                           "red_paint",
                           "black_paint",
                           "roof_tile",
                           "asphalt",
                           "glass",
                           "retro_sheeting",
                           "hi_vis_fabric",
                           "hi_vis_band",
                           "black_rubber",
                           "car_paint",
                           "fur",
                           "horn"}) {
    materials.push_back({name, 0.3});
  }
  return MaterialLibrary(materials);
}

RailSurfaces TestSurfaces() {
  RailSurfaces surfaces(RailLabels(), RailMaterials());
  surfaces.AddBushSurfaces(RailLabels(), RailMaterials());
  surfaces.AddStructureSurfaces(RailLabels(), RailMaterials());
  surfaces.AddTurnoutSurfaces(RailLabels(), RailMaterials());
  return surfaces;
}

}  // namespace railcast
