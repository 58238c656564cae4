#include "core/rail/structures/lineside_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/rail/model_checks.h"

namespace railcast {
namespace {

constexpr double kBuildingRounding_m = 1e-6;  // Half a unit in the last place at 10 m.

LinesideSurfaces FourSurfaces() {
  LinesideSurfaces surfaces;
  surfaces.wall.material = 1;
  surfaces.flat_roof.material = 2;
  surfaces.tiled_roof.material = 3;
  surfaces.window.material = 4;
  return surfaces;
}

/// 12 x 8 m.
const std::vector<Eigen::Vector2d> kOblong_m = {{-6, -4}, {6, -4}, {6, 4}, {-6, 4}};
/// An L of 12 x 8 m whose corner of 6 x 4 m is missing.
const std::vector<Eigen::Vector2d> kAngle_m = {{-6, -4}, {6, -4}, {6, 0}, {0, 0}, {0, 4}, {-6, 4}};

double Area_m2(const Model& model, const SurfaceClass& surface) {
  double area_m2 = 0.0;
  for (const Part& part : model.parts) {
    if (part.material != surface.material) continue;
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const auto& v = part.mesh.vertices;
      area_m2 += 0.5 * static_cast<double>((v[b] - v[a]).cross(v[c] - v[a]).norm());
    }
  }
  return area_m2;
}

/// Volume within the closed surface of walls, gables and roof, with the floor 1 m below the ground.
double Volume_m3(const Model& model, const LinesideSurfaces& surfaces) {
  double volume_m3 = 0.0;
  const Eigen::Vector3d floor(0, 0, -1.0);  // The missing floor adds nothing seen from here.
  for (const Part& part : model.parts) {
    if (part.material == surfaces.window.material) continue;
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const auto p = [&](std::uint32_t i) -> Eigen::Vector3d {
        return part.mesh.vertices[i].cast<double>() - floor;
      };
      volume_m3 += p(a).dot(p(b).cross(p(c))) / 6.0;
    }
  }
  return volume_m3;
}

TEST(BuildingModel, StandsOnItsFootprintWithAFlatRoof) {
  const LinesideSurfaces surfaces = FourSurfaces();
  const Model building = MakeBuilding({kAngle_m, 6.5, {}, false}, surfaces);
  EXPECT_EQ(CountBadTriangles(building), 0U);
  EXPECT_EQ(building.num_triangles(), 2U * 6U + 4U);
  EXPECT_NEAR(Area_m2(building, surfaces.flat_roof), 72.0, 1e-4);
  EXPECT_NEAR(Area_m2(building, surfaces.wall), 40.0 * 7.5, 1e-4);
  EXPECT_NEAR(Volume_m3(building, surfaces), 72.0 * 7.5, 1e-3);
}

TEST(BuildingModel, CarriesAGableRoofAlongItsLongerSide) {
  const LinesideSurfaces surfaces = FourSurfaces();
  for (const std::vector<Eigen::Vector2d>& corners_m :
       {kOblong_m, std::vector<Eigen::Vector2d>{{-4, -6}, {4, -6}, {4, 6}, {-4, 6}}}) {
    const BuildingShape shape{corners_m, 4.0, 0.25 * std::numbers::pi, false};
    const Model building = MakeBuilding(shape, surfaces);
    EXPECT_NEAR(RidgeRise_m(shape), 4.0, 1e-12);
    EXPECT_NEAR(building.Bounds().max().z(), 8.0, kBuildingRounding_m);
    EXPECT_NEAR(Area_m2(building, surfaces.tiled_roof), 2.0 * 12.0 * 4.0 * std::sqrt(2.0), 1e-4);
    EXPECT_NEAR(Volume_m3(building, surfaces), 96.0 * 5.0 + 12.0 * 16.0, 1e-3);
  }
}

TEST(BuildingModel, TurnsItsFacesOutwardsWhicheverWayTheCornersRun) {
  const LinesideSurfaces surfaces = FourSurfaces();
  const std::vector<Eigen::Vector2d> backwards_m(kAngle_m.rbegin(), kAngle_m.rend());
  EXPECT_NEAR(Volume_m3(MakeBuilding({backwards_m, 6.5, {}, false}, surfaces), surfaces),
              72.0 * 7.5, 1e-3);
}

TEST(BuildingModel, HasWindowsOfGlassInEveryStoreyOutsideItsWalls) {
  const LinesideSurfaces surfaces = FourSurfaces();
  const Model building = MakeBuilding({kOblong_m, 6.5, {}, true}, surfaces);
  // 12 m have room for 1 + floor((12 - 2.8) / 3) windows, 8 m for 2; two storeys.
  const double num_windows = 2.0 * 2.0 * (4.0 + 2.0);
  EXPECT_NEAR(Area_m2(building, surfaces.window), num_windows * 1.2 * 1.4, 1e-3);
  for (const Vector3& p : VerticesOf(building, surfaces.window)) {
    EXPECT_NEAR(std::max(std::abs(p.x()) - 6.0, std::abs(p.y()) - 4.0), 0.02, kBuildingRounding_m);
    EXPECT_LE(p.z(), 3.0 + 0.9 + 1.4 + kBuildingRounding_m);
  }
}

TEST(BuildingModel, KeepsToFewTrianglesHoweverLongItIs) {
  const LinesideSurfaces surfaces = FourSurfaces();
  const Model hall =
      MakeBuilding({{{0, 0}, {400, 0}, {400, 60}, {0, 60}}, 15.0, {}, true}, surfaces);
  EXPECT_GT(hall.num_triangles(), 100U);
  EXPECT_LE(hall.num_triangles(), 2U * kMostWindows + 10U);
}

TEST(BuildingModel, LeavesOutWindowsWhereNoneHasRoom) {
  const LinesideSurfaces surfaces = FourSurfaces();
  EXPECT_EQ(Area_m2(MakeBuilding({kOblong_m, 2.9, {}, true}, surfaces), surfaces.window), 0.0);
  EXPECT_EQ(Area_m2(MakeBuilding({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 4.0, {}, true}, surfaces),
                    surfaces.window),
            0.0);
}

}  // namespace
}  // namespace railcast
