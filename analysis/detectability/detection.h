#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "analysis/detectability/approach.h"
#include "analysis/detectability/braking.h"

namespace railcast {

/// When an object counts as detected.
struct DetectionRule {
  std::uint32_t min_points = 5;
  std::uint32_t min_frames = 3;  ///< Of so many ...
  std::uint32_t of_frames = 5;   ///< ... consecutive ones.
};

/// What became of one object in one run.
enum class Fate {
  kDetected,
  kNeverDetected,
  kNeverApproached,  ///< It never came nearer: nothing to brake for.
};

/// The first detection of an object in one run.
struct Detection {
  Fate fate{};
  /// At the frame that completes the rule; NaN if not detected.
  double distance_m = std::numeric_limits<double>::quiet_NaN();
  /// Whether the object reaches into the gauge of the own track ahead at any time of the approach.
  /// What does not is no reason to brake.
  bool is_in_way{};
  double from_axis_m{};  ///< The least distance from that track's axis, across, meanwhile.
  /// Whether the run's first frames complete the rule already: the object would have been seen from
  /// farther off, too.
  bool is_from_start{};
  double speed_mps{};  ///< Of the vehicle then; where it was first in range if not detected.
  double gradient{};   ///< Likewise.
  double stop_m{};     ///< Braking distance.
  /// Braking distance, what the object itself comes nearer meanwhile, and the margin.
  double needed_m{};

  [[nodiscard]] double spare_m() const { return distance_m - needed_m; }
  [[nodiscard]] bool is_in_time() const { return fate == Fate::kDetected && spare_m() >= 0.0; }
};

/// An object is approached if its distance falls by this much.
inline constexpr double kMinApproach_m = 1.0;

/// The first detection on the way to the closest point: what comes after it is no approach. Frames
/// in which the object is out of range count as frames without points. An object that comes towards
/// the sensor needs its own way during the stop on top; one that goes away counts as standing.
/// @param speed_mps Instead of the vehicle's own.
/// @throws InputError as StopOf() does.
[[nodiscard]] Detection DetectObject(const ObjectCourse& course,
                                     const DetectionRule& rule,
                                     const BrakingSpec& braking,
                                     std::optional<double> speed_mps);

}  // namespace railcast
