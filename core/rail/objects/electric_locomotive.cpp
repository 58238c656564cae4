#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/pantograph.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/train_bogie.h"
#include "core/rail/objects/vehicle_shapes.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using LocomotivePoint = Eigen::Vector2d;

constexpr double kLowerEdge_m = 1.02;
constexpr double kSide_m = 1.485;     ///< Half width of the body; the handrails stand out 21 mm.
constexpr double kRoof_m = 3.72;      ///< Flat middle of the roof.
constexpr double kLowered_m = 4.248;  ///< Height with lowered pantograph.

/// Cross-sections from the machine room to the front: left half, from the lower edge to the top.
std::vector<VehicleSection> FrontSections(double end) {
  const std::vector<std::pair<double, std::vector<LocomotivePoint>>> stations = {
      {0.0,
       {{kSide_m, kLowerEdge_m}, {kSide_m, 2.0}, {kSide_m, 3.12}, {1.28, 3.52}, {0.95, kRoof_m}}},
      {6.9,
       {{kSide_m, kLowerEdge_m}, {kSide_m, 2.0}, {kSide_m, 3.12}, {1.28, 3.52}, {0.95, kRoof_m}}},
      {7.55, {{1.48, kLowerEdge_m}, {1.475, 2.0}, {1.44, 3.06}, {1.25, 3.46}, {0.97, 3.68}}},
      {8.0, {{1.44, kLowerEdge_m}, {1.43, 1.98}, {1.36, 2.96}, {1.22, 3.28}, {1.05, 3.42}}},
      {8.68, {{1.38, kLowerEdge_m}, {1.36, 1.55}, {1.33, 1.82}, {1.28, 1.93}, {1.16, 1.98}}},
      {8.84, {{1.33, kLowerEdge_m}, {1.30, 1.42}, {1.27, 1.62}, {1.22, 1.72}, {1.10, 1.76}}}};
  std::vector<VehicleSection> sections;
  for (const auto& [x_m, half] : stations) sections.push_back(MakeVehicleSection(end * x_m, half));
  return sections;
}

/// Adds one half of the body: machine room, cab, windows, lamps and wipers.
void AddHalf(double end, const RailSurfaces& surfaces, Model& locomotive) {
  const std::vector<VehicleSection> sections = FrontSections(end);
  MeshOf(surfaces.vehicles.paint, locomotive).Append(MakeLoft(sections));
  Mesh& glass = MeshOf(surfaces.vehicles.glass, locomotive);
  const Vector3 forwards(end, 0.0, 0.5);
  const std::array<Vector3, 4> windscreen = {sections[3][4], sections[3][5], sections[4][5],
                                             sections[4][4]};
  glass.Append(MakePane(windscreen, {0.03, 0.492, 0.10, 0.90}, forwards, 0.01));
  glass.Append(MakePane(windscreen, {0.508, 0.97, 0.10, 0.90}, forwards, 0.01));
  for (const auto& [corner, side] :
       {std::pair(std::size_t{1}, 1.0), std::pair(std::size_t{7}, -1.0)}) {
    const FacePart part =
        side > 0.0 ? FacePart{0.22, 0.88, 0.12, 0.85} : FacePart{0.12, 0.78, 0.12, 0.85};
    glass.Append(MakePane(FaceBetween(sections[2], sections[3], corner), part, {0, side, 0}, 0.01));
    const FacePart door =
        side > 0.0 ? FacePart{0.28, 0.88, 0.0, 0.72} : FacePart{0.12, 0.72, 0.0, 0.72};
    const std::array<Vector3, 4> leaf = {
        Vector3(end * 6.32, side * kSide_m, 2.0), Vector3(end * 6.32, side * kSide_m, 3.12),
        Vector3(end * 6.98, side * kSide_m, 3.12), Vector3(end * 6.98, side * kSide_m, 2.0)};
    glass.Append(
        MakePane(leaf, side > 0.0 ? door : FacePart{0.28, 0.88, 0.0, 0.72}, {0, side, 0}, 0.004));
  }
  for (const double side : kBothSides) {
    glass.Append(
        MakeEndBlock(end, {8.80, side * 0.92 - 0.20, 1.34}, {8.855, side * 0.92 + 0.20, 1.50}));
  }
  glass.Append(MakeEndBlock(end, {7.94, -0.16, 3.43}, {8.02, 0.16, 3.52}));  // Upper headlamp.
  Mesh& rubber = MeshOf(surfaces.vehicles.rubber, locomotive);
  for (const double side : kBothSides) {
    rubber.Append(MakeBar({end * 8.66, side * 0.30, 2.06}, {end * 8.36, side * 0.75, 2.72}, 0.012));
  }
}

