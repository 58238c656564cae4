// What a recording does not identify is said in words, never as a number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "analysis/fit/fit.h"
#include "tests/analysis/fit/made_street.h"

namespace railcast {
namespace {

constexpr const char* kThreshold = "lidar/receiver/range_at_10_percent_m";
constexpr const char* kReference = "lidar/plausibility/reference_range_m";

FitSettings Physical() {
  FitSettings settings;
  settings.is_physical = true;
  return settings;
}

std::vector<Trial> SurfaceTrials(double range_at_10_percent_m, std::uint32_t num_frames = 4) {
  SimulatorSpec spec = StreetSpec("surface", 1);
  spec.receiver.range_at_10_percent_m = range_at_10_percent_m;
  return StreetTrials(spec, num_frames);
}

// The number after "at least".
double BoundIn(const std::string& remark) {
  const std::size_t at = remark.find("at least ");
  return at == std::string::npos ? std::nan("") : std::stod(remark.substr(at + 9));
}

TEST(FitLimits, BoundsTheThresholdWhereNoBeamIsLostToIt) {
  std::vector<Trial> trials = SurfaceTrials(20'000.0);
  const FitResult result = FitModel(trials, StreetSurfaces(), Physical());
  const FittedParameter& threshold = ParameterOf(result, kThreshold);
  EXPECT_FALSE(threshold.estimate.is_enough());
  EXPECT_NE(threshold.remark.find("no beam is lost to the threshold"), std::string::npos);
  const double bound_m = BoundIn(threshold.remark);
  EXPECT_GT(bound_m, 50.0);
  EXPECT_LE(bound_m, 20'000.0);
  // Nor is what follows from it.
  EXPECT_FALSE(ParameterOf(result, "lidar/receiver/snr_at_threshold").estimate.is_enough());
  const FittedParameter& scale = ParameterOf(result, "lidar/receiver/range_noise_scale_m");
  EXPECT_FALSE(scale.estimate.is_enough());
  EXPECT_NE(scale.remark.find("not identified"), std::string::npos);
  // Reflectances are, from intensities.
  EXPECT_NEAR(SurfaceOf(result, "road").reflectance.value, 0.2, 1e-5);
}

TEST(FitLimits, GivesOnlyRatiosWhereNothingFixesTheScale) {
  FitSettings settings = Physical();
  settings.has_reflectances = false;
  settings.extinction_per_m = 0.0;
  std::vector<Trial> trials = SurfaceTrials(70.0);
  const FitResult result = FitModel(trials, StreetSurfaces(), settings);
  EXPECT_EQ(ParameterOf(result, kThreshold).remark,
            "not identified: reflectance and threshold enter detection only as a ratio; give "
            "--range-at-10-percent-m or --known");
  for (const SurfaceFit& surface : result.surfaces) {
    EXPECT_FALSE(surface.reflectance.is_enough()) << surface.name;
    EXPECT_NE(surface.remark.find("not identified"), std::string::npos) << surface.name;
  }
  // sqrt(rho / P_min) of the Lambertian.
  const Estimate& facing_m = SurfaceOf(result, "right_wall").facing_range_m;
  EXPECT_LE(facing_m.low, 70.0 * std::sqrt(6.0));
  EXPECT_GE(facing_m.high, 70.0 * std::sqrt(6.0));
}

// Things that face the beam are lost at one range: any air could have done it.
TEST(FitLimits, DoesNotTellTheThresholdFromTheAirByOneRange) {
  std::vector<Trial> trials = SurfaceTrials(70.0, 12);
  std::erase_if(trials, [](const Trial& trial) { return trial.surface != 4; });
  FitResult result = FitModel(trials, StreetSurfaces(), Physical());
  EXPECT_EQ(ParameterOf(result, kThreshold).remark,
            "not identified: beams are lost at about one range only, so that threshold and "
            "extinction cannot be told apart; give --extinction-per-m");
  FitSettings settings = Physical();
  settings.extinction_per_m = 0.0;
  result = FitModel(trials, StreetSurfaces(), settings);
  const Estimate& threshold_m = ParameterOf(result, kThreshold).estimate;
  EXPECT_LE(threshold_m.low, 70.0);
  EXPECT_GE(threshold_m.high, 70.0);
}

TEST(FitLimits, KnowsOnlyTheProductOfRainRateAndDropoutRate) {
  SimulatorSpec spec = StreetSpec("plausibility", 2);
  spec.weather.rain_rate_mmph = 25.0;
  std::vector<Trial> trials = StreetTrials(spec, 4);
  const FitResult result = FitModel(trials, StreetSurfaces(), {});
  const double rate_per_m = 3.65e-4 * std::pow(25.0, 0.63);
  const Estimate& product = ParameterOf(result, "Rain dropout rate, k x rain rate^e").estimate;
  EXPECT_LE(product.low, rate_per_m);
  EXPECT_GE(product.high, rate_per_m);
  const FittedParameter& alone = ParameterOf(result, "weather/rain_dropout_per_m");
  EXPECT_FALSE(alone.estimate.is_enough());
  EXPECT_NE(alone.remark.find("--rain-rate-mmph"), std::string::npos);
}

TEST(FitLimits, GivesNoNumberFromFewTrialsOrNone) {
  const std::vector<Trial> all = SurfaceTrials(70.0, 1);
  for (const std::size_t num : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{9}}) {
    for (const bool is_physical : {false, true}) {
      std::vector<Trial> trials(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(num));
      FitSettings settings;
      settings.is_physical = is_physical;
      const FitResult result = FitModel(trials, StreetSurfaces(), settings);
      for (const FittedParameter& parameter : result.parameters) {
        EXPECT_TRUE(std::isnan(parameter.estimate.value)) << num << parameter.title;
        EXPECT_TRUE(parameter.remark.starts_with("not identified")) << num << parameter.title;
      }
      for (const SurfaceFit& surface : result.surfaces) {
        EXPECT_TRUE(std::isnan(surface.reflectance.value)) << num << surface.name;
      }
    }
  }
}

TEST(FitLimits, KeepsNotANumberOutOfTheFigures) {
  std::vector<Trial> trials = SurfaceTrials(70.0, 1);
  for (Trial& trial : trials) {
    trial.residual_m = trial.intensity = std::numeric_limits<float>::quiet_NaN();
  }
  const FitResult result = FitModel(trials, StreetSurfaces(), Physical());
  for (const FittedParameter& parameter : result.parameters) {
    EXPECT_EQ(std::isnan(parameter.estimate.value), std::isnan(parameter.estimate.low));
  }
  EXPECT_FALSE(ParameterOf(result, "lidar/receiver/range_noise_floor_m").estimate.is_enough());
  EXPECT_FALSE(SurfaceOf(result, "road").reflectance.is_enough());
}

TEST(FitLimits, SaysThatPointsAloneDoNotShowLosses) {
  std::vector<Trial> trials = SurfaceTrials(70.0, 2);
  std::erase_if(trials, [](const Trial& trial) { return trial.answer == Answer::kLost; });
  FitSettings settings = Physical();
  settings.knows_losses = false;
  const FitResult result = FitModel(trials, StreetSurfaces(), settings);
  for (const char* place : {kThreshold, "lidar/plausibility/dropout_probability"}) {
    EXPECT_FALSE(ParameterOf(result, place).estimate.is_enough());
    EXPECT_NE(ParameterOf(result, place).remark.find("leaves no trace"), std::string::npos);
  }
}

// One returned trial in twenty is somewhere else, with any intensity.
std::vector<Trial> WildTrials(bool is_physical, std::uint64_t seed) {
  SimulatorSpec spec = StreetSpec(is_physical ? "surface" : "plausibility", seed);
  spec.plausibility.reference_range_m = 80.0;
  spec.plausibility.dropout_probability = 0.1;
  spec.receiver.range_at_10_percent_m = 70.0;
  std::vector<Trial> trials = StreetTrials(spec, 4);
  std::mt19937 random(static_cast<unsigned>(seed));
  for (Trial& trial : trials) {
    if (trial.answer != Answer::kReturned || random() % 20 != 0) continue;
    trial.residual_m = static_cast<float>(random() % 40'000) * 1e-3F - 20.0F;
    trial.intensity = static_cast<float>(random() % 1000) * 1e-3F;
  }
  return trials;
}

TEST(FitLimits, StandsWildPoints) {
  constexpr std::uint64_t kNumSeeds = 10;
  for (const bool is_physical : {false, true}) {
    std::map<std::string, int> holds;
    for (std::uint64_t seed = 1; seed <= kNumSeeds; ++seed) {
      std::vector<Trial> trials = WildTrials(is_physical, seed);
      FitSettings settings;
      settings.is_physical = is_physical;
      const FitResult result = FitModel(trials, StreetSurfaces(), settings);
      const auto count = [&](const char* place, double truth) {
        const Estimate& estimate = ParameterOf(result, place).estimate;
        holds[place] += estimate.low <= truth && truth <= estimate.high ? 1 : 0;
      };
      count(is_physical ? kThreshold : kReference, is_physical ? 70.0 : 80.0);
      count("lidar/plausibility/dropout_probability", 0.1);
      if (is_physical) {
        count("lidar/receiver/range_noise_floor_m", 0.015);
      } else {
        count("lidar/plausibility/noise_sigma0_m", 0.01);
        count("lidar/plausibility/noise_sigma1", 1e-4);
      }
      EXPECT_NEAR(SurfaceOf(result, "road").reflectance.value, 0.2, 1e-3);
    }
    // Of 10 that hold 19 times in 20, fewer than 8 hold once in 87 times.
    for (const auto& [place, num] : holds) EXPECT_GE(num, 8) << place;
  }
}

}  // namespace
}  // namespace railcast
