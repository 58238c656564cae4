// The ground of lines through terrain, and of wide strips.
#include "core/rail/landform/landform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "core/rail/ground/terrain.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/track/cross_section.h"
#include "tests/core/rail/test_line.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

WorldSpec Hilly(WorldSpec spec) {
  spec.terrain.half_width_m = 300.0;
  spec.terrain.relief = ReliefSpec{.sigma_m = 4.0, .wavelength_m = 200.0};
  return spec;
}

/// Straight, then a bend of 190 m through a third of a circle, straight.
WorldSpec TightBend() {
  return WorldAlong({{ElementType::kStraight, 200.0, {}},
                     {ElementType::kArc, 400.0, 190.0},
                     {ElementType::kStraight, 200.0, {}}});
}

Mesh GroundMesh(const TestLine& line, int chunk_index, bool is_coarse) {
  ChunkContext context = line.Context(chunk_index);
  context.level = is_coarse ? 1 : 0;
  Chunk chunk;
  AddTerrain(context, chunk);
  return MeshOfSurface(chunk, line.surfaces().ground);
}

double HeightAboveFormation(const TestLine& line, double s_m, double d_m) {
  const int chunk = static_cast<int>(s_m / TestLine::kChunkLength_m);
  return (line.WorldFromChunk(chunk) * GroundPoint(line.Context(chunk), s_m, d_m)).z() +
         CrossSection::kFormationDepth_m;
}

TEST(CutAndFill, IsTheTerrainBetweenTheSlopes) {
  EXPECT_EQ(CutAndFill_m(5.0, -1.0), 0.0);
  EXPECT_EQ(CutAndFill_m(5.0, 3.0), 2.0);
  EXPECT_EQ(CutAndFill_m(5.0, 7.5), 5.0);
  EXPECT_EQ(CutAndFill_m(5.0, 30.0), 5.0);
  EXPECT_EQ(CutAndFill_m(-5.0, 3.0), -2.0);
  EXPECT_EQ(CutAndFill_m(-5.0, 30.0), -5.0);
}

TEST(CutAndFill, HasADitchInCuttingsOnly) {
  // 0.6 m down, 0.4 m of bottom, 0.6 m up, then the slope.
  EXPECT_EQ(CutWithDitchAndFill_m(5.0, -1.0), 0.0);
  EXPECT_NEAR(CutWithDitchAndFill_m(5.0, 0.3), -0.2, 1e-12);
  EXPECT_NEAR(CutWithDitchAndFill_m(5.0, 0.6), -0.4, 1e-12);
  EXPECT_NEAR(CutWithDitchAndFill_m(5.0, 1.0), -0.4, 1e-12);
  EXPECT_NEAR(CutWithDitchAndFill_m(5.0, 1.6), 0.0, 1e-12);
  EXPECT_NEAR(CutWithDitchAndFill_m(5.0, 4.6), 2.0, 1e-12);
  EXPECT_EQ(CutWithDitchAndFill_m(5.0, 40.0), 5.0);
  // No deeper than the cutting, and none beside embankments.
  EXPECT_NEAR(CutWithDitchAndFill_m(0.1, 0.8), -0.1, 1e-12);
  EXPECT_EQ(CutWithDitchAndFill_m(0.0, 0.8), 0.0);
  EXPECT_EQ(CutWithDitchAndFill_m(-5.0, 3.0), -2.0);
}

TEST(Relief, HasDitchesBesideTheFormationInCuttings) {
  WorldSpec spec = Hilly(StraightLine(2000.0));
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  const TestLine without(spec);
  spec.terrain.has_ditches = true;
  const TestLine with(spec);
  int num_ditches = 0;
  for (double s_m = 1.0; s_m < 2000.0; s_m += 10.0) {
    for (const double d_m : {-5.3, 5.3}) {
      // In a cutting deeper than its ditch, the land is higher 3 m farther away.
      const bool is_cut = HeightAboveFormation(without, s_m, d_m > 0.0 ? 8.3 : -8.3) > 1.5;
      const double height_m = HeightAboveFormation(with, s_m, d_m);
      if (is_cut) {
        EXPECT_NEAR(height_m, -0.4, 1e-9) << s_m;
      }
      num_ditches += is_cut ? 1 : 0;
      EXPECT_EQ(HeightAboveFormation(with, s_m, 4.4), 0.0);
    }
  }
  EXPECT_GT(num_ditches, 40);
}

