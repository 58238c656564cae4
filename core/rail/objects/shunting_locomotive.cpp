#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/train_bogie.h"
#include "core/rail/objects/vehicle_shapes.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using ShunterPoint = Eigen::Vector2d;

constexpr double kShunterEnd_m = 6.54;  ///< Faces of the headstocks.
constexpr double kDeck_m = 1.42;        ///< Walkway around the hoods, above top of rail.
constexpr double kDeckHalfWidth_m = 1.52;
constexpr double kCabBack_m = -2.55;
constexpr double kCabFront_m = -0.10;
constexpr double kCabTop_m = kShuntingLocomotiveMeasures.height_m;
constexpr double kHoodHalfWidth_m = 0.86;

/// A hood: its extent along the locomotive, its height and which end is its free one.
struct Hood {
  double begin_x_m{};
  double end_x_m{};
  double top_m{};
  double free_end{};
};

constexpr Hood kLongHood = {kCabFront_m, 5.75, 3.02, 1.0};
constexpr Hood kShortHood = {-5.75, kCabBack_m, 2.78, -1.0};

/// Adds a hood with doors, grilles, lamps and handrails.
void AddHood(const Hood& hood, const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& paint = MeshOf(surfaces.vehicles.paint, locomotive);
  const double w_m = kHoodHalfWidth_m;
  const std::vector<ShunterPoint> outline = {{w_m, kDeck_m},
                                             {w_m, hood.top_m - 0.25},
                                             {w_m - 0.10, hood.top_m - 0.07},
                                             {w_m - 0.30, hood.top_m},
                                             {-w_m + 0.30, hood.top_m},
                                             {-w_m + 0.10, hood.top_m - 0.07},
                                             {-w_m, hood.top_m - 0.25},
                                             {-w_m, kDeck_m}};
  paint.Append(MakeExtrusion(outline, hood.begin_x_m, hood.end_x_m));
  Mesh& frame = MeshOf(surfaces.vehicles.frame, locomotive);
  const double face_m = hood.free_end > 0.0 ? hood.end_x_m : -hood.begin_x_m;
  // Radiator grille in the face: horizontal slats in a frame.
  for (int slat = 0; slat < 11; ++slat) {
    const double z_m = 1.62 + 0.095 * slat;
    frame.Append(MakeEndBlock(hood.free_end, {face_m - 0.01, -0.62, z_m},
                              {face_m + 0.03, 0.62, z_m + 0.05}));
  }
  Mesh& glass = MeshOf(surfaces.vehicles.glass, locomotive);
  const std::vector<ShunterPoint> lamp = {{0.0, 0.11}, {0.07, 0.11}, {0.09, 0.08}};
  const Eigen::Matrix3d turn =
      RotationFromYawPitchRoll(hood.free_end > 0.0 ? 0.0 : std::numbers::pi, 0, 0);
  glass.Append(MakeLathe(lamp, 10),
               MakeTransform(turn, {hood.free_end * face_m, 0.0, hood.top_m - 0.14}));
  const double length_m = hood.end_x_m - hood.begin_x_m;
  const int num_doors = static_cast<int>(length_m / 0.80);
  for (const double side : kBothSides) {
    for (int door = 0; door < num_doors; ++door) {
      const double x_m = hood.begin_x_m + length_m * (door + 0.5) / num_doors;
      paint.Append(MakeSideBlock(side, {x_m - 0.36, w_m - 0.01, 1.50},
                                 {x_m + 0.36, w_m + 0.018, hood.top_m - 0.28}));
      frame.Append(MakeSideBlock(side, {x_m + 0.28, w_m, 2.05}, {x_m + 0.31, w_m + 0.04, 2.20}));
      if (door % 3 == 1) {  // Louvres.
        for (int slat = 0; slat < 6; ++slat) {
          const double z_m = 1.62 + 0.09 * slat;
          frame.Append(
              MakeSideBlock(side, {x_m - 0.30, w_m, z_m}, {x_m + 0.30, w_m + 0.03, z_m + 0.04}));
        }
      }
    }
    frame.Append(MakeBar({hood.begin_x_m + 0.1, side * (w_m + 0.08), 2.42},
                         {hood.end_x_m - 0.1, side * (w_m + 0.08), 2.42}, 0.018));
  }
}

/// Left half of the cab's outline, from the deck to the top.
const std::vector<ShunterPoint>& CabOutline() {
  static const std::vector<ShunterPoint> outline = {{1.46, kDeck_m}, {1.46, 3.35},
                                                    {1.36, 3.68},    {1.08, 3.94},
                                                    {0.62, 4.16},    {0.16, kCabTop_m - 0.01}};
  return outline;
}

