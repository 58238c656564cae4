#include "core/fidelity/beam_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/fidelity/frame_comparison.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/echo_frame.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Sigma is a quarter of the wider divergence: 1 mrad.
constexpr BeamSpec kBeam{.divergence_mrad = {4.0, 1.0}};

std::vector<float> Steps(const std::vector<std::vector<MadeEcho>>& firings,
                         const StepLimits& limits = kReferenceSteps,
                         float incidence_rad = 0.0F) {
  Frame frame = MakeEchoFrame(firings);
  for (float& value : frame.incidence_rad) value = incidence_rad;
  return StepsOf(frame, kBeam, limits);
}

MadeEcho Part(float range_m, float share) {
  return {range_m, 3, 0.2F, share};
}

TEST(StepsOf, AreTheGapsBetweenPartsOneBehindTheOther) {
  const std::vector<float> steps_m =
      Steps({{Part(20.3F, 0.6F), Part(20.0F, 0.4F)},
             {Part(20.0F, 0.6F), Part(20.1F, 0.2F), Part(20.4F, 0.2F)},
             {Part(20.0F, 1.0F)},
             {}});
  EXPECT_NEAR(static_cast<double>(steps_m[0]), 0.3, 1e-5);
  EXPECT_NEAR(static_cast<double>(steps_m[1]), 0.3, 1e-5);
  EXPECT_TRUE(std::isnan(steps_m[2]));
  EXPECT_TRUE(std::isnan(steps_m[3]));
}

TEST(StepsOf, LeaveOutGapsBeyondTheirLimitsAndSmallParts) {
  const std::vector<std::vector<MadeEcho>> firings = {{Part(20.0F, 0.6F), Part(20.04F, 0.4F)},
                                                      {Part(20.0F, 0.6F), Part(20.6F, 0.4F)},
                                                      {Part(20.0F, 0.96F), Part(20.2F, 0.04F)}};
  for (const float step_m : Steps(firings)) EXPECT_TRUE(std::isnan(step_m));
  for (const float step_m : Steps(firings, kFoundSteps)) EXPECT_FALSE(std::isnan(step_m));
}

// At 20 m and 85 deg a beam of 1 mrad has a spread of 0.23 m.
TEST(StepsOf, AreNotThoseOfASlope) {
  EXPECT_TRUE(
      std::isnan(Steps({{Part(20.0F, 0.6F), Part(20.4F, 0.4F)}}, kReferenceSteps, 1.4835F)[0]));
  EXPECT_FALSE(
      std::isnan(Steps({{Part(20.0F, 0.6F), Part(20.4F, 0.4F)}}, kReferenceSteps, 1.2F)[0]));
}

// Beams of 3 mrad whose centres are up to two sigmas from a plate's edge, before a wall.
std::shared_ptr<SimpleWorld> PlateBeforeWall(float step_m) {
  return WorldOfParts(
      {{{{{20, -9, -9}, {20, 0, -9}, {20, 0, 9}, {20, -9, 9}}, {{0, 1, 2}, {0, 2, 3}}}, 2, 7},
       {MakeWall(20.0F + step_m, 9.0F), 2, 8}});
}

TEST(ShowParts, ShowsAStepThatTheSensorsOwnPulsesMerge) {
  SimulatorSpec spec{
      .detector = {.effects = WithoutRangeErrors(EffectsOfRung(Fidelity::kReference))}};
  spec.detector.effects.pointing_jitter = false;
  spec.detector.beam = {.divergence_mrad = {3.0, 3.0}};
  const ScanPattern pattern = MakeRaster(0.1, 0.1, 0.05);  // Two columns, 0.6 sigma off the edge.
  for (const float step_m : {0.07F, 0.2F, 0.45F}) {
    spec.detector.receiver.return_mode = ReturnMode::kTriple;
    const Frame own = ScanOnce(PlateBeforeWall(step_m), pattern, spec);
    const Frame parts = ScanOnce(PlateBeforeWall(step_m), pattern, ShowParts(spec));
    for (const float found_m : StepsOf(own, spec.detector.beam, kReferenceSteps)) {
      EXPECT_TRUE(std::isnan(found_m)) << step_m;
    }
    for (const float found_m : StepsOf(parts, spec.detector.beam, kReferenceSteps)) {
      EXPECT_NEAR(static_cast<double>(found_m), static_cast<double>(step_m), 1e-3);
    }
  }
}

}  // namespace
}  // namespace railcast
