#include "railcast/motion_sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/motion/sample_times.h"
#include "tests/core/motion/lines.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Two IMUs, two receivers and an odometer, none of whose rates divides that of the frames.
MotionSensorsSpec SeveralSensors() {
  return {.imus = {{.name = "imu",
                    .rate_hz = 73.0,
                    .gyroscope_noise_density_degps_per_sqrthz = 0.01,
                    .gyroscope_random_walk_degps2_per_sqrthz = 0.001,
                    .gyroscope_bias_degps = 0.1,
                    .accelerometer_noise_density_mps2_per_sqrthz = 0.002,
                    .accelerometer_random_walk_mps3_per_sqrthz = 0.0001,
                    .accelerometer_bias_mps2 = 0.02},
                   {.name = "bogie_imu", .rate_hz = 31.0}},
          .gnss = {{.name = "gnss", .rate_hz = 7.0, .horizontal_noise_m = 1.0},
                   {.name = "rear", .rate_hz = 3.0, .antenna_m = {-15.0, 0.0, 4.0}}},
          .odometers = {{.name = "odometer", .rate_hz = 47.0, .braking_slip_share = 0.02}}};
}

ScenarioSpec MovingScenario() {
  ScenarioSpec spec = StraightScenario();
  Drive({SpeedAt(0, 12), SpeedAt(1, 12), SpeedAt(4, 3)}, spec);
  spec.motion_sensors = SeveralSensors();
  return spec;
}

struct SampledFrames {
  explicit SampledFrames(const ScenarioSpec& spec, int num_threads = 2)
      : simulator(MakeSimulator(spec, num_threads)),
        sensors(*MakeMotionSensors(spec, *MakeWorld(spec))) {}
  MotionSamples Of(std::uint32_t frame) { return sensors.Sample(*simulator, frame); }

  std::unique_ptr<Simulator> simulator;
  MotionSensors sensors;
};

template <typename Sample>
std::vector<std::int64_t> TimesOf(const std::vector<std::vector<Sample>>& sensors, std::size_t i) {
  std::vector<std::int64_t> times_ns;
  for (const Sample& sample : sensors.at(i)) times_ns.push_back(sample.time_ns);
  return times_ns;
}

void ExpectSame(const MotionSamples& got, const MotionSamples& expected) {
  for (std::size_t i = 0; i < expected.imus.size(); ++i) {
    ASSERT_EQ(TimesOf(got.imus, i), TimesOf(expected.imus, i));
    for (std::size_t k = 0; k < expected.imus[i].size(); ++k) {
      EXPECT_EQ(got.imus[i][k].angular_velocity_radps, expected.imus[i][k].angular_velocity_radps);
      EXPECT_EQ(got.imus[i][k].specific_force_mps2, expected.imus[i][k].specific_force_mps2);
    }
  }
  for (std::size_t i = 0; i < expected.gnss.size(); ++i) {
    ASSERT_EQ(TimesOf(got.gnss, i), TimesOf(expected.gnss, i));
    for (std::size_t k = 0; k < expected.gnss[i].size(); ++k) {
      EXPECT_EQ(got.gnss[i][k].position_m, expected.gnss[i][k].position_m);
      EXPECT_EQ(got.gnss[i][k].sky_share, expected.gnss[i][k].sky_share);
    }
  }
  ASSERT_EQ(TimesOf(got.odometers, 0), TimesOf(expected.odometers, 0));
  for (std::size_t k = 0; k < expected.odometers[0].size(); ++k) {
    EXPECT_EQ(got.odometers[0][k].pulses, expected.odometers[0][k].pulses);
    EXPECT_EQ(got.odometers[0][k].speed_mps, expected.odometers[0][k].speed_mps);
  }
}

TEST(MotionSensors, EachSampleIsInTheFrameInWhoseTimeItLies) {
  SampledFrames frames(MovingScenario());
  std::size_t num_samples = 0;
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    const MotionSamples samples = frames.Of(frame);
    ASSERT_EQ(samples.imus.size(), 2U);
    ASSERT_EQ(samples.gnss.size(), 2U);
    ASSERT_EQ(samples.odometers.size(), 1U);
    for (const std::int64_t time_ns : TimesOf(samples.imus, 0)) {
      EXPECT_GE(time_ns, std::int64_t{frame} * 100'000'000);
      EXPECT_LT(time_ns, std::int64_t{frame + 1} * 100'000'000);
      EXPECT_EQ(time_ns, std::llround(static_cast<double>(num_samples++) / 73.0 * 1e9));
    }
  }
  EXPECT_EQ(num_samples, 146U);
}

TEST(MotionSensors, SamplesDependNeitherOnFramesBeforeNorOnTheNumberOfThreads) {
  SampledFrames forwards(MovingScenario(), 1);
  std::vector<MotionSamples> expected;
  for (std::uint32_t frame = 0; frame < 12; ++frame) expected.push_back(forwards.Of(frame));
  SampledFrames backwards(MovingScenario(), 3);
  for (std::uint32_t frame = 12; frame-- > 0;) ExpectSame(backwards.Of(frame), expected[frame]);
}

// Adding sensors, or changing others, changes no sample of one.
TEST(MotionSensors, ASensorMeasuresTheSameAloneAndBesideOthers) {
  SampledFrames together(MovingScenario());
  ScenarioSpec alone = MovingScenario();
  alone.motion_sensors->imus.resize(1);
  alone.motion_sensors->gnss.resize(1);
  SampledFrames apart(alone);
  MotionSamples of_all = together.Of(7);
  of_all.imus.resize(1);
  of_all.gnss.resize(1);
  ExpectSame(apart.Of(7), of_all);
}

