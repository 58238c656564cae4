// Properties of tracks, contact line and ground together that hold for every chunk.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tests/core/rail/line/alignment_files.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

WorldSpec RealLineOfTwoTracks() {
  WorldSpec spec;
  spec.alignment = ReadStGallenWil();
  spec.tracks.push_back(spec.tracks[0]);
  spec.tracks[1].name = "second";
  spec.tracks[1].offset_m = -4.0;
  spec.tracks[1].sleeper = SleeperType::kWood;
  return spec;
}

void ExpectSoundTriangles(const Mesh& mesh, const std::string& name) {
  // The square of a tenth of a millimetre.
  constexpr double kLeastArea_m2 = 1e-8;
  double least_m2 = 1.0;
  bool is_finite = true;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3 corner = mesh.vertices[a].cast<double>();
    const Vector3 normal =
        (mesh.vertices[b].cast<double>() - corner).cross(mesh.vertices[c].cast<double>() - corner);
    is_finite = is_finite && normal.allFinite();
    least_m2 = std::min(least_m2, 0.5 * normal.norm());
  }
  EXPECT_TRUE(is_finite) << name;
  EXPECT_GT(least_m2, kLeastArea_m2) << name;
}

TEST(ChunkGeometry, HasOnlyFiniteTrianglesThatAreNoSlivers) {
  const TestLine line(RealLineOfTwoTracks());
  for (const int chunk_index : {0, 1, 46, 250, 590}) {
    const Chunk chunk = line.Build(chunk_index);
    EXPECT_GT(chunk.ground.num_triangles(), 40000U);
    for (const Part& part : chunk.ground.parts) {
      ExpectSoundTriangles(part.mesh, "label " + std::to_string(part.label));
    }
    std::set<std::shared_ptr<const Model>> models;
    for (const Placement& placement : chunk.placements) {
      EXPECT_TRUE(placement.chunk_from_model.matrix().allFinite());
      models.insert(placement.model);
    }
    for (const auto& model : models) {
      for (const Part& part : model->parts) ExpectSoundTriangles(part.mesh, model->name);
    }
  }
}

TEST(ChunkGeometry, IsTheSameEveryTime) {
  const TestLine line(RealLineOfTwoTracks());
  const TestLine again(RealLineOfTwoTracks());
  ExpectSameChunk(line.Build(47), again.Build(47));
}

TEST(ChunkGeometry, ChangesWithTheSeedOnlyWhereItIsRandom) {
  const TestLine line(StraightLine(300.0), 1);
  const TestLine other(StraightLine(300.0), 2);
  const Chunk first = line.Build(2);
  const Chunk second = other.Build(2);
  const auto& surfaces = line.surfaces();
  for (const SurfaceClass& surface : {surfaces.ballast, surfaces.ground}) {
    EXPECT_NE(MeshOfSurface(first, surface).vertices, MeshOfSurface(second, surface).vertices);
  }
  for (const SurfaceClass& surface : {surfaces.rail_head, surfaces.contact_wire}) {
    EXPECT_EQ(MeshOfSurface(first, surface).vertices, MeshOfSurface(second, surface).vertices);
  }
}

/// Points within a millimetre of the plane x = 0 in the level frame of the axis at chainage `s_m`.
std::vector<Vector3> PointsAtSeam(const TestLine& line,
                                  int chunk_index,
                                  std::size_t level,
                                  const SurfaceClass& surface,
                                  double s_m) {
  const AxisPoint axis = line.alignment().At(s_m);
  const Transform seam_from_chunk =
      MakeTransform(RotationFromYawPitchRoll(axis.heading_rad, 0.0, 0.0), axis.position_m)
          .inverse() *
      line.WorldFromChunk(chunk_index);
  std::vector<Vector3> points;
  for (const Eigen::Vector3f& vertex :
       MeshOfSurface(line.Build(chunk_index, level), surface).vertices) {
    const Vector3 point = seam_from_chunk * vertex.cast<double>();
    if (std::abs(point.x()) < 1e-3) points.push_back(point);
  }
  return points;
}

