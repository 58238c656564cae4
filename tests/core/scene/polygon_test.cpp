#include "core/scene/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

double TriangleArea(const Outline& outline, const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector2d b = outline[triangle[1]] - outline[triangle[0]];
  const Eigen::Vector2d c = outline[triangle[2]] - outline[triangle[0]];
  return 0.5 * (b.x() * c.y() - b.y() * c.x());
}

TEST(TriangulatePolygon, CutsAStarIntoLeftTurningTrianglesOfItsArea) {
  Outline star;
  for (int i = 0; i < 10; ++i) {
    const double radius = i % 2 == 0 ? 1.0 : 0.4;
    const double angle_rad = std::numbers::pi * i / 5.0;
    star.emplace_back(radius * std::cos(angle_rad), radius * std::sin(angle_rad));
  }
  const auto triangles = TriangulatePolygon(star);
  ASSERT_EQ(triangles.size(), 8U);
  double sum = 0.0;
  for (const auto& triangle : triangles) {
    EXPECT_GT(TriangleArea(star, triangle), 0.0);
    sum += TriangleArea(star, triangle);
  }
  // Ten triangles about the centre with sides 1 and 0.4, 36 degrees apart.
  EXPECT_NEAR(sum, 10.0 * 0.5 * 0.4 * std::sin(std::numbers::pi / 5.0), 1e-12);
}

TEST(TriangulatePolygon, KeepsCornersOnEdgesAndLeavesOutRepeatedOnes) {
  const Outline square = {{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}};
  const auto triangles = TriangulatePolygon(square);
  ASSERT_EQ(triangles.size(), 4U);
  double sum = 0.0;
  for (const auto& triangle : triangles) {
    EXPECT_GT(TriangleArea(square, triangle), 0.0);
    sum += TriangleArea(square, triangle);
  }
  EXPECT_DOUBLE_EQ(sum, 4.0);
}

TEST(ClipEars, GivesTwoTrianglesFewerThanCornersWhateverTheirArea) {
  const Outline square = {{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}};
  EXPECT_EQ(ClipEars(square).size(), 5U);
  EXPECT_EQ(ClipEars(Outline{{0, 0}, {1, 1}, {2, 2}, {3, 3}}).size(), 2U);
}

TEST(TriangulatePolygon, HasNothingToCutInALine) {
  EXPECT_TRUE(TriangulatePolygon(Outline{{0, 0}, {1, 1}, {2, 2}, {3, 3}}).empty());
}

TEST(TriangulatePolygon, EndsOnAnOutlineThatCrossesItself) {
  const Outline bow_tie = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_LE(TriangulatePolygon(bow_tie).size(), 2U);
}

}  // namespace
}  // namespace railcast
