#include "core/simulate/frame_scene.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "core/base/units.h"

namespace railcast {
namespace {

// Moving objects are interpolated linearly between poses this far apart in time. A lateral
// acceleration of 2 m/s^2 then bends the path by a dt^2 / 8 = 0.6 mm.
constexpr std::int64_t kShutterStep_ns = 50'000'000;

// Upper bound of the vehicle's speed, above that of any train: limits its travel within a frame.
constexpr double kSpeedMax_mps = 200.0;

// Look-ahead time for the next window, and its step: at 80 m/s, a step is shorter than a chunk.
constexpr std::int64_t kLookAhead_ns = 4'000'000'000;
constexpr std::int64_t kLookAheadStep_ns = 500'000'000;

// Maximum distance from the vehicle's position at the stamp to anything a beam of the frame may
// hit.
double SensorReachOf(const FrameSceneSpec& spec) {
  return spec.range_max_m + spec.vehicle_from_sensor.translation().norm() +
         kSpeedMax_mps * SecondsFromNs(spec.duration_ns);
}

}  // namespace

void FrameScene::Cast(RayTile& rays) const {
  window->scene->Cast(rays);
  if (moving != nullptr) moving->Cast(rays);
}

void FrameScene::CastBeam(BeamRays& beam) const {
  window->scene->CastBeam(beam);
  if (moving != nullptr) moving->CastBeam(beam);
}

void FrameScene::CastRanges(RayTile& rays) const {
  window->scene->CastRanges(rays);
  if (moving != nullptr) moving->CastRanges(rays);
}

FrameScenes::FrameScenes(std::shared_ptr<SceneStore> store, const FrameSceneSpec& spec)
    : store_(std::move(store)), spec_(spec), windows_(store_, SensorReachOf(spec)) {
  UseWorld(store_->world());
}

void FrameScenes::UseWorld(std::shared_ptr<const World> world) {
  if (world == world_) return;
  std::map<std::uint32_t, std::size_t> known;  // Object index by instance id.
  const std::vector<SceneObject>& first = store_->world()->objects();
  for (std::size_t i = 0; i < first.size(); ++i) known.emplace(first[i].instance, i);

  std::vector<Object> objects;
  std::vector<Surface> more_surfaces;
  std::vector<std::size_t> standing;
  for (const SceneObject& object : world->objects()) {
    const auto found = known.find(object.instance);
    if (found != known.end() && first[found->second].model == object.model) {
      const std::size_t i = found->second;
      const bool stands = !object.moves && !first[i].moves;
      if (stands) standing.push_back(i);
      objects.push_back({windows_.object(i), windows_.object_surface(i), true, stands});
      continue;
    }
    objects.push_back({store_->MakeObject(object), static_cast<std::uint32_t>(more_surfaces.size()),
                       false, false});
    const std::vector<Surface>& surfaces = objects.back().stored.surfaces;
    more_surfaces.insert(more_surfaces.end(), surfaces.begin(), surfaces.end());
  }
  windows_.UseStanding(std::move(standing));
  objects_ = std::move(objects);
  more_surfaces_ = std::move(more_surfaces);
  world_ = std::move(world);
  store_->ForgetUnusedModels();
}

void FrameScenes::UseWind(const Wind& wind) {
  wind_ = wind;
  windows_.UseWind(wind.blows());
}

FrameScene FrameScenes::At(std::uint32_t index, std::int64_t stamp_ns) {
  const int home_chunk = world_->HomeChunk(stamp_ns);
  std::shared_ptr<const Window> window = windows_.Get(home_chunk);
  PrepareNextWindow(stamp_ns, home_chunk);
  FrameScene scene;
  std::vector<TracePlacement> moving = MovingObjects(stamp_ns, *window);
  if (wind_.blows()) {
    SwayedThings swayed = Swayed(stamp_ns, *window);
    std::ranges::move(swayed.placements, std::back_inserter(moving));
    scene.swayed_wires = std::move(swayed.wires);
  }
  if (!moving.empty()) {
    scene.moving = std::make_unique<const TraceScene>(store_->device(), moving);
  }
  scene.index = index;
  scene.stamp_ns = stamp_ns;
  scene.poses = PosesIn(window->window_from_world, stamp_ns);
  if (!more_surfaces_.empty()) {
    scene.more_surfaces = window->surfaces;
    scene.more_surfaces.insert(scene.more_surfaces.end(), more_surfaces_.begin(),
                               more_surfaces_.end());
  }
  scene.window = std::move(window);
  return scene;
}

FramePoses FrameScenes::PosesIn(const Transform& window_from_world, std::int64_t stamp_ns) const {
  return FramePoses(spec_.duration_ns, [&](std::uint32_t time_ns) {
    return window_from_world * WorldFromSensor(stamp_ns + time_ns);
  });
}

TracePlacement FrameScenes::Place(std::size_t object,
                                  std::int64_t stamp_ns,
                                  const Window& window) const {
  TracePlacement placement{
      objects_[object].stored.model, {}, FirstSurface(objects_[object], window)};
  const std::int64_t duration_ns = spec_.duration_ns;
  const bool moves = world_->objects()[object].moves;
  const std::int64_t num_intervals =
      moves ? std::max<std::int64_t>(1, (duration_ns + kShutterStep_ns - 1) / kShutterStep_ns) : 0;
  for (std::int64_t step = 0; step <= num_intervals; ++step) {
    const std::int64_t since_stamp_ns = moves ? duration_ns * step / num_intervals : 0;
    const Transform window_from_object =
        window.window_from_world * world_->WorldFromObject(object, stamp_ns + since_stamp_ns);
    placement.window_from_model.emplace_back(window_from_object.matrix());
  }
  return placement;
}

bool FrameScenes::IsInReach(const TracePlacement& placement,
                            std::size_t object,
                            const Vector3& sensor_window_m) const {
  const auto& steps = placement.window_from_model;
  const double travel_m = (steps.back().translation() - steps.front().translation()).norm() +
                          kSpeedMax_mps * SecondsFromNs(spec_.duration_ns);
  return (steps.front().translation() - sensor_window_m).norm() <=
         spec_.range_max_m + objects_[object].stored.radius_m + travel_m;
}

std::vector<TracePlacement> FrameScenes::MovingObjects(std::int64_t stamp_ns,
                                                       const Window& window) const {
  std::vector<TracePlacement> placements;
  const Vector3 sensor_window_m = SensorInWindow(stamp_ns, window);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].is_in_windows) continue;
    TracePlacement placement = Place(i, stamp_ns, window);
    if (IsInReach(placement, i, sensor_window_m)) placements.push_back(std::move(placement));
  }
  return placements;
}

