#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/car_body.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/train_bogie.h"
#include "core/rail/objects/vehicle_shapes.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using MetroPoint = Eigen::Vector2d;

constexpr double kMetroBack_m = -9.06;  ///< Outer face of the back wall.
constexpr double kMetroCab_m = 8.05;    ///< Where the cab begins.
constexpr double kMetroSill_m = 0.86;
constexpr double kMetroTop_m = kMetroCarMeasures.height_m;

const CarSection& MetroSection() {
  static const CarSection section = {
      .side = {{1.40, kMetroSill_m}, {1.45, 1.15}, {1.45, 2.00}, {1.385, 2.90}},
      .roof = {{1.385, 2.90}, {1.26, 3.16}, {0.98, 3.38}, {0.55, 3.50}, {0.0, kMetroTop_m}}};
  return section;
}

/// Three pairs of doors of 1.3 m and the windows between them.
std::vector<CarOpening> MetroOpenings() {
  std::vector<CarOpening> openings;
  for (const double middle_m : {-6.1, -0.3, 5.5}) {
    for (const double leaf : kBothSides) {
      const double leaf_m = middle_m + leaf * 0.34;
      openings.push_back({CarOpeningKind::kDoor, leaf_m - 0.31, leaf_m + 0.31, 0.98, 2.84});
    }
  }
  for (const double middle_m : {-8.1, -4.2, -2.2, 1.6, 3.6}) {
    const double half_m = middle_m < -8.0 ? 0.55 : 0.85;
    openings.push_back({CarOpeningKind::kWindow, middle_m - half_m, middle_m + half_m, 1.72, 2.66});
  }
  openings.push_back({CarOpeningKind::kWindow, 7.25, 7.85, 1.78, 2.62});  // Cab.
  return openings;
}

/// Cross-sections of the cab from where it begins to its front: left half, from the sill to the
/// top.
std::vector<VehicleSection> MetroCabSections() {
  const std::vector<std::pair<double, std::vector<MetroPoint>>> stations = {{kMetroCab_m,
                                                                             {{1.40, kMetroSill_m},
                                                                              {1.45, 1.15},
                                                                              {1.45, 2.0},
                                                                              {1.385, 2.90},
                                                                              {1.26, 3.16},
                                                                              {0.98, 3.38},
                                                                              {0.30, 3.54}}},
                                                                            {8.30,
                                                                             {{1.38, kMetroSill_m},
                                                                              {1.43, 1.15},
                                                                              {1.43, 1.9},
                                                                              {1.36, 2.80},
                                                                              {1.24, 3.05},
                                                                              {1.00, 3.28},
                                                                              {0.30, 3.43}}},
                                                                            {8.78,
                                                                             {{1.33, 0.80},
                                                                              {1.38, 1.05},
                                                                              {1.38, 1.35},
                                                                              {1.36, 1.50},
                                                                              {1.34, 1.58},
                                                                              {1.28, 1.64},
                                                                              {0.30, 1.68}}},
                                                                            {8.90,
                                                                             {{1.24, 0.82},
                                                                              {1.28, 0.98},
                                                                              {1.28, 1.15},
                                                                              {1.26, 1.30},
                                                                              {1.22, 1.38},
                                                                              {1.16, 1.44},
                                                                              {0.30, 1.48}}}};
  std::vector<VehicleSection> sections;
  for (const auto& [x_m, half] : stations) sections.push_back(MakeVehicleSection(x_m, half));
  return sections;
}

/// Adds the cab with its windscreen, side windows, headlamps and destination display.
void AddMetroCab(const RailSurfaces& surfaces, Model& car) {
  const std::vector<VehicleSection> sections = MetroCabSections();
  MeshOf(surfaces.vehicles.light_paint, car).Append(MakeLoft(sections));
  Mesh& glass = MeshOf(surfaces.vehicles.glass, car);
  const Vector3 forwards(1.0, 0.0, 0.2);
  for (std::size_t corner = 5; corner <= 7; ++corner) {  // Three panes side by side.
    FacePart part{0.0, 1.0, 0.22, 0.90};
    if (corner == 5) part = {0.06, 0.97, 0.22, 0.90};
    if (corner == 7) part = {0.03, 0.94, 0.22, 0.90};
    glass.Append(MakePane(FaceBetween(sections[1], sections[2], corner), part, forwards, 0.012));
  }
  const FacePart display{0.0, 1.0, 0.03, 0.16};
  glass.Append(MakePane(FaceBetween(sections[1], sections[2], 6), display, forwards, 0.012));
  const std::vector<MetroPoint> lamp = {{0.0, 0.10}, {0.05, 0.10}, {0.07, 0.07}};
  for (const double side : kBothSides) {
    for (const double y_m : {0.72, 0.98}) {
      glass.Append(MakeLathe(lamp, 10),
                   MakeTransform(Eigen::Matrix3d::Identity(), {8.87, side * y_m, 1.16}));
    }
  }
  Mesh& frame = MeshOf(surfaces.vehicles.frame, car);
  for (const double side : kBothSides) {
    frame.Append(MakeBar({8.955, side * 0.40, 1.58}, {8.955, side * 1.0, 1.58}, 0.012));
    frame.Append(MakeBar({8.70, side * 1.05, 1.66}, {8.52, side * 0.55, 2.35}, 0.012));  // Wiper.
    frame.Append(MakeSideBlock(side, {7.0, 1.40, 0.42}, {7.08, 1.43, kMetroSill_m + 0.1}));
    frame.Append(MakeSideBlock(side, {7.5, 1.40, 0.42}, {7.58, 1.43, kMetroSill_m + 0.1}));
    frame.Append(MakeSideBlock(side, {7.0, 1.25, 0.42}, {7.58, 1.43, 0.46}));
  }
  frame.Append(
      MakeBlock({8.40, -1.15, 0.30}, {8.60, 1.15, 0.80}));  // Guard in front of the wheels.
}

