#include "generator/run/all_sensors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/content_hash.h"
#include "core/io/field_layout.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/recording/line_reader.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"
#include "generator/run/line_ledger.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCompressed = "pcd-compressed";

std::vector<MergedSensor> MergedSensorsOf(const FrameMaker& maker, const RunPlan& plan) {
  std::vector<MergedSensor> sensors;
  for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
    sensors.push_back({plan.sensors[i], maker.pattern(i)});
  }
  return sensors;
}

std::size_t OffsetOf(const Cloud& cloud, std::string_view name) {
  const CloudField* const field = cloud.Find(name);
  Check(field != nullptr && field->type == NumberType::kFloat,
        "a cloud that is merged has coordinates");
  return field->offset;
}

/// Points of several clouds with the same fields, one after another, with the field `sensor_index`
/// (uint8) behind the others.
class MergedCloud {
 public:
  /// How a cloud becomes part of the merged one.
  struct Part {
    std::uint8_t sensor_index{};
    /// From the cloud's axes to those of the merged cloud; may mirror.
    Transform merged_from_cloud = Transform::Identity();
    std::uint32_t later_ns{};  ///< Added to the field time_ns, if there is one.
  };

  /// Adds the points of a cloud; slots without a point (x is NaN) are left out.
  /// @pre The cloud has the fields x, y and z as float32, and those of the clouds before it.
  void Add(const Cloud& cloud, const Part& part);

  [[nodiscard]] std::uint32_t num_points() const { return merged_.width; }

  /// Returns a PCD file, binary or LZF-compressed, with HEIGHT 1.
  [[nodiscard]] std::string Pcd(bool is_compressed) const;

 private:
  Cloud merged_;
};

void MergedCloud::Add(const Cloud& cloud, const Part& part) {
  const std::size_t step = cloud.point_step;
  if (merged_.fields.empty()) {
    merged_.fields = cloud.fields;
    merged_.point_step = cloud.point_step;
    merged_.AddField(std::string(kSensorIndexField), NumberType::kUint8);
    merged_.height = 1;
  }
  Check(merged_.point_step == step + 1, "clouds that are merged have the same fields");
  const std::size_t x = OffsetOf(cloud, "x");
  const std::size_t y = OffsetOf(cloud, "y");
  const std::size_t z = OffsetOf(cloud, "z");
  const CloudField* const time = cloud.Find("time_ns");
  const std::size_t num_slots = cloud.num_points();
  merged_.data.reserve(merged_.data.size() + num_slots * (step + 1));
  for (std::size_t slot = 0; slot < num_slots; ++slot) {
    const char* const from = cloud.Row(slot).data();
    if (std::isnan(LoadAt<float>(from + x))) continue;
    const std::size_t begin = merged_.data.size();
    merged_.data.insert(merged_.data.end(), from, from + step);
    merged_.data.push_back(part.sensor_index);
    char* const to = reinterpret_cast<char*>(merged_.data.data() + begin);
    const Vector3 point =
        part.merged_from_cloud *
        Vector3(LoadAt<float>(from + x), LoadAt<float>(from + y), LoadAt<float>(from + z));
    StoreAt<float>(to + x, point.x());
    StoreAt<float>(to + y, point.y());
    StoreAt<float>(to + z, point.z());
    if (time != nullptr) {
      const std::size_t offset = time->offset;
      StoreAt<std::uint32_t>(to + offset, LoadAt<std::uint32_t>(from + offset) + part.later_ns);
    }
  }
  merged_.width = static_cast<std::uint32_t>(merged_.data.size() / merged_.point_step);
}

std::string MergedCloud::Pcd(bool is_compressed) const {
  return EncodePcd(merged_, is_compressed);
}

