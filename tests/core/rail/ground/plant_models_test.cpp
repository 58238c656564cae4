#include "core/rail/ground/plant_models.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/ray_cast.h"

namespace railcast {
namespace {

class PlantModelsTest : public testing::Test {
 protected:
  [[nodiscard]] std::vector<PlantModel> Trees() const {
    std::vector<PlantModel> trees = plants_.broadleaves;
    trees.insert(trees.end(), plants_.conifers.begin(), plants_.conifers.end());
    return trees;
  }

  const RailSurfaces surfaces_ = TestSurfaces();
  const PlantModels plants_ = MakePlantModels(surfaces_, 42);
};

const Mesh& LeavesOf(const Model& tree, const RailSurfaces& surfaces) {
  return std::find_if(tree.parts.begin(), tree.parts.end(),
                      [&](const Part& part) { return part.material == surfaces.leaf.material; })
      ->mesh;
}

bool CoversFromAbove(const Mesh& mesh,
                     const std::array<std::uint32_t, 3>& triangle,
                     double x,
                     double y) {
  double least = 1.0;
  double most = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 a = mesh.vertices[triangle[i]].cast<double>();
    const Vector3 b = mesh.vertices[triangle[(i + 1) % 3]].cast<double>();
    const double turn = (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
    least = i == 0 ? turn : std::min(least, turn);
    most = i == 0 ? turn : std::max(most, turn);
  }
  return least > 0.0 || most < 0.0;
}

/// Area of grass without its roots (blades below z = 0).
double AreaAboveGround_m2(const Mesh& mesh) {
  double sum_m2 = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3 pa = mesh.vertices[a].cast<double>();
    const Vector3 pb = mesh.vertices[b].cast<double>();
    const Vector3 pc = mesh.vertices[c].cast<double>();
    const double lowest_m = std::min({pa.z(), pb.z(), pc.z()});
    const double highest_m = std::max({pa.z(), pb.z(), pc.z()});
    const double share = std::min(1.0, highest_m / (highest_m - lowest_m));
    sum_m2 += 0.5 * (pb - pa).cross(pc - pa).norm() * share;
  }
  return sum_m2;
}

TEST_F(PlantModelsTest, AreMadeOfFewAndSoundTriangles) {
  ASSERT_EQ(Trees().size(), 4U);
  for (const PlantModel& tree : Trees()) {
    EXPECT_LE(tree.model->num_triangles(), 20000U) << tree.model->name;
    EXPECT_EQ(CountBadTriangles(*tree.model), 0U) << tree.model->name;
  }
  ASSERT_EQ(plants_.grass.size(), 3U);
  for (const auto& patch : plants_.grass) {
    EXPECT_LE(patch.model->num_triangles(), 2500U);
    EXPECT_EQ(CountBadTriangles(*patch.model), 0U);
  }
}

TEST_F(PlantModelsTest, HaveLeavesOfTheSizeOfLeaves) {
  for (const PlantModel& tree : Trees()) {
    std::vector<double> edges_m = LongestEdges_m(*tree.model, surfaces_.leaf);
    std::sort(edges_m.begin(), edges_m.end());
    EXPECT_GT(edges_m.front(), 0.05) << tree.model->name;
    EXPECT_LT(edges_m[edges_m.size() / 2], 0.12) << tree.model->name;
    EXPECT_LT(edges_m.back(), 0.15) << tree.model->name;
  }
}

TEST_F(PlantModelsTest, HaveTheStatedLeafAreaIndex) {
  const std::vector<double> crown_radii_m = {2.1, 2.3, 1.6, 2.0};
  for (std::size_t i = 0; i < 4; ++i) {
    const Mesh& leaves = LeavesOf(*Trees()[i].model, surfaces_);
    double area_m2 = 0.0;
    for (const auto& [a, b, c] : leaves.triangles) {
      const Vector3 ab = (leaves.vertices[b] - leaves.vertices[a]).cast<double>();
      const Vector3 ac = (leaves.vertices[c] - leaves.vertices[a]).cast<double>();
      area_m2 += 0.5 * ab.cross(ac).norm();
    }
    const double projection_m2 = std::numbers::pi * crown_radii_m[i] * crown_radii_m[i];
    // Sizes are uniform within 20 %: their mean square is 1 + 0.2^2 / 3 = 1.0133.
    EXPECT_NEAR(area_m2 / projection_m2, 1.0133 * 3.2, 0.05) << Trees()[i].model->name;
  }
}

TEST_F(PlantModelsTest, LetAsMuchLightThroughTheirCrownsAsTheLeafAreaSays) {
  const std::vector<double> crown_radii_m = {2.1, 2.3, 1.6, 2.0};
  for (std::size_t tree = 0; tree < 4; ++tree) {
    const Mesh& leaves = LeavesOf(*Trees()[tree].model, surfaces_);
    int num_through = 0;
    constexpr int kNumBeams = 1000;
    for (int i = 0; i < kNumBeams; ++i) {
      // Evenly distributed over the inner three quarters of the crown's radius (Vogel's spiral).
      const double radius_m = 0.75 * crown_radii_m[tree] * std::sqrt((i + 0.5) / kNumBeams);
      const double x_m = radius_m * std::cos(2.4 * i);
      const double y_m = radius_m * std::sin(2.4 * i);
      if (std::none_of(leaves.triangles.begin(), leaves.triangles.end(), [&](const auto& triangle) {
            return CoversFromAbove(leaves, triangle, x_m, y_m);
          })) {
        ++num_through;
      }
    }
    const double gap_fraction = static_cast<double>(num_through) / kNumBeams;
    // Leaves distributed uniformly in the crown transmit exp(-0.5 * 3.2) = 0.20 (Beer, Lambert).
    // Clustering about twigs increases that, and the rim of the crown is thinner than its middle.
    EXPECT_GT(gap_fraction, 0.12) << Trees()[tree].model->name;
    EXPECT_LT(gap_fraction, 0.40) << Trees()[tree].model->name;
  }
}

TEST_F(PlantModelsTest, GrowFromBelowTheGroundToTheirHeight) {
  const std::vector<double> heights_m = {7.5, 11.0, 7.0, 12.0};
  for (std::size_t i = 0; i < 4; ++i) {
    const PlantModel tree = Trees()[i];
    EXPECT_NEAR(tree.height_m, heights_m[i], 0.05 * heights_m[i]);
    EXPECT_DOUBLE_EQ(tree.height_m, tree.model->Bounds().max().z());
    EXPECT_NEAR(tree.model->Bounds().min().z(), -0.3, 1e-6);
    EXPECT_GT(LeavesOf(*tree.model, surfaces_).vertices.front().z(), 0.1F);
  }
}

TEST_F(PlantModelsTest, HaveGrassOf15To40CentimetresOnItsPatch) {
  for (const auto& patch : plants_.grass) {
    const Eigen::AlignedBox3d box = patch.model->Bounds();
    EXPECT_LE(box.max().z(), 0.40);
    EXPECT_LT(box.min().z(), 0.0);
    // Feet stand up to a tuft's radius beyond the square, and tips lean out by up to 0.6 * 0.4 m.
    EXPECT_LT(box.max().cwiseAbs().head<2>().maxCoeff(), 1.0 + 0.07 + 0.24 + 0.01);
    const Mesh& mesh = patch.model->parts.front().mesh;
    for (std::size_t tip = 4; tip < mesh.vertices.size(); tip += 5) {
      EXPECT_GE(mesh.vertices[tip].z(), 0.15F - 1e-6F);
    }
    EXPECT_NEAR(AreaAboveGround_m2(mesh) / (kGrassPatch_m * kGrassPatch_m), 0.35, 0.05);
  }
}

/// Sums over a mesh, above the ground.
struct MeshSums {
  double area_m2{};
  double height_m3{};                                       ///< Area times height.
  Eigen::Matrix3d directions_m2 = Eigen::Matrix3d::Zero();  ///< Area times normal, squared.
};

MeshSums SumsOf(const Mesh& mesh) {
  MeshSums sums;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3 pa = mesh.vertices[a].cast<double>();
    const Vector3 pb = mesh.vertices[b].cast<double>();
    const Vector3 pc = mesh.vertices[c].cast<double>();
    const Vector3 normal = (pb - pa).cross(pc - pa);
    const double area_m2 = 0.5 * normal.norm();
    sums.area_m2 += area_m2;
    sums.height_m3 += area_m2 * (pa.z() + pb.z() + pc.z()) / 3.0;
    sums.directions_m2 += area_m2 * normal.normalized() * normal.normalized().transpose();
  }
  return sums;
}

