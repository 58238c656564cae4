#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/clearance/structure_gauge.h"
#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// The track that the vehicle is on: an object ahead is in the way if it reaches into the structure
/// gauge.
class OwnTrack {
 public:
  /// @throws InputError as MakeWorld() does.
  explicit OwnTrack(const ScenarioSpec& scenario);
  /// @param world The scenario's.
  /// @param gauge What must stay clear; empty = the structure gauge.
  OwnTrack(const ScenarioSpec& scenario, const RailWorld& world, std::vector<GaugePart> gauge = {});

  [[nodiscard]] const std::vector<GaugePart>& gauge() const { return gauge_; }
  [[nodiscard]] double begin_s_m() const { return track_.begin_s_m(); }
  [[nodiscard]] double end_s_m() const { return track_.end_s_m(); }
  /// The track frame on the axis at a chainage.
  [[nodiscard]] Transform WorldFromTrack(double s_m) const {
    return track_.WorldFromTrack(alignment_, s_m);
  }
  /// Chainage of the point of the axis that is nearest to this point.
  [[nodiscard]] double ChainageNear_m(const Vector3& world_m) const;
  /// As above, but starts from a nearby chainage.
  [[nodiscard]] double Refined_m(double s_m, const Vector3& world_m) const;

  /// Position of a box relative to the gauge of the track ahead, where it comes nearest to it. A
  /// box behind the vehicle or beyond the ends of the track is not inside, at an infinite distance
  /// from the axis.
  [[nodiscard]] GaugeClearance ClearanceAhead(const Transform& world_from_vehicle,
                                              const Transform& world_from_box,
                                              const Vector3& size_m) const;

 private:
  Alignment alignment_;
  TrackCourse track_;
  std::vector<GaugePart> gauge_;
  /// One point every kAxisStep_m of chainage from the start of the track.
  std::vector<Vector3> axis_m_;
};

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
