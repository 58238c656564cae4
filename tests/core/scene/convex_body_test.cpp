#include "core/scene/convex_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/scene/shapes.h"
#include "railcast/scene.h"

namespace railcast {
namespace {

constexpr double kReach_m = 100.0;
// Of the descent that finds a gap.
constexpr double kBodyRounding_m = 1e-5;

ConvexBody BodyOf(const Mesh& mesh) {
  std::vector<Vector3> corners;
  for (const Eigen::Vector3f& vertex : mesh.vertices) corners.push_back(vertex.cast<double>());
  return MakeConvexBody(std::move(corners));
}

ConvexBody BoxOfSize(const Vector3& half_size_m) {
  return BodyOf(MakeBox({-half_size_m, half_size_m}));
}

const ConvexBody kCube = BoxOfSize(Vector3::Constant(0.5));

Transform At(const Vector3& place, double yaw_rad = 0.0, double pitch_rad = 0.0) {
  return MakeTransform(RotationFromYawPitchRoll(yaw_rad, pitch_rad, 0.0), place);
}

void ExpectGap(double expected_m,
               const ConvexBody& a,
               const Transform& a_from_b,
               const ConvexBody& b) {
  EXPECT_NEAR(Gap_m(a, a_from_b, b, kReach_m), expected_m, kBodyRounding_m);
  EXPECT_NEAR(Gap_m(b, a_from_b.inverse(), a, kReach_m), expected_m, kBodyRounding_m);
}

void ExpectDepth(double expected_m,
                 const ConvexBody& a,
                 const Transform& a_from_b,
                 const ConvexBody& b,
                 double tolerance_m = kBodyRounding_m) {
  EXPECT_EQ(Gap_m(a, a_from_b, b, kReach_m), 0.0);
  EXPECT_NEAR(Depth_m(a, a_from_b, b), expected_m, tolerance_m);
  EXPECT_NEAR(Depth_m(b, a_from_b.inverse(), a), expected_m, tolerance_m);
}

TEST(ConvexBody, MeasuresTheGapBetweenFacesEdgesAndCorners) {
  ExpectGap(0.25, kCube, At({1.25, 0.3, -0.2}), kCube);
  // Edge against edge, and corner against corner.
  ExpectGap(std::hypot(0.3, 0.4), kCube, At({1.3, 1.4, 0.1}), kCube);
  ExpectGap(std::sqrt(3.0), kCube, At({2.0, 2.0, 2.0}), kCube);
}

TEST(ConvexBody, MeasuresTheGapOfARotatedBox) {
  // On its edge, the cube reaches sqrt(1/2) towards the other one.
  constexpr double kEighth_rad = std::numbers::pi / 4.0;
  ExpectGap(2.0 - 0.5 - std::sqrt(0.5), kCube, At({2.0, 0.1, 0.0}, kEighth_rad), kCube);
  // Then on its corner: the plane through three neighbours of that corner is normal to the
  // diagonal, whose half is sqrt(3) / 2.
  const double tilt_rad = std::atan(std::sqrt(0.5));
  ExpectGap(2.0 - 0.5 - std::sqrt(0.75), kCube,
            At({2.0, 0.1, 0.0}, 0.0, 0.0) *
                Transform(Eigen::AngleAxisd(tilt_rad, Vector3::UnitY())) *
                Transform(Eigen::AngleAxisd(kEighth_rad, Vector3::UnitZ())),
            kCube);
}

TEST(ConvexBody, MeasuresTheGapOfCrossedBars) {
  const ConvexBody bar = BoxOfSize({5.0, 0.1, 0.1});
  ExpectGap(0.05, bar, At({1.7, 2.2, 0.25}, 1.1), bar);
}

TEST(ConvexBody, MeasuresTheGapOfTrianglesToABox) {
  // A flat body: its nearest point lies within the triangle, on its edge, at its corner.
  const ConvexBody triangle =
      MakeConvexBody({{-3.0, -3.0, 0.0}, {3.0, -3.0, 0.0}, {0.0, 3.0, 0.0}});
  ExpectGap(0.2, kCube, At({0.0, 0.0, 0.7}), triangle);
  ExpectGap(0.7, kCube, At({0.2, 4.2, 0.0}), triangle);
  ExpectGap(std::hypot(0.3, 0.4), kCube, At({0.0, -3.8, 0.9}), triangle);
}

TEST(ConvexBody, MeasuresFarFromTheBodiesOwnOrigin) {
  // A wagon's pieces lie some metres from its origin.
  const ConvexBody aside = BodyOf(MakeBox({Vector3(6.4, 0.7, 0.8), Vector3(7.0, 1.1, 1.3)}));
  ExpectGap(0.003, aside, At({14.003, 0.0, 0.0}, std::numbers::pi) * At({0.0, -1.8, 0.0}), aside);
}

TEST(ConvexBody, GivesTheReachWhereTheGapIsWider) {
  EXPECT_EQ(Gap_m(kCube, At({3.0, 0.0, 0.0}), kCube, 0.5), 0.5);
}

TEST(ConvexBody, MeasuresHowDeepBoxesAreInEachOther) {
  ExpectDepth(0.25, kCube, At({0.75, 0.3, 0.2}), kCube);
  ExpectDepth(0.0, kCube, At({1.0, 0.0, 0.0}), kCube);
  // Enclosed: it leaves by the nearest side, with all of its own size.
  ExpectDepth(0.3 + 0.5 - 0.1, BoxOfSize({1.0, 0.9, 0.5}), At({0.2, 0.0, 0.1}),
              BoxOfSize({0.3, 0.3, 0.3}));
  constexpr double kEighth_rad = std::numbers::pi / 4.0;
  ExpectDepth(0.5 + std::sqrt(0.5) - 1.1, kCube, At({1.1, 0.0, 0.1}, kEighth_rad), kCube);
}

TEST(ConvexBody, PartsCrossedBarsBetweenTheirEdges) {
  // Both stand on an edge. The way out is along neither's faces but across both bars.
  const Eigen::AngleAxisd on_edge(std::numbers::pi / 4.0, Vector3::UnitX());
  const ConvexBody bar = BoxOfSize({5.0, 0.1, 0.1});
  const Transform one_from_other =
      Transform(on_edge.inverse()) * At({0.0, 0.0, 0.25}, 1.2) * Transform(on_edge);
  ExpectDepth(0.2 * std::sqrt(2.0) - 0.25, bar, one_from_other, bar);
}

TEST(ConvexBody, PartsRoundBarsBesideEachOther) {
  // Their middles lie apart lengthwise, too, so that the way out is not along the line through
  // them.
  constexpr int kSides = 60;
  const ConvexBody bar =
      BodyOf(MakeTube(std::array<Vector3, 2>{Vector3(0, 0, -5), Vector3(0, 0, 5)}, 1.0, kSides));
  const double within_m = 2.0 * (1.0 - std::cos(std::numbers::pi / kSides));
  ExpectDepth(2.0 - std::hypot(1.2, 1.0) - 0.5 * within_m, bar, At({1.2, 1.0, 3.0}), bar,
              0.5 * within_m);
}

TEST(ConvexBody, GivesTheLeastDepthAskedForWhereTheyAreLessDeep) {
  EXPECT_EQ(Depth_m(kCube, At({0.75, 0.3, 0.2}), kCube, 0.3), 0.3);
  EXPECT_NEAR(Depth_m(kCube, At({0.75, 0.3, 0.2}), kCube, 0.2), 0.25, kBodyRounding_m);
}

TEST(ConvexBody, MeasuresHowDeepRoundBodiesAreInEachOther) {
  constexpr int kSides = 60;
  const ConvexBody ball = BodyOf(MakeEllipsoid(Vector3::Zero(), Vector3::Ones(), kSides));
  // Faces lie inside the ball by up to 1 - cos(pi / sides) along either circle.
  const double within_m = 4.0 * (1.0 - std::cos(std::numbers::pi / kSides));
  const Vector3 apart(1.1, 1.0, -0.9);
  ExpectDepth(2.0 - apart.norm() - 0.5 * within_m, ball, At(apart), ball, 0.5 * within_m);
}

Model ModelOf(Mesh mesh) {
  return {"model", {{std::move(mesh), 1, 9}}};
}

// Returns the number of bodies of a mesh that is one piece.
std::size_t NumBodies(const Mesh& mesh) {
  const std::vector<Piece> pieces = PiecesOf(ModelOf(mesh));
  EXPECT_EQ(pieces.size(), 1U);
  return pieces[0].bodies.size();
}

Mesh Block(const Vector3& min_m, const Vector3& max_m) {
  return MakeBox({min_m, max_m});
}

TEST(ConvexPieces, EachBlockOfAMeshIsAPiece) {
  Mesh mesh = Block({0, 0, 0}, {1, 1, 1});
  mesh.Append(Block({0, 0, 2}, {4, 1, 3}));
  const std::vector<Piece> pieces = PiecesOf(ModelOf(mesh));
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].box_m.max(), Vector3(1, 1, 1));
  EXPECT_EQ(pieces[1].box_m.min(), Vector3(0, 0, 2));
  ASSERT_EQ(pieces[1].bodies.size(), 1U);
  EXPECT_EQ(pieces[1].bodies[0].corners_m.size(), 8U);
  EXPECT_TRUE(pieces[1].bodies[0].is_box);
}

