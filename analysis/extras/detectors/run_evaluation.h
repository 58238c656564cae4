#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/detectability/approach.h"
#include "analysis/detectability/object_detection.h"
#include "analysis/extras/detectors/detection.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A detected box is of an object if at least this share of the smaller of both is common to them.
inline constexpr double kLeastOverlap = 0.5;
/// Every face of a true box is moved outwards by this before that: points err by noise and, beside
/// the object, by half a beam's width, 0.26 m at 150 m for beams 0.2 degrees wide.
inline constexpr double kBoxSlack_m = 0.3;

/// A run of frames in which the rule is fulfilled by boxes for which there is no reason to brake.
struct FalseAlarm {
  std::uint32_t frame{};  ///< Number of the frame that completes the rule.
  double s_m{};           ///< Chainage of the nearest of these boxes in that frame.
  double distance_m{};    ///< From the sensor to it.
  std::string object;     ///< The object that is not in the way; empty where there is none.
  /// Label of most of the box's points, or as the detector calls it where it has no points.
  std::string cause;
};

/// How many of the boxes that a detector reports count.
struct BoxCounts {
  std::uint64_t read{};
  std::uint64_t in_gauge{};
  std::uint64_t matched{};  ///< In the gauge, and of an object.
};

/// A run as a detector sees it.
struct EvaluatedRun {
  /// In the sightings, `points` is 1 where the object was detected in the frame.
  DetectRun run;
  double driven_m{};  ///< From the first frame's stamp to the last one's.
  std::vector<FalseAlarm> alarms;
  BoxCounts boxes;
  /// Number and latency of each frame that has been evaluated.
  std::vector<std::uint32_t> frames;
  std::vector<double> latencies_s;

  /// The objects that the run comes near and that never reach into the gauge.
  [[nodiscard]] std::vector<std::string> ObjectsBeside() const;
};

/// Evaluates what a detector reports of a run, frame by frame.
class RunEvaluator {
 public:
  /// @param track,labels Must outlive this.
  RunEvaluator(const OwnTrack& track,
               const LabelTable& labels,
               const Transform& vehicle_from_sensor);

  /// @pre The frame has a pose and lasts > 0.
  void Add(const RecordedFrame& recorded, const FrameDetections& detections);

  /// @param rule Of spec, only its numbers of frames count: what a detector reports is seen.
  /// @throws InputError as DetectInRun() does.
  [[nodiscard]] EvaluatedRun Finish(std::filesystem::path source,
                                    std::uint64_t seed,
                                    DetectSpec spec);

 private:
  /// A box in the gauge.
  struct GaugeBox {
    double s_m{};
    double distance_m{};
    std::string cause;
    std::vector<std::string> objects;  ///< The objects that it belongs to.
  };
  [[nodiscard]] std::vector<FalseAlarm> AlarmsAt(const std::string& object,
                                                 const DetectionRule& rule) const;

  const OwnTrack& track_;
  const LabelTable& labels_;
  Transform vehicle_from_sensor_;
  RunCourses courses_;
  std::vector<std::vector<GaugeBox>> boxes_;  ///< By frame.
  BoxCounts counts_;
  std::vector<std::uint32_t> frames_;
  std::vector<double> latencies_s_;
  std::vector<Vector3> sensor_m_;  ///< In the world, by frame.
};

/// Moves a detection to where it is known: nearer by what the vehicle, and the object towards it,
/// do in that time. It is never nearer than 0.
void AddLatency(const ObjectCourse& course, double latency_s, ObjectDetection& detection);

}  // namespace railcast
