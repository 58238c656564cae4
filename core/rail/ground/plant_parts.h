#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Trunk, branch or twig: a tapering tube about a line.
struct Stem {
  std::vector<Vector3> line;
  double foot_radius_m{};
  double tip_radius_m{};
  int sides{};
};

/// Stems as tubes.
[[nodiscard]] Mesh WoodOf(std::span<const Stem> stems);

/// Stems with tubes of four sides instead of trunks, and with flat triangles of about `width_m` at
/// their foot instead of branches and twigs thinner than twice that. There are as many of them as
/// have the same area in projection, on average over all directions.
[[nodiscard]] Mesh FlattenedWood(std::span<const Stem> stems, double width_m);

/// How leaves are merged.
struct LeafMerger {
  std::size_t num = 1;    ///< Leaves that become one.
  double widening = 1.0;  ///< Of its width; the rest of its area is due to its length.
  double area = 1.0;      ///< Of the area of all; below 1 for leaves that hide each other less.
};

/// Of leaves that are next to each other, one, enlarged about its centre. Which one is drawn at
/// equal steps of the sum of their areas, so that they stay as evenly distributed as they were, in
/// the same directions.
/// @param leaves Triangles without common corners, the third of which is the tip.
[[nodiscard]] Mesh MergedLeaves(const Mesh& leaves, const LeafMerger& merger);

/// A blade of grass of two pieces, of which the upper one tapers and leans over.
struct Blade {
  Vector3 foot_m;
  Vector3 over_m;        ///< From the foot to below the tip.
  Vector3 half_width_m;  ///< Horizontal.
  double height_m{};
};

/// How blades of grass are merged.
struct BladeMerger {
  std::size_t num = 1;  ///< Blades that become one, which is wider.
  double area = 1.0;    ///< Of the area of all; below 1 for blades that hide each other less.
};

/// Three triangles for each blade. Roots extend 0.15 m into the ground. Which of neighbouring
/// blades stands for all is drawn as in MergedLeaves().
[[nodiscard]] Mesh GrassOf(std::span<const Blade> blades, const BladeMerger& merger);

}  // namespace railcast
