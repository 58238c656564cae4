#include "railcast/simulator.h"

#include <tbb/enumerable_thread_specific.h>
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
#include "core/base/parallelism.h"
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
#include "core/simulate/simulator_parts.h"
#include "core/simulate/velocity_meter.h"
#include "core/simulate/view_counter.h"

namespace railcast {
namespace {

void CheckSimulatorSpec(const SimulatorSpec& spec, const std::vector<Material>& materials) {
  CheckDetectorSpec(spec.detector);
  if (spec.snow_material < materials.size()) return;
  throw InputError(
      {{"/snow_material",
        "must be the index of one of " + std::to_string(materials.size()) + " materials",
        std::to_string(spec.snow_material)}});
}

// The sources of all tiles, in the order of the tiles, whichever thread found them.
std::vector<HaloSource> Joined(const std::vector<std::vector<HaloSource>>& found) {
  std::vector<HaloSource> all;
  for (const std::vector<HaloSource>& of_tile : found) {
    all.insert(all.end(), of_tile.begin(), of_tile.end());
  }
  return all;
}

}  // namespace

Simulator::Simulator(std::shared_ptr<const World> world,
                     ScanPattern pattern,
                     const MaterialLibrary& materials,
                     const SimulatorSpec& spec,
                     int num_threads)
    : Simulator(MakeSceneStore(std::move(world), materials, spec.isa),
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
                         .full_scenes{},
                         .own{},
                         .variants{},
                         .others{},
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
  parts_->parallelism = AllowThreads(num_workers);
  parts_->arena.terminate();
  parts_->arena.initialize(num_workers);
}

std::size_t Simulator::num_threads() const {
  return static_cast<std::size_t>(parts_->arena.max_concurrency());
}

Detection::Detection(const SimulatorSpec& spec,
                     const std::vector<Material>& materials,
                     const ScanPattern& pattern)
    : detector(spec.detector),
      tracer(std::make_unique<const BeamTracer>(spec, materials, pattern)),
      work(std::make_unique<WorkOfThreads>(
          [tracer = tracer.get()] { return BeamTracer::Work(*tracer); })) {
  if (EffectBetweenBeams(detector) != nullptr) halo.emplace(detector);
}

void Simulator::Parts::UseSpec() {
  own.emplace(spec, materials, pattern);
  PrepareScenes();
  const DetectorSpec& detector = spec.detector;
  const Wind wind(WindVelocity_mps(detector.weather), detector.air_seed);
  ForScenes([&](FrameScenes& each) {
    each.UseWind(wind);
    each.UseMotion(detector.velocity.has_value());
  });
  others.clear();
}

void Simulator::Parts::PrepareScenes() {
  std::vector<EffectSet> sets = {spec.detector.effects};
  for (const FiringVariant& variant : variants) sets.push_back(variant.effects);
  const bool has_texture = std::ranges::any_of(sets, &EffectSet::texture);
  const bool casts_beams = std::ranges::any_of(sets, [&](const EffectSet& effects) {
    DetectorSpec detector = spec.detector;
    detector.effects = effects;
    return CastsBeams(detector);
  });
  ForScenes([&](FrameScenes& each) {
    each.UseTexture(has_texture);
    if (casts_beams) {
      each.UseBeams(spec.detector.footprint_labels);
    } else {
      each.UseRaysAlone();
    }
  });
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
  parts_->ForScenes([&](FrameScenes& each) { each.UseWorld(world); });
}

void Simulator::UseProgress(WindowProgress progress) {
  parts_->ForScenes([&](FrameScenes& each) { each.UseProgress(progress); });
}

void Simulator::KeepWindows(std::size_t num) {
  parts_->ForScenes([&](FrameScenes& each) { each.KeepWindows(num); });
}

void Simulator::UseLastStamp(std::int64_t stamp_ns) {
  parts_->ForScenes([&](FrameScenes& each) { each.UseLastStamp(stamp_ns); });
}

CastFrame Simulator::Parts::CastOf(const Detection& by,
                                   const FrameScene& scene,
                                   const FiringTiles& firings) const {
  CastFrame cast{scene.index,      scene.poses,    scene,
                 scene.surfaces(), &scene.wires(), scene.window->window_from_world};
  if (by.detector.effects.spray && HasSpray(by.detector)) {
    cast.spray = SprayCloudsOf(scenes.world(), by.detector.weather,
                               {scene.stamp_ns, firings.duration_ns()}, cast.window_from_world);
  }
  cast.mirrors = by.tracer->MirrorsAmong(cast.surfaces, cast.window_from_world);
  cast.takes_no_rays = true;
  if (scene.motion) cast.motion = &*scene.motion;
  cast.textured = &scene.textured;
  return cast;
}

void Simulator::Parts::ForAllEchoes(const Detection& by,
                                    const CastFrame& cast,
                                    const FiringTiles& firings,
                                    ViewCounter* views,
                                    const EchoUse& use) {
  // A halo reaches beams of other tiles. Without bright echoes, which are rare, all is done after
  // one pass; otherwise the tiles that halos reach are made a second time.
  std::vector<std::vector<HaloSource>> found(by.halo ? firings.num_tiles() : 0);
  ForEachTile(firings.num_tiles(), [&](std::size_t tile) {
    BeamTracer::Work& mine = by.work->local();
    by.tracer->MakeEchoes(cast, firings, tile, mine);
    if (by.halo) by.halo->CollectSources(mine.echoes, found[tile]);
    use(tile, mine);
    if (views != nullptr) views->AddTraced(*by.tracer, firings, tile, mine);
  });
  const std::vector<HaloSource> sources = Joined(found);
  if (sources.empty()) return;
  ForEachTile(firings.num_tiles(), [&](std::size_t tile) {
    BeamTracer::Work& mine = by.work->local();
    firings.Describe(tile, mine.echoes.first);
    if (!by.halo->Reaches(mine.echoes.first, sources)) return;
    by.tracer->MakeEchoes(cast, firings, tile, mine);
    by.halo->AddEchoes(mine.echoes, sources);
    use(tile, mine);
  });
}

std::vector<HaloSource> Simulator::Parts::FindHaloSources(const CastFrame& cast,
                                                          const FiringTiles& firings) {
  std::vector<std::vector<HaloSource>> found(firings.num_tiles());
  ForEachTile(firings.num_tiles(), [&](std::size_t tile) {
    BeamTracer::Work& mine = own->work->local();
    own->tracer->MakeEchoes(cast, firings, tile, mine);
    own->halo->CollectSources(mine.echoes, found[tile]);
  });
  return Joined(found);
}

void Simulator::Parts::Prepare(std::uint32_t frame_index,
                               const FiringTiles& firings,
                               Frame& frame) const {
  frame.index = frame_index;
  frame.stamp_ns = pattern.StampNs(frame_index);
  frame.world_from_sensor = ReportedPose(frame.stamp_ns);
  frame.duration_ns = firings.duration_ns();
  frame.world_from_sensor_end = ReportedPose(frame.stamp_ns + frame.duration_ns);
  frame.poses_between = PosesBetween(frame.duration_ns, [&](std::uint32_t time_ns) {
    return ReportedPose(frame.stamp_ns + time_ns);
  });
}

void Simulator::Parts::Fill(const Detection& by,
                            const CastFrame& cast,
                            const FiringTiles& firings,
                            Frame& frame,
                            ViewCounter* views) {
  const OutputAxes axes(spec.output, spec.origin_place,
                        {spec.vehicle_from_sensor, spec.nominal_from_true.inverse()},
                        cast.window_from_world, frame.world_from_sensor);
  const ReturnStore store(by.return_rule(), by.tracer->has_beams());
  const Transform world_from_window = cast.window_from_world.inverse();
  const double time_s = SecondsFromNs(frame.stamp_ns);
  std::optional<VelocityMeter> velocities;
  if (frame.has_velocity) velocities.emplace(by.detector, cast);

  ForAllEchoes(by, cast, firings, views, [&](std::size_t tile, BeamTracer::Work& mine) {
    by.tracer->detector().Detect({mine.rays, world_from_window, time_s}, mine.echoes);
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
  if (!by.tracer->has_beams()) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::fill(frame.footprint_share.begin(), frame.footprint_share.end(), kNaN);
    std::fill(frame.mixed_share.begin(), frame.mixed_share.end(), kNaN);
  }
}

void Simulator::Parts::Scan(const CastFrame& cast,
                            const FiringTiles& firings,
                            Frame& frame,
                            ViewCounter* views) {
  // A host does not say how its things move.
  frame.has_velocity = cast.motion != nullptr;
  Prepare(cast.index, firings, frame);
  frame.Resize(pattern.rows, pattern.columns, NumReturns(own->return_mode()));
  Fill(*own, cast, firings, frame, views);
  firings.StoreConstants(frame);
}

std::shared_ptr<BegunFrame> Simulator::Begin(std::uint32_t frame_index) {
  return WithinMemory(parts_->Making(frame_index),
                      [&] { return std::make_shared<BegunFrame>(parts_->Begin(frame_index)); });
}

void Simulator::Scan(BegunFrame& begun, Frame& frame) {
  WithinMemory(parts_->Making(begun.index), [&] {
    const FrameScene& scene = parts_->SceneOf(begun);
    const FiringTiles& firings = parts_->TilesOf(begun);
    parts_->Scan(parts_->CastOf(*parts_->own, scene, firings), firings, frame);
  });
}

void Simulator::Scan(BegunFrame& begun, Frame& frame, std::vector<ObjectView>& views) {
  WithinMemory(parts_->Making(begun.index), [&] {
    const FrameScene& scene = parts_->SceneOf(begun);
    const FiringTiles& firings = parts_->TilesOf(begun);
    const CastFrame cast = parts_->CastOf(*parts_->own, scene, firings);
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
    parts_->Scan(
        {.index = frame_index,
         .poses = poses,
         .caster = host.caster,
         .surfaces = host.surfaces,
         .wires = nullptr,
         .window_from_world = host.window_from_world,
         .spray = {},
         .mirrors = parts_->own->tracer->MirrorsAmong(host.surfaces, host.window_from_world)},
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
    parts_->ForEachTile(aimed->size(), [&](std::size_t tile) {
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
  ForEachTile(firings.num_tiles(), [&](std::size_t tile) {
    views.Add(*own->tracer, firings, tile, own->work->local());
  });
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
