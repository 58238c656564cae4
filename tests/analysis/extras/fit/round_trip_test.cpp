// Checks that parameters of the simulator are recovered from the points it produces.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/extras/fit/fit.h"
#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumFrames = 6;
constexpr std::uint64_t kNumSeeds = 10;
constexpr double kRange_m = 80.0;

std::vector<Material> StreetMaterials() {
  return {{.name = "road", .reflectivity = 0.2, .facet_slope_deg = 30.0},
          {.name = "wall", .reflectivity = 0.4},
          {.name = "board", .reflectivity = 0.8}};
}

// Walls 12 m to the left and right, a road 2 m below the sensor, and every 15 m a board at varying
// angles to the sensor; the vehicle passes at 47 m/s.
std::shared_ptr<SimpleWorld> MakeStreet() {
  auto world = std::make_shared<SimpleWorld>();
  const auto quad = [](const Vector3& a, const Vector3& u, const Vector3& v) {
    const auto f = [](const Vector3& p) { return Eigen::Vector3f(p.cast<float>()); };
    return Mesh{{f(a), f(a + u), f(a + u + v), f(a + v)}, {{0, 1, 2}, {0, 2, 3}}};
  };
  const Vector3 along(700.0, 0, 0);
  const auto add = [&](const Mesh& mesh, std::uint16_t material) {
    world->ground.parts.push_back({mesh, material, 1});
  };
  add(quad({-50, -12, -2}, along, {0, 24, 0}), 1);
  add(quad({-50, 12, -2}, along, {0, 0, 30}), 2);
  add(quad({-50, -12, -2}, along, {0, 0, 30}), 2);
  for (int i = 0; i < 20; ++i) {
    const double turn_rad = 0.3 * (i % 4);
    // The boards stand on the left, in the middle and on the right in turn, so that they do not
    // hide each other.
    add(quad({20.0 + 15.0 * i, 6.0 - 5.0 * (i % 3), -2},
             {5.0 * std::sin(turn_rad), 5.0 * std::cos(turn_rad), 0}, {0, 0, 3.0 + i}),
        3);
  }
  world->velocity_chunk_mps = Vector3(47.3, -0.61, 0);
  return world;
}

SimulatorSpec SpecOf(Fidelity rung, std::uint64_t seed) {
  SimulatorSpec spec;
  spec.detector.seed = seed;
  spec.detector.effects = EffectsOfRung(rung);
  spec.detector.range_max_m = 300.0;
  spec.detector.plausibility.dropout_probability = 0.1;
  spec.detector.plausibility.noise_shape = NoiseShape::kBeam;
  spec.detector.plausibility.noise_sigma0_m = 0.02;
  spec.detector.plausibility.noise_sigma1 = 2e-4;
  spec.detector.weather.rain_rate_mmph = 25.0;
  spec.detector.receiver.range_at_10_percent_m = kRange_m;
  spec.detector.receiver.range_noise_scale_m = 0.2;
  spec.detector.receiver.pointing_jitter_deg = 0.02;
  spec.detector.receiver.channel_bias_sigma_m = 0.005;
  // The losses at the threshold are not a part of what is fitted.
  spec.detector.effects.threshold = spec.detector.effects.detection =
      spec.detector.effects.detection_probability = false;
  // Rain returns would replace those of surfaces, and the noise of rung surface is fitted in clear
  // air.
  spec.detector.effects.clutter = spec.detector.effects.extinction =
      spec.detector.effects.surface_condition = false;
  return spec;
}

RecordedTrials StreetTrials(const SimulatorSpec& spec) {
  Simulator simulator(MakeStreet(), MakeRaster(60.0, 30.0, 0.5), MaterialLibrary(StreetMaterials()),
                      spec, 0);
  RecordedTrials trials;
  Frame frame;
  for (std::uint32_t index = 0; index < kNumFrames; ++index) {
    simulator.Scan(index, frame);
    trials.Add(TakeTrials(RecordPointsOnly(frame)));
  }
  return trials;
}

struct Expected {
  double truth{};
  /// Relative limit of the mean half width of the intervals, since wider ones would be useless. The
  /// mean value over the seeds, whose standard error is a sixth of that, may be off by half of it.
  double most{};
};

/// How often the interval held the truth, and its width.
struct Tally {
  int holds{};
  double values{};
  double half_widths{};
};

