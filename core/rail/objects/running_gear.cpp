#include "core/rail/objects/wagon_parts.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

constexpr double kQuarterTurn_rad = std::numbers::pi / 2.0;
constexpr int kWheelSides = 16;

/// Rotates a body that lies along x towards +y or -y.
Transform TowardsSide(double side, const Vector3& origin_m) {
  return MakeTransform(RotationFromYawPitchRoll(side * kQuarterTurn_rad, 0, 0), origin_m);
}

/// A wheel about the x axis, with x pointing outwards from the back of the flange: hub, web, rim,
/// and the UIC 510-2 tread with its flange.
Mesh MakeWheel(double radius_m) {
  const std::vector<Point2> profile = {
      {0.04, radius_m - 0.07},    {0.0, radius_m + 0.018}, {0.016, radius_m + kFlangeHeight_m},
      {0.0325, radius_m + 0.010}, {0.07, radius_m},        {0.135, radius_m - 0.003},
      {0.085, radius_m - 0.07}};
  return MakeLathe(profile, kWheelSides);
}

/// Adds an axle box with its cover, the wings under the springs, and the two springs.
void AddAxleBox(double x_m, double side, Mesh& mesh) {
  const auto between = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
    const double a = side * y0;
    const double b = side * y1;
    return MakeBlock({x_m + x0, std::min(a, b), z0}, {x_m + x1, std::max(a, b), z1});
  };
  mesh.Append(between(-0.15, 0.15, 0.90, 1.10, 0.33, 0.62));
  mesh.Append(between(-0.43, 0.43, 0.93, 1.08, 0.29, 0.34));
  const std::vector<Point2> cover = {{0.0, 0.14}, {0.05, 0.12}, {0.06, 0.0}};
  mesh.Append(MakeLathe(cover, 8), TowardsSide(side, {x_m, side * 1.10, kWheelRadius_m}));
  for (const double end : kBothSides) {
    const double spring_x_m = x_m + end * 0.31;
    const std::vector<Vector3> axis = {{spring_x_m, side * 1.005, 0.33},
                                       {spring_x_m, side * 1.005, 0.62}};
    mesh.Append(MakeTube(axis, 0.085, 6));
    mesh.Append(between(end * 0.19 - 0.03, end * 0.19 + 0.03, 0.91, 1.09, 0.38, 0.62));
  }
}

/// Outline of a bogie side frame: deep between the axles, arched above the axle boxes.
std::vector<Point2> SideFrameOutline() {
  const std::vector<Point2> half = {{0.24, 0.42}, {0.42, 0.60}, {1.46, 0.60}, {1.54, 0.64},
                                    {1.54, 0.72}, {1.20, 0.80}, {0.62, 0.80}, {0.38, 0.73}};
  std::vector<Point2> outline = half;
  for (auto point = half.rbegin(); point != half.rend(); ++point) {
    outline.emplace_back(-point->x(), point->y());
  }
  return outline;
}

/// One buffer, with x pointing out of the wagon.
Mesh MakeBuffer() {
  // Sleeve, plunger, and a disc whose face is a spherical cap of 1.5 m radius.
  const std::vector<Point2> profile = {{0.0, 0.11},
                                       {0.33, 0.11},
                                       {0.33, 0.085},
                                       {0.57, 0.085},
                                       {0.575, kBufferRadius_m},
                                       {0.603, kBufferRadius_m},
                                       {kBufferLength_m, 0.0}};
  Mesh buffer = MakeLathe(profile, 16);
  buffer.Append(MakeBlock({0.0, -0.19, -0.19}, {0.03, 0.19, 0.19}));
  return buffer;
}

