#include "core/io/recording/recording_kinds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/kitti.h"
#include "core/io/cloud/kitti_names.h"
#include "core/io/content_hash.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/sensor_axes.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/table_records.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// What all frames of a sequence share.
struct SequenceContext {
  std::filesystem::path directory;
  bool has_clouds{};
  ScanPattern pattern;
  OutputSpec output;
  Transform vehicle_from_sensor;

  [[nodiscard]] bool is_in_sensor_axes() const {
    return output.frame == OutputFrame::kSensor && output.handedness == Handedness::kRight;
  }
};

/// A format that a newer version wrote has clouds as far as we know.
bool HasClouds(const SequenceSummary& summary) {
  const FrameFormat* const format = FindFrameFormat(summary.run.format);
  return format == nullptr || !format->files.empty();
}

const KnownFile& CloudFileOf(const FrameRecord& line, const std::string& place) {
  for (const KnownFile& file : line.files) {
    const FrameFormat* const format = FindReader(file.name);
    if (format != nullptr && !format->dataset) return file;
  }
  throw InputError(place + ": files: must name a " + ReadableExtensions(false) + " file");
}

void RecomputeRanges(Frame& frame) {
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    frame.range_m[i] = std::hypot(frame.x[i], frame.y[i], frame.z[i]);
  }
}

RecordedFrame ReadCloudInBag(const SequenceContext& context,
                             const CloudInBag& cloud,
                             const std::string& known_hash,
                             bool& has_ranges) {
  const std::string_view bytes(reinterpret_cast<const char*>(cloud.bytes.data()),
                               cloud.bytes.size());
  if (ContentHash(bytes) != known_hash) {
    throw InputError(cloud.bag + ": must have the clouds of which " + std::string(kFramesFile) +
                     " states the hashes");
  }
  return AtPlace(cloud.bag + ": ", [&] {
    const Cloud points = cloud.parse(cloud.bytes);
    has_ranges = points.Find("range_m") != nullptr;
    return MakeScanFrame(points, cloud.bag, context.pattern, true);
  });
}

/// @param cloud Null unless the run's clouds are in a bag.
RecordedFrame ReadFrame(const SequenceContext& context,
                        const FrameLines& lines,
                        const CloudInBag* cloud) {
  FrameRecord line = ReadNextFrameLine(lines);
  RecordedFrame recorded;
  bool has_ranges = true;
  if (cloud != nullptr) {
    recorded = ReadCloudInBag(context, *cloud, line.clouds_hash, has_ranges);
  } else if (context.has_clouds) {
    const KnownFile& known = CloudFileOf(line, lines.frame.place);
    const std::string file = ShownPath(context.directory / known.name);
    const std::string bytes = ReadKnownFile(context.directory, known, kFramesFile);
    const FrameFormat& format = *FindReader(known.name);
    const Cloud points = format.parse(file, bytes, std::nullopt).cloud;
    recorded = MakeScanFrame(points, file, context.pattern, format.has_all_slots);
    has_ranges = points.Find("range_m") != nullptr;
  } else {
    recorded.name = ShownPath(context.directory);
  }
  Frame& frame = recorded.frame;
  frame.index = line.frame;
  TakeRecords(line, lines, recorded);
  if (context.is_in_sensor_axes()) return recorded;
  UndoOutputAxes(context.output, context.vehicle_from_sensor, context.pattern, recorded);
  if (!has_ranges) RecomputeRanges(frame);
  return recorded;
}

/// What all frames of a sequence in KITTI's format share.
struct KittiContext {
  std::filesystem::path directory;
  LabelTable labels;  ///< railcast's own, which objects.jsonl names.
  LabelTable kitti;   ///< SemanticKITTI's, which the clouds have.
};

/// @param place Index among the directory's frames, which numbers KITTI's files.
RecordedFrame ReadKittiFrame(const KittiContext& context,
                             const FrameLines& lines,
                             std::uint32_t place) {
  const std::filesystem::path& directory = context.directory;
  FrameRecord line = ReadNextFrameLine(lines);
  std::erase_if(line.files, [](const KnownFile& file) { return IsCameraFile(file.name); });
  if (line.files.size() != 2 || !line.files[0].name.ends_with(".bin") ||
      !line.files[1].name.ends_with(".label")) {
    throw InputError(lines.frame.place + ": files: must name a .bin and a .label file");
  }
  const std::string file = ShownPath(directory / line.files[0].name);
  const std::string points = ReadKnownFile(directory, line.files[0], kFramesFile);
  const std::string labels = ReadKnownFile(directory, line.files[1], kFramesFile);
  RecordedFrame recorded = MakeCloudFrame(ParseKittiFile(file, points, labels).cloud, file);
  recorded.frame.index = place;
  TakeRecords(line, lines, recorded);
  for (RecordedObject& object : recorded.objects) {
    object.label = KittiClassOf(object, context.labels, context.kitti);
  }
  recorded.axes = PointAxes::kSensorAtStamp;
  return recorded;
}

