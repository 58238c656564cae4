// Tests what a mirror reflects and what is left of its own response, on single hits.
#include "core/detect/beam/mirrors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/kernels/kernels.h"

namespace railcast {
namespace {

constexpr std::uint32_t kPane = 1;    // Surface and material.
constexpr std::uint32_t kGround = 2;  // The same.

std::vector<Material> Materials(double height_rms_um) {
  return {{.name = "none"},
          {.name = "pane",
           .reflectivity = 0.3,
           .facet_slope_deg = 20.0,
           .specular_f0 = 0.08,
           .retroreflectance = 2.0,
           .height_rms_um = height_rms_um},
          {.name = "ground", .reflectivity = 0.25, .facet_slope_deg = 20.0, .holds_puddles = true}};
}

/// One hit at 10 m, under an angle of incidence, on a surface whose normal leans by `slope_deg`
/// from the vertical, away from the sensor.
struct MirroredHit {
  std::uint32_t surface = kPane;
  double incidence_deg = 0.0;
  double slope_deg = 0.0;
  double height_rms_um = 0.0;
  DetectorSpec spec{.effects = {.surface_response = true, .mirror_paths = true}};
};

struct Result {
  DetectTile bare;
  DetectTile dimmed;
  std::vector<MirrorHit> hits;
};

std::unique_ptr<Result> Meet(const MirroredHit& one) {
  const std::vector<Material> materials = Materials(one.height_rms_um);
  const std::vector<Surface> surfaces{{}, {.material = kPane}, {.material = kGround}};
  const Mirrors mirrors(one.spec, materials);
  const auto scene = mirrors.Among(surfaces, Transform::Identity());
  auto result = std::make_unique<Result>();
  auto rays = std::make_unique<RayTile>();
  rays->num_rays = 16;
  const double from_vertical_rad = RadFromDeg(one.incidence_deg + one.slope_deg);
  for (std::size_t i = 0; i < 16; ++i) {
    rays->origin_x[i] = 0.0F;
    rays->origin_y[i] = 0.0F;
    rays->origin_z[i] = 0.0F;
    rays->direction_x[i] = static_cast<float>(std::sin(from_vertical_rad));
    rays->direction_y[i] = 0.0F;
    rays->direction_z[i] = static_cast<float>(-std::cos(from_vertical_rad));
    rays->normal_x[i] = static_cast<float>(-3.0 * std::sin(RadFromDeg(one.slope_deg)));
    rays->normal_y[i] = 0.0F;
    rays->normal_z[i] = static_cast<float>(3.0 * std::cos(RadFromDeg(one.slope_deg)));
    rays->range_m[i] = 10.0F;
    rays->surface[i] = i == 0 ? one.surface : 0;
  }
  const auto optics = OpticsTable(materials, one.spec.beam.wavelength_nm, 0.0);
  result->bare.num_rays = 16;
  ResolveHits(*rays, {surfaces, optics}, result->bare);
  const Kernels& kernels = AvailableKernels().back();
  kernels.incidence(*rays, result->bare);
  kernels.spread(*rays, {}, result->bare);
  result->dimmed = result->bare;
  if (scene) DimMirrors(*scene, *rays, result->dimmed, &result->hits);
  return result;
}

double Schlick(double f0, double incidence_deg) {
  return f0 + (1.0 - f0) * std::pow(1.0 - std::cos(RadFromDeg(incidence_deg)), 5.0);
}

// Fresnel's equations for water by the angles a and b above and below the surface:
// (sin^2(a - b) / sin^2(a + b) + tan^2(a - b) / tan^2(a + b)) / 2
double OfWater(double incidence_deg) {
  const double a = RadFromDeg(incidence_deg);
  const double b = std::asin(std::sin(a) / 1.33);
  return 0.5 * (std::pow(std::sin(a - b) / std::sin(a + b), 2) +
                std::pow(std::tan(a - b) / std::tan(a + b), 2));
}

TEST(Mirrors, ReflectByFresnelBothWays) {
  for (const double incidence_deg : {0.0, 30.0, 60.0, 75.0, 85.0, 89.0}) {
    const auto met = Meet({.incidence_deg = incidence_deg});
    ASSERT_EQ(met->hits.size(), 1U);
    const double expected = std::pow(Schlick(0.08, incidence_deg), 2);
    EXPECT_NEAR(met->hits[0].there_and_back, expected, 2e-6) << incidence_deg;
    EXPECT_EQ(met->hits[0].lane, 0U);
    EXPECT_NEAR(met->hits[0].normal[2], 1.0F, 1e-6F);
  }
}

TEST(Mirrors, LoseTheirCoherentShareByRayleighsParameter) {
  for (const int wavelength_nm : {905, 1550}) {
    for (const double incidence_deg : {0.0, 60.0, 80.0}) {
      MirroredHit one{.incidence_deg = incidence_deg, .height_rms_um = 0.05};
      one.spec.beam.wavelength_nm = wavelength_nm;
      const double parameter =
          4.0 * std::numbers::pi * 50.0 / wavelength_nm * std::cos(RadFromDeg(incidence_deg));
      const double expected =
          std::pow(std::exp(-parameter * parameter) * Schlick(0.08, incidence_deg), 2);
      const auto met = Meet(one);
      ASSERT_EQ(met->hits.size(), 1U);
      EXPECT_NEAR(met->hits[0].there_and_back, expected, 1e-4 * expected + 1e-7);
    }
  }
  // A matt surface, of heights of a few micrometres, has no coherent share at all.
  EXPECT_TRUE(Meet({.incidence_deg = 60.0, .height_rms_um = 3.0})->hits.empty());
}

TEST(Mirrors, KeepOfTheirOwnResponseWhatTheyDoNotReflect) {
  for (const double incidence_deg : {0.0, 60.0, 85.0}) {
    const auto met = Meet({.incidence_deg = incidence_deg});
    const double enters = (1.0 - Schlick(0.08, incidence_deg)) / (1.0 - 0.08);
    EXPECT_NEAR(met->dimmed.diffuse_a[0] / met->bare.diffuse_a[0], enters * enters, 1e-5);
    EXPECT_NEAR(met->dimmed.diffuse_b[0] / met->bare.diffuse_b[0], enters * enters, 1e-5);
    EXPECT_EQ(met->dimmed.specular_f0[0], 0.0F);
    EXPECT_EQ(met->dimmed.retro[0], met->bare.retro[0]);
  }
  // Half of the specular power is scattered: exp(-x^2) = 1/2.
  const double half_um = 0.905 / (4.0 * std::numbers::pi) * std::sqrt(std::log(2.0));
  const auto met = Meet({.height_rms_um = half_um});
  EXPECT_NEAR(met->dimmed.specular_f0[0], 0.04F, 1e-6F);
  EXPECT_EQ(met->dimmed.diffuse_a[0], met->bare.diffuse_a[0]);
}

MirroredHit InWater(double incidence_deg, double slope_deg = 0.0) {
  MirroredHit one{.surface = kGround, .incidence_deg = incidence_deg, .slope_deg = slope_deg};
  one.spec.weather.puddle_share = 1.0;
  return one;
}

TEST(Mirrors, OfWaterAreLevelWhateverTheGroundBelow) {
  const auto met = Meet(InWater(75.0, 9.0));  // 84 deg from the vertical.
  ASSERT_EQ(met->hits.size(), 1U);
  EXPECT_NEAR(met->hits[0].there_and_back, std::pow(OfWater(84.0), 2), 1e-5);
  EXPECT_EQ(met->hits[0].normal[2], 1.0F);
  EXPECT_NEAR(met->dimmed.cos_incidence[0], std::cos(RadFromDeg(84.0)), 1e-6);
  EXPECT_TRUE(Meet(InWater(70.0, 10.5))->hits.empty());  // Water runs off.
}

TEST(Mirrors, OfWaterHideTheGroundAtGrazingIncidence) {
  for (const double incidence_deg : {1.0, 60.0, 85.0}) {
    const auto met = Meet(InWater(incidence_deg));
    const double enters = 1.0 - OfWater(incidence_deg);
    // Soaked ground has 0.6 of the reflectance of dry ground at 905 nm.
    EXPECT_NEAR(met->dimmed.diffuse_a[0], 0.6 * 0.25 * enters * enters, 1e-6);
    EXPECT_EQ(met->dimmed.diffuse_b[0], 0.0F);
    EXPECT_EQ(met->dimmed.specular_f0[0], 0.0F);
  }
}

// What a textbook's table has for n = 1.33.
TEST(Mirrors, OfWaterReflectAsMuchAsFresnelsTableSays) {
  EXPECT_NEAR(std::sqrt(Meet(InWater(85.0))->hits[0].there_and_back), 0.583, 1e-3);
  EXPECT_NEAR(std::sqrt(Meet(InWater(60.0))->hits[0].there_and_back), 0.059, 1e-3);
}

TEST(Mirrors, UnderSnowMirrorWithWhatIsBare) {
  MirroredHit one = InWater(80.0);
  one.spec.effects.surface_condition = true;
  one.spec.weather.snow_cover = 0.25;
  const auto met = Meet(one);
  ASSERT_EQ(met->hits.size(), 1U);
  EXPECT_NEAR(met->hits[0].there_and_back, std::pow(0.75 * OfWater(80.0), 2), 1e-6);
}

TEST(Mirrors, AreNotLookedForWhereThereAreNone) {
  const std::vector<Material> materials = Materials(0.0);
  const DetectorSpec dry;
  EXPECT_FALSE(Mirrors(dry, materials).Among({{}, {.material = kGround}}, Transform::Identity()));
  EXPECT_TRUE(Mirrors(dry, materials).Among({{}, {.material = kPane}}, Transform::Identity()));
  DetectorSpec wet;
  wet.weather.puddle_share = 0.1;
  EXPECT_TRUE(Mirrors(wet, materials).Among({{}, {.material = kGround}}, Transform::Identity()));
}

constexpr std::uint64_t kNumPuddleSeeds = 40'000;

bool IsWet(std::uint64_t seed, double share, float x_m, float y_m) {
  return IsUnderWater(Puddles(seed, share).WavesAt(Transform::Identity()), {x_m, y_m, -1.0F});
}

TEST(Puddles, CoverTheStatedShareOfTheGround) {
  for (const double share : {0.02, 0.1, 0.3, 0.5, 0.8}) {
    double wet = 0.0;
    for (std::uint64_t seed = 0; seed < kNumPuddleSeeds; ++seed) {
      wet += IsWet(seed, share, 31.0F, -8.0F) ? 1.0 : 0.0;
    }
    // Places of different seeds are independent. Of the Edgeworth series of 16 equal cosines, the
    // term of the kurtosis, 1.5 / 16 / 24 (q^3 - 3 q) phi(q), is at most 0.0022.
    const double sigma = std::sqrt(share * (1.0 - share) / static_cast<double>(kNumPuddleSeeds));
    EXPECT_NEAR(wet / static_cast<double>(kNumPuddleSeeds), share, 4.0 * sigma + 0.0022) << share;
  }
}

TEST(Puddles, CoverNothingOrEverythingAtTheEnds) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    EXPECT_FALSE(IsWet(seed, 0.0, 3.0F, 4.0F));
    EXPECT_TRUE(IsWet(seed, 1.0, 3.0F, 4.0F));
  }
}

