#include "core/detect/kernels/surface_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "core/base/units.h"
#include "core/detect/kernels/echo_power.h"

namespace railcast {
namespace {

constexpr float kInversePower_m2 = 200.0F * 200.0F / 0.1F;

// A tile with one lane: a surface with these optics at `range_m`.
std::unique_ptr<DetectTile> OneHit(const LaneOptics& optics, float cosine, float range_m) {
  auto tile = std::make_unique<DetectTile>();
  tile->num_rays = 1;
  tile->cos_incidence[0] = cosine;
  tile->true_range_m[0] = range_m;
  tile->share[0] = 1.0F;
  tile->reflectivity[0] = optics.diffuse;
  tile->diffuse_a[0] = optics.a;
  tile->diffuse_b[0] = optics.b;
  tile->specular_f0[0] = optics.f0;
  tile->specular_alpha2[0] = optics.alpha2;
  tile->retro[0] = optics.retro;
  return tile;
}

const LaneOptics kEverything = LaneOpticsOf({.diffuse = 0.3F,
                                             .facet_slope_rad = 0.4F,
                                             .specular_f0 = 0.1F,
                                             .specular_roughness = 0.3F,
                                             .retroreflectance = 5.0F});

// Intensities of a painted post in ninths of its width, over their mean: rows of a VLS-128
// (.53 .86 1.07 1.41 2.27 1.34 1.00 .77 .38), both sides averaged.
TEST(SurfaceResponse, HasTheProfileOfAPaintedPostThatWasRecorded) {
  const LaneOptics paint =
      LaneOpticsOf({.diffuse = 0.3F, .specular_f0 = 0.2F * 0.3F, .specular_roughness = 0.2F});
  constexpr int kNumSteps = 1000;
  std::array<double, 9> profile{};
  for (std::size_t ninth = 0; ninth < profile.size(); ++ninth) {
    for (int step = 0; step < kNumSteps; ++step) {
      const double across =
          (2.0 * (static_cast<double>(ninth) + (step + 0.5) / kNumSteps) - 9.0) / 9.0;
      const auto cosine = static_cast<float>(std::sqrt(1.0 - across * across));
      profile[ninth] += static_cast<double>(baseline::EffectiveReflectance(paint, cosine));
    }
  }
  const double mean = std::accumulate(profile.begin(), profile.end(), 0.0) / 9.0;
  const std::array<double, 5> recorded = {0.455, 0.815, 1.035, 1.375, 2.27};
  constexpr double kMeanRecorded = 9.63 / 9.0;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    EXPECT_NEAR(profile[i] / mean / (recorded[i] / kMeanRecorded), 1.0, 0.04) << i;
  }
}

TEST(SurfaceResponse, IsTheSumOfDiffuseSpecularAndRetro) {
  for (const double incidence_deg : {0.0, 20.0, 60.0, 89.0}) {
    const double c = std::cos(RadFromDeg(incidence_deg));
    const double s2 = 0.4 * 0.4;
    const double diffuse =
        0.3 * (1.0 - 0.1) *
        ((1.0 - 0.5 * s2 / (s2 + 0.33)) * c + 0.45 * s2 / (s2 + 0.09) * (1.0 - c * c));
    const double a2 = 0.3 * 0.3;
    const double d = a2 / (std::numbers::pi * std::pow(c * c * (a2 - 1.0) + 1.0, 2));
    const double g1 = 2.0 * c / (c + std::sqrt(a2 + (1.0 - a2) * c * c));
    const double taper = std::min(1.0, 2.0 * c * c);
    const double specular = taper * std::numbers::pi * 0.1 * d * g1 * g1 / (4.0 * c);
    const double expected = diffuse + specular + 5.0 * std::pow(c, 5);
    EXPECT_NEAR(
        static_cast<double>(baseline::EffectiveReflectance(kEverything, static_cast<float>(c))) /
            expected,
        1.0, 1e-5)
        << incidence_deg;
  }
}

TEST(SurfaceResponse, MakesPowerFallWithTheSquareOfRangeAndReachTheThresholdAtTheDataSheetsRange) {
  for (const float range_m : {20.0F, 200.0F, 300.0F}) {
    const auto tile =
        OneHit(LaneOpticsOf({.diffuse = 0.1F, .specular_roughness = 0.3F}), 1.0F, range_m);
    baseline::ApplyResponse(*tile, {.inverse_power_m2 = kInversePower_m2});
    EXPECT_NEAR(static_cast<double>(tile->power_ratio[0]),
                std::pow(200.0 / static_cast<double>(range_m), 2), 1e-5);
    EXPECT_FLOAT_EQ(tile->intensity[0], 0.1F);
  }
}

TEST(SurfaceResponse, GoesWithTheShareOfTheBeam) {
  const auto tile = OneHit(kEverything, 0.7F, 50.0F);
  tile->share[0] = 0.25F;
  baseline::ApplyResponse(*tile, {.inverse_power_m2 = kInversePower_m2});
  const float whole = baseline::EffectiveReflectance(kEverything, 0.7F);
  EXPECT_FLOAT_EQ(tile->intensity[0], 0.25F * whole);
  EXPECT_FLOAT_EQ(tile->power_ratio[0], 0.25F * whole * kInversePower_m2 / 2500.0F);
}

TEST(SurfaceResponse, IsLambertsWhereItIsOff) {
  const auto tile = OneHit(kEverything, 0.5F, 50.0F);
  baseline::ApplyResponse(*tile, {.is_lambert = true, .inverse_power_m2 = kInversePower_m2});
  EXPECT_FLOAT_EQ(tile->intensity[0], 0.15F);
}

// cos^5 30 deg = 0.487: within 3 % of a half.
TEST(SurfaceResponse, HalvesARetroreflectorAt30Degrees) {
  const LaneOptics retro = LaneOpticsOf({.specular_roughness = 0.3F, .retroreflectance = 1000.0F});
  const double facing = static_cast<double>(baseline::EffectiveReflectance(retro, 1.0F));
  const double turned = static_cast<double>(
      baseline::EffectiveReflectance(retro, static_cast<float>(std::cos(RadFromDeg(30.0)))));
  EXPECT_NEAR(facing, 1000.0, 1e-3);
  EXPECT_NEAR(turned / facing, 0.5, 0.015);
}

TEST(SurfaceResponse, PutsSnowOnFacesLessSteepThan45Degrees) {
  const LaneOptics snow = LaneOpticsOf({.diffuse = 0.9F, .facet_slope_rad = 0.2F});
  const ResponseParameters parameters{
      .inverse_power_m2 = kInversePower_m2, .snow_cover = 0.6F, .snow_a = snow.a, .snow_b = snow.b};
  const float bare = baseline::EffectiveReflectance(kEverything, 0.8F);
  const float white = snow.a * 0.8F + snow.b * (1.0F - 0.8F * 0.8F);
  for (const float up : {1.0F, 0.71F, 0.70F, 0.0F}) {
    const auto tile = OneHit(kEverything, 0.8F, 50.0F);
    tile->normal_up[0] = up;
    baseline::ApplyResponse(*tile, parameters);
    const float cover = up > 0.705F ? 0.6F : 0.0F;
    const float rho = kEverything.diffuse;  // What the sun shines on.
    EXPECT_FLOAT_EQ(tile->reflectivity[0], cover * snow.a + (1.0F - cover) * rho) << up;
    EXPECT_FLOAT_EQ(tile->intensity[0], cover * white + (1.0F - cover) * bare) << up;
  }
}

// D cos integrates to 1 over all facets, so that without shadowing rho 4 cos^2 / pi = F0 D cos
// integrates to F0 over the half space. Shadowing can only reduce the integral; a smooth surface
// has none.
TEST(SurfaceResponse, LetsTheSpecularLobeGiveNoMoreThanItsReflectance) {
  constexpr double kF0 = 0.6;
  for (const double roughness : {0.02, 0.1, 0.3, 0.6, 1.0}) {
    constexpr int kSteps = 200'000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double theta_rad = 0.5 * std::numbers::pi * (i + 0.5) / kSteps;
      const double c = std::cos(theta_rad);
      const double rho = static_cast<double>(
          baseline::MonostaticGgx(static_cast<float>(c), static_cast<float>(kF0),
                                  static_cast<float>(roughness * roughness)));
      sum += rho * 8.0 * c * c * std::sin(theta_rad);
    }
    const double given = sum * 0.5 * std::numbers::pi / kSteps;
    EXPECT_LE(given, kF0 * 1.0005) << roughness;
    EXPECT_GT(given, kF0 * (roughness < 0.05 ? 0.99 : 0.2)) << roughness;
  }
}

TEST(Extinction, TakesItsPartThereAndBack) {
  for (const float range_m : {1.0F, 100.0F, 1000.0F}) {
    const auto tile = OneHit(kEverything, 1.0F, range_m);
    tile->power_ratio[0] = 3.0F;
    baseline::ApplyExtinction(*tile, 0.01F);
    EXPECT_NEAR(static_cast<double>(tile->power_ratio[0]) /
                    (3.0 * std::exp(-0.02 * static_cast<double>(range_m))),
                1.0, 3e-6);
  }
}

}  // namespace
}  // namespace railcast
