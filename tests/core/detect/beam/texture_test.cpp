#include "core/detect/beam/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include "core/detect/kernels/surface_response.h"

namespace railcast {
namespace {

/// A beam on a plane that is tilted about neither of its axes.
struct BeamOnPlane {
  double range_m;
  double cosine;
  float sigma_h_rad = 7.5e-4F;
  float sigma_v_rad = 3.75e-4F;

  [[nodiscard]] Vector3 Normal() const {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return {0.8 * sine, 0.6 * sine, cosine};
  }
  [[nodiscard]] double Spread_m() const {
    return range_m / cosine *
           std::hypot(static_cast<double>(sigma_h_rad) * Normal().x(),
                      static_cast<double>(sigma_v_rad) * Normal().y());
  }
};

/// Of the factors of beams with a cell of their own each.
struct FactorMoments {
  double mean{};
  double variance{};
};

FactorMoments MomentsOf(const BeamOnPlane& beam, double texture, std::uint32_t num_beams) {
  auto tile = std::make_unique<DetectTile>();
  auto lanes = std::make_unique<TextureLanes>();
  double sum = 0.0;
  double squares = 0.0;
  tile->num_rays = kTileSize;
  for (std::uint32_t begin = 0; begin < num_beams; begin += kTileSize) {
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      tile->share[i] = tile->intensity[i] = tile->power_ratio[i] = 1.0F;
      tile->true_range_m[i] = static_cast<float>(beam.range_m);
      tile->cos_incidence[i] = static_cast<float>(beam.cosine);
      tile->spread_m[i] = static_cast<float>(beam.Spread_m());
      lanes->x[i] = static_cast<float>(begin + i) + 0.5F;
      lanes->variance[i] = static_cast<float>(std::expm1(texture * texture));
    }
    baseline::ApplyTexture(*tile, *lanes, {5, beam.sigma_h_rad, beam.sigma_v_rad});
    for (std::size_t i = 0; i < kTileSize; ++i) {
      EXPECT_EQ(tile->intensity[i], tile->power_ratio[i]);
      sum += static_cast<double>(tile->intensity[i]);
      squares += std::pow(static_cast<double>(tile->intensity[i]), 2);
    }
  }
  const double mean = sum / num_beams;
  return {mean, squares / num_beams - mean * mean};
}

// How likely two of many sub-rays of the beam are to meet one cell of a lattice that lies anywhere.
double ShareInOneCell(const BeamOnPlane& beam, bool is_turned) {
  constexpr int kNumLattices = 400;
  constexpr int kNumSubRays = 1000;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const Vector3 n = beam.Normal();
  const Eigen::Quaterniond flat = Eigen::Quaterniond::FromTwoVectors(n, Vector3::UnitZ());
  double pairs = 0.0;
  for (int lattice = 0; lattice < kNumLattices; ++lattice) {
    Eigen::Quaterniond turn = flat;
    if (is_turned) {
      turn.coeffs() << normal(random), normal(random), normal(random), normal(random);
      turn.normalize();
    }
    const Vector3 from(uniform(random), uniform(random), uniform(random));
    std::map<std::tuple<double, double, double>, int> counts;
    for (int i = 0; i < kNumSubRays; ++i) {
      const double h = beam.range_m * static_cast<double>(beam.sigma_h_rad) * normal(random);
      const double v = beam.range_m * static_cast<double>(beam.sigma_v_rad) * normal(random);
      const Vector3 place(h, v, -(h * n.x() + v * n.y()) / n.z());
      const Vector3 cell = (turn * place / static_cast<double>(kTextureCell_m) + from);
      ++counts[{std::floor(cell.x()), std::floor(cell.y()), std::floor(cell.z())}];
    }
    for (const auto& [cell, num] : counts) pairs += static_cast<double>(num) * (num - 1);
  }
  return pairs / (static_cast<double>(kNumLattices) * kNumSubRays * (kNumSubRays - 1));
}

constexpr std::uint32_t kNumTextureBeams = 1U << 16U;

// The sample's variance of n normal deviates has the standard error sqrt(2 / n) of itself; log-
// normal ones of 0.1 have hardly more.
TEST(Texture, OfABeamIsTheMeanOfTheCellsOfItsFootprintAsOfManySubRays) {
  const double cell = std::expm1(0.1 * 0.1);
  const double error = 4.0 * std::sqrt(2.0 / kNumTextureBeams);
  for (const BeamOnPlane& beam :
       {BeamOnPlane{5.0, 1.0}, BeamOnPlane{10.0, 0.5}, BeamOnPlane{20.0, 1.0},
        BeamOnPlane{40.0, 0.7}, BeamOnPlane{100.0, 0.2}}) {
    for (const bool is_turned : {false, true}) {
      const double expected = cell * ShareInOneCell(beam, is_turned);
      EXPECT_NEAR(MomentsOf(beam, 0.1, kNumTextureBeams).variance / expected, 1.0, 0.08 + error)
          << beam.range_m << " m, " << beam.cosine << (is_turned ? ", turned" : "");
    }
  }
}

TEST(Texture, OfARayHasTheStatedLogarithmAndKeepsTheMean) {
  constexpr double kTexture = 0.3;
  const FactorMoments moments = MomentsOf({30.0, 0.5, 0.0F, 0.0F}, kTexture, kNumTextureBeams);
  const double variance = std::expm1(kTexture * kTexture);
  EXPECT_NEAR(moments.mean, 1.0, 4.0 * std::sqrt(variance / kNumTextureBeams));
  // The kurtosis of this log-normal law is 4.7.
  EXPECT_NEAR(moments.variance / variance, 1.0, 4.0 * std::sqrt(3.7 / kNumTextureBeams));
}

// The correlation of n independent pairs has the standard error 1 / sqrt(n).
TEST(Texture, OfNeighbouringCellsIsIndependent) {
  constexpr std::uint32_t kSide = 256;
  auto tile = std::make_unique<DetectTile>();
  auto lanes = std::make_unique<TextureLanes>();
  tile->num_rays = kTileSize;
  std::vector<double> logs;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      tile->share[x] = tile->intensity[x] = tile->cos_incidence[x] = 1.0F;
      lanes->x[x] = static_cast<float>(x) - 99.5F;
      lanes->y[x] = static_cast<float>(y) - 99.5F;
      lanes->variance[x] = static_cast<float>(std::expm1(1.0));
    }
    baseline::ApplyTexture(*tile, *lanes, {5, 0.0F, 0.0F});
    for (std::size_t x = 0; x < kSide; ++x) {
      logs.push_back(std::log(static_cast<double>(tile->intensity[x])) + 0.5);
    }
  }
  for (const std::size_t away : {1U, 2U, kSide, kSide + 1U}) {
    double product = 0.0;
    for (std::size_t i = 0; i + away < logs.size(); ++i) product += logs[i] * logs[i + away];
    EXPECT_NEAR(product / static_cast<double>(logs.size()), 0.0, 4.0 / kSide) << away;
  }
}

