#include "generator/extras/insert/screened_scan.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallelism.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/weather_optics.h"
#include "core/detect/detector/effect_table.h"
#include "core/detect/effects/spray.h"
#include "core/scan/firing.h"
#include "core/simulate/beam_tracer.h"
#include "core/simulate/beams_near_objects.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_scene.h"
#include "core/simulate/returns.h"
#include "core/simulate/velocity_meter.h"
#include "core/simulate/view_counter.h"
#include "generator/extras/insert/screen_echoes.h"
#include "generator/extras/insert/screen_surfaces.h"

namespace railcast {
namespace {

// What the recording shows already, or what is not known of it, is not simulated once more.
SimulatorSpec ForRecorded(SimulatorSpec spec) {
  EffectSet& effects = spec.detector.effects;
  effects.surface_condition = false;
  effects.halo = false;
  effects.ghost = false;
  effects.interference = false;
  if (!(spec.detector.weather.sun.illuminance_klx > 0.0)) effects.sunlight = false;
  return spec;
}

bool ChangesEmptyBeams(const DetectorSpec& spec) {
  if (spec.effects.threshold && FogExtinction_per_m(spec.weather) > 0.0) return true;
  const char* const names[] = {"rain",     "snow",  "extinction", "clutter",
                               "fog_echo", "spray", "sunlight",   "cover"};
  return std::ranges::any_of(names, [&](const char* name) {
    const Effect* const effect = FindEffect(name);
    return spec.effects.*effect->is_on && effect->has_cause(spec);
  });
}

ReturnMode ModeOf(ReturnMode mode, std::uint32_t returns) {
  if (NumReturns(mode) == returns) return mode;
  return returns == 1   ? ReturnMode::kStrongest
         : returns == 2 ? ReturnMode::kDual
                        : ReturnMode::kTriple;
}

ScanPattern AnyPatternOf(std::uint32_t rows, double rate_hz) {
  ScanPattern pattern;
  pattern.rows = rows;
  pattern.rate_hz = rate_hz;
  pattern.figure = std::make_shared<const MovingFigure>();  // Frames have firings of their own.
  return pattern;
}

ReturnRule RuleFor(const DetectorSpec& detector, std::uint32_t returns) {
  const EffectSet& effects = detector.effects;
  const ReceiverSpec& receiver = detector.receiver;
  return {ModeOf(receiver.return_mode, returns),
          effects.dead_time ? static_cast<float>(DeadLength_m(receiver)) : 0.0F,
          effects.saturation ? static_cast<float>(receiver.saturation_power_ratio.value_or(0.0))
                             : 0.0F};
}

// Each firing once, in the order in which the pattern would be traced.
std::vector<std::uint32_t> TracingOrder(const ScanPattern& pattern) {
  const auto& packets = pattern.packet_order;
  Check(packets.size() >= pattern.num_firings(), "every firing is in a packet");
  return {packets.begin(), packets.begin() + static_cast<std::ptrdiff_t>(pattern.num_firings())};
}

template <typename IsWanted>
std::vector<std::uint32_t> Those(const std::vector<std::uint32_t>& order,
                                 const IsWanted& is_wanted) {
  std::vector<std::uint32_t> those;
  std::ranges::copy_if(order, std::back_inserter(those), is_wanted);
  return those;
}

FewReturns ReturnsOf(std::vector<std::uint32_t> firings, const RecordedScan& all) {
  if (firings.size() == all.pattern.num_firings()) {
    std::iota(firings.begin(), firings.end(), 0U);
    return {std::move(firings), all.first, all.returns};
  }
  std::ranges::sort(firings);
  FewReturns few{.firings = std::move(firings),
                 .first = std::vector<std::uint32_t>(all.first.size())};
  std::uint32_t next = 0;  // The first firing whose place is not known yet.
  const auto fill_to = [&](std::size_t end) {
    std::fill(few.first.begin() + next, few.first.begin() + static_cast<std::ptrdiff_t>(end),
              static_cast<std::uint32_t>(few.returns.size()));
  };
  for (const std::uint32_t firing : few.firings) {
    fill_to(firing + 1);
    few.returns.insert(few.returns.end(), all.returns.begin() + all.first[firing],
                       all.returns.begin() + all.first[firing + 1]);
    next = firing + 1;
  }
  fill_to(few.first.size());
  return few;
}

// From the numbers of some returns, which screens have, to those of all.
void NumberAmongAll(const Screens& screens,
                    const RecordedScan& all,
                    std::vector<ChangedFiring>& changed) {
  for (ChangedFiring& firing : changed) {
    const std::uint32_t shift = all.first[firing.firing] - screens.first(firing.firing);
    for (ReturnNow& now : firing.returns) now.screen += now.screen == kNoScreen ? 0 : shift;
    for (LostReturn& lost : firing.lost) lost.screen += shift;
  }
}

using WorkOfThreads = tbb::enumerable_thread_specific<BeamTracer::Work>;

}  // namespace

struct ScreenedScan::Parts {
  /// One way of making firings.
  struct Way {
    SimulatorSpec spec;
    std::unique_ptr<const BeamTracer> tracer{};
    std::unique_ptr<const Detector> unfailing{};  // Loses no pulses by chance.
    std::unique_ptr<WorkOfThreads> work{};
  };

