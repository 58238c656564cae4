#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/structures/building_model.h"
#include "core/rail/structures/lineside_placing.h"
#include "core/rail/structures/structure_types.h"

namespace railcast {
namespace {

constexpr double kLeastArea_m2 = 1.0;
constexpr std::size_t kMostCorners = 200;

using FootprintCorner = std::array<double, 2>;

double TurnAt(const FootprintCorner& a, const FootprintCorner& b, const FootprintCorner& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double FootprintArea_m2(const std::vector<FootprintCorner>& corners) {
  double twice_m2 = 0.0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    twice_m2 += TurnAt(corners[0], corners[i], corners[i + 1]);
  }
  return 0.5 * std::abs(twice_m2);
}

/// Whether two of its sides that are not neighbours meet.
bool MeetsItself(const std::vector<FootprintCorner>& corners) {
  const std::size_t count = corners.size();
  const auto at = [&](std::size_t i) -> const FootprintCorner& { return corners[i % count]; };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 2; j < count; ++j) {
      if (i == 0 && j + 1 == count) continue;
      const bool parts =
          TurnAt(at(i), at(i + 1), at(j)) * TurnAt(at(i), at(i + 1), at(j + 1)) <= 0.0;
      const bool meets =
          TurnAt(at(j), at(j + 1), at(i)) * TurnAt(at(j), at(j + 1), at(i + 1)) <= 0.0;
      if (parts && meets) return true;
    }
  }
  return false;
}

double MiddleOf_m(const BuildingSpec& building) {
  double sum_m = 0.0;
  for (const FootprintCorner& corner : building.footprint_m) sum_m += corner[0];
  return sum_m / static_cast<double>(building.footprint_m.size());
}

}  // namespace

void AddStructure(const ChunkContext& context, const BuildingSpec& building, Chunk& chunk) {
  const StructureTrack track(context, building.track);
  if (!track.Holds(MiddleOf_m(building))) return;
  BuildingShape shape{.footprint_m = {},
                      .eaves_m = building.height_m,
                      .gable_pitch_rad = {},
                      .has_windows = building.has_windows};
  if (building.roof == RoofKind::kGable) {
    shape.gable_pitch_rad = RadFromDeg(building.roof_pitch_deg);
  }
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const auto& [s_m, d_m] : building.footprint_m) {
    const Vector3 corner_m = GroundPoint(context, s_m, track.offset_m(s_m) + d_m);
    shape.footprint_m.emplace_back(corner_m.head<2>());
    lowest_m = std::min(lowest_m, corner_m.z());
  }
  const Transform chunk_from_building =
      MakeTransform(Eigen::Matrix3d::Identity(), {0.0, 0.0, lowest_m});
  AppendModel(MakeBuilding(shape, context.surfaces.structures.lineside), chunk_from_building,
              chunk);
}

std::vector<ClearedArea> ClearedBy(const BuildingSpec& building) {
  // The rectangle about the footprint: nothing grows in the corners of courts.
  Eigen::AlignedBox2d box;
  for (const auto& [s_m, d_m] : building.footprint_m) box.extend(Eigen::Vector2d(s_m, d_m));
  return ClearedAround({.begin_s_m = box.min().x(),
                        .end_s_m = box.max().x(),
                        .right_m = box.min().y(),
                        .left_m = box.max().y(),
                        .cleared = {}});
}

void CheckShape(const StructurePlace& place, const BuildingSpec& building, WorldFaults& faults) {
  const std::string pointer = place.pointer + "/footprint_m";
  if (!faults.AreKnown({pointer})) return;
  const std::vector<FootprintCorner>& corners = building.footprint_m;
  if (corners.size() < 3) {
    faults.Add(pointer, "must have at least 3 corners", NumberText(corners.size()));
  } else if (building.roof == RoofKind::kGable && corners.size() != 4) {
    faults.Add(pointer, "must have four corners under a gable roof", NumberText(corners.size()));
  } else if (corners.size() > kMostCorners) {
    faults.Add(pointer, "must have at most " + NumberText(kMostCorners) + " corners",
               NumberText(corners.size()));
  } else if (MeetsItself(corners)) {
    faults.Add(pointer, "must not meet itself");
  } else if (FootprintArea_m2(corners) < kLeastArea_m2) {
    faults.Add(pointer, "must have an area of at least " + NumberText(kLeastArea_m2) + " m2",
               NumberText(FootprintArea_m2(corners)));
  }
}

}  // namespace railcast
