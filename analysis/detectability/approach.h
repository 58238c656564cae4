#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/own_track.h"
#include "core/base/transform.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// What one frame shows of one object.
struct Sighting {
  std::uint32_t frame{};  ///< Counted from the recording's first.
  double distance_m{};    ///< From the sensor to the nearest point of the object's box.
  std::uint32_t points{};
  double speed_mps{};     ///< Of the sensor.
  double gradient{};      ///< Of the track below it: rise per way along the vehicle's x axis.
  double approach_mps{};  ///< The object's own speed towards the sensor; < 0 where it goes away.
  bool is_in_way{};       ///< Whether it reaches into the gauge of the own track ahead.
  double from_axis_m{};   ///< Its least distance from that track's axis, across; infinite behind.
};

/// The frames in which an object was within the sensor's range.
struct ObjectCourse {
  std::string type;
  std::string label;
  std::vector<Sighting> sightings;  ///< In order of time.
};

/// What a run shows of its objects, by name.
struct RunCourses {
  std::uint32_t num_frames{};
  std::map<std::string, ObjectCourse> objects;
};

/// @param on_frame Told how many frames are read.
/// @throws InputError with one line if the recording is no sequence of ours or cannot be read.
[[nodiscard]] RunCourses FollowObjects(Recording& recording,
                                       const std::function<void(std::size_t)>& on_frame);

/// What one frame shows of its objects, added to `courses`. @pre Has a pose and lasts > 0.
void AddFrame(const RecordedFrame& recorded,
              const Transform& vehicle_from_sensor,
              const OwnTrack& own_track,
              RunCourses& courses);

/// From a point to the nearest of a box about the origin; 0 inside.
[[nodiscard]] double DistanceToBox(const Vector3& point_m, const Vector3& size_m);

}  // namespace railcast
