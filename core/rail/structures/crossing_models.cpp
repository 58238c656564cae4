#include <algorithm>
#include <array>
#include <cmath>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/structures/lineside_models.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kStripe_m = 0.60;

void AppendPedestal(const LinesideSurfaces& surfaces, Model& model) {
  constexpr double kPedestal_m = 0.30;
  constexpr double kPedestalTop_m = 1.10;
  constexpr double kPedestalFoot_m = -0.50;
  MeshOf(surfaces.crossing_steel, model)
      .Append(MakeBlockAbout({0.0, 0.0, 0.5 * (kPedestalTop_m + kPedestalFoot_m)},
                             {kPedestal_m, kPedestal_m, kPedestalTop_m - kPedestalFoot_m}));
}

}  // namespace

Model MakeBoom(double length_m, const LinesideSurfaces& surfaces) {
  constexpr double kBoomDepth_m = 0.05;
  constexpr double kBoomRise_m = 0.12;
  constexpr double kFront_m = -0.20;  // The boom runs in front of its pedestal, towards -y.
  Model model{.name = "boom", .parts = {}};
  const int num_stripes = std::max(1, static_cast<int>(std::lround(length_m / kStripe_m)));
  for (int i = 0; i < num_stripes; ++i) {
    const SurfaceClass& surface = i % 2 == 0 ? surfaces.barrier_red : surfaces.barrier_white;
    MeshOf(surface, model)
        .Append(MakeBox(
            {Vector3(length_m * i / num_stripes, kFront_m - 0.5 * kBoomDepth_m, -0.5 * kBoomRise_m),
             Vector3(length_m * (i + 1) / num_stripes, kFront_m + 0.5 * kBoomDepth_m,
                     0.5 * kBoomRise_m)}));
  }
  Mesh& steel = MeshOf(surfaces.crossing_steel, model);
  steel.Append(
      MakeBox({Vector3(-0.80, kFront_m - 0.10, -0.12), Vector3(-0.35, kFront_m + 0.10, 0.12)}));
  steel.Append(
      MakeBox({Vector3(-0.35, kFront_m - 0.02, -0.04), Vector3(0.0, kFront_m + 0.02, 0.04)}));
  return model;
}

Model MakeBoomPedestal(const LinesideSurfaces& surfaces) {
  Model model{.name = "boom_pedestal", .parts = {}};
  AppendPedestal(surfaces, model);
  return model;
}

Transform BarrierFromBoom(double angle_rad) {
  return MakeTransform(RotationFromYawPitchRoll(0.0, -angle_rad, 0.0), {0.0, 0.0, kBoomAxis_m});
}

Model MakeHalfBarrier(double boom_length_m, double angle_rad, const LinesideSurfaces& surfaces) {
  Model model = MakeBoom(boom_length_m, surfaces);
  model.name = "half_barrier";
  const Transform upright_from_boom = BarrierFromBoom(angle_rad);
  for (Part& part : model.parts) {
    Mesh turned;
    turned.Append(part.mesh, upright_from_boom);
    part.mesh = std::move(turned);
  }
  AppendPedestal(surfaces, model);
  return model;
}

Model MakeCrossingSign(const LinesideSurfaces& surfaces) {
  constexpr double kPostRadius_m = 0.045;
  constexpr double kCrossMiddle_m = 3.25;
  constexpr double kBeamLength_m = 1.20;
  constexpr double kBeamWidth_m = 0.15;
  constexpr double kBeamThickness_m = 0.008;
  constexpr double kBeamSlant_rad = 0.96;  // 55 degrees: the cross is higher than wide.
  Model model{.name = "crossing_sign", .parts = {}};
  MeshOf(surfaces.crossing_steel, model)
      .Append(MakePost({.bottom_m = -0.50, .top_m = 3.75, .radius_m = kPostRadius_m}));
  double front_m = -kPostRadius_m;
  for (const double slant : {-kBeamSlant_rad, kBeamSlant_rad}) {
    const Vector3 half_m(0.5 * kBeamThickness_m, 0.5 * kBeamLength_m, 0.5 * kBeamWidth_m);
    // One beam lies in front of the other.
    front_m -= kBeamThickness_m;
    MeshOf(surfaces.barrier_white, model)
        .Append(MakeBox({-half_m, half_m}),
                MakeTransform(RotationFromYawPitchRoll(0.0, 0.0, slant),
                              {front_m + 0.5 * kBeamThickness_m, 0.0, kCrossMiddle_m}));
  }
  constexpr PlateSize kScreen{.width_m = 0.40, .height_m = 0.80};
  constexpr double kScreenTop_m = 2.70;
  constexpr double kScreenThickness_m = 0.04;
  const double screen_middle_m = kScreenTop_m - 0.5 * kScreen.height_m;
  MeshOf(surfaces.crossing_screen, model)
      .Append(MakeBlockAbout({-kPostRadius_m - 0.5 * kScreenThickness_m, 0.0, screen_middle_m},
                             {kScreenThickness_m, kScreen.width_m, kScreen.height_m}));
  for (const double side : {1.0, -1.0}) {
    AddSignalLamp({-kPostRadius_m - kScreenThickness_m, 0.0, screen_middle_m + 0.2 * side}, 0.20,
                  {surfaces.crossing_lamp, surfaces.crossing_screen}, model);
  }
  return model;
}

}  // namespace railcast
