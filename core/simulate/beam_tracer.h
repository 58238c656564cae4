#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/echo_tiles.h"
#include "core/detect/beam/footprint.h"
#include "core/detect/beam/mirror_paths.h"
#include "core/detect/beam/texture.h"
#include "core/detect/clutter/cover.h"
#include "core/detect/detector/detector.h"
#include "core/detect/effects/spray.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_motion.h"
#include "core/simulate/frame_poses.h"
#include "railcast/ray_caster.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// Everything that the tiles of one frame are traced with.
struct CastFrame {
  std::uint32_t index{};
  const FramePoses& poses;
  const RayCaster& caster;
  const std::vector<Surface>& surfaces;
  const WireSet* wires{};  ///< Null if the owner of the caster provides no wires.
  Transform window_from_world;
  std::vector<SprayCloud> spray{};       ///< Empty unless effect `spray` is on and trains move.
  std::optional<MirrorScene> mirrors{};  ///< Absent unless effect `mirror_paths` has any.
  /// Whether the caster takes rays that are shorter than 0, which hit nothing.
  bool takes_no_rays = false;
  const TexturedThings* textured{};  ///< Null = the coordinates of all surfaces are the world's.
  const FrameMotion* motion{};       ///< Null unless velocities are measured and it is known.
  const FiringSurfaces* besides{};   ///< What beams meet besides; null = nothing.
};

/// Makes the echoes of a tile of firings, from aiming the beams to the received power, with the
/// selected effects. Immutable.
class BeamTracer {
 public:
  BeamTracer(const SimulatorSpec& spec,
             const std::vector<Material>& materials,
             const ScanPattern& pattern);

  /// Working memory of one thread.
  struct Work {
    explicit Work(const BeamTracer& tracer) : footprint(tracer.spec_, AvailableKernels().back()) {}

    RayTile rays;
    EchoTiles echoes;
    PatternTurns turns{};
    Footprint footprint;
    Cover::Drops drops;
    MirrorPaths::Work mirrors;
    RayTile to_sun;
  };

  /// Makes the echoes of a tile of firings up to the point where the receiver (Detector) takes
  /// over. Leaves the central rays in `work.rays`; those that make no difference hit nothing.
  void MakeEchoes(const CastFrame& frame,
                  const FiringTiles& tiles,
                  std::size_t tile,
                  Work& work,
                  const EffectObserver& observer = {}) const;

  /// As MakeEchoes(), of firings whose echoes from surfaces are known. Nothing is traced.
  /// @param put Puts these echoes into the tile, whose firings have met nothing.
  void MakeKnownEchoes(const CastFrame& frame,
                       const FiringTiles& tiles,
                       std::size_t tile,
                       Work& work,
                       const std::function<void(EchoTiles&)>& put) const;

  /// Aims the central rays of a tile, as MakeEchoes() does, describes the firings in
  /// `work.echoes.first`, and turns their sub-rays.
  void AimCenters(const CastFrame& frame,
                  const FiringTiles& tiles,
                  std::size_t tile,
                  Work& work) const;
  /// The same for all beams of a frame, in which the sensor's z axis turns by some milliradians: so
  /// an outline is as much awry, and what a firing meets does not depend on others.
  [[nodiscard]] BeamFrame BeamFrameOf(const CastFrame& frame) const;
  /// Aims kNumCrowdedSubRays about a central ray of `work`; all else of `beam` stays as it is.
  void AimSubRays(const Work& work, const BeamFrame& frame, std::size_t lane, BeamRays& beam) const;

  /// CastFrame::mirrors of a frame with these surfaces.
  [[nodiscard]] std::optional<MirrorScene> MirrorsAmong(const std::vector<Surface>& surfaces,
                                                        const Transform& window_from_world) const {
    return mirrors_ ? mirrors_->Among(surfaces, window_from_world) : std::nullopt;
  }

  [[nodiscard]] const Detector& detector() const { return detector_; }
  [[nodiscard]] bool has_beams() const { return is_physical_; }
  /// Whether surfaces are met by beams with a width.
  [[nodiscard]] bool has_wide_beams() const { return HasFootprint(spec_); }
  /// Whether MakeEchoes() casts the central rays of all firings at all surfaces, so that it leaves
  /// in `work.rays` what each of them meets first.
  [[nodiscard]] bool casts_all_centers() const {
    return !HasFootprint(spec_) && !spec_.effects.thin_conductors;
  }
  [[nodiscard]] float range_max_m() const { return static_cast<float>(spec_.range_max_m); }
  [[nodiscard]] bool casts_beams() const { return CastsBeams(spec_); }

 private:
  /// Casts the central rays of beams that need one; of all if `are_all_needed`.
  void CastCenters(const WideBeams& beams, bool are_all_needed, Work& work) const;
  /// Share of the sun's disc that nothing hides from a firing, at the time of the firing.
  [[nodiscard]] double VisibleSun(const CastFrame& frame, std::size_t lane, Work& work) const;
  void Blind(const CastFrame& frame, Work& work) const;
  /// What becomes of the light on its way through spray and before the sun.
  void PassAir(const CastFrame& frame, Work& work, const EffectObserver& observer) const;

  bool is_physical_;
  BeamFrame beam_;
  PointingParameters pointing_;
  bool is_sun_up_{};
  Vector3 to_sun_world_;
  /// Directions to points of the sun's disc: a packet of rays.
  std::vector<Vector3> sun_disc_world_;
  DetectorSpec spec_;
  std::vector<LaneOptics> optics_;
  std::vector<LaneOptics> dry_optics_;  ///< Optics of the surfaces without water, for FiringStory.
  Detector detector_;
  Kernels kernels_;
  std::optional<Cover> cover_;
  Spray spray_;
  std::optional<Mirrors> mirrors_;
  MirrorPaths mirror_paths_;
  Texture texture_;
};

}  // namespace railcast