/// Adds doors, their handrails and steps, and the vents of the machine room on both sides.
void AddSides(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& paint = MeshOf(surfaces.vehicles.paint, locomotive);
  Mesh& frame = MeshOf(surfaces.vehicles.frame, locomotive);
  for (const double side : kBothSides) {
    for (const double end : kBothSides) {
      const double door_m = end * 6.65;
      for (const double edge_m : {-0.36, 0.36}) {
        const double x_m = door_m + edge_m;
        paint.Append(MakeSideBlock(side, {x_m - 0.02, kSide_m - 0.01, 1.25},
                                   {x_m + 0.02, kSide_m + 0.010, 3.15}));
        const double rail_m = door_m + 1.25 * edge_m;
        frame.Append(MakeBar({rail_m, side * 1.490, 1.20}, {rail_m, side * 1.490, 2.75}, 0.016));
      }
      paint.Append(MakeSideBlock(side, {door_m - 0.36, kSide_m - 0.01, 3.11},
                                 {door_m + 0.36, kSide_m + 0.010, 3.15}));
      for (const double z_m : {0.36, 0.66, 0.93}) {
        frame.Append(
            MakeSideBlock(side, {door_m - 0.24, 1.28, z_m}, {door_m + 0.24, 1.48, z_m + 0.03}));
      }
      for (const double leg_m : {-0.24, 0.24}) {
        frame.Append(MakeSideBlock(side, {door_m + leg_m - 0.015, 1.44, 0.36},
                                   {door_m + leg_m + 0.015, 1.47, kLowerEdge_m}));
      }
    }
    for (int i = -2; i <= 2; ++i) {  // Ribs of the side panels.
      paint.Append(MakeSideBlock(side, {2.1 * i - 0.03, kSide_m - 0.01, 1.10},
                                 {2.1 * i + 0.03, kSide_m + 0.008, 3.05}));
    }
    frame.Append(MakeSideBlock(side, {-6.1, kSide_m - 0.01, 1.04}, {6.1, kSide_m + 0.012, 1.16}));
  }
}

/// Adds the transformer between the bogies, tanks, buffer beams and snow ploughs below the body.
void AddUnderfloor(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& frame = MeshOf(surfaces.vehicles.frame, locomotive);
  frame.Append(MakeBlock({-2.0, -1.30, 0.28}, {2.0, 1.30, kLowerEdge_m}));
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-1.9, 1.30, 0.40}, {-0.1, 1.36, 0.92}));
    frame.Append(MakeSideBlock(side, {0.1, 1.30, 0.40}, {1.9, 1.36, 0.92}));
  }
  const std::vector<LocomotivePoint> plough = {
      {1.30, 0.16}, {1.34, 0.62}, {-1.34, 0.62}, {-1.30, 0.16}};
  for (const double end : kBothSides) {
    frame.Append(MakeEndBlock(end, {8.30, -1.36, 0.84}, {8.80, 1.36, kLowerEdge_m + 0.02}));
    frame.Append(
        MakeExtrusion(plough, std::min(end * 8.30, end * 8.42), std::max(end * 8.30, end * 8.42)));
    for (const double side : kBothSides) {
      frame.Append(
          MakeEndBlock(end, {8.24, side * 0.9 - 0.06, 0.60}, {8.42, side * 0.9 + 0.06, 0.90}));
      frame.Append(
          MakeEndBlock(end, {8.50, side * 1.22 - 0.16, 0.44}, {8.72, side * 1.22 + 0.16, 0.48}));
      frame.Append(
          MakeEndBlock(end, {8.60, side * 1.22 - 0.16, 0.48}, {8.64, side * 1.22 + 0.16, 0.90}));
      frame.Append(
          MakeBar({end * 8.90, side * 0.95, 1.42}, {end * 8.90, side * 1.25, 1.42}, 0.014));
    }
    const double pivot_m = end * kElectricLocomotiveMeasures.pivot_distance_m / 2.0;
    frame.Append(
        MakeBlock({pivot_m - 0.35, -1.25, 0.99}, {pivot_m + 0.35, 1.25, kLowerEdge_m + 0.02}));
  }
}