TEST(Relief, CutsAndFillsBetweenTheFormationAndHillsOfTheSpecsHeight) {
  WorldSpec spec = Hilly(StraightLine(8000.0));
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  const TestLine line(spec);
  double sum_of_squares = 0.0;
  int count = 0;
  int num_cut = 0;
  int num_filled = 0;
  for (double s_m = 1.0; s_m < 8000.0; s_m += 10.0) {
    EXPECT_EQ(HeightAboveFormation(line, s_m, 4.4), 0.0);
    const double beside_m = HeightAboveFormation(line, s_m, 10.5);
    EXPECT_LE(std::abs(beside_m), 6.0 * kCutAndFillSlope + 1e-9);
    num_cut += beside_m > 1.0 ? 1 : 0;
    num_filled += beside_m < -1.0 ? 1 : 0;
    for (double d_m = 60.0; d_m < 300.0; d_m += 10.0) {
      const double far_m = HeightAboveFormation(line, s_m, d_m);
      sum_of_squares += far_m * far_m;
      ++count;
    }
  }
  // 8,000 m by 240 m in cells of 200 m: some 48 lattice points, the relative error of sigma is
  // 1.3 / sqrt(96) = 13 %.
  EXPECT_NEAR(std::sqrt(sum_of_squares / count), 4.0, 3.0 * 0.13 * 4.0);
  EXPECT_GT(num_cut, 160);
  EXPECT_GT(num_filled, 160);
}

TEST(Relief, IsCutByABranchOnlyBesideIt) {
  WorldSpec spec = Hilly(StraightLine(800.0));
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  const TestLine without(spec);
  TrackSpec branch{.name = "branch",
                   .offset_m = 30.0,
                   .begin = TurnoutSpec{"main", 100.0, TurnoutType::k9_190, {}, {}}};
  branch.end_s_m = 420.0;
  spec.tracks.push_back(branch);
  const TestLine with(spec);
  // Beside the branch the formation is level; 80 m behind its end the land is as without it.
  EXPECT_EQ(HeightAboveFormation(with, 415.0, 30.0), 0.0);
  double largest_m = 0.0;
  for (double s_m = 500.0; s_m < 790.0; s_m += 7.0) {
    const double height_m = HeightAboveFormation(with, s_m, 30.0);
    EXPECT_NEAR(height_m, HeightAboveFormation(without, s_m, 30.0), 1e-9) << s_m;
    largest_m = std::max(largest_m, std::abs(height_m));
  }
  EXPECT_GT(largest_m, 1.0);
}

TEST(Relief, IsContinuousAndDependsOnTheSeed) {
  const WorldSpec spec = Hilly(TightBend());
  const TestLine line(spec, 1);
  const TestLine other(spec, 2);
  double greatest_difference_m = 0.0;
  // Steps of 0.5 m, on slopes of 1:1.5, of hills and of roughness.
  constexpr double kMostStep_m = 0.6;
  for (const double d_m : {-250.0, -12.0, 8.0, 60.0, 140.0}) {
    for (double s_m = 1.0; s_m < 799.0; s_m += 0.5) {
      const double height_m = HeightAboveFormation(line, s_m, d_m);
      EXPECT_LT(std::abs(HeightAboveFormation(line, s_m + 0.5, d_m) - height_m), kMostStep_m);
      EXPECT_LT(std::abs(HeightAboveFormation(line, s_m, d_m + 0.5) - height_m), kMostStep_m);
      greatest_difference_m = std::max(greatest_difference_m,
                                       std::abs(HeightAboveFormation(other, s_m, d_m) - height_m));
    }
  }
  EXPECT_GT(greatest_difference_m, 2.0);
}

TEST(DemHeights, IsTheGroundBeyondTheSlopes) {
  const std::string file = testing::TempDir() + "/elevation_is_the_ground.asc";
  std::ofstream(file) << "ncols 60\nnrows 40\nxllcorner 99000\nyllcorner 199000\ncellsize 50\n";
  const auto plane_m = [](double x_m, double y_m) { return 500.0 + 0.01 * x_m - 0.05 * y_m; };
  {
    std::ofstream stream(file, std::ios::app);
    stream.precision(12);
    for (int row = 39; row >= 0; --row) {
      for (int column = 0; column < 60; ++column) {
        stream << plane_m(50.0 * (column + 0.5) - 1000.0, 50.0 * (row + 0.5) - 1000.0) << ' ';
      }
    }
  }
  WorldSpec spec = StraightLine(800.0);
  spec.alignment.origin_m = {0.0, 0.0, 5.0};
  spec.terrain.half_width_m = 300.0;
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  spec.terrain.elevation = ElevationSpec{file, {100000.0, 200000.0, 500.0}};
  const TestLine line(spec);
  for (const double s_m : {3.0, 260.0, 777.0}) {
    for (const double d_m : {-280.0, -150.0, -40.0, 40.0, 150.0, 280.0}) {
      // The height above the formation is that above the world's zero less the formation's.
      EXPECT_NEAR(HeightAboveFormation(line, s_m, d_m) - CrossSection::kFormationDepth_m,
                  plane_m(s_m, d_m) - 500.0, 1e-6);
    }
    EXPECT_NEAR(HeightAboveFormation(line, s_m, 3.0), 5.0, 1e-9);
  }
}

