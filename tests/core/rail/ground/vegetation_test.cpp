#include "core/rail/ground/plant_models.h"
#include "core/rail/landform/ground_rise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/core/rail/test_line.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

const PlantModels& Plants() {
  static const PlantModels plants = MakePlantModels(TestSurfaces(), 1);
  return plants;
}

bool IsGrass(const Placement& placement) {
  return std::ranges::find(Plants().grass, placement.model, &PlantModel::model) !=
         Plants().grass.end();
}

double HeightOf(const Placement& tree) {
  return tree.model->Bounds().max().z() * tree.chunk_from_model.linear().col(2).norm();
}

std::vector<Placement> Plant(const TestLine& line, int chunk) {
  Chunk built;
  AddVegetation(line.Context(chunk), Plants(), built);
  return built.placements;
}

/// The line with the given density of trees and without grass.
WorldSpec Forest(WorldSpec spec, double trees_per_hectare) {
  spec.vegetation.grass = false;
  spec.vegetation.trees_per_hectare = trees_per_hectare;
  return spec;
}

void AddTrack(const std::string& name, double offset_m, WorldSpec& spec) {
  TrackSpec track{.name = name, .offset_m = offset_m};
  spec.tracks.push_back(track);
}

TEST(AddVegetation, PlantsTreesAtTheirDensityAsAPoissonProcess) {
  constexpr int kNumChunks = 200;
  const TestLine line(Forest(StraightLine(kNumChunks * TestLine::kChunkLength_m), 40.0));
  // Two strips from 9 to 80 m: 28.4 trees per chunk.
  constexpr double kMean = 40e-4 * TestLine::kChunkLength_m * 2.0 * 71.0;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (int chunk = 0; chunk < kNumChunks; ++chunk) {
    const auto count = static_cast<double>(Plant(line, chunk).size());
    sum += count;
    sum_of_squares += (count - kMean) * (count - kMean);
  }
  EXPECT_NEAR(sum, kMean * kNumChunks, 5.0 * std::sqrt(kMean * kNumChunks));
  // The variance of a Poisson count equals its mean; the variance of that estimate is about 2
  // mean^2 / n.
  EXPECT_NEAR(sum_of_squares / kNumChunks, kMean, 5.0 * kMean * std::sqrt(2.0 / kNumChunks));
}

TEST(AddVegetation, KeepsTheDensityInsideAndOutsideOfACurve) {
  constexpr int kNumChunks = 20;
  constexpr double kRadius_m = 300.0;
  const TestLine line(Forest(CantedArc(kNumChunks * TestLine::kChunkLength_m, kRadius_m), 400.0));
  double inside = 0.0;
  double outside = 0.0;
  for (int chunk = 0; chunk < kNumChunks; ++chunk) {
    const Vector3 centre_m =
        line.WorldFromChunk(chunk).inverse() *
        (line.alignment().WorldFromTrack(0.0).translation() + Vector3(0, kRadius_m, 0));
    for (const Placement& tree : Plant(line, chunk)) {
      const Vector3 arm_m = tree.chunk_from_model.translation() - centre_m;
      (arm_m.head<2>().norm() < kRadius_m ? inside : outside) += 1.0;
    }
  }
  // Rings between 9 and 80 m from the axis, along 1000 m of it.
  const double angle_rad = kNumChunks * TestLine::kChunkLength_m / kRadius_m;
  const double expected_inside = 0.04 * angle_rad * (291.0 * 291.0 - 220.0 * 220.0) / 2.0;
  const double expected_outside = 0.04 * angle_rad * (380.0 * 380.0 - 309.0 * 309.0) / 2.0;
  EXPECT_NEAR(inside, expected_inside, 5.0 * std::sqrt(expected_inside));
  EXPECT_NEAR(outside, expected_outside, 5.0 * std::sqrt(expected_outside));
}

TEST(AddVegetation, KeepsTreesOffTheTracksAndOnTheChunksGround) {
  WorldSpec spec = Forest(StraightLine(500.0), 400.0);
  AddTrack("left", 4.0, spec);
  AddTrack("right", -8.5, spec);
  const TestLine line(spec);
  for (int chunk = 0; chunk < 10; ++chunk) {
    for (const Placement& tree : Plant(line, chunk)) {
      const Vector3 at_m = tree.chunk_from_model.translation();
      EXPECT_TRUE(at_m.y() >= 4.0 + 9.0 || at_m.y() <= -8.5 - 9.0) << at_m.transpose();
      EXPECT_LE(std::abs(at_m.y()), 80.0);
      EXPECT_LE(std::abs(at_m.x()), 0.5 * TestLine::kChunkLength_m);
      const double s_m = (chunk + 0.5) * TestLine::kChunkLength_m + at_m.x();
      EXPECT_NEAR(at_m.z(), GroundPoint(line.Context(chunk), s_m, at_m.y()).z(), 1e-6);
      const double height_m = HeightOf(tree);
      EXPECT_GE(height_m, 6.0 - 1e-9);
      EXPECT_LE(height_m, 14.0 + 1e-9);
      EXPECT_EQ(tree.instance, 0U);
      EXPECT_NEAR(tree.sway_height_m, height_m, 1e-6);
    }
  }
}

