#include <algorithm>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/road_vehicle_parts.h"
#include "core/rail/objects/road_vehicles.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

// Directive 96/53/EC: 16.50 m in all, and 12.00 m from the king pin to the trailer's rear.
constexpr double kLorryFront_m = 8.25;
constexpr double kLorryRear_m = -8.25;
constexpr double kKingPin_m = kLorryRear_m + 12.0;
constexpr double kTrailerFront_m = kKingPin_m + 1.6;  // 13.6 m long.
constexpr double kLorryHalfWidth_m = 1.275;
constexpr double kLorryHeight_m = 4.0;
constexpr double kTrailerFloor_m = 1.18;
constexpr double kTapeWidth_m = 0.055;  // UN regulation 104: 50 to 60 mm.

/// The outline of the cab at a height.
struct CabOutline {
  double z_m{};
  double front_m{};  ///< x of its foremost point.
  double rear_m{};
  double half_width_m{};
};

/// The left half of the cab's outline, from the middle of its rear to that of its front: rear
/// corner, door pillars, front pillar, front corner.
Rib CabRib(const CabOutline& cab) {
  const std::vector<Eigen::Vector2d> half = {
      {cab.rear_m, 0.0},
      {cab.rear_m, cab.half_width_m - 0.06},
      {cab.rear_m + 0.06, cab.half_width_m},
      {std::max(cab.front_m - 1.25, cab.rear_m + 0.10), cab.half_width_m},
      {std::max(cab.front_m - 0.42, cab.rear_m + 0.15), cab.half_width_m - 0.01},
      {cab.front_m - 0.24, cab.half_width_m - 0.06},
      {cab.front_m - 0.07, cab.half_width_m - 0.28},
      {cab.front_m - 0.01, 0.45 * cab.half_width_m},
      {cab.front_m, 0.0}};
  Rib rib;
  for (const auto& point : half) rib.emplace_back(point.x(), point.y(), cab.z_m);
  for (std::size_t i = half.size() - 2; i > 0; --i) {
    rib.emplace_back(half[i].x(), -half[i].y(), cab.z_m);
  }
  return rib;
}
constexpr std::size_t kCabHalfPoints = 9;

void AddLorryCab(const RoadVehicleSurfaces& surfaces, Model& lorry) {
  const double front_m = kLorryFront_m - 0.005;  // The number plate is in front of it.
  const std::vector<CabOutline> outlines = {{0.32, front_m - 0.02, 7.43, 1.15},
                                            {0.38, front_m, 7.42, 1.245},
                                            {0.92, front_m, 7.42, 1.25},
                                            {1.06, front_m - 0.01, 7.40, 1.25},
                                            {1.08, front_m - 0.01, 5.95, 1.25},
                                            {1.50, front_m - 0.02, 5.95, 1.25},
                                            {1.95, front_m - 0.05, 5.95, 1.25},
                                            {2.10, front_m - 0.06, 5.95, 1.25},
                                            {2.85, front_m - 0.17, 5.95, 1.235},
                                            {2.95, front_m - 0.20, 5.95, 1.23},
                                            {3.20, front_m - 0.34, 5.95, 1.215},
                                            {3.60, front_m - 0.72, 5.95, 1.18},
                                            {3.80, front_m - 1.00, 5.95, 1.13},
                                            {3.92, front_m - 1.30, 5.97, 1.05},
                                            {kLorryHeight_m - 0.02, front_m - 1.50, 6.05, 0.90}};
  std::vector<Rib> ribs;
  for (const CabOutline& outline : outlines) ribs.push_back(CabRib(outline));
  const auto wall = [&](std::size_t piece, std::size_t side) {
    const std::size_t panel = HalfPanel(side, kCabHalfPoints);
    const double z_m = 0.5 * (outlines[piece].z_m + outlines[piece + 1].z_m);
    if (panel >= 5 && z_m > 1.95 && z_m < 2.95) return surfaces.window;
    if (panel == 3 && z_m > 2.10 && z_m < 2.85) return surfaces.window;
    if (panel == 6 && z_m > 0.38 && z_m < 0.92) return surfaces.window;  // Head lamps.
    if (z_m < 0.38 || (panel >= 7 && z_m > 0.92 && z_m < 1.50)) return surfaces.trim;
    return surfaces.paint;
  };
  AddLoftedBody(ribs, {wall, surfaces.trim, surfaces.paint}, lorry);
  AddNumberPlate(1.0, {kLorryFront_m, 0.0, 0.60}, surfaces, lorry);
}

