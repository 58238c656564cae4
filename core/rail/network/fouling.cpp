#include "core/rail/network/fouling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/rail/network/network.h"

namespace railcast {

std::optional<double> ClearChainage_m(const TrackCourse& track,
                                      const TrackCourse& branch,
                                      const TurnoutSite& turnout,
                                      double distance_m) {
  const auto is_clear = [&](double s_m) {
    return std::abs(branch.OffsetAt(s_m).d_m - track.OffsetAt(s_m).d_m) >= distance_m - 1e-9;
  };
  constexpr double kStep_m = 1.0;
  constexpr double kFarthest_m = 1000.0;
  constexpr double kExact_m = 1e-6;
  const double side = turnout.opens_ahead() ? kStep_m : -kStep_m;
  double before_m = turnout.s_m;
  double after_m = turnout.s_m;
  do {
    before_m = after_m;
    after_m += side;
    const bool is_on_both = std::clamp(after_m, branch.begin_s_m(), branch.end_s_m()) == after_m &&
                            std::clamp(after_m, track.begin_s_m(), track.end_s_m()) == after_m;
    if (!is_on_both || std::abs(after_m - turnout.s_m) > kFarthest_m) return std::nullopt;
  } while (!is_clear(after_m));
  while (std::abs(after_m - before_m) > kExact_m) {
    const double middle_m = std::midpoint(before_m, after_m);
    (is_clear(middle_m) ? after_m : before_m) = middle_m;
  }
  return after_m;
}

}  // namespace railcast
