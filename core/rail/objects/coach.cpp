#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/car_body.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/train_bogie.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kCoachBodyEnd_m = 13.05;  ///< The body is 26.1 m long.
constexpr double kCoachSill_m = 1.02;
constexpr double kDoorMiddle_m = 12.30;

const CarSection& CoachSection() {
  static const CarSection section = {
      .side = {{1.375, kCoachSill_m}, {1.4125, 1.70}, {1.4125, 2.45}, {1.375, 3.05}, {1.31, 3.36}},
      .roof = {{1.31, 3.36}, {1.16, 3.66}, {0.88, 3.86}, {0.46, 3.97}, {0.0, 4.01}}};
  return section;
}

std::vector<CarOpening> CoachOpenings() {
  std::vector<CarOpening> openings;
  for (const double end : kBothSides) {
    const double middle_m = end * kDoorMiddle_m;
    openings.push_back({CarOpeningKind::kDoor, middle_m - 0.42, middle_m + 0.42, 1.06, 3.14});
    const double toilet_m = end * 10.9;
    openings.push_back({CarOpeningKind::kWindow, toilet_m - 0.30, toilet_m + 0.30, 2.35, 2.95});
  }
  for (int i = 0; i < 10; ++i) {  // UIC windows of 1.4 x 0.95 m, one for each pair of seat rows.
    const double middle_m = 1.92 * (i - 4.5);
    openings.push_back({CarOpeningKind::kWindow, middle_m - 0.70, middle_m + 0.70, 2.0, 2.95});
  }
  return openings;
}

/// Adds the steps and grab rails at the four doors, and the sill below the side walls.
void AddCoachSteps(const RailSurfaces& surfaces, Model& coach) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, coach);
  for (const double end : kBothSides) {
    for (const double side : kBothSides) {
      const double x_m = end * kDoorMiddle_m;
      for (const auto& [y_m, z_m] : {std::pair(1.34, 0.50), std::pair(1.26, 0.75)}) {
        frame.Append(
            MakeSideBlock(side, {x_m - 0.42, y_m - 0.26, z_m}, {x_m + 0.42, y_m, z_m + 0.04}));
      }
      for (const double leg_m : {-0.43, 0.43}) {
        frame.Append(MakeSideBlock(side, {x_m + leg_m - 0.015, 1.02, 0.50},
                                   {x_m + leg_m + 0.015, 1.34, kCoachSill_m}));
      }
    }
  }
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-12.4, 1.28, 0.96}, {12.4, 1.37, kCoachSill_m + 0.01}));
  }
}

/// Adds the end walls with their gangway frames, rubber bulges and tail lamps.
void AddCoachEnd(double end, const RailSurfaces& surfaces, Model& coach) {
  const double inner_m = end * (kCoachBodyEnd_m - 0.08);
  const double outer_m = end * kCoachBodyEnd_m;
  Mesh& walls = MeshOf(surfaces.vehicles.paint, coach);
  walls.Append(MakeCarEnd(CoachSection(), std::min(inner_m, outer_m), std::max(inner_m, outer_m)));
  Mesh& rubber = MeshOf(surfaces.vehicles.rubber, coach);
  for (const double side : kBothSides) {
    rubber.Append(MakeBar({end * (kCoachBodyEnd_m + 0.04), side * 0.58, 1.35},
                          {end * (kCoachBodyEnd_m + 0.04), side * 0.58, 3.35}, 0.10));
  }
  rubber.Append(MakeBar({end * (kCoachBodyEnd_m + 0.04), -0.58, 3.38},
                        {end * (kCoachBodyEnd_m + 0.04), 0.58, 3.38}, 0.10));
  rubber.Append(MakeEndBlock(end, {kCoachBodyEnd_m - 0.01, -0.55, 1.22},
                             {kCoachBodyEnd_m + 0.10, 0.55, 1.27}));
  MeshOf(surfaces.vehicles.collector, coach)
      .Append(MakeEndBlock(end, {kCoachBodyEnd_m - 0.01, -0.50, 1.30},
                           {kCoachBodyEnd_m + 0.015, 0.50, 3.30}));
  Mesh& glass = MeshOf(surfaces.vehicles.glass, coach);
  for (const double side : kBothSides) {
    glass.Append(MakeEndBlock(end, {kCoachBodyEnd_m - 0.01, side * 1.10 - 0.08, 1.55},
                              {kCoachBodyEnd_m + 0.03, side * 1.10 + 0.08, 1.75}));
  }
}

/// Adds the boxes of the air conditioning, battery and brakes below the floor.
void AddCoachUnderfloor(const RailSurfaces& surfaces, Model& coach) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, coach);
  frame.Append(MakeBlock({-12.9, -1.28, 1.05}, {12.9, 1.28, 1.20}));
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-7.2, 0.30, 0.90}, {7.2, 0.42, 1.06}));
    for (const auto& [begin_m, end_m, bottom_m] :
         {std::array{-6.6, -4.4, 0.48}, std::array{-3.9, -1.6, 0.42}, std::array{-0.9, 0.4, 0.55},
          std::array{1.0, 3.6, 0.42}, std::array{4.1, 6.3, 0.52}}) {
      frame.Append(MakeSideBlock(side, {begin_m, 0.50, bottom_m}, {end_m, 1.30, 1.06}));
    }
  }
  for (const double end : kBothSides) {
    const double pivot_m = end * kCoachMeasures.pivot_distance_m / 2.0;
    frame.Append(MakeBlock({pivot_m - 0.25, -1.2, 0.93}, {pivot_m + 0.25, 1.2, 1.06}));
    frame.Append(MakeEndBlock(end, {11.1, -0.35, 0.88}, {12.6, 0.35, 1.06}));
  }
}

/// Adds the roof's longitudinal seams and its ventilators.
void AddCoachRoof(const RailSurfaces& surfaces, Model& coach) {
  Mesh& roof = MeshOf(surfaces.vehicles.roof, coach);
  for (const double y_m : {-0.75, -0.25, 0.25, 0.75}) {
    const double z_m = y_m * y_m > 0.3 ? 3.89 : 3.985;
    roof.Append(MakeBlock({-13.0, y_m - 0.015, z_m - 0.05}, {13.0, y_m + 0.015, z_m + 0.02}));
  }
  for (const double end : kBothSides) {
    roof.Append(MakeEndBlock(end, {8.9, -0.55, 3.92}, {11.4, 0.55, 4.05}));
  }
}

}  // namespace

RailVehicleModel MakeCoach(const RailSurfaces& surfaces) {
  const VehicleSurfaces& of = surfaces.vehicles;
  Model coach = MakeVehicleOf(
      "coach", {of.light_paint, of.paint, of.roof, of.frame, of.rubber, of.collector, of.glass});
  AddCarBody(CoachSection(), {-kCoachBodyEnd_m + 0.08, kCoachBodyEnd_m - 0.08}, CoachOpenings(),
             {.wall = of.light_paint, .door = of.paint, .roof = of.roof, .glass = of.glass}, coach);
  for (const double end : kBothSides) AddCoachEnd(end, surfaces, coach);
  AddCoachSteps(surfaces, coach);
  AddCoachUnderfloor(surfaces, coach);
  AddCoachRoof(surfaces, coach);
  AddDrawAndBufferGear(kCoachMeasures.length_m, of.frame, coach);
  return {std::move(coach),
          MakeTrainBogie({.axle_base_m = 2.5, .wheel_radius_m = 0.46, .top_m = 0.94}, surfaces)};
}

}  // namespace railcast