/// Says what is being read, for WithinMemory: the first of the frame's files is its cloud.
std::string ReadingFrameText(const std::filesystem::path& directory, const FrameLines& lines) {
  const FrameRecord line = ReadFrameLine(lines.frame.text, lines.frame.place);
  return ReadingText(line.files.empty() ? directory : directory / line.files.front().name);
}

class SequenceRecording : public Recording {
 public:
  explicit SequenceRecording(const SequenceSummary& summary) : lines_(summary) {
    CheckKnownFiles(summary);
    const std::filesystem::path& directory = summary.directory;
    info_.source = directory;
    info_.kind = "sequence";
    info_.num_frames = lines_.num_frames();
    info_.labels = ReadLabelTable(directory / kLabelsFile);
    const std::filesystem::path materials = directory / kMaterialsFile;
    info_.materials = ReadMaterialNames(ReadFileWhole(materials), ShownPath(materials));
    info_.scenario = ReadScenario(directory / kScenarioFile);
    CheckNames();
    info_.origin = OriginOf(summary);
    const LidarSpec& lidar = info_.scenario->lidar;
    context_ = std::make_shared<const SequenceContext>(
        SequenceContext{.directory = directory,
                        .has_clouds = HasClouds(summary),
                        .pattern = BuildScanPattern(lidar.scan),
                        .output = info_.scenario->output,
                        .vehicle_from_sensor = VehicleFromSensor(lidar.mount)});
    if (!summary.run.bag) return;
    clouds_ = NeedExtra(RecordingExtras::Get().clouds_of_bag, directory, "ros")(summary);
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto lines = lines_.Next();
    if (!lines) return std::nullopt;
    std::shared_ptr<const CloudInBag> cloud;
    if (clouds_) cloud = std::make_shared<const CloudInBag>(clouds_());
    return [context = context_, lines = std::move(*lines), cloud = std::move(cloud)] {
      return WithinMemory([&] { return ReadingFrameText(context->directory, lines); },
                          [&] { return ReadFrame(*context, lines, cloud.get()); });
    };
  }

 private:
  // Needed because an unfinished run has no hash of these files; the scenario gives the same
  // content.
  void CheckNames() const {
    const auto check = [&](bool is_same, std::string_view file) {
      if (is_same) return;
      throw InputError(ShownPath(info_.source / file) + ": must agree with " +
                       std::string(kScenarioFile));
    };
    check(info_.labels.labels() == LabelTable(info_.scenario->labels).labels(), kLabelsFile);
    std::vector<std::string> materials;
    const MaterialLibrary library(info_.scenario->materials);
    for (const Material& material : library.materials()) materials.push_back(material.name);
    check(info_.materials == materials, kMaterialsFile);
  }

  RecordingInfo info_;
  std::shared_ptr<const SequenceContext> context_;
  FrameLineReader lines_;
  std::function<CloudInBag()> clouds_;  ///< If the run's clouds are in a bag.
};

/// The clouds of a sequence in KITTI's format: read like any KITTI clouds, but checked against
/// their hashes.
class KittiRecording : public Recording {
 public:
  explicit KittiRecording(const SequenceSummary& summary) : lines_(summary) {
    CheckKnownFiles(summary);
    info_.source = summary.directory;
    info_.kind = "KITTI sequence";
    info_.num_frames = lines_.num_frames();
    info_.has_kitti_labels = true;
    const std::filesystem::path names = summary.directory / kKittiLabelsFile;
    info_.labels = exists(names)
                       ? ParseSemanticKittiNames(ReadFileWhole(names), ShownPath(names))
                       : SemanticKittiLabels(ReadLabelTable(summary.directory / kLabelsFile));
    info_.origin = OriginOf(summary);
    context_ = std::make_shared<const KittiContext>(
        KittiContext{.directory = summary.directory,
                     .labels = ReadLabelTable(summary.directory / kLabelsFile),
                     .kitti = info_.labels});
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto lines = lines_.Next();
    if (!lines) return std::nullopt;
    return [context = context_, lines = std::move(*lines), place = next_++] {
      return WithinMemory([&] { return ReadingFrameText(context->directory, lines); },
                          [&] { return ReadKittiFrame(*context, lines, place); });
    };
  }

 private:
  RecordingInfo info_;
  std::shared_ptr<const KittiContext> context_;
  FrameLineReader lines_;
  std::uint32_t next_{};
};

}  // namespace

std::unique_ptr<Recording> OpenSequence(const std::filesystem::path& directory) {
  const SequenceSummary summary = ReadSequenceSummary(directory);
  const FrameFormat* const format = FindFrameFormat(summary.run.format);
  if (format != nullptr && format->dataset) return std::make_unique<KittiRecording>(summary);
  return std::make_unique<SequenceRecording>(summary);
}

}  // namespace railcast
