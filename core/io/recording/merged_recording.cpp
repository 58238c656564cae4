#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/sensor_axes.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The lines about one cloud, not yet parsed.
struct MergedCloudLines {
  PlacedLine cloud;
  PlacedLine pose;
  std::optional<FrameLines> first_sensor;
};

/// What all clouds share.
struct MergedContext {
  fs::path directory;
  OutputSpec output;
  Transform vehicle_from_first = Transform::Identity();  ///< From the first sensor's axes.
};

/// Takes the vehicle's motion and the objects from the first sensor's frame of that number.
void AddFromFirstSensor(const MergedContext& context,
                        const FrameLines& lines,
                        const std::string& place,
                        RecordedFrame& recorded) {
  const FrameRecord line = ReadNextFrameLine(lines);
  Frame& frame = recorded.frame;
  if (line.frame != frame.index) {
    throw InputError(place + ": frame: must be that of " + lines.frame.place + ", " +
                     NumberText(line.frame) + Got(frame.index));
  }
  const PlacedLine& objects = lines.records.at(1);
  CheckRecords(line, lines);
  const Transform first_from_vehicle = context.vehicle_from_first.inverse();
  TakeScanPoses(line, frame);
  frame.world_from_sensor_end = frame.world_from_sensor_end * first_from_vehicle;
  for (ScanPose& pose : frame.poses_between) {
    pose.world_from_sensor = pose.world_from_sensor * first_from_vehicle;
  }
  recorded.objects = ReadObjectsLine(objects.text, line.frame, objects.place);
  std::map<std::uint32_t, std::uint32_t> num_points;
  for (const std::uint32_t instance : frame.instance) ++num_points[instance];
  for (RecordedObject& object : recorded.objects) {
    object.sensor_from_box = context.vehicle_from_first * object.sensor_from_box;
    object.points = num_points[object.instance];
    object.firings_visible = object.firings_alone = 0;
    object.occlusion.reset();
  }
}

/// The "sensor" of a merged cloud is the vehicle.
RecordedFrame ReadMergedFrame(const MergedContext& context, const MergedCloudLines& lines) {
  const auto line = ReadRecordLine<MergedRecord>(lines.cloud.text, lines.cloud.place);
  const std::string file = ShownPath(context.directory / line.file.name);
  RecordedFrame recorded = MakeCloudFrame(
      ParsePcdFile(file, ReadKnownFile(context.directory, line.file, kMergedFile)).cloud, file);
  Frame& frame = recorded.frame;
  frame.index = line.frame;
  frame.stamp_ns = line.stamp_ns;
  frame.world_from_sensor = ReadPoseLine(lines.pose.text, line.stamp_ns, lines.pose.place);
  frame.world_from_sensor_end = frame.world_from_sensor;
  recorded.has_pose = true;
  if (lines.first_sensor) {
    AddFromFirstSensor(context, *lines.first_sensor, lines.cloud.place, recorded);
  }
  UndoOutputAxes(context.output, Transform::Identity(), {}, recorded);
  return recorded;
}

class MergedRecording : public Recording {
 public:
  explicit MergedRecording(const fs::path& directory)
      : clouds_(directory / kMergedFile), poses_(directory / kPosesFile) {
    info_.source = directory;
    info_.kind = kMergedKind;
    info_.num_frames = CountLines(directory / kMergedFile);
    static_cast<void>(poses_.Need());  // The names of the columns.
    MergedContext context{.directory = directory, .output = {}};
    // A path that ends in a slash has an empty last component.
    const fs::path folder = fs::absolute(directory / "").lexically_normal().parent_path();
    const auto sensors = SensorFoldersIn(folder.parent_path());
    if (!sensors.empty()) UseFirstSensor(sensors.front(), context);
    context_ = std::make_shared<const MergedContext>(std::move(context));
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto cloud = clouds_.Next();
    if (!cloud) return std::nullopt;
    MergedCloudLines lines{std::move(*cloud), poses_.Need(), {}};
    if (first_sensor_) lines.first_sensor = first_sensor_->Next();
    return
        [context = context_, lines = std::move(lines)] { return ReadMergedFrame(*context, lines); };
  }

 private:
  /// Takes what the sensors have in common from the folder of the first.
  void UseFirstSensor(const fs::path& folder, MergedContext& context) {
    const RecordingInfo first = OpenSequence(folder)->info();
    info_.labels = first.labels;
    info_.materials = first.materials;
    info_.scenario = first.scenario;
    if (!info_.scenario) return;
    context.vehicle_from_first = VehicleFromSensor(info_.scenario->lidar.mount);
    context.output = info_.scenario->output;
    if (context.output.frame == OutputFrame::kSensor) {
      context.output.frame = OutputFrame::kVehicle;
    }
    // Points, poses and boxes are in the vehicle's axes.
    info_.scenario->lidar.name = "merged";
    info_.scenario->lidar.mount = {.position_m = {0.0, 0.0, 0.0}};
    info_.scenario->lidar.mount_error = {};
    first_sensor_.emplace(ReadSequenceSummary(folder));
  }

  RecordingInfo info_;
  std::shared_ptr<const MergedContext> context_;
  LineReader clouds_;
  LineReader poses_;
  std::optional<FrameLineReader> first_sensor_;
};

}  // namespace

std::unique_ptr<Recording> OpenMerged(const fs::path& directory) {
  return std::make_unique<MergedRecording>(directory);
}

}  // namespace railcast
