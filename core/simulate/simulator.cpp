#include "railcast/simulator.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/wind_velocity.h"
#include "core/detect/clutter/bright_echo.h"
#include "core/detect/detector/effect_table.h"
#include "core/detect/effects/spray.h"
#include "core/simulate/beam_tracer.h"
#include "core/simulate/detail_choice.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/frame_scene.h"
#include "core/simulate/output_axes.h"
#include "core/simulate/returns.h"
#include "core/simulate/story_echoes.h"
#include "core/simulate/velocity_meter.h"
#include "core/simulate/view_counter.h"

namespace railcast {
namespace {

CastFrame CastOf(const FrameScene& scene,
                 const World& world,
                 const DetectorSpec& spec,
                 const BeamTracer& tracer,
                 std::uint32_t duration_ns) {
  CastFrame cast{scene.index,      scene.poses,    scene,
                 scene.surfaces(), &scene.wires(), scene.window->window_from_world};
  if (spec.effects.spray && HasSpray(spec)) {
    cast.spray =
        SprayCloudsOf(world, spec.weather, {scene.stamp_ns, duration_ns}, cast.window_from_world);
  }
  cast.mirrors = tracer.MirrorsAmong(cast.surfaces, cast.window_from_world);
  cast.takes_no_rays = true;
  if (scene.motion) cast.motion = &*scene.motion;
  return cast;
}

void CheckSimulatorSpec(const SimulatorSpec& spec, const std::vector<Material>& materials) {
  CheckDetectorSpec(spec.detector);
  if (spec.snow_material < materials.size()) return;
  throw InputError(
      {{"/snow_material",
        "must be the index of one of " + std::to_string(materials.size()) + " materials",
        std::to_string(spec.snow_material)}});
}

using EchoUse = std::function<void(std::size_t tile, BeamTracer::Work& work)>;

// The sources of all tiles, in the order of the tiles, whichever thread found them.
std::vector<HaloSource> Joined(const std::vector<std::vector<HaloSource>>& found) {
  std::vector<HaloSource> all;
  for (const std::vector<HaloSource>& of_tile : found) {
    all.insert(all.end(), of_tile.begin(), of_tile.end());
  }
  return all;
}

using WorkOfThreads = tbb::enumerable_thread_specific<BeamTracer::Work>;

}  // namespace

struct Simulator::Parts {
  ScanPattern pattern;
  SimulatorSpec spec;
  std::vector<Material> materials;
  std::shared_ptr<const FiringTiles> tiles;  // Of all frames, or of frame 0 if they differ.
  FrameScenes scenes;
  std::unique_ptr<const BeamTracer> tracer;
  std::unique_ptr<WorkOfThreads> work;
  std::optional<Halo> halo;  // If that effect is on and has a cause.
  std::unique_ptr<tbb::global_control> parallelism;
  tbb::task_arena arena;

