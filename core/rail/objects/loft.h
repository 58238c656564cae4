#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// A cross-section of a rounded body, normal to z: a superellipse
/// |x / depth|^exponent + |y / half_width|^exponent = 1 about (x_m, 0), which may reach further
/// forwards than backwards.
struct LoftSection {
  double z_m{};
  double front_m{};       ///< Half axis towards +x.
  double back_m{};        ///< Half axis towards -x.
  double half_width_m{};  ///< Half axis along y; 0 = the section is a single point.
  double x_m = 0.0;       ///< Position of its centre.
  double exponent = 2.2;  ///< 2 = ellipse; the greater, the closer to a rectangle.
};

/// The sections of a body, from the lowest to the highest, stretched along the three axes.
[[nodiscard]] std::vector<LoftSection> Stretched(std::span<const LoftSection> sections,
                                                 const Vector3& scale);

/// The sections with another one at `z_m`, halfway between its neighbours by linear interpolation.
/// Returns them as they are where there is one already.
/// @pre `z_m` lies between the first and the last section.
[[nodiscard]] std::vector<LoftSection> WithSectionAt(double z_m, std::vector<LoftSection> sections);

/// The sections with domes at both ends: limbs that bend at a joint are closed if both of them end
/// in domes about it. Heights are those of the domes beyond the first and the last section.
[[nodiscard]] std::vector<LoftSection> WithDomes(double below_m,
                                                 double above_m,
                                                 std::vector<LoftSection> sections);

/// The surface of the faces between section `gap` and the next one, on side `side` counted to the
/// left from the front.
using LoftSurface = std::function<SurfaceClass(int gap, int side)>;

/// Adds a closed body through the sections to a model, placed by `model_from_loft`. `num_sides` is
/// even, so that the body's foremost and rearmost lines are its sections' half axes.
void AddLoft(std::span<const LoftSection> sections,
             int num_sides,
             const LoftSurface& surface,
             Model& model,
             const Transform& model_from_loft = Transform::Identity());

/// The overload for one surface.
void AddLoft(std::span<const LoftSection> sections,
             int num_sides,
             const SurfaceClass& surface,
             Model& model,
             const Transform& model_from_loft = Transform::Identity());

}  // namespace railcast
