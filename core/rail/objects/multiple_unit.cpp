#include <algorithm>
#include <array>
#include <span>
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

using UnitPoint = Eigen::Vector2d;

constexpr double kUnitEnd_m = kMultipleUnitMeasures.length_m / 2.0;
constexpr double kUnitBack_m = -kUnitEnd_m + 0.36;  ///< Outer face of the back wall.
constexpr double kNoseBegin_m = 7.6;
constexpr double kUnitSill_m = 1.00;
constexpr double kUnitTop_m = kMultipleUnitMeasures.height_m;
constexpr double kUnitPivot_m = kMultipleUnitMeasures.pivot_distance_m / 2.0;

const CarSection& UnitSection() {
  static const CarSection section = {
      .side = {{1.465, kUnitSill_m}, {1.475, 1.35}, {1.475, 1.95}, {1.42, 2.70}, {1.33, 3.10}},
      .roof = {{1.33, 3.10}, {1.15, 3.45}, {0.85, 3.70}, {0.45, 3.84}, {0.0, kUnitTop_m}}};
  return section;
}

/// A band of windows, and the door behind it.
std::vector<CarOpening> UnitOpenings() {
  std::vector<CarOpening> openings = {{CarOpeningKind::kDoor, -11.55, -10.65, 1.06, 3.05},
                                      {CarOpeningKind::kWindow, -10.2, -9.6, 2.05, 2.75}};
  for (int i = 0; i < 9; ++i) {
    const double begin_m = -9.1 + 1.82 * i;
    openings.push_back({CarOpeningKind::kWindow, begin_m, begin_m + 1.55, 1.98, 2.75});
  }
  return openings;
}

/// One cross-section of the nose: an outline, squeezed.
struct NoseStation {
  double x_m{};
  double width = 1.0;  ///< As a share of the body's.
  double bottom_m{};
  double top_m{};
};

/// The nose after photographs of class 403: the windscreen rises at about 30 degrees from a long,
/// round hood over the coupling.
constexpr auto kNoseStations = std::to_array<NoseStation>({{kNoseBegin_m, 1.0, 1.0, kUnitTop_m},
                                                           {8.7, 0.995, 1.0, 3.86},
                                                           {9.5, 0.975, 1.0, 3.72},
                                                           {10.2, 0.935, 1.0, 3.42},
                                                           {10.9, 0.875, 1.0, 2.96},
                                                           {11.5, 0.79, 1.0, 2.48},
                                                           {12.0, 0.68, 0.98, 2.08},
                                                           {12.4, 0.55, 0.94, 1.76},
                                                           {12.7, 0.40, 0.88, 1.46},
                                                           {12.87, 0.25, 0.84, 1.22},
                                                           {kUnitEnd_m, 0.12, 0.82, 1.06}});

/// The apron below the nose, in front of the bogie.
constexpr auto kApronStations = std::to_array<NoseStation>({{10.56, 0.905, 0.30, 1.05},
                                                            {10.9, 0.875, 0.30, 1.05},
                                                            {11.5, 0.79, 0.32, 1.05},
                                                            {12.0, 0.68, 0.36, 1.05},
                                                            {12.4, 0.54, 0.42, 1.02},
                                                            {12.7, 0.38, 0.52, 0.98},
                                                            {12.85, 0.22, 0.66, 0.92}});

/// @param outline Left half, with heights from 0 at the station's bottom to 1 at its top.
std::vector<VehicleSection> SectionsOf(std::span<const NoseStation> stations,
                                       std::span<const UnitPoint> outline) {
  std::vector<VehicleSection> sections;
  for (const NoseStation& station : stations) {
    std::vector<UnitPoint> half;
    for (const UnitPoint& point : outline) {
      half.emplace_back(point.x() * station.width,
                        station.bottom_m + point.y() * (station.top_m - station.bottom_m));
    }
    sections.push_back(MakeVehicleSection(station.x_m, half));
  }
  return sections;
}

/// Adds a pane on the same face of the nose on both sides.
void AddSidePanes(const VehicleSection& back,
                  const VehicleSection& front,
                  std::size_t corner,
                  const FacePart& part,
                  Mesh& glass) {
  const FacePart mirrored{1.0 - part.end_u, 1.0 - part.begin_u, part.begin_v, part.end_v};
  glass.Append(MakePane(FaceBetween(back, front, corner), part, {0.3, 1.0, 0.0}, 0.008));
  glass.Append(MakePane(FaceBetween(back, front, back.size() - 2 - corner), mirrored,
                        {0.3, -1.0, 0.0}, 0.008));
}

/// Adds the nose with windscreen, side windows of the cab and headlamps.
void AddNose(const RailSurfaces& surfaces, Model& unit) {
  const std::vector<UnitPoint> nose = {{1.465, 0.0},  {1.475, 0.12}, {1.475, 0.33},
                                       {1.42, 0.588}, {1.33, 0.727}, {1.15, 0.848},
                                       {0.85, 0.934}, {0.45, 0.983}, {0.12, 1.0}};
  const std::vector<UnitPoint> apron = {{1.20, 0.0}, {1.38, 0.40}, {1.46, 1.0}};
  const std::vector<VehicleSection> sections = SectionsOf(kNoseStations, nose);
  Mesh& body = MeshOf(surfaces.vehicles.light_paint, unit);
  body.Append(MakeLoft(sections));
  body.Append(MakeLoft(SectionsOf(kApronStations, apron)));
  Mesh& glass = MeshOf(surfaces.vehicles.glass, unit);
  // The windscreen goes over the top, from one shoulder (corner 5) to the other.
  constexpr std::size_t kShoulder = 5;
  const std::size_t num_corners = sections.front().size();
  for (std::size_t station = 2; station <= 4; ++station) {
    for (std::size_t corner = kShoulder; corner <= num_corners - 2 - kShoulder; ++corner) {
      const double middle_y_m = 0.5 * (sections[3][corner].y() + sections[3][corner + 1].y());
      const FacePart part{.begin_v = station == 2 ? 0.35 : 0.0, .end_v = station == 4 ? 0.85 : 1.0};
      glass.Append(MakePane(FaceBetween(sections[station], sections[station + 1], corner), part,
                            {0.7, 0.5 * middle_y_m, 1.0}, 0.008));
    }
  }
  AddSidePanes(sections[0], sections[1], 2, {0.05, 0.95, 0.15, 0.95}, glass);
  AddSidePanes(sections[6], sections[7], 2, {0.2, 0.9, 0.1, 0.9}, glass);  // Headlamps.
}