/// Rays along +x that meet surface 1 at places 1 cm apart.
std::unique_ptr<RayTile> RaysOnWall(double y_m) {
  auto rays = std::make_unique<RayTile>();
  rays->num_rays = kTileSize;
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    rays->origin_x[i] = 0.0F;
    rays->origin_y[i] = static_cast<float>(y_m) + 0.01F * static_cast<float>(i);
    rays->origin_z[i] = 0.0F;
    rays->direction_x[i] = 1.0F;
    rays->direction_y[i] = rays->direction_z[i] = 0.0F;
    rays->range_m[i] = 10.0F;
    rays->shutter[i] = 0.5F;
    rays->surface[i] = 1;
  }
  return rays;
}

/// The factors on a wall 10 m away, whose things are `things`.
std::vector<float> FactorsOnWall(const TexturedThings& things, std::uint32_t instance, double y_m) {
  const std::vector<Material> materials{{.name = "none"}, {.name = "a", .texture = 0.3}};
  DetectorSpec spec{.effects = {.texture = true}};
  spec.beam.divergence_mrad = {0.0, 0.0};
  const Texture texture(spec, materials, AvailableKernels().back());
  const std::vector<Surface> surfaces{{}, {.instance = instance, .material = 1}};
  auto tile = std::make_unique<DetectTile>();
  tile->num_rays = kTileSize;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    tile->share[i] = tile->cos_incidence[i] = tile->intensity[i] = tile->power_ratio[i] = 1.0F;
    tile->true_range_m[i] = 10.0F;
    tile->spread_m[i] = 0.0F;
  }
  texture.Apply(Texture::SceneOf(Transform::Identity(), &things), surfaces, *RaysOnWall(y_m),
                *tile);
  return {tile->intensity, tile->intensity + kTileSize};
}

