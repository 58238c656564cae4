#include "generator/extras/insert/insert_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/io/recording/found_sensor.h"
#include "core/io/recording/plausibility.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/io/sensor_tables.h"
#include "core/rail/line/line_place.h"
#include "core/scenario/json_source.h"
#include "core/scenario/ouster_metadata.h"
#include "core/track/track_survey.h"
#include "generator/extras/insert/intensity_scale.h"
#include "generator/extras/insert/plan/recorded_intensities.h"
#include "generator/extras/insert/plan/recorded_line.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "generator/extras/insert/plan/recorded_way.h"
#include "generator/extras/insert/plan/recorded_world.h"
#include "generator/extras/insert/plan/standing_things.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// What places are turned with.
struct PlacesOfRun {
  const RecordedWay& way;
  const RecordedLine& line;
  Transform vehicle_from_sensor;
  double length_m{};  ///< Length of the alignment.
};

void CountMotionFrom(double zero_s_m, std::optional<MotionSpec>& motion) {
  if (!motion) return;
  for (SpeedPoint& point : motion->profile) {
    if (point.s_m) *point.s_m += zero_s_m;
  }
  if (!motion->path) return;
  for (PathPoint& point : motion->path->points) {
    if (point.s_m) *point.s_m += zero_s_m;
  }
  if (motion->path->start_at_vehicle_s_m) *motion->path->start_at_vehicle_s_m += zero_s_m;
}

/// The place in the world of x_m and y_m in the sensor's axes, where they meet the vehicle's plane
/// z = 0.
Vector3 PlaceBeforeSensor(const PlacesOfRun& run, std::size_t frame, double x_m, double y_m) {
  const Transform& vehicle_from_sensor = run.vehicle_from_sensor;
  const double height_m = (vehicle_from_sensor * Vector3(x_m, y_m, 0.0)).z();
  const double z_m = -height_m / vehicle_from_sensor.linear()(2, 2);
  return run.way.at_frames[frame] * (vehicle_from_sensor * Vector3(x_m, y_m, z_m));
}

void PlaceByFrame(const PlacesOfRun& run,
                  const std::string& pointer,
                  ObjectSpec& object,
                  ErrorList& errors) {
  const std::size_t frame = *object.frame;
  const std::size_t num_frames = run.way.at_frames.size();
  if (frame >= num_frames) {
    errors.Add({pointer + "/frame",
                "must be a frame of the recording, 0 to " + NumberText(num_frames - 1),
                NumberText(frame)});
    return;
  }
  if (!object.x_m) {
    const double ahead_m = run.line.faces_up[frame] ? object.s_m : -object.s_m;
    object.s_m = run.line.at_frames_m[frame] + ahead_m;
    return;
  }
  if (run.line.alignment.map) {
    errors.Add({pointer + "/x_m",
                "must not be given beside frame: the alignment has a map, in which x_m counts",
                NumberText(*object.x_m)});
    return;
  }
  const Vector3 place_m = PlaceBeforeSensor(run, frame, *object.x_m, *object.y_m);
  object.x_m = place_m.x();
  object.y_m = place_m.y();
}

void PlaceThing(const PlacesOfRun& run,
                const std::string& pointer,
                ObjectSpec& object,
                ErrorList& errors) {
  const double zero_s_m = run.line.zero_s_m;
  const double given_s_m = object.s_m;
  const bool is_on_line = !object.x_m && !object.longitude_deg;
  const std::size_t num_before = errors.size();
  if (object.frame) {
    PlaceByFrame(run, pointer, object, errors);
  } else if (is_on_line) {
    object.s_m += zero_s_m;
  }
  object.frame.reset();
  CountMotionFrom(zero_s_m, object.motion);
  const bool may_begin_beyond = object.motion && !object.motion->path;
  if (!is_on_line || may_begin_beyond || errors.size() > num_before) return;
  if (object.s_m >= 0.0 && object.s_m <= run.length_m) return;
  errors.Add({pointer + "/s_m",
              "must put it on the line, between chainage " + ShortText(-zero_s_m) + " and " +
                  ShortText(run.length_m - zero_s_m) + " m",
              NumberText(given_s_m)});
}

