#include <numbers>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

constexpr double kFlatWagonPivotDistance_m = kFlatWagonMeasures.pivot_distance_m;

/// I-section side sill of the container wagon: deep between the bogies, shallow above them.
void AddFishBelliedSill(double side, Mesh& frame) {
  constexpr double kTop_m = 1.14;
  const std::vector<Point2> bottom = {{-9.15, 0.93}, {-5.5, 0.93}, {-4.2, 0.56},
                                      {4.2, 0.56},   {5.5, 0.93},  {9.15, 0.93}};
  std::vector<Point2> web = bottom;
  web.emplace_back(9.15, kTop_m);
  web.emplace_back(-9.15, kTop_m);
  std::vector<Point2> flange = bottom;
  for (auto point = bottom.rbegin(); point != bottom.rend(); ++point) {
    flange.emplace_back(point->x(), point->y() - 0.025);
  }
  const double y_m = side * 1.13;
  frame.Append(MakePlate(web, y_m - 0.012, y_m + 0.012));
  frame.Append(MakePlate(flange, y_m - 0.10, y_m + 0.10));
  frame.Append(MakeBlock({-9.15, y_m - 0.11, kTop_m - 0.03}, {9.15, y_m + 0.11, kTop_m}));
  for (int i = -4; i <= 4; ++i) {  // Web stiffeners.
    const double x_m = 0.95 * i;
    frame.Append(MakeBlock({x_m - 0.008, y_m - 0.09, 0.57}, {x_m + 0.008, y_m + 0.09, kTop_m}));
  }
}

/// Adds supports and spigots for three 20-foot containers, or for a 40-foot and a 20-foot one.
void AddContainerSpigots(double side, Mesh& frame) {
  for (const double x_m : {2.93, 3.17, 6.0, 9.02}) {
    for (const double end : kBothSides) {
      const double x0 = end * x_m;
      const double y0 = side * 1.13;
      frame.Append(MakeBlock({x0 - 0.10, y0 - 0.10, 1.14}, {x0 + 0.10, y0 + 0.10, 1.16}));
      const std::vector<Point2> spigot = {{1.16, 0.045}, {1.26, 0.02}};
      const Transform upright =
          MakeTransform(RotationFromYawPitchRoll(0, -0.5 * std::numbers::pi, 0), {x0, y0, 0});
      frame.Append(MakeLathe(spigot, 6), upright);
    }
  }
}

/// Adds cross members between the sills, and chequer plates and hand rails at the ends.
void AddCrossMembers(Mesh& frame) {
  for (const double x_m : {0.95, 2.85, 4.0, 5.7, 8.6}) {
    for (const double end : kBothSides) {
      frame.Append(MakeEndBlock(end, {x_m - 0.06, -1.13, 0.94}, {x_m + 0.06, 1.13, 1.10}));
    }
  }
  for (const double end : kBothSides) {
    frame.Append(MakeEndBlock(end, {4.0, -0.32, 0.94}, {9.20, 0.32, 1.08}));  // Draft sill.
    frame.Append(MakeEndBlock(end, {8.75, -1.25, 1.11}, {9.25, 1.25, 1.13}));
    frame.Append(MakeEndBlock(end, {7.1 - 0.25, -1.13, kBogieTop_m}, {7.1 + 0.25, 1.13, 1.10}));
    // Diagonals that transfer the coupling force into the side sills.
    for (const double side : kBothSides) {
      frame.Append(MakeBar({end * 4.1, side * 0.2, 1.0}, {end * 2.9, side * 1.1, 1.0}, 0.06));
    }
  }
}

/// Adds a hand brake wheel on either side.
void AddHandBrake(Mesh& frame) {
  const std::vector<Point2> wheel = {{0.0, 0.20}, {0.03, 0.20}};
  for (const double side : kBothSides) {
    const Eigen::Matrix3d turn = RotationFromYawPitchRoll(side * 0.5 * std::numbers::pi, 0, 0);
    frame.Append(MakeLathe(wheel, 12), MakeTransform(turn, {3.5, side * 1.26, 0.82}));
    frame.Append(MakeBar({3.5, side * 1.1, 0.82}, {3.5, side * 1.28, 0.82}, 0.025));
  }
}

}  // namespace

RailVehicleModel MakeFlatWagon(const RailSurfaces& surfaces) {
  Model wagon{.name = "flat_wagon", .parts = {}};
  Mesh body;
  AddCrossMembers(body);
  for (const double side : kBothSides) {
    AddFishBelliedSill(side, body);
    AddContainerSpigots(side, body);
  }
  MeshOf(surfaces.wagon_body, wagon) = std::move(body);
  Mesh& frame = MeshOf(surfaces.wagon_frame, wagon);
  AddHandBrake(frame);
  frame.Append(MakeBrakeGear(kFlatWagonPivotDistance_m));
  frame.Append(MakeCornerSteps(8.9, 1.15, 0.95));
  AddDrawAndBufferGear(kFlatWagonMeasures.length_m, surfaces.wagon_frame, wagon);
  return {std::move(wagon), MakeWagonBogie(surfaces)};
}

}  // namespace railcast