  [[nodiscard]] ReturnMode return_mode() const {
    return tracer->has_beams() ? spec.detector.receiver.return_mode : ReturnMode::kStrongest;
  }
  /// Where the sensor is said to be.
  [[nodiscard]] Transform ReportedPose(std::int64_t time_ns) const {
    return scenes.WorldFromSensor(time_ns) * spec.nominal_from_true.inverse();
  }
  [[nodiscard]] ReturnRule return_rule() const {
    const EffectSet& effects = spec.detector.effects;
    const ReceiverSpec& receiver = spec.detector.receiver;
    return {return_mode(), effects.dead_time ? static_cast<float>(DeadLength_m(receiver)) : 0.0F,
            effects.saturation ? static_cast<float>(receiver.saturation_power_ratio.value_or(0.0))
                               : 0.0F};
  }
  [[nodiscard]] float range_max_m() const { return static_cast<float>(spec.detector.range_max_m); }
  [[nodiscard]] BegunFrame Begin(std::uint32_t frame_index) {
    return arena.execute([&] { return scenes.Begin(frame_index, pattern.StampNs(frame_index)); });
  }
  [[nodiscard]] const FrameScene& SceneOf(BegunFrame& begun) {
    arena.execute([&] { static_cast<void>(scenes.SceneOf(begun)); });
    return *begun.scene;
  }
  [[nodiscard]] std::shared_ptr<const FiringTiles> TilesOf(std::uint32_t frame_index) const {
    if (pattern.repeats()) return tiles;
    return std::make_shared<const FiringTiles>(PatternOfFrame(pattern, frame_index));
  }
  [[nodiscard]] const FiringTiles& TilesOf(BegunFrame& begun) const {
    if (begun.tiles == nullptr) begun.tiles = TilesOf(begun.index);
    return *begun.tiles;
  }
  /// For WithinMemory: "making frame 3 (28800 firings)".
  [[nodiscard]] auto Making(std::uint32_t frame_index) const {
    return [this, frame_index] {
      return "making frame " + std::to_string(frame_index) + " (" +
             std::to_string(pattern.num_firings()) + " firings)";
    };
  }
  void UseSpec();
  /// Calls `use(tile, work)` on the echoes of every tile as they reach the receiver.
  /// @param views Receives what every firing sees; may be null.
  void ForAllEchoes(const CastFrame& cast,
                    const FiringTiles& firings,
                    ViewCounter* views,
                    const EchoUse& use);
  [[nodiscard]] std::vector<HaloSource> FindHaloSources(const CastFrame& cast,
                                                        const FiringTiles& firings);
  void Scan(const CastFrame& cast,
            const FiringTiles& firings,
            Frame& frame,
            ViewCounter* views = nullptr);
  [[nodiscard]] std::vector<ObjectView> ViewObjects(const FrameScene& scene,
                                                    const FiringTiles& firings);
  [[nodiscard]] CastFrame CastOf(const FrameScene& scene, const FiringTiles& firings) const {
    return railcast::CastOf(scene, scenes.world(), spec.detector, *tracer, firings.duration_ns());
  }
  /// Calls `work(tile)` for every tile, on the run's threads.
  template <typename Job>
  void ForEachTile(const Job& job) {
    // One by one, since a tile takes up to milliseconds, for which others would wait at the end.
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, tiles->num_tiles(), job, tbb::simple_partitioner{});
    });
  }
};

Simulator::Simulator(std::shared_ptr<const World> world,
                     ScanPattern pattern,
                     const MaterialLibrary& materials,
                     const SimulatorSpec& spec,
                     int num_threads)
    : Simulator(std::make_shared<SceneStore>(std::move(world), materials, spec.isa),
                std::move(pattern),
                materials,
                spec,
                num_threads) {}

Simulator::Simulator(std::shared_ptr<SceneStore> store,
                     ScanPattern pattern,
                     const MaterialLibrary& materials,
                     const SimulatorSpec& spec,
                     int num_threads) {
  CheckSimulatorSpec(spec, materials.materials());
  auto tiles = std::make_shared<const FiringTiles>(pattern);
  const FrameSceneSpec scene_spec{
      .range_max_m = spec.detector.range_max_m,
      .vehicle_from_sensor = spec.vehicle_from_sensor * spec.nominal_from_true,
      .detail = DetailOf(spec, pattern),
      .duration_ns = tiles->duration_ns()};
  parts_.reset(new Parts{.pattern = std::move(pattern),
                         .spec = spec,
                         .materials = materials.materials(),
                         .tiles = std::move(tiles),
                         .scenes{std::move(store), scene_spec},
                         .tracer{},
                         .work{},
                         .halo{},
                         .parallelism{},
                         .arena{}});
  parts_->UseSpec();
  UseThreads(num_threads);
}

Simulator::~Simulator() = default;

const World& Simulator::world() const {
  return parts_->scenes.world();
}
const std::shared_ptr<const World>& Simulator::shared_world() const {
  return parts_->scenes.shared_world();
}
const ScanPattern& Simulator::pattern() const {
  return parts_->pattern;
}
Transform Simulator::WorldFromSensor(std::int64_t time_ns) const {
  return parts_->ReportedPose(time_ns);
}

void Simulator::UseThreads(int num_threads) {
  const int num_workers = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  // Without this, TBB starts no more threads than there are cores.
  parts_->parallelism = std::make_unique<tbb::global_control>(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(std::max(num_workers, tbb::info::default_concurrency())));
  parts_->arena.terminate();
  parts_->arena.initialize(num_workers);
}

std::size_t Simulator::num_threads() const {
  return static_cast<std::size_t>(parts_->arena.max_concurrency());
}

