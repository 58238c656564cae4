#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/beam/echo_finder.h"
#include "core/detect/beam/mirrors.h"
#include "core/detect/beam/texture.h"
#include "core/detect/detector/detector.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Surfaces beside those of the scene, each of which only the beams of its own firing meet.
/// Thread-safe, as long as one thread at a time asks for a firing.
class FiringSurfaces {
 public:
  virtual ~FiringSurfaces() = default;

  /// Lets rays that have been cast meet the surfaces of their firings.
  /// @param firings Of the first `num` rays.
  virtual void Meet(const std::uint32_t* firings, std::size_t num, RayTile& rays) const = 0;
  /// The same for the sub-rays of a firing's beam.
  virtual void Meet(std::uint32_t firing, BeamRays& beam) const = 0;
};

/// A tile of wide beams. Their central rays are aimed, and traced unless a function says otherwise.
struct WideBeams {
  const RayTile& rays;
  const BeamFrame& frame;
  const PatternTurns& turns;
  const RayCaster& caster;
  const SurfaceTable& table;
  const Detector& detector;
  const MirrorScene* mirrors{};     ///< Null if nothing mirrors.
  const FiringSurfaces* besides{};  ///< What beams meet besides; null = nothing.
  const Texture* texture{};         ///< Null if nothing has one.
  const TextureScene* textures{};   ///< As `texture`.
};

/// Hits of sub-rays on the way to their response. Each stands for a share of its beam.
class PartBatch {
 public:
  /// The hits. Whoever fills a lane also calls Describe() for it.
  RayTile rays;

  /// @param share Share of the beam that hits this surface.
  /// @param cell Share of the beam over which the slope of the surface spreads the range.
  /// @param variance_m2 Variance of the range that is known otherwise.
  void Describe(std::size_t lane, float share, float cell, float variance_m2) {
    share_[lane] = share;
    cell_[lane] = cell;
    variance_m2_[lane] = variance_m2;
  }

  /// Pads the last packet of `num` rays with its last ray. Returns the padded number.
  std::size_t Pad(std::size_t num);
  /// Computes the responses of the first `num` hits, a whole number of packets, and appends those
  /// of the first `num_wanted` to `parts`.
  void Respond(const WideBeams& beams,
               const Kernels& kernels,
               std::size_t num,
               std::size_t num_wanted,
               std::vector<Component>& parts);

 private:
  DetectTile hits_;
  float share_[kTileSize], cell_[kTileSize], variance_m2_[kTileSize];
};

/// The parts of a tile's beams, one beam after another. A beam that a single ray represents has
/// none; the parts of any other add up to the whole beam, with those that meet nothing (surface 0).
struct PartLists {
  std::vector<Component> parts;
  std::array<std::size_t, kTileSize + 1> begin{};  ///< By lane.

  [[nodiscard]] std::span<const Component> of(std::size_t lane) const {
    return {parts.data() + begin[lane], begin[lane + 1] - begin[lane]};
  }
};

/// Whether a part sends light back to the sensor. Parts nearer than range_min or on the vehicle
/// block their share of the beam and send nothing.
[[nodiscard]] inline bool SendsLight(const Component& part,
                                     const std::vector<Surface>& surfaces,
                                     const DetectorSpec& spec) {
  return part.surface != 0 && part.range_m >= static_cast<float>(spec.range_min_m) &&
         !surfaces[part.surface].is_ego;
}

/// The component that a lane of a tile with responses describes.
[[nodiscard]] Component ComponentOf(const DetectTile& hits, std::size_t lane);

/// Scales the response of a whole beam to a cell that is this share of it and has less spread.
[[nodiscard]] Component CellOf(const Component& whole, float share, const DetectorSpec& spec);

}  // namespace railcast