// Two places are alike with the probability 1/2 + asin(r) / pi (the normal orthant probability),
// where the correlation r of waves in all directions of the plane is the mean of J0(2 pi d /
// wavelength).
TEST(Puddles, AreSomeMetresLong) {
  for (const double distance_m : {0.1, 0.5, 1.0, 3.0, 200.0}) {
    double correlation = 0.0;
    for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
      const double step = static_cast<double>(i) / static_cast<double>(kNumPuddleWaves - 1);
      const double wavelength_m =
          Puddles::kShortest_m * std::pow(Puddles::kLongest_m / Puddles::kShortest_m, step);
      correlation += std::cyl_bessel_j(0.0, 2.0 * std::numbers::pi * distance_m / wavelength_m) /
                     static_cast<double>(kNumPuddleWaves);
    }
    double alike = 0.0;
    for (std::uint64_t seed = 0; seed < kNumPuddleSeeds; ++seed) {
      const auto waves = Puddles(seed, 0.5).WavesAt(Transform::Identity());
      const float x_m = 5.0F + static_cast<float>(distance_m);
      alike += IsUnderWater(waves, {5.0F, 2.0F, 0.0F}) == IsUnderWater(waves, {x_m, 2.0F, 0.0F});
    }
    const double expected = 0.5 + std::asin(correlation) / std::numbers::pi;
    const double sigma =
        std::sqrt(expected * (1.0 - expected) / static_cast<double>(kNumPuddleSeeds));
    // The waves are not quite normal, which the first test bounds by 0.002 for a single place.
    EXPECT_NEAR(alike / static_cast<double>(kNumPuddleSeeds), expected, 4.0 * sigma + 0.005)
        << distance_m;
  }
}

