#include "core/rail/structures/lineside_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structures.h"
#include "core/scene/polygon.h"

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

using FootprintPoint = Eigen::Vector2d;

constexpr double kBuildingFoot_m = -1.0;
constexpr double kPaneProud_m = 0.02;

std::vector<FootprintPoint> LeftTurning(std::vector<FootprintPoint> corners_m) {
  if (TwiceAreaOf(corners_m) < 0.0) std::reverse(corners_m.begin(), corners_m.end());
  return corners_m;
}

/// Adds a polygon whose corners turn left seen from outside.
void AddFace(std::initializer_list<Vector3> corners_m, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3& corner : corners_m) mesh.vertices.emplace_back(corner.cast<float>());
  for (std::uint32_t i = 1; i + 1 < corners_m.size(); ++i) {
    mesh.triangles.push_back({first, first + i, first + i + 1});
  }
}

Vector3 At(const FootprintPoint& point, double z_m) {
  return {point.x(), point.y(), z_m};
}

/// One wall in plan; the outside is on its right.
struct Wall {
  FootprintPoint begin_m;
  FootprintPoint end_m;

  [[nodiscard]] double length_m() const { return (end_m - begin_m).norm(); }
};

std::vector<Wall> WallsOf(const std::vector<FootprintPoint>& corners_m) {
  std::vector<Wall> walls;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    walls.push_back({corners_m[i], corners_m[(i + 1) % corners_m.size()]});
  }
  return walls;
}

int NumWindowsOn(const Wall& wall, double spacing_m) {
  constexpr double kCorner_m = 0.8;  // Between a window and the end of its wall.
  const double room_m = wall.length_m() - 2.0 * kCorner_m - kWindowWidth_m;
  return room_m < 0.0 ? 0 : 1 + static_cast<int>(room_m / spacing_m);
}

/// The least spacing, doubled until there are few enough windows.
double WindowSpacing_m(const std::vector<Wall>& walls, int num_storeys) {
  for (double spacing_m = kWindowSpacing_m;; spacing_m *= 2.0) {
    std::size_t count = 0;
    for (const Wall& wall : walls) {
      count += static_cast<std::size_t>(NumWindowsOn(wall, spacing_m) * num_storeys);
    }
    if (count <= std::max(kMostWindows, walls.size() * static_cast<std::size_t>(num_storeys))) {
      return spacing_m;
    }
  }
}

void AddWindows(const std::vector<Wall>& walls, double eaves_m, Mesh& glass) {
  const int num_storeys = static_cast<int>(eaves_m / kStorey_m);
  const double spacing_m = WindowSpacing_m(walls, num_storeys);
  for (const Wall& wall : walls) {
    const FootprintPoint along = (wall.end_m - wall.begin_m).normalized();
    const FootprintPoint outwards(along.y(), -along.x());
    const int count = NumWindowsOn(wall, spacing_m);
    for (int i = 0; i < count; ++i) {
      const FootprintPoint middle_m =
          wall.begin_m + along * (wall.length_m() * (i + 0.5) / count) + kPaneProud_m * outwards;
      const FootprintPoint half_m = 0.5 * kWindowWidth_m * along;
      for (int storey = 0; storey < num_storeys; ++storey) {
        const double sill_m = storey * kStorey_m + kWindowSill_m;
        const double top_m = sill_m + kWindowHeight_m;
        AddFace({At(middle_m - half_m, sill_m), At(middle_m + half_m, sill_m),
                 At(middle_m + half_m, top_m), At(middle_m - half_m, top_m)},
                glass);
      }
    }
  }
}

void AddFlatRoof(const std::vector<FootprintPoint>& corners_m, double eaves_m, Mesh& roof) {
  const auto first = static_cast<std::uint32_t>(roof.vertices.size());
  for (const FootprintPoint& corner : corners_m) {
    roof.vertices.emplace_back(At(corner, eaves_m).cast<float>());
  }
  for (const auto& [a, b, c] : TriangulatePolygon(corners_m)) {
    roof.triangles.push_back({first + a, first + b, first + c});
  }
}

/// The four corners, beginning with a longer side.
std::array<FootprintPoint, 4> FromALongSide(const std::vector<FootprintPoint>& corners_m) {
  Check(corners_m.size() == 4, "a gable roof covers four corners");
  const double first_m =
      (corners_m[1] - corners_m[0]).norm() + (corners_m[3] - corners_m[2]).norm();
  const double other_m =
      (corners_m[2] - corners_m[1]).norm() + (corners_m[0] - corners_m[3]).norm();
  const std::size_t turn = first_m >= other_m ? 0 : 1;
  std::array<FootprintPoint, 4> turned;
  for (std::size_t i = 0; i < 4; ++i) turned[i] = corners_m[(i + turn) % 4];
  return turned;
}

void AddGableRoof(const std::array<FootprintPoint, 4>& corners_m,
                  double eaves_m,
                  double ridge_m,
                  const LinesideSurfaces& surfaces,
                  Model& model) {
  const auto eaves = [&](std::size_t i) { return At(corners_m[i], eaves_m); };
  const Vector3 ahead_m = At(0.5 * (corners_m[1] + corners_m[2]), ridge_m);
  const Vector3 back_m = At(0.5 * (corners_m[3] + corners_m[0]), ridge_m);
  Mesh& roof = MeshOf(surfaces.tiled_roof, model);
  AddFace({eaves(0), eaves(1), ahead_m, back_m}, roof);
  AddFace({eaves(2), eaves(3), back_m, ahead_m}, roof);
  Mesh& wall = MeshOf(surfaces.wall, model);
  AddFace({eaves(1), eaves(2), ahead_m}, wall);
  AddFace({eaves(3), eaves(0), back_m}, wall);
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
              chunk.ground);
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
    faults.Add(pointer, "must have an area of at least " + NumberText(kLeastArea_m2) + " m²",
               NumberText(FootprintArea_m2(corners)));
  }
}

double RidgeRise_m(const BuildingShape& shape) {
  if (!shape.gable_pitch_rad) return 0.0;
  const auto corners_m = FromALongSide(LeftTurning(shape.footprint_m));
  const double width_m =
      0.5 * ((corners_m[2] - corners_m[1]).norm() + (corners_m[0] - corners_m[3]).norm());
  return 0.5 * width_m * std::tan(*shape.gable_pitch_rad);
}

Model MakeBuilding(const BuildingShape& shape, const LinesideSurfaces& surfaces) {
  const std::vector<FootprintPoint> corners_m = LeftTurning(shape.footprint_m);
  const std::vector<Wall> walls = WallsOf(corners_m);
  Model model{.name = "building", .parts = {}};
  Mesh& masonry = MeshOf(surfaces.wall, model);
  for (const Wall& wall : walls) {
    AddFace({At(wall.begin_m, kBuildingFoot_m), At(wall.end_m, kBuildingFoot_m),
             At(wall.end_m, shape.eaves_m), At(wall.begin_m, shape.eaves_m)},
            masonry);
  }
  if (shape.gable_pitch_rad) {
    AddGableRoof(FromALongSide(corners_m), shape.eaves_m, shape.eaves_m + RidgeRise_m(shape),
                 surfaces, model);
  } else {
    AddFlatRoof(corners_m, shape.eaves_m, MeshOf(surfaces.flat_roof, model));
  }
  if (shape.has_windows && shape.eaves_m >= kStorey_m) {
    AddWindows(walls, shape.eaves_m, MeshOf(surfaces.window, model));
  }
  return model;
}

}  // namespace railcast
