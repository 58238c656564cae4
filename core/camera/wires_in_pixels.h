#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/camera/colors.h"
#include "core/detect/beam/thin_conductors.h"
#include "railcast/ray_caster.h"
#include "railcast/simulator.h"

namespace railcast {

/// Puts a ray that has met nothing yet into a tile, at the frame's stamp.
inline void PutRay(const Eigen::Vector3f& origin,
                   const Eigen::Vector3f& direction,
                   float range_m,
                   std::size_t i,
                   RayTile& rays) {
  rays.origin_x[i] = origin.x();
  rays.origin_y[i] = origin.y();
  rays.origin_z[i] = origin.z();
  rays.direction_x[i] = direction.x();
  rays.direction_y[i] = direction.y();
  rays.direction_z[i] = direction.z();
  rays.shutter[i] = 0.0F;
  rays.range_m[i] = range_m;
  rays.surface[i] = 0;
  rays.normal_x[i] = 0.0F;
  rays.normal_y[i] = 0.0F;
  rays.normal_z[i] = 0.0F;
}

/// The wires in a block of pixels, in closed form (core/detect/beam/wire_in_beam.h). Most are
/// thinner than a pixel, so that the rays through the centres of pixels meet a wire here and there
/// only.
///
/// A pixel sees a wire as a Gaussian beam does whose standard deviation is half the way to the next
/// pixel: a straight line of any direction then has the same brightness all along, to
/// 2 exp(-pi^2 / 2) = 1.4 %, the first harmonic of the sum of a Gaussian's samples.
///
/// The colour is the mean over the visible half of the wire's surface. Wires cast no shadow: a
/// wire of 12 mm hides the whole disc of the sun only for 1.3 m behind it.
class WiresInPixels {
 public:
  /// Finds the wires in the pixels of a block.
  /// @param pixels A ray through the centre of each.
  /// @param shape Its standard deviations are half the ways from pixel to pixel.
  void Find(const RayTile& pixels, const BeamShape& shape, const SceneOfFrame& scene);

  [[nodiscard]] bool is_empty() const { return captures_.empty(); }

  /// Computes the colours of the wires that were found.
  /// @param colors Reflectances of the materials.
  void Shade(const RayTile& pixels,
             const SceneOfFrame& scene,
             const std::vector<Vector3>& colors,
             const Daylight& daylight,
             float reach_m);

  /// Returns the colour of a pixel: that of what is behind its wires, as far as they do not hide
  /// it, and theirs.
  /// @param behind The block's rays, cast without wires.
  [[nodiscard]] Radiance Over(const RayTile& behind, std::size_t ray, const Radiance& color) const;

 private:
  std::vector<WireCapture> captures_;               ///< Sorted by lane and range.
  std::vector<Radiance> colors_;                    ///< One of each.
  std::array<std::size_t, kTileSize + 1> first_{};  ///< First capture of each lane.
};

}  // namespace railcast
