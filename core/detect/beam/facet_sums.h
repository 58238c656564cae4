#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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
  float x, y, z;  ///< Of the directions.
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

}  // namespace railcast
