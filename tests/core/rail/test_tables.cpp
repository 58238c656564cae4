#include "tests/core/rail/test_tables.h"

#include <utility>
#include <vector>

namespace railcast {

LabelTable TestLabels() {
  std::vector<Label> labels;
  for (const char* name : {"rail",          "sleeper",     "ballast",      "ground",
                           "grass",         "tree",        "contact_wire", "messenger_wire",
                           "dropper",       "mast",        "cantilever",   "wagon",
                           "person",        "pole",        "object",       "ego",
                           "platform",      "noise_wall",  "fence",        "retaining_wall",
                           "cable_trough",  "tunnel",      "bridge",       "third_rail",
                           "slab_track",    "signal",      "board",        "balise",
                           "relay_box",     "buffer_stop", "road",         "level_crossing",
                           "building",      "derailer",    "furniture",    "switch",
                           "point_machine", "bush"}) {
    Label label;
    label.id = static_cast<std::uint32_t>(labels.size() + 1);
    label.name = name;
    labels.push_back(label);
  }
  return LabelTable(std::move(labels));
}

MaterialLibrary TestMaterials() {
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
                           "retro_sheeting"}) {
    materials.push_back({name, 0.3});
  }
  return MaterialLibrary(materials);
}

RailSurfaces TestSurfaces() {
  RailSurfaces surfaces(TestLabels(), TestMaterials());
  surfaces.AddBushSurfaces(TestLabels(), TestMaterials());
  surfaces.AddStructureSurfaces(TestLabels(), TestMaterials());
  surfaces.AddTurnoutSurfaces(TestLabels(), TestMaterials());
  return surfaces;
}

}  // namespace railcast