TEST(MotionSensors, SensorsOfOtherNamesAndOtherSeedsHaveOtherErrors) {
  const auto turn_of = [](const ScenarioSpec& spec) {
    return SampledFrames(spec).Of(3).imus.at(0).at(0).angular_velocity_radps;
  };
  ScenarioSpec renamed = MovingScenario();
  renamed.motion_sensors->imus[0].name = "other";
  ScenarioSpec reseeded = MovingScenario();
  ++reseeded.seed;
  EXPECT_NE(turn_of(renamed), turn_of(MovingScenario()));
  EXPECT_NE(turn_of(reseeded), turn_of(MovingScenario()));
}

TEST(MotionSensors, AScenarioWithoutThemHasNone) {
  const ScenarioSpec spec = StraightScenario();
  EXPECT_FALSE(MakeMotionSensors(spec, *MakeWorld(spec)).has_value());
}

// The shipped tunnel: 170 m long, through which the vehicle runs at 16 m/s.
TEST(MotionSensors, TheReceiverLosesItsFixInATunnelAndFindsItAgain) {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "tunnel.json");
  spec.vehicle.start_s_m = 240.0;
  spec.motion_sensors = MotionSensorsSpec{};
  spec.motion_sensors->gnss = {{.rate_hz = 10.0, .antenna_m = {0.0, 0.0, 4.0}}};
  SampledFrames frames(spec);
  int num_outside = 0;
  int num_inside = 0;
  for (std::uint32_t frame = 0; frame < 160; frame += 5) {
    const double s_m = 240.0 + 1.6 * frame;
    const GnssSample sample = frames.Of(frame).gnss.at(0).at(0);
    // 10 m within either mouth, the sky that is seen is the mouth.
    if (s_m > 295.0 && s_m < 445.0) {
      EXPECT_FALSE(sample.has_fix) << s_m;
      EXPECT_LT(sample.sky_share, 0.1) << s_m;
      ++num_inside;
    } else if (s_m > 475.0 || s_m < 265.0) {
      EXPECT_TRUE(sample.has_fix) << s_m;
      ++num_outside;
    }
  }
  EXPECT_GT(num_inside, 15);
  EXPECT_GT(num_outside, 2);
}

// A road bridge of 14 m, 3 m above the antenna: over the middle of the sky nothing is free below
// it.
TEST(MotionSensors, TheReceiverLosesItsFixUnderABridge) {
  ScenarioSpec spec = StraightScenario();
  OverbridgeSpec bridge = StructureAlong<OverbridgeSpec>("bridge", 200.0, 214.0);
  bridge.track = "main";
  spec.world.structures = {bridge};
  Drive({SpeedAt(0, 20)}, spec);
  spec.motion_sensors = MotionSensorsSpec{};
  spec.motion_sensors->gnss = {
      {.rate_hz = 10.0, .antenna_m = {0.0, 0.0, 4.0}, .least_sky_share = 0.5}};
  SampledFrames frames(spec);
  const auto at_s_m = [&](double s_m) {
    const auto frame = static_cast<std::uint32_t>(std::lround((s_m - 100.0) / 2.0));
    return frames.Of(frame).gnss.at(0).at(0);
  };
  EXPECT_GT(at_s_m(120.0).sky_share, 0.95);
  EXPECT_FALSE(at_s_m(206.0).has_fix);
  EXPECT_GT(at_s_m(206.0).sky_share, 0.02);
  EXPECT_TRUE(at_s_m(250.0).has_fix);
}

TEST(SampleTimes, AreWholeNanosecondsFromTimeZero) {
  EXPECT_EQ(SampleTimeNs(0, 100.0), 0);
  EXPECT_EQ(SampleTimeNs(1, 100.0), 10'000'000);
  EXPECT_EQ(SampleTimeNs(2, 3.0), 666'666'667);
  // A day at 200 Hz.
  EXPECT_EQ(SampleTimeNs(17'280'000, 200.0), 86'400'000'000'000);
}

TEST(SampleTimes, ATimeBelongsToTheSpanThatItBegins) {
  const SampleRange range = SamplesBetween(100'000'000, 200'000'000, 100.0);
  EXPECT_EQ(range.begin, 10U);
  EXPECT_EQ(range.end, 20U);
  EXPECT_EQ(SamplesBetween(100'000'001, 200'000'001, 100.0).begin, 11U);
  EXPECT_EQ(SamplesBetween(100'000'001, 200'000'001, 100.0).end, 21U);
}

// Rates that divide neither one another nor a second.
TEST(SampleTimes, SpansShareOutAllSamplesWithoutGapsOrRepetitions) {
  for (const double rate_hz : {0.7, 1.0, 3.0, 99.9, 400.0}) {
    std::uint64_t next = 0;
    std::int64_t begin_ns = 0;
    for (int span = 0; span < 1000; ++span) {
      const std::int64_t end_ns = begin_ns + 76'923'077 + span % 2;
      const SampleRange range = SamplesBetween(begin_ns, end_ns, rate_hz);
      ASSERT_EQ(range.begin, next) << rate_hz << " Hz, span " << span;
      for (std::uint64_t sample = range.begin; sample < range.end; ++sample) {
        ASSERT_GE(SampleTimeNs(sample, rate_hz), begin_ns);
        ASSERT_LT(SampleTimeNs(sample, rate_hz), end_ns);
      }
      next = range.end;
      begin_ns = end_ns;
    }
    EXPECT_NEAR(static_cast<double>(next), 76.9230775 * rate_hz, 1.0);
  }
}

}  // namespace
}  // namespace railcast
