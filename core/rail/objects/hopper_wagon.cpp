#include <algorithm>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using HopperPoint = Eigen::Vector2d;

constexpr double kHopperPivotDistance_m = kHopperWagonMeasures.pivot_distance_m;
constexpr double kHopperTop_m = kHopperWagonMeasures.height_m;
constexpr double kOpeningHalfLength_m = 11.94 / 2.0;
constexpr double kOpeningHalfWidth_m = 1.94 / 2.0;
constexpr double kHinge_m = 2.46;  ///< Height above top of rail where the flaps hang.

/// Outer face of a side above the hinges, from the bottom to the top.
const std::vector<HopperPoint>& UpperFace() {
  static const std::vector<HopperPoint> face = {
      {1.44, kHinge_m}, {1.44, 3.02}, {1.03, kHopperTop_m}};
  return face;
}

/// Outer face of a flap, from its lower edge to the hinge.
const std::vector<HopperPoint>& FlapFace() {
  static const std::vector<HopperPoint> face = {
      {1.30, 1.02}, {1.47, 1.45}, {1.47, kHinge_m - 0.02}};
  return face;
}

/// A sheet or rib on a face, from `inner_m` to `outer_m` to the outside of it.
Mesh MakeOnFace(double side,
                const std::vector<HopperPoint>& face,
                const HopperPoint& begin_end_x_m,
                const HopperPoint& inner_outer_m) {
  std::vector<HopperPoint> ring;
  for (const HopperPoint& point : face) {
    ring.emplace_back(side * (point.x() + inner_outer_m.y()), point.y());
  }
  for (auto point = face.rbegin(); point != face.rend(); ++point) {
    ring.emplace_back(side * (point->x() + inner_outer_m.x()), point->y());
  }
  return MakeExtrusion(ring, begin_end_x_m.x(), begin_end_x_m.y());
}

/// Adds the upper wall with its posts and top chord, and the two flaps with hinges, ribs and the
/// latch shaft below, on one side.
void AddHopperSide(double side, Mesh& body, Mesh& frame) {
  const double end_m = kOpeningHalfLength_m;
  body.Append(MakeOnFace(side, UpperFace(), {-end_m, end_m}, {-0.06, 0.0}));
  body.Append(MakeSideBlock(side, {-end_m - 0.05, kOpeningHalfWidth_m, kHopperTop_m - 0.12},
                            {end_m + 0.05, kOpeningHalfWidth_m + 0.12, kHopperTop_m}));
  for (int i = -5; i <= 5; ++i) {
    const double x_m = 1.16 * i;
    body.Append(MakeOnFace(side, UpperFace(), {x_m - 0.04, x_m + 0.04}, {-0.02, 0.07}));
  }
  for (const double half : kBothSides) {
    const double middle_m = half * 2.70;
    body.Append(MakeOnFace(side, FlapFace(), {middle_m - 2.5, middle_m + 2.5}, {-0.05, 0.0}));
    for (int i = 0; i <= 6; ++i) {
      const double x_m = middle_m - 2.43 + 0.81 * i;
      body.Append(MakeOnFace(side, FlapFace(), {x_m - 0.035, x_m + 0.035}, {-0.02, 0.05}));
    }
    for (const double x_m : {-2.0, -0.7, 0.7, 2.0}) {
      frame.Append(MakeSideBlock(side, {middle_m + x_m - 0.07, 1.45, kHinge_m - 0.20},
                                 {middle_m + x_m + 0.07, 1.534, kHinge_m + 0.05}));
      // Claw that holds the flap's lower edge.
      frame.Append(MakeSideBlock(side, {middle_m + x_m - 0.05, 1.20, 0.94},
                                 {middle_m + x_m + 0.05, 1.38, 1.06}));
    }
  }
  frame.Append(MakeBar({-5.6, side * 1.47, kHinge_m}, {5.6, side * 1.47, kHinge_m}, 0.03));
  frame.Append(MakeBar({-5.3, side * 1.16, 0.98}, {5.3, side * 1.16, 0.98}, 0.05));
  for (const double x_m : {-5.55, 0.0, 5.55}) {  // Posts between the flaps.
    body.Append(MakeSideBlock(side, {x_m - 0.10, 1.28, 1.0}, {x_m + 0.10, 1.45, kHinge_m}));
  }
}