/// Along a driven path, chainages of tracks would have to be turned, too.
void CheckTracks(const ScenarioSpec& plan, ErrorList& errors) {
  for (std::size_t i = 0; i < plan.world.tracks.size(); ++i) {
    const TrackSpec& track = plan.world.tracks[i];
    TrackSpec simple;
    simple.name = track.name;
    simple.offset_m = track.offset_m;
    simple.sleeper = track.sleeper;
    simple.electrified = track.electrified;
    if (track == simple) continue;
    errors.Add({plan.sources.Place("/world/tracks/" + std::to_string(i)),
                "must have only name and offset_m beside a driven path; others need "
                "/world/recording/alignment",
                Quoted(track.name)});
  }
}

/// Says where the plan wants an object: "frame 120, s_m 60, d_m 0.4".
std::string AskedPlace(const ObjectSpec& object) {
  std::string asked;
  const auto add = [&](const char* key, const auto& value) {
    asked += (asked.empty() ? "" : ", ") + std::string(key) + " " + NumberText(value);
  };
  if (object.frame) add("frame", *object.frame);
  if (object.x_m) {
    add("x_m", *object.x_m);
    add("y_m", object.y_m.value_or(0.0));
  } else if (object.longitude_deg) {
    add("longitude_deg", *object.longitude_deg);
    add("latitude_deg", object.latitude_deg.value_or(0.0));
  } else {
    add("s_m", object.s_m);
    add("d_m", object.d_m);
  }
  if (object.h_m) add("h_m", *object.h_m);
  return asked;
}

/// Turns the places of a plan's objects and trains, which count from the first frame, from where
/// the vehicle is in a frame or from the sensor there, into those of the line's alignment.
/// @throws InputError with a line for every fault: "plan.json: /world/objects/0/frame: rule (got
///   value)".
void PlaceThings(const RecordedWay& way, const RecordedLine& line, ScenarioSpec& plan) {
  ErrorList errors;
  const PlacesOfRun run{
      way, line, VehicleFromSensor(plan.lidar.mount) * NominalFromTrue(plan.lidar.mount_error),
      Alignment(line.alignment).length_m()};
  if (line.zero_s_m != 0.0) CheckTracks(plan, errors);
  for (std::size_t i = 0; i < plan.world.objects.size(); ++i) {
    const std::string pointer = "/world/objects/" + std::to_string(i);
    ErrorList faults;
    PlaceThing(run, pointer, plan.world.objects[i], faults);
    for (const Fault& fault : faults.faults()) errors.Add(plan.sources.Locate(fault, ""));
  }
  for (TrainSpec& train : plan.world.trains) {
    train.s_m += line.zero_s_m;
    CountMotionFrom(line.zero_s_m, train.motion);
  }
  errors.ThrowIfAny();
}

constexpr std::string_view kCaptureOf = "capture of ";

/// Reads the section of a sensor's file as if the plan named it.
LidarSpec ReadSensorFile(std::string_view text, const ScenarioSpec& plan) {
  auto scenario = nlohmann::json::parse(ResolvedScenarioJson(plan));
  auto lidar = nlohmann::json::parse(text);
  lidar.erase("version");
  lidar.erase("$schema");
  scenario["lidar"] = std::move(lidar);
  return ReadScenarioText(scenario.dump(), "plan.json").lidar;
}

std::optional<LidarSpec> SensorOfSequence(const RecordingInfo& info) {
  if (info.kind == kMergedKind) return std::nullopt;
  // Sequences into which something was put have a scenario, too.
  if (info.scenario) return info.scenario->lidar;
  if (!info.origin) return std::nullopt;
  const auto file = info.source / kScenarioFile;
  if (!exists(file)) return std::nullopt;
  return ReadScenario(file).lidar;
}

std::optional<LidarSpec> SensorOfCapture(const RecordingInfo& info, const ScenarioSpec& plan) {
  if (!info.kind.starts_with(kCaptureOf)) return std::nullopt;
  const std::string name = info.kind.substr(kCaptureOf.size());
  if (const auto text = SensorFileOf(name)) return ReadSensorFile(*text, plan);
  const auto capture = FindCapture(info.source);
  if (!capture || !capture->beside.metadata) return std::nullopt;
  LidarSpec lidar;
  UseOusterMetadata(ReadFileWhole(capture->beside.file), lidar);
  lidar.name = name;
  return lidar;
}