void Simulator::Parts::UseSpec() {
  tracer = std::make_unique<const BeamTracer>(spec, materials, pattern);
  work = std::make_unique<WorkOfThreads>(
      [tracer = tracer.get()] { return BeamTracer::Work(*tracer); });
  if (tracer->casts_beams()) scenes.UseBeams();
  const DetectorSpec& detector = spec.detector;
  scenes.UseWind(Wind(WindVelocity_mps(detector.weather), detector.air_seed));
  scenes.UseMotion(detector.velocity.has_value());
  halo.reset();
  if (EffectBetweenBeams(detector) != nullptr) halo.emplace(detector);
}

const SimulatorSpec& Simulator::spec() const {
  return parts_->spec;
}

void Simulator::Use(const SimulatorSpec& spec) {
  CheckSimulatorSpec(spec, parts_->materials);
  parts_->spec = spec;
  parts_->UseSpec();
}

void Simulator::UseWorld(std::shared_ptr<const World> world) {
  parts_->scenes.UseWorld(std::move(world));
}

void Simulator::UseProgress(WindowProgress progress) {
  parts_->scenes.UseProgress(std::move(progress));
}

void Simulator::UseLastStamp(std::int64_t stamp_ns) {
  parts_->scenes.UseLastStamp(stamp_ns);
}

void Simulator::Parts::ForAllEchoes(const CastFrame& cast,
                                    const FiringTiles& firings,
                                    ViewCounter* views,
                                    const EchoUse& use) {
  // A halo reaches beams of other tiles. Without bright echoes, which are rare, all is done after
  // one pass; otherwise the tiles that halos reach are made a second time.
  std::vector<std::vector<HaloSource>> found(halo ? firings.num_tiles() : 0);
  ForEachTile([&](std::size_t tile) {
    BeamTracer::Work& mine = work->local();
    tracer->MakeEchoes(cast, firings, tile, mine);
    if (halo) halo->CollectSources(mine.echoes, found[tile]);
    use(tile, mine);
    if (views != nullptr) views->AddTraced(*tracer, firings, tile, mine);
  });
  const std::vector<HaloSource> sources = Joined(found);
  if (sources.empty()) return;
  ForEachTile([&](std::size_t tile) {
    BeamTracer::Work& mine = work->local();
    firings.Describe(tile, mine.echoes.first);
    if (!halo->Reaches(mine.echoes.first, sources)) return;
    tracer->MakeEchoes(cast, firings, tile, mine);
    halo->AddEchoes(mine.echoes, sources);
    use(tile, mine);
  });
}

std::vector<HaloSource> Simulator::Parts::FindHaloSources(const CastFrame& cast,
                                                          const FiringTiles& firings) {
  std::vector<std::vector<HaloSource>> found(firings.num_tiles());
  ForEachTile([&](std::size_t tile) {
    BeamTracer::Work& mine = work->local();
    tracer->MakeEchoes(cast, firings, tile, mine);
    halo->CollectSources(mine.echoes, found[tile]);
  });
  return Joined(found);
}

void Simulator::Parts::Scan(const CastFrame& cast,
                            const FiringTiles& firings,
                            Frame& frame,
                            ViewCounter* views) {
  frame.index = cast.index;
  frame.stamp_ns = pattern.StampNs(cast.index);
  frame.world_from_sensor = ReportedPose(frame.stamp_ns);
  frame.duration_ns = firings.duration_ns();
  frame.world_from_sensor_end = ReportedPose(frame.stamp_ns + frame.duration_ns);
  frame.poses_between = PosesBetween(frame.duration_ns, [&](std::uint32_t time_ns) {
    return ReportedPose(frame.stamp_ns + time_ns);
  });
  const ReturnRule rule = return_rule();
  // A host does not say how its things move.
  frame.has_velocity = cast.motion != nullptr;
  frame.Resize(pattern.rows, pattern.columns, NumReturns(rule.mode));
  const OutputAxes axes(spec.output, spec.origin_place,
                        {spec.vehicle_from_sensor, spec.nominal_from_true.inverse()},
                        cast.window_from_world, frame.world_from_sensor);
  const ReturnStore store(rule, tracer->has_beams());
  const Transform world_from_window = cast.window_from_world.inverse();
  const double time_s = SecondsFromNs(frame.stamp_ns);
  std::optional<VelocityMeter> velocities;
  if (frame.has_velocity) velocities.emplace(spec.detector, cast);

  ForAllEchoes(cast, firings, views, [&](std::size_t tile, BeamTracer::Work& mine) {
    tracer->detector().Detect({mine.rays, world_from_window, time_s}, mine.echoes);
    firings.MoveToOrigins(tile, mine.echoes);
    axes.Apply(cast.poses, firings.times_ns(tile), mine.echoes);
    StoredEcho measure;
    if (velocities) {
      measure = [&](const EchoTiles::Place& echo, std::size_t beam, std::size_t slot) {
        velocities->Store(echo, beam, mine, slot, frame);
      };
    }
    store.Store(mine.echoes, cast.surfaces, {firings.slots(tile), firings.num_firings(tile)}, frame,
                measure);
  });
  firings.StoreConstants(frame);
  if (!tracer->has_beams()) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::fill(frame.footprint_share.begin(), frame.footprint_share.end(), kNaN);
    std::fill(frame.mixed_share.begin(), frame.mixed_share.end(), kNaN);
  }
}