/// Adds the roof's hatches with their grilles, the pantographs and the busbar between them.
void AddRoof(const RailSurfaces& surfaces, Model& locomotive) {
  Mesh& roof = MeshOf(surfaces.vehicles.roof, locomotive);
  for (const double middle_m : {-2.3, 0.0, 2.3}) {
    roof.Append(MakeBlock({middle_m - 1.05, -0.90, kRoof_m - 0.02},
                          {middle_m + 1.05, 0.90, kRoof_m + 0.08}));
    for (const double side : kBothSides) {
      for (int slot = 0; slot < 6; ++slot) {
        const double x_m = middle_m - 0.85 + 0.34 * slot;
        roof.Append(MakeSideBlock(side, {x_m - 0.12, 0.45, kRoof_m + 0.08},
                                  {x_m + 0.12, 0.82, kRoof_m + 0.11}));
      }
    }
  }
  for (const double end : kBothSides) {
    roof.Append(
        MakeEndBlock(end, {6.7, -0.75, kRoof_m - 0.02}, {7.3, 0.75, kRoof_m + 0.12}));  // Climate.
    roof.Append(MakeBar({end * 7.5, 0.4, kRoof_m - 0.06}, {end * 7.5, 0.4, kRoof_m + 0.25}, 0.012));
  }
  const double base_m = kRoof_m + 0.02;
  AddPantograph({.x_m = -5.2,
                 .base_m = base_m,
                 .contact_height_m = kElectricLocomotiveMeasures.height_m,
                 .knee = 1.0},
                surfaces, locomotive);
  AddPantograph({.x_m = 5.2, .base_m = base_m, .contact_height_m = kLowered_m, .knee = -1.0},
                surfaces, locomotive);
  for (const double x_m : {-3.2, -1.1, 1.1, 3.2}) {
    AddRoofInsulator({x_m, -0.25, kRoof_m + 0.08}, surfaces, locomotive);
  }
  MeshOf(surfaces.vehicles.collector, locomotive)
      .Append(MakeBar({-4.6, -0.25, kRoof_m + 0.38}, {4.6, -0.25, kRoof_m + 0.38}, 0.025));
}

}  // namespace

RailVehicleModel MakeElectricLocomotive(const RailSurfaces& surfaces) {
  const VehicleSurfaces& of = surfaces.vehicles;
  Model locomotive = MakeVehicleOf("electric_locomotive", {of.paint, of.roof, of.frame, of.rubber,
                                                           of.glass, of.collector, of.insulator});
  for (const double end : kBothSides) AddHalf(end, surfaces, locomotive);
  AddSides(surfaces, locomotive);
  AddUnderfloor(surfaces, locomotive);
  AddRoof(surfaces, locomotive);
  AddDrawAndBufferGear(kElectricLocomotiveMeasures.length_m, surfaces.vehicles.frame, locomotive);
  return {std::move(locomotive),
          MakeTrainBogie(
              {.axle_base_m = 3.0, .wheel_radius_m = 0.625, .top_m = 1.0, .has_motors = true},
              surfaces)};
}

}  // namespace railcast
