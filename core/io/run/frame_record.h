#pragma once

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// Returns the rotation as a quaternion with w >= 0, so that of the two for the same rotation it is
/// always the same one.
[[nodiscard]] Eigen::Quaterniond CanonicalRotation(const Transform& transform);

/// Time and pose of the sensor at a frame's stamp.
struct PoseRecord {
  std::int64_t stamp_ns{};
  Vector3 position_m = Vector3::Zero();  ///< In the world frame.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  PoseRecord() = default;
  PoseRecord(std::int64_t stamp, const Transform& world_from_sensor);

  [[nodiscard]] Transform WorldFromSensor() const;
};

/// The first line of poses.csv.
inline constexpr std::string_view kPosesHeader = "stamp_ns,x,y,z,qx,qy,qz,qw\n";

/// Returns a line of poses.csv with enough digits to restore the same doubles.
[[nodiscard]] std::string PoseLine(const PoseRecord& pose);

/// Parses such a line.
/// @pre The line was written by PoseLine.
[[nodiscard]] PoseRecord ParsePoseLine(std::string_view line);

/// Counts over one frame, or over many together.
struct FrameCounts {
  std::uint64_t points{};  ///< Slots with a point.
  /// Number of firings with each outcome.
  std::array<std::uint64_t, kOutcomeNames.size()> outcomes{};
  /// By the label's name; labels without a point are left out.
  std::map<std::string, std::uint64_t> points_per_label;

  void Add(const FrameCounts& other);
  bool operator==(const FrameCounts&) const = default;
};

[[nodiscard]] FrameCounts CountFrame(const Frame& frame, const LabelTable& labels);

/// Adds the members `points`, `outcomes` and `points_per_label`, as in frames.jsonl and
/// manifest.json, to `object`.
void PutCounts(const FrameCounts& counts, nlohmann::ordered_json& object);

/// A file that holds data of a frame.
struct WrittenFile {
  std::string name;  ///< Relative to the sequence directory.
  std::uint64_t size{};
  std::string hash;  ///< ContentHash of its bytes.

  bool operator==(const WrittenFile&) const = default;
};

/// The sensor's pose at a time during a frame's scan.
struct RecordedScanPose {
  std::uint32_t time_ns{};               ///< Time since the stamp.
  Vector3 position_m = Vector3::Zero();  ///< In the world frame.
  /// Of the two quaternions for the same rotation, the one nearer to that of the pose before it, so
  /// that poses in between can be interpolated.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  bool operator==(const RecordedScanPose&) const = default;
};

/// The poses after the stamp, of which the last is that of the last firing.
[[nodiscard]] std::vector<RecordedScanPose> ScanPosesOf(const Frame& frame);

/// The member `scan_poses` of lines of frames.jsonl and insert.jsonl.
[[nodiscard]] nlohmann::ordered_json ScanPosesJson(const std::vector<RecordedScanPose>& poses);

/// A line of frames.jsonl, which states that a frame is complete.
struct FrameRecord {
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  std::vector<RecordedScanPose> scan_poses;
  std::vector<WrittenFile> files;
  std::string records_hash;  ///< Hash of the frame's lines in the directory's other files.
  /// The numbers of these in the files of the motion sensors, in their order.
  std::vector<std::uint32_t> motion_lines{};
  std::string clouds_hash{};  ///< Of its clouds in the run's bag; empty if there is none.
  FrameCounts counts;

  bool operator==(const FrameRecord&) const = default;
};

[[nodiscard]] std::string FrameRecordLine(const FrameRecord& record);

/// Returns nothing if the line is incomplete, was changed, or was not written by FrameRecordLine.
[[nodiscard]] std::optional<FrameRecord> ParseFrameLine(std::string_view line);

}  // namespace railcast