TEST(AddVegetation, PlantsWhatTheSeedAndTheChunkSay) {
  const WorldSpec spec = StraightLine(500.0);
  const TestLine line(spec, 7);
  const auto poses = [](const std::vector<Placement>& placements) {
    std::vector<Eigen::Matrix4d> all;
    for (const Placement& p : placements) all.push_back(p.chunk_from_model.matrix());
    return all;
  };
  EXPECT_EQ(poses(Plant(line, 3)), poses(Plant(TestLine(spec, 7), 3)));
  EXPECT_NE(poses(Plant(line, 3)), poses(Plant(line, 4)));
  EXPECT_NE(poses(Plant(line, 3)), poses(Plant(TestLine(spec, 8), 3)));
}

TEST(AddVegetation, FillsTheStripsBesideTheTracksWithGrass) {
  WorldSpec spec = StraightLine(500.0);
  spec.vegetation.trees_per_hectare = 0.0;
  AddTrack("left", 4.0, spec);
  const TestLine line(spec);
  const std::vector<Placement> patches = Plant(line, 2);
  EXPECT_EQ(patches.size(), 25U * 3U * 2U);  // Every 2 m; three rows in 5.4 m; both sides.
  for (const Placement& patch : patches) {
    ASSERT_TRUE(IsGrass(patch));
    EXPECT_EQ(patch.sway_height_m, 0.0);
    const double d_m = patch.chunk_from_model.translation().y();
    const double beyond_m = std::max(d_m - 4.0, -d_m);
    EXPECT_GE(beyond_m, 3.6 + 1.0 - 1e-9);
    EXPECT_LE(beyond_m, 9.0 - 1.0 + 1e-9);
    for (const Eigen::Vector3f& vertex : patch.model->parts.front().mesh.vertices) {
      const double y_m = (patch.chunk_from_model * vertex.cast<double>()).y();
      // Rotated corners, and tips leaning out by 0.24 m, stay clear of the ballast's foot at 2.6 m.
      EXPECT_GT(std::max(y_m - 4.0, -y_m), 2.9);
    }
  }
}

TEST(AddVegetation, RootsGrassInTheGround) {
  WorldSpec spec = StraightLine(500.0);
  spec.vegetation.trees_per_hectare = 0.0;
  const TestLine line(spec);
  const ChunkContext context = line.Context(2);
  for (const Placement& patch : Plant(line, 2)) {
    for (const Eigen::Vector3f& vertex : patch.model->parts.front().mesh.vertices) {
      if (vertex.z() > -0.14F) continue;  // Check the roots only, which are 0.15 m deep.
      const Vector3 root_m = patch.chunk_from_model * vertex.cast<double>();
      const double s_m = 2.5 * TestLine::kChunkLength_m + root_m.x();
      ASSERT_LT(root_m.z(), GroundPoint(context, s_m, root_m.y()).z()) << root_m.transpose();
    }
  }
}

bool IsBush(const Placement& placement) {
  return std::ranges::find(Plants().bushes, placement.model, &PlantModel::model) !=
         Plants().bushes.end();
}

TEST(AddVegetation, PlantsBushesOfHalfAMetreToTwoAndAHalf) {
  constexpr int kNumChunks = 40;
  WorldSpec spec = Forest(StraightLine(kNumChunks * TestLine::kChunkLength_m), 0.0);
  spec.vegetation.bushes_per_hectare = 60.0;
  const TestLine line(spec);
  double count = 0.0;
  for (int chunk = 0; chunk < kNumChunks; ++chunk) {
    for (const Placement& bush : Plant(line, chunk)) {
      ASSERT_TRUE(IsBush(bush));
      EXPECT_GE(HeightOf(bush), 0.5 - 1e-6);
      EXPECT_LE(HeightOf(bush), 2.5 + 1e-6);
      EXPECT_GE(std::abs(bush.chunk_from_model.translation().y()), 6.0);
      count += 1.0;
    }
  }
  const double mean = 60e-4 * kNumChunks * TestLine::kChunkLength_m * 2.0 * 74.0;
  EXPECT_NEAR(count, mean, 5.0 * std::sqrt(mean));
}

TEST(AddVegetation, GivesBushesTheirLabelDownToTheGround) {
  ASSERT_EQ(Plants().bushes.size(), 2U);
  for (const PlantModel& bush : Plants().bushes) {
    for (const Part& part : bush.model->parts)
      EXPECT_EQ(part.label, TestSurfaces().bush_leaf.label);
    const Eigen::AlignedBox3d box = bush.model->Bounds();
    EXPECT_LT(box.min().z(), 0.0);
    EXPECT_GT(box.sizes().x(), 0.8 * bush.height_m);
    EXPECT_EQ(bush.coarser->size(), 4U);
  }
}

