#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallelism.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/bright_echo.h"
#include "core/simulate/beam_tracer.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_scene.h"
#include "core/simulate/returns.h"
#include "core/simulate/view_counter.h"
#include "railcast/simulator.h"

namespace railcast {

/// A detector's spec, and what makes returns of firings by it.
struct Detection {
  using WorkOfThreads = tbb::enumerable_thread_specific<BeamTracer::Work>;

  Detection(const SimulatorSpec& spec,
            const std::vector<Material>& materials,
            const ScanPattern& pattern);

  DetectorSpec detector;
  std::unique_ptr<const BeamTracer> tracer;
  std::unique_ptr<WorkOfThreads> work;
  std::optional<Halo> halo;  // If that effect is on and has a cause.

  [[nodiscard]] ReturnMode return_mode() const {
    return tracer->has_beams() ? detector.receiver.return_mode : ReturnMode::kStrongest;
  }
  [[nodiscard]] ReturnRule return_rule() const {
    const EffectSet& effects = detector.effects;
    const ReceiverSpec& receiver = detector.receiver;
    return {return_mode(), effects.dead_time ? static_cast<float>(DeadLength_m(receiver)) : 0.0F,
            effects.saturation ? static_cast<float>(receiver.saturation_power_ratio.value_or(0.0))
                               : 0.0F};
  }
};

/// What a simulator consists of; its functions are in several files.
struct Simulator::Parts {
  using EchoUse = std::function<void(std::size_t tile, BeamTracer::Work& work)>;

  ScanPattern pattern;
  SimulatorSpec spec;
  std::vector<Material> materials;
  std::shared_ptr<const FiringTiles> tiles;  // For all frames, or for frame 0 if they differ.
  FrameScenes scenes;
  /// In full detail, for variants; null if none asks for it, or if `scenes` are.
  std::unique_ptr<FrameScenes> full_scenes;
  std::optional<Detection> own;  ///< By the spec; always there once the simulator is made.
  std::vector<FiringVariant> variants;
  std::vector<Detection> others;  ///< By the variants; empty if the spec has changed since.
  std::mutex others_mutex{};
  HeldThreads parallelism;
  tbb::task_arena arena;

  /// Where the sensor is said to be.
  [[nodiscard]] Transform ReportedPose(std::int64_t time_ns) const {
    return scenes.WorldFromSensor(time_ns) * spec.nominal_from_true.inverse();
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
  [[nodiscard]] const ScanPattern& PatternOf(BegunFrame& begun) const {
    if (pattern.repeats()) return pattern;
    if (begun.pattern == nullptr) {
      begun.pattern = std::make_shared<const ScanPattern>(PatternOfFrame(pattern, begun.index));
    }
    return *begun.pattern;
  }
  [[nodiscard]] const FiringTiles& TilesOf(BegunFrame& begun) const {
    if (begun.tiles == nullptr) {
      begun.tiles = begun.pattern == nullptr ? TilesOf(begun.index)
                                             : std::make_shared<const FiringTiles>(*begun.pattern);
    }
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
  /// Calls `use` on all scenes that there are.
  template <typename Use>
  void ForScenes(const Use& use) {
    use(scenes);
    if (full_scenes != nullptr) use(*full_scenes);
  }
  /// Has scenes made with what the spec's effects and those of the variants need.
  void PrepareScenes();
  /// Makes `others` unless they are there. Another spec needs others, but only for firings that are
  /// made in variants, so that weather that is changed live does not wait for them.
  void MakeOthers();
  /// Calls `use(tile, work)` on the echoes of every tile as they reach the receiver.
  /// @param views Receives what every firing sees; may be null.
  void ForAllEchoes(const Detection& by,
                    const CastFrame& cast,
                    const FiringTiles& firings,
                    ViewCounter* views,
                    const EchoUse& use);
  [[nodiscard]] std::vector<HaloSource> FindHaloSources(const CastFrame& cast,
                                                        const FiringTiles& firings);
  /// Sets all of a frame but its shape and what its slots hold.
  /// @param firings Those of the whole frame.
  void Prepare(std::uint32_t frame_index, const FiringTiles& firings, Frame& frame) const;
  /// Stores what becomes of firings in their slots of a frame that is prepared, but for what is the
  /// same in all frames (FiringTiles::StoreConstants()).
  void Fill(const Detection& by,
            const CastFrame& cast,
            const FiringTiles& firings,
            Frame& frame,
            ViewCounter* views = nullptr);
  void Scan(const CastFrame& cast,
            const FiringTiles& firings,
            Frame& frame,
            ViewCounter* views = nullptr);
  [[nodiscard]] std::vector<ObjectView> ViewObjects(const FrameScene& scene,
                                                    const FiringTiles& firings);
  [[nodiscard]] CastFrame CastOf(const Detection& by,
                                 const FrameScene& scene,
                                 const FiringTiles& firings) const;
  /// Calls `job(tile)` for each of so many tiles, on the run's threads.
  template <typename Job>
  void ForEachTile(std::size_t num_tiles, const Job& job) {
    // One by one, since a tile takes up to milliseconds, for which others would wait at the end.
    arena.execute(
        [&] { tbb::parallel_for(std::size_t{0}, num_tiles, job, tbb::simple_partitioner{}); });
  }
};

}  // namespace railcast
