#include "core/rail/structures/lineside_models.h"

#include <array>

#include "core/rail/base/rail_surfaces.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr std::array<double, 2> kBothSigns = {-1.0, 1.0};
constexpr double kRailHeadDistance_m = 1.5;  // Between the middles of the two heads.

Mesh MakeSquareBar(const Vector3& begin_m, const Vector3& end_m, double radius_m) {
  constexpr int kSides = 4;
  const std::array<Vector3, 2> axis_m = {begin_m, end_m};
  return MakeTube(axis_m, radius_m, kSides);
}

/// Height and distance of buffers (UIC), as on wagons.
constexpr double kStopBufferHeight_m = 1.06;
constexpr double kStopBufferDistance_m = 1.75;
constexpr double kStopBufferRadius_m = 0.225;
constexpr double kBeamFront_m = 0.40;
constexpr double kBeamBack_m = 0.60;

void AddBufferBeam(const LinesideSurfaces& surfaces, Model& model) {
  constexpr double kBeamBottom_m = 0.86;
  constexpr double kBeamTop_m = 1.26;
  MeshOf(surfaces.buffer_beam, model)
      .Append(MakeBox({Vector3(kBeamFront_m, -0.5 * kBufferStopWidth_m, kBeamBottom_m),
                       Vector3(kBeamBack_m, 0.5 * kBufferStopWidth_m, kBeamTop_m)}));
  constexpr double kHeadThickness_m = 0.06;
  constexpr double kShaftRadius_m = 0.09;
  constexpr int kSides = 12;
  for (const double side : kBothSigns) {
    const Vector3 face_m(0.0, 0.5 * side * kStopBufferDistance_m, kStopBufferHeight_m);
    const Vector3 back_m = face_m + Vector3(kHeadThickness_m, 0.0, 0.0);
    const std::array<Vector3, 2> head_m = {face_m, back_m};
    const std::array<Vector3, 2> shaft_m = {back_m, face_m + Vector3(kBeamFront_m, 0.0, 0.0)};
    MeshOf(surfaces.buffer_frame, model).Append(MakeTube(head_m, kStopBufferRadius_m, kSides));
    MeshOf(surfaces.buffer_frame, model).Append(MakeTube(shaft_m, kShaftRadius_m, 8));
  }
  constexpr double kBoardWidth_m = 0.60;
  constexpr double kBoardThickness_m = 0.010;
  MeshOf(surfaces.buffer_board, model)
      .Append(MakeBox(
          {Vector3(kBeamFront_m, -0.5 * kBoardWidth_m, kBeamTop_m),
           Vector3(kBeamFront_m + kBoardThickness_m, 0.5 * kBoardWidth_m, kBufferStopHeight_m)}));
}

constexpr double kFurnitureFoot_m = -0.40;

}  // namespace

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

Model MakeBalise(const LinesideSurfaces& surfaces) {
  Model model{.name = "balise", .parts = {}};
  MeshOf(surfaces.balise, model)
      .Append(MakeBlockAbout({0.0, 0.0, 0.5 * kBaliseHeight_m},
                             {kBaliseLength_m, kBaliseWidth_m, kBaliseHeight_m}));
  return model;
}

Model MakeRelayBox(const Vector3& size_m, const LinesideSurfaces& surfaces) {
  constexpr double kPlinth_m = 0.15;
  constexpr double kPlinthFoot_m = -0.40;
  constexpr double kRoof_m = 0.05;
  constexpr double kInset_m = 0.03;  // Of walls and plinth from the roof's edge.
  const Vector3 inset_m(2.0 * kInset_m, 2.0 * kInset_m, 0.0);
  Model model{.name = "relay_box", .parts = {}};
  const auto block = [&](double bottom_m, double top_m) -> Mesh {
    const Vector3 middle_m(0.0, 0.0, 0.5 * (bottom_m + top_m));
    const Vector3 block_m(size_m.x(), size_m.y(), top_m - bottom_m);
    return MakeBlockAbout(middle_m, top_m < size_m.z() ? Vector3(block_m - inset_m) : block_m);
  };
  MeshOf(surfaces.relay_foot, model).Append(block(kPlinthFoot_m, kPlinth_m));
  MeshOf(surfaces.relay_box, model).Append(block(kPlinth_m, size_m.z() - kRoof_m));
  MeshOf(surfaces.relay_box, model).Append(block(size_m.z() - kRoof_m, size_m.z()));
  return model;
}

Model MakeBufferStop(const LinesideSurfaces& surfaces, double shift_m) {
  Model model{.name = "buffer_stop", .parts = {}};
  AddBufferBeam(surfaces, model);
  constexpr double kBar_m = 0.09;
  Mesh& frame = MeshOf(surfaces.buffer_frame, model);
  for (const double side : kBothSigns) {
    const double y_m = side * (0.5 * kRailHeadDistance_m + shift_m);
    const Vector3 head_m(kBeamBack_m + kBar_m, y_m, kStopBufferHeight_m);
    const Vector3 heel_m(kBufferStopLength_m - kBar_m, y_m, kBar_m);
    frame.Append(MakeSquareBar({head_m.x(), y_m, 0.0}, head_m + Vector3(0, 0, 0.2), kBar_m));
    frame.Append(MakeSquareBar(head_m, heel_m, kBar_m));
    frame.Append(MakeBox({Vector3(kBeamFront_m, y_m - kBar_m, 0.0),
                          Vector3(kBufferStopLength_m, y_m + kBar_m, kBar_m)}));
  }
  const double y_m = 0.5 * kRailHeadDistance_m + shift_m;
  frame.Append(MakeSquareBar({1.5, -y_m, 0.55}, {1.5, y_m, 0.55}, kBar_m));
  return model;
}

Model MakeDerailer(const LinesideSurfaces& surfaces, double shift_m) {
  constexpr double kShoeLength_m = 0.60;
  constexpr double kShoeRise_m = 0.10;
  const double rail_m = 0.5 * kRailHeadDistance_m + shift_m;
  Model model{.name = "derailer", .parts = {}};
  MeshOf(surfaces.derailer, model)
      .Append(MakeBox({Vector3(-0.5 * kShoeLength_m, rail_m - 0.15, -0.10),
                       Vector3(0.5 * kShoeLength_m, rail_m + 0.15, kShoeRise_m)}));
  Mesh& machine = MeshOf(surfaces.derailer_machine, model);
  machine.Append(
      MakeBox({Vector3(-0.03, rail_m + 0.15, -0.10), Vector3(0.03, rail_m + 0.40, -0.04)}));
  machine.Append(
      MakeBox({Vector3(-0.35, rail_m + 0.40, -0.35), Vector3(0.35, rail_m + 0.80, 0.02)}));
  return model;
}

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
  for (const double end : kBothSigns) {
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
  for (const double end : kBothSigns) {
    for (const double side : kBothSigns) {
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
  for (const double end : kBothSigns) {
    glass.Append(MakeBlockAbout({end * post_x_m, 0.0, pane_middle_m},
                                {kPane_m, 2.0 * post_y_m - kPost_m, pane_height_m}));
  }
  // The bench under it stands at the back.
  const Mesh seat = MakeBlockAbout({0.0, post_y_m - 0.30, 0.45}, {0.7 * size_m.x(), 0.40, 0.05});
  MeshOf(surfaces.furniture_wood, model).Append(seat);
  return model;
}

}  // namespace railcast
