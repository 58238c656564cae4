#include "generator/run/merged_clouds.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <ranges>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/content_hash.h"
#include "core/io/merged_files.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"
#include "generator/empty_folder.h"
#include "generator/record/pose_record.h"
#include "generator/sequence/merged_cloud.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCompressed = "pcd-compressed";

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
  const SequenceSpec& spec = sensor.run.spec;
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

class MergedWriter {
 public:
  MergedWriter(const fs::path& directory, std::span<const MergedSensor> sensors)
      : folder_(directory / kMergedFolder), sensors_(sensors), frames_(MergedFramesOf(sensors)) {}

  [[nodiscard]] bool is_complete() const { return fs::exists(folder_ / kMergedFile); }

  bool Write(const std::function<void(double)>& on_progress,
             const std::function<bool()>& is_stopped) {
    RefuseOtherFiles();
    lines_.resize(frames_.size());
    std::atomic<bool> stops = false;
    tbb::parallel_for(std::size_t{0}, frames_.size(), [&](std::size_t i) {
      if (stops || is_stopped()) {
        stops = true;
        return;
      }
      lines_[i] = WriteCloud(frames_[i]);
      const std::lock_guard lock(mutex_);
      on_progress(static_cast<double>(++num_done_) / static_cast<double>(frames_.size()));
    });
    if (stops) return false;
    WriteFileWhole(folder_ / kPosesFile, Poses());
    std::string all;
    for (const std::string& line : lines_) all += line;
    WriteFileWhole(folder_ / kMergedFile, all);
    return true;
  }

 private:
  // Files of another run would be taken for this run's.
  void RefuseOtherFiles() const {
    const auto is_known = [](const std::string& name) {
      return name == "frames" || name.starts_with(kPosesFile) || name.starts_with(kMergedFile);
    };
    RefuseOtherEntries(folder_, is_known, "merged clouds");
  }

  // Returns the line about it.
  std::string WriteCloud(const MergedFrame& frame) const {
    MergedCloud cloud;
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (const MergedFrame::Part& part : frame.parts) {
      const auto& [name, scenario, spec] = sensors_[part.sensor].run;
      cloud.Add(ReadPcd(spec.directory / CloudName(spec, part.frame)),
                {.sensor_index = static_cast<std::uint8_t>(part.sensor),
                 .merged_from_cloud = MergedFromCloud(scenario),
                 .later_ns = part.later_ns});
      parts.push_back({{"sensor", name}, {"frame", part.frame}, {"later_ns", part.later_ns}});
    }
    const SequenceSpec& first = sensors_.front().run.spec;
    const std::string name = CloudName(first, frame.parts.front().frame);
    const std::string bytes = cloud.Pcd(first.files.format->name == kCompressed);
    fs::create_directories((folder_ / name).parent_path());
    WriteFileWhole(folder_ / name, bytes);
    const nlohmann::ordered_json line = {{"frame", frame.parts.front().frame},
                                         {"stamp_ns", frame.stamp_ns},
                                         {"file", name},
                                         {"bytes", bytes.size()},
                                         {"xxh3", ContentHash(bytes)},
                                         {"points", cloud.num_points()},
                                         {"parts", std::move(parts)}};
    return line.dump() + "\n";
  }

  // The vehicle's poses by the nominal mount of the first sensor, whose poses are recorded.
  [[nodiscard]] std::string Poses() const {
    const SensorRun& first = sensors_.front().run;
    const Transform sensor_from_vehicle = VehicleFromSensor(first.scenario.lidar.mount).inverse();
    LineReader lines(first.spec.directory / kPosesFile);
    static_cast<void>(lines.Need());
    std::string text(kPosesHeader);
    for (const MergedFrame& frame : frames_) {
      const PlacedLine line = lines.Need();
      const Transform world_from_sensor = ReadPoseLine(line.text, frame.stamp_ns, line.place);
      text += PoseLine({frame.stamp_ns, world_from_sensor * sensor_from_vehicle});
    }
    return text;
  }

  fs::path folder_;
  std::span<const MergedSensor> sensors_;
  std::vector<MergedFrame> frames_;
  std::vector<std::string> lines_;
  std::mutex mutex_;
  std::size_t num_done_ = 0;
};

}  // namespace

std::vector<MergedSensor> MergedSensorsOf(const std::vector<std::unique_ptr<Simulator>>& simulators,
                                          std::span<const SensorRun> runs) {
  std::vector<MergedSensor> sensors;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    sensors.push_back({runs[i], simulators[i]->pattern()});
  }
  return sensors;
}

std::vector<MergedFrame> MergedFramesOf(std::span<const MergedSensor> sensors) {
  const MergedSensor& first = sensors.front();
  std::vector<MergedFrame> merged;
  for (std::uint32_t i = 0; i < first.run.spec.num_frames; ++i) {
    const std::uint32_t frame = first.run.spec.FrameAt(i);
    const std::int64_t begin_ns = first.pattern.StampNs(frame);
    const std::int64_t end_ns = first.pattern.StampNs(frame + 1);
    MergedFrame made{begin_ns, {}};
    for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
      for (const std::uint32_t part : FramesWithin(sensors[sensor], begin_ns, end_ns)) {
        const std::int64_t later_ns = sensors[sensor].pattern.StampNs(part) - begin_ns;
        made.parts.push_back({sensor, part, static_cast<std::uint32_t>(later_ns)});
      }
    }
    merged.push_back(std::move(made));
  }
  return merged;
}

void CheckCanMerge(std::span<const MergedSensor> sensors) {
  constexpr std::size_t kMostSensors = std::numeric_limits<std::uint8_t>::max() + std::size_t{1};
  const MergedSensor& first = sensors.front();
  const FrameFileSpec& files = first.run.spec.files;
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
  for (const auto& [run, pattern] : sensors) {
    if (run.name == kMergedFolder) fail("sensors of other names", Quoted(run.name));
    longest_ns = std::max(longest_ns, pattern.time_ns.back());
  }
  // The times of points are counted from the first sensor's stamp, in 32 bits.
  const std::int64_t last_ns = first.pattern.PeriodNs() + longest_ns;
  if (last_ns > std::numeric_limits<std::uint32_t>::max()) {
    fail("a first sensor whose frames and those that begin meanwhile end within 4.29 s",
         NumberText(SecondsFromNs(last_ns)) + " s");
  }
}

bool WriteMergedClouds(const fs::path& directory,
                       std::span<const MergedSensor> sensors,
                       const std::function<void(double)>& on_progress,
                       const std::function<bool()>& is_stopped) {
  MergedWriter writer(directory, sensors);
  return writer.is_complete() || writer.Write(on_progress, is_stopped);
}

}  // namespace railcast
