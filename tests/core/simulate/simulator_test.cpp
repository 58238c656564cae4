#include "railcast/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/io/message_of.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint32_t kWallLabel = 7;

std::shared_ptr<const Model> WallModel(float distance_m, float half_m, std::uint16_t material = 2) {
  return std::make_shared<Model>(
      Model{"wall", {{MakeWall(distance_m, half_m), material, kWallLabel}}});
}

std::shared_ptr<SimpleWorld> WorldWithWall(float distance_m, float half_m = 1000.0F) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground = *WallModel(distance_m, half_m);
  return world;
}

std::size_t CountOutcome(const Frame& frame, Outcome outcome) {
  return static_cast<std::size_t>(std::count(frame.outcome.begin(), frame.outcome.end(), outcome));
}

TEST(Simulator, FillsEveryFieldOfAReturn) {
  const Frame frame = ScanOnce(WorldWithWall(20.0F), MakeRaster(10, 10, 1));
  ASSERT_EQ(frame.num_slots(), 100U);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double x = static_cast<double>(frame.x[slot]);
    const double range = static_cast<double>(frame.range_m[slot]);
    EXPECT_NEAR(x, 20.0, 1e-5);
    EXPECT_NEAR(static_cast<double>(frame.incidence_rad[slot]), std::acos(20.0 / range), 2e-4);
    EXPECT_EQ(frame.outcome[slot], Outcome::kReturned);
    EXPECT_EQ(frame.true_range_m[slot], frame.range_m[slot]);
    EXPECT_EQ(frame.label[slot], kWallLabel);
    EXPECT_EQ(frame.material[slot], 2);
    EXPECT_EQ(frame.return_count[slot], 1);
    EXPECT_EQ(frame.ring[slot], slot / 10);
    EXPECT_EQ(frame.column[slot], slot % 10);
    EXPECT_EQ(frame.time_ns[slot], 10'000'000U * (slot % 10));
    EXPECT_TRUE(std::isnan(frame.intensity[slot]));
    EXPECT_TRUE(std::isnan(frame.power_ratio[slot]));
  }
  // Row 0 looks down; column 0 looks left.
  EXPECT_LT(frame.z.front(), 0.0F);
  EXPECT_GT(frame.y.front(), 0.0F);
}

TEST(Simulator, GivesEachBlockedFiringItsCause) {
  const ScanPattern pattern = MakeRaster(10, 10, 1);
  const SimulatorSpec spec{.detector = {.range_min_m = 1.0, .range_max_m = 50.0}};
  EXPECT_EQ(CountOutcome(ScanOnce(WorldWithWall(0.5F), pattern, spec), Outcome::kNearRange), 100U);
  const Frame far = ScanOnce(WorldWithWall(60.0F), pattern, spec);
  EXPECT_EQ(CountOutcome(far, Outcome::kNoSurface), 100U);
  EXPECT_EQ(far.label[0], 0U);
  EXPECT_TRUE(std::isnan(far.x[0]) && std::isnan(far.range_m[0]) &&
              std::isnan(far.true_range_m[0]));

  auto world = WorldWithWall(20.0F);
  world->AddObject(WallModel(0.2F, 100.0F), Transform::Identity(), Vector3::Zero(), true);
  const Frame ego = ScanOnce(world, pattern, spec);
  EXPECT_EQ(CountOutcome(ego, Outcome::kEgo), 100U);
  EXPECT_TRUE(std::isnan(ego.x[0]));
  EXPECT_NEAR(static_cast<double>(ego.true_range_m[45]), 0.2, 1e-3);
}

std::string FaultOf(const SimulatorSpec& spec) {
  return MessageOf(
      [&] { Simulator(WorldWithWall(5.0F), MakeRaster(10, 10, 1), TestMaterials(), spec, 1); });
}

TEST(Simulator, ThrowsForNumbersThatItCannotWorkWith) {
  SimulatorSpec spec{.detector = {.effects = {.surface_response = true}}};
  EXPECT_EQ(FaultOf(spec), "no error");
  spec.detector.beam.wavelength_nm = 1064;
  EXPECT_EQ(FaultOf(spec), "/beam/wavelength_nm: must be 905 or 1550 (got 1064)");
  spec = {};
  spec.snow_material = 999;
  EXPECT_EQ(FaultOf(spec), "/snow_material: must be the index of one of " +
                               std::to_string(TestMaterials().materials().size()) +
                               " materials (got 999)");
  spec = {.isa = "avx1"};
  EXPECT_EQ(FaultOf(spec).find("isa: must be an instruction set of this machine, one of "), 0U);
}

