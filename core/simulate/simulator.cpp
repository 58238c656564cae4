#include "core/simulate/simulator.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/detect/detector.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/output_axes.h"
#include "core/simulate/window.h"

namespace railcast {
namespace {

// Moving things are interpolated linearly between this many places in a frame.
constexpr std::uint32_t kShutterSteps = 3;
// How far ahead the next window is looked for.
constexpr std::int64_t kLookAhead_ns = 4'000'000'000;

}  // namespace

struct Simulator::Parts {
  std::shared_ptr<const World> world;
  ScanPattern pattern;
  SimulatorSpec spec;
  FiringTiles tiles;
  Detector detector;
  WindowSource windows;
  tbb::task_arena arena;

  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const {
    return world->WorldFromVehicle(time_ns) * spec.vehicle_from_sensor;
  }
  [[nodiscard]] FramePoses Poses(std::int64_t stamp_ns, const Transform& window_from_world) const;
  [[nodiscard]] TracePlacement Place(std::size_t object,
                                     std::int64_t stamp_ns,
                                     const Transform& window_from_world) const;
  [[nodiscard]] std::unique_ptr<const TraceScene> MovingScene(std::int64_t stamp_ns,
                                                              const Window& window) const;
  void PrepareNextWindow(std::int64_t stamp_ns, int home_chunk);
};

FramePoses Simulator::Parts::Poses(std::int64_t stamp_ns,
                                   const Transform& window_from_world) const {
  return FramePoses(tiles.duration_ns(), [&](std::uint32_t time_ns) {
    return window_from_world * WorldFromSensor(stamp_ns + time_ns);
  });
}

TracePlacement Simulator::Parts::Place(std::size_t object,
                                       std::int64_t stamp_ns,
                                       const Transform& window_from_world) const {
  TracePlacement placement{windows.object_model(object), {}, windows.object_surface(object)};
  const std::uint32_t num_steps = world->objects()[object].moves ? kShutterSteps : 1;
  for (std::uint32_t step = 0; step < num_steps; ++step) {
    const std::int64_t time_ns =
        num_steps == 1 ? stamp_ns
                       : stamp_ns + std::int64_t{tiles.duration_ns()} * step / (num_steps - 1);
    const Transform window_from_object =
        window_from_world * world->WorldFromObject(object, time_ns);
    placement.window_from_model.emplace_back(window_from_object.matrix());
  }
  return placement;
}

std::unique_ptr<const TraceScene> Simulator::Parts::MovingScene(std::int64_t stamp_ns,
                                                                const Window& window) const {
  std::vector<TracePlacement> placements;
  const Vector3 sensor_window =
      (window.window_from_world * WorldFromSensor(stamp_ns)).translation();
  const auto& objects = world->objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].moves) continue;
    TracePlacement placement = Place(i, stamp_ns, window.window_from_world);
    const auto& steps = placement.window_from_model;
    const double travel_m = (steps.back().translation() - steps.front().translation()).norm();
    const double reach_m =
        spec.range_max_m + objects[i].model->Bounds().diagonal().norm() + 2.0 * travel_m;
    if ((steps.front().translation() - sensor_window).norm() > reach_m + 100.0) continue;
    placements.push_back(std::move(placement));
  }
  if (placements.empty()) return nullptr;
  return std::make_unique<TraceScene>(windows.device(), placements);
}

void Simulator::Parts::PrepareNextWindow(std::int64_t stamp_ns, int home_chunk) {
  const auto period_ns = static_cast<std::int64_t>(1e9 / pattern.rate_hz);
  for (std::int64_t ahead_ns = period_ns; ahead_ns <= kLookAhead_ns; ahead_ns += period_ns) {
    const int next = world->HomeChunk(stamp_ns + ahead_ns);
    if (next == home_chunk) continue;
    windows.Prepare(next);
    return;
  }
}

Simulator::Simulator(std::shared_ptr<const World> world,
                     ScanPattern pattern,
                     const MaterialLibrary& materials,
                     const SimulatorSpec& spec,
                     int num_threads) {
  FiringTiles tiles(pattern);
  Detector detector({.seed = spec.seed,
                     .range_min_m = spec.range_min_m,
                     .range_max_m = spec.range_max_m,
                     .effects = spec.effects,
                     .plausibility = spec.plausibility,
                     .weather = spec.weather});
  parts_.reset(new Parts{.world = world,
                         .pattern = std::move(pattern),
                         .spec = spec,
                         .tiles = std::move(tiles),
                         .detector = std::move(detector),
                         .windows{world, materials, spec.range_max_m, spec.isa},
                         .arena{num_threads > 0 ? num_threads : tbb::task_arena::automatic}});
}

Simulator::~Simulator() = default;

const World& Simulator::world() const {
  return *parts_->world;
}
const ScanPattern& Simulator::pattern() const {
  return parts_->pattern;
}
Transform Simulator::WorldFromSensor(std::int64_t time_ns) const {
  return parts_->WorldFromSensor(time_ns);
}

