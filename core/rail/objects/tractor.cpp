#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/road_vehicle_parts.h"
#include "core/rail/objects/road_vehicles.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

// Fendt 310 Vario.
constexpr double kFarmTractorHalfLength_m = 2.075;
constexpr double kFarmTractorHalfWidth_m = 1.1375;
constexpr double kFarmTractorHeight_m = 2.760;
constexpr double kFarmRearTyre_m = 0.783;   // 540/65 R 34.
constexpr double kFarmFrontTyre_m = 0.591;  // 440/65 R 24.
constexpr double kFarmRearAxle_m = -kFarmTractorHalfLength_m + 1.02;
constexpr double kFarmFrontAxle_m = kFarmRearAxle_m + 2.350;

/// A cross-section of hood or cab: a trapezium with rounded upper edges.
struct FarmSection {
  double x_m{};
  double bottom_m{};
  double shoulder_m{};
  double top_m{};
  double bottom_half_width_m{};
  double top_half_width_m{};
};

Rib FarmRib(const FarmSection& section) {
  const std::vector<Point2> half = {
      {0.0, section.bottom_m},
      {section.bottom_half_width_m, section.bottom_m},
      {std::lerp(section.bottom_half_width_m, section.top_half_width_m, 0.6), section.shoulder_m},
      {section.top_half_width_m, section.top_m - 0.06},
      {0.75 * section.top_half_width_m, section.top_m - 0.01},
      {0.0, section.top_m}};
  return MirroredRib(section.x_m, half);
}
constexpr std::size_t kFarmHalfPoints = 6;

std::vector<Rib> FarmRibs(const std::vector<FarmSection>& sections) {
  std::vector<Rib> ribs;
  for (const FarmSection& section : sections) ribs.push_back(FarmRib(section));
  return ribs;
}

void AddFarmHood(const RoadVehicleSurfaces& surfaces, Model& tractor) {
  const std::vector<FarmSection> sections = {
      {0.10, 0.80, 1.30, 1.72, 0.40, 0.40}, {0.60, 0.80, 1.28, 1.68, 0.40, 0.39},
      {1.20, 0.80, 1.22, 1.60, 0.38, 0.37}, {1.65, 0.82, 1.18, 1.52, 0.35, 0.34},
      {1.85, 0.85, 1.14, 1.44, 0.32, 0.30}, {1.93, 0.90, 1.10, 1.32, 0.26, 0.24}};
  const auto wall = [&](std::size_t piece, std::size_t side) {
    const std::size_t panel = HalfPanel(side, kFarmHalfPoints);
    if (panel == 0) return surfaces.trim;
    if (panel == 2 && piece == 3) return surfaces.window;  // Lamps.
    return panel == 1 && piece < 3 ? surfaces.trim : surfaces.paint;
  };
  AddLoftedBody(FarmRibs(sections), {wall, surfaces.paint, surfaces.trim}, tractor);
}

void AddFarmCab(const RoadVehicleSurfaces& surfaces, Model& tractor) {
  // From the rear forward, with pillars of 70 mm; panel 1 is the door's lower half.
  const std::vector<FarmSection> sections = {
      {-1.42, 1.25, 1.55, 2.52, 0.66, 0.66}, {-1.35, 1.05, 1.50, 2.55, 0.74, 0.70},
      {-0.72, 0.95, 1.42, 2.58, 0.76, 0.72}, {-0.65, 0.95, 1.42, 2.58, 0.76, 0.72},
      {0.02, 0.95, 1.35, 2.56, 0.66, 0.70},  {0.09, 0.98, 1.35, 2.54, 0.62, 0.66},
      {0.16, 1.10, 1.40, 2.48, 0.50, 0.60}};
  const auto wall = [&](std::size_t piece, std::size_t side) {
    const std::size_t panel = HalfPanel(side, kFarmHalfPoints);
    const bool is_pillar = piece == 0 || piece == 2 || piece == 4;
    if (panel == 0) return surfaces.trim;
    if (panel == 1) return piece == 3 ? surfaces.window : surfaces.trim;
    return panel == 2 && !is_pillar ? surfaces.window : surfaces.trim;
  };
  AddLoftedBody(FarmRibs(sections), {wall, surfaces.window, surfaces.window}, tractor);
  const std::vector<FarmSection> roof = {{-1.50, 2.50, 2.56, 2.66, 0.66, 0.60},
                                         {-1.30, 2.50, 2.58, 2.74, 0.76, 0.72},
                                         {0.05, 2.50, 2.58, kFarmTractorHeight_m, 0.76, 0.72},
                                         {0.26, 2.52, 2.58, 2.68, 0.70, 0.64}};
  const auto paint = [&](std::size_t, std::size_t) { return surfaces.paint; };
  AddLoftedBody(FarmRibs(roof), {paint, surfaces.paint, surfaces.paint}, tractor);
}