  Way own;
  std::uint16_t first_material;
  std::vector<Material> materials;
  FrameScenes scenes;
  HeldThreads parallelism;
  tbb::task_arena arena;
  std::uint32_t num_rows = 0;
  std::vector<Way> variants{};

  /// The firings of a frame that are made, in the order in which they are traced.
  struct Wanted {
    const RecordedScan& recorded;
    const FrameScene& scene;
    std::uint32_t duration_ns;
    std::uint32_t returns;
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> near;  ///< Firings that may meet an object.
  };

  /// One frame on its way.
  struct Job {
    const Way& way;
    const RecordedScan& recorded;
    const CastFrame& cast;
    const Screens& screens;
    const ScreenEchoes& screen_echoes;
    std::optional<VelocityMeter> velocities;
    Transform world_from_window;
    std::vector<ChangedFiring>& changed;
    std::vector<float>& power_kept;
  };

  void UseRows(std::uint32_t rows, double rate_hz) {
    if (rows == num_rows) return;
    num_rows = rows;
    const ScanPattern pattern = AnyPatternOf(rows, rate_hz);
    const auto use = [&](Way& way) {
      way.tracer = std::make_unique<const BeamTracer>(way.spec, materials, pattern);
      DetectorSpec without_dropout = way.spec.detector;
      without_dropout.effects.sensor_dropout = without_dropout.effects.edge_loss = false;
      way.unfailing = std::make_unique<const Detector>(
          without_dropout, DetectorSetting{.num_channels = rows, .snow = {}});
      way.work = std::make_unique<WorkOfThreads>(
          [used = way.tracer.get()] { return BeamTracer::Work(*used); });
      if (way.tracer->casts_beams()) scenes.UseBeams();
    };
    use(own);
    for (Way& way : variants) use(way);
  }

  [[nodiscard]] NearObjects ObjectsNear(const RecordedScan& recorded) const {
    std::vector<std::size_t> objects(scenes.world().objects().size());
    std::iota(objects.begin(), objects.end(), std::size_t{0});
    return {scenes.world(),
            objects,
            recorded.pattern,
            {.stamp_ns = recorded.stamp_ns,
             .vehicle_from_sensor = own.spec.vehicle_from_sensor * own.spec.nominal_from_true,
             .range_max_m = own.spec.detector.range_max_m}};
  }