TEST(Simulator, StaysAsItIsIfItCannotWorkWithANewSpec) {
  Simulator simulator(WorldWithWall(5.0F), MakeRaster(10, 10, 1), TestMaterials(), {}, 1);
  SimulatorSpec spec = simulator.spec();
  spec.detector.seed = 99;
  spec.detector.beam.wavelength_nm = 1064;
  EXPECT_THROW(simulator.Use(spec), InputError);
  EXPECT_EQ(simulator.spec().detector.seed, SimulatorSpec().detector.seed);
}

TEST(Simulator, ThresholdUsesReflectivityIncidenceAndFog) {
  SimulatorSpec spec{.detector = {.effects = {.threshold = true}}};
  spec.detector.weather.fog_density_per_m = 0.005;
  const Frame frame = ScanOnce(WorldWithWall(100.0F), MakeRaster(40, 10, 1), spec);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double range = static_cast<double>(frame.true_range_m[slot]);
    const double intensity = 0.5 * 100.0 / range;
    const double ratio = intensity * std::exp(-0.005 * range) / (0.1 * std::pow(range / 200.0, 2));
    EXPECT_NEAR(static_cast<double>(frame.intensity[slot]), intensity, 1e-6);
    EXPECT_NEAR(static_cast<double>(frame.power_ratio[slot]) / ratio, 1.0, 1e-5);
    EXPECT_EQ(frame.outcome[slot], ratio >= 1.0 ? Outcome::kReturned : Outcome::kBelowThreshold);
  }
}

TEST(Simulator, AFrameKeepsTheTruthOfWhatWasNotDetected) {
  SimulatorSpec spec{.detector = {.effects = {.threshold = true}}};
  spec.detector.plausibility.reference_threshold = 1e6;
  const Frame frame = ScanOnce(WorldWithWall(100.0F), MakeRaster(10, 10, 1), spec);
  EXPECT_EQ(CountOutcome(frame, Outcome::kBelowThreshold), 100U);
  EXPECT_TRUE(std::isnan(frame.range_m[55]));
  EXPECT_NEAR(static_cast<double>(frame.true_range_m[55]), 100.0, 0.1);
  EXPECT_EQ(frame.label[55], kWallLabel);
}

TEST(Simulator, TellsTheBeamsShareOnlyWhereBeamsHaveAWidth) {
  const ScanPattern pattern = MakeRaster(10, 10, 1);
  for (const EffectSet& effects : {EffectSet{}, EffectSet{.threshold = true}}) {
    const Frame frame = ScanOnce(WorldWithWall(20.0F), pattern, {.detector = {.effects = effects}});
    EXPECT_TRUE(std::isnan(frame.footprint_share[55]) && std::isnan(frame.mixed_share[55]));
  }
  const Frame wide =
      ScanOnce(WorldWithWall(20.0F), pattern, {.detector = {.effects = {.footprint = true}}});
  EXPECT_NEAR(static_cast<double>(wide.footprint_share[55]), 1.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(wide.mixed_share[55]), 0.0, 1e-6);
}

TEST(Simulator, ReadsTheInstanceOfTheObjectInFront) {
  auto world = WorldWithWall(50.0F);
  world->AddObject(WallModel(0.0F, 2.0F, 1),
                   MakeTransform(Eigen::Matrix3d::Identity(), {20.0, 0.0, 0.0}));
  const Frame frame = ScanOnce(world, MakeRaster(20, 2, 1));
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const bool in_front = std::abs(frame.y[slot] / frame.x[slot]) < 0.1F;
    EXPECT_EQ(frame.instance[slot], in_front ? 1U : 0U);
    EXPECT_EQ(frame.material[slot], in_front ? 1 : 2);
  }
}

TEST(Simulator, RollingShutterSeesTheWallComeNearer) {
  auto world = WorldWithWall(50.0F);
  world->velocity_chunk_mps = {20.0, 0.0, 0.0};
  const Frame frame = ScanOnce(world, MakeRaster(60, 2, 1));
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double travelled_m = 20.0 * static_cast<double>(frame.time_ns[slot]) * 1e-9;
    EXPECT_NEAR(static_cast<double>(frame.x[slot]), 50.0 - travelled_m, 1e-4);
  }
}

// Packets of a slow pattern cover more time than the interval between two poses.
TEST(Simulator, SlowPatternsGiveEveryFiringItsOwnPose) {
  auto world = WorldWithWall(50.0F);
  world->velocity_chunk_mps = {5.0, 0.0, 0.0};
  const ScanPattern pattern = BuildScanPattern(
      {.rate_hz = 0.5,
       .pattern = RasterSpec{
           .horizontal_fov_deg = 60, .vertical_fov_deg = 4, .angular_resolution_deg = 1}});
  const Frame frame = ScanOnce(world, pattern);
  EXPECT_GT(frame.time_ns[59], 1'900'000'000U);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double travelled_m = 5.0 * static_cast<double>(frame.time_ns[slot]) * 1e-9;
    EXPECT_NEAR(static_cast<double>(frame.x[slot]), 50.0 - travelled_m, 1e-4);
  }
}

