#include "core/rail/rail_surfaces.h"

#include <string_view>

namespace railcast {

RailSurfaces::RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  const auto surface = [&](std::string_view material, std::string_view label) {
    return SurfaceClass{materials.Index(material), labels.Id(label)};
  };
  rail_head = surface("rail_head", "rail");
  rail_side = surface("rail_side", "rail");
  fastening = surface("rusty_steel", "sleeper");
  sleeper_concrete = surface("concrete", "sleeper");
  sleeper_wood = surface("wood", "sleeper");
  ballast = surface("ballast", "ballast");
  ground = surface("soil", "ground");
  grass = surface("grass", "grass");
  leaf = surface("leaf", "tree");
  bark = surface("bark", "tree");
  contact_wire = surface("copper_wire", "contact_wire");
  messenger_wire = surface("bronze_wire", "messenger_wire");
  dropper = surface("bronze_wire", "dropper");
  mast = surface("galvanised_steel", "mast");
  cantilever = surface("galvanised_steel", "cantilever");
  insulator = surface("ceramic", "cantilever");
  wagon_body = surface("wagon_paint", "wagon");
  wagon_frame = surface("rusty_steel", "wagon");
  wheel = surface("wheel_steel", "wagon");
  tank = surface("tank_paint", "wagon");
  skin = surface("skin", "person");
  clothing = surface("clothing", "person");
  pole = surface("galvanised_steel", "pole");
  box = surface("grey_paint", "object");
}

}  // namespace railcast
