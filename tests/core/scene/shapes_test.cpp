#include "core/scene/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "core/scene/part_gatherer.h"

namespace railcast {
namespace {

/// Volume by the divergence theorem; positive if the normals of a closed mesh point outwards.
double Volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3 pa = mesh.vertices[a].cast<double>();
    sum += pa.dot(mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>())) / 6.0;
  }
  return sum;
}

/// Whether every edge is traversed once in each direction: closed, manifold and consistently wound.
bool IsClosed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> walks;
  for (const auto& [a, b, c] : mesh.triangles) {
    ++walks[{a, b}];
    ++walks[{b, c}];
    ++walks[{c, a}];
  }
  for (const auto& [edge, count] : walks) {
    const auto back = walks.find({edge.second, edge.first});
    if (count != 1 || back == walks.end()) return false;
  }
  return true;
}

Eigen::AlignedBox3d ShapeBounds(const Mesh& mesh) {
  return Model{.name = "", .parts = {{.mesh = mesh, .material = 0, .label = 0}}}.Bounds();
}

/// Area of the regular polygon inscribed in a circle.
double PolygonArea(double radius, int num_sides) {
  return 0.5 * num_sides * radius * radius * std::sin(2.0 * std::numbers::pi / num_sides);
}

// Volumes of a few cubic metres from float32 coordinates of a few metres: relative error of about
// 1e-6.
constexpr double kVolumeTolerance_m3 = 2e-5;

TEST(MakeBox, HasItsVolumeAndBounds) {
  const Eigen::AlignedBox3d box(Vector3(-1, 2, 3), Vector3(1, 5, 4));
  const Mesh mesh = MakeBox(box);
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_NEAR(Volume(mesh), 6.0, kVolumeTolerance_m3);
  EXPECT_TRUE(ShapeBounds(mesh).isApprox(box));
}

TEST(MakeTube, IsAPrismOfTheGivenRadius) {
  const std::vector<Vector3> line = {{0, 0, 0}, {0, 0, 2}};
  const Mesh mesh = MakeTube(line, 0.5, 8);
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_NEAR(Volume(mesh), 2.0 * PolygonArea(0.5, 8), kVolumeTolerance_m3);
}

// A mitred bend preserves section and centre line, so by Pappus the volume is section times length.
TEST(MakeTube, KeepsItsSectionThroughBends) {
  const std::vector<Vector3> line = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {2, 2, 2}};
  const Mesh mesh = MakeTube(line, 0.1, 12);
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_NEAR(Volume(mesh), (3.0 + std::sqrt(3.0)) * PolygonArea(0.1, 12), kVolumeTolerance_m3);
}

TEST(MakeTube, TapersLinearly) {
  const std::vector<Vector3> line = {{0, 0, 0}, {0, 3, 0}};
  const std::vector<double> radii_m = {1.0, 0.5};
  const Mesh mesh = MakeTube(line, radii_m, 16);
  const double frustum = (PolygonArea(1.0, 16) + PolygonArea(0.5, 16) +
                          std::sqrt(PolygonArea(1.0, 16) * PolygonArea(0.5, 16)));
  EXPECT_NEAR(Volume(mesh), frustum, kVolumeTolerance_m3);  // length 3 / 3
}

TEST(MakeTubeDeathTest, RefusesAHairpin) {
  const std::vector<Vector3> line = {{0, 0, 0}, {1, 0, 0}, {0, 0.01, 0}};
  EXPECT_DEATH((void)MakeTube(line, 0.1, 6), "a tube turns by less than 150 degrees");
}

TEST(MakeLathe, TurnsAConeAboutX) {
  const std::vector<Eigen::Vector2d> profile = {{0, 1}, {3, 0}};
  const Mesh mesh = MakeLathe(profile, 20);
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_NEAR(Volume(mesh), PolygonArea(1.0, 20), kVolumeTolerance_m3);
  EXPECT_TRUE(
      ShapeBounds(mesh).isApprox(Eigen::AlignedBox3d(Vector3(0, -1, -1), Vector3(3, 1, 1)), 1e-6));
}

