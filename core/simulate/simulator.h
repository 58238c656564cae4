#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/scan/scan_pattern.h"
#include "core/scene/material.h"
#include "core/scene/world.h"
#include "core/simulate/scene_store.h"
#include "core/simulate/simulator_spec.h"
#include "core/simulate/window_progress.h"
#include "core/trace/ray_tile.h"
#include "core/trace/surface.h"

namespace railcast {

/// One firing's way from hit to return, for `railcast-generate trace`. Its steps are those of the
/// first echo.
struct FiringStory {
  std::uint32_t firing{};
  std::uint32_t time_ns{};  ///< Since the stamp.
  std::uint32_t slot{};     ///< Of its first return.
  Vector3 direction_sensor;
  Vector3 origin_world;
  std::uint32_t label{};  ///< Of the surface hit, like the three after it; 0 = none.
  std::uint32_t instance{};
  std::uint16_t material{};
  float reflectivity{};

  /// The firing after one effect. NaN = not known yet.
  struct Step {
    std::string effect;
    Outcome outcome{};
    float true_range_m{};
    float cos_incidence{};
    float intensity{};
    float power_ratio{};
    float range_m{};
  };
  std::vector<Step> steps;

  /// What came back, or was too weak to; also that nothing did. NaN = none or not known.
  struct Echo {
    std::uint32_t label{};  ///< Of the surface or of the clutter.
    float true_range_m{};
    float range_m{};
    float power_ratio{};
    float footprint_share{};
    Outcome outcome{};
    std::optional<std::uint32_t> slot;  ///< Where it stands in the frame, if it is a return.
  };
  /// All echoes in the order in which they were found: surfaces by range, then clutter.
  std::vector<Echo> echoes;
};

/// A scene that a host program traces itself, with things and surfaces of its own.
struct HostScene {
  const RayCaster& caster;               ///< Its rays are in a window of the host's choice: metres,
  Transform window_from_world;           ///< origin near the sensor, so that float32 is exact.
  const std::vector<Surface>& surfaces;  ///< What the caster's indices mean; 0 = nothing.
};

/// Turns (scenario, frame index) into a Frame: aim, trace, detect, store, tile by tile.
///
/// A frame depends on its index alone, never on history or on the number of threads.
class Simulator {
 public:
  Simulator(std::shared_ptr<const World> world,
            ScanPattern pattern,
            const MaterialLibrary& materials,
            const SimulatorSpec& spec,
            int num_threads);
  /// One sensor of several: what stands is built once for all that are given the same store. Each
  /// gives the frames that it gives alone.
  /// @param store Of the same materials, and of spec.isa.
  Simulator(std::shared_ptr<SceneStore> store,
            ScanPattern pattern,
            const MaterialLibrary& materials,
            const SimulatorSpec& spec,
            int num_threads);
  ~Simulator();

  /// Fills `frame`; keeps its memory where the shape stays. Not thread-safe: one caller at a time.
  void Scan(std::uint32_t frame_index, Frame& frame);

  /// The same with a scene that the host traces; of the world only the vehicle's way counts.
  void Scan(std::uint32_t frame_index, const HostScene& host, Frame& frame);

  /// For each of world().objects(), in their order: how many firings of the frame would hit it
  /// within range if nothing else stood in the world. (Occlusion = 1 - visible / alone.)
  [[nodiscard]] std::vector<std::uint32_t> FiringsOnObjectAlone(std::uint32_t frame_index);

  /// Replays one firing, with the packet and the random numbers it has in `Scan`.
  /// @pre firing < pattern().num_firings()
  [[nodiscard]] FiringStory Explain(std::uint32_t frame_index, std::uint32_t firing);

  [[nodiscard]] const SimulatorSpec& spec() const;
  /// Changes seed, effects, plausibility, beam, receiver and weather; scenes stay. Speed and
  /// accuracy studies compare effect sets on one scene in one process this way.
  /// @pre The rest of `spec` is as it was.
  void Use(const SimulatorSpec& spec);
  /// Changes the world to one that differs from that of the constructor in the vehicle's way and in
  /// objects only. Chunks, models and, as long as no object of that world that stands is gone,
  /// windows stay. Frames do not depend on the worlds in between.
  void UseWorld(std::shared_ptr<const World> world);
  /// Of the windows of the world that are begun from now on, also those in the background. Scan,
  /// and whatever else needs a window, throws what it throws.
  void UseProgress(WindowProgress progress);
  /// @param num_threads 0 = all cores.
  void UseThreads(int num_threads);

  /// The raw trace of a frame, the yardstick of all speed figures: its rays aimed beforehand, every
  /// call traces them by packets of 16 and keeps the ranges. Valid as long as the simulator.
  [[nodiscard]] std::function<void()> MakeRawTrace(std::uint32_t frame_index);

  /// The one in use.
  [[nodiscard]] const World& world() const;
  [[nodiscard]] const std::shared_ptr<const World>& shared_world() const;
  [[nodiscard]] const ScanPattern& pattern() const;
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