/// Gives a plan without a sensor the one that the points of the recording show.
/// @throws InputError "plan.json: /lidar: rule (got value)" if they show none.
void UseSensorOfPoints(const std::filesystem::path& recording,
                       const RecordingInfo& info,
                       ScenarioSpec& plan,
                       std::vector<std::string>& remarks) {
  try {
    const FoundSensor found = FindSensor(*OpenRecording(recording));
    plan.lidar = ReadSensorFile(found.FileText(), plan);
    const std::string axis = found.AxisText();
    remarks.push_back("the sensor is what the points show, with default range and power: the " +
                      std::string("plan's lidar may say otherwise: ") + found.Text() +
                      (axis.empty() ? "" : ", spins about " + axis + " of the recording's axes"));
  } catch (const InputError& error) {
    throw InputError(
        {{plan.sources.Place("/lidar"),
          "missing: this recording does not say which sensor made it, and " +
              std::string(error.what()) + "; name a sensor's file, such as \"sensors/vlp16.json\"",
          info.kind}});
  }
}

/// Gives a plan without a sensor the one that made the recording: of a sequence that of its
/// scenario, of a capture railcast's own preset, or what an Ouster sensor's metadata say, and else
/// what its points show.
/// @param remarks Receives which one it is.
/// @throws InputError as UseSensorOfPoints() does.
void UseSensorOf(const std::filesystem::path& recording,
                 ScenarioSpec& plan,
                 std::vector<std::string>& remarks) {
  // A constant, for GCC 12 fears that a temporary one is destroyed unset.
  static const LidarSpec unset;
  if (const auto& classes = plan.lidar.beam.footprint_of; !classes.empty()) {
    throw InputError({{plan.sources.Place("/lidar/beam/footprint_of"),
                       "must be left out: of what classes recorded surfaces are is not known",
                       Json(classes).dump()}});
  }
  if (plan.lidar != unset) return;
  const RecordingInfo info = OpenRecording(recording)->info();
  std::optional<LidarSpec> lidar = SensorOfSequence(info);
  const bool is_own = lidar.has_value();
  if (!lidar) lidar = SensorOfCapture(info, plan);
  if (!lidar) return UseSensorOfPoints(recording, info, plan, remarks);
  plan.lidar = std::move(*lidar);
  plan.lidar.beam.footprint_of.clear();  // Recorded surfaces are of unknown classes.
  std::string remark = "the sensor is " + (plan.lidar.name.empty() ? "that" : plan.lidar.name) +
                       (is_own ? " of the recording's scenario" : ", as the packets say");
  if (!is_own) {
    remark += ", with its preset and " + NumberText(plan.lidar.mount.position_m[2]) +
              " m above the rails: the plan's lidar may say otherwise";
  }
  remarks.push_back(std::move(remark));
}

/// Gives the plan's sensor the place above the track that the recording shows.
/// @param remarks Receives it.
/// @throws InputError as SurveyTracks() does.
void UseFoundTrack(const std::filesystem::path& recording,
                   ScenarioSpec& plan,
                   std::vector<std::string>& remarks) {
  constexpr std::size_t kMostFrames = 50;
  const TrackSurvey survey = SurveyTracks(*OpenRecording(recording),
                                          {.gauge_m = {}, .num_frames = kMostFrames}, [](auto) {});
  const MountSpec mount = survey.Mount();
  plan.lidar.mount = mount;
  plan.world.recording->track.reset();
  const auto text = [](const FigureOfFrames& figure) {
    return ShortText(figure.median.value) + " m (to " + ShortText(figure.median.margin) + ")";
  };
  remarks.push_back("the sensor is " + text(survey.height_m) + " above the rails of a track that " +
                    NumberText(survey.num_own) + " of " + NumberText(survey.frames.size()) +
                    " frames show, and " + text(survey.sideways_m) +
                    " left of its middle, with yaw " + ShortText(mount.yaw_deg) + ", pitch " +
                    ShortText(mount.pitch_deg) + " and roll " + ShortText(mount.roll_deg) +
                    " degrees");
}

