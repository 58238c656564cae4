#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "railcast/scene.h"
#include "tests/support/ray_cast.h"

namespace railcast {

/// One way to trace rays against a mesh.
struct Peer {
  std::string name;
  int num_threads{};
  /// Time of building its search structure; NaN where another row has the same.
  double build_s{};
  /// Stores the range of the first hit of each ray in m: infinity or more than the longest range
  /// where there is none.
  std::function<void(std::span<float> ranges_m)> trace;
};

/// The mesh, the rays and how far they go, all in one frame of reference.
struct PeerScene {
  Model mesh;
  std::vector<Ray> rays;  ///< A whole number of packets.
  float range_max_m{};
};

/// Builds the peers. Each that can is there on one thread and on `num_threads`:
///
/// | raw trace | our scene, packets of 16, the rays aimed beforehand, ranges only |
/// | railcast | the same with surface and normal, from rays to answers |
/// | Embree, ray by ray | rtcIntersect1 in a scene with default settings |
/// | Embree, ray by ray, robust | the same with the robust flag, which our scene has, too |
/// | Open3D | RaycastingScene |
/// | VTK, static cell locator | vtkStaticCellLocator with its defaults |
/// | PCL's virtual scanner | vtkCellLocator with that program's settings and its call |
///
/// Debian's Embree honours the masks of rays, and Open3D 0.16 leaves those of its rays at 0, so
/// that nothing is hit. This program sets them on the way from Open3D to Embree.
///
/// @param scene Must live as long as the peers.
[[nodiscard]] std::vector<Peer> MakePeers(const PeerScene& scene, int num_threads);

}  // namespace railcast
