// A recording in clear air to which weather is added is compared with the simulation in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/detect/base/weather_optics.h"
#include "generator/extras/insert/inserter.h"
#include "generator/extras/insert/packets/insertion.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/closed_loop.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

/// Points of a frame by class and range: 0 = of surfaces, else the label of what is in the air.
using PointCounts = std::map<std::pair<std::uint32_t, int>, double>;

int RangeBin(float range_m) {
  const std::array<float, 5> ends_m{5.0F, 15.0F, 30.0F, 60.0F, 120.0F};
  int bin = 0;
  for (const float end_m : ends_m) bin += range_m >= end_m ? 1 : 0;
  return bin;
}

void CountPointsOf(const Frame& frame, PointCounts& counts) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    const bool is_clutter = frame.outcome[slot] == Outcome::kClutter;
    counts[{is_clutter ? frame.label[slot] : 0, RangeBin(frame.range_m[slot])}] += 1.0;
  }
}

/// The same scene recorded in clear air, recorded in weather, and the first with the weather added.
struct WeatherLoop {
  PointCounts clear, truth, inserted;
};

struct WeatherCase {
  std::string name;
  WeatherSpec weather;
  CoverSpec cover{};
};

std::ostream& operator<<(std::ostream& out, const WeatherCase& weather) {
  return out << weather.name;
}

WeatherLoop RunWeather(const WeatherCase& weather, Fidelity fidelity, bool is_own = true) {
  LoopSensor sensor = MakeLoopSensor("pandar64", fidelity, {25.0, -25.0, 5.0});
  LoopSensor wet = sensor;
  wet.scenario.weather = weather.weather;
  wet.scenario.lidar.cover = weather.cover;
  // What weather does to surfaces is not claimed.
  wet.scenario.weather.wetness = 0.0;
  wet.scenario.effects["surface_condition"] = false;
  WeatherLoop loop;
  const std::vector<LoopThing> things = LoopThings();
  const auto scene = MakeLoopScene(sensor.scenario);
  AddThings(sensor.scenario, things, *scene);
  ScenarioSpec inserted_into = wet.scenario;
  // A sensor of another name draws otherwise in the same air. Of drops on the window, a few cover
  // all of the far ground, so that those must stay where they are.
  const bool has_drops = weather.cover.drop_coverage > 0.0;
  if (!is_own && !has_drops) inserted_into.lidar.name = "another";
  Inserter inserter(PlanOf(inserted_into, ThingsAlone(wet.scenario, {}), sensor.pattern), 0);
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    const Frame clear = ScanLoop(sensor, scene, frame);
    CountPointsOf(clear, loop.clear);
    CountPointsOf(ScanLoop(wet, scene, frame), loop.truth);
    RecordedFirings recorded = RecordedOf(clear, sensor.pattern);
    if (!is_own) ForgetOwnFields(recorded);
    const InsertedFrame inserted = inserter.Insert(recorded, frame);
    CountPointsOf(inserted.recorded.frame, loop.inserted);
  }
  return loop;
}

std::string TextOf(const WeatherLoop& loop) {
  std::ostringstream text;
  PointCounts all = loop.truth;
  for (const auto& [key, count] : loop.inserted) all.try_emplace(key, 0.0);
  for (const auto& [key, count] : all) {
    const auto at = [&](const PointCounts& counts) {
      const auto found = counts.find(key);
      return found == counts.end() ? 0.0 : found->second;
    };
    text << "label " << key.first << " bin " << key.second << ": " << at(loop.clear) << " clear, "
         << at(loop.truth) << " in weather, " << at(loop.inserted) << " with weather added\n";
  }
  return text.str();
}

// Two counts of independent draws differ by less than 4 standard deviations, and shares by 3 %.
void ExpectAsMany(const WeatherLoop& loop, const std::string& what) {
  testing::Test::RecordProperty(what, TextOf(loop));
  SCOPED_TRACE(what + "\n" + TextOf(loop));
  for (const auto& [key, expected] : loop.truth) {
    const auto found = loop.inserted.find(key);
    const double count = found == loop.inserted.end() ? 0.0 : found->second;
    EXPECT_NEAR(count, expected, 0.03 * expected + 4.0 * std::sqrt(expected + count))
        << "label " << key.first << ", bin " << key.second;
  }
}

