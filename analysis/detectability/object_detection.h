#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "analysis/detectability/approach.h"

namespace railcast {

/// How a train brakes for an obstacle on its track.
struct BrakingSpec {
  double reaction_s = 2.0;         ///< Time from the detection to full braking.
  double deceleration_mps2 = 0.5;  ///< Deceleration on level track.
  double margin_m = 15.0;          ///< Distance to be left before the object.
};

/// Distance and time that a train needs to stop.
struct BrakedStop {
  double distance_m{};  ///< Without the margin.
  double time_s{};
};

/// s = v t_r + v^2 / (2 (a + g i)), t = t_r + v / (a + g i); i is the gradient, rise per way,
/// negative downhill (constant deceleration; g = 9.80665 m/s2).
/// @throws InputError "cannot stop: rule (got value)" if a + g i <= 0.
[[nodiscard]] BrakedStop StopOf(const BrakingSpec& braking, double speed_mps, double gradient);

/// When an object counts as detected.
struct DetectionRule {
  std::uint32_t min_points = 5;
  std::uint32_t min_frames = 3;  ///< Number of frames that need the points ...
  std::uint32_t of_frames = 5;   ///< ... out of this many consecutive frames.
};

/// Result for one object in one run.
enum class Fate {
  kDetected,
  kNeverDetected,
  kNeverApproached,  ///< It never came nearer, so there is no reason to brake.
};

/// The first detection of an object in one run.
struct ObjectDetection {
  Fate fate{};
  /// Distance at the frame that completes the rule; NaN if not detected.
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  /// The frame that completes the rule (Sighting::frame); absent if not detected.
  std::optional<std::uint32_t> frame{};
  /// The last frame of the approach, before that one, with fewer points than the rule asks for.
  std::optional<std::uint32_t> missed_frame{};
  /// Whether the object reaches into the gauge of the own track ahead at any time of the approach.
  /// An object that does not is no reason to brake.
  bool is_in_way{};
  double from_axis_m{};  ///< Least lateral distance from that track's axis during the approach.
  /// Whether the run's first frames already complete the rule: the object might have been detected
  /// from farther away.
  bool is_from_start{};
  /// Speed of the vehicle at the detection, or where the object was first in range if not detected.
  double speed_mps{};
  double gradient{};  ///< Gradient at the same place.
  double stop_m{};    ///< Braking distance.
  /// Sum of the braking distance, the distance that the object itself comes nearer meanwhile, and
  /// the margin.
  double needed_m{};

  [[nodiscard]] double spare_m() const { return distance_m - needed_m; }
  [[nodiscard]] bool is_in_time() const { return fate == Fate::kDetected && spare_m() >= 0.0; }
};

/// An object is approached if its distance falls by this much.
inline constexpr double kMinApproach_m = 1.0;

/// Finds the first detection before the closest point; later frames are no approach. Frames in
/// which the object is out of range count as frames without points. If the object moves towards the
/// sensor, its own travel during the stop is added to the distance needed; one that moves away
/// counts as standing.
/// @param speed_mps Replaces the vehicle's own speed.
/// @throws InputError as StopOf() does.
[[nodiscard]] ObjectDetection DetectObject(const ObjectCourse& course,
                                           const DetectionRule& rule,
                                           const BrakingSpec& braking,
                                           std::optional<double> speed_mps);

}  // namespace railcast
