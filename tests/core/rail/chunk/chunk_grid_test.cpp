#include "core/rail/chunk/chunk_grid.h"

#include "tests/support/world_specs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace railcast {
namespace {

constexpr double kChunkLength_m = 50.0;
constexpr double kHalfWidth_m = 80.0;

Alignment LineOf(std::vector<AlignmentElement> elements) {
  return Alignment(AlignmentOf(std::move(elements)));
}

/// 1 km straight, a semicircle of 100 m radius, and 1 km back.
Alignment Hairpin() {
  return LineOf({{ElementType::kStraight, 1000.0, {}},
                 {ElementType::kArc, 100.0 * std::numbers::pi, 100.0},
                 {ElementType::kStraight, 1000.0, {}}});
}

std::vector<int> Range(int first, int last) {
  std::vector<int> numbers(static_cast<std::size_t>(last - first + 1));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

TEST(ChunkGrid, EndsWithAShorterChunk) {
  const ChunkGrid grid(LineOf({{ElementType::kStraight, 120.0, {}}}), kChunkLength_m, kHalfWidth_m);
  EXPECT_EQ(grid.num_chunks(), 3);
  EXPECT_EQ(grid.BeginOf(2), 100.0);
  EXPECT_EQ(grid.EndOf(1), 100.0);
  EXPECT_EQ(grid.EndOf(2), 120.0);
  EXPECT_TRUE(grid.WorldFromChunk(2).translation().isApprox(Vector3(110.0, 0.0, 0.0), 1e-12));
}

TEST(ChunkGrid, HasNoEmptyChunkAtTheEnd) {
  const ChunkGrid grid(LineOf({{ElementType::kStraight, 100.0, {}}}), kChunkLength_m, kHalfWidth_m);
  EXPECT_EQ(grid.num_chunks(), 2);
}

TEST(ChunkGrid, GivesTheFirstOrLastChunkBeyondTheLine) {
  const ChunkGrid grid(LineOf({{ElementType::kStraight, 120.0, {}}}), kChunkLength_m, kHalfWidth_m);
  EXPECT_EQ(grid.ChunkAt(-10.0), 0);
  EXPECT_EQ(grid.ChunkAt(0.0), 0);
  EXPECT_EQ(grid.ChunkAt(50.0), 1);
  EXPECT_EQ(grid.ChunkAt(1e6), 2);
}

TEST(ChunkGrid, HasLevelChunkFrames) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kArc, 200.0, 400.0}});
  spec.gradients_permil = {{0.0, 30.0}};
  spec.speed_limits_kmph = {{0.0, 90.0}};
  const Alignment alignment(spec);
  const Transform world_from_chunk =
      ChunkGrid(alignment, kChunkLength_m, kHalfWidth_m).WorldFromChunk(1);
  EXPECT_TRUE(world_from_chunk.translation().isApprox(alignment.At(75.0).position_m, 1e-12));
  EXPECT_TRUE(world_from_chunk.linear().col(2).isApprox(Vector3::UnitZ(), 1e-12));
  const double heading_rad = alignment.At(75.0).heading_rad;
  EXPECT_TRUE(world_from_chunk.linear().col(0).isApprox(
      Vector3(std::cos(heading_rad), std::sin(heading_rad), 0.0), 1e-12));
}

TEST(ChunkGrid, ReachesAlongAStraightLineAsFarAsAsked) {
  const ChunkGrid grid(LineOf({{ElementType::kStraight, 5000.0, {}}}), kChunkLength_m,
                       kHalfWidth_m);
  // The home chunk is 2000 to 2050 m; 310 m plus a slack of 7.5 m extend from 1682.5 m to 2367.5 m.
  EXPECT_EQ(grid.WithinReach(40, 310.0), Range(33, 47));
  EXPECT_EQ(grid.WithinReach(0, 310.0), Range(0, 7));
  EXPECT_EQ(grid.WithinReach(99, 310.0), Range(92, 99));
}

TEST(ChunkGrid, ReachesTheOtherSideOfAHairpin) {
  const ChunkGrid grid(Hairpin(), kChunkLength_m, kHalfWidth_m);
  // Chunk 4 (200 to 250 m) is 200 m from the returning line, whose ground has its edge 120 m away.
  const std::vector<int> near = grid.WithinReach(4, 130.0);
  EXPECT_THAT(near, testing::IsSupersetOf(Range(2, 6)));
  EXPECT_THAT(near, testing::Contains(grid.ChunkAt(2314.16 - 225.0)));
  EXPECT_THAT(near, testing::Not(testing::Contains(grid.ChunkAt(1157.0))));
  EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
  EXPECT_EQ(grid.WithinReach(4, 100.0), Range(1, 7));
}

// Checks the definition by brute force: no ground point within reach is missed.
TEST(ChunkGrid, MissesNoGroundWithinReach) {
  const Alignment alignment = Hairpin();
  const ChunkGrid grid(alignment, kChunkLength_m, kHalfWidth_m);
  const double reach_m = 137.0;
  for (const int home : {0, 11, 21, 30}) {
    const std::vector<int> found = grid.WithinReach(home, reach_m);
    for (double home_s_m = grid.BeginOf(home); home_s_m <= grid.EndOf(home); home_s_m += 6.25) {
      const Vector3 home_m = alignment.At(home_s_m).position_m;
      for (double s_m = 0.5; s_m < alignment.length_m(); s_m += 1.0) {
        for (double d_m = -kHalfWidth_m; d_m <= kHalfWidth_m; d_m += 4.0) {
          const Vector3 ground_m = alignment.WorldFromTrack(s_m, d_m).translation();
          if ((ground_m - home_m).norm() > reach_m) continue;
          ASSERT_TRUE(std::binary_search(found.begin(), found.end(), grid.ChunkAt(s_m)))
              << "chunk " << grid.ChunkAt(s_m) << " from " << home;
        }
      }
    }
  }
}

}  // namespace
}  // namespace railcast
