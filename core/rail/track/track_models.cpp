#include "core/rail/track/track_structure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

/// A symmetric trapezoidal cross-section of a sleeper.
struct SleeperStation {
  double y_m{};
  double top_m{};
  double top_half_width_m{};
  double bottom_half_width_m{};
};

constexpr double kConcreteUnderside_m = -0.396;

/// Lofts a sleeper through sections from the right end to the left one, with four corners each.
Mesh MakeSleeperLoft(std::span<const SleeperStation> stations, double underside_m) {
  Mesh mesh;
  for (const SleeperStation& station : stations) {
    const auto add = [&](double x_m, double z_m) {
      mesh.vertices.emplace_back(Vector3(x_m, station.y_m, z_m).cast<float>());
    };
    add(-station.bottom_half_width_m, underside_m);
    add(station.bottom_half_width_m, underside_m);
    add(station.top_half_width_m, station.top_m);
    add(-station.top_half_width_m, station.top_m);
  }
  for (std::uint32_t k = 0; k + 1 < stations.size(); ++k) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t a = 4 * k + i;
      const std::uint32_t b = 4 * k + (i + 1) % 4;
      mesh.triangles.push_back({a, a + 4, b + 4});
      mesh.triangles.push_back({a, b + 4, b});
    }
  }
  const auto last = static_cast<std::uint32_t>(4 * (stations.size() - 1));
  mesh.triangles.push_back({0, 1, 2});
  mesh.triangles.push_back({0, 2, 3});
  mesh.triangles.push_back({last, last + 2, last + 1});
  mesh.triangles.push_back({last, last + 3, last + 2});
  return mesh;
}

/// Right half of the B70, from the end inwards (DB drawing Ios 8; heights from
/// docs/physics.md 7.1).
std::vector<SleeperStation> ConcreteStations(double shift_m) {
  constexpr double kSeat_m = -0.182;
  constexpr double kSeatSlope = kRailInclination;
  const double seat_y_m = RailFootMiddle_m().x();
  const double outer_m = 0.91;
  const double inner_m = 0.60;
  std::vector<SleeperStation> half = {
      {-kSleeperHalfLength_m, -0.205, 0.075, 0.150},
      {-1.08, -0.162, 0.095, 0.150},
      {-0.96, -0.162, 0.095, 0.150},
      {-outer_m, kSeat_m + (outer_m - seat_y_m) * kSeatSlope, 0.090, 0.150},
      {-inner_m, kSeat_m + (inner_m - seat_y_m) * kSeatSlope, 0.090, 0.145},
  };
  half.push_back({-0.45, -0.221, 0.080, 0.110});
  for (SleeperStation& station : half) station.y_m -= shift_m;
  std::vector<SleeperStation> stations = half;
  for (auto station = half.rbegin(); station != half.rend(); ++station) {
    stations.push_back(*station);
    stations.back().y_m = -station->y_m;
  }
  return stations;
}

/// One rail seat; `side` is +1 for the left rail. Shapes are given on the canted seat: across
/// (outwards from the middle of the rail foot) and up (from its underside).
class RailSeat {
 public:
  RailSeat(double side, double shift_m, Mesh& mesh) : side_(side), shift_m_(shift_m), mesh_(mesh) {}

  void Add(const Outline& across_up_m, double half_width_m) {
    const Eigen::Vector2d foot_m = RailFootMiddle_m();
    const double angle_rad = std::atan(kRailInclination);
    Outline outline_m;
    for (const Eigen::Vector2d& point : across_up_m) {
      const double y_m =
          foot_m.x() + shift_m_ + point.x() * std::cos(angle_rad) - point.y() * std::sin(angle_rad);
      const double z_m =
          foot_m.y() + point.x() * std::sin(angle_rad) + point.y() * std::cos(angle_rad);
      outline_m.emplace_back(side_ * y_m, z_m);
    }
    mesh_.Append(MakeExtrusion(outline_m, -half_width_m, half_width_m));
  }

  /// Adds guide plate, clamp and screw on both sides of the foot, 0.1 m high (docs/physics.md 7.1).
  void AddFastenings(double below_foot_m) {
    for (const double out : {-1.0, 1.0}) {
      const auto at = [&](double across_m, double up_m) {
        return Eigen::Vector2d(out * across_m, up_m);
      };
      Add({at(0.076, -below_foot_m - 0.005), at(0.180, -below_foot_m - 0.005), at(0.165, 0.020),
           at(0.076, 0.020)},
          0.070);
      Add({at(0.052, 0.0125), at(0.150, 0.015), at(0.140, 0.048), at(0.062, 0.028)}, 0.045);
      Add({at(0.094, 0.020), at(0.130, 0.020), at(0.128, 0.100 - below_foot_m),
           at(0.096, 0.100 - below_foot_m)},
          0.017);
    }
  }

 private:
  double side_;
  double shift_m_;
  Mesh& mesh_;
};

}  // namespace