namespace {

// Hands what the rays hit to the detector.
void Resolve(const RayTile& rays, const std::vector<Surface>& surfaces, DetectTile& detect) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const Surface& surface = surfaces[rays.surface[i]];
    const bool hit = rays.surface[i] != 0;
    const Outcome outcome = !hit             ? Outcome::kNoSurface
                            : surface.is_ego ? Outcome::kEgo
                                             : Outcome::kReturned;
    detect.true_range_m[i] = hit ? rays.range_m[i] : kNaN;
    detect.cos_incidence[i] = hit ? rays.cos_incidence[i] : kNaN;
    detect.reflectivity[i] = hit ? surface.reflectivity : kNaN;
    detect.outcome[i] = static_cast<std::uint32_t>(outcome);
  }
}

void Store(const DetectTile& detect,
           const RayTile& rays,
           const std::vector<Surface>& surfaces,
           const std::uint32_t* slots,
           std::size_t num_firings,
           std::uint32_t snow_label,
           Frame& frame) {
  for (std::size_t i = 0; i < num_firings; ++i) {
    const std::size_t slot = slots[i];
    const auto outcome = static_cast<Outcome>(detect.outcome[i]);
    const Surface& surface = surfaces[rays.surface[i]];
    const bool is_flake = detect.is_flake[i] != 0;
    frame.x[slot] = detect.x[i];
    frame.y[slot] = detect.y[i];
    frame.z[slot] = detect.z[i];
    frame.intensity[slot] = detect.intensity[i];
    frame.power_ratio[slot] = detect.power_ratio[i];
    frame.range_m[slot] = detect.range_m[i];
    frame.true_range_m[slot] = detect.true_range_m[i];
    frame.outcome[slot] = outcome;
    frame.return_count[slot] = HasPoint(outcome) ? 1 : 0;
    frame.label[slot] = is_flake ? snow_label : surface.label;
    frame.instance[slot] = is_flake ? 0 : surface.instance;
    frame.material[slot] = is_flake ? std::uint16_t{0} : surface.material;
    frame.incidence_rad[slot] =
        is_flake ? std::numeric_limits<float>::quiet_NaN() : detect.incidence_rad[i];
  }
}

}  // namespace

void Simulator::Scan(std::uint32_t frame_index, Frame& frame) {
  Parts& parts = *parts_;
  const std::int64_t stamp_ns = parts.pattern.StampNs(frame_index);
  frame.index = frame_index;
  frame.stamp_ns = stamp_ns;
  frame.world_from_sensor = parts.WorldFromSensor(stamp_ns);
  frame.Resize(parts.pattern.rows, parts.pattern.columns, 1);

  const int home_chunk = parts.world->HomeChunk(stamp_ns);
  const std::shared_ptr<const Window> window = parts.windows.Get(home_chunk);
  parts.PrepareNextWindow(stamp_ns, home_chunk);
  const FramePoses poses = parts.Poses(stamp_ns, window->window_from_world);
  const std::unique_ptr<const TraceScene> moving = parts.MovingScene(stamp_ns, *window);
  const OutputAxes axes(parts.spec.output, parts.spec.vehicle_from_sensor,
                        window->window_from_world);
  const auto range_max_m = static_cast<float>(parts.spec.range_max_m);

  const auto scan_tile = [&](std::size_t tile) {
    RayTile rays;
    DetectTile detect;
    parts.tiles.Aim(tile, poses, range_max_m, rays);
    window->scene->Cast(rays);
    if (moving != nullptr) moving->Cast(rays);
    detect.frame = frame_index;
    parts.tiles.Describe(tile, detect);
    Resolve(rays, window->surfaces, detect);
    parts.detector.Run(detect);
    axes.Apply(poses, parts.tiles.times_ns(tile), detect);
    Store(detect, rays, window->surfaces, parts.tiles.slots(tile), parts.tiles.num_firings(tile),
          parts.spec.snow_label, frame);
  };
  parts.arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, parts.tiles.num_tiles(), scan_tile); });
  parts.tiles.StoreConstants(frame);
}

std::vector<std::uint32_t> Simulator::FiringsOnObjectAlone(std::uint32_t frame_index) {
  Parts& parts = *parts_;
  const std::int64_t stamp_ns = parts.pattern.StampNs(frame_index);
  const Transform window_from_world =
      parts.world->WorldFromChunk(parts.world->HomeChunk(stamp_ns)).inverse();
  const FramePoses poses = parts.Poses(stamp_ns, window_from_world);
  const auto range_max_m = static_cast<float>(parts.spec.range_max_m);
  std::vector<std::uint32_t> counts(parts.world->objects().size(), 0);
  parts.arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, counts.size(), [&](std::size_t object) {
      TracePlacement placement = parts.Place(object, stamp_ns, window_from_world);
      placement.first_surface = 1;
      const TraceScene alone(parts.windows.device(), {placement});
      for (std::size_t tile = 0; tile < parts.tiles.num_tiles(); ++tile) {
        RayTile rays;
        parts.tiles.Aim(tile, poses, range_max_m, rays);
        alone.Cast(rays);
        const std::size_t num_firings = parts.tiles.num_firings(tile);
        counts[object] += static_cast<std::uint32_t>(
            std::count_if(rays.surface, rays.surface + num_firings,
                          [](std::uint32_t surface) { return surface != 0; }));
      }
    });
  });
  return counts;
}

}  // namespace railcast
