#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/road_vehicle_parts.h"
#include "core/rail/objects/road_vehicles.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

constexpr double kBusHalfLength_m = 6.0675;
constexpr double kBusFrontAxle_m = kBusHalfLength_m - 2.805;  // Front overhang (EvoBus).
constexpr double kBusRearAxle_m = kBusFrontAxle_m - 5.900;
constexpr double kBusTyreRadius_m = 0.478;  // 275/70 R 22.5.
constexpr double kBusArchRadius_m = 0.56;
constexpr double kBusFace_m = 6.02;  // Ends of the lofted body; the ends' panes are in front of it.
constexpr double kBusBelt_m = 1.30;
constexpr double kBusWindowTop_m = 2.45;

const std::vector<Point2> kBusWidth_m = {{-kBusFace_m, 1.15}, {-5.9, 1.24}, {-5.7, 1.275},
                                         {5.5, 1.275},        {5.75, 1.25}, {5.92, 1.18},
                                         {kBusFace_m, 1.08}};
/// Doors on the right side, from x to x.
constexpr std::array<std::array<double, 2>, 3> kBusDoors_m = {
    {{4.10, 5.35}, {-0.20, 1.10}, {-5.30, -4.10}}};

constexpr std::size_t kBusHalfPoints = 8;

std::vector<Point2> HalfBusSection(double x_m) {
  const double width_m = SmoothValueAt(kBusWidth_m, x_m);
  const double end_m = std::max(0.0, std::abs(x_m) - 4.5);
  const double sill_m = std::max(
      {0.30 + 0.05 * end_m, ArchHeight_m(x_m, kBusFrontAxle_m, kBusTyreRadius_m, kBusArchRadius_m),
       ArchHeight_m(x_m, kBusRearAxle_m, kBusTyreRadius_m, kBusArchRadius_m)});
  return {{0.0, sill_m},
          {width_m - 0.04, sill_m},
          {width_m, sill_m + 0.05},
          {width_m, kBusBelt_m},
          {width_m - 0.015, kBusWindowTop_m},
          {width_m - 0.06, 2.78},
          {width_m - 0.22, 2.90},
          {0.0, 2.94}};
}

/// Pillars of 0.1 m stand between windows of 1.35 m.
constexpr double kBusWindowStep_m = 1.45;
constexpr double kBusFirstPillar_m = -5.60;

std::vector<double> BusStations_m() {
  std::vector<double> stations_m = {-kBusFace_m, -5.9, 5.75, 5.92, kBusFace_m};
  for (int i = 0; i < 8; ++i) {
    const double pillar_m = kBusFirstPillar_m + kBusWindowStep_m * i;
    stations_m.insert(stations_m.end(), {pillar_m - 0.05, pillar_m + 0.05});
  }
  for (const auto& [begin_m, end_m] : kBusDoors_m) {
    stations_m.insert(stations_m.end(), {begin_m, 0.5 * (begin_m + end_m) - 0.03,
                                         0.5 * (begin_m + end_m) + 0.03, end_m});
  }
  for (const double axle_m : {kBusRearAxle_m, kBusFrontAxle_m}) {
    for (const double share : {-1.0, -0.97, -0.87, -0.7, -0.4, 0.0, 0.4, 0.7, 0.87, 0.97, 1.0}) {
      stations_m.push_back(axle_m + share * (kBusArchRadius_m + 0.002));
    }
  }
  std::sort(stations_m.begin(), stations_m.end());
  return stations_m;
}

bool IsBusDoor(double x_m) {
  return std::any_of(kBusDoors_m.begin(), kBusDoors_m.end(), [&](const auto& door_m) {
    const double from_middle_m = std::abs(x_m - 0.5 * (door_m[0] + door_m[1]));
    return from_middle_m > 0.03 && from_middle_m < 0.5 * (door_m[1] - door_m[0]);
  });
}

bool IsBusPillar(double x_m) {
  const double from_m = (x_m - kBusFirstPillar_m) / kBusWindowStep_m;
  return std::abs(from_m - std::round(from_m)) * kBusWindowStep_m < 0.05 || std::abs(x_m) > 5.75;
}

void AddBusBody(const RoadVehicleSurfaces& surfaces, Model& bus) {
  const std::vector<double> stations_m = BusStations_m();
  std::vector<Rib> ribs;
  for (const double x_m : stations_m) ribs.push_back(MirroredRib(x_m, HalfBusSection(x_m)));
  const auto wall = [&](std::size_t piece, std::size_t side) {
    const double x_m = 0.5 * (stations_m[piece] + stations_m[piece + 1]);
    const std::size_t panel = HalfPanel(side, kBusHalfPoints);
    const bool is_right = side != panel;
    if (panel <= 1) return surfaces.trim;
    if (is_right && (panel == 2 || panel == 3) && IsBusDoor(x_m)) return surfaces.window;
    if (panel == 3 && !IsBusPillar(x_m)) return surfaces.window;
    return surfaces.paint;
  };
  AddLoftedBody(ribs, {wall, surfaces.paint, surfaces.paint}, bus);
  MeshOf(surfaces.trim, bus).Append(MakeBlock({-5.6, -0.85, 0.28}, {5.6, 0.85, 1.05}));
}

