#include "core/rail/rail_surfaces.h"

#include <algorithm>

#include "core/base/attempt.h"

namespace railcast {
namespace {

struct SurfaceRow {
  SurfaceClass RailSurfaces::*surface;
  std::string_view material;
  std::string_view label;
};

constexpr SurfaceRow kSurfaceRows[] = {
    {&RailSurfaces::rail_head, "rail_head", "rail"},
    {&RailSurfaces::rail_side, "rail_side", "rail"},
    {&RailSurfaces::fastening, "rusty_steel", "sleeper"},
    {&RailSurfaces::sleeper_concrete, "concrete", "sleeper"},
    {&RailSurfaces::sleeper_wood, "wood", "sleeper"},
    {&RailSurfaces::ballast, "ballast", "ballast"},
    {&RailSurfaces::ground, "soil", "ground"},
    {&RailSurfaces::grass, "grass", "grass"},
    {&RailSurfaces::leaf, "leaf", "tree"},
    {&RailSurfaces::bark, "bark", "tree"},
    {&RailSurfaces::contact_wire, "copper_wire", "contact_wire"},
    {&RailSurfaces::messenger_wire, "bronze_wire", "messenger_wire"},
    {&RailSurfaces::dropper, "bronze_wire", "dropper"},
    {&RailSurfaces::mast, "galvanised_steel", "mast"},
    {&RailSurfaces::cantilever, "galvanised_steel", "cantilever"},
    {&RailSurfaces::insulator, "ceramic", "cantilever"},
    {&RailSurfaces::wagon_body, "wagon_paint", "wagon"},
    {&RailSurfaces::wagon_frame, "rusty_steel", "wagon"},
    {&RailSurfaces::wheel, "wheel_steel", "wagon"},
    {&RailSurfaces::tank, "tank_paint", "wagon"},
    {&RailSurfaces::skin, "skin", "person"},
    {&RailSurfaces::clothing, "clothing", "person"},
    {&RailSurfaces::pole, "galvanised_steel", "pole"},
    {&RailSurfaces::box, "grey_paint", "object"},
};

}  // namespace

RailSurfaces::RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  ErrorList errors;
  for (const SurfaceRow& row : kSurfaceRows) {
    const auto index = Attempt("", errors, [&] { return materials.Index(row.material); });
    const auto id = Attempt("", errors, [&] { return labels.Id(row.label); });
    this->*row.surface = SurfaceClass{index.value_or(0), id.value_or(0)};
  }
  errors.ThrowIfAny();
}

bool IsRailMaterial(std::string_view name) {
  return std::any_of(std::begin(kSurfaceRows), std::end(kSurfaceRows),
                     [&](const SurfaceRow& row) { return row.material == name; });
}

}  // namespace railcast
