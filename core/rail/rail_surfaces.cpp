#include "core/rail/rail_surfaces.h"

#include <string_view>

#include "core/base/attempt.h"

namespace railcast {
RailSurfaces::RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  ErrorList errors;
  const auto surface = [&](std::string_view material, std::string_view label) {
    const auto index = Attempt("", errors, [&] { return materials.Index(material); });
    const auto id = Attempt("", errors, [&] { return labels.Id(label); });
    return SurfaceClass{index.value_or(0), id.value_or(0)};
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
  errors.ThrowIfAny();
}

}  // namespace railcast
