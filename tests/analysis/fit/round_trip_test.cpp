// Parameters that are put into the simulator come out of its frames, within the intervals stated.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "analysis/fit/fit.h"
#include "tests/analysis/fit/made_street.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumFrames = 6;
constexpr std::uint64_t kNumSeeds = 20;
constexpr double kVisibility_m = 800.0;

// Of intervals that hold 19 times in 20, fewer than 17 of 20 hold once in 63 times.
constexpr int kLeastHolds = 17;

SimulatorSpec PlausibilitySpecOf(std::uint64_t seed) {
  SimulatorSpec spec = StreetSpec("plausibility", seed);
  spec.plausibility.reference_range_m = 80.0;
  spec.plausibility.noise_sigma0_m = 0.02;
  spec.plausibility.noise_sigma1 = 2e-4;
  spec.plausibility.dropout_probability = 0.1;
  spec.weather.rain_rate_mmph = 25.0;
  spec.weather.fog_density_per_m = 0.004;
  return spec;
}

SimulatorSpec SurfaceSpecOf(std::uint64_t seed) {
  SimulatorSpec spec = StreetSpec("surface", seed);
  spec.plausibility.dropout_probability = 0.1;
  spec.receiver.range_at_10_percent_m = 70.0;
  spec.receiver.snr_at_threshold = 6.0;
  spec.receiver.range_noise_scale_m = 0.2;
  spec.weather.visibility_m = kVisibility_m;
  // They hide what beams should have met.
  spec.effects.fog_echo = spec.effects.clutter = false;
  return spec;
}

/// How often the truth lay in the interval, and how wide that was.
struct Tally {
  int num{};
  int holds{};
  double half_widths{};  ///< Sum, relative to the truth.

  void Add(const Estimate& estimate, double truth) {
    if (!estimate.is_enough()) return;
    ++num;
    holds += estimate.low <= truth && truth <= estimate.high ? 1 : 0;
    half_widths += 0.5 * (estimate.high - estimate.low) / truth;
  }
};

struct Expected {
  double truth{};
  double most_half_width{};  ///< Relative, mean over the seeds: wider would be of no use.
};

using ExpectedByName = std::map<std::string, Expected>;

void ExpectRecovered(const ExpectedByName& expected, const std::map<std::string, Tally>& tallies) {
  std::cout << "| parameter | truth | interval holds | half width |\n|---|---|---|---|\n";
  for (const auto& [name, value] : expected) {
    const auto found = tallies.find(name);
    ASSERT_NE(found, tallies.end()) << name;
    const Tally& tally = found->second;
    const double half_width = tally.half_widths / tally.num;
    std::cout << "| " << name << " | " << value.truth << " | " << tally.holds << " of " << tally.num
              << " | " << std::setprecision(2) << 100.0 * half_width << " % |\n"
              << std::setprecision(6);
    EXPECT_EQ(tally.num, static_cast<int>(kNumSeeds)) << name;
    EXPECT_GE(tally.holds, kLeastHolds) << name;
    EXPECT_LE(half_width, value.most_half_width) << name;
  }
}

void RoundTrip(SimulatorSpec (*make_spec)(std::uint64_t),
               const FitSettings& settings,
               const ExpectedByName& expected) {
  std::map<std::string, Tally> tallies;
  for (std::uint64_t seed = 1; seed <= kNumSeeds; ++seed) {
    std::vector<Trial> trials = StreetTrials(make_spec(seed), kNumFrames);
    const FitResult result = FitModel(trials, StreetSurfaces(), settings);
    for (const FittedParameter& parameter : result.parameters) {
      const std::string name = parameter.place.empty() ? parameter.title : parameter.place;
      const auto found = expected.find(name);
      if (found != expected.end()) tallies[name].Add(parameter.estimate, found->second.truth);
    }
    for (const SurfaceFit& surface : result.surfaces) {
      const auto found = expected.find(surface.name);
      if (found != expected.end()) {
        tallies[surface.name].Add(surface.reflectance, found->second.truth);
      }
    }
  }
  ExpectRecovered(expected, tallies);
}

