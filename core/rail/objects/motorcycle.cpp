#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/road_vehicle_parts.h"
#include "core/rail/objects/road_vehicles.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

// Honda CB500F: tyres 120/70 and 160/60 R 17.
constexpr double kMotorFrontTyre_m = 0.300;
constexpr double kMotorRearTyre_m = 0.312;
constexpr double kMotorHalfLength_m = 1.040;
constexpr double kMotorFrontAxle_m = kMotorHalfLength_m - kMotorFrontTyre_m;
constexpr double kMotorRearAxle_m = kMotorFrontAxle_m - 1.410;

void AddMotorWheels(const RoadVehicleSurfaces& surfaces, Model& motorcycle) {
  AddRoadWheel({.radius_m = kMotorFrontTyre_m, .width_m = 0.12, .rim_radius_m = 0.216},
               {kMotorFrontAxle_m, 0.0, kMotorFrontTyre_m}, surfaces, motorcycle);
  AddRoadWheel({.radius_m = kMotorRearTyre_m, .width_m = 0.16, .rim_radius_m = 0.216},
               {kMotorRearAxle_m, 0.0, kMotorRearTyre_m}, surfaces, motorcycle);
  Mesh metal;
  for (const double side : kBothSides) {
    // Fork, swinging arm.
    metal.Append(MakeBar({kMotorFrontAxle_m, side * 0.10, kMotorFrontTyre_m},
                         {0.44, side * 0.10, 0.92}, 0.026));
    metal.Append(MakeBar({kMotorRearAxle_m, side * 0.11, kMotorRearTyre_m},
                         {-0.12, side * 0.11, 0.40}, 0.030));
  }
  const std::vector<OvalSection> mudguard = {{kMotorFrontAxle_m - 0.26, 0.49, 0.010, 0.06},
                                             {kMotorFrontAxle_m - 0.14, 0.595, 0.012, 0.07},
                                             {kMotorFrontAxle_m, 0.625, 0.012, 0.07},
                                             {kMotorFrontAxle_m + 0.13, 0.60, 0.010, 0.06}};
  MeshOf(surfaces.trim, motorcycle).Append(MakeOvalBody(mudguard, {0, 0}, 8));
  MeshOf(surfaces.metal, motorcycle).Append(metal);
}

void AddMotorBody(const RoadVehicleSurfaces& surfaces, Model& motorcycle) {
  Mesh paint;
  const std::vector<OvalSection> tank = {{-0.16, 0.78, 0.05, 0.08},
                                         {-0.02, 0.82, 0.11, 0.14},
                                         {0.16, 0.85, 0.14, 0.17},
                                         {0.32, 0.85, 0.12, 0.13},
                                         {0.40, 0.84, 0.06, 0.07}};
  paint.Append(MakeOvalBody(tank, {0, 0}, 14));
  const std::vector<OvalSection> tail = {{-0.30, 0.72, 0.07, 0.11},
                                         {-0.55, 0.77, 0.07, 0.12},
                                         {-0.80, 0.84, 0.05, 0.08},
                                         {-0.92, 0.88, 0.02, 0.04}};
  paint.Append(MakeOvalBody(tail, {0, 0}, 10));
  Mesh trim;
  const std::vector<OvalSection> seat = {{-0.10, 0.785, 0.04, 0.11},
                                         {-0.30, 0.79, 0.04, 0.15},
                                         {-0.48, 0.83, 0.045, 0.13},
                                         {-0.70, 0.885, 0.035, 0.10},
                                         {-0.80, 0.90, 0.02, 0.06}};
  trim.Append(MakeOvalBody(seat, {0, 0}, 12));
  Mesh metal;
  const std::vector<OvalSection> engine = {{-0.16, 0.42, 0.15, 0.17},
                                           {0.02, 0.42, 0.19, 0.20},
                                           {0.18, 0.48, 0.20, 0.17},
                                           {0.30, 0.54, 0.12, 0.14}};
  metal.Append(MakeOvalBody(engine, {0, 0}, 12));
  metal.Append(MakeBlock({0.32, -0.15, 0.44}, {0.36, 0.15, 0.72}));  // Radiator.
  for (const double side : kBothSides) {
    metal.Append(MakeBar({0.36, side * 0.09, 0.84}, {-0.14, side * 0.13, 0.46}, 0.028));
    metal.Append(MakeBar({-0.10, side * 0.11, 0.70}, {-0.78, side * 0.07, 0.80}, 0.018));
    metal.Append(MakeBar({-0.14, side * 0.15, 0.36}, {-0.14, side * 0.27, 0.36}, 0.015));
  }
  metal.Append(MakeBar({-0.05, -0.17, 0.30}, {-0.40, -0.20, 0.34}, 0.045));
  metal.Append(MakeBar({-0.40, -0.20, 0.34}, {-0.80, -0.22, 0.47}, 0.058));  // Silencer.
  MeshOf(surfaces.paint, motorcycle).Append(paint);
  MeshOf(surfaces.trim, motorcycle).Append(trim);
  MeshOf(surfaces.metal, motorcycle).Append(metal);
}

