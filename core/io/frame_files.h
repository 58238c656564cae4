#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/frame.h"
#include "core/frame/labels.h"
#include "core/io/field_selection.h"

namespace railcast {

/// In which files frames are stored.
enum class FrameFormat { kPcd, kPcdCompressed, kPcdAscii, kPly, kPlyCloudCompare, kKitti };

/// "pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare" or "kitti".
[[nodiscard]] std::string_view FrameFormatName(FrameFormat format);

/// @throws InputError that names the valid ones.
[[nodiscard]] FrameFormat ParseFrameFormat(std::string_view name);

/// How frames become files.
struct FrameFileSpec {
  FrameFormat format = FrameFormat::kPcd;
  FieldSelection fields;  ///< Not used by kitti, whose fields are fixed.
  LabelTable labels;      ///< Used by kitti alone.
};

/// One file of a frame, not yet written.
struct FrameFile {
  std::string name;  ///< Relative to the sequence directory: "frames/000012.pcd".
  std::string bytes;
};

/// Relative to the sequence directory: "frames/000012.pcd"; of kitti the points', then the labels'.
/// @param number The one in the name, six digits or more.
[[nodiscard]] std::vector<std::string> FrameFileNames(FrameFormat format, std::uint32_t number);

/// Puts a frame into the file or files (kitti: points and labels) that hold it. `files` keeps its
/// memory from frame to frame. `number` is that of FrameFileNames(); `moving` are the instances
/// that move, which kitti tells apart.
/// @throws InputError as the format's encoder does.
void EncodeFrameFiles(const Frame& frame,
                      const FrameFileSpec& spec,
                      std::uint32_t number,
                      std::vector<FrameFile>& files,
                      const std::set<std::uint32_t>& moving = {});

}  // namespace railcast
