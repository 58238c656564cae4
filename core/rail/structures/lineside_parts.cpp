#include "core/rail/structures/lineside_parts.h"

#include <array>

#include "core/rail/base/model_parts.h"
#include "core/scene/shapes.h"

namespace railcast {

Mesh MakeBlockAbout(const Vector3& middle_m, const Vector3& size_m) {
  return MakeBox({middle_m - 0.5 * size_m, middle_m + 0.5 * size_m});
}

Mesh MakePost(const PostShape& post) {
  constexpr int kSides = 8;
  const std::array<Vector3, 2> axis_m = {Vector3(post.x_m, post.y_m, post.bottom_m),
                                         Vector3(post.x_m, post.y_m, post.top_m)};
  return MakeTube(axis_m, post.radius_m, kSides);
}

void AddSignalLamp(const Vector3& middle_m,
                   double depth_m,
                   const LampSurfaces& surfaces,
                   Model& model) {
  constexpr double kLensRadius_m = 0.100;
  constexpr double kHoodRadius_m = 0.120;
  constexpr double kProud_m = 0.005;  // The lens closes the hood: its inside is black and deep.
  const std::array<Vector3, 2> hood_m = {middle_m, middle_m - Vector3(depth_m, 0.0, 0.0)};
  const std::array<Vector3, 2> lens_m = {hood_m[1], hood_m[1] - Vector3(kProud_m, 0.0, 0.0)};
  constexpr int kSides = 8;
  MeshOf(surfaces.hood, model).Append(MakeTube(hood_m, kHoodRadius_m, kSides));
  MeshOf(surfaces.lens, model).Append(MakeTube(lens_m, kLensRadius_m, kSides));
}

}  // namespace railcast
