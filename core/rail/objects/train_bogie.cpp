#include "core/rail/objects/train_bogie.h"

#include <array>
#include <numbers>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using FramePoint = Eigen::Vector2d;

constexpr double kFrameMiddle_m = 1.0;  ///< Lateral distance of the side frames from the axis.

/// Outline of a side frame: low between the axles, raised above the axle boxes.
std::vector<FramePoint> OutlineOfSideFrame(const TrainBogieShape& shape) {
  const double r_m = shape.wheel_radius_m;
  const double end_m = shape.axle_base_m / 2.0 + 0.48;
  const std::vector<FramePoint> half = {{0.50, r_m - 0.12},  {0.78, r_m + 0.18},
                                        {end_m, r_m + 0.18}, {end_m, r_m + 0.30},
                                        {0.66, r_m + 0.32},  {0.40, r_m + 0.08}};
  std::vector<FramePoint> outline = half;
  for (auto point = half.rbegin(); point != half.rend(); ++point) {
    outline.emplace_back(-point->x(), point->y());
  }
  return outline;
}

/// Adds an axle box with its cover, its arm towards the middle and the spring above it.
void AddAxleGuide(const TrainBogieShape& shape, double end, double side, Mesh& mesh) {
  const double x_m = end * shape.axle_base_m / 2.0;
  const double r_m = shape.wheel_radius_m;
  mesh.Append(MakeSideBlock(side, {x_m - 0.16, 0.90, r_m - 0.15}, {x_m + 0.16, 1.10, r_m + 0.12}));
  const std::vector<FramePoint> cover = {{0.0, 0.14}, {0.06, 0.12}, {0.075, 0.0}};
  const Eigen::Matrix3d turn = RotationFromYawPitchRoll(side * std::numbers::pi / 2.0, 0, 0);
  mesh.Append(MakeLathe(cover, 8), MakeTransform(turn, {x_m, side * 1.10, r_m}));
  mesh.Append(MakeBar({x_m, side * 1.0, r_m - 0.08}, {end * 0.46, side * 1.0, r_m - 0.02}, 0.06));
  const std::array<Vector3, 2> spring = {Vector3(x_m, side * 1.0, r_m + 0.10),
                                         Vector3(x_m, side * 1.0, r_m + 0.20)};
  mesh.Append(MakeTube(spring, 0.13, 8));
  // Brake unit and sand pipe with guard iron.
  mesh.Append(MakeBar({x_m - end * (r_m + 0.06), side * 0.75, r_m - 0.05},
                      {x_m - end * (r_m + 0.06), side * 0.75, r_m + 0.22}, 0.06));
  mesh.Append(MakeBar({x_m + end * (r_m + 0.05), side * 0.75, 0.10},
                      {x_m + end * (r_m - 0.02), side * 0.92, r_m + 0.20}, 0.024));
}

void AddMotor(const TrainBogieShape& shape, double end, Mesh& mesh) {
  const double x_m = end * (shape.axle_base_m / 2.0 - 0.52);
  const double z_m = shape.wheel_radius_m + 0.02;
  mesh.Append(MakeBar({x_m, -0.55, z_m}, {x_m, 0.55, z_m}, 0.27));
}

/// Adds the springs that carry the body, and a damper beside them, on one side.
void AddSecondarySprings(const TrainBogieShape& shape, double side, Mesh& mesh) {
  const double r_m = shape.wheel_radius_m;
  const std::array<Vector3, 2> spring = {Vector3(0, side * kFrameMiddle_m, r_m + 0.05),
                                         Vector3(0, side * kFrameMiddle_m, shape.top_m)};
  mesh.Append(MakeTube(spring, 0.24, 12));
  const double z_m = r_m + 0.12;
  mesh.Append(MakeBar({0.30, side * 1.16, z_m}, {0.95, side * 1.16, z_m + 0.02}, 0.045));
  mesh.Append(MakeSideBlock(side, {0.26, 1.04, z_m - 0.06}, {0.36, 1.20, z_m + 0.08}));
}

/// Adds a collector for a third rail that is touched from below, with its beam.
void AddShoe(const TrainBogieShape& shape, double side, Mesh& mesh) {
  const double half_m = shape.axle_base_m / 2.0;
  mesh.Append(MakeSideBlock(side, {-half_m, 1.09, 0.34}, {half_m, 1.17, 0.44}));
  mesh.Append(MakeSideBlock(side, {-0.12, 1.17, 0.20}, {0.12, 1.38, 0.24}));
  mesh.Append(MakeSideBlock(side, {-0.10, 1.17, 0.24}, {0.10, 1.22, 0.40}));
}

}  // namespace

Model MakeTrainBogie(const TrainBogieShape& shape, const RailSurfaces& surfaces) {
  Model bogie{.name = "train_bogie", .parts = {}};
  const double r_m = shape.wheel_radius_m;
  for (const double end : kBothSides) {
    AddWheelset({end * shape.axle_base_m / 2.0, r_m}, surfaces.vehicles.wheel, bogie);
  }
  Mesh& frame = MeshOf(surfaces.vehicles.frame, bogie);
  const std::vector<FramePoint> side_frame = OutlineOfSideFrame(shape);
  for (const double side : kBothSides) {
    const double middle_m = side * kFrameMiddle_m;
    frame.Append(MakePlate(side_frame, middle_m - 0.08, middle_m + 0.08));
    for (const double end : kBothSides) AddAxleGuide(shape, end, side, frame);
    AddSecondarySprings(shape, side, frame);
    if (shape.has_shoes) AddShoe(shape, side, frame);
  }
  frame.Append(MakeBlock({-0.30, -0.94, r_m - 0.12}, {0.30, 0.94, r_m + 0.08}));
  const double end_m = shape.axle_base_m / 2.0 + 0.42;
  for (const double end : kBothSides) {
    frame.Append(
        MakeEndBlock(end, {end_m - 0.06, -0.94, r_m + 0.18}, {end_m + 0.06, 0.94, r_m + 0.28}));
    if (shape.has_motors) AddMotor(shape, end, frame);
  }
  frame.Append(MakeBar({0, 0, r_m}, {0, 0, shape.top_m}, 0.16));
  return bogie;
}

}  // namespace railcast
