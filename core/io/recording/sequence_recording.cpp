#include "core/io/recording/sequence_recording.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/base/shown_text.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sensor_axes.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/write_file.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

/// What all frames of a sequence share.
struct SequenceContext {
  std::filesystem::path directory;
  ScanPattern pattern;
  OutputSpec output;
  Transform vehicle_from_sensor;

  [[nodiscard]] bool is_in_sensor_axes() const {
    return output.frame == "sensor" && output.handedness == "right";
  }
};

/// A frame's line of each line file.
struct FrameLines {
  PlacedLine frame;
  PlacedLine pose;
  PlacedLine objects;
};

std::filesystem::path CloudFileOf(const FrameLine& line, const std::string& place) {
  for (const std::string& name : line.files) {
    std::filesystem::path file = name;
    if (file.extension() == ".pcd" || file.extension() == ".ply") return file;
  }
  throw InputError(place + ": files: must name a .pcd or .ply file");
}

void RecomputeRanges(Frame& frame) {
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    frame.range_m[i] = std::hypot(frame.x[i], frame.y[i], frame.z[i]);
  }
}

RecordedFrame ReadFrame(const SequenceContext& context, const FrameLines& lines) {
  const FrameLine line = ReadFrameLine(lines.frame.text, lines.frame.place);
  const std::filesystem::path file = context.directory / CloudFileOf(line, lines.frame.place);
  const PointTable table = ReadPointTable(file);
  RecordedFrame recorded =
      MakeScanFrame(table, ShownPath(file), context.pattern, file.extension() == ".pcd");
  Frame& frame = recorded.frame;
  frame.index = line.frame;
  frame.stamp_ns = line.stamp_ns;
  frame.duration_ns = line.duration_ns;
  frame.world_from_sensor = ReadPoseLine(lines.pose.text, line.stamp_ns, lines.pose.place);
  frame.world_from_sensor_end = line.world_from_sensor_end;
  recorded.has_pose = true;
  recorded.objects = ReadObjectsLine(lines.objects.text, line.frame, lines.objects.place);
  if (context.is_in_sensor_axes()) return recorded;
  UndoOutputAxes(context.output, context.vehicle_from_sensor, context.pattern, recorded);
  if (table.Find("range_m") == nullptr) RecomputeRanges(frame);
  return recorded;
}

std::vector<std::string> ReadMaterialNames(const std::filesystem::path& file) {
  std::vector<std::string> names;
  try {
    const auto json = nlohmann::json::parse(ReadFileWhole(file));
    for (const auto& material : json.at("materials")) {
      const auto id = material.at("id").get<std::uint16_t>();
      if (names.size() <= id) names.resize(id + std::size_t{1});
      names[id] = material.at("name");
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(ShownPath(file) + ": is damaged: " + error.what());
  }
  return names;
}

class SequenceRecording : public Recording {
 public:
  explicit SequenceRecording(const std::filesystem::path& directory)
      : frames_(directory / "frames.jsonl"),
        poses_(directory / "poses.csv"),
        objects_(directory / "objects.jsonl") {
    info_.source = directory;
    info_.kind = "sequence";
    info_.num_frames = CountLines(directory / "frames.jsonl");
    info_.labels = ReadLabelTable(directory / "labels.json");
    info_.materials = ReadMaterialNames(directory / "materials.json");
    info_.scenario = ReadScenario(directory / "scenario.resolved.json");
    const LidarSpec& lidar = info_.scenario->lidar;
    context_ = std::make_shared<const SequenceContext>(
        SequenceContext{.directory = directory,
                        .pattern = BuildScanPattern(lidar.scan),
                        .output = info_.scenario->output,
                        .vehicle_from_sensor = VehicleFromSensor(lidar.mount)});
    (void)poses_.Need();  // The names of its columns.
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto frame = frames_.Next();
    if (!frame) return std::nullopt;
    FrameLines lines{std::move(*frame), poses_.Need(), objects_.Need()};
    return [context = context_, lines = std::move(lines)] { return ReadFrame(*context, lines); };
  }

 private:
  RecordingInfo info_;
  std::shared_ptr<const SequenceContext> context_;
  LineReader frames_;
  LineReader poses_;
  LineReader objects_;
};

}  // namespace

std::unique_ptr<Recording> OpenSequence(const std::filesystem::path& directory) {
  return std::make_unique<SequenceRecording>(directory);
}

}  // namespace railcast
