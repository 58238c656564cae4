#include "core/simulate/simulator.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/detect/detector.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/hits_and_slots.h"
#include "core/simulate/output_axes.h"
#include "core/simulate/window.h"

namespace railcast {
namespace {

// Moving things are interpolated linearly between this many places in a frame.
constexpr std::uint32_t kShutterSteps = 3;
// How far ahead the next window is looked for.
constexpr std::int64_t kLookAhead_ns = 4'000'000'000;

/// What all tiles of a frame share.
struct FrameContext {
  std::uint32_t index{};
  std::int64_t stamp_ns{};
  std::shared_ptr<const Window> window;
  FramePoses poses;
  std::unique_ptr<const TraceScene> moving;  ///< Null if nothing moves within reach.
};

}  // namespace

struct Simulator::Parts {
  std::shared_ptr<const World> world;
  ScanPattern pattern;
  SimulatorSpec spec;
  FiringTiles tiles;
  Detector detector;
  WindowSource windows;
  // TBB starts no more threads than there are cores unless told to.
  tbb::global_control parallelism;
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
  [[nodiscard]] FrameContext Begin(std::uint32_t frame_index);
  void TraceTile(const FrameContext& frame,
                 std::size_t tile,
                 RayTile& rays,
                 DetectTile& detect) const;
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
  const int num_workers = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  parts_.reset(new Parts{.world = world,
                         .pattern = std::move(pattern),
                         .spec = spec,
                         .tiles = std::move(tiles),
                         .detector = std::move(detector),
                         .windows{world, materials, spec.range_max_m, spec.isa},
                         .parallelism{tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(
                                          std::max(num_workers, tbb::info::default_concurrency()))},
                         .arena{num_workers}});
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

FrameContext Simulator::Parts::Begin(std::uint32_t frame_index) {
  const std::int64_t stamp_ns = pattern.StampNs(frame_index);
  const int home_chunk = world->HomeChunk(stamp_ns);
  std::shared_ptr<const Window> window = windows.Get(home_chunk);
  PrepareNextWindow(stamp_ns, home_chunk);
  FramePoses poses = Poses(stamp_ns, window->window_from_world);
  std::unique_ptr<const TraceScene> moving = MovingScene(stamp_ns, *window);
  return {frame_index, stamp_ns, std::move(window), std::move(poses), std::move(moving)};
}

void Simulator::Parts::TraceTile(const FrameContext& frame,
                                 std::size_t tile,
                                 RayTile& rays,
                                 DetectTile& detect) const {
  tiles.Aim(tile, frame.poses, static_cast<float>(spec.range_max_m), rays);
  frame.window->scene->Cast(rays);
  if (frame.moving != nullptr) frame.moving->Cast(rays);
  detect.frame = frame.index;
  tiles.Describe(tile, detect);
  ResolveHits(rays, frame.window->surfaces, detect);
}

void Simulator::Scan(std::uint32_t frame_index, Frame& frame) {
  Parts& parts = *parts_;
  const FrameContext context = parts.Begin(frame_index);
  frame.index = frame_index;
  frame.stamp_ns = context.stamp_ns;
  frame.world_from_sensor = parts.WorldFromSensor(context.stamp_ns);
  frame.Resize(parts.pattern.rows, parts.pattern.columns, 1);
  const OutputAxes axes(parts.spec.output, parts.spec.vehicle_from_sensor,
                        context.window->window_from_world);

  const auto scan_tile = [&](std::size_t tile) {
    RayTile rays;
    DetectTile detect;
    parts.TraceTile(context, tile, rays, detect);
    parts.detector.Run(detect);
    axes.Apply(context.poses, parts.tiles.times_ns(tile), detect);
    const SlotRange slots{parts.tiles.slots(tile), parts.tiles.num_firings(tile)};
    StoreReturns(rays, detect, {context.window->surfaces, parts.spec.snow_label}, slots, frame);
  };
  parts.arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, parts.tiles.num_tiles(), scan_tile); });
  parts.tiles.StoreConstants(frame);
}

FiringStory Simulator::Explain(std::uint32_t frame_index, std::uint32_t firing) {
  Parts& parts = *parts_;
  const FrameContext context = parts.Begin(frame_index);
  const auto [tile, lane] = parts.tiles.PlaceOf(firing);
  RayTile rays;
  DetectTile detect;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (float* unknown : {detect.intensity, detect.power_ratio, detect.range_m}) {
    std::fill_n(unknown, kTileSize, kNaN);
  }
  parts.TraceTile(context, tile, rays, detect);
  const Surface& surface = context.window->surfaces[rays.surface[lane]];
  const Transform world_from_window = context.window->window_from_world.inverse();
  FiringStory story{
      .firing = firing,
      .time_ns = parts.tiles.times_ns(tile)[lane],
      .slot = parts.tiles.slots(tile)[lane],
      .direction_sensor = Vector3(static_cast<double>(detect.direction_x[lane]),
                                  static_cast<double>(detect.direction_y[lane]),
                                  static_cast<double>(detect.direction_z[lane])),
      .origin_world = world_from_window * Vector3(static_cast<double>(rays.origin_x[lane]),
                                                  static_cast<double>(rays.origin_y[lane]),
                                                  static_cast<double>(rays.origin_z[lane])),
      .label = surface.label,
      .instance = surface.instance,
      .material = surface.material,
      .reflectivity = surface.reflectivity,
      .steps = {}};
  for (const Detector::Step& step : parts.detector.steps()) {
    step.apply(detect);
    story.steps.push_back({.effect = std::string(step.effect),
                           .outcome = static_cast<Outcome>(detect.outcome[lane]),
                           .true_range_m = detect.true_range_m[lane],
                           .cos_incidence = detect.cos_incidence[lane],
                           .intensity = detect.intensity[lane],
                           .power_ratio = detect.power_ratio[lane],
                           .range_m = detect.range_m[lane]});
  }
  return story;
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
        alone.CastRanges(rays);
        const std::size_t num_firings = parts.tiles.num_firings(tile);
        counts[object] += static_cast<std::uint32_t>(
            std::count_if(rays.range_m, rays.range_m + num_firings,
                          [&](float range_m) { return range_m < range_max_m; }));
      }
    });
  });
  return counts;
}

}  // namespace railcast
