#include "core/rail/chunk/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace railcast {
namespace {

using testing::ElementsAre;

/// A level grid of `num_rows` by 7 points a metre apart, with columns 0, 3, 4 and 6 within.
Mesh LevelGrid(std::size_t num_rows, std::size_t num_hidden_columns = 0) {
  return MeshOfCoarseGrid(
      {num_rows, 7, {0, 3, 4, 6}}, [&](std::size_t row, std::size_t column) -> GridPoint {
        return {Vector3(static_cast<double>(row), static_cast<double>(column), 0.0),
                column >= num_hidden_columns};
      });
}

TEST(MeshOfCoarseGrid, HasAllColumnsInItsFirstAndLastRowAndSomeBetween) {
  std::map<float, std::vector<float>> columns;
  for (const Eigen::Vector3f& vertex : LevelGrid(4).vertices) {
    columns[vertex.x()].push_back(vertex.y());
  }
  EXPECT_THAT(columns[0.0F], testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(columns[1.0F], testing::UnorderedElementsAre(0, 3, 4, 6));
  EXPECT_THAT(columns[2.0F], testing::UnorderedElementsAre(0, 3, 4, 6));
  EXPECT_THAT(columns[3.0F], testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6));
}

TEST(MeshOfCoarseGrid, CoversItsAreaOnceAndFacesUp) {
  for (const std::size_t num_rows : {3U, 4U, 9U}) {
    const Mesh mesh = LevelGrid(num_rows);
    double area_m2 = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3f normal =
          (mesh.vertices[b] - mesh.vertices[a])
              .cross(Eigen::Vector3f(mesh.vertices[c] - mesh.vertices[a]));
      EXPECT_GT(normal.z(), 0.0F);
      area_m2 += 0.5 * static_cast<double>(normal.z());
    }
    EXPECT_DOUBLE_EQ(area_m2, 6.0 * static_cast<double>(num_rows - 1));
  }
}

TEST(MeshOfCoarseGrid, JoinsItsTrianglesAtTheirEdges) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> num_sides;
  const Mesh mesh = LevelGrid(5);
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      ++num_sides[std::minmax(triangle[k], triangle[(k + 1) % 3])];
  }
  // Six edges at either end, and four at either side.
  const auto is_alone = [](const auto& edge) { return edge.second == 1; };
  EXPECT_EQ(std::count_if(num_sides.begin(), num_sides.end(), is_alone), 6 + 6 + 4 + 4);
  for (const auto& [edge, num] : num_sides) EXPECT_LE(num, 2);
}

TEST(MeshOfCoarseGrid, LeavesOutTheCellsOfWhichNothingShows) {
  EXPECT_EQ(LevelGrid(4, 3).triangles.size(), LevelGrid(4).triangles.size());
  // The first cell has three points in either edge row beside the corner that shows.
  EXPECT_EQ(LevelGrid(4, 4).triangles.size(), LevelGrid(4).triangles.size() - 4 - 2 - 4);
}

TEST(ColumnsAlong, AreAsFarApartAsTheyMayBe) {
  const std::vector<double> places_m = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_THAT(ColumnsAlong(places_m, {}, 0.0, [](double) { return 3.0; }), ElementsAre(0, 3, 6, 8));
  EXPECT_THAT(ColumnsAlong(places_m, {}, 0.0, [](double d_m) { return d_m < 3.0 ? 0.0 : 2.0; }),
              ElementsAre(0, 1, 2, 3, 5, 7, 8));
}

TEST(ColumnsAlong, FollowEveryProfileWithinTheTolerance) {
  const std::vector<double> places_m = {0, 1, 2, 3, 4, 5, 6};
  const std::vector<std::vector<double>> profiles_m = {{0, 0, 0, 1, 2, 3, 4},
                                                       {0, 0, 0, 0, 0, 0.01, 0}};
  const auto any_width = [](double) { return 100.0; };
  EXPECT_THAT(ColumnsAlong(places_m, profiles_m, 0.02, any_width), ElementsAre(0, 2, 6));
  EXPECT_THAT(ColumnsAlong(places_m, profiles_m, 1e-3, any_width), ElementsAre(0, 2, 4, 5, 6));
}

}  // namespace
}  // namespace railcast
