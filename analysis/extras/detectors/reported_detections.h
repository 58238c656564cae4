#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/extras/detectors/detection.h"
#include "core/io/recording/recorded_motion.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {

/// One detection of a file (docs/evaluate.md): a box, or a cluster of points.
struct ReportedDetection {
  std::optional<std::array<double, 3>> center_m;
  std::optional<std::array<double, 3>> size_m;
  std::array<double, 4> quaternion_xyzw{0.0, 0.0, 0.0, 1.0};
  /// By their places in the frame's file; absent of a box.
  std::optional<std::vector<std::uint32_t>> points;
  double score = 1.0;
  std::string class_name;
};

/// World coordinates may be those of a national grid.
inline constexpr double kFarthestBox_m = 1e7;
inline constexpr double kLargestBox_m = 1e3;

/// What a file says of one frame.
struct ReportedFrame {
  std::uint32_t frame{};
  std::optional<double> latency_ms;
  /// Which motion had been undone when the boxes were found.
  Compensation compensation = Compensation::kNone;
  std::vector<ReportedDetection> detections;
  std::string place;  ///< For messages: "FILE:3".
  /// Whose axes the boxes are in; absent = the sensor's, right-handed. Must be there where the
  /// points of the run's files are in others.
  std::optional<OutputFrame> axes;
  std::optional<Handedness> handedness;
};

/// The detections of a run, by rising number of the frame.
using ReportedRun = std::vector<ReportedFrame>;

/// Reads a file of detections: JSON lines, or a file of OpenLABEL with cuboids.
/// @throws InputError as ReadDetectionLines() and ReadOpenLabelRun() do.
[[nodiscard]] ReportedRun ReadReportedRun(const std::filesystem::path& file,
                                          const Transform& vehicle_from_sensor);

/// Reads the lines of a file of detections.
/// @param shown Names the file in messages.
/// @throws InputError with a line for every fault of the first faulty line: "FILE:3: /pointer: rule
///   (got value)".
[[nodiscard]] ReportedRun ReadDetectionLines(const std::string& text, const std::string& shown);

/// Reads the cuboids of a file of OpenLABEL 1.0 as export_osdar.py and raillabel have them: 10
/// numbers each, in a coordinate system of which the place in the topmost one, the vehicle's axes,
/// is known. They are put into the sensor's axes.
/// @throws InputError "FILE: /openlabel/...: rule".
[[nodiscard]] ReportedRun ReadOpenLabelRun(const std::string& text,
                                           const std::string& shown,
                                           const Transform& vehicle_from_sensor);

/// Hands out a run's detections frame by frame.
class ReportedFrames {
 public:
  explicit ReportedFrames(ReportedRun run) : run_(std::move(run)) {}

  /// What is reported of a frame, or nothing. Frames must be asked for in their order.
  /// @throws InputError "FILE:3: /frame: must be one of the run ..." if a frame was skipped.
  [[nodiscard]] const ReportedFrame* Of(std::uint32_t frame);
  /// @throws InputError as Of() if frames are left.
  void CheckEnd() const;

 private:
  [[noreturn]] void FailAt(const ReportedFrame& reported) const;

  ReportedRun run_;
  std::size_t next_ = 0;
};

/// How a run's files have their points.
struct PointsOfRun {
  OutputSpec output;
  Transform vehicle_from_sensor = Transform::Identity();
};

/// Puts what is reported of a frame into the world, boxes where they were at the stamp. A box of
/// points as measured was seen at the mean time of the points in it.
/// @param min_score Detections below are left out.
/// @throws InputError "FILE:3: /detections/0/points/2: rule (got value)" for a point that the frame
///   does not have, and "FILE:3: /axes: rule" for a box that does not say whose axes it is in where
///   it must.
[[nodiscard]] std::vector<DetectedBox> DetectionsOf(const ReportedFrame& reported,
                                                    const RecordedFrame& recorded,
                                                    const PointsOfRun& run,
                                                    const OwnTrack& track,
                                                    double min_score);

}  // namespace railcast