// Woods of 60 m in 10 km by 142 m: some 400 lattice points, each of which is wooded or not, so that
// the share has a standard error of sqrt(0.3 * 0.7 / 400) = 2.3 %; the noise is not quite normal.
TEST(AddVegetation, GrowsTreesOnTheWoodedShareOfTheLandAndInGroves) {
  constexpr int kNumChunks = 200;
  WorldSpec spec = Forest(StraightLine(kNumChunks * TestLine::kChunkLength_m), 100.0);
  const TestLine everywhere(spec);
  spec.vegetation.woods_share = 0.3;
  const TestLine woods(spec);
  double num_everywhere = 0.0;
  double num_in_woods = 0.0;
  double sum_of_squares = 0.0;
  for (int chunk = 0; chunk < kNumChunks; ++chunk) {
    num_everywhere += static_cast<double>(Plant(everywhere, chunk).size());
    const auto count = static_cast<double>(Plant(woods, chunk).size());
    num_in_woods += count;
    sum_of_squares += count * count;
  }
  EXPECT_NEAR(num_in_woods / num_everywhere, 0.3, 4.0 * 0.023);
  const double mean = num_in_woods / kNumChunks;
  EXPECT_GT(sum_of_squares / kNumChunks - mean * mean, 4.0 * mean);  // Of a Poisson process, once.
}

TEST(AddVegetation, ThinsOutGrassBeyondItsStrip) {
  WorldSpec spec = StraightLine(2000.0);
  spec.vegetation.trees_per_hectare = 0.0;
  const TestLine sharp(spec);
  spec.vegetation.grass_fade_m = 20.0;
  const TestLine fading(spec);
  std::array<double, 4> nums{};  // By 5 m of the distance beyond the strip.
  for (int chunk = 0; chunk < 40; ++chunk) {
    std::size_t num_beyond = 0;
    const std::vector<Placement> patches = Plant(fading, chunk);
    for (const Placement& patch : patches) {
      const double beyond_m = std::abs(patch.chunk_from_model.translation().y()) - 9.0;
      if (beyond_m <= 0.0) continue;
      ASSERT_TRUE(IsGrass(patch));
      ASSERT_LT(beyond_m, 20.0);
      nums.at(static_cast<std::size_t>(beyond_m / 5.0)) += 1.0;
      ++num_beyond;
    }
    EXPECT_EQ(patches.size() - num_beyond, Plant(sharp, chunk).size());
  }
  // Places for a patch on 4 m^2 each, of which (1 - x / 20)^2 are taken.
  const double num_places = 2.0 * 2000.0 * 5.0 / 4.0;
  for (std::size_t i = 0; i < nums.size(); ++i) {
    const double from = 1.0 - 0.25 * static_cast<double>(i);
    const double to = from - 0.25;
    const double expected = num_places * (from * from * from - to * to * to) / 0.75;
    EXPECT_NEAR(nums.at(i), expected, 5.0 * std::sqrt(expected)) << i;
  }
}

TEST(AddVegetation, PlantsNothingBeyondNarrowedGround) {
  WorldSpec spec = Forest(CantedArc(600.0, 190.0), 200.0);
  spec.terrain.half_width_m = 300.0;
  spec.vegetation.bushes_per_hectare = 50.0;
  const TestLine line(spec);
  int num_inside = 0;
  for (int chunk = 0; chunk < 12; ++chunk) {
    const Vector3 centre_m =
        line.WorldFromChunk(chunk).inverse() *
        (line.alignment().WorldFromTrack(0.0).translation() + Vector3(0, 190.0, 0));
    for (const Placement& plant : Plant(line, chunk)) {
      const double from_centre_m =
          (plant.chunk_from_model.translation() - centre_m).head<2>().norm();
      EXPECT_GE(from_centre_m, 190.0 - 152.0 - 1e-6);
      num_inside += from_centre_m < 190.0 ? 1 : 0;
    }
  }
  EXPECT_GT(num_inside, 100);
}

TEST(AddVegetation, GrowsNothingWhereTheSpecHasNoRoom) {
  WorldSpec spec = StraightLine(500.0);
  spec.vegetation.grass_max_distance_m = spec.vegetation.grass_min_distance_m + 1.9;
  spec.vegetation.tree_min_distance_m = spec.terrain.half_width_m + 1.0;
  EXPECT_TRUE(Plant(TestLine(spec), 0).empty());
}

TEST(AddVegetation, KeepsPlantsOffStructures) {
  WorldSpec spec = StraightLine(500.0);
  spec.vegetation.trees_per_hectare = 1000.0;
  PlatformSpec platform = StructureBeside<PlatformSpec>(TrackSide::kLeft, "platform", 0.0, 500.0);
  platform.width_m = 20.0;
  spec.structures = {platform};
  const TestLine line(spec);
  int num_right = 0;
  for (int chunk = 0; chunk < 10; ++chunk) {
    for (const Placement& plant : Plant(line, chunk)) {
      const double d_m = plant.chunk_from_model.translation().y();
      // Beyond the edge at 1.65 m and the back at 21.65 m, grass keeps 1.2 m and trees 2 m.
      EXPECT_FALSE(d_m > 0.0 && d_m < 21.65 + (IsGrass(plant) ? 1.2 : 2.0)) << d_m;
      if (d_m < -3.6 && d_m > -20.0) ++num_right;
    }
  }
  EXPECT_GT(num_right, 1000);
}

}  // namespace
}  // namespace railcast