void AddMotorFittings(const RoadVehicleSurfaces& surfaces, Model& motorcycle) {
  Mesh trim;
  for (const double side : kBothSides) {
    const std::vector<Vector3> handlebar = {{0.40, 0.0, 0.95},
                                            {0.40, side * 0.10, 0.96},
                                            {0.36, side * 0.24, 1.00},
                                            {0.26, side * 0.37, 0.985}};
    trim.Append(MakeTube(handlebar, 0.014, 8));
    trim.Append(MakeBar({0.36, side * 0.26, 1.00}, {0.39, side * 0.31, 1.035}, 0.008));
    trim.Append(MakeEllipsoid({0.40, side * 0.335, 1.025}, {0.018, 0.06, 0.035}, 12));
    // Indicators.
    trim.Append(MakeBar({0.46, side * 0.08, 0.80}, {0.47, side * 0.20, 0.80}, 0.02));
    trim.Append(MakeBar({-0.88, side * 0.04, 0.78}, {-0.90, side * 0.17, 0.78}, 0.02));
  }
  MeshOf(surfaces.window, motorcycle)
      .Append(MakeEllipsoid({0.50, 0.0, 0.84}, {0.07, 0.10, 0.09}, 12));
  const std::vector<OvalSection> cowl = {
      {0.38, 0.90, 0.08, 0.10}, {0.46, 0.94, 0.06, 0.11}, {0.53, 0.90, 0.03, 0.07}};
  MeshOf(surfaces.paint, motorcycle).Append(MakeOvalBody(cowl, {0, 0}, 10));
  // Holder with a number plate of 200 x 180 mm and a reflector below the tail.
  trim.Append(MakeBar({-0.84, 0.0, 0.80}, {-1.015, 0.0, 0.60}, 0.015));
  Mesh reflector;
  reflector.Append(
      MakeBlock({-kMotorHalfLength_m, -0.10, 0.50}, {-kMotorHalfLength_m + 0.006, 0.10, 0.68}));
  reflector.Append(MakeBlock({-kMotorHalfLength_m + 0.001, -0.04, 0.44},
                             {-kMotorHalfLength_m + 0.012, 0.04, 0.48}));
  MeshOf(surfaces.trim, motorcycle).Append(trim);
  MeshOf(surfaces.reflector, motorcycle).Append(reflector);
}

}  // namespace

Model MakeMotorcycle(const RoadVehicleSurfaces& surfaces) {
  Model motorcycle{.name = "motorcycle", .parts = {}};
  AddMotorWheels(surfaces, motorcycle);
  AddMotorBody(surfaces, motorcycle);
  AddMotorFittings(surfaces, motorcycle);
  return motorcycle;
}

}  // namespace railcast