TEST(Simulator, MovingObjectsAreSeenWhereTheyAreAtEachFiring) {
  auto world = std::make_shared<SimpleWorld>();
  world->AddObject(WallModel(0.0F, 100.0F),
                   MakeTransform(Eigen::Matrix3d::Identity(), {50.0, 0.0, 0.0}), {-30.0, 0.0, 0.0});
  const Frame frame = ScanOnce(world, MakeRaster(60, 2, 1), {}, 3);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double time_s = 0.3 + static_cast<double>(frame.time_ns[slot]) * 1e-9;
    EXPECT_NEAR(static_cast<double>(frame.x[slot]), 50.0 - 30.0 * time_s, 1e-4);
    EXPECT_EQ(frame.instance[slot], 1U);
  }
}

TEST(Simulator, ViewsObjectsAloneAndAsTheyAreHidden) {
  auto world = std::make_shared<SimpleWorld>();
  world->AddObject(WallModel(0.0F, 2.0F), MakeTransform(Eigen::Matrix3d::Identity(), {20, 0, 0}));
  world->AddObject(WallModel(0.0F, 2.0F), MakeTransform(Eigen::Matrix3d::Identity(), {40, 0, 0}));
  world->AddObject(WallModel(0.0F, 2.0F), MakeTransform(Eigen::Matrix3d::Identity(), {400, 0, 0}));
  Simulator simulator(world, MakeRaster(30, 30, 0.5), TestMaterials(), {}, 2);
  const std::vector<ObjectView> views = simulator.ViewObjects(0);
  // Half angles atan(2/20) = 5.7 deg: 22 cells per side; atan(2/40) = 2.9 deg: 12 cells. The first
  // object hides the second; the third is out of range.
  const std::uint32_t near = 22U * 22U;
  const std::uint32_t far = 12U * 12U;
  EXPECT_EQ(views, (std::vector<ObjectView>{{near, near, near, near}, {far, 0, far, 0}, {}}));
  EXPECT_EQ(views[0].occlusion(), 0.0);
  EXPECT_EQ(views[1].occlusion(), 1.0);
  EXPECT_EQ(views[2].occlusion(), std::nullopt);
}

std::vector<std::string> EffectsOn(const FiringStory& story) {
  std::vector<std::string> effects;
  for (const FiringStory::Step& step : story.steps) effects.push_back(step.effect);
  return effects;
}

TEST(Simulator, ExplainsAFiringAsScanMeasuredIt) {
  SimulatorSpec spec{
      .detector = {.effects = {.threshold = true, .rain = true, .snow = true, .noise = true}}};
  spec.detector.weather.rain_rate_mmph = 30.0;
  spec.detector.weather.snow_rate_mmph = 10.0;
  Simulator simulator(WorldWithWall(60.0F), MakeRaster(20, 10, 1), TestMaterials(), spec, 1);
  const Frame frame = FrameBy(simulator, 5);
  for (std::uint32_t firing = 0; firing < 200; ++firing) {
    const FiringStory story = simulator.Explain(5, firing);
    EXPECT_EQ(story.time_ns, frame.time_ns[story.slot]);
    const FiringStory::Step& last = story.steps.back();
    EXPECT_EQ(last.outcome, frame.outcome[story.slot]);
    EXPECT_EQ(last.power_ratio, frame.power_ratio[story.slot]);
    if (HasPoint(last.outcome)) {
      EXPECT_EQ(last.range_m, frame.range_m[story.slot]);
    }
    EXPECT_EQ(story.material, 2);
  }
  EXPECT_EQ(EffectsOn(simulator.Explain(5, 0)),
            (std::vector<std::string>{"hit", "threshold", "rain", "snow", "noise"}));
}

TEST(Simulator, ExplainsWhatWaterAndSnowMadeOfTheSurface) {
  SimulatorSpec spec{
      .detector = {.effects = {.surface_response = true, .surface_condition = true}}};
  const auto explain = [&] {
    Simulator simulator(WorldWithWall(60.0F), MakeRaster(20, 10, 1), TestMaterials(), spec, 1);
    return simulator.Explain(5, 105);
  };
  const FiringStory dry = explain();
  EXPECT_EQ(EffectsOn(dry), (std::vector<std::string>{"surface_response", "hit", "measurement"}));
  spec.detector.weather.wetness = 1.0;
  const FiringStory wet = explain();
  EXPECT_EQ(EffectsOn(wet), (std::vector<std::string>{"surface_response", "surface_condition",
                                                      "hit", "measurement"}));
  EXPECT_EQ(wet.steps[0].intensity, dry.steps[0].intensity);
  EXPECT_NE(wet.steps[1].intensity, dry.steps[0].intensity);
  EXPECT_EQ(wet.steps[2].intensity, wet.steps[1].intensity);
}

