#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "analysis/frontier/measure.h"

namespace railcast {

/// An error that is set against time; less is better.
struct FrontierError {
  const char* name;   ///< As in the files.
  const char* title;  ///< As on the chart, with the unit.
  double scale;       ///< From SI to that unit.
  double (*of)(const FrameDifference& difference);
};

/// Share of what is missed; NaN if there is nothing to miss.
[[nodiscard]] inline double MissedShare(const Matched& matched) {
  return matched.num == 0 ? std::numeric_limits<double>::quiet_NaN() : 1.0 - matched.share();
}

/// Of the files. The first four are the charts' panels.
inline constexpr std::array<FrontierError, 10> kFrontierErrors{{
    {"missed_share", "echoes missed, %", 100.0,
     [](const FrameDifference& d) { return MissedShare(d.reference_echoes); }},
    {"range_median_m", "range error, median, mm", 1e3,
     [](const FrameDifference& d) { return d.range_m.median; }},
    {"thin_missed_share", "wires missed, %", 100.0,
     [](const FrameDifference& d) { return MissedShare(d.thin); }},
    {"second_missed_share", "second surfaces missed, %", 100.0,
     [](const FrameDifference& d) { return MissedShare(d.second); }},
    {"further_missed_share", "further echoes missed, %", 100.0,
     [](const FrameDifference& d) { return MissedShare(d.further); }},
    {"false_share", "false echoes, %", 100.0,
     [](const FrameDifference& d) { return MissedShare(d.echoes); }},
    {"range_p95_m", "range error, 95th percentile, mm", 1e3,
     [](const FrameDifference& d) { return d.range_m.p95; }},
    {"intensity_median", "intensity error, median, %", 100.0,
     [](const FrameDifference& d) { return d.intensity.median; }},
    {"intensity_p95", "intensity error, 95th percentile, %", 100.0,
     [](const FrameDifference& d) { return d.intensity.p95; }},
    {"dropout_error", "dropout error, %", 100.0,
     [](const FrameDifference& d) { return d.dropout_error; }},
}};

/// For one error: which rows no other row beats, that is, none is as fast and as accurate and
/// better in one of both. The raw trace, the references (nobody would make frames with them) and
/// rows without this error have no part in it.
[[nodiscard]] std::vector<bool> ParetoFront(const std::vector<RowResult>& results,
                                            const FrontierError& error);

/// A row of brute force that is faster and more accurate than a rung of ours (group kLadder: a rung
/// without one of its effects is offered to nobody).
struct Defeat {
  std::string brute_force;
  std::string ours;
  std::string error;
};

/// All of them: what lies left of and below a row of ours on any chart.
[[nodiscard]] std::vector<Defeat> FindDefeats(const std::vector<RowResult>& results);

/// In sentences, whole lines.
[[nodiscard]] std::string DefeatsText(const std::vector<Defeat>& defeats);

}  // namespace railcast