// From the axes of a sensor's points to those of the merged cloud. Points in vehicle or world axes
// stay as they are.
Transform MergedFromCloud(const ScenarioSpec& scenario) {
  if (scenario.output.frame != OutputFrame::kSensor) return Transform::Identity();
  Transform vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount);
  if (scenario.output.handedness == Handedness::kRight) return vehicle_from_sensor;
  const Transform mirror(Eigen::Scaling(1.0, -1.0, 1.0));
  return mirror * vehicle_from_sensor * mirror;
}

// The frames of a sensor's run that begin in a span of time.
std::vector<std::uint32_t> FramesWithin(const MergedSensor& sensor,
                                        std::int64_t begin_ns,
                                        std::int64_t end_ns) {
  const SequenceSpec& spec = sensor.plan.spec;
  const auto stamp_ns = [&](std::uint32_t i) { return sensor.pattern.StampNs(spec.FrameAt(i)); };
  const auto all = std::views::iota(std::uint32_t{0}, spec.num_frames);
  std::vector<std::uint32_t> frames;
  for (auto i = std::ranges::partition_point(
           all, [&](std::uint32_t frame) { return stamp_ns(frame) < begin_ns; });
       i != all.end() && stamp_ns(*i) < end_ns; ++i) {
    frames.push_back(spec.FrameAt(*i));
  }
  return frames;
}

std::string CloudName(const SequenceSpec& spec, std::uint32_t frame) {
  return FrameFileNames(*spec.files.format, frame).front();
}

/// Writes the merged clouds and the lines about them, which are not kept: there may be millions.
class MergedWriter {
 public:
  MergedWriter(const fs::path& directory, std::vector<MergedSensor> sensors)
      : folder_(directory / kMergedFolder),
        sensors_(std::move(sensors)),
        first_(sensors_.front().plan) {}

  bool Write(const std::function<void(double)>& on_progress,
             const std::function<bool()>& is_stopped) {
    constexpr std::uint32_t kAtOnce = 256;
    fs::create_directories(folder_);
    const UnfinishedFile poses(folder_ / kPosesFile, 0), merged(folder_ / kMergedFile, 0);
    LineReader own_poses(first_.spec.directory / kPosesFile);
    static_cast<void>(own_poses.Need());
    poses.Append(std::as_bytes(std::span(kPosesHeader)));
    const std::uint32_t num_frames = first_.spec.num_frames;
    for (std::uint32_t begin = 0; begin < num_frames; begin += kAtOnce) {
      std::vector<std::string> lines(std::min(kAtOnce, num_frames - begin));
      std::atomic<bool> stops = false;
      tbb::parallel_for(std::size_t{0}, lines.size(), [&](std::size_t i) {
        if (stops || is_stopped()) {
          stops = true;
          return;
        }
        lines[i] = WriteCloud(begin + static_cast<std::uint32_t>(i));
        const std::lock_guard lock(mutex_);
        on_progress(static_cast<double>(++num_done_) / static_cast<double>(num_frames));
      });
      if (stops) return false;
      for (const std::string& line : lines) merged.Append(std::as_bytes(std::span(line)));
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string line = Pose(begin + static_cast<std::uint32_t>(i), own_poses.Need());
        poses.Append(std::as_bytes(std::span(line)));
      }
    }
    poses.Finish();
    merged.Finish();
    return true;
  }

 private:
  // Returns the line about it.
  std::string WriteCloud(std::uint32_t i) const {
    const MergedFrame frame = MergedFrameOf(sensors_, i);
    MergedCloud cloud;
    MergedRecord line{.frame = frame.parts.front().frame, .stamp_ns = frame.stamp_ns, .file = {}};
    for (const MergedFrame::Part& part : frame.parts) {
      const auto& [name, scenario, spec] = sensors_[part.sensor].plan;
      cloud.Add(ReadCloud(spec.directory / CloudName(spec, part.frame)),
                {.sensor_index = static_cast<std::uint8_t>(part.sensor),
                 .merged_from_cloud = MergedFromCloud(scenario),
                 .later_ns = part.later_ns});
      line.parts.push_back({name, part.frame, part.later_ns});
    }
    const std::string name = CloudName(first_.spec, frame.parts.front().frame);
    const std::string bytes = cloud.Pcd(first_.spec.files.format->name == kCompressed);
    fs::create_directories((folder_ / name).parent_path());
    WriteFileWhole(folder_ / name, bytes);
    line.file = {name, ContentHash(bytes), bytes.size()};
    line.points = cloud.num_points();
    return RecordText(line) + "\n";
  }

  // The vehicle's pose by the nominal mount of the first sensor, whose pose is recorded.
  [[nodiscard]] std::string Pose(std::uint32_t i, const PlacedLine& own) const {
    const std::int64_t stamp_ns = sensors_.front().pattern.StampNs(first_.spec.FrameAt(i));
    const Transform world_from_sensor = ReadPoseLine(own.text, stamp_ns, own.place);
    return PoseLine(
        {stamp_ns, world_from_sensor * VehicleFromSensor(first_.scenario.lidar.mount).inverse()});
  }

  fs::path folder_;
  std::vector<MergedSensor> sensors_;
  const SensorPlan& first_;
  std::mutex mutex_;
  std::size_t num_done_ = 0;
};