void AddTractorUnit(const RoadVehicleSurfaces& surfaces, Model& lorry) {
  constexpr double kFrontAxle_m = kLorryFront_m - 1.42;
  constexpr double kDriveAxle_m = kFrontAxle_m - 3.70;
  const WheelMeasures wheel{
      .radius_m = 0.507, .width_m = 0.312, .rim_radius_m = 0.29, .num_sides = 16};
  Mesh frame;
  for (const double side : kBothSides) {
    AddRoadWheel(wheel, {kFrontAxle_m, side * 1.07, wheel.radius_m}, surfaces, lorry);
    AddRoadWheel(wheel, {kDriveAxle_m, side * 1.07, wheel.radius_m}, surfaces, lorry);
    AddRoadWheel({.radius_m = 0.507, .width_m = 0.312, .rim_radius_m = 0.29, .num_sides = 12},
                 {kDriveAxle_m, side * 0.72, wheel.radius_m}, surfaces, lorry);
    frame.Append(MakeSideBlock(side, {2.3, 0.36, 0.80}, {6.9, 0.44, 1.05}));
    // Tank and silencer, mudguards, mirrors.
    frame.Append(MakeBar({4.0, side * 0.92, 0.68}, {5.6, side * 0.92, 0.68}, 0.32));
    MeshOf(surfaces.trim, lorry)
        .Append(MakeSideBlock(side, {kDriveAxle_m - 0.56, 0.60, 1.04},
                              {kDriveAxle_m + 0.56, 1.24, 1.08}));
    MeshOf(surfaces.trim, lorry)
        .Append(MakeSideBlock(side, {6.22, 0.80, 0.95}, {7.42, 1.10, 1.05}));
  }
  frame.Append(MakeBlock({3.3, -0.45, 1.05}, {4.2, 0.45, kTrailerFloor_m}));  // Fifth wheel.
  MeshOf(surfaces.trim, lorry).Append(MakeBlock({5.2, -0.75, 0.45}, {7.5, 0.75, 1.0}));  // Engine.
  MeshOf(surfaces.metal, lorry).Append(frame);
}

/// Contour tape along the edges of the trailer's sides and of its rear.
void AddContourTape(Mesh& tape) {
  constexpr double kProud_m = 0.003;
  constexpr double kOut_m = kLorryHalfWidth_m;
  for (const double side : kBothSides) {
    const auto add = [&](double x0_m, double z0_m, double x1_m, double z1_m) {
      tape.Append(MakeSideBlock(side, {x0_m, kOut_m - 0.02, z0_m}, {x1_m, kOut_m, z1_m}));
    };
    add(kLorryRear_m + 0.15, 1.28, kTrailerFront_m - 0.15, 1.28 + kTapeWidth_m);
    for (const double x_m : {kLorryRear_m + 0.15, kTrailerFront_m - 0.40}) {
      add(x_m, 3.80, x_m + 0.25, 3.80 + kTapeWidth_m);
    }
  }
  const double rear_m = kLorryRear_m - kProud_m + 0.005;
  for (const double z_m : {1.28, 3.86}) {
    tape.Append(MakeBlock({rear_m, -1.15, z_m}, {rear_m + 0.01, 1.15, z_m + kTapeWidth_m}));
  }
  for (const double side : kBothSides) {
    tape.Append(MakeSideBlock(side, {rear_m, 1.10, 1.28 + kTapeWidth_m},
                              {rear_m + 0.01, 1.10 + kTapeWidth_m, 3.86}));
  }
}

/// A loading body with rounded vertical edges and a frame of posts at its rear.
void AddTrailerBody(const RoadVehicleSurfaces& surfaces, Model& lorry) {
  const double half_m = kLorryHalfWidth_m - 0.005;
  const std::vector<Eigen::Vector2d> outline = {
      {0.0, kTrailerFloor_m}, {half_m - 0.02, kTrailerFloor_m}, {half_m, 1.22},
      {half_m, 3.94},         {half_m - 0.015, 3.98},           {half_m - 0.06, kLorryHeight_m},
      {0.0, kLorryHeight_m}};
  std::vector<Rib> ribs;
  for (const double x_m : {kLorryRear_m + 0.005, kTrailerFront_m - 0.06, kTrailerFront_m}) {
    std::vector<Eigen::Vector2d> half = outline;
    if (x_m == kTrailerFront_m) {
      for (Eigen::Vector2d& point : half) point.x() *= 0.95;
    }
    ribs.push_back(MirroredRib(x_m, half));
  }
  const auto wall = [&](std::size_t, std::size_t side) {
    return HalfPanel(side, outline.size()) == 0 ? surfaces.metal : surfaces.panel;
  };
  AddLoftedBody(ribs, {wall, surfaces.panel, surfaces.panel}, lorry);
  for (const double side : kBothSides) {  // Door bars and hinges.
    for (const double y_m : {0.35, 0.75}) {
      MeshOf(surfaces.metal, lorry)
          .Append(MakeBar({kLorryRear_m + 0.012, side * y_m, 1.25},
                          {kLorryRear_m + 0.012, side * y_m, 3.9}, 0.012));
    }
  }
  AddContourTape(MeshOf(surfaces.reflector, lorry));
}

