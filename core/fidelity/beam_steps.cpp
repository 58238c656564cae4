#include "core/fidelity/beam_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/base/beam_optics.h"

namespace railcast {
namespace {

constexpr double kShortPulse_ns = 0.2;
constexpr int kMostSubRays = 256;

struct PartOfBeam {
  float range_m{};
  float spread_m{};  // Standard deviation of the range, were the whole beam on its plane.
};

float LargestStep_m(const StepLimits& limits, std::vector<PartOfBeam>& parts) {
  std::ranges::sort(parts, {}, &PartOfBeam::range_m);
  float largest_m = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    const float step_m = parts[i + 1].range_m - parts[i].range_m;
    const float spread_m = std::max(parts[i].spread_m, parts[i + 1].spread_m);
    const bool is_step = step_m >= limits.least_m && step_m <= limits.most_m &&
                         step_m > limits.least_spreads * spread_m;
    if (is_step && !(largest_m >= step_m)) largest_m = step_m;
  }
  return largest_m;
}

}  // namespace

SimulatorSpec ShowParts(SimulatorSpec spec) {
  const EffectSet& own = spec.detector.effects;
  spec.detector.effects = EffectSet{.surface_response = own.surface_response,
                                    .pulse_stretch = true,
                                    .pointing_jitter = own.pointing_jitter,
                                    .footprint = own.footprint,
                                    .thin_conductors = own.thin_conductors,
                                    .dense_footprint = own.dense_footprint};
  BeamSpec& beam = spec.detector.beam;
  beam.pulse_length_ns = kShortPulse_ns;
  beam.reference_rays = std::min(beam.reference_rays, kMostSubRays);
  spec.detector.receiver.return_mode = ReturnMode::kTriple;
  return spec;
}

std::vector<float> StepsOf(const Frame& parts, const BeamSpec& beam, const StepLimits& limits) {
  const auto sigma_rad =
      static_cast<float>(std::max(HorizontalSigma_rad(beam), VerticalSigma_rad(beam)));
  std::vector<float> steps_m(parts.num_slots() / parts.returns);
  std::vector<PartOfBeam> of_beam;
  for (std::size_t firing = 0; firing < steps_m.size(); ++firing) {
    of_beam.clear();
    for (std::size_t r = 0; r < parts.returns; ++r) {
      const std::size_t slot = firing * parts.returns + r;
      // Without a beam's width there are no shares.
      const bool is_part =
          HasPoint(parts.outcome[slot]) && parts.footprint_share[slot] >= limits.least_share;
      if (!is_part) continue;
      const float range_m = parts.true_range_m[slot];
      of_beam.push_back({range_m, range_m * sigma_rad * std::tan(parts.incidence_rad[slot])});
    }
    steps_m[firing] = LargestStep_m(limits, of_beam);
  }
  return steps_m;
}

}  // namespace railcast
