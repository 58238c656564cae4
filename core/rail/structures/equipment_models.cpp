#include <array>

#include "core/rail/base/model_parts.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/lineside_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr std::array<double, 2> kBothRails = {-1.0, 1.0};
constexpr double kRailHeadDistance_m = 1.5;  // Between the middles of the two heads.

Mesh MakeSquareBar(const Vector3& begin_m, const Vector3& end_m, double radius_m) {
  constexpr int kSides = 4;
  const std::array<Vector3, 2> axis_m = {begin_m, end_m};
  return MakeTube(axis_m, radius_m, kSides);
}

/// Height and distance of buffers (UIC), as on wagons (objects/wagon_parts.h).
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
  for (const double side : kBothRails) {
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

}  // namespace

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
  for (const double side : kBothRails) {
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

}  // namespace railcast
