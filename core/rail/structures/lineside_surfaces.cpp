#include "core/rail/structures/lineside_surfaces.h"

#include <string_view>

#include "core/base/attempt.h"

namespace railcast {
namespace {

struct LinesideRow {
  SurfaceClass LinesideSurfaces::*surface;
  std::string_view material;
  std::string_view label;
};

constexpr LinesideRow kLinesideRows[] = {
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

}  // namespace

LinesideSurfaces::LinesideSurfaces(const LabelTable& labels, const MaterialLibrary& materials) {
  ErrorList errors;
  for (const LinesideRow& row : kLinesideRows) {
    const auto index = Attempt("", errors, [&] { return materials.Index(row.material); });
    const auto id = Attempt("", errors, [&] { return labels.Id(row.label); });
    this->*row.surface = SurfaceClass{index.value_or(0), id.value_or(0)};
  }
  errors.ThrowIfAny();
}

}  // namespace railcast
