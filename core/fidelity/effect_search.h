#pragma once

#include <functional>
#include <vector>

#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "railcast/fidelity.h"

namespace railcast {

struct Effect;

/// A compared quantity: its members in Deviation and in ToleranceSpec.
struct DeviationQuantity {
  double Deviation::*value;
  double ToleranceSpec::*limit;
};
inline constexpr DeviationQuantity kDeviationQuantities[] = {
    {&Deviation::range_m, &ToleranceSpec::range_m},
    {&Deviation::missed_share, &ToleranceSpec::missed_share},
    {&Deviation::false_share, &ToleranceSpec::false_share},
    {&Deviation::thin_missed_share, &ToleranceSpec::thin_missed_share},
    {&Deviation::intensity, &ToleranceSpec::intensity},
};

/// The same quantities of a part of the scene, which has no wires of its own.
struct PartQuantity {
  SampledError PartDeviation::*value;
  double ToleranceSpec::*limit;
  bool is_for_objects_only;  ///< See PartDeviation.
};
inline constexpr PartQuantity kPartQuantities[] = {
    {&PartDeviation::range_m, &ToleranceSpec::range_m, true},
    {&PartDeviation::missed_share, &ToleranceSpec::missed_share, false},
    {&PartDeviation::false_share, &ToleranceSpec::false_share, false},
    {&PartDeviation::intensity, &ToleranceSpec::intensity, true},
};

/// Whether a quantity of a part is compared with the tolerance.
[[nodiscard]] constexpr bool Counts(const PartQuantity& quantity, const PartDeviation& part) {
  return part.is_object || !quantity.is_for_objects_only;
}

[[nodiscard]] Deviation DeviationOf(const FrameDifference& difference);

/// Whether every quantity is within the tolerance or, if that is larger, within its error with all
/// effects plus 0.2 of the tolerance.
[[nodiscard]] bool IsWithinOrAsFull(const Deviation& deviation,
                                    const Deviation& full,
                                    const ToleranceSpec& tolerance);

/// Instructions per firing of Simulator::Scan without any effect (Effect::instructions).
inline constexpr double kInstructionsOfGeometry = 2677.0;
/// What kNumSubRays sub-rays of effect `footprint` cost more than kNumCrowdedSubRays; counted in
/// the same way.
inline constexpr double kInstructionsOfMoreSubRays = 12274.0;

/// Where only beams have a width that may meet certain classes (BeamSpec::footprint_of): what it
/// takes to tell which, and the share of `footprint` that is left. Counted in the same way, with no
/// such class and with all but ground, ballast, sleepers, roads and plants.
inline constexpr double kInstructionsOfChoosing = 680.0;
inline constexpr double kShareOfChosen = 0.17;

/// Estimated instructions per firing of Simulator::Scan with a set of effects.
[[nodiscard]] double InstructionsOf(const EffectSet& effects, const BeamSpec& beam);

/// Instructions per firing that leaving out an effect of a set saves. Of the footprint it is the
/// saving with kNumCrowdedSubRays; the further ones are a candidate of their own, so that savings
/// add up.
[[nodiscard]] double SavingOf(const Effect& effect, const EffectSet& effects, const BeamSpec& beam);

/// The limits of the search are so much of the tolerance, so that other frames than the samples are
/// likely to be within it as well.
inline constexpr double kSearchMargin = 0.8;

/// A set of things left out: bit i stands for the i-th candidate.
using Omissions = unsigned;
[[nodiscard]] constexpr bool IsIn(Omissions omissions, std::size_t candidate) {
  return (omissions >> candidate & 1U) != 0;
}

/// The result of a search among candidates.
struct EffectSearchResult {
  Omissions left_out{};            ///< The set that saves most within the limits.
  Deviation deviation;             ///< The deviation without that set.
  Deviation full_deviation;        ///< The deviation if nothing is left out.
  std::vector<Deviation> without;  ///< Without one candidate each, in their order.
};

/// Returns the deviations without some sets of candidates. All have the same parts. It takes
/// several at once, because moving from frame to frame takes time of its own.
using MeasureOmissions = std::function<std::vector<Deviation>(const std::vector<Omissions>&)>;

/// Finds what may be left out within a tolerance while measuring only a few of all sets.
///
/// First, each candidate is left out on its own. Among the sets whose changes, added up, stay
/// within the limits, the one that saves most is measured as a whole, since effects influence each
/// other. While it exceeds a limit, the candidate that reduces the excess most is put back.
///
/// The limit of each error is 0.8 of the tolerance, because frames differ, or the error of
/// everything together (the reference has many more rays) plus 0.2 of the tolerance, whichever is
/// larger: limits widen where that error is above 0.6 of the tolerance. In parts of the scene, the
/// lower end of the error's interval must not exceed the limit.
/// @param savings What leaving out each candidate saves; at most 16.
[[nodiscard]] EffectSearchResult FindOmissions(const std::vector<double>& savings,
                                               const ToleranceSpec& tolerance,
                                               const MeasureOmissions& measure);

}  // namespace railcast
