#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/certify/certificate.h"
#include "core/io/run/sequence_files.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

class Archive;
struct FrameFile;

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

/// Reads such a line.
/// @throws InputError "place: rule" if it is anything else.
[[nodiscard]] PoseRecord ReadPoseRecord(std::string_view line, const std::string& place);

/// Reads such a line: world_from_sensor at the stamp.
/// @throws InputError "place: rule" if it is not such a line, or has another stamp.
[[nodiscard]] Transform ReadPoseLine(std::string_view line,
                                     std::int64_t stamp_ns,
                                     const std::string& place);

/// Describes a record's key quaternion_xyzw.
void DescribeRotation(Archive& a, Eigen::Quaterniond& rotation);

/// Number of firings with each outcome, by its number.
struct OutcomeCounts : std::array<std::uint64_t, kOutcomeNames.size()> {
  OutcomeCounts() : array() {}
};
void Describe(Archive& a, OutcomeCounts& s);

/// Counts over one frame, or over many together.
struct FrameCounts {
  std::uint64_t points{};  ///< Slots with a point.
  OutcomeCounts outcomes{};
  /// By the label's name; labels without a point are left out.
  std::map<std::string, std::uint64_t> points_per_label;

  void Add(const FrameCounts& other);
  bool operator==(const FrameCounts&) const = default;
};

[[nodiscard]] FrameCounts CountFrame(const Frame& frame, const LabelTable& labels);

void Describe(Archive& a, FrameCounts& s);

/// Describes counts of frames of which only the points may be known, as those of clouds into which
/// something was put. The other keys are left out where no firing is counted.
void DescribeKnown(Archive& a, FrameCounts& s);

/// The sensor's pose at a time during a frame's scan.
struct RecordedScanPose {
  std::uint32_t time_ns{};               ///< Time since the stamp.
  Vector3 position_m = Vector3::Zero();  ///< In the world frame.
  /// A rotation has two quaternions; this is the one nearer to that of the pose before it, so that
  /// poses in between can be interpolated.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  bool operator==(const RecordedScanPose&) const = default;
};

/// The poses after the stamp, of which the last is that of the last firing.
[[nodiscard]] std::vector<RecordedScanPose> ScanPosesOf(const Frame& frame);

void Describe(Archive& a, RecordedScanPose& s);

/// @throws InputError "place: rule" unless each is later than the one before it.
void CheckTimes(const std::vector<RecordedScanPose>& poses, const std::string& place);

/// What a frame's record says of its encoded files.
[[nodiscard]] std::vector<KnownFile> KnownFilesOf(const std::vector<FrameFile>& files);

/// A line of frames.jsonl, which states that a frame is complete.
struct FrameRecord {
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  /// By time: at least one, and the last at the last firing.
  std::vector<RecordedScanPose> scan_poses{};
  std::vector<KnownFile> files{};
  std::string records_hash{};  ///< Hash over the frame's lines in the directory's other files.
  /// The numbers of these in the files of the motion sensors, in their order.
  std::vector<std::uint32_t> motion_lines{};
  std::string
      clouds_hash{};  ///< Over its clouds in the run's bag or trace; empty if there is none.
  FrameCounts counts{};
  std::optional<FrameCertificate> certificate{};  ///< If the run is certified.

  bool operator==(const FrameRecord&) const = default;
};
void Describe(Archive& a, FrameRecord& s);

/// @throws InputError "place: rule" if it is not a line of frames.jsonl. Its hash is not checked.
[[nodiscard]] FrameRecord ReadFrameLine(std::string_view line, const std::string& place);

/// Returns nothing if the line is incomplete, was changed, or is no line of frames.jsonl.
[[nodiscard]] std::optional<FrameRecord> ParseFrameLine(std::string_view line);

/// The scan's poses as a frame has them.
[[nodiscard]] std::vector<ScanPose> ScanPosesOf(const std::vector<RecordedScanPose>& poses);

}  // namespace railcast
