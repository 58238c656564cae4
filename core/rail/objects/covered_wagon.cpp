#include <algorithm>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using OutlinePoint = Eigen::Vector2d;

constexpr double kCoveredPivotDistance_m = kCoveredWagonMeasures.pivot_distance_m;
constexpr double kCoveredEnd_m = 11.0;  ///< Outer faces of the end walls.
constexpr double kFloorTop_m = 1.20;
constexpr double kWallHalfWidth_m = 1.42;

/// Left half of the body's outline above the floor, which the sliding walls follow up to their
/// upper edge in the roof.
const std::vector<OutlinePoint>& WallOutline() {
  static const std::vector<OutlinePoint> outline = {{kWallHalfWidth_m, 1.08},
                                                    {kWallHalfWidth_m, 3.25},
                                                    {1.35, 3.58},
                                                    {1.20, 3.82},
                                                    {1.0, 3.98},
                                                    {0.72, 4.12}};
  return outline;
}

std::vector<OutlinePoint> MovedOut(const std::vector<OutlinePoint>& outline, double by_m) {
  std::vector<OutlinePoint> moved;
  for (const OutlinePoint& point : outline) {
    // Outwards from the axis of the body at 2.4 m.
    const OutlinePoint from_axis(point.x(), point.y() < 3.2 ? 0.0 : point.y() - 2.4);
    moved.push_back(point + by_m * from_axis.normalized());
  }
  return moved;
}

/// A sheet that follows the outline between two places along the wagon, from `inner_m` to `outer_m`
/// outside it.
Mesh MakeBentSheet(double side,
                   const OutlinePoint& begin_end_x_m,
                   const OutlinePoint& inner_outer_m) {
  std::vector<OutlinePoint> ring = MovedOut(WallOutline(), inner_outer_m.y());
  const std::vector<OutlinePoint> inner = MovedOut(WallOutline(), inner_outer_m.x());
  ring.insert(ring.end(), inner.rbegin(), inner.rend());
  for (OutlinePoint& point : ring) point.x() *= side;
  return MakeExtrusion(ring, begin_end_x_m.x(), begin_end_x_m.y());
}

/// Adds the two sliding walls of a side, with their ribs, edges, rollers and locks.
void AddSlidingWalls(double side, Mesh& walls) {
  constexpr double kGap_m = 0.02;
  constexpr double kEdge_m = 10.85;
  for (const double end : kBothSides) {
    const OutlinePoint extent_m =
        end > 0.0 ? OutlinePoint(kGap_m, kEdge_m) : OutlinePoint(-kEdge_m, -kGap_m);
    walls.Append(MakeBentSheet(side, extent_m, {-0.04, 0.0}));
    for (int i = 0; i <= 8; ++i) {
      const double x_m = end * (kGap_m + 0.04 + (kEdge_m - kGap_m - 0.08) * i / 8.0);
      const double half_m = i == 0 || i == 8 ? 0.04 : 0.025;
      const double out_m = i == 0 || i == 8 ? 0.025 : 0.014;
      walls.Append(MakeBentSheet(side, {x_m - half_m, x_m + half_m}, {-0.01, out_m}));
    }
    const double begin_m = std::min(end * kGap_m, end * kEdge_m);
    const double end_m = std::max(end * kGap_m, end * kEdge_m);
    walls.Append(MakeSideBlock(side, {begin_m, 1.40, 1.00}, {end_m, 1.445, 1.16}));
    walls.Append(MakeSideBlock(side, {begin_m, 1.41, 3.14}, {end_m, 1.44, 3.24}));
  }
}

void AddSlidingGear(double side, Mesh& frame) {
  frame.Append(MakeSideBlock(side, {-10.95, 1.30, 0.98}, {10.95, 1.40, 1.20}));
  frame.Append(MakeSideBlock(side, {-10.95, 1.38, 0.955}, {10.95, 1.45, 0.985}));  // Lower rail.
  for (const double x_m : {-9.9, -6.6, -3.6, -0.9, 0.9, 3.6, 6.6, 9.9}) {
    frame.Append(MakeSideBlock(side, {x_m - 0.14, 1.39, 0.985}, {x_m + 0.14, 1.45, 1.06}));
  }
  // Handle and lock bar of each wall beside the middle.
  for (const double x_m : {-0.35, 0.35}) {
    frame.Append(MakeBar({x_m, side * 1.44, 1.05}, {x_m, side * 1.44, 1.9}, 0.010));
    frame.Append(MakeSideBlock(side, {x_m - 0.09, 1.42, 1.42}, {x_m + 0.09, 1.448, 1.50}));
  }
  // Truss below the side sill.
  const std::vector<Vector3> truss = {{-6.4, side * 1.18, 0.96},
                                      {-3.0, side * 1.18, 0.56},
                                      {3.0, side * 1.18, 0.56},
                                      {6.4, side * 1.18, 0.96}};
  frame.Append(MakeTube(truss, 0.05, 6));
  for (const double x_m : {-3.0, 0.0, 3.0}) {
    frame.Append(MakeSideBlock(side, {x_m - 0.05, 1.14, 0.56}, {x_m + 0.05, 1.22, 1.0}));
  }
}