TEST(FitRoundTrip, RecoversPlausibilityWithIntensities) {
  FitSettings settings;
  settings.rain_rate_mmph = 25.0;
  RoundTrip(&PlausibilitySpecOf, settings,
            {{"lidar/plausibility/reference_range_m", {80.0, 0.02}},
             {"weather/fog_density_per_m", {0.004, 0.15}},
             {"lidar/plausibility/dropout_probability", {0.1, 0.2}},
             {"weather/rain_dropout_per_m", {3.65e-4, 0.3}},
             {"lidar/plausibility/noise_sigma0_m", {0.02, 0.05}},
             {"lidar/plausibility/noise_sigma1", {2e-4, 0.15}},
             {"road", {0.2, 1e-4}},
             {"left_wall", {0.35, 1e-4}},
             {"right_wall", {0.6, 1e-4}},
             {"gate", {0.1, 1e-4}},
             {"board", {0.5, 1e-4}}});
}

TEST(FitRoundTrip, RecoversSurfaceWithIntensities) {
  FitSettings settings;
  settings.is_physical = true;
  RoundTrip(&SurfaceSpecOf, settings,
            {{"lidar/receiver/range_at_10_percent_m", {70.0, 0.06}},
             {"lidar/receiver/snr_at_threshold", {6.0, 0.15}},
             {"Extinction of the air", {std::log(20.0) / kVisibility_m, 0.3}},
             {"lidar/plausibility/dropout_probability", {0.1, 0.1}},
             {"lidar/receiver/range_noise_floor_m", {0.015, 0.06}},
             {"lidar/receiver/range_noise_scale_m", {0.2, 0.1}},
             {"lidar/receiver/channel_bias_sigma_m", {0.01, 0.25}},
             {"road", {0.2, 1e-4}},
             {"left_wall", {0.35, 1e-4}},
             {"right_wall", {0.6, 1e-4}},
             {"gate", {0.1, 1e-4}},
             {"board", {0.5, 1e-4}}});
}

TEST(FitRoundTrip, RecoversReflectancesFromLossesWhereTheDataSheetFixesTheThreshold) {
  FitSettings settings;
  settings.is_physical = true;
  settings.has_reflectances = false;
  settings.range_at_10_percent_m = 70.0;
  settings.extinction_per_m = std::log(20.0) / kVisibility_m;
  RoundTrip(&SurfaceSpecOf, settings,
            {{"lidar/receiver/snr_at_threshold", {6.0, 0.15}},
             {"road", {0.2, 0.06}},
             {"left_wall", {0.35, 0.06}},
             {"right_wall", {0.6, 0.06}}});
}

TEST(FitRoundTrip, RecoversThresholdAndReflectancesFromOneKnownMaterial) {
  FitSettings settings;
  settings.is_physical = true;
  settings.has_reflectances = false;
  settings.known["road"] = 0.2;
  settings.extinction_per_m = std::log(20.0) / kVisibility_m;
  RoundTrip(&SurfaceSpecOf, settings,
            {{"lidar/receiver/range_at_10_percent_m", {70.0, 0.04}},
             {"left_wall", {0.35, 0.08}},
             {"right_wall", {0.6, 0.08}}});
}

TEST(FitRoundTrip, RecoversPlausibilityFromOneKnownMaterial) {
  FitSettings settings;
  settings.has_reflectances = false;
  settings.known["right_wall"] = 0.6;
  settings.extinction_per_m = 0.004;
  RoundTrip(&PlausibilitySpecOf, settings,
            {{"lidar/plausibility/reference_range_m", {80.0, 0.05}}, {"left_wall", {0.35, 0.05}}});
}

}  // namespace
}  // namespace railcast