TEST(Puddles, AreAtTheSamePlacesInAnyWindow) {
  const Puddles puddles(7, 0.3);
  const Transform world_from_here = MakeTransform(RotationFromYawPitchRoll(0.7, 0.0, 0.0),
                                                  Vector3(454'321.5, 5'234'567.25, 400.0));
  const Transform world_from_there = MakeTransform(RotationFromYawPitchRoll(-2.0, 0.0, 0.0),
                                                   Vector3(454'300.0, 5'234'500.0, 395.0));
  const PuddleWaves here = puddles.WavesAt(world_from_here);
  const PuddleWaves there = puddles.WavesAt(world_from_there);
  int num_wet = 0;
  int num_different = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Vector3 place(0.3 * (i % 100), 0.3 * (i / 100), 0.1);
    const Eigen::Vector3f moved =
        (world_from_there.inverse() * (world_from_here * place)).cast<float>();
    const bool is_wet =
        IsUnderWater(here, {static_cast<float>(place.x()), static_cast<float>(place.y()), 0.1F});
    num_wet += is_wet ? 1 : 0;
    num_different += is_wet != IsUnderWater(there, {moved.x(), moved.y(), moved.z()}) ? 1 : 0;
  }
  EXPECT_GT(num_wet, 500);
  // Rounding moves the shores by some 10 micrometres of the cells' 0.3 m.
  EXPECT_LE(num_different, 1);
}

}  // namespace

}  // namespace railcast