/// A mudguard: an arc of sheet metal about an axle, from one angle above forward to another.
Mesh MakeMudguard(const Vector3& axle_m, double radius_m, const Point2& y_m, const Point2& deg) {
  constexpr int kPieces = 10;
  constexpr double kSheet_m = 0.03;
  std::vector<Rib> ribs;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle_rad = RadFromDeg(std::lerp(deg.x(), deg.y(), 1.0 * i / kPieces));
    const Vector3 out(std::cos(angle_rad), 0.0, std::sin(angle_rad));
    const Vector3 middle_m(axle_m.x(), 0.0, axle_m.z());
    ribs.push_back({middle_m + radius_m * out + Vector3(0, y_m.x(), 0),
                    middle_m + radius_m * out + Vector3(0, y_m.y(), 0),
                    middle_m + (radius_m + kSheet_m) * out + Vector3(0, y_m.y(), 0),
                    middle_m + (radius_m + kSheet_m) * out + Vector3(0, y_m.x(), 0)});
  }
  return MakeLoftedBody(ribs);
}

void AddFarmWheels(const RoadVehicleSurfaces& surfaces, Model& tractor) {
  for (const double side : kBothSides) {
    AddRoadWheel({.radius_m = kFarmRearTyre_m, .width_m = 0.54, .rim_radius_m = 0.44},
                 {kFarmRearAxle_m, side * 0.83, kFarmRearTyre_m}, surfaces, tractor);
    AddRoadWheel({.radius_m = kFarmFrontTyre_m, .width_m = 0.44, .rim_radius_m = 0.31},
                 {kFarmFrontAxle_m, side * 0.8425, kFarmFrontTyre_m}, surfaces, tractor);
    const Point2 rear_y_m(side * 0.55, side * kFarmTractorHalfWidth_m);
    const Point2 front_y_m(side * 0.66, side * 1.04);
    MeshOf(surfaces.paint, tractor)
        .Append(MakeMudguard({kFarmRearAxle_m, 0.0, kFarmRearTyre_m}, 0.86, rear_y_m, {45, 165}));
    MeshOf(surfaces.trim, tractor)
        .Append(
            MakeMudguard({kFarmFrontAxle_m, 0.0, kFarmFrontTyre_m}, 0.65, front_y_m, {60, 165}));
    // Lugs of the rear tyres' tread would be finer than the sensor sees; steps and mirrors are not.
    for (const double z_m : {0.45, 0.72}) {
      MeshOf(surfaces.trim, tractor)
          .Append(MakeSideBlock(side, {-0.15, 0.55, z_m}, {0.25, 0.90, z_m + 0.04}));
    }
    MeshOf(surfaces.trim, tractor)
        .Append(MakeBar({0.10, side * 0.66, 2.30}, {0.14, side * 0.95, 2.35}, 0.015));
    MeshOf(surfaces.trim, tractor)
        .Append(MakeSideBlock(side, {0.12, 0.90, 2.02}, {0.17, 1.10, 2.36}));
    MeshOf(surfaces.reflector, tractor)
        .Append(MakeSideBlock(side, {kFarmRearAxle_m - 0.89, 0.80, 1.02},
                              {kFarmRearAxle_m - 0.84, 0.95, 1.12}));
  }
}

void AddFarmChassis(const RoadVehicleSurfaces& surfaces, Model& tractor) {
  Mesh metal;
  metal.Append(MakeBlock({-1.55, -0.30, 0.55}, {0.2, 0.30, 1.05}));  // Gearbox.
  metal.Append(MakeBlock({0.1, -0.26, 0.58}, {1.80, 0.26, 0.88}));   // Engine.
  metal.Append(MakeBar({kFarmRearAxle_m, -0.8, kFarmRearTyre_m},
                       {kFarmRearAxle_m, 0.8, kFarmRearTyre_m}, 0.16));
  metal.Append(MakeBar({kFarmFrontAxle_m, -0.8, kFarmFrontTyre_m},
                       {kFarmFrontAxle_m, 0.8, kFarmFrontTyre_m}, 0.11));
  metal.Append(MakeBlock({1.75, -0.30, 0.60}, {kFarmTractorHalfLength_m, 0.30, 0.92}));  // Ballast.
  for (const double side : kBothSides) {  // Links of the three-point hitch.
    metal.Append(MakeBar({-1.45, side * 0.28, 0.55},
                         {-kFarmTractorHalfLength_m + 0.025, side * 0.42, 0.50}, 0.045));
    metal.Append(MakeBar({-1.50, side * 0.32, 1.15}, {-1.90, side * 0.38, 0.55}, 0.03));
    MeshOf(surfaces.paint, tractor)
        .Append(MakeSideBlock(side, {-0.1, 0.42, 0.55}, {0.75, 0.72, 0.95}));  // Tanks.
  }
  metal.Append(MakeBar({0.25, -0.52, 1.25}, {0.25, -0.52, 2.50}, 0.06));  // Exhaust.
  metal.Append(MakeBlock({-kFarmTractorHalfLength_m, -0.12, 0.46}, {-1.5, 0.12, 0.56}));
  MeshOf(surfaces.metal, tractor).Append(metal);
}

}  // namespace

Model MakeTractor(const RoadVehicleSurfaces& surfaces) {
  Model tractor{.name = "tractor", .parts = {}};
  AddFarmHood(surfaces, tractor);
  AddFarmCab(surfaces, tractor);
  AddFarmWheels(surfaces, tractor);
  AddFarmChassis(surfaces, tractor);
  return tractor;
}

}  // namespace railcast