  [[nodiscard]] CastFrame CastOf(const Way& way,
                                 const FrameScene& scene,
                                 const std::vector<Surface>& surfaces,
                                 const Screens& screens,
                                 std::uint32_t duration_ns) const {
    CastFrame cast{scene.index, scene.poses,    scene,
                   surfaces,    &scene.wires(), scene.window->window_from_world};
    if (scene.motion) cast.motion = &*scene.motion;
    cast.textured = &scene.textured;
    const DetectorSpec& detector = way.spec.detector;
    if (detector.effects.spray && HasSpray(detector)) {
      cast.spray = SprayCloudsOf(scenes.world(), detector.weather, {scene.stamp_ns, duration_ns},
                                 cast.window_from_world);
    }
    cast.mirrors = way.tracer->MirrorsAmong(surfaces, cast.window_from_world);
    cast.takes_no_rays = true;
    cast.besides = &screens;
    return cast;
  }

  enum class Kind { kTraced, kScreens, kEmpty };
  void MakeTile(const Job& job,
                const FiringTiles& firings,
                std::size_t tile,
                Kind kind,
                std::vector<ChangedFiring>& changed) {
    const BeamTracer& tracer = *job.way.tracer;
    BeamTracer::Work& mine = job.way.work->local();
    EchoTiles& echoes = mine.echoes;
    if (kind == Kind::kTraced) {
      tracer.MakeEchoes(job.cast, firings, tile, mine);
    } else {
      tracer.MakeKnownEchoes(job.cast, firings, tile, mine, [&](EchoTiles& empty) {
        job.screen_echoes.Put(tracer.detector(), empty);
      });
    }
    const std::vector<float> exact = job.screen_echoes.Place(echoes);
    const Detector& detector = kind == Kind::kScreens ? *job.way.unfailing : tracer.detector();
    detector.Detect({mine.rays, job.world_from_window, SecondsFromNs(job.recorded.stamp_ns)},
                    echoes);
    job.screen_echoes.Judge(echoes, exact);
    firings.MoveToOrigins(tile, echoes);
    std::array<bool, kTileSize> is_told{};
    // Beams that were traced in vain are as all others.
    const auto is_of_kind = [&](std::uint32_t firing) {
      return kind != Kind::kTraced || job.screens.met(firing) != 0;
    };
    const auto tell = [&](std::size_t lane, const EchoTiles::Place& echo) {
      is_told[lane] = is_told[lane] || kind == Kind::kTraced || job.screen_echoes.IsNews(echo);
      if (is_of_kind(echo.tile.firing[echo.lane]))
        job.screen_echoes.TellPower(echo, job.power_kept);
    };
    for (std::size_t i = 0; i < echoes.first.num_rays; ++i) tell(i, {echoes.first, i});
    for (std::size_t i = 0; i < echoes.num_more(); ++i) tell(echoes.beam_of(i), echoes.more(i));
    for (std::size_t lane = 0; lane < firings.num_firings(tile); ++lane) {
      if (!is_told[lane] || !is_of_kind(echoes.first.firing[lane])) continue;
      VelocityOfEcho velocity_of;
      if (job.velocities) {
        velocity_of = [&](const EchoTiles::Place& echo) {
          return job.velocities->Of(echo, lane, mine);
        };
      }
      ChangedFiring composed = job.screen_echoes.Compose(echoes, lane, velocity_of);
      if (job.screen_echoes.IsChanged(composed)) changed.push_back(std::move(composed));
    }
  }

  void Make(Job& job, const std::vector<std::uint32_t>& order, Kind kind) {
    if (order.empty()) return;
    const FiringTiles firings(job.recorded.pattern, order);
    std::vector<std::vector<ChangedFiring>> changed(firings.num_tiles());
    tbb::parallel_for(std::size_t{0}, firings.num_tiles(),
                      [&](std::size_t tile) { MakeTile(job, firings, tile, kind, changed[tile]); });
    for (std::vector<ChangedFiring>& of_tile : changed) {
      std::ranges::move(of_tile, std::back_inserter(job.changed));
    }
  }