// Both chunks sample the same functions, 1 mm of chainage apart: at d left of an axis of radius R,
// the distance is 1 - d / R mm. Heights differ by slope times 1 mm, and float32 adds 0.01 mm.
void ExpectOverlap(std::size_t level_before, std::size_t level_after) {
  const TestLine line(CantedArc(500.0, 400.0));
  const auto& surfaces = line.surfaces();
  for (const SurfaceClass& surface :
       {surfaces.rail_head, surfaces.rail_side, surfaces.ballast, surfaces.ground}) {
    const auto ends = PointsAtSeam(line, 3, level_before, surface, 200.0);
    const auto begins = PointsAtSeam(line, 4, level_after, surface, 200.0);
    EXPECT_GT(ends.size(), 8U);
    for (const Vector3& end : ends) {
      EXPECT_GT(end.x(), 0.0);
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const Vector3& begin : begins) nearest_m = std::min(nearest_m, (end - begin).norm());
      // Where ballast lies below the ground, or ground below the ballast, the chunks may differ in
      // which cells at the seam are drawn.
      const bool is_hidden =
          surface.label == surfaces.ballast.label
              ? end.z() < -0.6
              : surface.label == surfaces.ground.label && end.z() < -0.7 && std::abs(end.y()) < 4.0;
      if (is_hidden) continue;
      EXPECT_LT(nearest_m, 1.5 * kChunkOverlap_m) << end.transpose();
    }
    for (const Vector3& begin : begins) EXPECT_LT(begin.x(), 0.0);
  }
}

TEST(ChunkGeometry, OverlapsItsNeighbourByAMillimetre) {
  ExpectOverlap(0, 0);
}

TEST(ChunkGeometry, BeginsAndEndsAlikeInAllForms) {
  for (std::size_t level = 1; level <= kMostCoarse; ++level) {
    ExpectOverlap(level, level - 1);
    ExpectOverlap(level - 1, level);
    ExpectOverlap(level, level);
  }
}

/// Lateral positions, in mm, of the ballast's points from 2 to 8 m behind the beginning of chunk 2.
std::set<int> BallastColumns_mm(const WorldSpec& spec) {
  const TestLine line(spec);
  const Mesh ballast = MeshOfSurface(line.Build(2, true), line.surfaces().ballast);
  std::set<int> columns_mm;
  for (const Eigen::Vector3f& vertex_m : ballast.vertices) {
    const float behind_begin_m = vertex_m.x() + 25.0F;
    if (behind_begin_m < 2.0F || behind_begin_m > 8.0F) continue;
    columns_mm.insert(static_cast<int>(std::lround(1e3F * vertex_m.y())));
  }
  return columns_mm;
}

// The columns follow the shape of the ballast, also of a track that has ended before the middle.
TEST(ChunkGeometry, KeepsTheShapeOfATrackThatEndsInsideInItsCoarserForm) {
  WorldSpec whole = StraightLine(300.0);
  WorldSpec ended = whole;
  ended.tracks[0].end_s_m = 110.0;
  const std::set<int> of_whole_mm = BallastColumns_mm(whole);
  EXPECT_GT(of_whole_mm.size(), 5U);
  EXPECT_THAT(BallastColumns_mm(ended), ::testing::IsSupersetOf(of_whole_mm));
}

TEST(ChunkGeometry, TakesFewerTrianglesInItsCoarserForms) {
  const TestLine line(RealLineOfTwoTracks());
  constexpr double kMostShares[kMostCoarse] = {0.5, 0.15};
  for (const int chunk : {46, 250}) {
    const auto num_fine = static_cast<double>(line.Build(chunk).ground.num_triangles());
    for (std::size_t level = 1; level <= kMostCoarse; ++level) {
      const Chunk coarse = line.Build(chunk, level);
      EXPECT_LT(static_cast<double>(coarse.ground.num_triangles()),
                kMostShares[level - 1] * num_fine)
          << level;
      for (const Part& part : coarse.ground.parts) {
        ExpectSoundTriangles(part.mesh, "label " + std::to_string(part.label));
      }
    }
  }
}

}  // namespace
}  // namespace railcast