/// Expects the same heights and directions of the triangles, by area. `num` is their number in the
/// coarser mesh, which is a sample of those in the finer one.
void ExpectAlike(const Mesh& fine, const Mesh& coarse, double spread_m, double num) {
  const MeshSums a = SumsOf(fine);
  const MeshSums b = SumsOf(coarse);
  EXPECT_NEAR(b.height_m3 / b.area_m2, a.height_m3 / a.area_m2, 4.0 * spread_m / std::sqrt(num));
  // The square of a component of a random unit vector has a standard deviation of 0.3.
  const Eigen::Matrix3d change = b.directions_m2 / b.area_m2 - a.directions_m2 / a.area_m2;
  EXPECT_LT(change.cwiseAbs().maxCoeff(), 4.0 * 0.3 / std::sqrt(num));
}

TEST_F(PlantModelsTest, HaveCoarserFormsWithTheSamePartsAndHalfTheTrianglesEach) {
  std::vector<PlantModel> plants = Trees();
  plants.insert(plants.end(), plants_.grass.begin(), plants_.grass.end());
  for (const PlantModel& plant : plants) {
    ASSERT_EQ(plant.coarser->size(), 4U);
    const Model* finer = plant.model.get();
    for (const CoarserModel& coarser : *plant.coarser) {
      const Model& model = *coarser.model;
      EXPECT_NEAR(static_cast<double>(model.num_triangles()),
                  0.5 * static_cast<double>(finer->num_triangles()),
                  0.1 * static_cast<double>(finer->num_triangles()))
          << model.name;
      EXPECT_EQ(CountBadTriangles(model), 0U) << model.name;
      ASSERT_EQ(model.parts.size(), plant.model->parts.size());
      for (std::size_t i = 0; i < model.parts.size(); ++i) {
        EXPECT_EQ(model.parts[i].material, plant.model->parts[i].material);
        EXPECT_EQ(model.parts[i].label, plant.model->parts[i].label);
      }
      finer = &model;
    }
  }
}

