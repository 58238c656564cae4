// A recording in clear air to which weather is added is compared with the simulation in it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "generator/insert/inserter.h"
#include "tests/generator/insert/closed_loop.h"

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

std::vector<WeatherCase> WeatherCases() {
  WeatherSpec rain;
  rain.rain_rate_mmph = 30.0;
  WeatherSpec fog;
  fog.visibility_m = 80.0;
  WeatherSpec snow;
  snow.snow_rate_mmph = 4.0;
  CoverSpec drops;
  drops.drop_coverage = 0.3;
  return {{"rain", rain}, {"fog", fog}, {"snow", snow}, {"drops", {}, drops}};
}

INSTANTIATE_TEST_SUITE_P(Weather,
                         WeatherRoundTrip,
                         testing::ValuesIn(WeatherCases()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace railcast
