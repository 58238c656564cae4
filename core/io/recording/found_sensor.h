#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// A spinning sensor as the points of a turn show it.
///
/// Without times of points, azimuths of channels are known but for multiples of the step between
/// columns: the beams are the same, but not the order in which they fire. All times of channels are
/// then 0, the sense of rotation is that in which columns are stored, and the rate is 10 turns per
/// second.
struct FoundSensor {
  SpinningSpec pattern;  ///< Channels by rising elevation. Rings without any point are not in it.
  double rate_hz = 10.0;
  bool has_times{};               ///< Whether rate, sense and times come from times of points.
  double step_deg{};              ///< From column to column.
  double elevation_error_deg{};   ///< Error of the points from their channel: root mean square.
  double azimuth_error_deg{};     ///< Error of the points from their column and channel.
  double share_without_return{};  ///< Share of the firings of these channels.
  ScanTable beams;                ///< Beams of the turn, from where they leave.
  std::optional<Eigen::Matrix3d> sensor_from_spin;  ///< As in Frame; Rz(yaw) Ry(pitch).
  std::size_t num_points{};
  std::size_t num_lost{};  ///< Points that share the firing of another one without its direction.

  /// "64 rings, step 0.172 deg, ...": one line with all figures.
  [[nodiscard]] std::string Text() const;
  /// "[0.966, 0, 0.259]": the axis of rotation in the recording's axes; empty if it is their z.
  [[nodiscard]] std::string AxisText() const;
  /// The sensor as a file that scenarios and plans take as `lidar`, as if it spun about z.
  /// @throws InputError as BuildScanPattern() does.
  [[nodiscard]] std::string FileText() const;
};

/// Finds the sensor of a turn.
/// @throws InputError with the reason in one line if the frame is no grid of a spinning sensor.
[[nodiscard]] FoundSensor FindSensor(const RecordedFrame& recorded);

/// Finds the sensor of a recording, by that of its first ten frames which has the most rings, and
/// of these the most points.
class SensorSearch {
 public:
  /// Looks at the next frame, if the search goes on.
  void Add(const RecordedFrame& recorded);
  static constexpr int kMostFrames = 10;
  [[nodiscard]] bool goes_on() const { return num_frames_ < kMostFrames; }
  /// Adds what another search found, after this one.
  void Add(SensorSearch other);

  std::optional<FoundSensor> found;
  std::string why_not = "it has no frame";  ///< Why the last frame that shows none does not.

 private:
  int num_frames_{};
};

/// As SensorSearch.
/// @throws InputError as above, or as OpenRecording() and its readers do.
[[nodiscard]] FoundSensor FindSensor(Recording& recording);

}  // namespace railcast
