#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/debris.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

// The hanging wire: a catenary z = a (cosh(x / a) - 1), a stretch on the ground, and coils.
constexpr double kWireCatenary_m = 0.5;
constexpr double kWireOnGround_m = 1.5;
constexpr double kWireCoilRadius_m = 0.35;
constexpr double kWireTurns = 2.5;

}  // namespace

Model MakePallet(const DebrisSurfaces& surfaces) {
  Mesh wood;
  constexpr double kBoard_m = 0.022;
  constexpr double kCrossBoards_m = kBoard_m + 0.078;
  constexpr double kDeck_m = kCrossBoards_m + kBoard_m;
  /// Half of the outer edges' distance along x and y.
  constexpr double kHalfLength_m = 0.6;
  constexpr double kHalfWidth_m = 0.4;
  const auto add = [&](const Point2& middle_m, const Point2& size_m, double z_m, double high_m) {
    wood.Append(MakeBlock(
        {middle_m.x() - 0.5 * size_m.x(), middle_m.y() - 0.5 * size_m.y(), z_m},
        {middle_m.x() + 0.5 * size_m.x(), middle_m.y() + 0.5 * size_m.y(), z_m + high_m}));
  };
  // Deck: three boards of 145 mm, and two of 100 mm in the middle of the gaps.
  const double outer_m = kHalfWidth_m - 0.0725;
  for (const double y_m : {-outer_m, 0.0, outer_m}) add({0, y_m}, {1.2, 0.145}, kDeck_m, kBoard_m);
  for (const double y_m : {-0.5 * outer_m, 0.5 * outer_m}) {
    add({0, y_m}, {1.2, 0.100}, kDeck_m, kBoard_m);
  }
  for (const double x_m : {-kHalfLength_m + 0.0725, 0.0, kHalfLength_m - 0.0725}) {
    add({x_m, 0}, {0.145, 0.8}, kCrossBoards_m, kBoard_m);
    add({x_m, 0}, {0.145, 0.145}, kBoard_m, 0.078);
    for (const double side : kBothSides) {
      add({x_m, side * (kHalfWidth_m - 0.05)}, {0.145, 0.100}, kBoard_m, 0.078);
    }
  }
  add({0, 0}, {1.2, 0.145}, 0.0, kBoard_m);
  for (const double side : kBothSides) {
    add({0, side * (kHalfWidth_m - 0.05)}, {1.2, 0.100}, 0.0, kBoard_m);
  }
  Model pallet{.name = "pallet", .parts = {}};
  MeshOf(surfaces.wood, pallet) = std::move(wood);
  return pallet;
}

Model MakeTyre(const DebrisSurfaces& surfaces) {
  // From bead to bead outside, and back inside; (across, radius).
  const std::vector<Point2> section = {
      {-0.120, 0.286}, {-0.156, 0.375}, {-0.148, 0.465}, {-0.118, 0.500}, {-0.050, 0.507},
      {0.050, 0.507},  {0.118, 0.500},  {0.148, 0.465},  {0.156, 0.375},  {0.120, 0.286},
      {0.095, 0.290},  {0.132, 0.375},  {0.124, 0.450},  {0.095, 0.478},  {-0.095, 0.478},
      {-0.124, 0.450}, {-0.132, 0.375}, {-0.095, 0.290}};
  Model tyre{.name = "tyre", .parts = {}};
  MeshOf(surfaces.tyre, tyre)
      .Append(
          MakeRevolvedBody(section, 40),
          MakeTransform(RotationFromYawPitchRoll(0, 0, 0.5 * std::numbers::pi), Vector3::Zero()));
  StandOnOrigin(tyre);
  return tyre;
}

Model MakeDragShoe(const DebrisSurfaces& surfaces) {
  Model shoe{.name = "drag_shoe", .parts = {}};
  Mesh iron;
  constexpr double kSole_m = 0.016;
  const std::vector<Point2> sole = {
      {-0.265, 0.0}, {0.325, 0.0}, {0.325, 0.003}, {0.20, kSole_m}, {-0.265, kSole_m}};
  iron.Append(MakePlate(sole, -0.049, 0.049));
  const std::vector<Point2> guide = {{-0.24, -0.020}, {0.16, -0.020},  {0.20, -0.004},
                                     {0.20, 0.004},   {-0.265, 0.004}, {-0.265, -0.010}};
  for (const double side : kBothSides) {  // 1 mm clear of the head of 72 mm.
    iron.Append(MakePlate(guide, side > 0.0 ? 0.037 : -0.049, side > 0.0 ? 0.049 : -0.037));
  }
  // The trestle that the wheel runs against, with its cap and a handle.
  const std::vector<Point2> trestle = {{-0.25, kSole_m}, {-0.04, kSole_m}, {-0.075, 0.040},
                                       {-0.105, 0.070},  {-0.125, 0.105},  {-0.165, 0.120},
                                       {-0.205, 0.105},  {-0.235, 0.060}};
  MeshOf(surfaces.shoe_paint, shoe).Append(MakePlate(trestle, -0.024, 0.024));
  const std::vector<Point2> cap = {{-0.13, 0.095},  {-0.105, 0.075}, {-0.095, 0.080},
                                   {-0.115, 0.110}, {-0.16, 0.125},  {-0.20, 0.115},
                                   {-0.195, 0.105}, {-0.16, 0.115}};
  iron.Append(MakePlate(cap, -0.030, 0.030));
  const std::vector<Vector3> handle = {{-0.225, 0.0, 0.045},
                                       {-0.275, 0.0, 0.075},
                                       {-0.315, 0.0, 0.075},
                                       {-0.315, 0.0, 0.035},
                                       {-0.255, 0.0, 0.025}};
  iron.Append(MakeTube(handle, 0.010, 8));
  MeshOf(surfaces.shoe_iron, shoe).Append(iron);
  return shoe;
}

std::vector<Vector3> HangingWireAxis() {
  constexpr double kRadius_m = 0.5 * kHangingWireDiameter_m;
  constexpr double kStep_m = 0.15;
  constexpr double kA_m = kWireCatenary_m;
  std::vector<Vector3> axis;
  // By arc length from where it touches the ground.
  const double rise_m = kHangingWireTop_m - kRadius_m;
  const double hanging_m = std::sqrt((rise_m + kA_m) * (rise_m + kA_m) - kA_m * kA_m);
  const int num_steps = static_cast<int>(std::ceil(hanging_m / kStep_m));
  for (int i = num_steps; i >= 0; --i) {
    const double arc_m = hanging_m * i / num_steps;
    axis.emplace_back(kA_m * std::asinh(arc_m / kA_m), 0.0,
                      kRadius_m + std::hypot(kA_m, arc_m) - kA_m);
  }
  constexpr int kStepsOfATurn = 24;
  for (int i = 0; i <= kWireTurns * kStepsOfATurn; ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * i / kStepsOfATurn;
    // Each turn lies on the one before.
    axis.emplace_back(-kWireOnGround_m - kWireCoilRadius_m * std::sin(turn_rad),
                      kWireCoilRadius_m * (1.0 - std::cos(turn_rad)),
                      kRadius_m + kHangingWireDiameter_m * i / kStepsOfATurn);
  }
  return axis;
}

Model MakeHangingWire(const DebrisSurfaces& surfaces) {
  Model wire{.name = "hanging_wire", .parts = {}};
  MeshOf(surfaces.wire, wire).Append(MakeTube(HangingWireAxis(), 0.5 * kHangingWireDiameter_m, 8));
  StandOnOrigin(wire);
  return wire;
}

}  // namespace railcast