/// An end wall with its posts, the platform in front of it and a ladder.
void AddHopperEnd(double end, Mesh& body, Mesh& frame) {
  const std::vector<HopperPoint> outline = {
      {-1.40, 1.0},         {1.40, 1.0},           {1.44, 1.45},  {1.44, 3.02},
      {1.03, kHopperTop_m}, {-1.03, kHopperTop_m}, {-1.44, 3.02}, {-1.44, 1.45}};
  const double outer_m = end * (kOpeningHalfLength_m + 0.06);
  const double inner_m = end * kOpeningHalfLength_m;
  body.Append(MakeExtrusion(outline, std::min(inner_m, outer_m), std::max(inner_m, outer_m)));
  const double face_m = kOpeningHalfLength_m + 0.06;
  for (const double y_m : {-1.20, -0.4, 0.4, 1.20}) {
    body.Append(MakeEndBlock(end, {face_m, y_m - 0.05, 1.2}, {face_m + 0.10, y_m + 0.05, 3.5}));
  }
  for (const double z_m : {1.9, 2.7, 3.45}) {
    body.Append(MakeEndBlock(end, {face_m, -1.2, z_m}, {face_m + 0.08, 1.2, z_m + 0.10}));
  }
  frame.Append(MakeEndBlock(end, {5.6, -1.30, 1.14}, {6.13, 1.30, 1.17}));
  const double rail_m = end * (face_m + 0.20);
  for (const double y_m : {0.62, 1.02}) {
    frame.Append(MakeBar({rail_m, end * y_m, 0.6}, {rail_m, end * y_m, 3.9}, 0.018));
  }
  for (int i = 0; i < 11; ++i) {
    const double z_m = 0.75 + 0.29 * i;
    frame.Append(MakeBar({rail_m, end * 0.62, z_m}, {rail_m, end * 1.02, z_m}, 0.013));
  }
  for (const double y_m : {-1.25, 1.25}) {
    frame.Append(MakeBar({end * 6.10, y_m, 1.15}, {end * 6.10, y_m, 2.15}, 0.02));
  }
  frame.Append(MakeBar({end * 6.10, -end * 1.27, 2.15}, {end * 6.10, end * 0.3, 2.15}, 0.02));
}

/// The saddle floor inside, from whose ridge the load slides to both sides.
Mesh MakeSaddle() {
  const std::vector<HopperPoint> saddle = {
      {-1.28, 1.05}, {1.28, 1.05}, {1.28, 1.12}, {0.0, 2.55}, {-1.28, 1.12}};
  return MakeExtrusion(saddle, -kOpeningHalfLength_m + 0.01, kOpeningHalfLength_m - 0.01);
}

}  // namespace

RailVehicleModel MakeHopperWagon(const RailSurfaces& surfaces) {
  Model model{.name = "hopper_wagon", .parts = {}};
  Mesh body = MakeSaddle();
  Mesh frame;
  for (const double side : kBothSides) {
    AddHopperSide(side, body, frame);
    AddHopperEnd(side, body, frame);
    frame.Append(MakeSideBlock(side, {-6.05, 0.85, 0.94}, {6.05, 1.0, 1.14}));
  }
  frame.Append(MakeCentreSill(6.1, kHopperPivotDistance_m, 1.06));
  frame.Append(MakeCornerSteps(5.85, 1.34, 1.15));
  frame.Append(MakeBrakeGear(kHopperPivotDistance_m));
  MeshOf(surfaces.wagon_body, model) = std::move(body);
  MeshOf(surfaces.wagon_frame, model) = std::move(frame);
  AddDrawAndBufferGear(kHopperWagonMeasures.length_m, surfaces.wagon_frame, model);
  return {std::move(model), MakeWagonBogie(surfaces)};
}

}  // namespace railcast
