#include "generator/extras/insert/screen_surfaces.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "core/detect/base/beam_optics.h"
#include "core/detect/beam/footprint.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

constexpr double kDarkest = 1e-6;
constexpr double kLogStep = 0.02;
// A screen that the model takes to be too weak is lifted to the threshold, and so much above it.
constexpr float kLift = 1.0001F;
// Rays meet screens so many standard deviations of the range noise behind where they were recorded.
constexpr float kBackBySigmas = 2.0F;
std::size_t LevelOf(float intensity) {
  const double level = std::log(std::max(static_cast<double>(intensity), kDarkest) / kDarkest);
  return std::min(static_cast<std::size_t>(level / kLogStep + 0.5), kNumScreenMaterials - 1);
}

double IntensityOfLevel(std::size_t level) {
  return kDarkest * std::exp(kLogStep * static_cast<double>(level));
}

float RangeNoise_m(const DetectorSpec& detector, const Screen& screen) {
  if (detector.effects.noise) {
    const PlausibilitySpec& model = detector.plausibility;
    return static_cast<float>(model.noise_sigma0_m) +
           static_cast<float>(model.noise_sigma1) * screen.range_m;
  }
  if (!detector.effects.range_noise) return 0.0F;
  const ReceiverSpec& receiver = detector.receiver;
  const float ratio = screen.intensity / LeastIntensity(detector, screen.range_m);
  const float snr = static_cast<float>(receiver.snr_at_threshold) * std::max(ratio, 1.0F);
  return std::hypot(static_cast<float>(receiver.range_noise_floor_m),
                    static_cast<float>(receiver.range_noise_scale_m) / std::sqrt(2.0F * snr));
}

}  // namespace

std::vector<Material> WithScreenMaterials(std::vector<Material> materials) {
  for (std::size_t level = 0; level < kNumScreenMaterials; ++level) {
    materials.push_back(
        {.name = "recorded " + std::to_string(level), .reflectivity = IntensityOfLevel(level)});
  }
  return materials;
}

float LeastIntensity(const DetectorSpec& detector, float range_m) {
  double per_m2 = 0.0;
  if (detector.effects.threshold) {
    const PlausibilitySpec& model = detector.plausibility;
    per_m2 = model.reference_threshold / (model.reference_range_m * model.reference_range_m);
  } else if (detector.effects.detection) {
    per_m2 = LeastPower(detector.receiver);
  }
  return static_cast<float>(per_m2) * range_m * range_m;
}

Screens MakeScreens(const DetectorSpec& detector,
                    FewReturns few,
                    std::uint16_t first_material,
                    ScreenSurfaces& surfaces) {
  auto& [firings, first, returns] = few;
  const bool has_footprint = HasFootprint(detector);
  const bool is_physical = IsPhysical(detector.effects);
  // What lies outside the gate was returned all the same.
  const auto nearest_m = static_cast<float>(detector.range_min_m * 1.0001);
  const auto farthest_m = static_cast<float>(detector.range_max_m * 0.9999);
  surfaces.first = static_cast<std::uint32_t>(surfaces.all.size());
  for (const std::uint32_t firing : firings) {
    const std::span<Screen> of(returns.data() + first[firing], first[firing + 1] - first[firing]);
    if (of.empty()) continue;
    for (Screen& screen : of) {
      screen.range_m = std::clamp(screen.range_m, nearest_m, farthest_m);
      // Noise may have helped it.
      const float least_share =
          detector.effects.detection_probability && screen.is_power_known ? 0.0F : kLift;
      screen.intensity = std::max({screen.intensity, static_cast<float>(kDarkest),
                                   least_share * LeastIntensity(detector, screen.range_m)});
      screen.back_m = kBackBySigmas * RangeNoise_m(detector, screen);
    }
    const ScreenParts parts = PartsOf(of);
    for (std::size_t k = 0; k < of.size(); ++k) {
      const float share =
          has_footprint ? static_cast<float>(parts[k]) / static_cast<float>(kScreenParts) : 1.0F;
      const std::size_t level = LevelOf(of[k].intensity / share);
      of[k].surface = static_cast<std::uint32_t>(surfaces.all.size());
      surfaces.alone.push_back(is_physical ? share * static_cast<float>(IntensityOfLevel(level))
                                           : of[k].intensity);
      surfaces.all.push_back({.reflectivity = of[k].intensity / share,
                              .material = static_cast<std::uint16_t>(first_material + level)});
    }
  }
  return {std::move(first), std::move(returns)};
}

}  // namespace railcast