void RoundTrip(Fidelity rung,
               const FitSettings& settings,
               const std::map<std::string, Expected>& expected) {
  std::map<std::string, Tally> tallies;
  for (std::uint64_t seed = 1; seed <= kNumSeeds; ++seed) {
    RecordedTrials trials = StreetTrials(SpecOf(rung, seed));
    const FitResult result = FitModel(trials, settings);
    ASSERT_FALSE(result.noise_by_range.empty());
    for (const NoiseBin& bin : result.noise_by_range) {
      // Of 100 residuals, at five standard errors of a robust scale, 0.117 of it each.
      EXPECT_NEAR(bin.sigma_m.value, bin.fitted_m, 0.59 * bin.fitted_m) << bin.range_m;
    }
    for (const FittedParameter& parameter : result.parameters) {
      const auto found = expected.find(parameter.place);
      if (found == expected.end() || !parameter.estimate.is_enough()) continue;
      const Estimate& estimate = parameter.estimate;
      const double truth = found->second.truth;
      Tally& tally = tallies[parameter.place];
      tally.holds += estimate.low <= truth && truth <= estimate.high ? 1 : 0;
      tally.values += estimate.value / kNumSeeds;
      tally.half_widths += 0.5 * (estimate.high - estimate.low) / truth;
    }
  }
  int holds = 0;
  std::cout
      << "| parameter | truth | mean | interval holds | half width |\n|---|---|---|---|---|\n";
  for (const auto& [place, value] : expected) {
    const Tally tally = tallies[place];
    const double half_width = tally.half_widths / kNumSeeds;
    holds += tally.holds;
    std::cout << "| `" << place << "` | " << value.truth << " | " << tally.values << " | "
              << tally.holds << " of " << kNumSeeds << " | " << std::setprecision(2)
              << 100.0 * half_width << " % |\n"
              << std::setprecision(6);
    EXPECT_NEAR(tally.values, value.truth, 0.5 * value.most * value.truth) << place;
    EXPECT_LE(half_width, value.most) << place;
  }
  // 95 % of the intervals minus four standard deviations.
  const auto num = static_cast<double>(kNumSeeds * expected.size());
  EXPECT_GE(holds, 0.95 * num - 4.0 * std::sqrt(0.95 * 0.05 * num));
}

TEST(FitRoundTrip, RecoversPlausibilityFromPoints) {
  FitSettings settings;
  settings.rain_rate_mmph = 25.0;
  RoundTrip(Fidelity::kPlausibility, settings,
            {{"lidar/plausibility/noise_sigma0_m", {0.02, 0.1}},
             {"lidar/plausibility/noise_sigma1", {2e-4, 0.35}},
             {"lidar/plausibility/dropout_probability", {0.1, 0.2}},
             {"weather/rain_dropout_per_m", {3.65e-4, 0.3}}});
}

TEST(FitRoundTrip, RecoversSurfaceFromPoints) {
  FitSettings settings;
  settings.is_physical = true;
  settings.range_at_10_percent_m = kRange_m;
  settings.snr_at_threshold = 5.0;
  RoundTrip(Fidelity::kSurface, settings,
            {{"lidar/receiver/range_noise_floor_m", {0.015, 0.1}},
             {"lidar/receiver/range_noise_scale_m", {0.2, 0.3}},
             {"lidar/receiver/pointing_jitter_deg", {0.02, 0.5}},
             {"lidar/plausibility/dropout_probability", {0.1, 0.2}}});
}

// With a wall at a single range constant noise cannot be told from noise that grows with range.
TEST(FitLimits, DoesNotTellConstantFromGrowingNoiseAtOneRange) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back({MakeSphere(40.0, 60, 90), 2, 1});
  Simulator simulator(world, MakeRaster(60.0, 30.0, 0.5), MaterialLibrary(StreetMaterials()),
                      SpecOf(Fidelity::kPlausibility, 1), 0);
  Frame frame;
  simulator.Scan(0, frame);
  RecordedTrials trials = TakeTrials(RecordPointsOnly(frame));
  const FitResult result = FitModel(trials, {});
  EXPECT_EQ(result.parameters[1].remark,
            "not identified: constant and growing noise cannot be told apart at about one range");
  EXPECT_FALSE(result.parameters[1].estimate.is_enough());
  EXPECT_TRUE(result.parameters[0].estimate.is_enough());
}

TEST(FitLimits, SaysThatPointsAloneDoNotShowLosses) {
  Simulator simulator(MakeStreet(), MakeRaster(60.0, 30.0, 0.5), MaterialLibrary(StreetMaterials()),
                      SpecOf(Fidelity::kSurface, 1), 0);
  Frame frame;
  simulator.Scan(0, frame);
  RecordedFrame recorded = RecordPointsOnly(frame);
  recorded.is_grid = false;
  RecordedTrials trials = TakeTrials(recorded);
  EXPECT_GT(trials.noise.size(), 300U);
  FitSettings settings;
  settings.is_physical = true;
  const FitResult result = FitModel(trials, settings);
  for (const FittedParameter& parameter : result.parameters) {
    if (parameter.place == "lidar/plausibility/dropout_probability") {
      EXPECT_EQ(parameter.remark,
                "not identified: the recording has points only, what is lost leaves no trace");
      EXPECT_FALSE(parameter.estimate.is_enough());
    }
    if (parameter.place == "lidar/receiver/range_noise_scale_m") {
      EXPECT_EQ(parameter.remark,
                "not identified: the signal is not known; it wants intensities that are "
                "reflectances and --range-at-10-percent-m");
    }
  }
}

TEST(FitLimits, GivesNoNumberFromNothing) {
  for (const bool is_physical : {false, true}) {
    RecordedTrials trials;
    FitSettings settings;
    settings.is_physical = is_physical;
    settings.range_at_10_percent_m = kRange_m;
    settings.snr_at_threshold = 5.0;
    for (const FittedParameter& parameter : FitModel(trials, settings).parameters) {
      EXPECT_FALSE(parameter.estimate.is_enough()) << parameter.title;
      EXPECT_TRUE(parameter.remark.starts_with("not identified")) << parameter.title;
    }
  }
}

}  // namespace
}  // namespace railcast