/// A draw hook with the screw coupling hanging from it. The origin is in the face of the headstock
/// at buffer height.
Mesh MakeCoupling() {
  const std::vector<Point2> hook = {{0.0, -0.05}, {0.24, -0.05}, {0.32, -0.13}, {0.38, -0.10},
                                    {0.40, 0.0},  {0.33, 0.08},  {0.28, 0.05},  {0.31, -0.01},
                                    {0.25, 0.01}, {0.22, 0.05},  {0.0, 0.05}};
  Mesh mesh = MakePlate(hook, -0.03, 0.03);
  mesh.Append(MakeBlock({0.0, -0.13, -0.13}, {0.025, 0.13, 0.13}));
  const std::vector<Vector3> links = {{0.20, -0.09, 0.0},
                                      {0.22, -0.09, -0.48},
                                      {0.20, 0.0, -0.56},
                                      {0.22, 0.09, -0.48},
                                      {0.20, 0.09, 0.0}};
  mesh.Append(MakeTube(links, 0.02, 4));
  mesh.Append(MakeBar({0.22, -0.16, -0.22}, {0.22, 0.16, -0.22}, 0.03));
  mesh.Append(MakeBar({0.20, -0.12, 0.0}, {0.20, 0.12, 0.0}, 0.025));
  for (const double side : kBothSides) {
    const std::vector<Vector3> hose = {{0.0, side * 0.33, -0.08},
                                       {0.10, side * 0.33, -0.12},
                                       {0.16, side * 0.33, -0.35},
                                       {0.10, side * 0.33, -0.50}};
    mesh.Append(MakeTube(hose, 0.022, 4));
  }
  return mesh;
}

}  // namespace

void AddWheelset(const WheelsetPlace& place, const SurfaceClass& surface, Model& bogie) {
  const Mesh wheel = MakeWheel(place.radius_m);
  Mesh& mesh = MeshOf(surface, bogie);
  for (const double side : kBothSides) {
    mesh.Append(wheel,
                TowardsSide(side, {place.x_m, side * kFlangeBackDistance_m / 2.0, place.radius_m}));
  }
  mesh.Append(MakeBar({place.x_m, -0.9, place.radius_m}, {place.x_m, 0.9, place.radius_m}, 0.1));
}

Model MakeWagonBogie(const RailSurfaces& surfaces) {
  Model bogie{.name = "wagon_bogie", .parts = {}};
  for (const double end : kBothSides) {
    AddWheelset({.x_m = end * kBogieAxleBase_m / 2.0}, surfaces.wheel, bogie);
  }
  Mesh& frame = MeshOf(surfaces.wagon_frame, bogie);
  const std::vector<Point2> side_frame = SideFrameOutline();
  for (const double side : kBothSides) {
    const double middle_m = side * 1.005;
    frame.Append(MakePlate(side_frame, middle_m - 0.06, middle_m + 0.06));
    frame.Append(
        MakeBlock({-0.14, side * 0.85 - 0.1, 0.70}, {0.14, side * 0.85 + 0.1, kBogieTop_m}));
    for (const double end : kBothSides) AddAxleBox(end * kBogieAxleBase_m / 2.0, side, frame);
  }
  frame.Append(MakeBlock({-0.24, -0.97, 0.46}, {0.24, 0.97, 0.72}));
  frame.Append(MakeBar({0, 0, 0.70}, {0, 0, kBogieTop_m}, 0.2));
  for (const double end : kBothSides) {
    const double x_m = end * 1.48;
    frame.Append(MakeBlock({x_m - 0.05, -0.97, 0.60}, {x_m + 0.05, 0.97, 0.71}));
  }
  return bogie;
}

void AddDrawAndBufferGear(double length_m, const SurfaceClass& surface, Model& vehicle) {
  const Mesh buffer = MakeBuffer();
  Mesh end_gear = MakeCoupling();
  for (const double side : kBothSides) {
    end_gear.Append(
        buffer, MakeTransform(Eigen::Matrix3d::Identity(), {0, side * kBufferDistance_m / 2.0, 0}));
  }
  end_gear.Append(MakeBlock({-0.22, -1.30, -0.19}, {0.0, 1.30, 0.16}));
  Mesh& mesh = MeshOf(surface, vehicle);
  const double headstock_x_m = length_m / 2.0 - kBufferLength_m;
  for (const double yaw_rad : {0.0, std::numbers::pi}) {
    const Eigen::Matrix3d turn = RotationFromYawPitchRoll(yaw_rad, 0, 0);
    mesh.Append(end_gear, MakeTransform(turn, turn * Vector3(headstock_x_m, 0, 0) +
                                                  Vector3(0, 0, kBufferHeight_m)));
  }
}

}  // namespace railcast