TEST(ConvexPieces, TrianglesWithCornersOfTheirOwnHangTogetherByPlace) {
  // As a file holds it whose faces do not share vertices.
  const Mesh block = Block({0, 0, 0}, {1, 2, 3});
  Mesh soup;
  for (const auto& triangle : block.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t corner : triangle) soup.vertices.push_back(block.vertices[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const std::vector<Piece> pieces = PiecesOf(ModelOf(soup));
  ASSERT_EQ(pieces.size(), 1U);
  ASSERT_EQ(pieces[0].bodies.size(), 1U);
  EXPECT_EQ(pieces[0].bodies[0].corners_m.size(), 8U);
}

// A triangle of 2 m with a notch in its long side.
Mesh Angle(double notch_m) {
  const std::vector<Eigen::Vector2d> outline = {
      {0, 0}, {2, 0}, {1.0 - notch_m, 1.0 - notch_m}, {0, 2}};
  return MakeExtrusion(outline, 0.0, 1.0);
}

TEST(ConvexPieces, WhatIsNotConvexIsItsTriangles) {
  const Mesh angle = Angle(0.1);
  EXPECT_EQ(NumBodies(angle), angle.triangles.size());
}

TEST(ConvexPieces, ShallowNotchesCountAsFilled) {
  // The notch is sqrt(2) times as deep below the long side; the plane of either of its faces passes
  // the far end of the side at twice that depth.
  EXPECT_EQ(NumBodies(Angle(0.0034)), 1U);
  EXPECT_GT(NumBodies(Angle(0.0037)), 1U);
}

TEST(ConvexPieces, AnOpenVesselIsItsTriangles) {
  Mesh vessel = Block({0, 0, 0}, {1, 1, 1});
  vessel.triangles.pop_back();
  EXPECT_EQ(NumBodies(vessel), vessel.triangles.size());
}

TEST(ConvexPieces, AHollowModelEnclosesWhatItSurroundsOnAllSides) {
  const Model block = ModelOf(Block({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(Encloses(block, {0.3, 0.6, 0.2}));
  EXPECT_FALSE(Encloses(block, {0.3, 0.6, 1.2}));
  Mesh vessel = Block({0, 0, 0}, {1, 1, 1});
  std::erase_if(vessel.triangles, [&](const auto& triangle) {
    return std::ranges::all_of(
        triangle, [&](std::uint32_t corner) { return vessel.vertices[corner].z() == 1.0F; });
  });
  EXPECT_FALSE(Encloses(ModelOf(vessel), {0.3, 0.6, 0.2}));
}

}  // namespace
}  // namespace railcast