class WeatherRoundTrip : public testing::TestWithParam<WeatherCase> {};

TEST_P(WeatherRoundTrip, GivesAsManyPointsByRangeAndClassAsTheSimulation) {
  for (const Fidelity fidelity : {Fidelity::kPlausibility, Fidelity::kFootprint}) {
    ExpectAsMany(RunWeather(GetParam(), fidelity), std::string(NameOf(fidelity)));
  }
}

TEST_P(WeatherRoundTrip, DoesSoWithOtherDrawsIfTheRecordingDoesNotKnowThePower) {
  ExpectAsMany(RunWeather(GetParam(), Fidelity::kFootprint, /*is_own=*/false), "foreign");
}

TEST(AddedWeather, LeavesTheIntensitiesOfWhatStillReturns) {
  const LoopSensor sensor = MakeLoopSensor("pandar64", Fidelity::kFootprint, {25.0, -25.0, 5.0});
  ScenarioSpec foggy = sensor.scenario;
  foggy.weather.visibility_m = 80.0;
  const Frame clear = ScanLoop(sensor, MakeLoopScene(sensor.scenario));
  const InsertedFrame inserted = Inserter(PlanOf(foggy, ThingsAlone(foggy, {}), sensor.pattern), 0)
                                     .Insert(RecordedOf(clear, sensor.pattern), 0);
  EXPECT_GT(inserted.edits.size(), 1000U);
  for (const SlotEdit& edit : inserted.edits) EXPECT_FALSE(edit.is_weaker);
}

TEST(AddedWeather, BlindsNoRecordedReturnBesideTheSun) {
  const LoopSensor sensor = MakeLoopSensor("pandar64", Fidelity::kFootprint, {25.0, -25.0, 5.0});
  const RecordedFirings recorded =
      RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
  const auto num_points = [&](double elevation_deg) {
    ScenarioSpec sunny = sensor.scenario;
    sunny.weather.sun = {
        .illuminance_klx = 100.0, .azimuth_deg = 0.0, .elevation_deg = elevation_deg};
    const InsertedFrame inserted =
        Inserter(PlanOf(sunny, ThingsAlone(sunny, {}), sensor.pattern), 0).Insert(recorded, 0);
    return std::ranges::count_if(inserted.recorded.frame.x, [](float x) { return !std::isnan(x); });
  };
  // Where the sun is does not matter to the noise of its light, nor to false alarms.
  EXPECT_EQ(num_points(0.5), num_points(80.0));
}

/// A frame in clear air and what rain of 15 mm/h without drops has left of it, with one seed.
struct RainedFrame {
  Frame clear, now;
  double snr{};
  double extinction_per_m{};

  [[nodiscard]] double Weakened(std::size_t slot) const {
    return static_cast<double>(clear.power_ratio[slot]) *
           std::exp(-2.0 * extinction_per_m * static_cast<double>(clear.range_m[slot]));
  }
  /// The probability of detection.
  [[nodiscard]] double Chance(double power_ratio) const {
    return 0.5 * std::erfc(-snr * (power_ratio - 1.0) / std::sqrt(2.0));
  }
};

std::vector<RainedFrame> LetItRain(const std::string& name) {
  const LoopSensor sensor = MakeLoopSensor(name, Fidelity::kFootprint, {90.0, -25.0, 5.0});
  ScenarioSpec rainy = sensor.scenario;
  rainy.weather.rain_rate_mmph = 15.0;
  rainy.effects["clutter"] = false;
  Inserter inserter(PlanOf(rainy, ThingsAlone(rainy, {}), sensor.pattern), 0);
  const auto scene = MakeLoopScene(sensor.scenario);
  std::vector<RainedFrame> frames;
  for (std::uint32_t i = 0; i < 3; ++i) {
    RainedFrame& frame = frames.emplace_back();
    frame.clear = ScanLoop(sensor, scene, i);
    frame.now = inserter.Insert(RecordedOf(frame.clear, sensor.pattern), i).recorded.frame;
    frame.snr = sensor.scenario.lidar.receiver.snr_at_threshold;
    frame.extinction_per_m = RainExtinction_per_m(rainy.weather);
  }
  return frames;
}

