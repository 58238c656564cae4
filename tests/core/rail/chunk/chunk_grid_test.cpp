#include "core/rail/chunk/chunk_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/rail/chunk/sweep.h"
#include "tests/core/rail/test_line.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

using testing::ElementsAre;

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

TEST(SweepStations, KeepChordsWithinTheToleranceOnAnArc) {
  constexpr double kRadius_m = 300.0;
  constexpr double kOffset_m = 4.0;  // Towards the centre of the curve: radius 296 m.
  constexpr double kTolerance_m = 1e-3;
  const TestLine line(CantedArc(500.0, kRadius_m));
  const auto stations_m =
      SweepStations(line.alignment(), {100.0, 150.0}, kOffset_m, kTolerance_m, 5.0);
  EXPECT_EQ(stations_m.front(), 100.0);
  EXPECT_EQ(stations_m.back(), 150.0);
  const double step_m = stations_m[1] - stations_m[0];
  const double chord_m = step_m * (kRadius_m - kOffset_m) / kRadius_m;
  EXPECT_LE(chord_m * chord_m / (8.0 * (kRadius_m - kOffset_m)), kTolerance_m);
  // The number of stations is minimal: with one chord less, chords would be too long.
  const double longer_m = chord_m * static_cast<double>(stations_m.size() - 1) /
                          static_cast<double>(stations_m.size() - 2);
  EXPECT_GT(longer_m * longer_m / (8.0 * (kRadius_m - kOffset_m)), 0.95 * kTolerance_m);
}

TEST(SweepStations, AreAtMostTheLongestStepApartOnAStraight) {
  const TestLine line(StraightLine(500.0));
  EXPECT_THAT(SweepStations(line.alignment(), {100.0, 110.0}, 0.0, 1e-3, 5.0),
              testing::ElementsAre(100.0, 105.0, 110.0));
}

TEST(GridStations, AreMultiplesBetweenTheEnds) {
  EXPECT_THAT(GridStations({9.9995, 11.0005}, 0.25),
              testing::ElementsAre(9.9995, 10.25, 10.5, 10.75, 11.0005));
  EXPECT_THAT(GridStations({10.1, 10.8}, 0.25), testing::ElementsAre(10.1, 10.25, 10.5, 10.8));
}

TEST(SweptRange, EndsWithTheTrackOrHalfAnOverlapBeyondTheChunk) {
  WorldSpec spec = StraightLine(500.0);
  spec.tracks[0].end_s_m = 120.0;
  const TestLine line(spec);
  const TrackCourse& track = line.network().courses[0];
  const ChainageRange whole{track.begin_s_m(), track.end_s_m()};
  const ChainageRange inside = SweptRange(line.Context(1), whole);
  EXPECT_DOUBLE_EQ(inside.begin_s_m, 49.9995);
  EXPECT_DOUBLE_EQ(inside.end_s_m, 100.0005);
  EXPECT_DOUBLE_EQ(SweptRange(line.Context(2), whole).end_s_m, 120.0);
}

}  // namespace
}  // namespace railcast