std::shared_ptr<BegunFrame> Simulator::Begin(std::uint32_t frame_index) {
  return WithinMemory(parts_->Making(frame_index),
                      [&] { return std::make_shared<BegunFrame>(parts_->Begin(frame_index)); });
}

void Simulator::Scan(BegunFrame& begun, Frame& frame) {
  WithinMemory(parts_->Making(begun.index), [&] {
    const FrameScene& scene = parts_->SceneOf(begun);
    const FiringTiles& firings = parts_->TilesOf(begun);
    parts_->Scan(parts_->CastOf(scene, firings), firings, frame);
  });
}

void Simulator::Scan(BegunFrame& begun, Frame& frame, std::vector<ObjectView>& views) {
  WithinMemory(parts_->Making(begun.index), [&] {
    const FrameScene& scene = parts_->SceneOf(begun);
    const FiringTiles& firings = parts_->TilesOf(begun);
    const CastFrame cast = parts_->CastOf(scene, firings);
    ViewCounter counter(cast, world(), parts_->scenes.ObjectsAlone(scene));
    parts_->Scan(cast, firings, frame, &counter);
    views = counter.Total();
  });
}

void Simulator::Scan(std::uint32_t frame_index, Frame& frame) {
  Scan(*Begin(frame_index), frame);
}

void Simulator::Scan(std::uint32_t frame_index, const HostScene& host, Frame& frame) {
  WithinMemory(parts_->Making(frame_index), [&] {
    const FramePoses poses =
        parts_->scenes.PosesIn(host.window_from_world, parts_->pattern.StampNs(frame_index));
    parts_->Scan({.index = frame_index,
                  .poses = poses,
                  .caster = host.caster,
                  .surfaces = host.surfaces,
                  .wires = nullptr,
                  .window_from_world = host.window_from_world,
                  .spray = {},
                  .mirrors = parts_->tracer->MirrorsAmong(host.surfaces, host.window_from_world)},
                 *parts_->TilesOf(frame_index), frame);
  });
}

void Simulator::VisitScene(std::uint32_t frame_index,
                           const std::function<void(const SceneOfFrame&)>& visit) {
  VisitScene(*Begin(frame_index), visit);
}

void Simulator::VisitScene(BegunFrame& begun,
                           const std::function<void(const SceneOfFrame&)>& visit) {
  const FrameScene& scene = parts_->SceneOf(begun);
  const Transform& window_from_world = scene.window->window_from_world;
  const SceneOfFrame view{
      .caster = scene,
      .surfaces = scene.surfaces(),
      .wires = &scene.wires(),
      .stamp_ns = scene.stamp_ns,
      .window_from_world = window_from_world,
      .window_from_vehicle = window_from_world * world().WorldFromVehicle(scene.stamp_ns)};
  Execute([&] { visit(view); });
}

void Simulator::Execute(const std::function<void()>& work) {
  parts_->arena.execute([&] { work(); });
}

