#pragma once

#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/estimate/detection_curve.h"
#include "analysis/estimate/streams.h"
#include "analysis/extras/study/approach_record.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// An object of an approach, and its one inspection.
struct Observation {
  const ApproachRecord* approach{};
  const StudiedObject* object{};
  Inspection inspection;
};

/// Something that differs between observations: what a recipe draws, or the kind of object.
struct Factor {
  std::string name;  ///< As in the recipe; what is drawn for objects has "object " before it.
  /// Names of its values: options, or thirds of numbers, "2.1 to 7.9".
  std::vector<std::string> levels;
  std::vector<std::size_t> level_of;  ///< By observation.
  std::vector<double> numbers;        ///< By observation; empty if they are no numbers.
};

/// Observations that have something in common.
struct ObservedGroup {
  std::uint64_t num{};
  std::uint64_t num_detected{};
  std::uint64_t num_decided{};
  std::uint64_t num_in_time{};
  Moments distance_m;              ///< Distances of the detections.
  std::vector<double> detected_m;  ///< For each approach; 0 without detection.
  /// As `detected_m`, but infinite for approaches that began too near to tell.
  std::vector<double> at_most_m;
  double most_needed_m = std::numeric_limits<double>::quiet_NaN();  ///< To stop; NaN of nothing.
  std::vector<Inspection> inspections;

  void Add(const Observation& each);
  [[nodiscard]] Estimate in_time_percent() const {
    return PercentProportion(num_in_time, num_decided);
  }
};

/// All observations of a study's approaches, each target inspected once in each of its approaches.
/// @param approaches Must outlive the observations.
[[nodiscard]] std::vector<Observation> ObservationsOf(
    const std::vector<ApproachRecord>& approaches);

/// What differs between them, options before all else, in the order of names. Seeds are left out,
/// and what has more than 12 values that are no numbers.
[[nodiscard]] std::vector<Factor> FactorsOf(const std::vector<Observation>& observations);

/// The factor that is the kind of object.
inline constexpr const char* kTarget = "target";
/// The name of the distance of the inspections among the factors.
inline constexpr const char* kDistance = "distance";
/// The level of an observation for which a factor is not drawn.
inline constexpr std::string_view kNotDrawn = "not drawn";

/// How much a factor changes whether objects are detected.
struct FactorWeight {
  std::string name;  ///< kDistance for that of the inspection.
  std::size_t degrees{};
  /// Twice the fall of the log-likelihood where the factor is left out of the model.
  double ratio{};
  double p_value = std::numeric_limits<double>::quiet_NaN();  ///< By the chi-squared distribution.
  double share{};                                             ///< Share in the sum of all ratios.
};

/// Weighs factors by the likelihood ratio in one logistic regression of hit and miss on the
/// logarithm of the distance and all factors: numbers linearly, their logarithm where they span a
/// decade; all others by level. Columns that follow from others are left out.
/// @return The greatest ratio first; empty with fewer than 10 observations for each coefficient.
[[nodiscard]] std::vector<FactorWeight> WeighFactors(const std::vector<Observation>& observations,
                                                     const std::vector<Factor>& factors);

/// The keys of scenarios that something drawn changes: "/weather/visibility_m".
/// @param name As records of approaches have it: a pointer stands for itself, the name of a group
///   for all that its options set or draw.
/// @param recipe The recipe's file.
[[nodiscard]] std::set<std::string> DrawnKeys(const std::string& name, const Json& recipe);

}  // namespace railcast
