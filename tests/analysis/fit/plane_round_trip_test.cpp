// The same without truth: points in a grid, and planes that are given a little wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/fit/fit.h"
#include "analysis/fit/plane_trials.h"
#include "analysis/fit/trial_sample.h"
#include "core/io/recording/scan_table.h"
#include "tests/analysis/fit/made_street.h"

namespace railcast {
namespace {

// A wall at 25 m that slants by 0.3 rad, and ground 2 m below.
std::shared_ptr<SimpleWorld> MakeYard() {
  auto world = std::make_shared<SimpleWorld>();
  const auto at = [](double y_m, double z_m) {
    return Eigen::Vector3f(static_cast<float>(25.0 + std::tan(0.3) * y_m), static_cast<float>(y_m),
                           static_cast<float>(z_m));
  };
  world->ground.parts = {
      {Mesh{{at(-6, -2), at(6, -2), at(6, 6), at(-6, 6)}, {{0, 1, 2}, {0, 2, 3}}}, 3, 1},
      {MakeFloor(-2.0F, 200.0F), 1, 1}};
  return world;
}

// 4 cm off and turned by 0.02 rad: what a tape measure gives.
std::vector<KnownPlane> GivenPlanes() {
  KnownPlane wall;
  wall.name = "wall";
  wall.point_m = Vector3(25.04, 0, 1.5);
  wall.normal = Vector3(-std::cos(0.32), std::sin(0.32), 0.0);
  wall.radius_m = 3.0;
  KnownPlane ground;
  ground.name = "ground";
  ground.point_m = Vector3(9, 0, -2.03);
  ground.normal = Vector3(0.01, 0, 1).normalized();
  // Clear of the wall's foot.
  ground.corners_m = {{4, -3, -2.03}, {20, -6, -2.03}, {20, 6, -2.03}, {4, 3, -2.03}};
  return {wall, ground};
}

struct Yard {
  std::vector<Trial> trials;
  std::vector<FitSurface> surfaces;
};

Yard FitYard(const SimulatorSpec& spec, bool is_isotropic) {
  constexpr std::uint32_t kNumFrames = 20;
  Simulator simulator(MakeYard(), MakeRaster(40.0, 30.0, 0.25), MaterialLibrary(StreetMaterials()),
                      spec, 0);
  std::vector<RecordedFrame> frames;
  std::vector<Vector3> points_m;
  for (std::uint32_t index = 0; index < kNumFrames; ++index) {
    Frame frame;
    simulator.Scan(index, frame);
    frames.push_back(AsRecorded(frame));
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (index >= 5 || std::isnan(frame.x[slot])) continue;
      points_m.push_back(
          Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>());
    }
  }
  Yard yard;
  PlaneScene scene{GivenPlanes(), {0, 1}, is_isotropic};
  EXPECT_EQ(RefinePlanes(points_m, scene.planes).size(), 2U);
  yard.surfaces = {MakeShapedSurface(StreetMaterials()[2], 905, 0.0),
                   MakeShapedSurface(StreetMaterials()[0], 905, 0.0)};
  const std::optional<ScanTable> scan = MakeScanTable(frames[0].frame);
  const SensorFacts facts{spec.range_min_m, spec.range_max_m, spec.beam, &*scan};
  TrialSample sample;
  for (std::uint64_t index = 0; index < frames.size(); ++index) {
    ForEachPlaneTrial(frames[index], scene, facts, [&](const Trial& trial, std::size_t slot) {
      sample.Add(trial, (index << 32U) + slot);
    });
  }
  yard.trials = sample.trials();
  return yard;
}

void ExpectWithin(const FitResult& result, const char* place, double truth, double most_half) {
  const Estimate& estimate = ParameterOf(result, place).estimate;
  ASSERT_TRUE(estimate.is_enough()) << place;
  EXPECT_LE(estimate.low, truth) << place;
  EXPECT_GE(estimate.high, truth) << place;
  EXPECT_LE(0.5 * (estimate.high - estimate.low), most_half * truth) << place;
}

TEST(FitOfPlanes, RecoversPlausibilityWithoutTruth) {
  SimulatorSpec spec = StreetSpec("plausibility", 4);
  spec.plausibility.reference_range_m = 30.0;
  spec.plausibility.noise_sigma0_m = 0.02;
  spec.plausibility.noise_sigma1 = 1e-3;
  spec.plausibility.dropout_probability = 0.15;
  Yard yard = FitYard(spec, true);
  FitSettings settings;
  settings.extinction_per_m = 0.0;
  const FitResult result = FitModel(yard.trials, yard.surfaces, settings);
  ExpectWithin(result, "lidar/plausibility/noise_sigma0_m", 0.02, 0.1);
  ExpectWithin(result, "lidar/plausibility/noise_sigma1", 1e-3, 0.1);
  ExpectWithin(result, "lidar/plausibility/dropout_probability", 0.15, 0.2);
  ExpectWithin(result, "lidar/plausibility/reference_range_m", 30.0, 0.04);
  EXPECT_NEAR(SurfaceOf(result, "right_wall").reflectance.value, 0.6, 0.006);
  EXPECT_NEAR(SurfaceOf(result, "road").reflectance.value, 0.2, 0.004);
}

TEST(FitOfPlanes, RecoversSurfaceWithItsPointingWithoutTruth) {
  SimulatorSpec spec = StreetSpec("surface", 5);
  spec.receiver.range_at_10_percent_m = 25.0;
  spec.receiver.pointing_jitter_deg = 0.05;
  spec.plausibility.dropout_probability = 0.15;
  Yard yard = FitYard(spec, false);
  FitSettings settings;
  settings.is_physical = true;
  settings.extinction_per_m = 0.0;
  const FitResult result = FitModel(yard.trials, yard.surfaces, settings);
  ExpectWithin(result, "lidar/plausibility/dropout_probability", 0.15, 0.1);
  ExpectWithin(result, "lidar/receiver/range_noise_floor_m", 0.015, 0.2);
  ExpectWithin(result, "lidar/receiver/channel_bias_sigma_m", 0.01, 0.4);
  ExpectWithin(result, "lidar/receiver/range_at_10_percent_m", 25.0, 0.08);
  ExpectWithin(result, "lidar/receiver/snr_at_threshold", 5.0, 0.6);
  // Ranges on the ground are linear in the angle only nearly: a per cent.
  EXPECT_NEAR(ParameterOf(result, "lidar/receiver/pointing_jitter_deg").estimate.value, 0.05,
              0.001);
}

}  // namespace
}  // namespace railcast
