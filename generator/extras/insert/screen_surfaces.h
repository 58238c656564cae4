#pragma once

#include <cstdint>
#include <vector>

#include "generator/extras/insert/screens.h"
#include "railcast/effects.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Materials of screens: Lambertian ones, whose reflectivities rise by 2 % each.
inline constexpr std::size_t kNumScreenMaterials = 1024;
/// Appends the materials of screens.
[[nodiscard]] std::vector<Material> WithScreenMaterials(std::vector<Material> materials);

/// The least intensity of a detectable echo in clear air; 0 if everything is detected.
[[nodiscard]] float LeastIntensity(const DetectorSpec& detector, float range_m);

/// A frame's surfaces, those of screens last.
struct ScreenSurfaces {
  std::vector<Surface> all;
  std::uint32_t first{};     ///< Index of the first screen.
  std::vector<float> alone;  ///< By screen, the intensity of its echo if nothing is beside it.
};

/// The recorded returns of some of a frame's firings.
struct FewReturns {
  std::vector<std::uint32_t> firings;  ///< In ascending order.
  std::vector<std::uint32_t> first;    ///< As of Screens; all others have none.
  std::vector<Screen> returns{};
};

/// Makes screens of recorded returns, and surfaces for them.
/// @param first_material The index of the first material of screens.
[[nodiscard]] Screens MakeScreens(const DetectorSpec& detector,
                                  FewReturns few,
                                  std::uint16_t first_material,
                                  ScreenSurfaces& surfaces);

}  // namespace railcast
