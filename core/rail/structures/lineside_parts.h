#pragma once

#include "core/rail/structures/lineside_models.h"

namespace railcast {

/// Shapes of which things beside the track are composed.

/// A box about a middle.
[[nodiscard]] Mesh MakeBlockAbout(const Vector3& middle_m, const Vector3& size_m);

/// An upright post with eight sides, over the place (x, y).
struct PostShape {
  double x_m = 0.0;
  double y_m = 0.0;
  double bottom_m{};
  double top_m{};
  double radius_m{};
};
[[nodiscard]] Mesh MakePost(const PostShape& post);

/// The surfaces of a lamp and of the hood that shades it.
struct LampSurfaces {
  SurfaceClass lens;
  SurfaceClass hood;
};

/// Adds a lamp of 200 mm whose hood reaches `depth_m` towards -x from `middle_m`. 56 triangles.
void AddSignalLamp(const Vector3& middle_m,
                   double depth_m,
                   const LampSurfaces& surfaces,
                   Model& model);

}  // namespace railcast