TexturedThings WallAt(double begin_y_m, double end_y_m) {
  std::vector<CellField> steps;
  for (const double y_m : {begin_y_m, end_y_m}) {
    steps.push_back(
        CellsFromWindow(Eigen::Affine3d(Eigen::Translation3d(-10.0, -y_m, 0.0))).cast<float>());
  }
  TexturedThings things;
  things.Add(1, 1, steps);
  return things;
}

TEST(Texture, GoesWithTheThingAndDiffersBetweenInstances) {
  const auto expected = FactorsOnWall(WallAt(0.0, 0.0), 7, 0.0);
  // In the middle of the shutter it is at 3 m.
  EXPECT_EQ(FactorsOnWall(WallAt(2.0, 4.0), 7, 3.0), expected);
  EXPECT_NE(FactorsOnWall(WallAt(2.0, 4.0), 8, 3.0), expected);
  EXPECT_NE(FactorsOnWall(WallAt(2.0, 2.0), 7, 3.0), expected);
}

TEST(Texture, IsOneValueInEachCell) {
  const auto factors = FactorsOnWall(WallAt(0.0, 0.0), 7, 0.0);
  int num_changes = 0;
  for (std::size_t i = 1; i < factors.size(); ++i) num_changes += factors[i] != factors[i - 1];
  EXPECT_NEAR(num_changes, 0.01 * 255 / 0.03, 1.0);
}

TEST(Texture, OfTheWorldIsTheSameInEveryWindowHoweverFarAway) {
  const TexturedThings none;
  const auto cell_of = [&](const Transform& window_from_world, const Vector3& world_m) {
    const TextureScene scene = Texture::SceneOf(window_from_world, &none);
    const Eigen::Vector3f place = (window_from_world * world_m).cast<float>();
    std::vector<std::uint32_t> cell;
    for (int k = 0; k < 3; ++k) {
      cell.push_back(scene.base[k] +
                     baseline::FloorOf(scene.cells_from_window.row(k).head<3>().dot(place) +
                                       scene.cells_from_window(k, 3)));
    }
    return cell;
  };
  const Vector3 world_m(123'456.7, -9876.5, 432.1);
  const auto window_at = [&](double off_m, double turn_rad) -> Transform {
    return (Transform(Eigen::Translation3d(world_m + Vector3(off_m, 0.5 * off_m, 0.0))) *
            Eigen::AngleAxisd(turn_rad, Vector3::UnitZ()))
        .inverse();
  };
  const auto expected = cell_of(window_at(0.0, 0.0), world_m);
  EXPECT_EQ(cell_of(window_at(80.0, 0.3), world_m), expected);
  EXPECT_EQ(cell_of(window_at(-150.0, 2.0), world_m), expected);
  EXPECT_NE(cell_of(window_at(0.0, 0.0), world_m + Vector3(0.03, 0.0, 0.0)), expected);
}

}  // namespace
}  // namespace railcast
