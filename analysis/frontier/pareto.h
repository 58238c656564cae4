#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/frontier/measure.h"

namespace railcast {

/// An error that is plotted against time; smaller is better.
struct FrontierError {
  const char* name;        ///< Name in the files, in SI units.
  const char* shown_name;  ///< Name in `unit`.
  const char* title;       ///< Title for readers.
  const char* unit;
  double scale;  ///< Factor from SI to `unit`.
  double (*of)(const RowErrors& difference);
};

/// Share of what is missed; NaN where there is too little to miss, as of other estimates.
[[nodiscard]] inline double MissedShare(const Matched& matched) {
  return 1.0 - Proportion(matched.num_matched, matched.num).value;
}

/// A quantile of the errors of so many echoes; NaN of too few.
[[nodiscard]] inline double OfEnough(std::uint64_t num, double quantile) {
  return num < kMinSamples ? std::numeric_limits<double>::quiet_NaN() : quantile;
}

/// The first four have charts.
inline constexpr std::array<FrontierError, 17> kFrontierErrors{{
    {"missed_share", "missed_percent", "Echoes missed", "%", 100.0,
     [](const RowErrors& d) { return MissedShare(d.reference_echoes); }},
    {"range_median_m", "range_median_mm", "Range error, median", "mm", 1e3,
     [](const RowErrors& d) { return OfEnough(d.reference_echoes.num_matched, d.range_m.median); }},
    {"thin_missed_share", "thin_missed_percent", "Wires missed", "%", 100.0,
     [](const RowErrors& d) { return MissedShare(d.thin); }},
    {"second_missed_share", "second_missed_percent", "Second surfaces missed", "%", 100.0,
     [](const RowErrors& d) { return MissedShare(d.second); }},
    {"further_missed_share", "further_missed_percent", "Further echoes missed", "%", 100.0,
     [](const RowErrors& d) { return MissedShare(d.further); }},
    {"false_share", "false_percent", "False echoes", "%", 100.0,
     [](const RowErrors& d) { return MissedShare(d.echoes); }},
    {"range_p95_m", "range_p95_mm", "Range error, 95 %", "mm", 1e3,
     [](const RowErrors& d) { return OfEnough(d.reference_echoes.num_matched, d.range_m.p95); }},
    {"intensity_median", "intensity_median_percent", "Intensity error, median", "%", 100.0,
     [](const RowErrors& d) { return d.intensity.median; }},
    {"intensity_p95", "intensity_p95_percent", "Intensity error, 95 %", "%", 100.0,
     [](const RowErrors& d) { return d.intensity.p95; }},
    {"range_p99_m", "range_p99_mm", "Range error, 99 %", "mm", 1e3,
     [](const RowErrors& d) { return OfEnough(d.reference_echoes.num_matched, d.range_m.p99); }},
    {"step_missed_share", "step_missed_percent", "Steps missed", "%", 100.0,
     [](const RowErrors& d) { return MissedShare(d.steps); }},
    {"step_range_median_m", "step_range_median_mm", "Range error at steps, median", "mm", 1e3,
     [](const RowErrors& d) { return OfEnough(d.steps.num, d.step_range_m.median); }},
    {"bright_edge_intensity_median", "bright_edge_intensity_median_percent",
     "Intensity error of retroreflectors at edges, median", "%", 100.0,
     [](const RowErrors& d) { return d.bright_edges.median; }},
    {"person_points_error", "person_points_percent", "Points on persons, error", "%", 100.0,
     [](const RowErrors& d) { return d.persons.Error(); }},
    {"pole_points_error", "pole_points_percent", "Points on poles, error", "%", 100.0,
     [](const RowErrors& d) { return d.poles.Error(); }},
    {"detection_distance_error", "detection_distance_percent",
     "Detection distance of objects, error", "%", 100.0,
     [](const RowErrors& d) { return DetectionDistanceError(d.approaches); }},
    {"dropout_error", "dropout_percent", "Dropout error", "%", 100.0,
     [](const RowErrors& d) { return d.dropout_error; }},
}};

/// The Pareto front for one error: the rows for which no other row is as fast and as accurate and
/// better in one of both. The raw trace, the references (too slow for making frames), the row
/// `auto` (which is one of the others or between them) and rows without this error are excluded.
[[nodiscard]] std::vector<std::string> ParetoFront(const std::vector<RowResult>& results,
                                                   const FrontierError& error);

/// A brute-force row that is faster and more accurate than a rung (group kLadder; a rung without
/// one of its effects cannot be chosen by a user and is not compared).
struct Defeat {
  std::string brute_force;
  std::string ours;
  std::string error;
};

/// Finds all such pairs: the brute-force points to the left of and below a rung on any chart.
[[nodiscard]] std::vector<Defeat> FindDefeats(const std::vector<RowResult>& results);

/// Describes them in a sentence, which claims nothing where there is no row of brute force or no
/// rung.
[[nodiscard]] std::string DefeatsText(const std::vector<RowResult>& results);

}  // namespace railcast
