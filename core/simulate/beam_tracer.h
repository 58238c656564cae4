#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/transform.h"
#include "core/detect/detector.h"
#include "core/detect/echo_tiles.h"
#include "core/detect/footprint.h"
#include "core/detect/hits.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/simulator_spec.h"
#include "core/simulate/sub_ray_needs.h"
#include "core/trace/ray_tile.h"
#include "core/trace/surface.h"

namespace railcast {

/// What the tiles of one frame are traced with.
struct CastFrame {
  std::uint32_t index{};
  const FramePoses& poses;
  const RayCaster& caster;
  const std::vector<Surface>& surfaces;
  const WireSet* wires{};  ///< Null if the caster's owner has none.
  Transform window_from_world;
};

/// From aim to echoes: all that the chosen effects do to a tile of firings. Immutable.
class BeamTracer {
 public:
  BeamTracer(const SimulatorSpec& spec,
             const std::vector<Material>& materials,
             const ScanPattern& pattern);

  /// What one thread works in.
  struct Work {
    explicit Work(const BeamTracer& tracer) : footprint(tracer.spec_, AvailableKernels().back()) {}

    RayTile rays;
    EchoTiles echoes;
    Footprint footprint;
  };

  /// Whether the central rays of all tiles are needed before any tile's echoes.
  [[nodiscard]] bool needs_all_centers() const { return needs_.has_value(); }

  /// Aims a tile's central rays and casts them. Fills `work.echoes.first` as far as it names them.
  void TraceCenters(const CastFrame& frame,
                    const FiringTiles& tiles,
                    std::size_t tile,
                    RayTile& rays,
                    DetectTile& first) const;

  /// Turns the central rays' hits into echoes with power, up to where the receiver takes over.
  /// @param centers All tiles' central rays; empty unless needs_all_centers().
  void MakeEchoes(const CastFrame& frame,
                  const FiringTiles& tiles,
                  std::size_t tile,
                  const std::vector<RayTile>& centers,
                  Work& work,
                  const EffectObserver& observer = {}) const;

  [[nodiscard]] const Detector& detector() const { return detector_; }
  [[nodiscard]] bool has_beams() const { return is_physical_; }

 private:
  [[nodiscard]] BeamFrame BeamFrameOf(const CastFrame& frame,
                                      const FiringTiles& tiles,
                                      std::size_t tile) const;
  void Blind(const CastFrame& frame, const RayTile& rays, EchoTiles& echoes) const;

  bool is_physical_;
  BeamFrame beam_;
  PointingParameters pointing_;
  bool is_sun_up_;
  Vector3 to_sun_world_;
  DetectorSpec spec_;
  std::vector<LaneOptics> optics_;
  Detector detector_;
  Kernels kernels_;
  std::optional<SubRayNeeds> needs_;
};

}  // namespace railcast
