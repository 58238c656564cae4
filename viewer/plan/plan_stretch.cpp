#include "viewer/plan/plan_stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/network/network.h"

namespace railcast {

std::vector<double> PlanStretch::WholeChainages_m(double step_m) const {
  std::vector<double> chainages_m;
  for (double step = std::ceil(from_s_m / step_m); step * step_m <= to_s_m; step += 1.0) {
    chainages_m.push_back(step * step_m);
  }
  return chainages_m;
}

PlanStretch NetworkStretch(const RailWorld& world) {
  const double line_m = world.alignment().length_m();
  PlanStretch stretch{.from_s_m = std::numeric_limits<double>::infinity(),
                      .to_s_m = -std::numeric_limits<double>::infinity()};
  const auto include = [&](double s_m) {
    stretch.from_s_m = std::min(stretch.from_s_m, s_m);
    stretch.to_s_m = std::max(stretch.to_s_m, s_m);
  };
  for (const TrackCourse& course : world.network().courses) {
    if (course.begin_s_m() <= 0.0 && course.end_s_m() >= line_m) continue;
    include(course.begin_s_m());
    include(course.end_s_m());
  }
  for (const TurnoutSite& turnout : world.network().turnouts) {
    include(turnout.s_m);
    include(turnout.end_s_m);
  }
  if (stretch.from_s_m > stretch.to_s_m) return {.from_s_m = 0.0, .to_s_m = line_m};
  return {.from_s_m = std::max(0.0, stretch.from_s_m - kPlanMargin_m),
          .to_s_m = std::min(line_m, stretch.to_s_m + kPlanMargin_m)};
}

PlanStretch ChosenStretch(const RailWorld& world,
                          const std::optional<std::array<double, 2>>& ends_m) {
  if (!ends_m) return NetworkStretch(world);
  const auto [from_s_m, to_s_m] = *ends_m;
  const double line_m = world.alignment().length_m();
  if (!(from_s_m >= 0.0 && from_s_m < to_s_m && to_s_m <= line_m)) {
    throw InputError("--stretch: must be two chainages from 0 to " + NumberText(line_m) +
                     ", the lesser first (got " + NumberText(from_s_m) + " and " +
                     NumberText(to_s_m) + ")");
  }
  return {.from_s_m = from_s_m, .to_s_m = to_s_m};
}

double RoundUp125(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value) return digit * power;
  }
  return 10.0 * power;
}

}  // namespace railcast