void AddTrailerGear(const RoadVehicleSurfaces& surfaces, Model& lorry) {
  Mesh frame;
  constexpr double kMiddleAxle_m = kKingPin_m - 7.75;
  for (const double side : kBothSides) {
    for (const double ahead_m : {-1.31, 0.0, 1.31}) {
      const WheelMeasures wheel{
          .radius_m = 0.536, .width_m = 0.385, .rim_radius_m = 0.29, .num_sides = 16};
      AddRoadWheel(wheel, {kMiddleAxle_m + ahead_m, side * 1.05, wheel.radius_m}, surfaces, lorry);
    }
    frame.Append(MakeSideBlock(side, {kLorryRear_m + 0.1, 0.55, 0.92},
                               {kTrailerFront_m - 0.3, 0.67, kTrailerFloor_m}));
    frame.Append(MakeSideBlock(side, {1.45, 0.80, 0.10}, {1.65, 0.95, kTrailerFloor_m}));  // Legs.
    frame.Append(MakeSideBlock(side, {1.35, 0.72, 0.04}, {1.75, 1.02, 0.10}));
    for (const double z_m : {0.50, 0.85}) {  // Side guards (UN regulation 73).
      frame.Append(MakeSideBlock(side, {-1.7, 1.20, z_m}, {1.2, 1.24, z_m + 0.12}));
    }
    for (const double x_m : {-1.5, -0.2, 1.0}) {
      frame.Append(MakeSideBlock(side, {x_m, 1.17, 0.50}, {x_m + 0.08, 1.20, kTrailerFloor_m}));
    }
    MeshOf(surfaces.window, lorry)
        .Append(MakeSideBlock(side, {kLorryRear_m + 0.03, 0.72, 0.92},
                              {kLorryRear_m + 0.12, 1.20, 1.08}));
    MeshOf(surfaces.trim, lorry)
        .Append(MakeSideBlock(side, {-6.35, 0.60, 0.35}, {-6.32, 1.25, 1.0}));  // Mud flaps.
  }
  for (const double ahead_m : {-1.31, 0.0, 1.31}) {
    frame.Append(MakeBar({kMiddleAxle_m + ahead_m, -0.9, 0.536},
                         {kMiddleAxle_m + ahead_m, 0.9, 0.536}, 0.07));
  }
  // Rear underrun protection (UN regulation 58).
  frame.Append(MakeBlock({kLorryRear_m + 0.06, -1.20, 0.45}, {kLorryRear_m + 0.16, 1.20, 0.60}));
  for (const double y_m : {-0.6, 0.6}) {
    frame.Append(MakeBlock({kLorryRear_m + 0.07, y_m - 0.05, 0.55},
                           {kLorryRear_m + 0.15, y_m + 0.05, kTrailerFloor_m}));
  }
  AddNumberPlate(-1.0, {kLorryRear_m + 0.02, 0.0, 1.02}, surfaces, lorry);
  MeshOf(surfaces.trim, lorry)
      .Append(MakeBlock({kLorryRear_m + 0.02, -1.24, 0.90}, {kLorryRear_m + 0.06, 1.24, 1.12}));
  MeshOf(surfaces.metal, lorry).Append(frame);
}

}  // namespace

Model MakeLorry(const RoadVehicleSurfaces& surfaces) {
  Model lorry{.name = "lorry", .parts = {}};
  AddLorryCab(surfaces, lorry);
  AddTractorUnit(surfaces, lorry);
  AddTrailerBody(surfaces, lorry);
  AddTrailerGear(surfaces, lorry);
  return lorry;
}

}  // namespace railcast