/// Gives a plan that names no rung the one that what is put in needs, unless the plan switches
/// effects of the published model on.
/// @param remarks Receives which one it is.
void UseRung(const std::filesystem::path& plan_file,
             ScenarioSpec& plan,
             std::vector<std::string>& remarks) {
  JsonSource source;
  const auto plan_keys = source.Members(*source.Open(plan_file));
  if (std::ranges::count(plan_keys->members, "fidelity", &Member::key) > 0) return;
  ScenarioSpec needed = plan;
  needed.fidelity = Fidelity::kFootprint;
  const bool has_published = ConflictIn(SwitchedEffects(needed)).has_value();
  if (!has_published) plan.fidelity = needed.fidelity;
  remarks.push_back("the rung is " + std::string(NameOf(plan.fidelity)) +
                    (has_published ? ", of whose model the plan's effects are"
                                   : ", which edges, shadows, noise and texture of what is put in "
                                     "need") +
                    ": the plan's fidelity may say otherwise");
}

/// Checks that the plan is one, and that it asks for nothing that is not put into recordings.
void CheckSections(const ScenarioSpec& plan) {
  ErrorList errors;
  const auto place = [&](std::string_view pointer) { return plan.sources.Place(pointer); };
  if (!plan.world.recording) errors.Add({place("/world/recording"), "missing", ""});
  if (plan.world.recording && plan.world.recording->track && plan.lidar.mount != MountSpec{}) {
    errors.Add({place("/lidar/mount"),
                "must be left out beside world.recording.track, which finds it", ""});
  }
  const auto refuse = [&](bool is_given, std::string_view pointer) {
    if (is_given) {
      errors.Add({place(pointer), "must be left out of a plan, whose world is a recording", ""});
    }
  };
  const WorldSpec& world = plan.world;
  refuse(!plan.lidars.empty(), "/lidars");
  refuse(plan.camera.has_value(), "/camera");
  refuse(plan.motion_sensors.has_value(), "/motion_sensors");
  refuse(plan.vehicle != VehicleSpec{}, "/vehicle");
  refuse(plan.output != OutputSpec{}, "/output");
  refuse(plan.interfaces != InterfacesSpec{}, "/interfaces");
  refuse(plan.tolerance != ToleranceSpec{}, "/tolerance");
  refuse(!world.yards.empty(), "/world/yards");
  refuse(!world.diamond_crossings.empty(), "/world/diamond_crossings");
  refuse(world.catenary != CatenarySpec{}, "/world/catenary");
  refuse(world.terrain != TerrainSpec{}, "/world/terrain");
  refuse(world.vegetation != VegetationSpec{}, "/world/vegetation");
  refuse(!world.structures.empty(), "/world/structures");
  refuse(world.detail != SceneDetail::kAuto, "/world/detail");
  refuse(world.survey.has_value(), "/world/survey");
  errors.ThrowIfAny();
}

/// How the vehicle runs along the line, for objects that set off when it comes.
MotionSpec MotionAlong(const RecordedLine& line, const RecordedWay& way) {
  constexpr double kStanding_m = 0.1;
  const std::vector<double>& s_m = line.at_frames_m;
  MotionSpec motion;
  if (std::abs(s_m.back() - s_m.front()) < kStanding_m) return motion;
  motion.reverse = s_m.back() < s_m.front();
  for (std::size_t i = 0; i < s_m.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, s_m.size() - 1);
    const double step_s = SecondsFromNs(way.frame_times_ns[after] - way.frame_times_ns[before]);
    const double step_m = (s_m[after] - s_m[before]) * (motion.reverse ? -1.0 : 1.0);
    motion.profile.push_back({.time_s = SecondsFromNs(way.frame_times_ns[i]),
                              .s_m = {},
                              .speed_mps = std::max(0.0, step_m / step_s)});
  }
  return motion;
}

/// Puts the line in the place of the recording, so that the objects have a world of their own.
void UseLine(const RecordedLine& line, const RecordedWay& way, ScenarioSpec& plan) {
  plan.world.alignment = line.alignment;
  plan.sources.Rename("/world/recording/alignment", "/world/alignment");
  plan.world.recording.reset();
  plan.world.catenary.enabled = false;
  plan.vehicle.track = plan.world.tracks.front().name;
  plan.vehicle.start_s_m = line.at_frames_m.front();
  plan.vehicle.motion = MotionAlong(line, way);
  plan.vehicle.pivot_distance_m = 0.0;
}