// What sensors.json says: where each sensor is by its nominal mount, and the hashes of the
// manifests and of the merged files.
SensorsRecord SensorsRecordOf(const RunPlan& plan, bool is_merged) {
  SensorsRecord record;
  for (const auto& [name, scenario, spec] : plan.sensors) {
    const Transform vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount);
    record.sensors.push_back({.name = name,
                              .folder = name,
                              .rate_hz = scenario.lidar.scan.rate_hz,
                              .phase_s = scenario.lidar.scan.phase_s,
                              .start_frame = spec.start_frame,
                              .num_frames = spec.num_frames,
                              .stride = spec.stride,
                              .vehicle_from_sensor = {vehicle_from_sensor.translation(),
                                                      CanonicalRotation(vehicle_from_sensor)},
                              .manifest_hash = HashFile(spec.directory / kManifestFile).hash});
  }
  if (!is_merged) return record;
  MergedFolderRecord& merged = record.merged.emplace();
  merged.folder = kMergedFolder;
  for (const std::string_view file : {kMergedFile, kPosesFile}) {
    merged.files.emplace_back(file, HashFile(plan.directory / kMergedFolder / file).hash);
  }
  return record;
}

// Whether a run's merged clouds are there as they were written.
bool IsMerged(const fs::path& directory) {
  try {
    const auto merged = MergedFolderIn(directory);
    if (!merged) return false;
    for (const KnownFile& file : merged->files) {
      if (HashFile(merged->folder / file.name).hash != file.hash) return false;
    }
    LineReader lines(merged->folder / kMergedFile);
    while (const auto line = lines.Next()) {
      const auto record = ReadRecordLine<MergedRecord>(line->text, line->place);
      if (!HasContent(merged->folder, record.file)) return false;
    }
    return true;
  } catch (const InputError&) {
    return false;  // They cannot be read.
  }
}

// Removes what an interrupted run has left beside the files about all sensors.
void RemoveUnfinished(const fs::path& directory) {
  std::vector<fs::path> unfinished;
  const fs::path merged = directory / kMergedFolder;
  for (const fs::path& folder : {directory, merged, merged / "frames"}) {
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const fs::path& file = entry.path();
      const bool is_left = file.extension() == kUnfinishedSuffix && !entry.is_directory();
      if (is_left && fs::exists(folder / file.stem())) unfinished.push_back(file);
    }
  }
  for (const fs::path& file : unfinished) fs::remove(file);
}

}  // namespace

