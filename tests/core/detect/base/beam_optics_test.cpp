#include "core/detect/base/beam_optics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/detect/kernels/surface_response.h"

namespace railcast {
namespace {

// Rounding of the expected values, computed by docs/physics.md 3.1 apart from this code.
constexpr double kHalfOfTheLastDigit = 0.00051;

LaneOptics Diffuse(double slope_deg) {
  return LaneOpticsOf({.diffuse = 1.0F,
                       .facet_slope_rad = static_cast<float>(RadFromDeg(slope_deg)),
                       .specular_roughness = 0.3F});
}

double ReflectanceAt(const LaneOptics& optics, double incidence_deg) {
  return static_cast<double>(baseline::EffectiveReflectance(
      optics, static_cast<float>(std::cos(RadFromDeg(incidence_deg)))));
}

// The pulse has a full width at half maximum of c tau / 2.
TEST(PulseSigma, MakesTheHalfWidthThatOfThePulse) {
  const double sigma_m = PulseSigma_m({.pulse_length_ns = 5.0});
  const double half_width_m = 0.25 * 0.299792458 * 5.0;
  EXPECT_NEAR(std::exp(-0.5 * std::pow(half_width_m / sigma_m, 2)), 0.5, 1e-12);
  EXPECT_NEAR(sigma_m, 0.3182, 1e-4);
}

// At half the full angle, two sigma, the profile is down to e^-2.
TEST(BeamSigmas, AreAQuarterOfTheFullAngle) {
  const BeamSpec beam{.divergence_mrad = {3.0, 1.5}};
  EXPECT_NEAR(std::exp(-0.5 * std::pow(1.5e-3 / HorizontalSigma_rad(beam), 2)), std::exp(-2.0),
              1e-12);
  EXPECT_DOUBLE_EQ(VerticalSigma_rad(beam), 0.5 * HorizontalSigma_rad(beam));
}

TEST(OrenNayar, HasThePublishedConstants) {
  struct Row {
    double slope_deg, a, b;
  };
  for (const Row& row : {Row{0, 1, 0},
                         {10, .958, .114},
                         {20, .865, .259},
                         {30, .773, .339},
                         {40, .702, .380},
                         {50, .651, .402}}) {
    const LaneOptics optics = Diffuse(row.slope_deg);
    EXPECT_NEAR(static_cast<double>(optics.a), row.a, kHalfOfTheLastDigit) << row.slope_deg;
    EXPECT_NEAR(static_cast<double>(optics.b), row.b, kHalfOfTheLastDigit) << row.slope_deg;
  }
}

TEST(OrenNayar, FallsWithIncidenceAsPublished) {
  constexpr double kAngles_deg[] = {0, 30, 45, 60, 70, 80, 85, 88};
  struct Row {
    double slope_deg;
    std::array<double, 8> reflectance;
  };
  constexpr Row kTable[] = {{0, {1, .866, .707, .500, .342, .174, .087, .035}},
                            {10, {.958, .858, .734, .564, .428, .277, .196, .147}},
                            {20, {.865, .814, .741, .627, .524, .401, .332, .289}},
                            {30, {.773, .754, .716, .641, .564, .463, .404, .365}},
                            {40, {.702, .703, .686, .636, .575, .490, .438, .404}}};
  for (const Row& row : kTable) {
    for (std::size_t k = 0; k < 8; ++k) {
      // The values of the table were computed from rounded A and B.
      EXPECT_NEAR(ReflectanceAt(Diffuse(row.slope_deg), kAngles_deg[k]), row.reflectance[k],
                  2.0 * kHalfOfTheLastDigit)
          << row.slope_deg << " " << kAngles_deg[k];
    }
  }
}

TEST(Ggx, FallsWithIncidenceAsPublished) {
  constexpr double kAngles_deg[] = {0, 2, 5, 10, 15, 20, 30, 45};
  struct Row {
    double roughness;
    std::array<double, 8> reflectance;
  };
  constexpr Row kTable[] = {{.05, {60, 27, 3.7, .36, .081, .028, .0068, .0021}},
                            {.10, {15, 12, 4.9, .96, .27, .10, .026, .0083}},
                            {.20, {3.8, 3.5, 2.7, 1.28, .57, .28, .088, .031}},
                            {.30, {1.7, 1.6, 1.4, .99, .61, .37, .15, .062}},
                            {.50, {.60, .60, .58, .51, .43, .34, .22, .12}}};
  for (const Row& row : kTable) {
    for (std::size_t k = 0; k < 8; ++k) {
      const double reflectance = static_cast<double>(
          baseline::MonostaticGgx(static_cast<float>(std::cos(RadFromDeg(kAngles_deg[k]))), 0.6F,
                                  static_cast<float>(row.roughness * row.roughness)));
      // Computed by docs/physics.md 3.2 apart from this code, to two digits.
      EXPECT_NEAR(reflectance / row.reflectance[k], 1.0, 0.05)
          << row.roughness << " " << kAngles_deg[k];
    }
  }
}

TEST(OpticsTable, TakesTheWavelengthAndTheWater) {
  const std::vector<Material> materials{
      {"none", 0.0},
      {.name = "soil", .reflectivity = 0.25, .reflectivity_1550nm = 0.32, .facet_slope_deg = 20.0}};
  const LaneOptics dry = OpticsTable(materials, 905, 0.0)[1];
  EXPECT_FLOAT_EQ(dry.diffuse, 0.25F);
  EXPECT_FLOAT_EQ(OpticsTable(materials, 1550, 0.0)[1].diffuse, 0.32F);
  const LaneOptics wet = OpticsTable(materials, 905, 1.0)[1];
  EXPECT_FLOAT_EQ(wet.diffuse, 0.25F * 0.6F);
  EXPECT_FLOAT_EQ(wet.f0, 0.02F);
  EXPECT_FLOAT_EQ(wet.alpha2, 0.15F * 0.15F);
}

}  // namespace
}  // namespace railcast