using Corner = std::array<float, 3>;

/// Edges of the mesh, with their directions, that no other triangle runs along the other way.
std::vector<std::pair<Corner, Corner>> OpenEdges(const Mesh& mesh) {
  std::map<std::pair<Corner, Corner>, int> edges;
  const auto corner = [&](std::uint32_t vertex) {
    const Eigen::Vector3f& at = mesh.vertices[vertex];
    return Corner{at.x(), at.y(), at.z()};
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      EXPECT_EQ(++edges[std::pair(corner(from), corner(to))], 1);
    }
  }
  std::vector<std::pair<Corner, Corner>> open;
  for (const auto& [edge, count] : edges) {
    if (!edges.contains({edge.second, edge.first})) open.push_back(edge);
  }
  return open;
}

/// Chainage from the middle of the chunk and lateral position, on an arc of that radius.
Eigen::Vector2d TrackPlaceOf(const Corner& corner, double radius_m) {
  const auto x_m = static_cast<double>(corner[0]);
  const double y_m = radius_m - static_cast<double>(corner[1]);
  return {radius_m * std::atan2(x_m, y_m), radius_m - std::hypot(x_m, y_m)};
}

TEST(WideGround, HasNoGapBetweenItsNearAndItsFarPart) {
  // A straight is an arc of this radius within 1e-4 m.
  for (const double radius_m : {5e8, 190.0}) {
    const bool is_bend = radius_m == 190.0;
    const TestLine line(Hilly(is_bend ? TightBend() : StraightLine(800.0)));
    for (const bool is_coarse : {false, true}) {
      const auto open = OpenEdges(GroundMesh(line, 7, is_coarse));
      EXPECT_GT(open.size(), 100U);
      for (const auto& [from, to] : open) {
        const Eigen::Vector2d first = TrackPlaceOf(from, radius_m);
        const Eigen::Vector2d second = TrackPlaceOf(to, radius_m);
        const auto both = [&](const auto& holds) { return holds(first) && holds(second); };
        const double left_m = is_bend ? 152.0 : 300.0;
        EXPECT_TRUE(both([](const auto& at) { return std::abs(at.x()) > 24.99; }) ||
                    both([](const auto& at) { return std::abs(at.y()) < 3.0; }) ||
                    both([](const auto& at) { return at.y() < -299.9; }) ||
                    both([&](const auto& at) { return at.y() > left_m - 0.1; }))
            << first.transpose() << " to " << second.transpose();
      }
    }
  }
}

TEST(WideGround, IsNotFoldedInATightBend) {
  const TestLine line(Hilly(TightBend()));
  for (int chunk = 0; chunk < 16; ++chunk) {
    for (const bool is_coarse : {false, true}) {
      const Mesh ground = GroundMesh(line, chunk, is_coarse);
      for (const auto& [a, b, c] : ground.triangles) {
        const Vector3 corner = ground.vertices[a].cast<double>();
        const Vector3 normal = (ground.vertices[b].cast<double>() - corner)
                                   .cross(ground.vertices[c].cast<double>() - corner);
        ASSERT_GT(normal.z(), 1e-6) << chunk;
      }
    }
  }
}

TEST(WideGround, CostsLessThanHalfAsMuchAgainAsAStripOf80Metres) {
  const TestLine narrow(StraightLine(300.0));
  const TestLine wide(Hilly(StraightLine(300.0)));
  for (const bool is_coarse : {false, true}) {
    const std::size_t of_narrow = GroundMesh(narrow, 2, is_coarse).triangles.size();
    const std::size_t of_wide = GroundMesh(wide, 2, is_coarse).triangles.size();
    RecordProperty(is_coarse ? "coarse" : "fine",
                   std::to_string(of_narrow) + " -> " + std::to_string(of_wide));
    EXPECT_LT(2 * of_wide, 3 * of_narrow);
  }
}

}  // namespace
}  // namespace railcast
