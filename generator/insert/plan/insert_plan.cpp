#include "generator/insert/insert_plan.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/run/scenario_identity.h"
#include "core/rail/line/line_place.h"
#include "generator/insert/intensity_scale.h"
#include "generator/insert/plan/found_sensor.h"
#include "generator/insert/plan/placed_things.h"
#include "generator/insert/plan/recorded_line.h"
#include "generator/insert/plan/recorded_run.h"
#include "generator/insert/plan/recorded_way.h"
#include "generator/insert/plan/recorded_world.h"
#include "generator/insert/plan/standing_things.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

/// Checks that the plan is one, and that it asks for nothing that is not put into recordings.
void CheckSections(const ScenarioSpec& plan) {
  ErrorList errors;
  const auto place = [&](std::string_view pointer) { return plan.sources.Place(pointer); };
  if (!plan.world.recording) errors.Add({place("/world/recording"), "missing", ""});
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

/// Finds the scale of the intensities in the first frames.
void UseIntensities(const std::filesystem::path& recording, InsertPlan& plan) {
  constexpr std::size_t kMostFrames = 10;
  const auto opened = OpenRecording(recording);
  IntensityScaleFinder finder(opened->info());
  for (std::size_t frame = 0; frame < kMostFrames; ++frame) {
    if (const auto read = opened->Next()) finder.Add((*read)());
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
  UseSensorOf(OpenRecording(recording)->info(), run.plan, run.remarks);
  const RecordingWorldSpec& world = *run.plan.world.recording;
  run.way = ReadRecordedWay(recording, world, run.plan.lidar, run.remarks);
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
  UseIntensities(run.recording, plan);
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
