#include "analysis/extras/study/approach_scan.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/base/error.h"
#include "core/io/recording/sequence_lines.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

/// Windows through which an approach of some hundred metres leads.
constexpr std::size_t kKeptWindows = 8;

// A scenario without what a simulator can change.
ScenarioSpec SharedPartOf(ScenarioSpec scenario) {
  const ScenarioSpec usual;
  scenario.world.objects.clear();
  scenario.world.trains.clear();
  scenario.vehicle.start_s_m = usual.vehicle.start_s_m;
  scenario.vehicle.motion = usual.vehicle.motion;
  scenario.weather = usual.weather;
  scenario.seed = usual.seed;
  return scenario;
}

std::uint32_t DurationOf_ns(const ScanPattern& pattern) {
  return *std::ranges::max_element(pattern.time_ns);
}

// A frame with its times and poses, and without firings.
Frame EmptyFrame(const Simulator& simulator, std::uint32_t index, std::uint32_t duration_ns) {
  Frame frame;
  frame.index = index;
  frame.stamp_ns = simulator.pattern().StampNs(index);
  frame.duration_ns = duration_ns;
  frame.world_from_sensor = simulator.WorldFromSensor(frame.stamp_ns);
  frame.world_from_sensor_end = simulator.WorldFromSensor(frame.stamp_ns + duration_ns);
  return frame;
}

/// An object whose detection is sought.
struct Target {
  std::size_t object{};  ///< Index into the world's objects.
  ObjectCourse* course{};
  std::size_t num_approach{};  ///< How many of the first sightings are its approach.
  std::size_t next{};          ///< The first sighting that was not traced.
  bool is_detected{};
};

bool IsTarget(const ObjectCourse& course) {
  const std::span<const Sighting> approach = ApproachIn(course.sightings);
  return std::ranges::any_of(approach, &Sighting::is_in_way) && IsApproached(approach);
}

}  // namespace

bool ApproachScanner::HasSceneOf(const ScenarioSpec& scenario) const {
  return SharedPartOf(scenario) == shared_;
}

void ApproachScanner::Use(const ScenarioSpec& scenario) {
  ScenarioSpec shared = SharedPartOf(scenario);
  if (shared != shared_) {
    // Without objects and trains, so that none is part of what is kept.
    ScenarioSpec bare = scenario;
    bare.world.objects.clear();
    bare.world.trains.clear();
    simulator_.reset();  // Its memory is freed first.
    shared_.reset();
    simulator_ = MakeSimulator(bare, num_threads_, isa_);
    simulator_->KeepWindows(kKeptWindows);
    shared_ = std::move(shared);
  }
  SimulatorSpec spec = simulator_->spec();
  // The sensor and the labels are those of the simulator.
  std::vector<std::uint32_t> footprint_labels = std::move(spec.detector.footprint_labels);
  spec.detector = DetectorSpecOf(scenario, scenario.lidar, EffectsOf(scenario));
  spec.detector.footprint_labels = std::move(footprint_labels);
  UseWeather(scenario, scenario.weather, spec);
  simulator_->Use(spec);
  world_ = MakeWorld(scenario);
  simulator_->UseWorld(world_);
  certifier_.reset();
  certificate_.reset();
  // A recipe may draw the reference itself for some of its scenarios, which needs no certificate.
  if (!certify_ || spec.detector.effects.dense_footprint) return;
  certifier_.emplace(scenario, *certify_, *simulator_);
  certificate_.emplace();
}

void ApproachScanner::Certify(BegunFrame& begun,
                              std::span<const std::size_t> objects,
                              const Frame& frame) {
  if (!certifier_) return;
  CertifiedRegion region;
  region.cells = simulator_->FiringsNearObjects(begun, objects);
  for (const std::size_t i : objects) {
    const SceneObject& object = world_->objects()[i];
    region.instances.insert(object.instance);
    certificate_->objects.emplace(object.name, object.instance);
  }
  certificate_->Add(certifier_->Certify(*simulator_, begun, frame, &region));
}