/// Adds the automatic coupling in front, whose face is the end of the car, and the bar behind.
void AddMetroCouplings(const RailSurfaces& surfaces, Model& car) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, car);
  const double face_m = kMetroCarMeasures.length_m / 2.0;
  constexpr double kCoupling_m = 0.60;  ///< Height of its axis above top of rail.
  frame.Append(MakeBar({7.6, 0, kCoupling_m}, {face_m - 0.30, 0, kCoupling_m}, 0.09));
  frame.Append(
      MakeBlock({face_m - 0.32, -0.20, kCoupling_m - 0.19}, {face_m, 0.20, kCoupling_m + 0.16}));
  frame.Append(MakeBlock({face_m - 0.28, -0.30, kCoupling_m - 0.32},
                         {face_m - 0.04, 0.30, kCoupling_m - 0.19}));
  frame.Append(MakeBar({-7.6, 0, kCoupling_m}, {-face_m, 0, kCoupling_m}, 0.09));
  for (const double y_m : {-0.35, 0.35}) {
    const std::vector<Vector3> cable = {
        {-9.0, y_m, 0.85}, {-9.12, y_m, 0.70}, {-9.2, y_m, 0.66}, {-face_m, y_m, 0.66}};
    frame.Append(MakeTube(cable, 0.025, 4));
  }
}

/// Adds floor, equipment boxes and bolsters below the car, and roof ventilators.
void AddMetroUnderfloor(const RailSurfaces& surfaces, Model& car) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, car);
  frame.Append(MakeBlock({-9.0, -1.36, 0.86}, {8.3, 1.36, 0.99}));
  for (const double side : kBothSides) {
    for (const auto& [begin_m, end_m, bottom_m] :
         {std::array{-3.9, -2.3, 0.36}, std::array{-2.1, -0.3, 0.40}, std::array{-0.1, 2.0, 0.34},
          std::array{2.2, 3.9, 0.42}}) {
      frame.Append(MakeSideBlock(side, {begin_m, 0.25, bottom_m}, {end_m, 1.30, 0.88}));
      frame.Append(
          MakeSideBlock(side, {begin_m + 0.1, 1.30, bottom_m + 0.06}, {end_m - 0.1, 1.32, 0.82}));
    }
  }
  for (const double pivot_m : {-6.0, 6.0}) {
    frame.Append(MakeBlock({pivot_m - 0.3, -1.2, 0.82}, {pivot_m + 0.3, 1.2, 0.88}));
  }
  Mesh& roof = MeshOf(surfaces.vehicles.roof, car);
  for (int i = -3; i <= 3; ++i) {
    for (const double side : kBothSides) {
      roof.Append(MakeSideBlock(side, {2.2 * i - 0.6, 0.62, 3.40}, {2.2 * i + 0.6, 0.90, 3.50}));
    }
  }
}

}  // namespace

RailVehicleModel MakeMetroCar(const RailSurfaces& surfaces) {
  const VehicleSurfaces& of = surfaces.vehicles;
  Model car = MakeVehicleOf("metro_car", {of.light_paint, of.paint, of.roof, of.frame, of.glass});
  AddCarBody(MetroSection(), {kMetroBack_m + 0.08, kMetroCab_m}, MetroOpenings(),
             {.wall = of.light_paint, .door = of.paint, .roof = of.roof, .glass = of.glass}, car);
  MeshOf(of.light_paint, car).Append(MakeCarEnd(MetroSection(), kMetroBack_m, kMetroBack_m + 0.08));
  MeshOf(of.glass, car)
      .Append(MakeBlock({kMetroBack_m - 0.012, -0.95, 1.75}, {kMetroBack_m + 0.02, -0.10, 2.60}));
  MeshOf(of.glass, car)
      .Append(MakeBlock({kMetroBack_m - 0.012, 0.10, 1.75}, {kMetroBack_m + 0.02, 0.95, 2.60}));
  AddMetroCab(surfaces, car);
  AddMetroCouplings(surfaces, car);
  AddMetroUnderfloor(surfaces, car);
  return {std::move(car), MakeTrainBogie({.axle_base_m = 2.1,
                                          .wheel_radius_m = 0.45,
                                          .top_m = 0.82,
                                          .has_motors = true,
                                          .has_shoes = true},
                                         surfaces)};
}

}  // namespace railcast
