// A labelled cloud without truth: noise and reflectance by label, from flat pieces of surface.
#include "analysis/fit/label_trials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "analysis/fit/fit.h"
#include "analysis/fit/trial_sample.h"
#include "tests/analysis/fit/made_street.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

// Walls at 10, 30 and 80 m beside each other, of reflectivity 0.1, 0.5 and 1 and labels 1 to 3.
std::shared_ptr<SimpleWorld> MakeWalls() {
  auto world = std::make_shared<SimpleWorld>();
  const auto wall = [](float x_m, float right_m, float left_m) {
    return Mesh{
        {{x_m, right_m, -x_m}, {x_m, left_m, -x_m}, {x_m, left_m, x_m}, {x_m, right_m, x_m}},
        {{0, 1, 2}, {0, 2, 3}}};
  };
  world->ground.parts = {
      {wall(10, -6, -2), 1, 1}, {wall(30, -6, 6), 2, 2}, {wall(80, 16, 50), 3, 3}};
  return world;
}

RecordedFrame WithLabelsOnly(const Frame& frame) {
  RecordedFrame recorded = RecordPointsOnly(frame);
  recorded.fields.emplace("label");
  return recorded;
}

TEST(LabelTrials, GiveNoiseAndReflectances) {
  SimulatorSpec spec{.effects = {.threshold = true, .noise = true}};
  spec.plausibility.noise_sigma0_m = 0.01;
  spec.plausibility.noise_sigma1 = 5e-4;
  spec.plausibility.noise_shape = "beam";
  Simulator simulator(MakeWalls(), MakeRaster(60.0, 30.0, 0.25), TestMaterials(), spec, 0);
  TrialSample sample;
  Frame frame;
  for (std::uint32_t index = 0; index < 20; ++index) {
    simulator.Scan(index, frame);
    const RecordedFrame recorded = WithLabelsOnly(frame);
    const auto scan = MakeScanTable(recorded.frame);
    SensorFacts facts;
    facts.scan = &*scan;
    ForEachLabelTrial(recorded, facts, [&](const Trial& trial, std::size_t slot) {
      sample.Add(trial, (std::uint64_t{index} << 32U) + slot);
    });
  }
  std::vector<Trial> trials = sample.trials();
  ASSERT_GT(trials.size(), 5000U);
  FitSettings settings;
  settings.knows_losses = false;
  const FitResult result = FitModel(trials,
                                    {MakeLambertSurface("none"), MakeLambertSurface("dark"),
                                     MakeLambertSurface("grey"), MakeLambertSurface("white")},
                                    settings);
  EXPECT_NEAR(ParameterOf(result, "lidar/plausibility/noise_sigma0_m").estimate.value, 0.01, 1e-3);
  EXPECT_NEAR(ParameterOf(result, "lidar/plausibility/noise_sigma1").estimate.value, 5e-4, 5e-5);
  // What is lost nobody knows.
  EXPECT_FALSE(ParameterOf(result, "lidar/plausibility/reference_range_m").estimate.is_enough());
  const double reflectivity[] = {0.1, 0.5, 1.0};
  int num_surfaces = 0;
  for (const SurfaceFit& surface : result.surfaces) {
    if (surface.num_trials == 0) continue;
    const double truth = reflectivity[num_surfaces++];
    EXPECT_NEAR(surface.reflectance.value / truth, 1.0, 0.01) << surface.name;
  }
  EXPECT_EQ(num_surfaces, 3);
}

TEST(LabelTrials, AreNoneOfPiecesOfSeveralLabelsOrOfNothing) {
  Frame frame = ScanOnce(MakeWalls(), MakeRaster(60.0, 30.0, 0.25));
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    frame.label[slot] = slot % frame.width() % 2 == 0 ? 1 : 0;
  }
  const RecordedFrame recorded = WithLabelsOnly(frame);
  const auto scan = MakeScanTable(frame);
  SensorFacts facts;
  facts.scan = &*scan;
  ForEachLabelTrial(recorded, facts, [](const Trial&, std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace railcast