  /// @param recorded_returns Of `order` if beams that meet nothing change, else of `near`: the
  ///   screens of all others take longer than the trace of a few.
  [[nodiscard]] ScreenedFrame MakeFirings(const Way& way,
                                          const Wanted& wanted,
                                          FewReturns recorded_returns,
                                          bool is_own) {
    ScreenedFrame frame;
    const auto& [recorded, scene, duration_ns, returns, order, near] = wanted;
    const DetectorSpec& detector = way.spec.detector;
    const bool makes_others = ChangesEmptyBeams(detector);
    ScreenSurfaces surfaces{.all = scene.surfaces(), .alone = {}};
    const Screens screens =
        MakeScreens(detector, std::move(recorded_returns), first_material, surfaces);
    const CastFrame cast = CastOf(way, scene, surfaces.all, screens, duration_ns);
    const ReturnRule rule = RuleFor(detector, returns);
    const ScreenEchoes screen_echoes(detector, rule, cast, screens, surfaces);
    std::vector<float> power_kept(surfaces.alone.size(), 1.0F);
    Job job{.way = way,
            .recorded = recorded,
            .cast = cast,
            .screens = screens,
            .screen_echoes = screen_echoes,
            .velocities = {},
            .world_from_window = scene.window->window_from_world.inverse(),
            .changed = frame.firings,
            .power_kept = power_kept};
    if (cast.motion != nullptr) job.velocities.emplace(detector, cast);
    Make(job, near, Kind::kTraced);
    if (makes_others) {
      std::vector<bool> is_met(recorded.pattern.num_firings());
      for (const std::uint32_t firing : near) is_met[firing] = screens.met(firing) != 0;
      const auto make = [&](Kind kind, bool has_screens) {
        Make(job,
             Those(order,
                   [&](std::uint32_t firing) {
                     return !is_met[firing] && screens.of(firing).empty() != has_screens;
                   }),
             kind);
      };
      make(Kind::kScreens, true);
      make(Kind::kEmpty, false);
    }
    std::ranges::sort(frame.firings, {}, &ChangedFiring::firing);
    NumberAmongAll(screens, recorded, frame.firings);
    if (!is_own) return frame;
    frame.power_kept.assign(recorded.returns.size(), 1.0F);
    for (const std::uint32_t firing : makes_others ? order : near) {
      std::copy_n(power_kept.begin() + screens.first(firing), screens.of(firing).size(),
                  frame.power_kept.begin() + recorded.first[firing]);
    }
    frame.views = ViewObjects(job, scene, near);
    return frame;
  }

  [[nodiscard]] std::vector<std::vector<ChangedFiring>> MakeAnew(
      const Wanted& wanted, const std::vector<std::uint32_t>& firings) {
    const Wanted those{wanted.recorded, wanted.scene, wanted.duration_ns,
                       wanted.returns,  firings,      firings};
    const FewReturns recorded_returns = ReturnsOf(firings, wanted.recorded);
    std::vector<std::vector<ChangedFiring>> changed;
    for (const Way& way : variants) {
      changed.push_back(MakeFirings(way, those, recorded_returns, false).firings);
    }
    return changed;
  }

  [[nodiscard]] std::vector<ObjectView> ViewObjects(const Job& job,
                                                    const FrameScene& scene,
                                                    const std::vector<std::uint32_t>& order) {
    ViewCounter views(job.cast, scenes.world(), scenes.ObjectsAlone(scene));
    if (!order.empty()) {
      const FiringTiles firings(job.recorded.pattern, order);
      tbb::parallel_for(std::size_t{0}, firings.num_tiles(), [&](std::size_t tile) {
        views.Add(*job.way.tracer, firings, tile, job.way.work->local());
      });
    }
    return views.Total();
  }

