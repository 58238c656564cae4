#pragma once

#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/sight/sight.h"

namespace railcast {

/// A part of the way on which the sight of one target is shorter than the distance needed, and
/// ends at the same label.
struct ShortSight {
  double from_s_m{};  ///< Chainages of the first and the last place.
  double to_s_m{};
  double height_m{};
  std::string blocker;  ///< "range" if nothing blocks.
  SightPlace worst;     ///< Where least is to spare.
  Sight sight;          ///< The one of `worst`.

  [[nodiscard]] double spare_m() const { return sight.distance_m - worst.needed_m; }
};

/// The parts of the way with too short a sight, by height and in the order in which they are
/// passed.
[[nodiscard]] std::vector<ShortSight> ShortSights(const std::vector<SightPlace>& places,
                                                  const SightSpec& spec);

/// @pre There is a place.
/// @param range_m How far targets were sought.
[[nodiscard]] Report MakeSightReport(const std::vector<SightPlace>& places,
                                     const SightSpec& spec,
                                     double range_m,
                                     const std::string& command);

}  // namespace railcast