MergedFrame MergedFrameOf(std::span<const MergedSensor> sensors, std::uint32_t i) {
  const MergedSensor& first = sensors.front();
  const std::uint32_t frame = first.plan.spec.FrameAt(i);
  const std::int64_t begin_ns = first.pattern.StampNs(frame);
  const std::int64_t end_ns = first.pattern.StampNs(frame + 1);
  MergedFrame made{begin_ns, {}};
  for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
    for (const std::uint32_t part : FramesWithin(sensors[sensor], begin_ns, end_ns)) {
      const std::int64_t later_ns = sensors[sensor].pattern.StampNs(part) - begin_ns;
      made.parts.push_back({sensor, part, static_cast<std::uint32_t>(later_ns)});
    }
  }
  return made;
}

void CheckCanMerge(const FrameMaker& maker, const RunPlan& plan) {
  const std::vector<MergedSensor> sensors = MergedSensorsOf(maker, plan);
  constexpr std::size_t kMostSensors = std::numeric_limits<std::uint8_t>::max() + std::size_t{1};
  const MergedSensor& first = sensors.front();
  const FrameFileSpec& files = first.plan.spec.files;
  const auto fail = [](const std::string& rule, const std::string& got) {
    throw InputError("--merged: must be with " + rule + " (got " + got + ")");
  };
  if (sensors.size() == 1) fail("several sensors", "one");
  if (sensors.size() > kMostSensors) {
    fail("at most " + std::to_string(kMostSensors) + " sensors", std::to_string(sensors.size()));
  }
  if (files.format->name != "pcd" && files.format->name != kCompressed) {
    fail("--format pcd or " + std::string(kCompressed), std::string(files.format->name));
  }
  for (const char* const axis : {"x", "y", "z"}) {
    if (!files.fields.Has(axis)) fail("--fields x, y and z", files.fields.Text());
  }
  std::uint32_t longest_ns = 0;
  for (const auto& [plan_of_sensor, pattern] : sensors) {
    const std::string& name = plan_of_sensor.name;
    if (name == kMergedFolder) fail("sensors of other names", Quoted(name));
    if (plan_of_sensor.spec.files.fields != files.fields) {
      fail("--fields that all sensors have", plan_of_sensor.spec.files.fields.Text());
    }
    longest_ns = std::max(longest_ns, pattern.time_ns.back());
  }
  // The times of points are counted from the first sensor's stamp, in 32 bits.
  const std::int64_t last_ns = first.pattern.PeriodNs() + longest_ns;
  if (last_ns > std::numeric_limits<std::uint32_t>::max()) {
    fail("a first sensor whose frames and those that begin meanwhile end within 4.29 s",
         NumberText(SecondsFromNs(last_ns)) + " s");
  }
}

std::optional<std::string> FaultOfList(const RunPlan& plan) {
  const fs::path file = plan.directory / kSensorsFile;
  if (!plan.is_in_folders() || !fs::exists(file)) return std::nullopt;
  const std::string text = ReadFileWhole(file);
  if (text == WithoutManifestHash(text)) return std::nullopt;
  ErrorList faults;
  if (Attempt("", faults, [&] { return CheckManifestHash(text, ShownPath(file)), true; })) {
    return std::nullopt;
  }
  return faults.lines().front();
}

bool FinishRun(const FrameMaker& maker,
               const RunPlan& plan,
               const std::function<void(double)>& on_progress,
               const std::function<bool()>& is_stopped) {
  if (!plan.is_in_folders()) return true;
  // What was merged before stays so.
  const bool is_merged = plan.is_merged || fs::exists(plan.directory / kMergedFolder / kMergedFile);
  if (is_merged && !IsMerged(plan.directory)) {
    MergedWriter writer(plan.directory, MergedSensorsOf(maker, plan));
    bool is_complete = false;
    maker.simulator(0).Execute([&] { is_complete = writer.Write(on_progress, is_stopped); });
    if (!is_complete) return false;
  }
  WriteFileWhole(plan.directory / kSensorsFile, SensorsText(SensorsRecordOf(plan, is_merged)));
  RemoveUnfinished(plan.directory);
  return true;
}

}  // namespace railcast
