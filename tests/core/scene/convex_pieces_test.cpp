#include "core/scene/convex_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/scene/shapes.h"

namespace railcast {
namespace {

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
