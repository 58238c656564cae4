#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/detectability/approach.h"
#include "analysis/estimate/streams.h"

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

/// The sightings up to the closest one.
[[nodiscard]] std::span<const Sighting> ApproachIn(const std::vector<Sighting>& sightings);

/// Whether the object comes nearer at all.
[[nodiscard]] bool IsApproached(std::span<const Sighting> approach);

/// Whether the last of these sightings completes the rule.
[[nodiscard]] bool CompletesRule(std::span<const Sighting> sightings, const DetectionRule& rule);

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

/// The settings that apply to every run.
struct DetectSpec {
  DetectionRule rule;
  BrakingSpec braking;
  /// Absent: the vehicle's own speed when the object is detected.
  std::optional<double> speed_mps;
};

/// One run of a scenario, with its own seed.
struct DetectRun {
  std::filesystem::path source;
  std::uint64_t seed{};
  RunCourses courses;
  std::map<std::string, ObjectDetection> detections;  ///< By the object's name.
};

/// @throws InputError "source: object NAME: ..." if the train cannot stop.
[[nodiscard]] DetectRun DetectInRun(std::filesystem::path source,
                                    std::uint64_t seed,
                                    RunCourses courses,
                                    const DetectSpec& spec);

/// The result for one object over all runs.
struct Verdict {
  std::string name;
  std::string type;
  std::string label;
  bool is_in_way{};  ///< In any run; otherwise there is nothing to judge.
  /// Least lateral distance from the own track's axis over all runs.
  double from_axis_m{};
  std::uint64_t num_approached{};  ///< Number of runs that approached it.
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  /// Runs that began so near that the object was detected at once, yet too late: had they begun
  /// farther away, the detection might have been in time.
  std::uint64_t num_undecided{};
  Moments distance_m;  ///< Distance of detection in the runs that did not detect it at once.
  Moments spare_m;     ///< Distance to spare in the same runs.
  /// Least distance of detection in the same runs; NaN if there is none.
  double least_distance_m{};
  double least_spare_m{};  ///< Over the runs that are decided; NaN if there is none.
  double most_needed_m{};  ///< NaN if the object was never approached.

  /// Whether any run that approached the object began far enough away to judge it.
  [[nodiscard]] bool is_judged() const { return is_in_way && num_approached > num_undecided; }
  /// Whether all runs that approached the object began too near.
  [[nodiscard]] bool is_begun_too_near() const {
    return is_in_way && num_approached > 0 && num_approached == num_undecided;
  }
  /// Whether every run that could be judged detected the object in time.
  [[nodiscard]] bool is_always_in_time() const {
    return is_judged() && num_in_time + num_undecided == num_approached;
  }

  /// "in time in all 12 runs", "too late in 1 of 12 runs, not detected in 2", "never approached".
  [[nodiscard]] std::string InWords() const;
};

/// Returns one verdict per object, in order of their names.
[[nodiscard]] std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs);

}  // namespace railcast
