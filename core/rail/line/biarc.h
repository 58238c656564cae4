#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/rail/line/plan_course.h"

namespace railcast {

/// Two arcs, one behind the other, that lead from one place and direction to another. Either may be
/// straight.
struct Biarc {
  double first_m{};  ///< Length.
  double first_per_m{};
  double second_m{};
  double second_per_m{};

  [[nodiscard]] double length_m() const { return first_m + second_m; }
  [[nodiscard]] double sharpest_per_m() const {
    return std::max(std::abs(first_per_m), std::abs(second_per_m));
  }
};

/// The two arcs with tangents of equal length. Curvatures of the points are not used.
/// @return Nothing if the arcs would have to turn by more than 90 degrees each, as they must if the
///   second place is not ahead of the first.
[[nodiscard]] std::optional<Biarc> BiarcBetween(const PlanPoint& from, const PlanPoint& to);

}  // namespace railcast
