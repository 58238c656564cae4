#include "generator/run/run_plan.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/certify/certifier.h"
#include "core/io/cloud/track_fields.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/known_names.h"
#include "core/io/write_file.h"
#include "core/program/version.h"
#include "core/scenario/track_limits.h"
#include "core/trace/trace_program.h"

namespace railcast {
namespace {

bool IsNameOfAFolder(const std::string& name) {
  return name.size() <= 200 && name != "." && name != ".." && name != kSensorsFile &&
         name.find('/') == std::string::npos;
}

// Checks that this build has what makes the format.
void CheckHasExtra(const FrameFormat& format) {
  const RunExtras& extras = RunExtras::Get();
  const bool lacks_bags = !format.bag.empty() && extras.find_bag == nullptr;
  if (!lacks_bags && (format.trace.empty() || extras.plan_trace != nullptr)) return;
  throw LacksExtra("--format " + std::string(format.name), lacks_bags ? "ros" : "osi");
}

// Chooses what is stored of each point.
void ChooseFields(const std::string& fields, SensorPlan& sensor) {
  const FrameFormat& format = *sensor.spec.files.format;
  const RunExtras& extras = RunExtras::Get();
  if (!format.bag.empty()) {
    extras.plan_bag(fields, sensor);
  } else if (std::ranges::find(extras.layouts, fields) != extras.layouts.end()) {
    throw InputError("--fields " + fields + ": must be with --format mcap or rosbag2 (got " +
                     std::string(format.name) + ")");
  } else {
    sensor.spec.files.fields =
        FieldSelection(fields, sensor.scenario.lidar.velocity.has_value(), true);
  }
}

// Tells the fields of the track, if any are chosen, where the track is.
void SetTrack(const FrameMaker& maker, const RunPlan& plan, SensorPlan& sensor) {
  FieldSelection& fields = sensor.spec.files.fields;
  if (!fields.NeedsTrack()) return;
  const ScenarioSpec& scenario = sensor.scenario;
  // The clouds of a bag share their fields, and these the sensor's place in the vehicle.
  if (plan.is_in_folders() && !sensor.spec.bag.empty() &&
      scenario.output.frame == OutputFrame::kVehicle) {
    throw InputError("--fields " + fields.Text() +
                     ": must be without fields of the track where several sensors have their "
                     "points in the vehicle's axes in one bag");
  }
  fields.SetTrack(std::make_shared<const FrameTrack>(
      FrameTrack{OwnTrack(*maker.StateAt(0).world, scenario.world.catenary), scenario.output,
                 VehicleFromSensor(scenario.lidar.mount)}));
}

// Plans the sequence of a sensor.
// @param reduced The scenario with this sensor alone.
SensorPlan PlanSensor(const std::string& name,
                      ScenarioSpec reduced,
                      const RunChoices& choices,
                      const std::string& shown) {
  SensorPlan sensor{name, std::move(reduced), {}};
  const ScenarioSpec& scenario = sensor.scenario;
  SequenceSpec& spec = sensor.spec;
  spec.directory = choices.directory;
  spec.version = ProgramVersion();
  spec.embree_version = EmbreeVersion();
  spec.isa = AtPlace("--", [&] { return IsaInUse(choices.isa); });
  spec.identity = IdentityOf(scenario);
  spec.seed = scenario.seed;
  spec.files.format = &ParseFrameFormat(choices.format);
  CheckHasExtra(*spec.files.format);
  if (!spec.files.format->trace.empty()) RunExtras::Get().check_trace(choices);
  ChooseFields(choices.fields, sensor);
  const std::optional<DatasetLayout>& dataset = spec.files.format->dataset;
  const bool is_sensor_frame = scenario.output.frame == OutputFrame::kSensor &&
                               scenario.output.handedness == Handedness::kRight;
  if (dataset && !is_sensor_frame) {
    throw InputError(shown + ": /output: must be right-handed sensor coordinates for --format " +
                     choices.format + " (got " + std::string(NameOf(scenario.output.handedness)) +
                     "-handed " + std::string(NameOf(scenario.output.frame)) + ")");
  }
  if (dataset && choices.fields != "all") {
    throw InputError("--fields: " + std::string(dataset->title) +
                     "'s are fixed, so it must be left out with --format " + choices.format +
                     " (got " + choices.fields + ")");
  }
  spec.files.labels = LabelTable(scenario.labels);
  spec.materials = MaterialLibrary(scenario.materials);
  if (scenario.camera) {
    spec.camera = scenario.camera->name;
    spec.calibration_json = CalibrationJson(*scenario.camera, VehicleFromCamera(scenario),
                                            VehicleFromSensor(scenario.lidar.mount));
  }
  spec.motion_sensors = scenario.motion_sensors;
  spec.start_frame = choices.start_frame;
  spec.num_frames = choices.num_frames;
  spec.stride = choices.stride;
  if (const auto share = CertifiedShareOf(choices.certify)) spec.certify = {.cost_share = *share};
  return sensor;
}

// The last frame of a sensor's sequence.
std::uint32_t LastFrameOf(const SequenceSpec& spec, const ScanPattern& pattern) {
  constexpr std::uint64_t kMost = 2 * kMaxFrame;
  const std::uint64_t last =
      spec.start_frame + std::uint64_t{spec.num_frames - 1} * std::uint64_t{spec.stride};
  if (last > kMost) {
    throw InputError("--start-frame, --frames, --stride: must not lead beyond frame " +
                     std::to_string(kMost) + " (got frame " + std::to_string(last) + ")");
  }
  const auto last_frame = static_cast<std::uint32_t>(last);
  CheckHasStamp("--start-frame, --frames", pattern, last_frame);
  return last_frame;
}

// Chooses every `stride`-th of the sensor's frames that begin in a span of time, from the first one
// that does.
void ChooseFrames(const SequenceSpec& first,
                  std::int64_t begin_ns,
                  std::int64_t end_ns,
                  const ScanPattern& pattern,
                  SensorPlan& sensor) {
  const std::uint32_t most = pattern.LastFrame();
  const std::uint32_t begin = FirstStampedAt(pattern, begin_ns, 0, most);
  const std::uint32_t end = FirstStampedAt(pattern, end_ns, begin, most);
  if (begin == end) {
    throw InputError("--frames: must last until a frame of sensor " + Quoted(sensor.name) +
                     " begins, " + SecondsText(pattern.StampNs(begin)) + " (got " +
                     std::to_string(first.num_frames) + " of the first sensor, to " +
                     SecondsText(end_ns) + ")");
  }
  sensor.spec.start_frame = begin;
  sensor.spec.num_frames = (end - begin + sensor.spec.stride - 1) / sensor.spec.stride;
  static_cast<void>(LastFrameOf(sensor.spec, pattern));
}

// Whether the name is that of the run's bag, complete or not, or of what tells of it.
bool IsOwnBag(const RunPlan& plan, std::string_view name) {
  const std::string_view bag = plan.sensors.front().spec.files.format->bag;
  if (bag.empty()) return false;
  return name == bag || name == kBagLinesFile ||
         name == std::string(bag) + std::string(kUnfinishedSuffix);
}

/// Refuses a folder that holds anything but known entries, which may be unfinished files; one that
/// is not there holds nothing.
/// @param is_known Called with the name of each entry, once it is finished.
/// @param known What may be there, for the message.
template <typename IsKnown>
void RefuseOtherEntries(const std::filesystem::path& folder,
                        const IsKnown& is_known,
                        const std::string& known) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    const auto finished = entry.is_directory() ? std::nullopt : FinishedName(name);
    if (is_known(std::string(finished.value_or(name)))) continue;
    throw InputError(ShownPath(folder) + ": must hold nothing but " + known + " (got " +
                     Quoted(name) + ")");
  }
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

RunPlan PlanRun(ScenarioSpec scenario, const RunChoices& choices, const std::string& shown) {
  CheckNamesOfFolders(scenario);
  RunPlan plan{choices.directory, choices.is_merged, std::move(scenario), {}, {}, {}};
  for (const std::string& name : SensorNames(plan.scenario)) {
    ScenarioSpec reduced = PickSensor(plan.scenario, name);
    if (!plan.sensors.empty()) {
      reduced.camera.reset();
      reduced.motion_sensors.reset();
    }
    SequenceSpec& spec =
        plan.sensors.emplace_back(PlanSensor(name, std::move(reduced), choices, shown)).spec;
    if (!plan.scenario.lidars.empty()) spec.directory /= name;
    if (plan.sensors.size() > 1) spec.twin = plan.sensors.front().spec.directory;
    const std::string_view bag = spec.files.format->bag;
    if (bag.empty()) continue;
    spec.bag = (plan.directory / bag).lexically_relative(spec.directory).generic_string();
  }
  return plan;
}

void RefuseOtherFiles(const RunPlan& plan) {
  const auto is_of_run = [&](const std::string& name) {
    return name == kSensorsFile || name == kMergedFolder || IsOwnBag(plan, name) ||
           std::ranges::find(plan.sensors, name, &SensorPlan::name) != plan.sensors.end();
  };
  RefuseOtherEntries(plan.directory, is_of_run,
                     "the folders of the scenario's sensors and " + std::string(kSensorsFile));
  if (!plan.is_merged) return;
  // A merged cloud has the name of the first sensor's frame.
  const SequenceSpec& first = plan.sensors.front().spec;
  KnownNames clouds;
  for (std::uint32_t i = 0; i < first.num_frames; ++i) {
    clouds.insert(FrameFileNames(*first.files.format, first.FrameAt(i)).front());
  }
  const auto is_merged = [](const std::string& name) {
    return name == "frames" || name == kPosesFile || name == kMergedFile;
  };
  const auto is_cloud = [&](const std::string& name) { return clouds.contains("frames/" + name); };
  const std::filesystem::path merged = plan.directory / kMergedFolder;
  RefuseOtherEntries(merged, is_merged, "merged clouds");
  RefuseOtherEntries(merged / "frames", is_cloud, "merged clouds");
}

void UseCommands(const std::filesystem::path& log, const ScenarioSpec& whole, RunPlan& plan) {
  CommandLog read = ReadCommandLog(log, whole.models);
  plan.commands_place = ShownPath(log) + ": ";
  const std::string hash = IdentityOf(whole).scenario_hash;
  const bool is_whole = whole.lidars.size() == plan.scenario.lidars.size();
  if (read.scenario_xxh3 != hash &&
      (is_whole || read.scenario_xxh3 != plan.sensors.front().spec.identity.scenario_hash)) {
    throw InputError(plan.commands_place +
                     "must be the log of this scenario with this --seed and --fidelity, " + hash +
                     " (got that of " + read.scenario_xxh3 + ")");
  }
  // Makes logs of all sensors and of this one alone give the same run.
  read.scenario_xxh3 = hash;
  // An empty log makes the same run as no log.
  for (SensorPlan& sensor : plan.sensors) {
    if (!read.commands.empty()) sensor.spec.commands_jsonl = CommandLogText(read);
  }
  plan.commands = std::move(read.commands);
}

void SetFrames(const FrameMaker& maker, RunPlan& plan) {
  const SequenceSpec& first = plan.sensors.front().spec;
  const ScanPattern& first_pattern = maker.pattern(0);
  const std::int64_t begin_ns = first_pattern.StampNs(first.start_frame);
  const std::int64_t end_ns = first_pattern.StampNs(LastFrameOf(first, first_pattern) + 1);
  for (std::size_t i = 1; i < plan.sensors.size(); ++i) {
    ChooseFrames(first, begin_ns, end_ns, maker.pattern(i), plan.sensors[i]);
  }
  for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
    if (!plan.sensors[i].spec.files.format->trace.empty()) {
      RunExtras::Get().plan_trace(maker, i, plan.sensors[i]);
    }
    SetTrack(maker, plan, plan.sensors[i]);
  }
}

void CheckHasStamp(const std::string& option, const ScanPattern& pattern, std::uint32_t frame) {
  if (frame <= pattern.LastFrame()) return;
  std::string line = option;
  line.append(": must not lead beyond frame ").append(std::to_string(pattern.LastFrame()));
  line.append(", since the next begins after 292 years at ").append(NumberText(pattern.rate_hz));
  line.append(" Hz (got frame ").append(std::to_string(frame)).append(")");
  throw InputError(line);
}

}  // namespace railcast