std::optional<RunCourses> ApproachScanner::Follow(const ScenarioSpec& scenario,
                                                  const std::vector<std::uint32_t>& frames,
                                                  const DetectionRule& rule,
                                                  const std::function<bool()>& is_stopped) {
  Use(scenario);
  Simulator& simulator = *simulator_;
  const RailWorld& world = *world_;
  const Transform vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount);
  const OwnTrack own_track(world, scenario.world.catenary, PartsOf(gauge_));
  ObjectSurvey survey(world, LabelTable(scenario.labels), simulator.spec().detector.range_max_m,
                      scenario.output);
  const std::vector<ObjectView> no_views(world.objects().size());
  RunCourses courses;
  const ScanPattern& pattern = simulator.pattern();
  std::uint32_t duration_ns = DurationOf_ns(pattern);
  for (const std::uint32_t index : frames) {
    if (!pattern.repeats()) duration_ns = DurationOf_ns(PatternOfFrame(pattern, index));
    RecordedFrame recorded;
    recorded.frame = EmptyFrame(simulator, index, duration_ns);
    const Transform sensor_from_world = recorded.frame.world_from_sensor.inverse();
    for (const ObjectInFrame& object : survey.Describe(recorded.frame, no_views)) {
      if (!IsAskedAbout(object.name, objects_)) continue;
      recorded.objects.push_back(RecordedOf(object, sensor_from_world));
    }
    AddFrame(recorded, vehicle_from_sensor, own_track, courses);
  }
  std::vector<Target> targets;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const auto course = courses.objects.find(world.objects()[i].name);
    if (course == courses.objects.end() || !IsTarget(course->second)) continue;
    targets.push_back({.object = i,
                       .course = &course->second,
                       .num_approach = ApproachIn(course->second.sightings).size()});
  }
  for (std::uint32_t number = 0; number < frames.size(); ++number) {
    if (is_stopped()) return std::nullopt;
    std::vector<std::size_t> sought;
    for (const Target& target : targets) {
      if (target.is_detected || target.next == target.num_approach) continue;
      if (target.course->sightings[target.next].frame == number) sought.push_back(target.object);
    }
    if (sought.empty()) continue;
    const auto begun = simulator.Begin(frames[number]);
    simulator.ScanNearObjects(*begun, sought, frame_);
    Certify(*begun, sought, frame_);
    ++effort_.num_traced;
    for (Target& target : targets) {
      if (std::ranges::find(sought, target.object) == sought.end()) continue;
      std::vector<Sighting>& sightings = target.course->sightings;
      sightings[target.next].points =
          PointsOnInstance(frame_, world.objects()[target.object].instance);
      target.is_detected = CompletesRule(std::span(sightings).first(++target.next), rule);
    }
  }
  effort_.num_frames += frames.size();
  return courses;
}

std::optional<EvaluatedRun> ApproachScanner::Evaluate(const ScenarioSpec& scenario,
                                                      const std::vector<std::uint32_t>& frames,
                                                      const ClusterDetectorSpec& detector,
                                                      const DetectSpec& detect,
                                                      const std::function<bool()>& is_stopped) {
  ScenarioSpec in_sensor_axes = scenario;
  in_sensor_axes.output = {};
  Use(in_sensor_axes);
  const Transform vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount);
  const double range_max_m = simulator_->spec().detector.range_max_m;
  const OwnTrack own_track(*world_, scenario.world.catenary, PartsOf(gauge_));
  const LabelTable labels(scenario.labels);
  ObjectSurvey survey(*world_, labels, range_max_m, in_sensor_axes.output);
  const std::vector<ObjectView> no_views(world_->objects().size());
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < world_->objects().size(); ++i) {
    const SceneObject& object = world_->objects()[i];
    if (!object.is_ego && IsAskedAbout(object.name, objects_)) asked.push_back(i);
  }
  RunEvaluator evaluator(own_track, labels, vehicle_from_sensor);
  recorded_.has_pose = true;
  for (const std::uint32_t index : frames) {
    if (is_stopped()) return std::nullopt;
    const auto begun = simulator_->Begin(index);
    simulator_->Scan(*begun, recorded_.frame);
    Certify(*begun, asked, recorded_.frame);
    ForEachField(recorded_.frame, [&](const char* name, const char*, const auto&) {
      recorded_.fields.emplace(name);
    });
    recorded_.objects.clear();
    const Transform sensor_from_world = recorded_.frame.world_from_sensor.inverse();
    for (const ObjectInFrame& object : survey.Describe(recorded_.frame, no_views)) {
      recorded_.objects.push_back(RecordedOf(object, sensor_from_world));
    }
    evaluator.Add(recorded_,
                  {FindClusters(recorded_, vehicle_from_sensor, own_track, detector, range_max_m)});
  }
  effort_.num_frames += frames.size();
  effort_.num_traced += frames.size();
  EvaluatedRun run = evaluator.Finish({}, scenario.seed, detect);
  std::erase_if(run.run.courses.objects,
                [&](const auto& object) { return !IsAskedAbout(object.first, objects_); });
  return run;
}

}  // namespace railcast
