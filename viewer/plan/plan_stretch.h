#pragma once

#include <array>
#include <optional>
#include <vector>

#include "railcast/rail_world.h"

namespace railcast {

/// The part of a line that a plan shows.
struct PlanStretch {
  double from_s_m{};  ///< Chainages of the alignment: from_s_m < to_s_m.
  double to_s_m{};

  [[nodiscard]] double length_m() const { return to_s_m - from_s_m; }
  [[nodiscard]] bool Holds(double s_m) const { return s_m >= from_s_m && s_m <= to_s_m; }
  /// Returns the multiples of `step_m` within the stretch.
  [[nodiscard]] std::vector<double> WholeChainages_m(double step_m) const;
};

/// How much of the line a plan shows by itself on either side of where its tracks branch.
inline constexpr double kPlanMargin_m = 50.0;

/// Returns the stretch that a plan shows unless told otherwise: all tracks that do not run along
/// the whole line, and all turnouts, with kPlanMargin_m on either side as far as the line extends.
/// The whole line, if there are none.
[[nodiscard]] PlanStretch NetworkStretch(const RailWorld& world);

/// Returns the stretch between two given chainages, or NetworkStretch() if none are given.
/// @throws InputError if they lie beyond the line's ends or the first is not the lesser.
[[nodiscard]] PlanStretch ChosenStretch(const RailWorld& world,
                                        const std::optional<std::array<double, 2>>& ends_m);

/// Returns the smallest of 1, 2, 5, 10, 20, 50, ... that is not less than `value` > 0.
[[nodiscard]] double RoundUp125(double value);

}  // namespace railcast
