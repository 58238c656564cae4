#include "core/rail/base/rail_surfaces.h"

#include <algorithm>

#include "core/base/error.h"

namespace railcast {
namespace {

/// @tparam Surfaces The struct that has the surface.
template <class Surfaces>
struct SurfaceRow {
  SurfaceClass Surfaces::*surface;
  std::string_view material;
  std::string_view label;
};

constexpr SurfaceRow<RailSurfaces> kSurfaceRows[] = {
    {&RailSurfaces::rail_head, "rail_head", "rail"},
    {&RailSurfaces::rail_side, "rail_side", "rail"},
    {&RailSurfaces::fastening, "rusty_steel", "sleeper"},
    {&RailSurfaces::sleeper_concrete, "concrete", "sleeper"},
    {&RailSurfaces::sleeper_wood, "wood", "sleeper"},
    {&RailSurfaces::ballast, "ballast", "ballast"},
    {&RailSurfaces::ground, "soil", "ground"},
    {&RailSurfaces::gravel, "ballast", "ground"},
    {&RailSurfaces::meadow, "grass", "ground"},
    {&RailSurfaces::grass, "grass", "grass"},
    {&RailSurfaces::leaf, "leaf", "tree"},
    {&RailSurfaces::bark, "bark", "tree"},
    {&RailSurfaces::contact_wire, "copper_wire", "contact_wire"},
    {&RailSurfaces::messenger_wire, "bronze_wire", "messenger_wire"},
    {&RailSurfaces::dropper, "bronze_wire", "dropper"},
    {&RailSurfaces::mast, "galvanised_steel", "mast"},
    {&RailSurfaces::cantilever, "galvanised_steel", "cantilever"},
    {&RailSurfaces::insulator, "ceramic", "cantilever"},
    {&RailSurfaces::skin, "skin", "person"},
    {&RailSurfaces::clothing, "clothing", "person"},
    {&RailSurfaces::pole, "galvanised_steel", "pole"},
    {&RailSurfaces::box, "grey_paint", "object"},
};

constexpr SurfaceRow<RailSurfaces> kBushRows[] = {
    {&RailSurfaces::bush_leaf, "leaf", "bush"},
    {&RailSurfaces::bush_bark, "bark", "bush"},
};

constexpr SurfaceRow<StructureSurfaces> kStructureRows[] = {
    {&StructureSurfaces::platform, "concrete", "platform"},
    {&StructureSurfaces::platform_strip, "white_paint", "platform"},
    {&StructureSurfaces::platform_roof, "grey_paint", "platform"},
    {&StructureSurfaces::noise_wall, "concrete", "noise_wall"},
    {&StructureSurfaces::noise_wall_post, "galvanised_steel", "noise_wall"},
    {&StructureSurfaces::fence, "galvanised_steel", "fence"},
    {&StructureSurfaces::retaining_wall, "masonry", "retaining_wall"},
    {&StructureSurfaces::cable_trough, "concrete", "cable_trough"},
    {&StructureSurfaces::tunnel, "concrete", "tunnel"},
    {&StructureSurfaces::tunnel_handrail, "galvanised_steel", "tunnel"},
    {&StructureSurfaces::bridge, "concrete", "bridge"},
    {&StructureSurfaces::bridge_railing, "galvanised_steel", "bridge"},
    {&StructureSurfaces::third_rail, "rail_side", "third_rail"},
    {&StructureSurfaces::third_rail_shield, "plastic", "third_rail"},
    {&StructureSurfaces::slab_track, "concrete", "slab_track"},
    {&StructureSurfaces::road, "asphalt", "road"},
};

constexpr SurfaceRow<LinesideSurfaces> kLinesideRows[] = {
    {&LinesideSurfaces::signal_mast, "galvanised_steel", "signal"},
    {&LinesideSurfaces::signal_foot, "concrete", "signal"},
    {&LinesideSurfaces::signal_screen, "black_paint", "signal"},
    {&LinesideSurfaces::signal_lamp, "glass", "signal"},
    {&LinesideSurfaces::signal_board, "retro_sheeting", "signal"},
    {&LinesideSurfaces::board_face, "retro_sheeting", "board"},
    {&LinesideSurfaces::board_steel, "galvanised_steel", "board"},
    {&LinesideSurfaces::marker_white, "white_paint", "board"},
    {&LinesideSurfaces::marker_red, "red_paint", "board"},
    {&LinesideSurfaces::balise, "plastic", "balise"},
    {&LinesideSurfaces::relay_box, "grey_paint", "relay_box"},
    {&LinesideSurfaces::relay_foot, "concrete", "relay_box"},
    {&LinesideSurfaces::buffer_frame, "rusty_steel", "buffer_stop"},
    {&LinesideSurfaces::buffer_beam, "red_paint", "buffer_stop"},
    {&LinesideSurfaces::buffer_board, "retro_sheeting", "buffer_stop"},
    {&LinesideSurfaces::derailer, "red_paint", "derailer"},
    {&LinesideSurfaces::derailer_machine, "rusty_steel", "derailer"},
    {&LinesideSurfaces::slab, "concrete", "road"},
    {&LinesideSurfaces::asphalt, "asphalt", "road"},
    {&LinesideSurfaces::barrier_white, "retro_sheeting", "level_crossing"},
    {&LinesideSurfaces::barrier_red, "red_paint", "level_crossing"},
    {&LinesideSurfaces::crossing_steel, "galvanised_steel", "level_crossing"},
    {&LinesideSurfaces::crossing_screen, "black_paint", "level_crossing"},
    {&LinesideSurfaces::crossing_lamp, "glass", "level_crossing"},
    {&LinesideSurfaces::wall, "masonry", "building"},
    {&LinesideSurfaces::flat_roof, "concrete", "building"},
    {&LinesideSurfaces::tiled_roof, "roof_tile", "building"},
    {&LinesideSurfaces::window, "glass", "building"},
    {&LinesideSurfaces::furniture_steel, "galvanised_steel", "furniture"},
    {&LinesideSurfaces::furniture_wood, "wood", "furniture"},
    {&LinesideSurfaces::furniture_glass, "glass", "furniture"},
};

constexpr SurfaceRow<TurnoutSurfaces> kTurnoutRows[] = {
    {&TurnoutSurfaces::running_band, "rail_head", "switch"},
    {&TurnoutSurfaces::rail, "rail_side", "switch"},
    {&TurnoutSurfaces::point_machine, "grey_paint", "point_machine"},
};

template <class Surfaces, std::size_t kCount>
void LookUp(const SurfaceRow<Surfaces> (&rows)[kCount],
            const LabelTable& labels,
            const MaterialLibrary& materials,
            Surfaces& surfaces,
            ErrorList& errors) {
  for (const SurfaceRow<Surfaces>& row : rows) {
    const auto index = Attempt("", errors, [&] { return materials.Index(row.material); });
    const auto id = Attempt("", errors, [&] { return labels.Id(row.label); });
    surfaces.*row.surface = SurfaceClass{index.value_or(0), id.value_or(0)};
  }
}

}  // namespace

Part& PartOf(const SurfaceClass& surface, Model& model) {
  const auto part =
      std::find_if(model.parts.begin(), model.parts.end(), [&](const Part& candidate) {
        return candidate.material == surface.material && candidate.label == surface.label;
      });
  if (part != model.parts.end()) return *part;
  model.parts.push_back({.mesh = {}, .material = surface.material, .label = surface.label});
  return model.parts.back();
}

void AppendModel(const Model& other, const Transform& model_from_other, Model& model) {
  for (const Part& part : other.parts) {
    MeshOf({part.material, part.label}, model).Append(part.mesh, model_from_other);
  }
}

RailSurfaces::RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  ErrorList errors;
  LookUp(kSurfaceRows, labels, materials, *this, errors);
  errors.ThrowIfAny();
}

void RailSurfaces::AddBushSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  ErrorList errors;
  LookUp(kBushRows, labels, materials, *this, errors);
  errors.ThrowIfAny();
}

void RailSurfaces::AddStructureSurfaces(const LabelTable& labels,
                                        const MaterialLibrary& materials) {
  ErrorList errors;
  LookUp(kStructureRows, labels, materials, structures, errors);
  LookUp(kLinesideRows, labels, materials, structures.lineside, errors);
  errors.ThrowIfAny();
}

void RailSurfaces::AddTurnoutSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  ErrorList errors;
  LookUp(kTurnoutRows, labels, materials, turnouts, errors);
  errors.ThrowIfAny();
}

bool IsRailMaterial(std::string_view name) {
  return std::any_of(std::begin(kSurfaceRows), std::end(kSurfaceRows),
                     [&](const auto& row) { return row.material == name; });
}

bool IsStructureMaterial(std::string_view name) {
  const auto is_of_it = [&](const auto& row) { return row.material == name; };
  return std::any_of(std::begin(kStructureRows), std::end(kStructureRows), is_of_it) ||
         std::any_of(std::begin(kLinesideRows), std::end(kLinesideRows), is_of_it);
}

}  // namespace railcast
