#include <array>

#include "core/rail/base/model_parts.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/lineside_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr std::array<double, 2> kBothEnds = {-1.0, 1.0};
constexpr double kFurnitureFoot_m = -0.40;

}  // namespace

Model MakeLamp(double height_m, const LinesideSurfaces& surfaces) {
  constexpr double kFootRadius_m = 0.080;
  constexpr double kHeadRadius_m = 0.040;
  constexpr double kArm_m = 1.0;
  constexpr double kArmRadius_m = 0.030;
  constexpr double kCase_m = 0.12;
  const double arm_height_m = height_m - kCase_m;
  Model model{.name = "lamp", .parts = {}};
  Mesh& steel = MeshOf(surfaces.furniture_steel, model);
  const std::array<Vector3, 2> pole_m = {Vector3(0, 0, kFurnitureFoot_m), Vector3(0, 0, height_m)};
  const std::array<double, 2> radii_m = {kFootRadius_m, kHeadRadius_m};
  steel.Append(MakeTube(pole_m, radii_m, 8));
  const std::array<Vector3, 2> arm_m = {Vector3(0, 0, arm_height_m),
                                        Vector3(0, -0.5, arm_height_m)};
  steel.Append(MakeTube(arm_m, kArmRadius_m, 6));
  // The case hangs half way out, so that the arm with it is 1 m long.
  steel.Append(MakeBox({Vector3(-0.15, -kArm_m, arm_height_m - 0.5 * kCase_m),
                        Vector3(0.15, -0.5, arm_height_m + 0.5 * kCase_m)}));
  return model;
}

Model MakeBench(const LinesideSurfaces& surfaces) {
  constexpr double kHalfLength_m = 0.90;
  constexpr double kHalfDepth_m = 0.275;
  constexpr double kSeat_m = 0.45;
  constexpr double kHeight_m = 0.80;
  constexpr double kPlank_m = 0.05;
  Model model{.name = "bench", .parts = {}};
  Mesh& wood = MeshOf(surfaces.furniture_wood, model);
  wood.Append(MakeBox({Vector3(-kHalfLength_m, -kHalfDepth_m, kSeat_m - kPlank_m),
                       Vector3(kHalfLength_m, kHalfDepth_m, kSeat_m)}));
  wood.Append(MakeBox({Vector3(-kHalfLength_m, kHalfDepth_m - kPlank_m, kSeat_m + 0.10),
                       Vector3(kHalfLength_m, kHalfDepth_m, kHeight_m)}));
  for (const double end : kBothEnds) {
    const double x_m = end * 0.7;
    MeshOf(surfaces.furniture_steel, model)
        .Append(MakeBox({Vector3(x_m - 0.03, -0.20, -0.10),
                         Vector3(x_m + 0.03, kHalfDepth_m - kPlank_m, kSeat_m - kPlank_m)}));
  }
  return model;
}

Model MakeShelter(const Vector3& size_m, const LinesideSurfaces& surfaces) {
  constexpr double kRoof_m = 0.10;
  constexpr double kPost_m = 0.08;
  constexpr double kPane_m = 0.01;
  constexpr double kPaneBottom_m = 0.15;
  const double eaves_m = size_m.z() - kRoof_m;
  const Vector3 half_m = 0.5 * size_m;
  const double post_x_m = half_m.x() - kPost_m;
  const double post_y_m = half_m.y() - kPost_m;
  Model model{.name = "shelter", .parts = {}};
  Mesh& steel = MeshOf(surfaces.furniture_steel, model);
  steel.Append(
      MakeBox({Vector3(-half_m.x(), -half_m.y(), eaves_m), half_m + Vector3(0, 0, half_m.z())}));
  for (const double end : kBothEnds) {
    for (const double side : kBothEnds) {
      steel.Append(
          MakeBlockAbout({end * post_x_m, side * post_y_m, 0.5 * (eaves_m + kFurnitureFoot_m)},
                         {kPost_m, kPost_m, eaves_m - kFurnitureFoot_m}));
    }
  }
  Mesh& glass = MeshOf(surfaces.furniture_glass, model);
  const double pane_height_m = eaves_m - kPaneBottom_m;
  const double pane_middle_m = kPaneBottom_m + 0.5 * pane_height_m;
  glass.Append(MakeBlockAbout({0.0, post_y_m, pane_middle_m},
                              {2.0 * post_x_m - kPost_m, kPane_m, pane_height_m}));
  for (const double end : kBothEnds) {
    glass.Append(MakeBlockAbout({end * post_x_m, 0.0, pane_middle_m},
                                {kPane_m, 2.0 * post_y_m - kPost_m, pane_height_m}));
  }
  // The bench under it stands at the back.
  const Mesh seat = MakeBlockAbout({0.0, post_y_m - 0.30, 0.45}, {0.7 * size_m.x(), 0.40, 0.05});
  MeshOf(surfaces.furniture_wood, model).Append(seat);
  return model;
}

}  // namespace railcast
