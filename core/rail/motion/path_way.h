#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/rail/motion/path_course.h"
#include "core/rail/motion/path_motion.h"
#include "core/rail/motion/track_path.h"

namespace railcast {

/// The motion of an object along a path of its own: a course, progress on it, and when it begins.
class PathWay {
 public:
  /// @param begin_ns Time at which the path's own time is 0.
  /// @param vehicle The sensor's vehicle, which may set the object off.
  PathWay(PathCourse course, const PathSpec& path, std::int64_t begin_ns, const TrackPath& vehicle);

  /// The same way if the vehicle has another motion from `from_ns` on.
  [[nodiscard]] PathWay WithVehicle(const TrackPath& vehicle, std::int64_t from_ns) const;

  struct State {
    PathPlace place;     ///< Its heading is the object's.
    double speed_mps{};  ///< >= 0.
    double walked_m{};   ///< Distance covered so far.
  };
  [[nodiscard]] State At(std::int64_t time_ns) const;

 private:
  std::shared_ptr<const PathCourse> course_;
  PathMotion motion_;
  std::optional<double> trigger_s_m_;
  double start_s_{};  ///< Absolute; infinite if the object never sets off.
};

}  // namespace railcast
