#include "railcast/io/cloud_files.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/kitti.h"
#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

using Moving = std::set<std::uint32_t>;
using Files = std::vector<FrameFile>;

template <PcdEncoding kEncoding>
void EncodePcdFile(const Frame& frame, const FrameFileSpec& spec, const Moving&, Files& files) {
  EncodePcd(frame, spec.fields, kEncoding, files[0].bytes);
}

template <PlyFlavour kFlavour>
void EncodePlyFile(const Frame& frame, const FrameFileSpec& spec, const Moving&, Files& files) {
  EncodePly(frame, spec.fields, kFlavour, files[0].bytes);
}

void EncodeKittiFiles(const Frame& frame,
                      const FrameFileSpec& spec,
                      const Moving& moving,
                      Files& files) {
  EncodeKittiPoints(frame, files[0].bytes);
  EncodeKittiLabels(frame, spec.labels, moving, files[1].bytes);
}

void EncodeNothing(const Frame&, const FrameFileSpec&, const Moving&, Files&) {}

std::vector<std::string> KittiLines(const Transform& first_from_sensor, double since_first_s) {
  return {KittiPoseLine(first_from_sensor), NumberText(since_first_s) + "\n"};
}

std::vector<FrameFile> KittiFixedFiles(const LabelTable& labels) {
  return {{std::string(kKittiCalibrationFile), KittiCalibration()},
          {std::string(kKittiLabelsFile), SemanticKittiYaml(labels)}};
}

}  // namespace

const std::vector<FrameFormat>& FrameFormats() {
  static const std::vector<FrameFormat> formats = {
      {.name = "pcd",
       .files = {{"frames/", ".pcd"}},
       .encode = &EncodePcdFile<PcdEncoding::kBinary>,
       .parse = &ParsePcdFile,
       .has_all_slots = true},
      {.name = "pcd-compressed",
       .files = {{"frames/", ".pcd"}},
       .encode = &EncodePcdFile<PcdEncoding::kBinaryCompressed>,
       .parse = &ParsePcdFile,
       .has_all_slots = true},
      {.name = "pcd-ascii",
       .files = {{"frames/", ".pcd"}},
       .encode = &EncodePcdFile<PcdEncoding::kAscii>,
       .parse = &ParsePcdFile,
       .has_all_slots = true},
      {.name = "ply",
       .files = {{"frames/", ".ply"}},
       .encode = &EncodePlyFile<PlyFlavour::kPcl>,
       .parse = &ParsePlyFile},
      {.name = "ply-cloudcompare",
       .files = {{"frames/", ".ply"}},
       .encode = &EncodePlyFile<PlyFlavour::kCloudCompare>,
       .parse = &ParsePlyFile},
      {.name = "kitti",
       .files = {{"sequences/00/velodyne/", ".bin"}, {"sequences/00/labels/", ".label"}},
       .encode = &EncodeKittiFiles,
       .parse = &ParseKittiFile,
       .dataset = DatasetLayout{.title = "KITTI",
                                .record_files = {kKittiPosesFile, kKittiTimesFile},
                                .record_lines = &KittiLines,
                                .fixed_files = &KittiFixedFiles}},
      // For studies of what can be seen: boxes, visibility and counts without clouds.
      {.name = "objects", .files = {}, .encode = &EncodeNothing},
      // What is written of each frame beside the bag or the trace is that of format objects.
      {.name = "mcap", .files = {}, .encode = &EncodeNothing, .bag = "frames.mcap"},
      {.name = "rosbag2", .files = {}, .encode = &EncodeNothing, .bag = "rosbag2"},
      {.name = "osi", .files = {}, .encode = &EncodeNothing, .trace = ".osi"},
      {.name = "osi-mcap", .files = {}, .encode = &EncodeNothing, .trace = ".mcap"},
  };
  return formats;
}

std::vector<std::string> FrameFormatNames() {
  std::vector<std::string> names;
  for (const FrameFormat& format : FrameFormats()) names.emplace_back(format.name);
  return names;
}

const FrameFormat* FindFrameFormat(std::string_view name) {
  const auto format = std::ranges::find(FrameFormats(), name, &FrameFormat::name);
  return format == FrameFormats().end() ? nullptr : &*format;
}

const FrameFormat& ParseFrameFormat(std::string_view name) {
  if (const FrameFormat* const format = FindFrameFormat(name)) return *format;
  throw InputError("--format: unknown format \"" + std::string(name) +
                   "\" (valid: " + Join(FrameFormatNames()) + ")");
}

const FrameFormat* FindReader(const std::filesystem::path& file) {
  const std::string extension = LowerCase(file.extension().string());
  for (const FrameFormat& format : FrameFormats()) {
    if (format.parse == nullptr) continue;
    if (extension == format.files.front().extension) return &format;
  }
  return nullptr;
}

std::string ReadableExtensions(bool with_datasets, const std::vector<std::string>& more) {
  std::vector<std::string> all;
  for (const FrameFormat& format : FrameFormats()) {
    if (format.parse == nullptr || (format.dataset && !with_datasets)) continue;
    const std::string extension(format.files.front().extension);
    if (std::ranges::find(all, extension) == all.end()) all.push_back(extension);
  }
  all.insert(all.end(), more.begin(), more.end());
  return JoinInProse(all, " or ");
}

std::vector<std::string> FrameFileNames(const FrameFormat& format, std::uint32_t number) {
  std::vector<std::string> names;
  for (const FrameFileKind& file : format.files) {
    names.push_back(std::string(file.folder) + FrameDigits(number) + std::string(file.extension));
  }
  return names;
}

void EncodeFrameFiles(const Frame& frame,
                      const FrameFileSpec& spec,
                      std::uint32_t number,
                      std::vector<FrameFile>& files,
                      const std::set<std::uint32_t>& moving) {
  const std::vector<std::string> names = FrameFileNames(*spec.format, number);
  files.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) files[i].name = names[i];
  spec.format->encode(frame, spec, moving, files);
}

}  // namespace railcast