TEST_F(PlantModelsTest, KeepHeightsAndDirectionsOfLeavesInCoarserForms) {
  for (const PlantModel& tree : Trees()) {
    const Mesh& leaves = LeavesOf(*tree.model, surfaces_);
    for (const CoarserModel& coarser : *tree.coarser) {
      SCOPED_TRACE(coarser.model->name);
      const Mesh& merged = LeavesOf(*coarser.model, surfaces_);
      ExpectAlike(leaves, merged, 0.25 * tree.height_m,
                  static_cast<double>(merged.triangles.size()));
    }
  }
}

TEST_F(PlantModelsTest, KeepHeightsAndDirectionsOfBladesInCoarserForms) {
  for (const PlantModel& patch : plants_.grass) {
    for (const CoarserModel& coarser : *patch.coarser) {
      SCOPED_TRACE(coarser.model->name);
      const Mesh& merged = coarser.model->parts.front().mesh;
      // Three triangles make a blade.
      ExpectAlike(patch.model->parts.front().mesh, merged, 0.05,
                  static_cast<double>(merged.triangles.size()) / 3.0);
    }
  }
}

/// The share of parallel beams that a model stops, on a grid over a disc about a point.
double StoppedShare(const Model& model,
                    const Vector3& towards,
                    const Vector3& middle_m,
                    double radius_m) {
  const TraceDevice device;
  constexpr int kNumRays = 16 * kTileSize;
  const Vector3 right = towards.unitOrthogonal();
  const Vector3 up = towards.cross(right);
  std::vector<Ray> rays;
  for (int i = 0; i < kNumRays; ++i) {  // Vogel's spiral.
    const double at_m = radius_m * std::sqrt((i + 0.5) / kNumRays);
    const Vector3 from_m = middle_m - 50.0 * towards + at_m * std::cos(2.4 * i) * right +
                           at_m * std::sin(2.4 * i) * up;
    rays.push_back({from_m.cast<float>(), towards.cast<float>()});
  }
  const auto hits = CastRays(*SceneOf(device, model), rays, 100.0F);
  return static_cast<double>(
             std::ranges::count_if(hits, [](const RayHit& hit) { return hit.range_m < 100.0F; })) /
         kNumRays;
}

