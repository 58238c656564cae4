#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "core/detect/beam/echo_finder.h"
#include "core/detect/beam/facet_parts.h"
#include "core/detect/beam/part_batch.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/detect/beam/thin_conductors.h"
#include "core/detect/beam/wire_set.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"

namespace railcast {

/// Effect `dense_footprint`: every sub-ray of a dense pattern is a part of its own, and passes
/// through RayCaster::Cast(). This is the slow method that FacetParts is compared with.
///
/// Not thread-safe: keeps its working memory.
class SubRayParts {
 public:
  SubRayParts(const DetectorSpec& spec, const Kernels& kernels);

  /// As FacetParts::Find(), for every beam.
  void Find(const WideBeams& beams, const DetectTile& first, PartLists& lists);

 private:
  void Flush(const WideBeams& beams, std::size_t num_rays);

  DetectorSpec spec_;
  Kernels kernels_;
  SubRayPattern pattern_;
  PartBatch batch_;
  std::array<std::uint32_t, kTileSize> firing_{};  // Firings of the rays in the batch.
  std::vector<Component> found_;                   // Responses of the batches so far.
};

/// Whether effect `footprint` is on and beams have a width.
[[nodiscard]] bool HasFootprint(const DetectorSpec& spec);
/// Whether beams are passed to RayCaster::CastBeam(): those of effect `footprint`, not those of
/// `dense_footprint`, whose sub-rays are traced alone.
[[nodiscard]] inline bool CastsBeams(const DetectorSpec& spec) {
  return HasFootprint(spec) && !spec.effects.dense_footprint;
}

/// Effects `footprint`, `dense_footprint` and `thin_conductors`: turns what a beam of finite width
/// meets (FacetParts, SubRayParts) into echoes. A beam that lies on one plane is represented by its
/// central ray, with the spread of the whole beam. So is a beam that cannot meet a surface of
/// BeamSpec::footprint_of; what the others give does not depend on it, but for halos.
///
/// Effect `thin_conductors`: wires in closed form (thin_conductors.h). A wire hides its share of
/// what lies behind it, and the surfaces in front of a wire hide it in proportion to their share of
/// the beam.
///
/// Not thread-safe: keeps its working memory.
class Footprint {
 public:
  Footprint(const DetectorSpec& spec, const Kernels& kernels);

  /// Traces the tile's beams, before their central rays.
  /// @param wires Null unless effect `thin_conductors` is on.
  /// @param first The keys of the firings.
  void Trace(const WideBeams& beams, const WireSet* wires, const DetectTile& first);

  /// Whether Resolve() needs the central ray of a beam. Where it does not, that ray may as well
  /// have met nothing.
  [[nodiscard]] bool NeedsCenter(const WideBeams& beams, std::size_t lane) const;

  /// Resolves the tile's beams into echoes.
  /// @pre `echoes.first` holds the central rays' hits, and Detector::Respond has been applied to
  ///   it.
  void Resolve(const WideBeams& beams, EchoTiles& echoes);

 private:
  void ChooseWide(const WideBeams& beams, std::size_t num_lanes);
  void FindParts(const WideBeams& beams, const DetectTile& first);
  void AddWires(const WideBeams& beams, const WireCapture* begin, const WireCapture* end);
  void StoreEchoes(std::size_t lane, EchoTiles& echoes) const;

  DetectorSpec spec_;
  FacetParts facet_parts_;
  SubRayParts sub_ray_parts_;
  EchoFinder finder_;
  PartLists lists_;
  std::vector<WireCapture> captures_;
  std::array<bool, kTileSize> has_wire_{};  // By lane.
  std::array<bool, kTileSize> is_wide_{};   // By lane; whether a beam is traced with its width.
  std::vector<Component> beam_parts_;       // All parts of one beam, also those that send nothing.
  std::vector<Component> wires_;
  std::vector<Component> components_;  // The parts of one beam that send light back, with wires.
  std::vector<std::size_t> lanes_;     // Lanes of the beams whose echoes are looked for.
  std::vector<Echo> found_;
  std::array<float, kTileSize> background_{};  // By lane; reflectivity of all that a beam meets.
};

}  // namespace railcast
