#include <cmath>
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

constexpr double kTankWagonPivotDistance_m = kTankWagonMeasures.pivot_distance_m;
constexpr double kTankRadius_m = 1.45;
constexpr double kTankAxis_m = 2.62;  ///< Above top of rail.
constexpr double kTankHalfLength_m = 7.2;
constexpr double kTop_m = 4.27;

/// The shell with its dished ends, modelled as half ellipses.
Mesh MakeTankShell() {
  constexpr double kDish_m = 0.5;
  constexpr int kDishSteps = 4;
  std::vector<Point2> profile;
  for (int i = 0; i <= kDishSteps; ++i) {
    const double angle_rad = 0.5 * std::numbers::pi * i / kDishSteps;
    profile.emplace_back(-kTankHalfLength_m + kDish_m * (1.0 - std::cos(angle_rad)),
                         kTankRadius_m * std::sin(angle_rad));
  }
  for (std::size_t i = profile.size(); i-- > 0;) {
    profile.emplace_back(-profile[i].x(), profile[i].y());
  }
  Mesh shell;
  shell.Append(MakeLathe(profile, 40),
               MakeTransform(Eigen::Matrix3d::Identity(), {0, 0, kTankAxis_m}));
  return shell;
}

/// Manhole with cover, safety valve, and the valve box below.
Mesh MakeFittings() {
  const Transform upright =
      MakeTransform(RotationFromYawPitchRoll(0, -0.5 * std::numbers::pi, 0), Vector3::Zero());
  const std::vector<Point2> manhole = {
      {4.0, 0.29}, {4.20, 0.29}, {4.20, 0.34}, {4.24, 0.34}, {kTop_m, 0.0}};
  const std::vector<Point2> valve = {{4.0, 0.10}, {4.18, 0.10}, {4.22, 0.05}};
  Mesh fittings;
  fittings.Append(MakeLathe(manhole, 12), upright);
  fittings.Append(MakeLathe(valve, 8), MakeTransform(upright.linear(), {1.1, 0, 0}));
  fittings.Append(MakeBlock({-0.25, -0.25, 0.85}, {0.25, 0.25, 1.25}));
  const std::vector<Vector3> outlet = {
      {0, -1.35, 0.72}, {0, -1.1, 0.86}, {0, 1.1, 0.86}, {0, 1.35, 0.72}};
  fittings.Append(MakeTube(outlet, 0.07, 8));
  return fittings;
}

/// Adds the gratings on top of the tank, with their brackets.
void AddWalkway(Mesh& frame) {
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-2.4, 0.38, 4.10}, {2.4, 0.78, 4.13}));
    for (const double x_m : {-2.3, -0.8, 0.8, 2.3}) {
      frame.Append(MakeSideBlock(side, {x_m - 0.03, 0.36, 3.75}, {x_m + 0.03, 0.72, 4.10}));
    }
  }
}

/// Adds a ladder on each side of the tank up to the walkway, bent around the shell.
void AddLadders(Mesh& frame) {
  constexpr double kRungSpacing_m = 0.28;
  for (const double side : kBothSides) {
    const std::vector<Vector3> rail = {{0, side * 1.50, 0.55},
                                       {0, side * 1.53, 2.62},
                                       {0, side * 1.36, 3.40},
                                       {0, side * 0.95, 3.95},
                                       {0, side * 0.60, 4.14}};
    const Vector3 half_rung_m(0.2, 0, 0);
    for (const double x_m : {1.35, 1.75}) {
      const Transform place = MakeTransform(Eigen::Matrix3d::Identity(), {x_m, 0, 0});
      frame.Append(MakeTube(rail, 0.022, 4), place);
    }
    const Vector3 middle_m(1.55, 0, 0);
    for (std::size_t piece = 0; piece + 1 < rail.size(); ++piece) {
      const Vector3 along = rail[piece + 1] - rail[piece];
      const int num_rungs = static_cast<int>(along.norm() / kRungSpacing_m);
      for (int rung = 0; rung < num_rungs; ++rung) {
        const Vector3 at = middle_m + rail[piece] + along * ((rung + 0.5) / num_rungs);
        frame.Append(MakeBar(at - half_rung_m, at + half_rung_m, 0.015));
      }
    }
  }
}

/// Adds the platform with its railing at the back end.
void AddEndPlatform(Mesh& frame) {
  frame.Append(MakeBlock({-7.38, -1.25, 1.22}, {-6.75, 1.25, 1.25}));
  for (const double y_m : {-1.2, -0.4, 0.4, 1.2}) {
    frame.Append(MakeBar({-7.35, y_m, 1.22}, {-7.35, y_m, 2.25}, 0.022));
  }
  for (const double z_m : {1.75, 2.25}) {
    frame.Append(MakeBar({-7.35, -1.22, z_m}, {-7.35, 1.22, z_m}, 0.022));
  }
}

/// Adds side sills, and the saddles that carry the tank above the bogies.
void AddFrame(Mesh& frame) {
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-7.2, 0.92, 0.96}, {7.2, 1.05, 1.20}));
    frame.Append(MakeSideBlock(side, {-7.2, 0.84, 1.17}, {7.2, 1.12, 1.20}));
  }
  for (const double x_m : {0.0, 2.4}) {
    for (const double end : kBothSides) {
      frame.Append(MakeEndBlock(end, {x_m - 0.06, -1.0, 0.98}, {x_m + 0.06, 1.0, 1.16}));
    }
  }
  // The saddle fills the space between frame and shell up to 50 degrees to either side of the
  // bottom.
  std::vector<Point2> saddle = {{1.25, 1.18}};
  for (int i = -5; i <= 5; ++i) {
    const double angle_rad = -0.17 * i;
    saddle.emplace_back(kTankRadius_m * std::sin(angle_rad),
                        kTankAxis_m - kTankRadius_m * std::cos(angle_rad));
  }
  saddle.emplace_back(-1.25, 1.18);
  saddle.emplace_back(-1.1, 1.0);
  saddle.emplace_back(1.1, 1.0);
  for (const double end : kBothSides) {
    const double pivot_m = end * kTankWagonPivotDistance_m / 2.0;
    for (const double offset : {-0.45, 0.45}) {
      frame.Append(MakeExtrusion(saddle, pivot_m + offset - 0.04, pivot_m + offset + 0.04));
    }
  }
  frame.Append(MakeCentreSill(7.2, kTankWagonPivotDistance_m, 1.15));
  frame.Append(MakeCornerSteps(7.05, 1.15, 1.0));
  frame.Append(MakeBrakeGear(kTankWagonPivotDistance_m));
}

}  // namespace

RailVehicleModel MakeTankWagon(const RailSurfaces& surfaces) {
  Model wagon{.name = "tank_wagon", .parts = {}};
  Mesh& tank = MeshOf(surfaces.tank, wagon);
  tank = MakeTankShell();
  tank.Append(MakeFittings());
  Mesh frame;
  AddFrame(frame);
  AddWalkway(frame);
  AddLadders(frame);
  AddEndPlatform(frame);
  MeshOf(surfaces.wagon_frame, wagon) = std::move(frame);
  AddDrawAndBufferGear(kTankWagonMeasures.length_m, surfaces.wagon_frame, wagon);
  return {std::move(wagon), MakeWagonBogie(surfaces)};
}

}  // namespace railcast
