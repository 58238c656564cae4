#include "core/rail/ground/terrain.h"
#include "core/rail/landform/ground_rise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rail/track/cross_section.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

/// RMS height above the formation of ground points at lateral positions from `begin_d_m` to
/// `end_d_m`.
double GroundSigma(const TestLine& line, double begin_d_m, double end_d_m) {
  double sum_of_squares = 0.0;
  int count = 0;
  for (int chunk = 0; chunk < 40; chunk += 4) {
    const ChunkContext context = line.Context(chunk);
    for (double s_m = context.begin_s_m; s_m < context.end_s_m; s_m += 0.77) {
      for (double d_m = begin_d_m; d_m < end_d_m; d_m += 0.63) {
        const double height_m = (line.WorldFromChunk(chunk) * GroundPoint(context, s_m, d_m)).z() +
                                CrossSection::kFormationDepth_m;
        sum_of_squares += height_m * height_m;
        ++count;
      }
    }
  }
  return std::sqrt(sum_of_squares / count);
}

// 500 m by 20 m with cells of 2 m: 2500 lattice points, relative error 1.3 / sqrt(5000) = 1.8 %.
TEST(AddTerrain, HasTheSpecsRoughness) {
  WorldSpec spec = StraightLine(2000.0);
  spec.terrain.undulation_sigma_m = 0.0;
  EXPECT_NEAR(GroundSigma(TestLine(spec), 10.0, 30.0), 0.04, 5.0 * 0.018 * 0.04);
}

// 500 m by 50 m with cells of 30 m: 28 lattice points carry four fifths of the variance, so the
// relative error of sigma is up to 1.3 / sqrt(56) = 17 %.
TEST(AddTerrain, HasTheSpecsUndulationAwayFromTheTrackAndNoneBesideIt) {
  WorldSpec spec = StraightLine(2000.0);
  spec.terrain.roughness_sigma_m = 0.0;
  const TestLine line(spec);
  EXPECT_NEAR(GroundSigma(line, 30.0, 80.0), 0.6, 3.0 * 0.17 * 0.6);
  EXPECT_EQ(GroundSigma(line, 2.0, 3.9), 0.0);
}

Mesh GroundOf(const TestLine& line, int chunk_index) {
  Chunk chunk;
  AddTerrain(line.Context(chunk_index), chunk);
  return MeshOfSurface(chunk, line.surfaces().ground);
}

TEST(AddTerrain, DrawsTheGroundPointsOfItsWholeStrip) {
  const TestLine line(StraightLine(300.0));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : GroundOf(line, 2).vertices) {
    const Vector3 world_m = line.WorldFromChunk(2) * vertex.cast<double>();
    box.extend(world_m);
    const Vector3 ground_m =
        line.WorldFromChunk(2) * GroundPoint(line.Context(2), world_m.x(), world_m.y());
    EXPECT_NEAR(world_m.z(), ground_m.z(), 1e-4);
  }
  EXPECT_NEAR(box.min().x(), 100.0 - 0.5 * kChunkOverlap_m, 1e-5);
  EXPECT_NEAR(box.max().x(), 150.0 + 0.5 * kChunkOverlap_m, 1e-5);
  EXPECT_NEAR(box.max().y(), 80.0, 1e-5);
  EXPECT_NEAR(box.min().y(), -80.0, 1e-5);
}

TEST(AddTerrain, LeavesOutWhatBallastCovers) {
  const TestLine line(StraightLine(300.0));
  for (const Eigen::Vector3f& vertex : GroundOf(line, 2).vertices) {
    EXPECT_GT(std::abs(vertex.y()), 1.4F);
  }
}

TEST(AddTerrain, NeverRisesAboveTheBallastItMeets) {
  WorldSpec spec = StraightLine(300.0);
  spec.terrain.roughness_sigma_m = 0.15;
  const TestLine line(spec);
  const ChunkContext context = line.Context(2);
  for (double s_m = 100.0; s_m < 150.0; s_m += 0.31) {
    const CrossSection section(context, s_m);
    for (double d_m = -2.15; d_m < 2.2; d_m += 0.1) {
      const Vector3 ground_m = line.WorldFromChunk(2) * GroundPoint(context, s_m, d_m);
      EXPECT_LT(ground_m.z(), section.BallastHeight_m(d_m) - 0.1);
    }
  }
}

TEST(AddTerrain, StaysWithinItsBudgetOfTriangles) {
  EXPECT_LE(GroundOf(TestLine(StraightLine(300.0)), 2).triangles.size(), 25000U);
}

}  // namespace
}  // namespace railcast
