#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/detector.h"
#include "core/detect/echo_finder.h"
#include "core/detect/echo_tiles.h"
#include "core/detect/hits.h"
#include "core/detect/kernels.h"
#include "core/detect/sub_ray_pattern.h"
#include "core/detect/thin_conductors.h"
#include "core/detect/wire_set.h"
#include "core/trace/ray_tile.h"

namespace railcast {

/// A tile of wide beams, their central rays traced.
struct WideBeams {
  const RayTile& rays;
  const BeamFrame& frame;
  const RayCaster& caster;
  const SurfaceTable& table;
  const Detector& detector;
  const WireSet* wires;                ///< Null unless they are found apart from the rays.
  const std::uint8_t* needs_sub_rays;  ///< By lane; null if no beam does.
};

/// Effects `footprint` and `dense_footprint`: what a beam of finite width meets.
///
/// Each sub-ray (sub_ray_pattern.h, turned by a random angle for each firing) stands for a cell of
/// the beam, whose slope spreads its range. A beam whose neighbourhood
/// is smooth is its central ray, with the whole beam's spread.
///
/// Effect `thin_conductors`: wires in closed form (thin_conductors.h), in front of as much as lies
/// behind them; what of them lies behind the sub-rays' surfaces is hidden, in proportion.
///
/// Not thread-safe: keeps its working memory.
class Footprint {
 public:
  Footprint(const DetectorSpec& spec, const Kernels& kernels);

  /// Splits the tile's beams into echoes. @pre `echoes.first` holds the central rays' hits, and
  /// Detector::Respond has been applied to it.
  void Resolve(const WideBeams& beams, EchoTiles& echoes);

 private:
  /// A run of sub-rays under way: the tile of rays that is being filled, and whose they are.
  struct Batch {
    RayTile rays;
    DetectTile hits;
    float share[kTileSize];      ///< Of each ray's beam.
    float cell_size[kTileSize];  ///< Its square root: the cell's size in the beam's.
  };

  void GatherParts(const EchoTiles& echoes, std::size_t lane, const Component* sub_components);
  void AddWires(const WideBeams& beams, const WireCapture* begin, const WireCapture* end);
  void TraceSubRays(const WideBeams& beams, const EchoTiles& echoes);
  void FlushBatch(const WideBeams& beams, std::size_t num_rays);
  void StoreEchoes(std::size_t lane, EchoTiles& echoes) const;
  [[nodiscard]] Component CentralCell(const DetectTile& first, std::size_t lane, float share) const;

  DetectorSpec spec_;
  float pulse_variance_m2_;
  SubRayPattern pattern_;
  Kernels kernels_;
  EchoFinder finder_;
  Batch batch_;
  std::vector<std::uint32_t> wide_lanes_;  // Those that need sub-rays.
  std::vector<Component> sub_components_;  // The pattern's, for each of them.
  std::vector<WireCapture> captures_;
  std::vector<Component> beam_parts_;  // All that rays say of one beam, in the way or not.
  std::vector<Component> wires_;
  std::vector<Component> components_;  // What of it sends light back, wires included.
  std::vector<Echo> found_;
};

}  // namespace railcast
