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

using Point2 = Eigen::Vector2d;
using CarCurve = std::vector<Point2>;  ///< (x, value) from the rear to the front.

constexpr double kCarHalfLength_m = 2.142;
constexpr double kCarFrontAxle_m = 1.272;
constexpr double kCarRearAxle_m = kCarFrontAxle_m - 2.636;
constexpr double kCarTyreRadius_m = 0.316;  // 205/55 R 16.
constexpr double kCarArchRadius_m = 0.36;
constexpr double kCarPlate_m = 0.005;  // Number plates are the foremost and the rearmost parts.
constexpr double kBodyEnd_m = kCarHalfLength_m - kCarPlate_m;

// Half widths at the widest, at the belt line below the windows, and at the roof's edge.
const CarCurve kCarWidth_m = {{-kBodyEnd_m, 0.66}, {-2.09, 0.77}, {-1.95, 0.835}, {-1.7, 0.878},
                              {-1.35, 0.8945},     {-0.7, 0.885}, {0.6, 0.885},   {1.25, 0.8945},
                              {1.65, 0.872},       {1.90, 0.815}, {2.04, 0.72},   {2.10, 0.62},
                              {kBodyEnd_m, 0.50}};
const CarCurve kCarBeltWidth_m = {
    {-kBodyEnd_m, 0.62}, {-2.05, 0.74}, {-1.8, 0.80}, {-1.2, 0.84}, {0.0, 0.855},      {0.9, 0.853},
    {1.3, 0.85},         {1.75, 0.79},  {2.0, 0.68},  {2.10, 0.56}, {kBodyEnd_m, 0.46}};
const CarCurve kCarEdgeWidth_m = {{-kBodyEnd_m, 0.58}, {-2.0, 0.68}, {-1.78, 0.60}, {-1.2, 0.595},
                                  {0.0, 0.60},         {0.25, 0.61}, {0.85, 0.75},  {1.05, 0.79},
                                  {1.3, 0.78},         {1.75, 0.71}, {2.0, 0.60},   {2.10, 0.50},
                                  {kBodyEnd_m, 0.42}};
// Heights of the sill, the belt line, the roof's edge, and the middle of hood and roof.
const CarCurve kCarSill_m = {{-kBodyEnd_m, 0.40}, {-2.05, 0.27}, {-1.9, 0.21},      {1.8, 0.18},
                             {2.0, 0.19},         {2.09, 0.22},  {kBodyEnd_m, 0.27}};
const CarCurve kCarBelt_m = {{-kBodyEnd_m, 0.72}, {-2.11, 0.86}, {-2.04, 0.97},     {-1.5, 0.975},
                             {0.0, 0.935},        {0.95, 0.905}, {1.4, 0.865},      {1.8, 0.785},
                             {2.0, 0.70},         {2.09, 0.63},  {kBodyEnd_m, 0.55}};
const CarCurve kCarEdge_m = {{-kBodyEnd_m, 0.74}, {-2.11, 0.88}, {-2.04, 0.99}, {-1.80, 1.27},
                             {-1.6, 1.33},        {-1.2, 1.365}, {-0.5, 1.385}, {0.0, 1.365},
                             {0.25, 1.32},        {0.86, 0.955}, {1.05, 0.925}, {1.4, 0.885},
                             {1.8, 0.80},         {2.0, 0.71},   {2.09, 0.64},  {kBodyEnd_m, 0.56}};
const CarCurve kCarTop_m = {{-kBodyEnd_m, 0.75}, {-2.11, 0.90}, {-2.05, 1.03},  {-1.80, 1.345},
                            {-1.75, 1.365},      {-1.2, 1.43},  {-0.45, 1.456}, {0.0, 1.435},
                            {0.28, 1.395},       {1.05, 0.985}, {1.15, 0.965},  {1.5, 0.915},
                            {1.85, 0.83},        {2.03, 0.735}, {2.10, 0.65},   {kBodyEnd_m, 0.57}};

constexpr std::size_t kCarHalfPoints = 10;

/// Half of the cross-section at `x_m`, from the middle of the underbody to that of the roof.
std::vector<Point2> HalfCarSection(double x_m) {
  const double width_m = SmoothValueAt(kCarWidth_m, x_m);
  const double edge_width_m = SmoothValueAt(kCarEdgeWidth_m, x_m);
  const double sill_m =
      std::max({SmoothValueAt(kCarSill_m, x_m),
                ArchHeight_m(x_m, kCarFrontAxle_m, kCarTyreRadius_m, kCarArchRadius_m),
                ArchHeight_m(x_m, kCarRearAxle_m, kCarTyreRadius_m, kCarArchRadius_m)});
  const double belt_m = SmoothValueAt(kCarBelt_m, x_m);
  const double side_m = belt_m - sill_m;
  const double edge_m = SmoothValueAt(kCarEdge_m, x_m);
  const double crown_m = SmoothValueAt(kCarTop_m, x_m) - edge_m;
  return {{0.0, sill_m},
          {0.92 * width_m, sill_m},
          {0.98 * width_m, sill_m + 0.12 * side_m},
          {width_m, sill_m + 0.50 * side_m},
          {0.985 * width_m, sill_m + 0.80 * side_m},
          {SmoothValueAt(kCarBeltWidth_m, x_m), belt_m},
          {edge_width_m, edge_m},
          {0.9 * edge_width_m, edge_m + 0.45 * crown_m},
          {0.45 * edge_width_m, edge_m + 0.87 * crown_m},
          {0.0, edge_m + crown_m}};
}

