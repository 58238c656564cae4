#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/run/sequence_files.h"
#include "core/io/strict_json.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

// Readers for one frame's lines in the line files of a sequence directory (docs/files.md). `place`
// names the file and line in errors: "out/frames.jsonl:3".

/// A line of frames.jsonl.
struct FrameLine {
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  /// Poses after the stamp, by time, the last at the last firing: at least that one, and only that
  /// one in sequences of older programs.
  std::vector<ScanPose> scan_poses;
  std::vector<KnownFile> files;
  std::string records_hash;  ///< Hash over the frame's lines in the other line files.
  /// The numbers of these in the files of the motion sensors, in their order.
  std::vector<std::uint32_t> motion_lines{};
  std::string clouds_hash{};  ///< Hash over its clouds in the run's bag; empty if there is none.
};

/// @throws InputError "place: rule" if it is not a line of frames.jsonl.
[[nodiscard]] FrameLine ReadFrameLine(const std::string& line, const std::string& place);

/// Reads a line of poses.csv: world_from_sensor at the stamp.
/// @throws InputError "place: rule" if it is not such a line, or has another stamp.
[[nodiscard]] Transform ReadPoseLine(std::string_view line,
                                     std::int64_t stamp_ns,
                                     const std::string& place);

/// Reads a line of objects.jsonl.
/// @throws InputError "place: rule" if it is not such a line, or belongs to another frame.
[[nodiscard]] std::vector<RecordedObject> ReadObjectsLine(const std::string& line,
                                                          std::uint32_t frame,
                                                          const std::string& place);

/// The name of the class of SemanticKITTI that the object's points have: of the moving one if it
/// moves. Its own label if there is none.
/// @param labels railcast's own, which objects.jsonl names. @param kitti Those that the clouds
/// have.
[[nodiscard]] std::string KittiClassOf(const RecordedObject& object,
                                       const LabelTable& labels,
                                       const LabelTable& kitti);

/// Reads the occlusion of an object of such a line: 0 to 1, absent if no firing would meet it even
/// alone.
/// @param place Names the object, too: "out/objects.jsonl:3: /objects/0".
/// @throws InputError "place/occlusion: rule" if it is anything else, or if more firings see the
///   object than would see it alone.
[[nodiscard]] std::optional<double> ReadOcclusion(const StrictJson& object,
                                                  const std::string& place);

/// Makes a pose of seven numbers: x y z qx qy qz qw.
/// @throws InputError "place: rule" unless there are seven finite numbers and the quaternion has
///   length 1.
[[nodiscard]] Transform MakePose(const std::vector<double>& numbers, const std::string& place);

}  // namespace railcast
