// Compares the optics of fog, rain and snow with the tables of docs/physics.md 4.
#include "core/detect/base/weather_optics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace railcast {
namespace {

// The tables are rounded to whole metres and to two or three digits.
constexpr double kPublishedRelative = 0.03;
constexpr double kHalfAMetre_m = 0.51;

double PowerMin(double range_at_10_percent_m) {
  return 0.1 / (range_at_10_percent_m * range_at_10_percent_m);
}

// The largest r with `power(r)` >= power_min; the power must decrease with r.
double Reach_m(const std::function<double(double)>& power, double power_min) {
  double near_m = 1e-3;
  double far_m = 1e5;
  for (int i = 0; i < 100; ++i) {
    const double r = 0.5 * (near_m + far_m);
    (power(r) >= power_min ? near_m : far_m) = r;
  }
  return near_m;
}

double RangeMax_m(double reflectance, double extinction_per_m, double range_at_10_percent_m) {
  return Reach_m(
      [&](double r) { return reflectance * std::exp(-2.0 * extinction_per_m * r) / (r * r); },
      PowerMin(range_at_10_percent_m));
}

void ExpectRange(double range_m, double published_m) {
  EXPECT_NEAR(range_m, published_m, std::max(kHalfAMetre_m, 0.01 * published_m));
}

WeatherSpec Rain(double rate_mmph, RainDrops sizes = RainDrops::kMarshallPalmer) {
  WeatherSpec weather;
  weather.rain_rate_mmph = rate_mmph;
  weather.rain_drop_sizes = sizes;
  return weather;
}

WeatherSpec Snow(double rate_mmph, SnowType type = SnowType::kDry) {
  WeatherSpec weather;
  weather.snow_rate_mmph = rate_mmph;
  weather.snow_type = type;
  return weather;
}

WeatherSpec Visibility(double visibility_m) {
  WeatherSpec weather;
  weather.visibility_m = visibility_m;
  return weather;
}

struct RainRow {
  double rate_mmph, extinction_per_m;
  std::array<double, 9> ranges_m;  // rho 0.1, 0.5, 0.8 for R0 100, then 200, 320.
};
constexpr RainRow kRainTable[] = {
    {1, 3.65e-4, {97, 207, 257, 187, 388, 476, 288, 579, 701}},
    {5, 1.01e-3, {91, 186, 225, 169, 323, 384, 249, 454, 531}},
    {10, 1.56e-3, {87, 171, 205, 157, 286, 336, 225, 390, 450}},
    {25, 2.77e-3, {80, 148, 174, 137, 234, 269, 189, 306, 347}},
    {50, 4.29e-3, {73, 129, 149, 120, 194, 220, 161, 248, 277}},
    {100, 6.64e-3, {65, 109, 124, 102, 157, 176, 133, 196, 216}},
};

TEST(RainExtinction, IsThatOfThePublishedTable) {
  EXPECT_EQ(RainExtinction_per_m(Rain(0.0)), 0.0);
  for (const RainRow& row : kRainTable) {
    const double extinction_per_m = RainExtinction_per_m(Rain(row.rate_mmph));
    EXPECT_NEAR(extinction_per_m / row.extinction_per_m, 1.0, kPublishedRelative) << row.rate_mmph;
    EXPECT_NEAR(extinction_per_m / (3.65e-4 * std::pow(row.rate_mmph, 0.63)), 1.0, 0.002);
  }
}

TEST(RainExtinction, GivesTheRangesOfThePublishedTable) {
  constexpr double kReflectances[] = {0.1, 0.5, 0.8};
  constexpr double kRanges_m[] = {100.0, 200.0, 320.0};
  for (const RainRow& row : kRainTable) {
    for (std::size_t k = 0; k < row.ranges_m.size(); ++k) {
      SCOPED_TRACE(row.rate_mmph);
      ExpectRange(RangeMax_m(kReflectances[k % 3], RainExtinction_per_m(Rain(row.rate_mmph)),
                             kRanges_m[k / 3]),
                  row.ranges_m[k]);
    }
  }
}

// Integrates twice the cross-section of the drops by Simpson's rule up to 20 mm.
TEST(RainExtinction, IsTheIntegralOverTheDropsOfEverySizeDistribution) {
  for (const auto& [sizes, name] : kEnumNames<RainDrops>) {
    for (const double rate_mmph : {0.5, 10.0, 100.0}) {
      const WeatherSpec weather = Rain(rate_mmph, sizes);
      const ParticleSizes drops = RainDropSizes(weather);
      constexpr int kSteps = 20'000;
      constexpr double kStep_mm = 20.0 / kSteps;
      double sum = 0.0;
      for (int i = 0; i <= kSteps; ++i) {
        const double d_mm = kStep_mm * i;
        const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum += weight * 2.0 * 0.25 * std::numbers::pi * d_mm * d_mm * 1e-6 *
               drops.intercept_per_m3_mm * std::exp(-drops.slope_per_mm * d_mm);
      }
      EXPECT_NEAR(RainExtinction_per_m(weather) / (sum * kStep_mm / 3.0), 1.0, 1e-6)
          << name << " " << rate_mmph;
    }
  }
}

TEST(RainDropSizes, AreThoseOfTheNamedDistributions) {
  const ParticleSizes drizzle = RainDropSizes(Rain(1.0, RainDrops::kDrizzle));
  EXPECT_EQ(drizzle.intercept_per_m3_mm, 30'000.0);
  EXPECT_EQ(drizzle.slope_per_mm, 5.7);
  const ParticleSizes thunderstorm = RainDropSizes(Rain(1.0, RainDrops::kThunderstorm));
  EXPECT_EQ(thunderstorm.intercept_per_m3_mm, 1'400.0);
  EXPECT_EQ(thunderstorm.slope_per_mm, 3.0);
  // Small drops extinguish more light per millimetre of water.
  EXPECT_GT(RainExtinction_per_m(Rain(2.0, RainDrops::kDrizzle)), RainExtinction_per_m(Rain(2.0)));
  EXPECT_LT(RainExtinction_per_m(Rain(2.0, RainDrops::kThunderstorm)),
            RainExtinction_per_m(Rain(2.0)));
}

TEST(FogExtinction, IsTheLogarithmOfTwentyOverTheVisibility) {
  EXPECT_DOUBLE_EQ(FogExtinction_per_m(Visibility(75.0)), std::log(20.0) / 75.0);
  WeatherSpec dense;
  dense.fog_density_per_m = 0.02;
  EXPECT_EQ(FogExtinction_per_m(dense), 0.02);
  EXPECT_EQ(FogExtinction_per_m({}), 0.0);
}

TEST(FogExtinction, GivesTheRangesOfThePublishedTable) {
  struct Row {
    double visibility_m;
    std::array<double, 4> ranges_200_m;  // rho 0.1, 0.5, 0.8, 100 for R0 200.
    std::array<double, 3> ranges_100_m;  // rho 0.1, 0.5, 0.8 for R0 100.
  };
  constexpr Row kTable[] = {
      {20, {17, 21, 22, 35}, {13, 17, 18}},        {30, {22, 28, 30, 49}, {17, 23, 24}},
      {50, {31, 40, 43, 74}, {24, 32, 35}},        {75, {40, 53, 57, 103}, {30, 42, 46}},
      {100, {48, 65, 70, 130}, {35, 50, 55}},      {150, {60, 84, 91, 179}, {43, 63, 70}},
      {200, {70, 100, 110, 223}, {48, 74, 82}},    {300, {85, 126, 140, 304}, {57, 91, 102}},
      {500, {106, 166, 186, 444}, {67, 113, 130}}, {1000, {134, 227, 260, 724}, {79, 145, 170}},
  };
  constexpr double kReflectances[] = {0.1, 0.5, 0.8, 100.0};
  for (const Row& row : kTable) {
    SCOPED_TRACE(row.visibility_m);
    const double extinction_per_m = FogExtinction_per_m(Visibility(row.visibility_m));
    for (std::size_t k = 0; k < 4; ++k) {
      ExpectRange(RangeMax_m(kReflectances[k], extinction_per_m, 200.0), row.ranges_200_m[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      ExpectRange(RangeMax_m(kReflectances[k], extinction_per_m, 100.0), row.ranges_100_m[k]);
    }
  }
}

TEST(SnowExtinction, IsThatOfThePublishedTableWetAndDry) {
  struct Row {
    double rate_mmph, wet_per_m, wet_range_m, dry_per_m, dry_range_m;
  };
  constexpr Row kTable[] = {{1.0, 8.9e-4, 172, 1.28e-3, 163},
                            {2.5, 1.7e-3, 153, 4.5e-3, 118},
                            {5.0, 2.8e-3, 136, 1.2e-2, 79}};
  for (const Row& row : kTable) {
    const double wet_per_m = SnowExtinction_per_m(Snow(row.rate_mmph, SnowType::kWet), 905);
    const double dry_per_m = SnowExtinction_per_m(Snow(row.rate_mmph, SnowType::kDry), 905);
    EXPECT_NEAR(wet_per_m / row.wet_per_m, 1.0, kPublishedRelative);
    EXPECT_NEAR(dry_per_m / row.dry_per_m, 1.0, kPublishedRelative);
    ExpectRange(RangeMax_m(0.1, wet_per_m, 200.0), row.wet_range_m);
    ExpectRange(RangeMax_m(0.1, dry_per_m, 200.0), row.dry_range_m);
  }
  EXPECT_EQ(SnowExtinction_per_m({}, 905), 0.0);
}

TEST(Extinction, AddsFogRainAndSnow) {
  WeatherSpec weather = Rain(3.0);
  weather.visibility_m = 500.0;
  weather.snow_rate_mmph = 2.0;
  EXPECT_DOUBLE_EQ(Extinction_per_m(weather, 1550), FogExtinction_per_m(weather) +
                                                        RainExtinction_per_m(weather) +
                                                        SnowExtinction_per_m(weather, 1550));
}

TEST(Wetness, IsWhatTheWeatherStatesElseWhatTheRainMakes) {
  EXPECT_EQ(WetnessOf({}), 0.0);
  EXPECT_DOUBLE_EQ(WetnessOf(Rain(1.0)), 0.25);
  EXPECT_DOUBLE_EQ(WetnessOf(Rain(4.0)), 1.0);
  EXPECT_DOUBLE_EQ(WetnessOf(Rain(50.0)), 1.0);
  WeatherSpec weather = Rain(50.0);
  weather.wetness = 0.0;
  EXPECT_EQ(WetnessOf(weather), 0.0);
  weather = {};
  weather.wetness = 0.7;
  EXPECT_EQ(WetnessOf(weather), 0.7);
}

TEST(ParticleEchoes, AreThoseOfThePublishedTable) {
  struct Row {
    WeatherSpec weather;
    // mean, median and 95th percentile for R0 and divergence as in kSensors.
    std::array<std::array<double, 3>, 5> echoes;
  };
  struct Sensor {
    double range_m, divergence_mrad;
  };
  constexpr Sensor kSensors[] = {{200, 1.5}, {200, 3}, {100, 3}, {50, 3}, {320, 2}};
  const Row table[] = {
      {Rain(10),
       {{{.28, 5.3, 9.6}, {.40, 3.7, 6.8}, {.14, 2.6, 4.8}, {.050, 1.9, 3.4}, {.66, 5.8, 10.5}}}},
      {Rain(50),
       {{{.66, 6.3, 11.4}, {.93, 4.4, 8.0}, {.33, 3.1, 5.7}, {.12, 2.2, 4.0}, {1.5, 6.9, 12.5}}}},
      {Snow(1.0),
       {{{3.4, 12, 22}, {4.8, 8.7, 16}, {1.7, 6.2, 11}, {.60, 4.4, 7.9}, {7.9, 13.5, 24.5}}}},
      {Snow(2.5),
       {{{4.6, 15, 28}, {6.5, 11, 20}, {2.3, 7.7, 14}, {.81, 5.4, 9.9}, {10.7, 17, 31}}}},
  };
  for (const Row& row : table) {
    const bool is_rain = row.weather.rain_rate_mmph > 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
      const BeamSpec beam{
          .divergence_mrad = {kSensors[k].divergence_mrad, kSensors[k].divergence_mrad}};
      const ParticleEchoes echoes = ParticleEchoesOf(
          is_rain ? RainDropSizes(row.weather) : SnowFlakeSizes(row.weather),
          is_rain ? kDropReflectance : kFlakeReflectance, beam, PowerMin(kSensors[k].range_m));
      const auto& [mean, median_m, p95_m] = row.echoes[k];
      // Rounding to two digits causes errors of up to 4 %.
      EXPECT_NEAR(echoes.mean_count / mean, 1.0, 0.04);
      EXPECT_NEAR(1.538 * echoes.range_scale_m / median_m, 1.0, 0.04);
      EXPECT_NEAR(2.795 * echoes.range_scale_m / p95_m, 1.0, 0.04);
    }
  }
}

// docs/physics.md 4.2: one in 58 detectable drops is stronger than a target of rho 0.5 at 30 m.
TEST(ParticleEchoes, OfThoseThatOutdoABrightTargetThereAreFew) {
  const BeamSpec beam{.divergence_mrad = {3.0, 3.0}};
  const ParticleSizes drops = RainDropSizes(Rain(10.0));
  const double any = ParticleEchoesOf(drops, kDropReflectance, beam, PowerMin(200.0)).mean_count;
  const double stronger =
      ParticleEchoesOf(drops, kDropReflectance, beam, 0.5 / (30.0 * 30.0)).mean_count;
  EXPECT_NEAR(any / stronger, 58.0, 0.5);
}

TEST(ParticleEchoes, TakeAnEllipticBeamAsADiscOfTheSameSolidAngle) {
  const ParticleSizes drops = RainDropSizes(Rain(10.0));
  const auto echoes = [&](double h, double v) {
    return ParticleEchoesOf(drops, kDropReflectance, {.divergence_mrad = {h, v}}, PowerMin(200.0));
  };
  EXPECT_DOUBLE_EQ(echoes(4.0, 1.0).mean_count, echoes(2.0, 2.0).mean_count);
  EXPECT_EQ(echoes(0.0, 1.0).mean_count, 0.0);
}

// rho_eq e^(-2 alpha r) / r^2 >= 0.1 / 200^2 holds up to the ranges of docs/physics.md 4.3 for 65
// sr.
// The received power is proportional to R^-2, so that 0.71 of the range corresponds to 0.71^-2
// times the threshold.
TEST(SunBackground, TakesThePublishedShareOfTheRangeInFullSun) {
  const double gain = SunBackgroundGain({.illuminance_klx = 100.0});
  const double threshold_factor = std::sqrt(1.0 + 0.8 * gain);
  EXPECT_NEAR(1.0 / std::sqrt(threshold_factor), 0.71, 1e-12);
  EXPECT_EQ(SunBackgroundGain({.illuminance_klx = 0.0}), 0.0);
}

TEST(FalseAlarms, AreAMillionthAtNightAndATenThousandthInFullSun) {
  EXPECT_DOUBLE_EQ(FalseAlarmProbability({.illuminance_klx = 0.0}), 1e-6);
  EXPECT_DOUBLE_EQ(FalseAlarmProbability({.illuminance_klx = 100.0}), 1e-4);
}

}  // namespace
}  // namespace railcast