/// An end wall with its posts and corner columns, and the grab irons at its edges.
void AddEndWall(double end, Mesh& body) {
  std::vector<OutlinePoint> outline = MovedOut(WallOutline(), -0.04);
  outline.emplace_back(0.0, 4.20);
  for (std::size_t i = outline.size() - 1; i-- > 0;) {
    const OutlinePoint left = outline[i];
    outline.emplace_back(-left.x(), left.y());
  }
  const double inner_m = end * (kCoveredEnd_m - 0.06);
  const double outer_m = end * kCoveredEnd_m;
  body.Append(MakeExtrusion(outline, std::min(inner_m, outer_m), std::max(inner_m, outer_m)));
  for (const double y_m : {-1.30, -0.45, 0.45, 1.30}) {
    body.Append(MakeEndBlock(end, {kCoveredEnd_m, y_m - 0.06, 1.0},
                             {kCoveredEnd_m + 0.09, y_m + 0.06, 3.5}));
  }
  for (const double z_m : {1.15, 2.3, 3.4}) {
    body.Append(
        MakeEndBlock(end, {kCoveredEnd_m, -1.3, z_m}, {kCoveredEnd_m + 0.05, 1.3, z_m + 0.08}));
  }
  for (const double side : kBothSides) {
    body.Append(MakeBar({end * (kCoveredEnd_m + 0.12), side * 1.30, 1.3},
                        {end * (kCoveredEnd_m + 0.12), side * 1.30, 2.0}, 0.015));
  }
}

/// Adds the portals behind the gaps between the sliding walls and at their ends.
void AddPortals(double side, Mesh& body) {
  body.Append(MakeBentSheet(side, {-0.10, 0.10}, {-0.09, -0.045}));
  for (const double end : kBothSides) {
    const double begin_m = std::min(end * 10.75, end * (kCoveredEnd_m - 0.06));
    const double end_m = std::max(end * 10.75, end * (kCoveredEnd_m - 0.06));
    body.Append(MakeBentSheet(side, {begin_m, end_m}, {-0.09, -0.045}));
  }
}

/// The middle of the roof with the rail on which the walls hang, and its cross ribs.
Mesh MakeRoof() {
  const std::vector<OutlinePoint> outline = {{0.74, 4.06}, {0.74, 4.13},  {0.40, 4.23},
                                             {0.0, 4.265}, {-0.40, 4.23}, {-0.74, 4.13},
                                             {-0.74, 4.06}};
  Mesh roof = MakeExtrusion(outline, -kCoveredEnd_m, kCoveredEnd_m);
  for (int i = -5; i <= 5; ++i) {
    const std::vector<OutlinePoint> rib = {{0.70, 4.12}, {0.70, 4.15},   {0.38, 4.247},
                                           {0.0, 4.28},  {-0.38, 4.247}, {-0.70, 4.15},
                                           {-0.70, 4.12}};
    roof.Append(MakeExtrusion(rib, 2.0 * i - 0.03, 2.0 * i + 0.03));
  }
  return roof;
}

}  // namespace

RailVehicleModel MakeCoveredWagon(const RailSurfaces& surfaces) {
  Model body{.name = "covered_wagon", .parts = {}};
  Mesh walls = MakeRoof();
  Mesh frame;
  for (const double side : kBothSides) {
    AddSlidingWalls(side, walls);
    AddPortals(side, walls);
    AddSlidingGear(side, frame);
    AddEndWall(side, walls);
  }
  frame.Append(
      MakeBlock({-kCoveredEnd_m, -1.38, kFloorTop_m - 0.08}, {kCoveredEnd_m, 1.38, kFloorTop_m}));
  for (int i = -5; i <= 5; ++i) {
    frame.Append(MakeBlock({1.9 * i - 0.05, -1.34, 1.0}, {1.9 * i + 0.05, 1.34, 1.12}));
  }
  frame.Append(MakeCentreSill(11.0, kCoveredPivotDistance_m, kFloorTop_m - 0.08));
  frame.Append(MakeCornerSteps(10.7, 1.28, 1.0));
  frame.Append(MakeBrakeGear(kCoveredPivotDistance_m));
  MeshOf(surfaces.vehicles.sliding_wall, body) = std::move(walls);
  MeshOf(surfaces.wagon_frame, body) = std::move(frame);
  AddDrawAndBufferGear(kCoveredWagonMeasures.length_m, surfaces.wagon_frame, body);
  return {std::move(body), MakeWagonBogie(surfaces)};
}

}  // namespace railcast