TEST(Simulator, ExplainsWhichEffectsAddedEchoes) {
  SimulatorSpec spec{.detector = {.effects = {.surface_response = true,
                                              .clutter = true,
                                              .fog_echo = true,
                                              .sunlight = true}}};
  spec.detector.weather.rain_rate_mmph = 50.0;
  spec.detector.weather.visibility_m = 100.0;
  spec.detector.receiver.clutter_gain = 10.0;
  Simulator simulator(WorldWithWall(60.0F), MakeRaster(20, 10, 1), TestMaterials(), spec, 1);
  std::size_t num_drops = 0;
  std::size_t num_fog = 0;
  for (std::uint32_t firing = 0; firing < 20; ++firing) {
    const FiringStory story = simulator.Explain(5, firing);
    ASSERT_EQ(EffectsOn(story), (std::vector<std::string>{"surface_response", "clutter", "fog_echo",
                                                          "hit", "measurement", "false alarms"}));
    num_drops += story.steps[1].num_added_echoes;
    num_fog += story.steps[2].num_added_echoes;
    std::size_t num_added = 0;
    for (const FiringStory::Step& step : story.steps) num_added += step.num_added_echoes;
    EXPECT_EQ(story.echoes.size(), 1 + num_added);
  }
  EXPECT_GT(num_drops, 20U);
  // At 0.9 of the threshold, hardly a beam has no peak of fog.
  EXPECT_GT(num_fog, 10U);
}

TEST(Simulator, ExplainsEveryEchoWithTheSlotItHasInTheFrame) {
  SimulatorSpec spec{.detector = {.seed = 2,
                                  .effects = {.surface_response = true,
                                              .extinction = true,
                                              .detection = true,
                                              .detection_probability = true,
                                              .clutter = true,
                                              .range_noise = true,
                                              .footprint = true}}};
  spec.detector.weather.rain_rate_mmph = 50.0;
  spec.detector.receiver.clutter_gain = 1.0;
  spec.detector.receiver.return_mode = ReturnMode::kTriple;
  auto world = WorldWithWall(60.0F);
  world->AddObject(WallModel(0.0F, 2.0F, 1),
                   MakeTransform(Eigen::Matrix3d::Identity(), {20.0, 0.0, 0.0}));
  Simulator simulator(world, MakeRaster(20, 10, 0.5), TestMaterials(), spec, 1);
  const Frame frame = FrameBy(simulator, 5);
  std::size_t num_echoes = 0;
  for (std::uint32_t firing = 0; firing < 800; ++firing) {
    const FiringStory story = simulator.Explain(5, firing);
    std::size_t num_slots = 0;
    for (const FiringStory::Echo& echo : story.echoes) {
      if (!echo.slot) continue;
      ++num_slots;
      ASSERT_EQ(echo.outcome, frame.outcome[*echo.slot]);
      ASSERT_EQ(echo.range_m, frame.range_m[*echo.slot]);
      ASSERT_EQ(echo.power_ratio, frame.power_ratio[*echo.slot]);
      ASSERT_EQ(echo.label, frame.label[*echo.slot]);
    }
    ASSERT_EQ(num_slots, frame.return_count[story.slot]);
    num_echoes += story.echoes.size();
  }
  EXPECT_GT(num_echoes, 1200U);
}

// A plate 0.9 m before a wall as bright: far enough for two echoes, too near for a receiver blind
// for 8 ns (1.2 m). Without the effect the parameter does nothing.
TEST(Simulator, ReportsNoEchoFromWithinTheDeadTime) {
  auto world = WorldWithWall(20.9F);
  // Its edges run through the middles of the beams at 5.625 deg: 20 m tan 5.625 deg.
  world->AddObject(WallModel(0.0F, 1.97F),
                   MakeTransform(Eigen::Matrix3d::Identity(), {20.0, 0.0, 0.0}));
  const auto num_pairs = [&](bool has_dead_time, double dead_time_ns) {
    SimulatorSpec spec{.detector = {.effects = {.surface_response = true,
                                                .detection = true,
                                                .dead_time = has_dead_time,
                                                .footprint = true}}};
    spec.detector.receiver.return_mode = ReturnMode::kDual;
    spec.detector.receiver.dead_time_ns = dead_time_ns;
    const Frame frame = ScanOnce(world, MakeRaster(20, 10, 0.25), spec);
    return std::ranges::count(frame.return_count, std::uint8_t{2});
  };
  const auto num_seen = num_pairs(true, 0.0);
  EXPECT_GT(num_seen, 50);
  EXPECT_EQ(num_pairs(false, 8.0), num_seen);
  EXPECT_EQ(num_pairs(true, 5.0), num_seen);  // 0.75 m.
  EXPECT_EQ(num_pairs(true, 8.0), 0);
}

}  // namespace
}  // namespace railcast
