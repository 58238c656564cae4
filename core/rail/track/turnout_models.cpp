#include <algorithm>
#include <array>

#include "core/rail/base/model_parts.h"
#include "core/rail/base/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/turnout_structure.h"
#include "core/scene/shapes.h"

namespace railcast {

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

}  // namespace railcast
