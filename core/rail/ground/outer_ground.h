#pragma once

#include <span>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// A line of points of the ground along the track, with ascending chainages.
struct GroundLine {
  std::span<const double> stations_m;
  std::span<const Vector3> points_m;  ///< As many.
};

/// Triangles between two lines of points, of which each has rows of its own, so that one may have
/// fewer than the other. The lines begin at one chainage and end at one. The surface faces up.
[[nodiscard]] Mesh MeshBetween(const GroundLine& right, const GroundLine& left);

}  // namespace railcast
