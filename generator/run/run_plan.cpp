#include "generator/run/run_plan.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/merged_files.h"
#include "core/io/sensor_folders.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"
#include "core/scenario/track_limits.h"
#include "generator/empty_folder.h"
#include "generator/record/pose_record.h"

namespace railcast {
namespace {

bool IsNameOfAFolder(const std::string& name) {
  return name.size() <= 200 && name != "." && name != ".." && name != kSensorsFile &&
         name.find('/') == std::string::npos;
}

std::vector<double> Components(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return {vector.begin(), vector.end()};
}

}  // namespace

void CheckNamesOfFolders(const ScenarioSpec& scenario) {
  if (scenario.lidars.empty()) return;
  for (const std::string& name : SensorNames(scenario)) {
    if (IsNameOfAFolder(name)) continue;
    throw InputError("sensor: must be chosen, because a sensor's name is no name of a folder (" +
                     Quoted(name) + ")");
  }
}

std::vector<SensorRun> SensorRunsOf(const ScenarioSpec& scenario, const SequenceChoices& choices) {
  std::vector<SensorRun> runs;
  if (scenario.lidars.empty()) {
    runs.push_back({scenario.lidar.name, scenario, SequenceSpecOf(scenario, choices)});
    return runs;
  }
  CheckNamesOfFolders(scenario);
  for (const std::string& name : SensorNames(scenario)) {
    ScenarioSpec reduced = PickSensor(scenario, name);
    if (!runs.empty()) reduced.camera.reset();
    SequenceChoices own = choices;
    own.directory = choices.directory / name;
    SequenceSpec spec = SequenceSpecOf(reduced, own);
    runs.push_back({name, std::move(reduced), std::move(spec)});
  }
  return runs;
}

void SetFrames(const SequenceSpec& first,
               const ScanPattern& first_pattern,
               const ScanPattern& pattern,
               SensorRun& run) {
  const std::int64_t begin_ns = first_pattern.StampNs(first.start_frame);
  const std::int64_t end_ns = first_pattern.StampNs(first.FrameAt(first.num_frames - 1) + 1);
  const std::uint32_t most = pattern.LastFrame();
  const std::uint32_t begin = FirstStampedAt(pattern, begin_ns, 0, most);
  const std::uint32_t end = FirstStampedAt(pattern, end_ns, begin, most);
  if (begin == end) {
    throw InputError("--frames: must last until a frame of sensor " + Quoted(run.name) +
                     " begins, " + SecondsText(pattern.StampNs(begin)) + " (got " +
                     std::to_string(first.num_frames) + " of the first sensor, to " +
                     SecondsText(end_ns) + ")");
  }
  run.spec.start_frame = begin;
  run.spec.num_frames = (end - begin + run.spec.stride - 1) / run.spec.stride;
}

void RefuseOtherFiles(const std::filesystem::path& directory, const std::vector<SensorRun>& runs) {
  const auto is_known = [&](const std::string& name) {
    return name == kSensorsFile || name == kMergedFolder ||
           std::any_of(runs.begin(), runs.end(),
                       [&](const SensorRun& run) { return run.name == name; });
  };
  RefuseOtherEntries(directory, is_known,
                     "the folders of the scenario's sensors and " + std::string(kSensorsFile));
}

std::string SensorsJson(const std::vector<SensorRun>& runs,
                        const std::optional<std::filesystem::path>& merged) {
  nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
  for (const SensorRun& run : runs) {
    const Transform vehicle_from_sensor = VehicleFromSensor(run.scenario.lidar.mount);
    const Eigen::Quaterniond rotation = CanonicalRotation(vehicle_from_sensor);
    sensors.push_back({{"name", run.name},
                       {"folder", run.name},
                       {"rate_hz", run.scenario.lidar.scan.rate_hz},
                       {"phase_s", run.scenario.lidar.scan.phase_s},
                       {"start_frame", run.spec.start_frame},
                       {"num_frames", run.spec.num_frames},
                       {"stride", run.spec.stride},
                       {"vehicle_from_sensor",
                        {{"translation_m", Components(vehicle_from_sensor.translation())},
                         {"quaternion_xyzw", Components(rotation.coeffs())}}}});
  }
  nlohmann::ordered_json all = {{"version", 1}, {"sensors", std::move(sensors)}};
  if (merged) {
    nlohmann::ordered_json hashes = nlohmann::ordered_json::object();
    for (const std::string_view name : {kMergedFile, kPosesFile}) {
      hashes[std::string(name)] = ContentHash(ReadFileWhole(*merged / name));
    }
    all["merged"] = {{"folder", merged->filename().string()}, {"files_xxh3", std::move(hashes)}};
  }
  return all.dump(2) + "\n";
}

}  // namespace railcast
