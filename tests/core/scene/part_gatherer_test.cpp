#include "core/scene/part_gatherer.h"

#include <gtest/gtest.h>

#include "core/base/units.h"

namespace railcast {
namespace {

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
