#pragma once

#include <cstddef>
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

/// Of the files. The first four are the charts' panels.
extern const std::vector<FrontierError> kFrontierErrors;

/// For one error: which rows no other row beats, that is, none is as fast and as accurate and
/// better in one of both. The raw trace, and rows without this error (NaN), are no part of it. The
/// references are: false, since nobody would make frames with them.
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
