#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/transform.h"
#include "core/io/recording/known_file.h"
#include "core/io/recording/recording.h"

namespace railcast {

// What the line files of a sequence directory say of one frame (docs/files.md). `place` names the
// file and line in errors: "out/frames.jsonl:3".

/// A line of frames.jsonl.
struct FrameLine {
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  std::uint32_t duration_ns{};  ///< From the stamp to the last firing.
  Transform world_from_sensor_end = Transform::Identity();
  std::vector<KnownFile> files;
  std::string records_hash;  ///< Of the frame's lines in the other line files.
};

/// @throws InputError "place: rule" if it is none.
[[nodiscard]] FrameLine ReadFrameLine(const std::string& line, const std::string& place);

/// A line of poses.csv: world_from_sensor at the stamp.
/// @throws InputError "place: rule" if it is none, or of another stamp.
[[nodiscard]] Transform ReadPoseLine(std::string_view line,
                                     std::int64_t stamp_ns,
                                     const std::string& place);

/// A line of objects.jsonl.
/// @throws InputError "place: rule" if it is none, or of another frame.
[[nodiscard]] std::vector<RecordedObject> ReadObjectsLine(const std::string& line,
                                                          std::uint32_t frame,
                                                          const std::string& place);

/// Seven numbers: x y z qx qy qz qw. @throws InputError "place: rule" unless the quaternion is one.
[[nodiscard]] Transform MakePose(const std::vector<double>& numbers, const std::string& place);

}  // namespace railcast
