#include "core/detect/effects/spray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint32_t kSprayLabel = 29;

WeatherSpec Wet() {
  WeatherSpec weather;
  weather.wetness = 1.0;
  weather.spray_extinction_per_m = 0.1;
  return weather;
}

/// A wagon 14 m long, 3 m wide and 4 m high whose middle starts 50 m ahead, 2 m below the sensor.
std::shared_ptr<SimpleWorld> WagonAhead(double speed_mps, const std::string& type = "open_wagon") {
  const Mesh box{{{-7, -1.5, 0},
                  {-7, 1.5, 0},
                  {-7, 1.5, 4},
                  {-7, -1.5, 4},
                  {7, -1.5, 0},
                  {7, 1.5, 0},
                  {7, 1.5, 4},
                  {7, -1.5, 4}},
                 {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}};
  Model model;
  model.parts.push_back({box, 2, 12});
  const auto world = WorldOfParts({{MakeFloor(-2.0F, 200.0F), 1, 4}});
  Transform place = Transform::Identity();
  place.translation() = Vector3(50.0, 0.0, -2.0);
  world->AddObject(std::make_shared<const Model>(std::move(model)), place,
                   Vector3(speed_mps, 0.0, 0.0), false, type);
  return world;
}

TEST(SprayClouds, TrailAMovingWagonOverTheWayOfASecond) {
  const auto clouds =
      SprayCloudsOf(*WagonAhead(20.0), Wet(), {1'000'000'000, 50'000'000}, Transform::Identity());
  ASSERT_EQ(clouds.size(), 1U);
  const SprayCloud& cloud = clouds[0];
  EXPECT_NEAR(cloud.rear[0], 63.0F, 1e-4F);  // 50 + 20 - 7.
  EXPECT_NEAR(cloud.rear[2], -2.0F, 1e-4F);
  EXPECT_NEAR(cloud.way[0], 1.0F, 1e-5F);  // 20 m/s x 50 ms.
  EXPECT_NEAR(cloud.back[0], -1.0F, 1e-6F);
  EXPECT_NEAR(cloud.body_m, 14.0F, 1e-4F);
  EXPECT_NEAR(cloud.half_width_m, 2.0F, 1e-4F);
  EXPECT_NEAR(cloud.decay_m, 20.0F, 1e-4F);
  EXPECT_NEAR(cloud.extinction_per_m, 0.1F * 0.72F * 0.72F, 1e-5F);
}

TEST(SprayClouds, TrailAWagonThatIsPushedTheOtherWay) {
  const auto clouds = SprayCloudsOf(*WagonAhead(-20.0), Wet(), {}, Transform::Identity());
  ASSERT_EQ(clouds.size(), 1U);
  EXPECT_NEAR(clouds[0].rear[0], 57.0F, 1e-4F);
  EXPECT_NEAR(clouds[0].back[0], 1.0F, 1e-6F);
}

TEST(SprayClouds, NeedATrainThatMovesOverWetGround) {
  const Transform here = Transform::Identity();
  EXPECT_TRUE(SprayCloudsOf(*WagonAhead(0.0), Wet(), {}, here).empty());
  EXPECT_TRUE(SprayCloudsOf(*WagonAhead(20.0, "person"), Wet(), {}, here).empty());
  WeatherSpec dry = Wet();
  dry.wetness = 0.0;
  EXPECT_TRUE(SprayCloudsOf(*WagonAhead(20.0), dry, {}, here).empty());
}

Frame ScanBehind(double speed_mps,
                 const WeatherSpec& weather,
                 int num_threads = 0,
                 const EffectSet& effects = EffectsOfRung(Fidelity::kSurface)) {
  SimulatorSpec spec{.detector = {.effects = effects}};
  spec.detector.effects.sunlight = false;
  spec.detector.weather = weather;
  spec.detector.clutter_labels.spray = kSprayLabel;
  return ScanOnce(WagonAhead(speed_mps), MakeRaster(20.0, 10.0, 0.25), spec, 0, num_threads);
}

TEST(SprayClouds, GivePointsBehindTheWagon) {
  const Frame frame = ScanBehind(30.0, Wet());
  std::size_t num = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != kSprayLabel) continue;
    ++num;
    EXPECT_EQ(frame.outcome[slot], Outcome::kClutter);
    // Within the cloud, which ends before the wagon's rear for these beams; noise has 5 sigma.
    EXPECT_LT(frame.x[slot], 43.3F + 14.0F);
    EXPECT_LT(std::abs(frame.y[slot]), 2.1F);
    EXPECT_GT(frame.z[slot], -2.3F);
    EXPECT_LT(frame.z[slot], 1.2F);
  }
  EXPECT_GT(num, 20U);
  EXPECT_EQ(FrameBytes(ScanBehind(30.0, Wet(), 1)), FrameBytes(frame));
}

// The wagon moves 3 m during the scan, and its spray with it: what weakens the echo of its rear end
// is as deep as in the cloud of the firing's own instant. With the stamp's cloud it would be up to
// a tenth deeper.
TEST(SprayClouds, MoveWithTheirWagonDuringTheScan) {
  constexpr double kSpeed_mps = 30.0;
  WeatherSpec without = Wet();
  without.spray_extinction_per_m = 0.0;
  EffectSet exact = WithoutRangeErrors(EffectsOfRung(Fidelity::kSurface));
  exact.pointing_jitter = false;
  const Frame dry = ScanBehind(kSpeed_mps, without, 0, exact);
  const Frame wet = ScanBehind(kSpeed_mps, Wet(), 0, exact);
  const auto world = WagonAhead(kSpeed_mps);
  constexpr float kSensor[3] = {0.0F, 0.0F, 0.0F};
  std::size_t num_late = 0;
  for (std::size_t slot = 0; slot < wet.num_slots(); ++slot) {
    if (wet.label[slot] != 12 || dry.label[slot] != 12) continue;
    const float range_m = dry.true_range_m[slot];
    const Eigen::Vector3f way = Eigen::Vector3f(dry.x[slot], dry.y[slot], dry.z[slot]).normalized();
    const auto cloud = SprayCloudsOf(*world, Wet(), {dry.time_ns[slot], 0}, Transform::Identity());
    const float direction[3] = {way.x(), way.y(), way.z()};
    const SprayPath path = PathIn(cloud.at(0), kSensor, direction);
    const float expected = OpticalDepth(cloud[0], path, range_m);
    const float depth = -0.5F * std::log(wet.power_ratio[slot] / dry.power_ratio[slot]);
    EXPECT_NEAR(depth, expected, 1e-3F * expected) << dry.time_ns[slot];
    if (dry.time_ns[slot] > 50'000'000) ++num_late;
  }
  EXPECT_GT(num_late, 50U);
}

TEST(SprayClouds, ChangeNothingWhereTrainsStand) {
  WeatherSpec without = Wet();
  without.spray_extinction_per_m = 0.0;
  EXPECT_EQ(FrameBytes(ScanBehind(0.0, Wet())), FrameBytes(ScanBehind(0.0, without)));
  EXPECT_NE(FrameBytes(ScanBehind(30.0, Wet())), FrameBytes(ScanBehind(30.0, without)));
}

}  // namespace
}  // namespace railcast
