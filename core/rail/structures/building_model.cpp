#include "core/rail/structures/building_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/rail/base/model_parts.h"
#include "core/scene/polygon.h"

namespace railcast {
namespace {

using FootprintPoint = Eigen::Vector2d;

constexpr double kBuildingFoot_m = -1.0;
constexpr double kPaneProud_m = 0.02;

std::vector<FootprintPoint> LeftTurning(std::vector<FootprintPoint> corners_m) {
  double twice_area_m2 = 0.0;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    const FootprintPoint& a = corners_m[i];
    const FootprintPoint& b = corners_m[(i + 1) % corners_m.size()];
    twice_area_m2 += a.x() * b.y() - a.y() * b.x();
  }
  if (twice_area_m2 < 0.0) std::reverse(corners_m.begin(), corners_m.end());
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