SwayedThings FrameScenes::Swayed(std::int64_t stamp_ns, const Window& window) const {
  const double duration_s = SecondsFromNs(spec_.duration_ns);
  return Sway(window.swaying, wind_,
              {.stamp_s = SecondsFromNs(stamp_ns),
               .duration_s = duration_s,
               .window_from_world = window.window_from_world,
               .sensor_window_m = SensorInWindow(stamp_ns, window),
               .reach_m = spec_.range_max_m + kSpeedMax_mps * duration_s});
}

std::vector<LoneObject> FrameScenes::LoneObjects(const FrameScene& frame) const {
  std::vector<LoneObject> lone;
  const Vector3 sensor_window_m = SensorInWindow(frame.stamp_ns, *frame.window);
  for (std::size_t i = 0; i < world_->objects().size(); ++i) {
    TracePlacement placement = Place(i, frame.stamp_ns, *frame.window);
    if (!IsInReach(placement, i, sensor_window_m)) continue;
    const auto& steps = placement.window_from_model;
    const Vector3 begin_m = steps.front().translation();
    const Vector3 end_m = steps.back().translation();
    lone.push_back({.object = i,
                    .scene = std::make_unique<TraceScene>(store_->device(), std::vector{placement}),
                    .center_window_m = (0.5 * (begin_m + end_m)).cast<float>(),
                    .radius_m = static_cast<float>(objects_[i].stored.radius_m +
                                                   0.5 * (end_m - begin_m).norm())});
  }
  return lone;
}

void FrameScenes::PrepareNextWindow(std::int64_t stamp_ns, int home_chunk) {
  for (std::int64_t ahead_ns = kLookAheadStep_ns; ahead_ns <= kLookAhead_ns;
       ahead_ns += kLookAheadStep_ns) {
    const int next = world_->HomeChunk(stamp_ns + ahead_ns);
    if (next == home_chunk) continue;
    windows_.Prepare(next);
    return;
  }
}

}  // namespace railcast
