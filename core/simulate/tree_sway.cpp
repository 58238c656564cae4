#include "core/simulate/tree_sway.h"

#include <cmath>

#include "core/base/random.h"

namespace railcast {

double TreeFrequency_hz(double height_m) {
  constexpr double kDiameter_cm_per_m = 2.2;
  return 0.0766 + 3.1219 * kDiameter_cm_per_m / height_m;
}

double MeanTreeTip_m(double wind_mps, double height_m) {
  constexpr double kLeanAt10mps = 0.015;
  return kLeanAt10mps * height_m * std::pow(wind_mps / 10.0, kTreeDragExponent);
}

Vector3 TreeTip_m(const Wind& wind, const TreeInWind& tree, double time_s) {
  const double frequency_hz = TreeFrequency_hz(tree.height_m);
  const double resonance = wind.Resonance(frequency_hz, kTreeDamping, 0.0);
  const auto ringing = [&](std::uint32_t block) {
    const auto words =
        RandomWords(wind.seed(), RandomUse::kTreeSway, tree.chunk, tree.number, block);
    return Ringing(words, frequency_hz, kTreeDamping, time_s);
  };
  const double gust = std::sqrt(Wind::kSlowShare) * wind.Gust(tree.foot_world_m, time_s);
  const double along =
      1.0 + kTreeDragExponent * Wind::kTurbulence * (gust + std::sqrt(resonance) * ringing(0));
  const double across =
      kAcrossGusts * Wind::kTurbulence * std::sqrt(Wind::kSlowShare + resonance) * ringing(1);
  return MeanTreeTip_m(wind.speed_mps(), tree.height_m) *
         (along * wind.downwind() + across * Vector3::UnitZ().cross(wind.downwind()));
}

}  // namespace railcast
