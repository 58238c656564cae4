#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/road_vehicles.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

constexpr double kBicycleWheel_m = 0.348;  // 37-622.
constexpr double kBicycleRearAxle_m = -0.552;
constexpr double kBicycleFrontAxle_m = 0.552;

/// An endless tube about the y axis of a wheel.
Mesh MakeHoop(const Vector3& hub_m, double radius_m, const Point2& half_m, int num_sides) {
  std::vector<Point2> section;
  for (int i = 0; i < 6; ++i) {
    const double angle_rad = std::numbers::pi * (i / 3.0 + 0.5);
    section.emplace_back(half_m.x() * std::cos(angle_rad),
                         radius_m + half_m.y() * std::sin(angle_rad));
  }
  Mesh hoop;
  hoop.Append(MakeRevolvedBody(section, num_sides),
              MakeTransform(Eigen::Matrix3d::Identity(), hub_m));
  return hoop;
}

Mesh MakeThinBar(const Vector3& begin_m, const Vector3& end_m, double radius_m) {
  const std::vector<Vector3> axis = {begin_m, end_m};
  return MakeTube(axis, radius_m, radius_m < 0.003 ? 3 : 8);
}

void AddBicycleWheel(double axle_x_m, const RoadVehicleSurfaces& surfaces, Model& bicycle) {
  const Vector3 hub_m(axle_x_m, 0.0, kBicycleWheel_m);
  MeshOf(surfaces.tyre, bicycle)
      .Append(MakeHoop(hub_m, kBicycleWheel_m - 0.0185, {0.0185, 0.0185}, 36));
  Mesh metal;
  metal.Append(MakeHoop(hub_m, 0.305, {0.013, 0.010}, 36));
  metal.Append(MakeThinBar(hub_m - Vector3(0, 0.05, 0), hub_m + Vector3(0, 0.05, 0), 0.02));
  constexpr int kSpokes = 36;  // Of 2 mm.
  for (int i = 0; i < kSpokes; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kSpokes;
    const double side_m = i % 2 == 0 ? 0.03 : -0.03;
    const Vector3 out(std::cos(angle_rad), 0.0, std::sin(angle_rad));
    metal.Append(
        MakeThinBar(hub_m + 0.018 * out + Vector3(0, side_m, 0), hub_m + 0.30 * out, 0.001));
  }
  for (const double end : kBothSides) {  // Reflectors between the spokes.
    const Vector3 middle_m = hub_m + Vector3(end * 0.20, 0.0, 0.0);
    MeshOf(surfaces.reflector, bicycle)
        .Append(MakeBlock(middle_m - Vector3(0.018, 0.012, 0.035),
                          middle_m + Vector3(0.018, 0.012, 0.035)));
  }
  MeshOf(surfaces.metal, bicycle).Append(metal);
}

void AddBicycleFrame(const RoadVehicleSurfaces& surfaces, Model& bicycle) {
  const Vector3 crank_m(-0.09, 0.0, 0.29);
  const Vector3 seat_m(-0.24, 0.0, 0.74);
  const Vector3 head_top_m(0.33, 0.0, 0.80);
  const Vector3 head_m(0.37, 0.0, 0.66);
  const Vector3 rear_m(kBicycleRearAxle_m, 0.0, kBicycleWheel_m);
  const Vector3 front_m(kBicycleFrontAxle_m, 0.0, kBicycleWheel_m);
  Mesh frame;
  frame.Append(MakeThinBar(crank_m, seat_m, 0.016));
  frame.Append(MakeThinBar(seat_m - Vector3(0, 0, 0.04), head_top_m - Vector3(0, 0, 0.04), 0.016));
  frame.Append(MakeThinBar(crank_m, head_m, 0.018));
  frame.Append(MakeThinBar(head_m, head_top_m, 0.02));
  for (const double side : kBothSides) {
    const Vector3 out(0.0, side * 0.06, 0.0);
    frame.Append(MakeThinBar(crank_m + 0.4 * out, rear_m + out, 0.010));
    frame.Append(MakeThinBar(seat_m + 0.2 * out - Vector3(0, 0, 0.05), rear_m + out, 0.008));
    frame.Append(MakeThinBar(head_m + 0.9 * out - Vector3(0, 0, 0.02), front_m + out, 0.012));
  }
  frame.Append(MakeThinBar(head_m - Vector3(0, 0.055, 0.02), head_m + Vector3(0, 0.055, -0.02),
                           0.014));  // Fork crown.
  Mesh metal;
  metal.Append(MakeThinBar(seat_m, seat_m + Vector3(-0.055, 0, 0.19), 0.013));
  metal.Append(MakeThinBar(head_top_m, head_top_m + Vector3(-0.045, 0, 0.20), 0.013));
  // Handlebar, swept back, with grips.
  const Vector3 stem_m = head_top_m + Vector3(-0.045, 0, 0.20);
  for (const double side : kBothSides) {
    const std::vector<Vector3> bar = {stem_m, stem_m + Vector3(0.05, side * 0.10, 0.05),
                                      stem_m + Vector3(-0.03, side * 0.26, 0.055),
                                      stem_m + Vector3(-0.16, side * 0.285, 0.05)};
    metal.Append(MakeTube(bar, 0.011, 8));
    MeshOf(surfaces.trim, bicycle).Append(MakeThinBar(bar[2], bar[3], 0.016));
    // Cranks and pedals.
    const Vector3 pedal_m = crank_m + Vector3(side * 0.17, side * 0.09, 0.0);
    metal.Append(MakeThinBar(crank_m + Vector3(0, side * 0.07, 0), pedal_m, 0.012));
    MeshOf(surfaces.trim, bicycle)
        .Append(MakeSideBlock(side, {side * 0.17 - 0.14, 0.09, 0.28},
                              {side * 0.17 - 0.04, 0.19, 0.30}));
  }
  MeshOf(surfaces.paint, bicycle).Append(frame);
  MeshOf(surfaces.metal, bicycle).Append(metal);
}

