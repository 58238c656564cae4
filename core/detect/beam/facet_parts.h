#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/detect/beam/echo_finder.h"
#include "core/detect/beam/part_batch.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// The product of two facets' normals.
[[nodiscard]] inline float Dot(const Facet& a, const Facet& b) {
  return a.normal_x * b.normal_x + a.normal_y * b.normal_y + a.normal_z * b.normal_z;
}

/// Sums over sub-rays on one facet, or on several in one plane. Ranges are counted from `base_m`.
struct FacetSum {
  std::uint32_t num;
  Facet facet;
  float base_m, range_m, range2_m2;
  float x, y, z;  ///< Components of the directions.
};

/// The sums of a beam's sub-rays by facet.
class FacetSums {
 public:
  void Clear() { sums_.clear(); }
  /// Adds a set of traced sub-rays. Facets of one set are not those of another.
  void Add(const BeamRays& beam);
  /// Adds up facets that are one plane, unless they are more than these.
  void JoinPlanes(std::size_t most_planes);
  /// Takes out the facets of a surface.
  void Remove(std::uint32_t surface);
  /// Takes out all facets but those of a surface.
  void RemoveOthers(std::uint32_t surface);

  [[nodiscard]] const std::vector<FacetSum>& all() const { return sums_; }

 private:
  std::vector<FacetSum> sums_;
};

/// A place in a beam before its pattern is turned, in standard deviations of the profile.
struct BeamPlace {
  float h{}, v{};
};

/// A straight strip of a beam in which something thin lies, in standard deviations of the profile.
/// It reaches from one side of the beam to the other.
struct ThinStrip {
  BeamPlace direction;   ///< Unit direction along it.
  float begin{}, end{};  ///< Its sides: distances of Aside().

  /// Distance of a place from the line along the strip through the beam's middle, with a sign.
  [[nodiscard]] float Aside(const BeamPlace& place) const {
    return direction.h * place.v - direction.v * place.h;
  }
  /// The beam's share of power in it.
  [[nodiscard]] float Share() const;
  /// Whether a place is so near to a side that what lies there may reach beyond it.
  [[nodiscard]] bool IsAtSide(const BeamPlace& place) const;
};

/// Fits a strip to places at which sub-rays meet a surface: along the line of least squares of
/// distances from it, and as wide as the surface may reach.
/// @param share Of the beam, which these places stand for.
/// @return nothing for fewer than two places, or if they are not on a line.
[[nodiscard]] std::optional<ThinStrip> FitStrip(std::span<const BeamPlace> places, float share);

/// So many sets of sub-rays cover a strip, each by itself.
inline constexpr std::size_t kNumStripSets = kNumCloserSubRays / kNumSubRays;
/// The sub-rays of sets, each of kNumSubRays that have an equal share of a strip.
[[nodiscard]] BeamSubRays SubRaysIn(const ThinStrip& strip,
                                    std::size_t first_set,
                                    std::size_t num_sets);

/// Effect `footprint`: finds what every beam meets with BeamSpec::footprint_rays sub-rays of equal
/// share, turned about its axis by a random angle for each firing.
///
/// The sub-rays on one facet make one part, since the surface responds the same all over it. Its
/// range is their mean, and its spread has the variance among them and the one within the cell of a
/// sub-ray. Where a small share decides, because few sub-rays or none have met something that may
/// be detected for its share alone, a closer look with four times as many finds it, and
/// sub-rays across a thin surface tell how much of the beam it takes
/// (ThinStrip). A beam that lies on one plane as a whole is left to its central
/// ray. Most others need none, so that the sub-rays come first: Trace(), central rays of those that
/// NeedsCenter(), Find().
///
/// Not thread-safe: keeps its working memory.
class FacetParts {
 public:
  FacetParts(const DetectorSpec& spec, const Kernels& kernels);

  /// Whether a beam may meet a surface of BeamSpec::footprint_of. If not, none of its sub-rays
  /// does, nor one of a closer look.
  [[nodiscard]] bool NeedsWidth(const WideBeams& beams, std::size_t lane);

  /// Traces the tile's beams.
  /// @param first The keys of the firings.
  /// @param is_wide By lane; beams that are not are left to their central rays, as if each lay on
  ///   one plane.
  void Trace(const WideBeams& beams,
             const DetectTile& first,
             const std::array<bool, kTileSize>& is_wide);

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
  // For a closer look: where sub-rays meet surfaces, and those surfaces that are thin.
  std::map<std::uint32_t, std::vector<BeamPlace>> met_;
  std::vector<ThinSurface> thin_;
  PartBatch batch_;
  std::size_t num_in_batch_{};
  std::vector<Component> found_;  // Responses of the batches so far.
  // By lane; all are 0 if the central ray represents the beam.
  std::array<std::size_t, kTileSize> first_part_{};  // Index into found_.
  std::array<std::uint32_t, kTileSize> num_parts_{};
  std::array<float, kTileSize> share_on_nothing_{};
  // By lane; the surface of a beam on one plane, else kSeveralPlanes or kNotTraced.
  std::array<std::uint32_t, kTileSize> plane_surface_{};
  // By lane; how near what the sub-rays have missed may be, the greatest power that it may send, or
  // 0, and that of a beam on one plane, if something may lie before it.
  std::array<float, kTileSize> missed_m_{};
  std::array<float, kTileSize> missed_ratio_{};
  std::array<float, kTileSize> plane_ratio_{};
};

}  // namespace railcast