  [[nodiscard]] ScreenedFrame Scan(const RecordedScan& recorded,
                                   std::uint32_t returns,
                                   const Certify& certify) {
    const ScanPattern& pattern = recorded.pattern;
    if (pattern.num_firings() == 0) {
      ScreenedFrame empty;
      empty.views.resize(scenes.world().objects().size());
      return empty;
    }
    UseRows(pattern.rows, pattern.rate_hz);
    const std::uint32_t duration_ns = *std::ranges::max_element(pattern.time_ns);
    scenes.UseDuration(duration_ns);
    BegunFrame begun = scenes.Begin(recorded.index, recorded.stamp_ns);
    const FrameScene& scene = scenes.SceneOf(begun);
    const double beside_rad = BesideBeam_rad(own.spec.detector);
    double widest_rad = beside_rad;
    if (certify) {
      for (const Way& way : variants) {
        widest_rad = std::max(widest_rad, BesideBeam_rad(way.spec.detector));
      }
    }
    const NearObjects near = ObjectsNear(recorded);
    const std::vector<std::uint32_t> widest = near.Beams(widest_rad);
    // The frame itself traces no others with them, which would move its rays by parts of 1e-7.
    std::vector<bool> is_near(pattern.num_firings());
    const std::vector<std::uint32_t> narrow =
        widest_rad > beside_rad ? near.Beams(beside_rad, widest) : widest;
    for (const std::uint32_t firing : narrow) is_near[firing] = true;
    Wanted all{recorded, scene, duration_ns, returns, TracingOrder(pattern), {}};
    all.near = Those(all.order, [&](std::uint32_t firing) { return is_near[firing]; });
    ScreenedFrame frame = MakeFirings(
        own, all, ReturnsOf(ChangesEmptyBeams(own.spec.detector) ? all.order : all.near, recorded),
        true);
    if (certify) {
      certify(frame, widest,
              [&](const std::vector<std::uint32_t>& firings) { return MakeAnew(all, firings); });
    }
    return frame;
  }
};

ScreenedScan::ScreenedScan(std::shared_ptr<const World> world,
                           const std::vector<Material>& materials,
                           const SimulatorSpec& spec,
                           int num_threads) {
  CheckDetectorSpec(spec.detector);
  const MaterialLibrary library(WithScreenMaterials(materials));
  const FrameSceneSpec scene_spec{
      .range_max_m = spec.detector.range_max_m,
      .vehicle_from_sensor = spec.vehicle_from_sensor * spec.nominal_from_true};
  const int num_workers = num_threads > 0 ? num_threads : tbb::info::default_concurrency();
  parts_.reset(new Parts{.own{ForRecorded(spec)},
                         .first_material = static_cast<std::uint16_t>(library.materials().size() -
                                                                      kNumScreenMaterials),
                         .materials = library.materials(),
                         .scenes{MakeSceneStore(std::move(world), library, spec.isa), scene_spec},
                         .parallelism = AllowThreads(num_workers),
                         .arena{num_workers}});
  parts_->scenes.UseMotion(spec.detector.velocity.has_value());
  parts_->scenes.UseTexture(spec.detector.effects.texture);
}

ScreenedScan::~ScreenedScan() = default;

void ScreenedScan::UseVariants(const std::vector<FiringVariant>& variants) {
  Parts& parts = *parts_;
  for (const FiringVariant& variant : variants) {
    SimulatorSpec spec = parts.own.spec;
    spec.detector.effects = variant.effects;
    spec.detector.beam.footprint_rays = variant.footprint_rays;
    if (variant.effects.texture) parts.scenes.UseTexture(true);
    parts.variants.push_back({ForRecorded(std::move(spec))});
  }
}

ScreenedFrame ScreenedScan::Scan(const RecordedScan& recorded,
                                 std::uint32_t returns,
                                 const Certify& certify) {
  ScreenedFrame frame;
  parts_->arena.execute([&] { frame = parts_->Scan(recorded, returns, certify); });
  return frame;
}

}  // namespace railcast