TEST_F(PlantModelsTest, StopAsManyBeamsInCoarserForms) {
  const std::vector<double> crown_radii_m = {2.1, 2.3, 1.6, 2.0};
  std::array<double, 4> mean_of_level{};
  for (std::size_t i = 0; i < 4; ++i) {
    const PlantModel tree = Trees()[i];
    const Vector3 middle_m(0, 0, 0.6 * tree.height_m);
    const auto stopped = [&](const Model& model) {
      constexpr int kNumDirections = 6;
      double sum = 0.0;
      for (int k = 0; k < kNumDirections; ++k) {
        const double azimuth_rad = 2.0 * std::numbers::pi * k / kNumDirections;
        const Vector3 towards(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
        sum += StoppedShare(model, towards, middle_m, crown_radii_m[i]);
      }
      return sum;
    };
    const double fine = stopped(*tree.model);
    for (std::size_t level = 0; level < 4; ++level) {
      const double ratio = stopped(*(*tree.coarser)[level].model) / fine;
      // Some 1,000 leaves are seen, so that a tree differs by up to 5 %; all four together by less.
      EXPECT_NEAR(ratio, 1.0, 0.06) << tree.model->name << " at level " << level;
      mean_of_level[level] += 0.25 * ratio;
    }
  }
  for (const double ratio : mean_of_level) EXPECT_NEAR(ratio, 1.0, 0.02);
}

TEST_F(PlantModelsTest, DependOnTheSeedAlone) {
  const PlantModels again = MakePlantModels(surfaces_, 42);
  const PlantModels other = MakePlantModels(surfaces_, 43);
  const auto& vertices = plants_.conifers[0].model->parts[1].mesh.vertices;
  EXPECT_EQ(vertices, again.conifers[0].model->parts[1].mesh.vertices);
  EXPECT_NE(vertices, other.conifers[0].model->parts[1].mesh.vertices);
}

TEST(PlantsOnDemand, AreMadeOnceForAllThreads) {
  const PlantsOnDemand plants(TestSurfaces(), 42);
  std::vector<const Model*> trees(8);
  tbb::parallel_for(
      std::size_t{0}, trees.size(),
      [&](std::size_t i) { trees[i] = plants.Get().broadleaves[0].model.get(); },
      tbb::simple_partitioner{});
  EXPECT_EQ(std::ranges::count(trees, trees[0]), 8);
  EXPECT_EQ(trees[0]->parts[1].mesh.vertices,
            MakePlantModels(TestSurfaces(), 42).broadleaves[0].model->parts[1].mesh.vertices);
}

}  // namespace
}  // namespace railcast