void AddBicycleFittings(const RoadVehicleSurfaces& surfaces, Model& bicycle) {
  Mesh trim;
  const std::vector<OvalSection> saddle = {{-0.42, 0.945, 0.035, 0.095},
                                           {-0.34, 0.955, 0.035, 0.085},
                                           {-0.24, 0.95, 0.03, 0.045},
                                           {-0.15, 0.945, 0.02, 0.02}};
  trim.Append(MakeOvalBody(saddle, {0.0, 0.0}, 10));
  // Mudguards, chain case, carrier, lamps.
  for (const auto& [axle_m, from_deg, to_deg] : {std::array{kBicycleRearAxle_m, 20.0, 150.0},
                                                 std::array{kBicycleFrontAxle_m, 60.0, 185.0}}) {
    std::vector<Vector3> arc;
    for (int i = 0; i <= 10; ++i) {
      const double angle_rad = RadFromDeg(std::lerp(from_deg, to_deg, i / 10.0));
      arc.emplace_back(axle_m + 0.360 * std::cos(angle_rad), 0.0,
                       kBicycleWheel_m + 0.360 * std::sin(angle_rad));
    }
    trim.Append(MakeTube(arc, 0.012, 4));
  }
  trim.Append(MakeBlock({-0.60, 0.06, 0.24}, {0.0, 0.075, 0.36}));
  Mesh metal;
  for (const double side : kBothSides) {
    metal.Append(MakeThinBar({-0.82, side * 0.06, 0.745}, {-0.30, side * 0.06, 0.745}, 0.006));
    metal.Append(MakeThinBar({-0.62, side * 0.07, 0.745},
                             {kBicycleRearAxle_m, side * 0.07, kBicycleWheel_m}, 0.006));
  }
  for (const double x_m : {-0.82, -0.62, -0.42}) {
    metal.Append(MakeThinBar({x_m, -0.06, 0.745}, {x_m, 0.06, 0.745}, 0.006));
  }
  MeshOf(surfaces.reflector, bicycle)
      .Append(MakeBlock({-0.85, -0.045, 0.70}, {-0.83, 0.045, 0.74}));
  MeshOf(surfaces.window, bicycle)
      .Append(MakeEllipsoid({0.44, 0.0, 0.77}, {0.035, 0.035, 0.035}, 8));
  MeshOf(surfaces.trim, bicycle).Append(trim);
  MeshOf(surfaces.metal, bicycle).Append(metal);
}

}  // namespace

Model MakeBicycle(const RoadVehicleSurfaces& surfaces) {
  Model bicycle{.name = "bicycle", .parts = {}};
  AddBicycleWheel(kBicycleRearAxle_m, surfaces, bicycle);
  AddBicycleWheel(kBicycleFrontAxle_m, surfaces, bicycle);
  AddBicycleFrame(surfaces, bicycle);
  AddBicycleFittings(surfaces, bicycle);
  return bicycle;
}

}  // namespace railcast
