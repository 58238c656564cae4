#include "analysis/fit/truth_trials.h"

#include <cmath>

#include "analysis/fit/truth_stretch.h"

namespace railcast {
namespace {

constexpr double kGateMargin_m = 1.0;
// Of a surface whose beam also meets others.
constexpr float kWholeBeam = 0.999F;
// Nearer to grazing the truth's float32 angle gives no cosine.
constexpr double kMinCosine = 0.01;

}  // namespace

bool HasTruth(const RecordedFrame& frame) {
  return frame.Has("true_range_m") && frame.Has("incidence_rad") &&
         (frame.Has("material") || frame.Has("label"));
}

void ForEachTruthTrial(const RecordedFrame& recorded,
                       const SensorFacts& facts,
                       const TrialTaker& take) {
  const Frame& frame = recorded.frame;
  const TruthStretch stretch(facts.beam, facts.scan);
  const bool has_materials = recorded.Has("material");
  const bool has_outcomes = recorded.Has("outcome");
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    const double expected_m = static_cast<double>(frame.true_range_m[slot]);
    const double cosine = std::cos(static_cast<double>(frame.incidence_rad[slot]));
    const std::uint32_t surface = has_materials ? frame.material[slot] : frame.label[slot];
    // NaN is within nothing.
    const bool is_within = expected_m > facts.range_min_m + kGateMargin_m &&
                           expected_m < facts.range_max_m - kGateMargin_m && cosine > kMinCosine;
    if (!is_within || surface == 0 || surface > 0xFFFFU) continue;
    if (has_outcomes &&
        (frame.outcome[slot] == Outcome::kEgo || frame.outcome[slot] == Outcome::kClutter)) {
      continue;
    }
    if (recorded.Has("footprint_share") && frame.footprint_share[slot] < kWholeBeam) continue;
    Trial trial;
    trial.expected_m = static_cast<float>(expected_m);
    trial.cos_incidence = static_cast<float>(cosine);
    trial.stretch = static_cast<float>(stretch.At(frame, slot));
    trial.surface = static_cast<std::uint16_t>(surface);
    trial.channel = frame.ring[slot];
    if (!std::isnan(frame.range_m[slot])) {
      trial.answer = Answer::kReturned;
      trial.residual_m = frame.range_m[slot] - frame.true_range_m[slot];
      trial.intensity = frame.intensity[slot];
    }
    take(trial, slot);
  }
}

}  // namespace railcast
