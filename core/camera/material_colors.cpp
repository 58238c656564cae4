#include "core/camera/material_colors.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace railcast {
namespace {

struct NamedColor {
  std::string_view material;
  double red, green, blue;
};

// Reflectances in daylight, chosen by eye: plausible, not measured.
constexpr auto kColors = std::to_array<NamedColor>({{"rail_head", 0.45, 0.45, 0.46},
                                                    {"rail_side", 0.16, 0.10, 0.07},
                                                    {"rusty_steel", 0.20, 0.10, 0.06},
                                                    {"concrete", 0.36, 0.35, 0.32},
                                                    {"wood", 0.15, 0.11, 0.08},
                                                    {"ballast", 0.21, 0.19, 0.17},
                                                    {"soil", 0.17, 0.12, 0.08},
                                                    {"grass", 0.16, 0.24, 0.07},
                                                    {"leaf", 0.10, 0.18, 0.05},
                                                    {"bark", 0.12, 0.09, 0.07},
                                                    {"copper_wire", 0.28, 0.16, 0.10},
                                                    {"bronze_wire", 0.25, 0.18, 0.10},
                                                    {"galvanised_steel", 0.42, 0.43, 0.44},
                                                    {"ceramic", 0.30, 0.16, 0.10},
                                                    {"wagon_paint", 0.24, 0.08, 0.05},
                                                    {"wheel_steel", 0.22, 0.20, 0.19},
                                                    {"tank_paint", 0.58, 0.58, 0.56},
                                                    {"skin", 0.45, 0.28, 0.20},
                                                    {"clothing", 0.06, 0.09, 0.18},
                                                    {"grey_paint", 0.30, 0.30, 0.30},
                                                    {"asphalt", 0.09, 0.09, 0.09},
                                                    {"glass", 0.05, 0.06, 0.06},
                                                    {"white_paint", 0.80, 0.80, 0.78},
                                                    {"black_rubber", 0.03, 0.03, 0.03},
                                                    {"snow", 0.90, 0.91, 0.93},
                                                    {"retro_sheeting", 0.60, 0.60, 0.60},
                                                    {"hi_vis_vest", 0.90, 0.30, 0.03},
                                                    {"hi_vis_fabric", 0.95, 0.32, 0.02},
                                                    {"hi_vis_band", 0.60, 0.60, 0.60},
                                                    {"masonry", 0.55, 0.48, 0.38},
                                                    {"red_paint", 0.55, 0.05, 0.04},
                                                    {"plastic", 0.65, 0.50, 0.10},
                                                    {"black_paint", 0.03, 0.03, 0.03},
                                                    {"roof_tile", 0.35, 0.13, 0.08},
                                                    {"car_paint", 0.10, 0.15, 0.35},
                                                    {"fur", 0.22, 0.12, 0.06},
                                                    {"horn", 0.20, 0.16, 0.12}});

}  // namespace

std::vector<Vector3> MaterialColors(const MaterialLibrary& materials) {
  std::vector<Vector3> colors;
  for (const Material& material : materials.materials()) {
    const auto named = std::ranges::find(kColors, material.name, &NamedColor::material);
    colors.push_back(named != kColors.end()
                         ? Vector3(named->red, named->green, named->blue)
                         : Vector3::Constant(std::min(1.0, material.reflectivity)));
  }
  return colors;
}

}  // namespace railcast