TEST(MakeExtrusion, FillsANotchedOutlineWhicheverWayItTurns) {
  std::vector<Eigen::Vector2d> outline = {{0, 0}, {3, 0}, {3, 2}, {2, 2},
                                          {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int turn = 0; turn < 2; ++turn) {
    const Mesh mesh = MakeExtrusion(outline, -1.0, 3.0);
    EXPECT_TRUE(IsClosed(mesh));
    EXPECT_NEAR(Volume(mesh), 4.0 * 5.0, kVolumeTolerance_m3);
    std::reverse(outline.begin(), outline.end());
  }
}

TEST(MakeEllipsoid, FillsItsBox) {
  const Mesh mesh = MakeEllipsoid({1, 2, 3}, {0.5, 1.0, 2.0}, 40);
  EXPECT_TRUE(IsClosed(mesh));
  const Eigen::AlignedBox3d box(Vector3(0.5, 1, 1), Vector3(1.5, 3, 5));
  EXPECT_TRUE(ShapeBounds(mesh).isApprox(box, 1e-6));
  // Facets cut off at most 1 - cos(pi / 40)^3 = 0.9 % of the volume.
  const double exact = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_LT(Volume(mesh), exact);
  EXPECT_GT(Volume(mesh), 0.985 * exact);
}

constexpr std::uint32_t kRail = 1, kWagon = 2;
constexpr std::uint16_t kSteel = 5, kWood = 6;

/// A triangle in the plane x = 0.
Part Triangle(std::uint32_t label, std::uint16_t material) {
  return {Mesh{{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}}, material, label};
}

TEST(PartGatherer, MakesOnePartOfEachPairOfLabelAndMaterialInTheirOrder) {
  PartGatherer gatherer;
  gatherer.Add({"a", {Triangle(kWagon, kWood), Triangle(kRail, kSteel)}},
               Eigen::Affine3d::Identity());
  gatherer.Add({"b", {Triangle(kWagon, kSteel), Triangle(kRail, kSteel)}},
               Eigen::Affine3d::Identity());
  const std::vector<Part> parts = gatherer.TakeParts();
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].label, kRail);
  EXPECT_EQ(parts[0].material, kSteel);
  EXPECT_EQ(parts[0].mesh.triangles.size(), 2U);
  EXPECT_EQ(parts[1].label, kWagon);
  EXPECT_EQ(parts[1].material, kSteel);
  EXPECT_EQ(parts[2].material, kWood);
  EXPECT_EQ(parts[2].mesh.triangles.size(), 1U);
}

TEST(PartGatherer, PutsEveryModelWhereItStands) {
  PartGatherer gatherer;
  const Model model{"a", {Triangle(kRail, kSteel)}};
  gatherer.Add(model, Eigen::Affine3d::Identity());
  // Scaled by 2, turned on its side and moved 10 m ahead: (x, y, z) becomes (10 + 2x, -2z, 2y).
  const Eigen::Affine3d gathered_from_model =
      Eigen::Translation3d(10, 0, 0) * Eigen::AngleAxisd(RadFromDeg(90.0), Vector3::UnitX()) *
      Eigen::Scaling(2.0);
  gatherer.Add(model, gathered_from_model);
  const Mesh mesh = gatherer.TakeParts().at(0).mesh;
  ASSERT_EQ(mesh.vertices.size(), 6U);
  const Eigen::Vector3f expected[] = {{10, 0, 0}, {10, 0, 2}, {10, -2, 0}};
  const auto& [a, b, c] = mesh.triangles.at(1);
  // Approximate, because the cosine of a right angle is not exactly 0.
  EXPECT_TRUE(mesh.vertices.at(a).isApprox(expected[0]));
  EXPECT_TRUE(mesh.vertices.at(b).isApprox(expected[1]));
  EXPECT_TRUE(mesh.vertices.at(c).isApprox(expected[2]));
  EXPECT_EQ(mesh.vertices.at(mesh.triangles.at(0)[1]), Eigen::Vector3f(0, 1, 0));
}

TEST(PartGatherer, GivesWhatItTookOnlyOnce) {
  PartGatherer gatherer;
  EXPECT_TRUE(gatherer.TakeParts().empty());
  gatherer.Add({"a", {Triangle(kRail, kSteel)}}, Eigen::Affine3d::Identity());
  EXPECT_EQ(gatherer.TakeParts().size(), 1U);
  EXPECT_TRUE(gatherer.TakeParts().empty());
}

TEST(PartGatherer, LeavesOutPartsWithoutTriangles) {
  PartGatherer gatherer;
  gatherer.Add({"a", {{Mesh{}, kSteel, kRail}, Triangle(kWagon, kWood)}},
               Eigen::Affine3d::Identity());
  EXPECT_EQ(gatherer.size().num_vertices, 3U);
  EXPECT_EQ(gatherer.size().num_triangles, 1U);
  const std::vector<Part> parts = gatherer.TakeParts();
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].label, kWagon);
  EXPECT_EQ(gatherer.size().num_triangles, 0U);
}

}  // namespace
}  // namespace railcast