/// Adds the cab with its windows, doors, roof edge and horn.
void AddCab(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& paint = MeshOf(surfaces.vehicles.paint, locomotive);
  const std::vector<VehicleSection> walls = {MakeVehicleSection(kCabBack_m, CabOutline()),
                                             MakeVehicleSection(kCabFront_m, CabOutline())};
  paint.Append(MakeLoft(walls));
  std::vector<ShunterPoint> roof(CabOutline().begin() + 2, CabOutline().end());
  for (ShunterPoint& point : roof) point += ShunterPoint(0.0, 0.01);
  const std::vector<VehicleSection> cover = {MakeVehicleSection(kCabBack_m - 0.14, roof),
                                             MakeVehicleSection(kCabFront_m + 0.14, roof)};
  MeshOf(surfaces.vehicles.roof, locomotive).Append(MakeLoft(cover));
  Mesh& glass = MeshOf(surfaces.vehicles.glass, locomotive);
  constexpr double kProud_m = 0.008;
  for (const double side : kBothSides) {
    for (const auto& [x_m, outwards] : {std::pair(kCabFront_m, 1.0), std::pair(kCabBack_m, -1.0)}) {
      const double inner_m = std::min(x_m - outwards * 0.02, x_m + outwards * kProud_m);
      const double outer_m = std::max(x_m - outwards * 0.02, x_m + outwards * kProud_m);
      const double over_hood_m = (outwards > 0.0 ? kLongHood.top_m : kShortHood.top_m) + 0.08;
      glass.Append(MakeSideBlock(side, {inner_m, 0.10, over_hood_m}, {outer_m, 0.86, 3.58}));
      glass.Append(MakeSideBlock(side, {inner_m, 0.94, 2.45}, {outer_m, 1.32, 3.50}));
    }
    for (const auto& [begin_m, end_m] : {std::pair(-2.38, -1.38), std::pair(-1.27, -0.27)}) {
      glass.Append(MakeSideBlock(side, {begin_m, 1.44, 2.45}, {end_m, 1.46 + kProud_m, 3.28}));
    }
  }
  Mesh& frame = MeshOf(surfaces.vehicles.frame, locomotive);
  for (const auto& [side, x_m] : {std::pair(1.0, kCabFront_m), std::pair(-1.0, kCabBack_m)}) {
    const double outwards = x_m > -1.0 ? 1.0 : -1.0;
    const double from_m = std::min(x_m, x_m + outwards * 0.015);
    const double to_m = std::max(x_m, x_m + outwards * 0.015);
    paint.Append(MakeSideBlock(side, {from_m, 0.92, kDeck_m + 0.03}, {to_m, 1.38, 2.40}));  // Door.
    frame.Append(MakeBar({x_m + outwards * 0.06, side * 1.42, 1.6},
                         {x_m + outwards * 0.06, side * 1.42, 2.9}, 0.016));
  }
  frame.Append(MakeBar({-0.75, 0.45, 4.10}, {-0.25, 0.45, 4.13}, 0.05));  // Horn.
}

/// Adds the frame: deck, sills, buffer beams, steps and plough plates.
void AddShunterFrame(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, locomotive);
  frame.Append(MakeBlock({-kShunterEnd_m, -kDeckHalfWidth_m, kDeck_m - 0.05},
                         {kShunterEnd_m, kDeckHalfWidth_m, kDeck_m}));
  for (const double side : kBothSides) {
    frame.Append(
        MakeSideBlock(side, {-kShunterEnd_m, 1.30, 1.16}, {kShunterEnd_m, 1.38, kDeck_m - 0.04}));
    frame.Append(
        MakeSideBlock(side, {-1.55, 0.95, 0.46}, {0.05, 1.40, 1.18}));  // Fuel and battery.
    frame.Append(MakeSideBlock(side, {0.2, 0.95, 0.46}, {1.55, 1.40, 1.18}));
    const std::vector<ShunterPoint> tank = {{0.0, 0.08}, {0.05, 0.18}, {1.45, 0.18}, {1.5, 0.08}};
    frame.Append(MakeLathe(tank, 10),
                 MakeTransform(Eigen::Matrix3d::Identity(), {-0.75, side * 0.7, 0.62}));
  }
  frame.Append(MakeBlock({-6.4, -0.9, 1.10}, {6.4, 0.9, kDeck_m - 0.04}));
  const double pivot_m = kShuntingLocomotiveMeasures.pivot_distance_m / 2.0;
  for (const double end : kBothSides) {
    frame.Append(MakeEndBlock(end, {6.36, -1.50, 0.72}, {kShunterEnd_m, 1.50, kDeck_m}));
    frame.Append(MakeEndBlock(end, {6.30, -1.25, 0.20}, {6.36, 1.25, 0.80}));
    frame.Append(MakeEndBlock(end, {pivot_m - 0.3, -1.2, 0.97}, {pivot_m + 0.3, 1.2, 1.12}));
    for (const double side : kBothSides) {
      for (const double z_m : {0.42, 0.74, 1.06}) {
        frame.Append(MakeSideBlock(side, {end * 6.05 - 0.24, 1.26, z_m},
                                   {end * 6.05 + 0.24, 1.5575, z_m + 0.03}));
      }
      for (const double leg_m : {-0.24, 0.24}) {
        frame.Append(MakeSideBlock(side, {end * 6.05 + leg_m - 0.015, 1.28, 0.42},
                                   {end * 6.05 + leg_m + 0.015, 1.32, 1.2}));
      }
    }
  }
}

