#include "railcast/material.h"

#include <gtest/gtest.h>

#include <numbers>

namespace railcast {
namespace {

Material Brick() {
  return {.name = "brick",
          .reflectivity = 0.25,
          .reflectivity_1550nm = 0.5,
          .facet_slope_deg = 30,
          .specular_f0 = 0.03,
          .specular_f0_1550nm = 0.06,
          .specular_roughness = 0.4,
          .retroreflectance = 12};
}

TEST(OpticsAt, TakesTheNumbersOfItsWavelength) {
  const SurfaceOptics near = OpticsAt(Brick(), 905);
  EXPECT_EQ(near.diffuse, 0.25F);
  EXPECT_FLOAT_EQ(near.facet_slope_rad, std::numbers::pi_v<float> / 6.0F);
  EXPECT_EQ(near.specular_f0, 0.03F);
  EXPECT_EQ(near.specular_roughness, 0.4F);
  EXPECT_EQ(near.retroreflectance, 12.0F);
  const SurfaceOptics far = OpticsAt(Brick(), 1550);
  EXPECT_EQ(far.diffuse, 0.5F);
  EXPECT_EQ(far.specular_f0, 0.06F);
}

TEST(OpticsAt, TakesTheNumbersAt905nmWhereNoneIsGiven) {
  Material brick = Brick();
  brick.reflectivity_1550nm.reset();
  brick.specular_f0_1550nm.reset();
  EXPECT_EQ(OpticsAt(brick, 1550), OpticsAt(brick, 905));
}

TEST(OpticsAtDeathTest, KnowsNoOtherWavelength) {
  EXPECT_DEATH(static_cast<void>(OpticsAt(Brick(), 1064)), "known at 905 and 1550 nm");
}

class WetSurface : public testing::TestWithParam<int> {};

TEST_P(WetSurface, IsAsItWasWhenDry) {
  const SurfaceOptics dry = OpticsAt(Brick(), GetParam());
  EXPECT_EQ(WetOptics(dry, 0.0, GetParam()), dry);
}

TEST_P(WetSurface, DarkensAndSmoothsWithEveryStepOfWetness) {
  SurfaceOptics matt = OpticsAt(Brick(), GetParam());
  matt.specular_f0 = 0.0F;
  SurfaceOptics before = matt;
  for (int i = 1; i <= 100; ++i) {
    const SurfaceOptics wet = WetOptics(matt, i / 100.0, GetParam());
    EXPECT_LT(wet.diffuse, before.diffuse);
    EXPECT_LT(wet.facet_slope_rad, before.facet_slope_rad);
    EXPECT_GT(wet.specular_f0, before.specular_f0);
    EXPECT_EQ(wet.retroreflectance, matt.retroreflectance);
    before = wet;
  }
}

// For dark and white, matt and glossy surfaces: none reflects more than it receives.
TEST_P(WetSurface, ConservesEnergy) {
  for (const float diffuse : {0.0F, 0.02F, 0.4F, 1.0F}) {
    for (const float f0 : {0.0F, 0.01F, 0.04F, 0.6F}) {
      if (diffuse + f0 > 1.0F) continue;
      const SurfaceOptics dry{.diffuse = diffuse, .specular_f0 = f0, .specular_roughness = 0.3F};
      for (int i = 0; i <= 100; ++i) {
        const SurfaceOptics wet = WetOptics(dry, i / 100.0, GetParam());
        EXPECT_LE(wet.diffuse + wet.specular_f0, 1.0F) << diffuse << " " << f0 << " " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Wavelengths, WetSurface, testing::Values(905, 1550));

TEST(WetOptics, KeepsThreeFifthsOfTheDiffuseAt905nmAndThreeTenthsAt1550nm) {
  const SurfaceOptics dry{.diffuse = 0.5F};
  EXPECT_FLOAT_EQ(WetOptics(dry, 1.0, 905).diffuse, 0.3F);
  EXPECT_FLOAT_EQ(WetOptics(dry, 1.0, 1550).diffuse, 0.15F);
  EXPECT_FLOAT_EQ(WetOptics(dry, 0.5, 905).diffuse, 0.4F);
}

TEST(WetOptics, PutsAFilmWhereNothingShinesMore) {
  const SurfaceOptics matt{.diffuse = 0.3F, .specular_f0 = 0.01F, .specular_roughness = 0.5F};
  EXPECT_EQ(WetOptics(matt, 1.0, 905).specular_f0, 0.02F);
  EXPECT_EQ(WetOptics(matt, 1.0, 905).specular_roughness, 0.15F);
  const SurfaceOptics steel{.diffuse = 0.1F, .specular_f0 = 0.6F, .specular_roughness = 0.1F};
  EXPECT_EQ(WetOptics(steel, 1.0, 905).specular_f0, 0.6F);
  EXPECT_EQ(WetOptics(steel, 1.0, 905).specular_roughness, 0.1F);
}

}  // namespace
}  // namespace railcast