/// Finds the scale of the intensities, and the axes of the sensor, in the first frames.
void UseFirstFrames(const std::filesystem::path& recording, InsertPlan& plan) {
  constexpr std::size_t kMostFrames = 10;
  const auto opened = OpenRecording(recording);
  IntensityScaleFinder finder(opened->info());
  for (std::size_t frame = 0; frame < kMostFrames; ++frame) {
    const auto read = opened->Next();
    if (!read) break;
    const RecordedFrame recorded = (*read)();
    (void)CheckRanges(recorded, opened->info(),
                      plan.scenario.lidar.range_max_m);  // Before anything is written.
    if (frame == 0) plan.sensor_from_spin = recorded.frame.sensor_from_spin;
    finder.Add(recorded);
  }
  plan.intensity_scale = finder.Found();
  plan.remarks.push_back(plan.intensity_scale.remark);
}

/// Finds where the objects are on the line at first.
void SetPlaces(const RecordedLine& line, const RailWorld& things, InsertPlan& plan) {
  const Alignment& alignment = things.alignment();
  for (std::size_t i = 0; i < plan.places.size(); ++i) {
    const Vector3 place_m = plan.world->WorldFromObject(i, 0).translation();
    const PlaceBesideLine place = PlaceOnLine(alignment, place_m, things.ObjectChainage_m(i, 0));
    plan.places[i].s_m = place.s_m - line.zero_s_m;
    plan.places[i].d_m = place.d_m;
    plan.places[i].h_m = place_m.z() - alignment.At(place.s_m).position_m.z();
  }
}

}  // namespace

RecordedRun ReadRecordedRun(const std::filesystem::path& plan_file,
                            const std::filesystem::path& recording) {
  RecordedRun run{.recording = recording, .plan = ReadScenario(plan_file)};
  CheckSections(run.plan);
  UseRung(plan_file, run.plan, run.remarks);
  UseSensorOf(recording, run.plan, run.remarks);
  const RecordingWorldSpec& world = *run.plan.world.recording;
  if (world.track) UseFoundTrack(recording, run.plan, run.remarks);
  run.way = ReadRecordedWay(recording, world, run.plan.lidar, run.remarks);
  const auto measured = MeasureIntensities(plan_file, run.plan, recording, run.way.at_frames);
  if (measured) run.intensities = UseIntensities(*measured, run.plan);
  const std::string source = ShownPath(recording);
  run.line =
      world.alignment ? GivenLine(*world.alignment, run.way, source) : LineOfWay(run.way, source);
  return run;
}

ScenarioSpec OnRecordedLine(const RecordedRun& run, ScenarioSpec plan) {
  CheckSections(plan);
  PlaceThings(run.way, run.line, plan);
  UseLine(run.line, run.way, plan);
  return plan;
}

InsertPlan MakeInsertPlan(const RecordedRun& run, const ScenarioSpec& plan_spec) {
  InsertPlan plan;
  ScenarioSpec& scenario = plan.scenario;
  scenario = OnRecordedLine(run, plan_spec);
  plan.identity = IdentityOf(plan_spec);
  plan.remarks = run.remarks;
  for (const ObjectSpec& object : plan_spec.world.objects) {
    plan.places.push_back({.asked = AskedPlace(object)});
  }
  std::vector<StandOnRecording> stands = LetGoOfGround(scenario);
  const auto things = MakeWorld(scenario);
  StandOnGround(run.recording, run.way, scenario, *things, stands, plan.places, plan.remarks);
  plan.first_stamp_ns = run.way.first_stamp_ns;
  plan.frame_times_ns = run.way.frame_times_ns;
  plan.world = std::make_shared<const RecordedWorld>(run.way, things, std::move(stands));
  SetPlaces(run.line, *things, plan);
  UseFirstFrames(run.recording, plan);
  const bool has_things = !plan_spec.world.objects.empty() || !plan_spec.world.trains.empty();
  if (has_things && !run.intensities.empty()) plan.remarks.push_back(run.intensities);
  return plan;
}

Transform PlannedPose(const InsertPlan& plan, std::int64_t time_ns) {
  return plan.world->WorldFromVehicle(time_ns) * VehicleFromSensor(plan.scenario.lidar.mount);
}

InsertPlan ReadInsertPlan(const std::filesystem::path& plan_file,
                          const std::filesystem::path& recording) {
  const RecordedRun run = ReadRecordedRun(plan_file, recording);
  return MakeInsertPlan(run, run.plan);
}

}  // namespace railcast