/// Adds the lamps above the buffers.
void AddShunterLamps(const RailSurfaces& surfaces, Model& locomotive) {
  for (const double end : kBothSides) {
    for (const double side : kBothSides) {
      MeshOf(surfaces.vehicles.paint, locomotive)
          .Append(MakeEndBlock(end, {6.28, side * 1.02 - 0.16, kDeck_m - 0.01},
                               {6.46, side * 1.02 + 0.16, 1.70}));
      MeshOf(surfaces.vehicles.glass, locomotive)
          .Append(MakeEndBlock(end, {6.45, side * 1.02 - 0.10, 1.47},
                               {6.475, side * 1.02 + 0.10, 1.66}));
    }
  }
}

/// Adds the railings at the ends and along the walkways.
void AddRailings(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& rails = MeshOf(surfaces.vehicles.light_paint, locomotive);
  constexpr double kRail_m = kDeck_m + 1.05;
  for (const double end : kBothSides) {
    const double x_m = end * (kShunterEnd_m - 0.04);
    for (const double side : kBothSides) {
      for (const double y_m : {0.35, 0.95, 1.50}) {
        rails.Append(MakeBar({x_m, side * y_m, kDeck_m}, {x_m, side * y_m, kRail_m}, 0.019));
      }
      for (const double z_m : {kDeck_m + 0.55, kRail_m}) {
        rails.Append(MakeBar({x_m, side * 0.35, z_m}, {x_m, side * 1.50, z_m}, 0.019));
      }
      // Grab rails beside the steps.
      for (const double step_m : {5.75, 6.35}) {
        rails.Append(MakeBar({end * step_m, side * 1.535, 0.80},
                             {end * step_m, side * 1.535, kRail_m}, 0.018));
      }
      rails.Append(
          MakeBar({x_m, side * 1.50, kRail_m}, {end * 6.35, side * 1.535, kRail_m}, 0.018));
    }
  }
}

/// Adds exhaust, fan and bells on the hoods.
void AddHoodTops(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, locomotive);
  const Eigen::Matrix3d upright = RotationFromYawPitchRoll(0, -0.5 * std::numbers::pi, 0);
  const std::vector<ShunterPoint> fan = {{0.0, 0.58}, {0.10, 0.58}, {0.14, 0.50}};
  frame.Append(MakeLathe(fan, 16), MakeTransform(upright, {4.7, 0.0, kLongHood.top_m - 0.02}));
  const std::vector<ShunterPoint> exhaust = {{0.0, 0.15}, {0.28, 0.13}, {0.30, 0.10}};
  for (const double y_m : {-0.28, 0.28}) {
    frame.Append(MakeLathe(exhaust, 10),
                 MakeTransform(upright, {1.6, y_m, kLongHood.top_m - 0.02}));
  }
  Mesh& roof = MeshOf(surfaces.vehicles.roof, locomotive);
  roof.Append(MakeBlock({2.2, -0.45, kLongHood.top_m - 0.02}, {3.7, 0.45, kLongHood.top_m + 0.06}));
  roof.Append(
      MakeBlock({-5.2, -0.40, kShortHood.top_m - 0.02}, {-3.4, 0.40, kShortHood.top_m + 0.05}));
}

}  // namespace

RailVehicleModel MakeShuntingLocomotive(const RailSurfaces& surfaces) {
  const VehicleSurfaces& of = surfaces.vehicles;
  Model locomotive =
      MakeVehicleOf("shunting_locomotive", {of.paint, of.light_paint, of.roof, of.frame, of.glass});
  AddHood(kLongHood, surfaces, locomotive);
  AddHood(kShortHood, surfaces, locomotive);
  AddCab(surfaces, locomotive);
  AddShunterFrame(surfaces, locomotive);
  AddRailings(surfaces, locomotive);
  AddShunterLamps(surfaces, locomotive);
  AddHoodTops(surfaces, locomotive);
  AddDrawAndBufferGear(kShuntingLocomotiveMeasures.length_m, surfaces.vehicles.frame, locomotive);
  return {std::move(locomotive),
          MakeTrainBogie({.axle_base_m = 2.5, .wheel_radius_m = 0.55, .top_m = 0.98}, surfaces)};
}

}  // namespace railcast
