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
#include "railcast/ray_caster.h"

namespace railcast {

/// A tile of wide beams whose central rays have been traced.
struct WideBeams {
  const RayTile& rays;
  const BeamFrame& frame;
  const RayCaster& caster;
  const SurfaceTable& table;
  const Detector& detector;
  const WireSet* wires;                ///< Null unless effect `thin_conductors` is on.
  const std::uint8_t* needs_sub_rays;  ///< Whether each lane needs them; null if no beam does.
};

/// Effects `footprint` and `dense_footprint`: what a beam of finite width meets.
///
/// Each sub-ray (sub_ray_pattern.h; the pattern is turned by a random angle for each firing)
/// represents a cell of the beam. The slope of the surface spreads the range within the cell. A
/// beam whose neighbourhood is smooth is represented by its central ray alone, with the spread of
/// the whole beam.
///
/// Effect `thin_conductors`: wires in closed form (thin_conductors.h). A wire hides its share of
/// what lies behind it, and the surfaces in front of a wire hide it in proportion to their share of
/// the beam.
///
/// Not thread-safe: keeps its working memory.
class Footprint {
 public:
  Footprint(const DetectorSpec& spec, const Kernels& kernels);

  /// Resolves the tile's beams into echoes.
  /// @pre `echoes.first` holds the central rays' hits, and Detector::Respond has been applied to
  ///   it.
  void Resolve(const WideBeams& beams, EchoTiles& echoes);

 private:
  /// A batch of sub-rays, which are traced together when the tile is full.
  struct Batch {
    RayTile rays;
    DetectTile hits;
    float share[kTileSize];      ///< Share of the beam that each ray represents.
    float cell_size[kTileSize];  ///< sqrt(share): size of the cell relative to the beam.
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
  std::vector<std::uint32_t> wide_lanes_;  // The lanes that need sub-rays.
  std::vector<Component>
      sub_components_;  // The sub-rays of each of these lanes, one after another.
  std::vector<WireCapture> captures_;
  std::vector<Component> beam_parts_;  // All parts of one beam, also those that send nothing.
  std::vector<Component> wires_;
  std::vector<Component> components_;  // The parts of one beam that send light back, with wires.
  std::vector<Echo> found_;
};

}  // namespace railcast
