#include "core/fidelity/frame_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/base/error.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

constexpr float kLeastThinShare = 0.02F;
constexpr float kLeastSecondShare = 0.05F;
constexpr float kLeastMixedShare = 1e-3F;  // Smaller shares may be rounding errors.
// The intensity of a white diffuse surface that faces the sensor.
constexpr float kWhite = 1.0F;

EchoPlace PlaceOf(const Frame& frame, std::size_t slot) {
  return {frame.true_range_m[slot], frame.label[slot], frame.instance[slot]};
}

// The nearest-rank quantile.
double Quantile(std::vector<float>& values, double q) {
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

ErrorQuantiles QuantilesOf(std::vector<float> errors) {
  if (errors.empty()) return {};
  return {Quantile(errors, 0.5), Quantile(errors, 0.95), Quantile(errors, 0.99)};
}

bool IsOneOf(const std::vector<std::uint32_t>& labels, std::uint32_t label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

double DropoutError(const decltype(FrameDifference::range_bins)& bins) {
  double sum = 0.0;
  int num_bins = 0;
  for (const FrameDifference::RangeBin& bin : bins) {
    if (bin.num_firings == 0) continue;
    const auto difference =
        static_cast<double>(bin.num_returned) - static_cast<double>(bin.num_reference_returned);
    sum += std::abs(difference) / static_cast<double>(bin.num_firings);
    ++num_bins;
  }
  return num_bins == 0 ? 0.0 : sum / num_bins;
}

}  // namespace

FiringEchoes::FiringEchoes(const Frame& frame, std::size_t firing) {
  for (std::size_t slot = firing * frame.returns; slot < (firing + 1) * frame.returns; ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    slots.push_back(slot);
    ranges_m.push_back(frame.range_m[slot]);
  }
}

bool IsSurfaceEcho(const Frame& frame, std::size_t slot) {
  return frame.outcome[slot] == Outcome::kReturned;
}

EffectSet YardstickEffects() {
  return WithoutRangeErrors(EffectsInRung(Fidelity::kReference));
}

EffectSet WithoutRangeErrors(EffectSet effects) {
  for (const Effect& effect : EffectTable()) {
    if (effect.is_measurement_error) effects.*effect.is_on = false;
  }
  return effects;
}

ComparisonSpec MakeComparisonSpec(const BeamSpec& beam,
                                  double range_max_m,
                                  const LabelTable& labels,
                                  const std::vector<SceneObject>& objects) {
  ComparisonSpec spec;
  spec.match_distance_m = static_cast<float>(0.5 * PulseLength_m(beam));
  spec.range_max_m = static_cast<float>(range_max_m);
  const auto add = [&](std::initializer_list<const char*> names, std::vector<std::uint32_t>& ids) {
    for (const char* name : names) {
      if (const Label* label = labels.Find(name)) ids.push_back(label->id);
    }
  };
  add({"contact_wire", "messenger_wire", "dropper"}, spec.thin_labels);
  add({"person"}, spec.person_labels);
  add({"pole", "mast", "signal"}, spec.pole_labels);
  spec.parts = MakeSceneParts(range_max_m, labels, spec.thin_labels, objects);
  return spec;
}

std::vector<std::pair<std::size_t, std::size_t>> MatchEchoes(const std::vector<float>& reference_m,
                                                             const std::vector<float>& other_m,
                                                             float match_distance_m) {
  std::vector<std::tuple<float, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < reference_m.size(); ++i) {
    for (std::size_t k = 0; k < other_m.size(); ++k) {
      const float distance_m = std::abs(reference_m[i] - other_m[k]);
      if (distance_m < match_distance_m) candidates.emplace_back(distance_m, i, k);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<std::pair<std::size_t, std::size_t>> matches;
  for (const auto& [distance_m, i, k] : candidates) {
    const bool is_taken = std::any_of(matches.begin(), matches.end(), [&](const auto& match) {
      return match.first == i || match.second == k;
    });
    if (!is_taken) matches.emplace_back(i, k);
  }
  return matches;
}

std::size_t TargetPoints::BinOf(float range_m) {
  return std::min(static_cast<std::size_t>(range_m / kBin_m), kNumBins - 1);
}

double TargetPoints::Error() const {
  double sum = 0.0;
  int num_bins = 0;
  for (const Bin& bin : bins) {
    if (bin.num_reference < kLeastPoints) continue;
    sum += std::abs(static_cast<double>(bin.num) / static_cast<double>(bin.num_reference) - 1.0);
    ++num_bins;
  }
  return num_bins == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / num_bins;
}

void FrameComparison::Add(const Frame& reference, const Frame& other) {
  const std::size_t num_firings = reference.num_slots() / reference.returns;
  Check(num_firings == other.num_slots() / other.returns, "both frames have the same firings");
  for (std::size_t i = 0; i < num_firings; ++i) AddFiring(reference, other, i);
  AddTargets(reference, other);
}

void FrameComparison::AddTargets(const Frame& reference, const Frame& other) {
  const auto count = [&](const Frame& frame, std::uint64_t TargetPoints::Bin::*num) {
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (!IsSurfaceEcho(frame, slot)) continue;
      const std::size_t bin = TargetPoints::BinOf(frame.true_range_m[slot]);
      if (IsOneOf(spec_.person_labels, frame.label[slot])) ++(sums_.persons.bins[bin].*num);
      if (IsOneOf(spec_.pole_labels, frame.label[slot])) ++(sums_.poles.bins[bin].*num);
    }
  };
  count(reference, &TargetPoints::Bin::num_reference);
  count(other, &TargetPoints::Bin::num);
}

void FrameComparison::AddEdges(const Frame& reference,
                               const std::vector<float>& reference_steps_m,
                               const Frame& other,
                               const std::vector<float>& other_steps_m) {
  for (std::size_t firing = 0; firing < reference_steps_m.size(); ++firing) {
    const bool has_step = !std::isnan(reference_steps_m[firing]);
    if (has_step) sums_.steps.Count(!std::isnan(other_steps_m[firing]));
    const std::size_t slot = firing * reference.returns;
    const std::size_t match = firing * other.returns;
    if (!IsSurfaceEcho(reference, slot)) continue;
    const bool is_found = IsSurfaceEcho(other, match);
    if (has_step && is_found) {
      step_errors_m_.push_back(std::abs(reference.range_m[slot] - other.range_m[match]));
    }
    const float expected = reference.intensity[slot];
    const bool is_edge = has_step || reference.mixed_share[slot] >= kLeastSecondShare;
    if (!is_edge || !(expected > kWhite)) continue;
    if (is_found && std::isnan(other.intensity[match])) continue;
    const float found = is_found ? other.intensity[match] : 0.0F;
    bright_errors_.push_back(std::abs(found - expected) / expected);
  }
}

bool FrameComparison::IsCompared(const Frame& frame, std::size_t slot) const {
  return IsSurfaceEcho(frame, slot) &&
         (spec_.labels.empty() || IsOneOf(spec_.labels, frame.label[slot]));
}

void FrameComparison::AddFiring(const Frame& reference, const Frame& other, std::size_t firing) {
  const FiringEchoes ours(reference, firing);
  const FiringEchoes theirs(other, firing);
  AddRangeBin(reference.true_range_m[firing * reference.returns], !ours.slots.empty(),
              !theirs.slots.empty());
  const auto matches = MatchEchoes(ours.ranges_m, theirs.ranges_m, spec_.match_distance_m);
  for (std::size_t k = 0; k < theirs.slots.size(); ++k) {
    const bool is_matched = std::any_of(matches.begin(), matches.end(),
                                        [k](const auto& match) { return match.second == k; });
    if (IsCompared(other, theirs.slots[k])) {
      sums_.echoes.Count(is_matched);
      parts_.CountOther(PlaceOf(other, theirs.slots[k]), is_matched);
    }
    sums_.echoes_per_label[other.label[theirs.slots[k]]].Count(is_matched);
  }
  const std::size_t first_slot = firing * reference.returns;
  if (reference.mixed_share[first_slot] >= kLeastSecondShare) {
    sums_.second.Count(other.mixed_share[firing * other.returns] > kLeastMixedShare);
  }
  const auto is_thin = [&](std::uint32_t label) { return IsOneOf(spec_.thin_labels, label); };
  for (std::size_t i = 0; i < ours.slots.size(); ++i) {
    const std::size_t slot = ours.slots[i];
    const auto match =
        std::find_if(matches.begin(), matches.end(), [i](const auto& m) { return m.first == i; });
    const bool is_matched = match != matches.end();
    sums_.reference_echoes_per_label[reference.label[slot]].Count(is_matched);
    if (!IsCompared(reference, slot)) continue;
    sums_.reference_echoes.Count(is_matched);
    parts_.CountReference(PlaceOf(reference, slot), is_matched);
    const float share = reference.footprint_share[slot];
    if (is_thin(reference.label[slot]) && share >= kLeastThinShare) {
      sums_.thin.Count(is_matched && is_thin(other.label[theirs.slots[match->second]]));
    }
    // In every return mode with several returns, the first slot holds the strongest echo.
    const bool is_strongest = slot % reference.returns == 0;
    if (!is_strongest && share >= kLeastSecondShare) sums_.further.Count(is_matched);
    if (is_strongest && is_matched) AddMatched(reference, slot, other, theirs.slots[match->second]);
  }
}

void FrameComparison::AddMatched(const Frame& reference,
                                 std::size_t slot,
                                 const Frame& other,
                                 std::size_t match) {
  const float range_error_m = std::abs(reference.range_m[slot] - other.range_m[match]);
  range_errors_m_.push_back(range_error_m);
  const float expected = reference.intensity[slot];
  const float found = other.intensity[match];
  const bool has_intensity = expected > 0.0F && std::isfinite(found);
  const float intensity_error = has_intensity ? std::abs(found - expected) / expected
                                              : std::numeric_limits<float>::quiet_NaN();
  if (has_intensity) intensity_errors_.push_back(intensity_error);
  parts_.AddErrors(PlaceOf(reference, slot), range_error_m, intensity_error);
}

void FrameComparison::AddRangeBin(float true_range_m, bool has_reference_return, bool has_return) {
  if (!(true_range_m >= 0.0F && true_range_m <= spec_.range_max_m)) return;
  constexpr std::size_t kNumBins = FrameDifference::kNumRangeBins;
  const float place = true_range_m / spec_.range_max_m * static_cast<float>(kNumBins);
  auto& bin = sums_.range_bins[std::min(static_cast<std::size_t>(place), kNumBins - 1)];
  ++bin.num_firings;
  bin.num_reference_returned += has_reference_return ? 1 : 0;
  bin.num_returned += has_return ? 1 : 0;
}

FrameDifference FrameComparison::Result() const {
  FrameDifference result = sums_;
  result.range_m = QuantilesOf(range_errors_m_);
  result.intensity = QuantilesOf(intensity_errors_);
  result.step_range_m = QuantilesOf(step_errors_m_);
  result.bright_edges = QuantilesOf(bright_errors_);
  result.dropout_error = DropoutError(sums_.range_bins);
  result.parts = parts_.Result();
  return result;
}

}  // namespace railcast