/// A pane or a flap of an end, rounded at its corners, from the body's face to `x_m`.
Mesh MakeEndPane(double end, double x_m, double half_width_m, const Point2& z_m) {
  const double corner_m = 0.12;
  const std::vector<Point2> outline = {
      {-half_width_m, z_m.x() + corner_m}, {-half_width_m + corner_m, z_m.x()},
      {half_width_m - corner_m, z_m.x()},  {half_width_m, z_m.x() + corner_m},
      {half_width_m, z_m.y() - corner_m},  {half_width_m - corner_m, z_m.y()},
      {-half_width_m + corner_m, z_m.y()}, {-half_width_m, z_m.y() - corner_m}};
  return end > 0.0 ? MakeExtrusion(outline, kBusFace_m - 0.01, x_m)
                   : MakeExtrusion(outline, -x_m, -kBusFace_m + 0.01);
}

void AddBusEnds(const RoadVehicleSurfaces& surfaces, Model& bus) {
  Mesh windows;
  windows.Append(MakeEndPane(1.0, kBusFace_m + 0.03, 1.06, {1.05, 2.36}));
  windows.Append(MakeEndPane(1.0, kBusFace_m + 0.02, 0.95, {2.42, 2.80}));  // Destination.
  windows.Append(MakeEndPane(-1.0, kBusFace_m + 0.02, 1.00, {1.75, 2.55}));
  MeshOf(surfaces.trim, bus).Append(MakeEndPane(-1.0, kBusFace_m + 0.02, 0.80, {0.95, 1.60}));
  for (const double end : kBothSides) {
    MeshOf(surfaces.trim, bus)
        .Append(MakeEndBlock(end, {5.85, -1.10, 0.42}, {kBusHalfLength_m - 0.005, 1.10, 0.66}));
    AddNumberPlate(end, {end * kBusHalfLength_m, 0.0, 0.54}, surfaces, bus);
    for (const double side : kBothSides) {
      MeshOf(surfaces.window, bus)
          .Append(MakeEndBlock(end, {kBusFace_m - 0.05, side * 0.86 - 0.14, 0.72},
                               {kBusFace_m + 0.015, side * 0.86 + 0.14, 0.90}));
    }
  }
  for (const double side : kBothSides) {
    MeshOf(surfaces.reflector, bus)
        .Append(MakeBlock({-kBusHalfLength_m, side * 0.95 - 0.06, 0.50},
                          {-kBusHalfLength_m + 0.01, side * 0.95 + 0.06, 0.55}));
    // Mirrors on arms, 2.95 m over both.
    MeshOf(surfaces.trim, bus)
        .Append(MakeBar({5.80, side * 1.15, 2.62}, {5.95, side * 1.38, 2.45}, 0.025));
    MeshOf(surfaces.trim, bus)
        .Append(MakeSideBlock(side, {5.88, 1.245, 2.00}, {5.98, 1.475, 2.46}));
  }
  MeshOf(surfaces.window, bus).Append(windows);
}

}  // namespace

Model MakeBus(const RoadVehicleSurfaces& surfaces) {
  Model bus{.name = "bus", .parts = {}};
  AddBusBody(surfaces, bus);
  AddBusEnds(surfaces, bus);
  for (const double side : kBothSides) {
    const WheelMeasures wheel{
        .radius_m = kBusTyreRadius_m, .width_m = 0.276, .rim_radius_m = 0.29, .num_sides = 20};
    AddRoadWheel(wheel, {kBusFrontAxle_m, side * 1.11, kBusTyreRadius_m}, surfaces, bus);
    AddRoadWheel(wheel, {kBusRearAxle_m, side * 1.11, kBusTyreRadius_m}, surfaces, bus);
  }
  // Air conditioning and ventilators on the roof.
  Mesh roof;
  roof.Append(MakeBlock({1.6, -0.85, 2.86}, {4.2, 0.85, 3.10}));
  roof.Append(MakeBlock({1.8, -0.65, 3.05}, {4.0, 0.65, 3.12}));
  roof.Append(MakeBlock({-5.2, -0.60, 2.86}, {-3.0, 0.60, 3.06}));
  MeshOf(surfaces.paint, bus).Append(roof);
  return bus;
}

}  // namespace railcast