/// Adds the skirts between the bogies and behind them, with the hatches of the equipment.
void AddSkirts(const RailSurfaces& surfaces, Model& unit) {
  const std::vector<UnitPoint> skirt = {
      {1.22, 0.36},  {1.41, 0.62}, {1.465, kUnitSill_m + 0.05}, {-1.465, kUnitSill_m + 0.05},
      {-1.41, 0.62}, {-1.22, 0.36}};
  Mesh& mesh = MeshOf(surfaces.vehicles.light_paint, unit);
  mesh.Append(MakeExtrusion(skirt, -6.75, 6.75));
  mesh.Append(MakeExtrusion(skirt, kUnitBack_m + 0.02, -10.62));
  Mesh& roof = MeshOf(surfaces.vehicles.roof, unit);
  for (int i = -3; i <= 3; ++i) {
    for (const double side : kBothSides) {
      roof.Append(MakeSideBlock(side, {1.8 * i - 0.75, 1.38, 0.66}, {1.8 * i + 0.75, 1.455, 0.96}));
    }
  }
  Mesh& frame = MeshOf(surfaces.vehicles.frame, unit);
  frame.Append(
      MakeBlock({kUnitBack_m + 0.1, -1.38, kUnitSill_m - 0.03}, {kNoseBegin_m + 1.0, 1.38, 1.2}));
  for (const double end : kBothSides) {
    const double pivot_m = end * kUnitPivot_m;
    frame.Append(MakeBlock({pivot_m - 0.3, -1.2, 0.94}, {pivot_m + 0.3, 1.2, kUnitSill_m}));
  }
}

/// Adds the gangway and the coupling to the next car, whose middle is the end of this one.
void AddUnitBack(const RailSurfaces& surfaces, Model& unit) {
  MeshOf(surfaces.vehicles.light_paint, unit)
      .Append(MakeCarEnd(UnitSection(), kUnitBack_m, kUnitBack_m + 0.08));
  Mesh& rubber = MeshOf(surfaces.vehicles.rubber, unit);
  const std::vector<UnitPoint> bellows = {{0.70, 1.15},  {0.70, 3.20},  {0.60, 3.35},
                                          {-0.60, 3.35}, {-0.70, 3.20}, {-0.70, 1.15}};
  for (int fold = 0; fold < 4; ++fold) {
    const double x_m = kUnitBack_m - 0.09 * fold;
    rubber.Append(MakeExtrusion(bellows, x_m - 0.06, x_m));
  }
  std::vector<UnitPoint> inner = bellows;
  for (UnitPoint& point : inner) point = {0.95 * point.x(), 1.15 + 0.97 * (point.y() - 1.15)};
  rubber.Append(MakeExtrusion(inner, -kUnitEnd_m + 0.01, kUnitBack_m));
  Mesh& frame = MeshOf(surfaces.vehicles.frame, unit);
  frame.Append(MakeBar({kUnitBack_m + 1.0, 0, 0.80}, {-kUnitEnd_m, 0, 0.80}, 0.11));
}

/// Adds the covers of the air conditioning and the seams of the roof.
void AddUnitRoof(const RailSurfaces& surfaces, Model& unit) {
  Mesh& roof = MeshOf(surfaces.vehicles.roof, unit);
  for (const double middle_m : {-9.6, -1.0, 5.0}) {
    for (const double side : kBothSides) {
      for (int slot = 0; slot < 5; ++slot) {
        const double x_m = middle_m - 0.8 + 0.4 * slot;
        roof.Append(MakeSideBlock(side, {x_m - 0.14, 0.40, 3.78}, {x_m + 0.14, 0.62, 3.845}));
      }
    }
  }
}

}  // namespace

RailVehicleModel MakeMultipleUnit(const RailSurfaces& surfaces) {
  const VehicleSurfaces& of = surfaces.vehicles;
  Model unit = MakeVehicleOf("multiple_unit",
                             {of.light_paint, of.paint, of.roof, of.frame, of.rubber, of.glass});
  AddCarBody(
      UnitSection(), {kUnitBack_m + 0.08, kNoseBegin_m}, UnitOpenings(),
      {.wall = of.light_paint, .door = of.light_paint, .roof = of.light_paint, .glass = of.glass},
      unit);
  AddNose(surfaces, unit);
  AddSkirts(surfaces, unit);
  AddUnitBack(surfaces, unit);
  AddUnitRoof(surfaces, unit);
  // A red stripe below the windows.
  for (const double side : kBothSides) {
    MeshOf(of.paint, unit)
        .Append(MakeSideBlock(side, {kUnitBack_m + 0.02, 1.46, 1.55}, {kNoseBegin_m, 1.478, 1.80}));
  }
  return {std::move(unit),
          MakeTrainBogie(
              {.axle_base_m = 2.5, .wheel_radius_m = 0.46, .top_m = 0.95, .has_motors = true},
              surfaces)};
}

}  // namespace railcast
