#include "core/rail/motion/path_way.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();

}  // namespace

PathWay::PathWay(PathCourse course,
                 const PathSpec& path,
                 std::int64_t begin_ns,
                 const TrackPath& vehicle)
    : course_(std::make_shared<const PathCourse>(std::move(course))),
      motion_(path, course_->points_along_m()),
      trigger_s_m_(path.start_at_vehicle_s_m) {
  const double begin_s = SecondsFromNs(begin_ns);
  start_s_ = begin_s + path.start_s.value_or(0.0);
  if (trigger_s_m_) {
    start_s_ = std::max(begin_s, vehicle.TimeAt_s(*trigger_s_m_).value_or(kNever_s));
  }
}

PathWay PathWay::WithVehicle(const TrackPath& vehicle, std::int64_t from_ns) const {
  PathWay changed = *this;
  if (trigger_s_m_ && start_s_ > SecondsFromNs(from_ns)) {
    changed.start_s_ = vehicle.TimeAt_s(*trigger_s_m_).value_or(kNever_s);
  }
  return changed;
}

PathWay::State PathWay::At(std::int64_t time_ns) const {
  const PathMotion::State state = motion_.At(SecondsFromNs(time_ns) - start_s_);
  PathPlace place = course_->At(state.along_m);
  place.heading_rad += state.turned_rad;
  return {place, state.speed_mps, state.walked_m};
}

}  // namespace railcast
