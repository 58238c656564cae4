#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "core/base/random.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/same_frames.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Several thousand random triangles, many of which intersect: plenty of edges, vertices and ties.
std::shared_ptr<SimpleWorld> ThicketWorld() {
  Mesh thicket;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const auto place = RandomWords(1, RandomUse::kTreePlacement, 0, i);
    const Eigen::Vector3f corner(10.0F + 80.0F * UnitFloat(place[0]),
                                 40.0F * UnitFloat(place[1]) - 20.0F,
                                 30.0F * UnitFloat(place[2]) - 15.0F);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto edge = RandomWords(1, RandomUse::kTreePlacement, 1 + k, i);
      thicket.vertices.emplace_back(
          corner + Eigen::Vector3f(UnitFloat(edge[0]), UnitFloat(edge[1]), UnitFloat(edge[2])));
    }
    thicket.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto world =
      WorldOfParts({{MakeFloor(-2.0F, 500.0F), 1, 1}, {MakeFloor(-2.0F, 400.0F), 2, 2}});
  const auto model = std::make_shared<Model>(Model{"thicket", {{thicket, 3, 3}}});
  world->AddObject(model, Transform::Identity());
  world->AddObject(model, Transform::Identity(), {-3.0, 1.0, 0.0});
  world->velocity_chunk_mps = {11.0, 0.0, 0.0};
  return world;
}

SimulatorSpec EverythingOn() {
  SimulatorSpec spec{.detector = {.seed = 42,
                                  .effects = {.threshold = true,
                                              .rain = true,
                                              .snow = true,
                                              .noise = true,
                                              .sensor_dropout = true}}};
  spec.detector.weather.rain_rate_mmph = 20.0;
  spec.detector.weather.snow_rate_mmph = 2.0;
  spec.detector.plausibility.dropout_probability = 0.05;
  return spec;
}

TEST(Determinism, SameBytesAtOneTwoAndEightThreads) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.25);
  const Frame one = ScanOnce(world, pattern, EverythingOn(), 4, 1);
  ExpectSameBytes(one, ScanOnce(world, pattern, EverythingOn(), 4, 2));
  ExpectSameBytes(one, ScanOnce(world, pattern, EverythingOn(), 4, 8));
}

TEST(Determinism, AFrameDoesNotDependOnThoseBeforeIt) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  Simulator simulator(world, pattern, TestMaterials(), EverythingOn(), 2);
  Frame frame;
  for (std::uint32_t index = 0; index <= 5; ++index) simulator.Scan(index, frame);
  ExpectSameBytes(frame, ScanOnce(world, pattern, EverythingOn(), 5, 2));
}

TEST(Determinism, FramesMadeAtOnceAreThoseMadeOneAfterAnother) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  Simulator simulator(world, pattern, TestMaterials(), EverythingOn(), 4);
  constexpr std::uint32_t kNumFrames = 8;
  std::vector<Frame> frames(kNumFrames);
  std::vector<std::vector<ObjectView>> views(kNumFrames);
  std::vector<std::shared_ptr<BegunFrame>> begun;
  for (std::uint32_t i = 0; i < kNumFrames; ++i) begun.push_back(simulator.Begin(i));
  simulator.Execute([&] {
    tbb::parallel_for(0U, kNumFrames,
                      [&](std::uint32_t i) { simulator.Scan(*begun[i], frames[i], views[i]); });
  });
  Simulator one(world, pattern, TestMaterials(), EverythingOn(), 1);
  Frame frame;
  for (std::uint32_t i = 0; i < kNumFrames; ++i) {
    one.Scan(i, frame);
    ExpectSameBytes(frame, frames[i]);
    EXPECT_EQ(one.ViewObjects(i), views[i]);
  }
}

TEST(Determinism, AnotherSeedChangesOnlyWhatIsRandom) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  SimulatorSpec other = EverythingOn();
  other.detector.seed = 43;
  const Frame a = ScanOnce(world, pattern, EverythingOn());
  const Frame b = ScanOnce(world, pattern, other);
  EXPECT_NE(a.outcome, b.outcome);
  std::size_t num_compared = 0;
  for (std::size_t slot = 0; slot < a.num_slots(); ++slot) {
    if (a.outcome[slot] == Outcome::kClutter || b.outcome[slot] == Outcome::kClutter) continue;
    if (a.label[slot] == 0) continue;
    ++num_compared;
    ASSERT_EQ(a.true_range_m[slot], b.true_range_m[slot]);
    ASSERT_EQ(a.label[slot], b.label[slot]);
  }
  EXPECT_GT(num_compared, 1000U);
}

// Random keys include the effect, so switching snow off must not change the draws of other effects.
TEST(Determinism, SwitchingOneEffectOffLeavesTheOthersDrawsAlone) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  SimulatorSpec without_snow = EverythingOn();
  without_snow.detector.effects.snow = false;
  const Frame with = ScanOnce(world, pattern, EverythingOn());
  const Frame without = ScanOnce(world, pattern, without_snow);
  std::size_t num_compared = 0;
  for (std::size_t slot = 0; slot < with.num_slots(); ++slot) {
    if (with.outcome[slot] == Outcome::kClutter) continue;
    ++num_compared;
    ASSERT_EQ(with.outcome[slot], without.outcome[slot]);
    if (with.outcome[slot] == Outcome::kReturned) {
      ASSERT_EQ(with.range_m[slot], without.range_m[slot]);
    }
  }
  EXPECT_GT(num_compared, with.num_slots() / 2);
}

}  // namespace
}  // namespace railcast
