#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_scene.h"
#include "railcast/frame.h"
#include "railcast/scenario.h"

namespace railcast {

/// The modules of the published evaluation (Vir2Rail, Table 1) on railcast's own tracer. They share
/// scene, aiming and trace, and differ in nothing but what each isolates:
///
/// | 1 | one thread; every point is serialised by itself, field by field |
/// | 2 | as 1, with the beams in parallel; the output's buffer has a lock |
/// | 3 | in parallel into a buffer with a place for every beam, serialised as a whole |
/// | 4 | as 3, with rung `plausibility` and the scenario's weather |
///
/// The publication describes its modules in words. What a point holds is ours: firing, x, y, z in
/// the sensor frame in m, and label.
class ScanModules {
 public:
  static constexpr int kNumModules = 4;

  struct Point {
    std::uint32_t firing{};
    float x{}, y{}, z{};
    std::uint32_t label{};

    bool operator==(const Point&) const = default;
  };

  /// @param num_threads Of modules 2 to 4.
  ScanModules(ScenarioSpec scenario, int num_threads);

  /// Scans frame 0, from aiming the beams to the serialised points.
  /// @param module 1 to kNumModules.
  /// @return The points in the machine's byte order, one after another. Valid until the next scan.
  ///   Modules 1, 3 and 4 give them in the order of the tiles, module 2 in any order.
  [[nodiscard]] std::span<const std::uint8_t> Scan(int module);

  /// Traces the rays of frame 0, aimed beforehand, and keeps nothing but their ranges: what every
  /// module has to do at least. On one thread or as many as modules 2 to 4 use.
  void TraceOnly(bool on_one_thread) { (on_one_thread ? trace_of_one_ : trace_of_all_)(); }

 private:
  template <typename Use>
  void TraceTile(std::size_t tile, const Use& use) const;
  template <typename Job>
  void ForEachTileInParallel(const Job& job);
  void ScanOnOneThread();
  void ScanUnderALock();
  void ScanIntoPlaces();
  void ScanWithEffects();
  void SerialiseAtOnce();

  ScanPattern pattern_;
  FiringTiles tiles_;
  float range_max_m_;
  std::unique_ptr<Simulator> effects_;     // Of module 4.
  std::unique_ptr<Simulator> one_thread_;  // Of the trace alone.
  std::unique_ptr<FrameScenes> scenes_;
  BegunFrame begun_;
  const FrameScene* scene_{};
  std::function<void()> trace_of_one_, trace_of_all_;
  tbb::task_arena arena_;
  Frame frame_;
  std::mutex mutex_;
  std::vector<Point> places_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace railcast
