#include "core/simulate/frame_scene.h"

#include <algorithm>
#include <utility>

#include "core/base/units.h"

namespace railcast {
namespace {

// Moving things are interpolated linearly between places this far apart in time: at 2 m/s^2 across
// the line of motion that bends the path by a dt^2 / 8 = 0.6 mm.
constexpr std::int64_t kShutterStep_ns = 50'000'000;

// Faster than any train: how far the vehicle may get from its place at the stamp within a frame.
constexpr double kSpeedMax_mps = 200.0;

// How far ahead, and in what steps, the next window is looked for: at 80 m/s a step is shorter than
// a chunk.
constexpr std::int64_t kLookAhead_ns = 4'000'000'000;
constexpr std::int64_t kLookAheadStep_ns = 500'000'000;

double RadiusAboutOrigin(const Model& model) {
  double radius_m = 0.0;
  for (const Part& part : model.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      radius_m = std::max(radius_m, vertex.cast<double>().norm());
    }
  }
  return radius_m;
}

// From the vehicle's place at the stamp to anything a beam of the frame may hit.
double ReachOf(const FrameSceneSpec& spec) {
  return spec.range_max_m + spec.vehicle_from_sensor.translation().norm() +
         kSpeedMax_mps * SecondsFromNs(spec.duration_ns);
}

}  // namespace

void FrameScene::Cast(RayTile& rays) const {
  window->scene->Cast(rays);
  if (moving != nullptr) moving->Cast(rays);
}

void FrameScene::CastRanges(RayTile& rays) const {
  window->scene->CastRanges(rays);
  if (moving != nullptr) moving->CastRanges(rays);
}

FrameScenes::FrameScenes(std::shared_ptr<const World> world,
                         const MaterialLibrary& materials,
                         const FrameSceneSpec& spec)
    : world_(std::move(world)), spec_(spec), windows_(world_, materials, ReachOf(spec), spec.isa) {
  for (const SceneObject& object : world_->objects()) {
    object_radii_m_.push_back(RadiusAboutOrigin(*object.model));
  }
}

FrameScene FrameScenes::At(std::uint32_t index, std::int64_t stamp_ns) {
  const int home_chunk = world_->HomeChunk(stamp_ns);
  std::shared_ptr<const Window> window = windows_.Get(home_chunk);
  PrepareNextWindow(stamp_ns, home_chunk);
  std::unique_ptr<const TraceScene> moving = MovingScene(stamp_ns, *window);
  FrameScene scene;
  scene.index = index;
  scene.stamp_ns = stamp_ns;
  scene.poses = PosesIn(window->window_from_world, stamp_ns);
  scene.window = std::move(window);
  scene.moving = std::move(moving);
  return scene;
}

FramePoses FrameScenes::PosesIn(const Transform& window_from_world, std::int64_t stamp_ns) const {
  return FramePoses(spec_.duration_ns, [&](std::uint32_t time_ns) {
    return window_from_world * WorldFromSensor(stamp_ns + time_ns);
  });
}

TracePlacement FrameScenes::Place(std::size_t object,
                                  std::int64_t stamp_ns,
                                  const Transform& window_from_world) const {
  TracePlacement placement{windows_.object_model(object), {}, windows_.object_surface(object)};
  const std::int64_t duration_ns = spec_.duration_ns;
  const bool moves = world_->objects()[object].moves;
  const std::int64_t num_intervals =
      moves ? std::max<std::int64_t>(1, (duration_ns + kShutterStep_ns - 1) / kShutterStep_ns) : 0;
  for (std::int64_t step = 0; step <= num_intervals; ++step) {
    const std::int64_t since_stamp_ns = moves ? duration_ns * step / num_intervals : 0;
    const Transform window_from_object =
        window_from_world * world_->WorldFromObject(object, stamp_ns + since_stamp_ns);
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
         spec_.range_max_m + object_radii_m_[object] + travel_m;
}

std::unique_ptr<const TraceScene> FrameScenes::MovingScene(std::int64_t stamp_ns,
                                                           const Window& window) const {
  std::vector<TracePlacement> placements;
  const Vector3 sensor_window_m = SensorInWindow(stamp_ns, window);
  const auto& objects = world_->objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].moves) continue;
    TracePlacement placement = Place(i, stamp_ns, window.window_from_world);
    if (IsInReach(placement, i, sensor_window_m)) placements.push_back(std::move(placement));
  }
  if (placements.empty()) return nullptr;
  return std::make_unique<TraceScene>(windows_.device(), placements);
}

std::vector<FrameScenes::LoneObject> FrameScenes::LoneObjects(const FrameScene& frame) const {
  std::vector<LoneObject> lone;
  const Vector3 sensor_window_m = SensorInWindow(frame.stamp_ns, *frame.window);
  for (std::size_t i = 0; i < world_->objects().size(); ++i) {
    TracePlacement placement = Place(i, frame.stamp_ns, frame.window->window_from_world);
    if (!IsInReach(placement, i, sensor_window_m)) continue;
    const auto& steps = placement.window_from_model;
    const Vector3 begin_m = steps.front().translation();
    const Vector3 end_m = steps.back().translation();
    lone.push_back(
        {.object = i,
         .scene = std::make_unique<TraceScene>(windows_.device(), std::vector{placement}),
         .center_window_m = (0.5 * (begin_m + end_m)).cast<float>(),
         .radius_m = static_cast<float>(object_radii_m_[i] + 0.5 * (end_m - begin_m).norm())});
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
