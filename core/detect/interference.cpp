#include "core/detect/interference.h"

#include <cmath>

#include "core/base/random.h"
#include "core/detect/added_echo.h"
#include "core/detect/beam_optics.h"

namespace railcast {

double ListeningTime_s(const DetectorSpec& spec) {
  constexpr double kSpeedOfLight_mps = 299'792'458.0;
  return 2.0 * (spec.range_max_m - spec.range_min_m) / kSpeedOfLight_mps;
}

Interference::Interference(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec), uniforms_(kernels.uniforms) {
  if (!spec.effects.interference) return;
  probability_ =
      static_cast<float>(-std::expm1(-spec.receiver.foreign_pulses_hz * ListeningTime_s(spec)));
}

void Interference::AddEchoes(EchoTiles& echoes) const {
  if (!is_on()) return;
  const DetectTile& first = echoes.first;
  const auto power_min = static_cast<float>(LeastPower(spec_.receiver));
  alignas(64) float arrivals[kTileSize];
  uniforms_(first, {spec_.seed, RandomUse::kInterference, 0}, arrivals);
  for (std::size_t beam = 0; beam < first.num_rays; ++beam) {
    if (arrivals[beam] >= probability_) continue;
    const auto words =
        RandomWords(spec_.seed, RandomUse::kInterference, first.frame, first.firing[beam], 1);
    const auto range_m = static_cast<float>(
        std::lerp(spec_.range_min_m, spec_.range_max_m, static_cast<double>(UnitFloat(words[0]))));
    const float ratio = 1.0F / (1.0F - UnitFloat(words[1]));
    AddMeasuredEcho(beam,
                    {spec_.clutter_labels.false_alarm, EchoTiles::kForeignPulse, range_m, ratio,
                     ratio * power_min * range_m * range_m},
                    echoes);
  }
}

}  // namespace railcast