Model MakeConcreteSleeper(const RailSurfaces& surfaces, double shift_m) {
  constexpr double kPad_m = 0.010;
  Model model{.name = "concrete_sleeper", .parts = {}};
  MeshOf(surfaces.sleeper_concrete, model) =
      MakeSleeperLoft(ConcreteStations(shift_m), kConcreteUnderside_m);
  for (const double side : {-1.0, 1.0}) {
    RailSeat seat(side, shift_m, MeshOf(surfaces.fastening, model));
    seat.Add({{-0.074, -kPad_m - 0.002}, {0.074, -kPad_m - 0.002}, {0.074, 0.0}, {-0.074, 0.0}},
             0.090);
    seat.AddFastenings(kPad_m);
  }
  return model;
}

Model MakeWoodSleeper(const RailSurfaces& surfaces, double shift_m) {
  const double top_m = SeatOf(SleeperType::kWood).top_m;
  constexpr double kHeight_m = 0.160;
  constexpr double kHalfWidth_m = 0.130;
  constexpr double kPlate_m = 0.018;
  Model model{.name = "wood_sleeper", .parts = {}};
  MeshOf(surfaces.sleeper_wood, model) =
      MakeBox({Vector3(-kHalfWidth_m, -kSleeperHalfLength_m - shift_m, top_m - kHeight_m),
               Vector3(kHalfWidth_m, kSleeperHalfLength_m + shift_m, top_m)});
  for (const double side : {-1.0, 1.0}) {
    RailSeat seat(side, shift_m, MeshOf(surfaces.fastening, model));
    // The lower edge extends into the wood, so that the canted plate leaves no gap.
    seat.Add({{-0.180, -kPlate_m - 0.005}, {0.180, -kPlate_m - 0.005}, {0.180, 0.0}, {-0.180, 0.0}},
             0.080);
    seat.AddFastenings(kPlate_m);
  }
  return model;
}

Model MakeBearer(SleeperType sleeper, double length_m, const RailSurfaces& surfaces) {
  const bool is_concrete = sleeper == SleeperType::kConcrete;
  const double half_width_m = is_concrete ? 0.150 : 0.130;
  const double height_m = is_concrete ? 0.220 : 0.160;
  const double top_m = SeatOf(sleeper).top_m;
  Model model{.name = "bearer", .parts = {}};
  MeshOf(is_concrete ? surfaces.sleeper_concrete : surfaces.sleeper_wood, model) =
      MakeBox({Vector3(-half_width_m, -0.5 * length_m, top_m - height_m),
               Vector3(half_width_m, 0.5 * length_m, top_m)});
  return model;
}

Model MakeRailPlate(SleeperType sleeper, const RailSurfaces& surfaces) {
  constexpr double kPlateHalfLength_m = 0.080;
  constexpr double kPlateHalfWidth_m = 0.180;
  const double top_m = -kRailHeight_m;
  Model model{.name = "rail_plate", .parts = {}};
  Mesh& mesh = MeshOf(surfaces.fastening, model);
  mesh.Append(MakeBox({Vector3(-kPlateHalfLength_m, -kPlateHalfWidth_m, SeatOf(sleeper).top_m),
                       Vector3(kPlateHalfLength_m, kPlateHalfWidth_m, top_m)}));
  for (const double side : {-1.0, 1.0}) {
    const std::array<double, 2> across_m = {side * 0.080, side * 0.150};
    mesh.Append(MakeBox({Vector3(-0.045, std::min(across_m[0], across_m[1]), top_m),
                         Vector3(0.045, std::max(across_m[0], across_m[1]), top_m + 0.060)}));
  }
  return model;
}

Model MakePointMachine(const RailSurfaces& surfaces) {
  Model model{.name = "point_machine", .parts = {}};
  MeshOf(surfaces.turnouts.point_machine, model) =
      MakeBox({Vector3(-0.475, -0.250, -0.400), Vector3(0.475, 0.250, -0.050)});
  return model;
}

TrackModels MakeTrackModels(const AlignmentSpec& line, const RailSurfaces& surfaces) {
  const auto shared = [](Model model) { return std::make_shared<const Model>(std::move(model)); };
  TrackModels models;
  const double shift_m = RailShift_m(line);
  models.concrete_sleeper = shared(MakeConcreteSleeper(surfaces, shift_m));
  models.wood_sleeper = shared(MakeWoodSleeper(surfaces, shift_m));
  for (int i = 0; kShortestBearer_m + kBearerStep_m * i < kLongestBearer_m; ++i) {
    const double length_m = kShortestBearer_m + kBearerStep_m * i;
    models.concrete_bearers.push_back(
        shared(MakeBearer(SleeperType::kConcrete, length_m, surfaces)));
    models.wood_bearers.push_back(shared(MakeBearer(SleeperType::kWood, length_m, surfaces)));
  }
  models.concrete_plate = shared(MakeRailPlate(SleeperType::kConcrete, surfaces));
  models.wood_plate = shared(MakeRailPlate(SleeperType::kWood, surfaces));
  models.point_machine = shared(MakePointMachine(surfaces));
  return models;
}

}  // namespace railcast
