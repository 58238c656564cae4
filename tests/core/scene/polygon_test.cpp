#include "core/scene/polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

double Area(const Outline& outline) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

/// The sum of the areas of the triangles, all of which must turn like the outline.
double CutArea(const Outline& outline) {
  double sum = 0.0;
  for (const auto& triangle : TriangulatePolygon(outline)) {
    EXPECT_GT(TriangleArea(outline, triangle) * Area(outline), 0.0);
    sum += TriangleArea(outline, triangle);
  }
  return sum;
}

/// An outline begun at another corner, and the other way round.
Outline Begun(Outline outline, std::size_t first, bool reversed) {
  std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
  if (reversed) std::reverse(outline.begin(), outline.end());
  return outline;
}

void ExpectArea(const Outline& outline, double area) {
  for (std::size_t first = 0; first < outline.size(); ++first) {
    EXPECT_NEAR(CutArea(Begun(outline, first, false)), area, 1e-12) << "from corner " << first;
    EXPECT_NEAR(CutArea(Begun(outline, first, true)), -area, 1e-12) << "from corner " << first;
  }
}

// Ways between outline and window that meet nothing else, of which some pass along its sides.
TEST(TriangulatePolygon, KeepsTheAreaOfAPlateWithAWindowFromAnyCorner) {
  const Outline plate = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
  const Outline window = {{1, 1}, {1, 2}, {3, 2}, {3, 1}};  // The other way round.
  const std::array<std::array<std::size_t, 2>, 12> ways = {{{0, 0},
                                                            {0, 1},
                                                            {0, 3},
                                                            {1, 0},
                                                            {1, 2},
                                                            {1, 3},
                                                            {2, 1},
                                                            {2, 2},
                                                            {2, 3},
                                                            {3, 0},
                                                            {3, 1},
                                                            {3, 2}}};
  for (const auto& [from, to] : ways) {
    Outline outline = Begun(plate, from, false);
    outline.push_back(outline.front());
    const Outline hole = Begun(window, to, false);
    outline.insert(outline.end(), hole.begin(), hole.end());
    outline.push_back(hole.front());
    SCOPED_TRACE(testing::Message() << "from " << from << " to " << to);
    ExpectArea(outline, 10.0);
  }
}

TEST(TriangulatePolygon, KeepsTheAreaOfAPlateWithTwoWindows) {
  // From the first corner to both windows, and from one window on to the other.
  ExpectArea({{0, 0},
              {9, 0},
              {9, 3},
              {0, 3},
              {0, 0},
              {1, 1},
              {1, 2},
              {4, 2},
              {4, 1},
              {1, 1},
              {0, 0},
              {5, 1},
              {5, 2},
              {8, 2},
              {8, 1},
              {5, 1}},
             21.0);
  ExpectArea({{0, 0},
              {9, 0},
              {9, 3},
              {0, 3},
              {0, 0},
              {1, 1},
              {1, 2},
              {4, 2},
              {5, 2},
              {8, 2},
              {8, 1},
              {5, 1},
              {5, 2},
              {4, 2},
              {4, 1},
              {1, 1}},
             21.0);
}

TEST(TriangulatePolygon, KeepsTheAreaOfARing) {
  for (const int sides : {3, 5, 16, 64}) {
    Outline ring;
    const auto turn = [&](double radius, int sign) {
      for (int i = 0; i <= sides; ++i) {
        const double angle_rad = sign * 2.0 * std::numbers::pi * (i % sides) / sides;
        ring.emplace_back(radius * std::cos(angle_rad), radius * std::sin(angle_rad));
      }
    };
    turn(2.0, 1);
    turn(1.5, -1);
    const double angle_rad = 2.0 * std::numbers::pi / sides;
    ExpectArea(ring, 0.5 * sides * std::sin(angle_rad) * (4.0 - 2.25));
  }
}

/// A random outline without crossings: corners at rising angles about the middle, or, as steps of
/// whole numbers, with many corners on lines through others.
Outline RandomOutline(std::mt19937& random) {
  const int num = std::uniform_int_distribution(3, 40)(random);
  const bool is_whole = std::bernoulli_distribution(0.5)(random);
  Outline outline;
  if (!is_whole) {
    std::uniform_real_distribution<double> radius(0.01, 1.0);
    for (int i = 0; i < num; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / num;
      outline.emplace_back(Eigen::Rotation2Dd(angle_rad) * Eigen::Vector2d(radius(random), 0.0));
    }
    return outline;
  }
  // A skyline over a line of towers from below.
  std::uniform_int_distribution<int> height(1, 5);
  for (int i = 0; i < num; ++i) {
    const double below = -height(random);
    outline.emplace_back(i, below);
    outline.emplace_back(i + 1, below);
  }
  for (int i = num; i > 0; --i) {
    const double above = height(random);
    outline.emplace_back(i, above);
    outline.emplace_back(i - 1, above);
  }
  return outline;
}

/// A small square hole about a point within the outline, reached from the corner that is nearest.
Outline WithHole(const Outline& outline, const Eigen::Vector2d& middle, double half) {
  std::size_t from = 0;
  for (std::size_t i = 1; i < outline.size(); ++i) {
    if ((outline[i] - middle).norm() < (outline[from] - middle).norm()) from = i;
  }
  Outline result = Begun(outline, from, false);
  result.push_back(result.front());
  Outline hole = {{-half, -half}, {-half, half}, {half, half}, {half, -half}};
  for (Eigen::Vector2d& corner : hole) corner += middle;
  std::size_t to = 0;
  for (std::size_t i = 1; i < hole.size(); ++i) {
    if ((hole[i] - outline[from]).norm() < (hole[to] - outline[from]).norm()) to = i;
  }
  hole = Begun(hole, to, false);
  result.insert(result.end(), hole.begin(), hole.end());
  result.push_back(hole.front());
  return result;
}

TEST(TriangulatePolygon, KeepsTheAreaOfRandomOutlines) {
  std::mt19937 random(7);
  for (int i = 0; i < 1000; ++i) {
    Outline outline = RandomOutline(random);
    // The middle of the outlines about it, and of a tower, is at least half that far from any edge.
    const bool is_whole = outline[0].x() == std::round(outline[0].x()) && outline.size() % 4 == 0 &&
                          outline[0].y() < 0.0;
    if (is_whole) outline = WithHole(outline, {0.5, 0.25}, 0.125);
    EXPECT_NEAR(CutArea(outline), Area(outline), 1e-12 * static_cast<double>(outline.size()))
        << "outline " << i;
  }
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