// What has been returned is returned in rain with P' / P. The count has the variance of that many
// independent draws, and is off by more than four standard deviations once in 16,000.
TEST(AddedWeather, KeepsWeakReturnsByChanceAlsoWithTheSeedOfTheRecording) {
  double expected = 0.0;
  double variance = 0.0;
  double num = 0.0;
  for (const RainedFrame& frame : LetItRain("pandar64")) {
    for (std::size_t slot = 0; slot < frame.clear.num_slots(); ++slot) {
      const double before = frame.Chance(static_cast<double>(frame.clear.power_ratio[slot]));
      if (std::isnan(frame.clear.x[slot]) || before > 0.99) continue;
      const double kept = frame.Chance(frame.Weakened(slot)) / before;
      expected += kept;
      variance += kept * (1.0 - kept);
      num += std::isnan(frame.now.x[slot]) ? 0.0 : 1.0;
    }
  }
  EXPECT_GT(variance, 50.0);
  EXPECT_NEAR(num, expected, 4.0 * std::sqrt(variance));
}

TEST(AddedWeather, TakesTheAirsPartOfThePowerOfWhatStillReturns) {
  const RainedFrame frame = LetItRain("pandar64").front();
  std::size_t num = 0;
  for (std::size_t slot = 0; slot < frame.now.num_slots(); ++slot) {
    if (std::isnan(frame.now.x[slot])) continue;
    ++num;
    const auto now = static_cast<double>(frame.now.power_ratio[slot]);
    // Float32 has a relative error of 6e-8 for each of some ten operations.
    EXPECT_NEAR(now / frame.Weakened(slot), 1.0, 1e-6) << slot;
  }
  EXPECT_GT(num, 1000U);
}

// 59 % of its returns have reflectivity byte 0. The least reflectance that the preset detects at
// 5 m is 0.006 %, and fog of 100 m leaves exp(-0.3) of 0.25 %.
TEST(AddedWeather, LeavesWhatIsNearInARealCaptureOfMostlyByte0) {
  const auto capture =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "lidar_packets_nebula/pandar64.pcap";
  if (!exists(capture)) GTEST_SKIP() << capture << " is not there";
  const TemporaryDirectory folder;
  const auto plan = WritePlan(folder.path(), R"({"poses": "standing"})", "",
                              R"("fidelity": "footprint", "weather": {"visibility_m": 100}, )");
  const RecordedFrame recorded = (*OpenRecording(capture)->Next())();
  const Frame& frame = recorded.frame;
  const auto num_points = std::ranges::count_if(frame.x, [](float x) { return !std::isnan(x); });
  EXPECT_GT(std::ranges::count(frame.intensity, 0.0025F), num_points / 2);
  std::size_t num_added = 0;
  for (const SlotEdit& edit : MakeInsertion(plan, capture)(recorded).edits) {
    num_added += edit.is_added ? 1U : 0U;
    if (edit.lost_to != Outcome::kBelowThreshold) continue;
    EXPECT_GT(frame.range_m[edit.slot], 5.0F);
  }
  EXPECT_GT(num_added, 10'000U);  // By the fog.
}

std::vector<WeatherCase> WeatherCases() {
  WeatherSpec rain;
  rain.rain_rate_mmph = 30.0;
  WeatherSpec fog;
  fog.visibility_m = 80.0;
  WeatherSpec snow;
  snow.snow_rate_mmph = 4.0;
  CoverSpec drops{.drop_coverage = 0.3};
  return {{"rain", rain}, {"fog", fog}, {"snow", snow}, {"drops", {}, drops}};
}

INSTANTIATE_TEST_SUITE_P(Weather,
                         WeatherRoundTrip,
                         testing::ValuesIn(WeatherCases()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace railcast