std::vector<double> CarStations_m() {
  // Where panes, pillars, lamps and wheel arches begin and end.
  std::vector<double> stations_m = {-kBodyEnd_m, -2.11, -2.05, -1.80, -1.62, -0.38, -0.29,     0.28,
                                    0.75,        0.86,  1.05,  1.80,  2.06,  2.10,  kBodyEnd_m};
  for (const double axle_m : {kCarRearAxle_m, kCarFrontAxle_m}) {
    for (const double share : {-1.0, -0.98, -0.9, -0.7, -0.4, 0.0, 0.4, 0.7, 0.9, 0.98, 1.0}) {
      stations_m.push_back(axle_m + share * (kCarArchRadius_m + 0.002));
    }
  }
  for (double x_m = -2.0; x_m < 2.1; x_m += 0.1) {
    const auto is_near = [&](double station_m) { return std::abs(station_m - x_m) < 0.05; };
    if (std::none_of(stations_m.begin(), stations_m.end(), is_near)) stations_m.push_back(x_m);
  }
  std::sort(stations_m.begin(), stations_m.end());
  return stations_m;
}

SurfaceClass CarPanel(double x_m, std::size_t panel, const RoadVehicleSurfaces& surfaces) {
  const auto is_within = [&](double begin_m, double end_m) { return x_m > begin_m && x_m < end_m; };
  if (panel <= 1) return surfaces.trim;
  if (panel <= 3) return is_within(2.06, 2.2) ? surfaces.trim : surfaces.paint;
  if (panel == 4 && (is_within(1.80, 2.06) || is_within(-2.11, -1.9))) return surfaces.window;
  if (panel == 5 && (is_within(-1.62, -0.38) || is_within(-0.29, 0.75))) return surfaces.window;
  if (panel >= 7 && (is_within(0.28, 1.05) || is_within(-2.05, -1.80))) return surfaces.window;
  return surfaces.paint;
}

void AddCarBody(const RoadVehicleSurfaces& surfaces, Model& car) {
  const std::vector<double> stations_m = CarStations_m();
  std::vector<Rib> ribs;
  for (const double x_m : stations_m) ribs.push_back(MirroredRib(x_m, HalfCarSection(x_m)));
  const auto wall = [&](std::size_t piece, std::size_t side) {
    const double middle_m = 0.5 * (stations_m[piece] + stations_m[piece + 1]);
    return CarPanel(middle_m, HalfPanel(side, kCarHalfPoints), surfaces);
  };
  AddLoftedBody(ribs, {wall, surfaces.paint, surfaces.trim}, car);
  // What is seen through the wheel arches.
  MeshOf(surfaces.trim, car).Append(MakeBlock({-1.85, -0.62, 0.17}, {1.85, 0.62, 0.68}));
}

}  // namespace

Model MakeCar(const RoadVehicleSurfaces& surfaces) {
  Model car{.name = "car", .parts = {}};
  AddCarBody(surfaces, car);
  for (const double side : kBothSides) {
    for (const double axle_m : {kCarRearAxle_m, kCarFrontAxle_m}) {
      AddRoadWheel({.radius_m = kCarTyreRadius_m, .width_m = 0.205, .rim_radius_m = 0.21},
                   {axle_m, side * 0.78, kCarTyreRadius_m}, surfaces, car);
    }
    // Mirrors, which reach to half of 2.073 m.
    MeshOf(surfaces.paint, car)
        .Append(MakeEllipsoid({0.70, side * 0.9365, 0.985}, {0.09, 0.10, 0.08}, 12));
    MeshOf(surfaces.trim, car)
        .Append(MakeBar({0.72, side * 0.83, 0.91}, {0.70, side * 0.92, 0.95}, 0.022));
    MeshOf(surfaces.reflector, car)
        .Append(MakeEndBlock(-1.0, {2.07, side * 0.60 - 0.06, 0.42},
                             {kBodyEnd_m - 0.001, side * 0.60 + 0.06, 0.46}));
  }
  AddNumberPlate(1.0, {kCarHalfLength_m, 0.0, 0.42}, surfaces, car);
  AddNumberPlate(-1.0, {-kCarHalfLength_m, 0.0, 0.60}, surfaces, car);
  return car;
}

}  // namespace railcast
