#include "core/detect/clutter/interference.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/added_echo.h"

namespace railcast {

double ListeningTime_s(const DetectorSpec& spec) {
  return 2.0 * (spec.range_max_m - spec.range_min_m) / kSpeedOfLight_mps;
}

Interference::Interference(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec), uniforms_(kernels.uniforms) {
  if (!spec.effects.interference) return;
  if (spec.effects.saturation) {
    saturation_ = static_cast<float>(spec.receiver.saturation_power_ratio.value_or(0.0));
    pulse_sigma_m_ = static_cast<float>(PulseSigma_m(spec.beam));
  }
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
    AddedEcho echo{spec_.clutter_labels.false_alarm, EchoTiles::kForeignPulse, range_m, ratio,
                   ratio * power_min * range_m * range_m};
    if (saturation_ > 0.0F) {
      echo.power_ratio = std::min(ratio, saturation_);
      echo.busy_m = pulse_sigma_m_ * std::sqrt(2.0F * std::log(ratio));
    }
    AddMeasuredEcho(beam, echo, echoes);
  }
}

}  // namespace railcast
