#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/rail/world/own_track.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

/// How one frame sees one object.
struct Sighting {
  std::uint32_t frame{};  ///< Counted from the first frame of the recording.
  double distance_m{};    ///< From the sensor to the nearest point of the object's box.
  std::uint32_t points{};
  double speed_mps{};  ///< Speed of the sensor.
  /// Gradient of the track below the vehicle: rise per distance along the vehicle's x axis.
  double gradient{};
  double approach_mps{};  ///< The object's own speed towards the sensor; negative if it moves away.
  bool is_in_way{};       ///< Whether the object reaches into the gauge of the own track ahead.
  /// Least lateral distance from that track's axis; infinite behind the vehicle.
  double from_axis_m{};
};

/// The frames in which an object was within the sensor's range.
struct ObjectCourse {
  std::string type;
  std::string label;
  std::vector<Sighting> sightings;  ///< In order of time.
};

/// The courses of a run's objects, by name.
struct RunCourses {
  std::uint32_t num_frames{};
  std::map<std::string, ObjectCourse> objects;
};

/// @param on_frame Called with the number of frames read so far.
/// @throws InputError with one line if the recording is not a railcast sequence or cannot be read.
[[nodiscard]] RunCourses FollowObjects(Recording& recording,
                                       const std::function<void(std::size_t)>& on_frame);

/// Adds one frame's sightings of its objects to `courses`.
/// @pre The frame has a pose and lasts > 0.
void AddFrame(const RecordedFrame& recorded,
              const Transform& vehicle_from_sensor,
              const OwnTrack& own_track,
              RunCourses& courses);

/// Distance from a point to a box centred at the origin; 0 inside.
[[nodiscard]] double DistanceToBox(const Vector3& point_m, const Vector3& size_m);

}  // namespace railcast
