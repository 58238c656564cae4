#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame.h"
#include "core/frame/labels.h"

namespace railcast {

/// What is counted of a frame, or of many together.
struct FrameCounts {
  std::uint64_t points{};                                      ///< Slots with a point.
  std::array<std::uint64_t, kOutcomeNames.size()> outcomes{};  ///< Firings.
  std::map<std::string, std::uint64_t> points_per_label;       ///< By name; none is 0.

  void Add(const FrameCounts& other);
  bool operator==(const FrameCounts&) const = default;
};

[[nodiscard]] FrameCounts CountFrame(const Frame& frame, const LabelTable& labels);

/// A file that a frame was written to.
struct WrittenFile {
  std::string name;  ///< Relative to the sequence directory.
  std::uint64_t size{};
  std::string hash;  ///< ContentHash of its bytes.

  bool operator==(const WrittenFile&) const = default;
};

/// Where the sensor was at a frame's last firing.
struct ScanEnd {
  std::uint32_t time_ns{};               ///< Since the stamp.
  Vector3 position_m = Vector3::Zero();  ///< World.
  /// Of the two quaternions that mean the same, the one nearer to that of poses.csv, so that what
  /// lies between can be interpolated.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  bool operator==(const ScanEnd&) const = default;
};

[[nodiscard]] ScanEnd ScanEndOf(const Frame& frame);

/// A line of frames.jsonl: the proof that a frame is complete.
struct FrameRecord {
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  ScanEnd scan_end;
  std::vector<WrittenFile> files;
  std::string records_hash;  ///< Of the frame's lines in the directory's other files.
  FrameCounts counts;

  bool operator==(const FrameRecord&) const = default;
};

[[nodiscard]] std::string FrameLine(const FrameRecord& record);

/// Nothing if the line is torn or was not written by FrameLine.
[[nodiscard]] std::optional<FrameRecord> ParseFrameLine(std::string_view line);

}  // namespace railcast