FiringStory Simulator::Explain(std::uint32_t frame_index, std::uint32_t firing) {
  Parts& parts = *parts_;
  BegunFrame begun = parts.Begin(frame_index);
  const FrameScene& scene = parts.SceneOf(begun);
  const FiringTiles& firings = parts.TilesOf(begun);
  const CastFrame cast = parts.CastOf(scene, firings);
  const FiringTiles::Place place = firings.PlaceOf(firing);
  const std::size_t tile = place.tile;
  const std::size_t lane = place.lane;
  BeamTracer::Work work(*parts.tracer);
  DetectTile& first = work.echoes.first;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (float* unknown : {first.intensity, first.power_ratio, first.range_m}) {
    std::fill_n(unknown, kTileSize, kNaN);
  }
  FiringStory story;
  std::size_t num_echoes = 1;
  const auto record = [&](std::string_view effect) {
    const std::size_t num_before = std::exchange(num_echoes, EchoesOf(work.echoes, lane).size());
    story.steps.push_back({.effect = std::string(effect),
                           .outcome = static_cast<Outcome>(first.outcome[lane]),
                           .true_range_m = first.true_range_m[lane],
                           .cos_incidence = first.cos_incidence[lane],
                           .intensity = first.intensity[lane],
                           .power_ratio = first.power_ratio[lane],
                           .range_m = first.range_m[lane],
                           .num_added_echoes = num_echoes - num_before});
  };
  parts.tracer->MakeEchoes(cast, firings, tile, work, record);
  const RayTile& rays = work.rays;
  if (parts.halo) {
    parts.halo->AddEchoes(work.echoes, parts.FindHaloSources(cast, firings));
    record(EffectBetweenBeams(spec().detector)->name);
  }
  const Transform world_from_window = scene.window->window_from_world.inverse();
  const double time_s = SecondsFromNs(parts.pattern.StampNs(frame_index));
  parts.tracer->detector().Detect({rays, world_from_window, time_s}, work.echoes, record);
  const Surface& surface = scene.surfaces()[first.surface[lane]];
  story.firing = firing;
  story.time_ns = firings.times_ns(tile)[lane];
  story.slot = firings.slots(tile)[lane] * NumReturns(parts.return_mode());
  story.direction_sensor = Vector3(static_cast<double>(first.direction_x[lane]),
                                   static_cast<double>(first.direction_y[lane]),
                                   static_cast<double>(first.direction_z[lane]));
  story.origin_world = world_from_window * Vector3(static_cast<double>(rays.origin_x[lane]),
                                                   static_cast<double>(rays.origin_y[lane]),
                                                   static_cast<double>(rays.origin_z[lane]));
  story.label = surface.label;
  story.instance = surface.instance;
  story.material = surface.material;
  story.reflectivity = surface.reflectivity;
  TellEchoes(scene.surfaces(), parts.return_rule(), lane, work.echoes, story);
  return story;
}

std::function<void()> Simulator::MakeRawTrace(std::uint32_t frame_index) {
  BegunFrame begun = parts_->Begin(frame_index);
  static_cast<void>(parts_->SceneOf(begun));
  const FiringTiles& firings = parts_->TilesOf(begun);
  const std::shared_ptr<const FrameScene> scene = std::move(begun.scene);
  auto aimed = std::make_shared<std::vector<RayTile>>(firings.num_tiles());
  for (std::size_t tile = 0; tile < aimed->size(); ++tile) {
    firings.Aim(tile, scene->poses, parts_->range_max_m(), (*aimed)[tile]);
  }
  return [this, scene, aimed] {
    parts_->ForEachTile([&](std::size_t tile) {
      RayTile& rays = (*aimed)[tile];
      std::fill_n(rays.range_m, kTileSize, parts_->range_max_m());
      scene->CastRanges(rays);
    });
  };
}

std::vector<ObjectView> Simulator::Parts::ViewObjects(const FrameScene& scene,
                                                      const FiringTiles& firings) {
  const CastFrame cast{scene.index,      scene.poses, scene,
                       scene.surfaces(), nullptr,     scene.window->window_from_world};
  ViewCounter views(cast, scenes.world(), scenes.ObjectsAlone(scene));
  ForEachTile([&](std::size_t tile) { views.Add(*tracer, firings, tile, work->local()); });
  return views.Total();
}

std::vector<ObjectView> Simulator::ViewObjects(BegunFrame& begun) {
  return WithinMemory(parts_->Making(begun.index), [&] {
    return parts_->ViewObjects(parts_->SceneOf(begun), parts_->TilesOf(begun));
  });
}

std::vector<ObjectView> Simulator::ViewObjects(std::uint32_t frame_index) {
  return ViewObjects(*Begin(frame_index));
}

}  // namespace railcast
