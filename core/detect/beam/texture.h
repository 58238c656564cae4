#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/detect/base/effect_parameters.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"
#include "railcast/transform.h"

namespace railcast {

/// Coordinates in cells of effect `texture`: cells = field (x, y, z, 1) of a place in the window
/// frame, m.
using CellField = Eigen::Matrix<float, 3, 4>;

/// The coordinates of something in cells. Cells begin beside its origin, so that faces at round
/// numbers do not lie between two cells, where rounding would decide.
[[nodiscard]] Eigen::Matrix<double, 3, 4> CellsFromWindow(const Eigen::Affine3d& thing_from_window);

/// The things of a frame with coordinates of their own, by which their textures go with them.
class TexturedThings {
 public:
  /// Surfaces of one rigid thing.
  /// @param steps Its fields at equal steps of the frame's shutter; one if it stands.
  void Add(std::uint32_t first_surface,
           std::uint32_t num_surfaces,
           const std::vector<CellField>& steps);

  /// The coordinates of a surface at this time of the shutter; null if they are the world's.
  [[nodiscard]] const CellField* FieldOf(std::uint32_t surface,
                                         float shutter,
                                         CellField& between) const;

 private:
  std::vector<std::vector<CellField>> things_;
  std::vector<std::uint32_t> thing_of_surface_;  // Counts from 1; 0 = the world.
};

/// The world's coordinates in a frame, and its things.
struct TextureScene {
  CellField cells_from_window;     ///< In the world's axes, without `base`.
  std::uint32_t base[3];           ///< What is too large for float32.
  const TexturedThings* things{};  ///< Null = none.
};

/// Effect `texture` (kernels/surface_response.h) on a tile of hits. Immutable.
class Texture {
 public:
  Texture(const DetectorSpec& spec, const std::vector<Material>& materials, const Kernels& kernels);

  /// Whether the effect is on and any material has a texture.
  [[nodiscard]] bool is_on() const { return is_on_; }
  [[nodiscard]] static TextureScene SceneOf(const Transform& window_from_world,
                                            const TexturedThings* things);
  /// Multiplies intensities and powers of the hits that have passed Detector::Respond().
  /// @param tile Its lanes are those of `rays`.
  void Apply(const TextureScene& scene,
             const std::vector<Surface>& surfaces,
             const RayTile& rays,
             DetectTile& tile) const;

 private:
  bool is_on_ = false;
  std::vector<float> variance_;  // Relative, of a cell; by material.
  TextureParameters parameters_;
  void (*apply_)(DetectTile&, const TextureLanes&, const TextureParameters&);
};

}  // namespace railcast
