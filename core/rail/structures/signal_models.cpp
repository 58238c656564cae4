#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/structures/lineside_models.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kSignalMastRadius_m = 0.070;
constexpr double kScreenThickness_m = 0.040;
constexpr double kHoodDepth_m = 0.20;

LampSurfaces LampsOf(const LinesideSurfaces& surfaces) {
  return {.lens = surfaces.signal_lamp, .hood = surfaces.signal_screen};
}

/// A mast with a screen in front of it and lamps one above the other in the screen's middle.
Model MakeSignal(const char* name,
                 const PlateSize& screen,
                 int num_lamps,
                 double height_m,
                 const LinesideSurfaces& surfaces) {
  Model model{.name = name, .parts = {}};
  MeshOf(surfaces.signal_mast, model)
      .Append(MakePost({.bottom_m = kFoot_m, .top_m = height_m, .radius_m = kSignalMastRadius_m}));
  constexpr double kFootTop_m = -0.55;
  constexpr double kFootBottom_m = -1.40;
  MeshOf(surfaces.signal_foot, model)
      .Append(MakeBlockAbout({0.0, 0.0, 0.5 * (kFootTop_m + kFootBottom_m)},
                             {0.60, 0.60, kFootTop_m - kFootBottom_m}));
  const double front_m = -kSignalMastRadius_m - kScreenThickness_m;
  MeshOf(surfaces.signal_screen, model)
      .Append(MakeBlockAbout(
          {front_m + 0.5 * kScreenThickness_m, 0.0, height_m - 0.5 * screen.height_m},
          {kScreenThickness_m, screen.width_m, screen.height_m}));
  for (int i = 0; i < num_lamps; ++i) {
    const double below_top_m = screen.height_m * (i + 0.5) / num_lamps;
    AddSignalLamp({front_m, 0.0, height_m - below_top_m}, kHoodDepth_m, LampsOf(surfaces), model);
  }
  return model;
}

/// Adds a retroreflecting plate on the mast's front, below the screen.
void AddMastPlate(double top_m,
                  const PlateSize& plate,
                  const LinesideSurfaces& surfaces,
                  Model& model) {
  constexpr double kThickness_m = 0.010;
  MeshOf(surfaces.signal_board, model)
      .Append(MakeBlockAbout(
          {-kSignalMastRadius_m - 0.5 * kThickness_m, 0.0, top_m - 0.5 * plate.height_m},
          {kThickness_m, plate.width_m, plate.height_m}));
}

constexpr double kBoardPostRadius_m = 0.030;
constexpr double kSheetThickness_m = 0.002;
constexpr double kPlateThickness_m = 0.003;

/// A plate of any outline (y, z) in front of its post.
Model MakeBoardOf(std::span<const Eigen::Vector2d> outline_m,
                  double height_m,
                  const LinesideSurfaces& surfaces) {
  Model model{.name = "board", .parts = {}};
  MeshOf(surfaces.board_steel, model)
      .Append(MakePost({.bottom_m = kFoot_m, .top_m = height_m, .radius_m = kBoardPostRadius_m}));
  const double back_m = -kBoardPostRadius_m;
  const double seam_m = back_m - kPlateThickness_m;
  MeshOf(surfaces.board_steel, model).Append(MakeExtrusion(outline_m, seam_m, back_m));
  MeshOf(surfaces.board_face, model)
      .Append(MakeExtrusion(outline_m, seam_m - kSheetThickness_m, seam_m));
  return model;
}

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

Model MakeMainSignal(double height_m, const LinesideSurfaces& surfaces) {
  Model model = MakeSignal("main_signal", kMainScreen, 3, height_m, surfaces);
  AddMastPlate(height_m - kMainScreen.height_m - 0.3, {0.150, 0.750}, surfaces, model);
  return model;
}

Model MakeDistantSignal(double height_m, const LinesideSurfaces& surfaces) {
  Model model = MakeSignal("distant_signal", kDistantScreen, 2, height_m, surfaces);
  AddMastPlate(height_m - kDistantScreen.height_m - 0.3, {0.450, 0.900}, surfaces, model);
  return model;
}

Model MakeShuntingSignal(double height_m, const LinesideSurfaces& surfaces) {
  constexpr double kCaseDepth_m = 0.20;
  constexpr double kShadeDepth_m = 0.10;
  constexpr double kPostRadius_m = 0.050;
  Model model{.name = "shunting_signal", .parts = {}};
  const double case_bottom_m = height_m - kShuntingScreen.height_m;
  MeshOf(surfaces.signal_mast, model)
      .Append(MakePost({.bottom_m = kFoot_m, .top_m = case_bottom_m, .radius_m = kPostRadius_m}));
  MeshOf(surfaces.signal_screen, model)
      .Append(MakeBlockAbout({0.0, 0.0, case_bottom_m + 0.5 * kShuntingScreen.height_m},
                             {kCaseDepth_m, kShuntingScreen.width_m, kShuntingScreen.height_m}));
  // Two lamps above, one below: they show two lights on a slant for "shunting permitted".
  const std::array<Eigen::Vector2d, 3> lamps_m = {{{-0.12, 0.12}, {0.12, 0.12}, {0.0, -0.12}}};
  const double middle_m = height_m - 0.5 * kShuntingScreen.height_m;
  for (const Eigen::Vector2d& lamp_m : lamps_m) {
    AddSignalLamp({-0.5 * kCaseDepth_m, lamp_m.x(), middle_m + lamp_m.y()}, kShadeDepth_m,
                  LampsOf(surfaces), model);
  }
  return model;
}

Model MakeBoard(const PlateSize& plate, double height_m, const LinesideSurfaces& surfaces) {
  const double side_m = 0.5 * plate.width_m;
  const double low_m = height_m - plate.height_m;
  const std::vector<Eigen::Vector2d> outline_m = {
      {-side_m, low_m}, {side_m, low_m}, {side_m, height_m}, {-side_m, height_m}};
  return MakeBoardOf(outline_m, height_m, surfaces);
}

Model MakeTriangularBoard(const PlateSize& plate,
                          double height_m,
                          const LinesideSurfaces& surfaces) {
  const double side_m = 0.5 * plate.width_m;
  const std::vector<Eigen::Vector2d> outline_m = {
      {0.0, height_m - plate.height_m}, {side_m, height_m}, {-side_m, height_m}};
  return MakeBoardOf(outline_m, height_m, surfaces);
}

Model MakeFoulingMarker(double height_m, const LinesideSurfaces& surfaces) {
  constexpr double kWidth_m = 0.150;
  constexpr double kBand_m = 0.200;
  Model model{.name = "fouling_marker", .parts = {}};
  const auto add = [&](double bottom_m, double top_m, const SurfaceClass& surface) {
    MeshOf(surface, model)
        .Append(MakeBlockAbout({0.0, 0.0, 0.5 * (bottom_m + top_m)},
                               {kWidth_m, kWidth_m, top_m - bottom_m}));
  };
  add(kFoot_m, height_m - 2.0 * kBand_m, surfaces.marker_white);
  add(height_m - 2.0 * kBand_m, height_m - kBand_m, surfaces.marker_red);
  add(height_m - kBand_m, height_m, surfaces.marker_white);
  return model;
}

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
