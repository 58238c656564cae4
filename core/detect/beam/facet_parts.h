#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/detect/beam/echo_finder.h"
#include "core/detect/beam/facet_sums.h"
#include "core/detect/beam/part_batch.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/detect/beam/thin_strip.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Effect `footprint`: finds what every beam meets with BeamSpec::footprint_rays sub-rays of equal
/// share, turned about its axis by a random angle for each firing.
///
/// The sub-rays on one facet make one part, since the surface responds the same all over it. Its
/// range is their mean, and its spread has the variance among them and the one within the cell of a
/// sub-ray. Where a small share decides, because few sub-rays or none have met something that may
/// be detected for its share alone, a closer look with four times as many finds it, and
/// sub-rays across a thin surface tell how much of the beam it takes
/// (core/detect/beam/thin_strip.h). A beam that lies on one plane as a whole is left to its central
/// ray. Most others need none, so that the sub-rays come first: Trace(), central rays of those that
/// NeedsCenter(), Find().
///
/// Not thread-safe: keeps its working memory.
class FacetParts {
 public:
  FacetParts(const DetectorSpec& spec, const Kernels& kernels);

  /// Traces the tile's beams.
  /// @param first The keys of the firings.
  void Trace(const WideBeams& beams, const DetectTile& first);

  /// Whether the beam may be left to its central ray, or has no part that sends light back.
  [[nodiscard]] bool NeedsCenter(const WideBeams& beams, std::size_t lane) const;

  /// Fills `lists` for the tile's beams.
  /// @param beams With the hits of the central rays that are needed.
  void Find(const WideBeams& beams, const DetectTile& first, PartLists& lists);

 private:
  /// A thin surface in a beam, and the sub-rays across it that meet it.
  struct ThinSurface {
    std::uint32_t surface{};
    float share{};
    std::size_t num_rays{};
    FacetSums sums{};
  };

  /// The sub-rays of a beam that is not looked at closer.
  [[nodiscard]] const BeamSubRays& Pattern() const;
  void Aim(const WideBeams& beams, std::size_t lane, const BeamSubRays& pattern);
  /// Casts the beam that is aimed.
  void Cast(const WideBeams& beams, std::uint32_t firing);
  /// Whether all sub-rays are on one facet, or on none.
  [[nodiscard]] bool IsOneFacet() const;
  void BeginParts(std::size_t lane);
  void AddParts(const WideBeams& beams, std::size_t lane, const FacetSums& all, float per_ray);
  void NoteMissed(const WideBeams& beams, std::size_t lane);
  void NotePlane(const WideBeams& beams, std::size_t lane, const Facet& plane);
  [[nodiscard]] static float RatioOfFacing(const WideBeams& beams, const Component& part);
  [[nodiscard]] bool NeedsCloserLook(const WideBeams& beams, std::size_t lane) const;
  void LookCloser(const WideBeams& beams, const DetectTile& first, std::size_t lane);
  /// Traces sub-rays of a closer look. Returns whether all of them count.
  bool TraceAll(const WideBeams& beams,
                const DetectTile& first,
                std::size_t lane,
                const BeamSubRays& sub_rays);
  /// Traces sub-rays across a surface that the sub-rays at some places meet.
  /// @return whether the surface is thin and `thin` describes it.
  bool LookAcross(const WideBeams& beams,
                  const DetectTile& first,
                  std::size_t lane,
                  std::vector<BeamPlace> places,
                  ThinSurface& thin);
  void Flush(const WideBeams& beams);
  void StoreLists(std::size_t num_lanes, PartLists& lists) const;

  DetectorSpec spec_;
  Kernels kernels_;
  BeamRays beam_;
  FacetSums sums_;
  // Of a closer look: where sub-rays meet surfaces, and those surfaces that are thin.
  std::map<std::uint32_t, std::vector<BeamPlace>> met_;
  std::vector<ThinSurface> thin_;
  PartBatch batch_;
  std::size_t num_in_batch_{};
  std::vector<Component> found_;  // Responses of the batches so far.
  // By lane; all are 0 if the central ray represents the beam.
  std::array<std::size_t, kTileSize> first_part_{};  // Index into found_.
  std::array<std::uint32_t, kTileSize> num_parts_{};
  std::array<float, kTileSize> share_on_nothing_{};
  // By lane; the surface of a beam on one plane, else kSeveralPlanes.
  std::array<std::uint32_t, kTileSize> plane_surface_{};
  // By lane; how near what the sub-rays have missed may be, the greatest power that it may send, or
  // 0, and that of a beam on one plane, if something may lie before it.
  std::array<float, kTileSize> missed_m_{};
  std::array<float, kTileSize> missed_ratio_{};
  std::array<float, kTileSize> plane_ratio_{};
};

}  // namespace railcast
