#include "railcast/fidelity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/fidelity/choice_report.h"
#include "core/fidelity/effect_search.h"
#include "core/fidelity/sample_frames.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A straight line of 1 km without plants, scanned by few beams.
struct Line {
  bool has_wires = true;
  std::string mount = "{}";
  std::string more = "";  ///< Further keys of the scenario.
  std::string start_s_m = "400";
};

ScenarioSpec Read(const Line& line) {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  return ReadScenario(folder
                          .Write(
                              "scenario.json",
                              R"({
    "version": 1,
    "fidelity": "auto",
    "lidar": {
      "range_max_m": 120,
      "mount": )" + line.mount + R"(,
      "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 30,
               "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}
    },
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "catenary": {"enabled": )" + (line.has_wires ? "true" : "false") +
                                  R"(},
      "terrain": {"roughness_sigma_m": 0.01},
      "vegetation": {"trees_per_hectare": 0, "grass": false}
    },
    "vehicle": {"start_s_m": )" + line.start_s_m +
                                  R"(, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},)" +
                                  line.more + R"(
    "materials": ")" + scenarios + R"(/materials/railway.json",
    "labels": ")" + scenarios + R"(/labels.json"})"));
}

FidelityChoice Choose(const ScenarioSpec& scenario, int num_threads = 0) {
  const auto simulator = MakeSimulator(scenario, num_threads);
  return ChooseFidelity(*simulator, scenario, [](double) {});
}

const char* const kSideways = R"({"position_m": [0, 0, 6], "yaw_deg": 90, "pitch_deg": 35})";

TEST(ChooseFidelity, LeavesOutThinConductorsWhereThereAreNoWires) {
  const FidelityChoice choice = Choose(Read({.has_wires = false}));
  EXPECT_FALSE(choice.effects.thin_conductors);
  EXPECT_THAT(ChoiceText(choice, {}), HasSubstr("without thin_conductors: changes nothing here\n"));
}

TEST(ChooseFidelity, KeepsThinConductorsWhereThereAreWires) {
  EXPECT_TRUE(Choose(Read({})).effects.thin_conductors);
}

TEST(ChooseFidelity, LeavesOutTheFootprintOnABarePlainFarFromEdges) {
  const FidelityChoice choice = Choose(Read({.has_wires = false, .mount = kSideways}));
  EXPECT_FALSE(choice.effects.footprint);
  EXPECT_TRUE(choice.is_within_tolerance);
}

TEST(ChooseFidelity, KeepsAllThatMattersAtNoTolerance) {
  const ScenarioSpec scenario = Read({.more = R"("tolerance": {"range_m": 0, "missed_share": 0,
      "false_share": 0, "thin_missed_share": 0, "intensity": 0},)"});
  const FidelityChoice choice = Choose(scenario);
  EXPECT_TRUE(choice.effects.footprint);
  EXPECT_TRUE(choice.effects.thin_conductors);
  EXPECT_TRUE(choice.effects.surface_response);
  EXPECT_TRUE(choice.effects.detection);
  // Leaving out the other effects must not increase any deviation.
  for (const DeviationQuantity& quantity : kDeviationQuantities) {
    EXPECT_LE(choice.deviation.*quantity.value, choice.full_deviation.*quantity.value);
  }
}

TEST(ChooseFidelity, LeavesOutTheDearestIfAnythingGoes) {
  const ScenarioSpec scenario = Read({.more = R"("tolerance": {"range_m": 100, "missed_share": 1,
      "false_share": 1, "thin_missed_share": 1, "intensity": 1000},)"});
  const FidelityChoice choice = Choose(scenario);
  EXPECT_FALSE(choice.effects.footprint);
  EXPECT_LT(choice.instructions, choice.full_instructions);
  EXPECT_TRUE(choice.is_within_tolerance);
}

TEST(ChooseFidelity, KeepsStatisticsThatHaveACause) {
  const ScenarioSpec rain = Read({.more = R"("weather": {"rain_rate_mmph": 20},)"});
  const FidelityChoice choice = Choose(rain);
  EXPECT_TRUE(choice.effects.clutter);
  EXPECT_TRUE(choice.effects.range_noise);
  EXPECT_THAT(choice.kept, Contains("clutter"));
  EXPECT_FALSE(choice.effects.fog_echo);
  EXPECT_FALSE(choice.effects.sunlight);
  EXPECT_THAT(choice.without_cause, Contains("fog_echo"));
}

TEST(ChooseFidelity, LeavesTheUsersSwitchesAlone) {
  const ScenarioSpec scenario =
      Read({.has_wires = false,
            .more = R"("effects": {"thin_conductors": true, "surface_response": false},)"});
  const FidelityChoice choice = Choose(scenario);
  EXPECT_TRUE(choice.effects.thin_conductors);
  EXPECT_FALSE(choice.effects.surface_response);
  EXPECT_THAT(choice.kept, Contains("thin_conductors"));
}

TEST(ChooseFidelity, IsTheSameAtAnyNumberOfThreads) {
  const ScenarioSpec scenario = Read({});
  const ToleranceSpec tolerance;
  EXPECT_EQ(ChoiceJson(Choose(scenario, 1), tolerance), ChoiceJson(Choose(scenario, 2), tolerance));
}

TEST(ChooseFidelity, IsNotMadeOnTheFramesItIsCheckedWith) {
  const FidelityChoice choice = Choose(Read({.has_wires = false, .mount = kSideways}));
  ASSERT_EQ(choice.held_back.size(), 3U);
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    EXPECT_THAT(choice.sample_frames, Not(Contains(held.frame)));
    EXPECT_EQ(held.is_within_tolerance, IsWithin(held.deviation, {}));
  }
}

TEST(ChooseFidelity, KeepsAllWhereNothingIsSeen) {
  const FidelityChoice choice =
      Choose(Read({.has_wires = false, .mount = R"({"pitch_deg": -80})"}));
  EXPECT_FALSE(choice.has_echoes);
  EXPECT_TRUE(choice.effects.footprint);
  EXPECT_THAT(ChoiceText(choice, {}), HasSubstr("no echo to compare with: all are kept\n"));
}

TEST(ChooseFidelity, LeavesTheSimulatorAsItWas) {
  const ScenarioSpec scenario = Read({.has_wires = false, .mount = kSideways});
  const auto simulator = MakeSimulator(scenario, 0);
  static_cast<void>(ChooseFidelity(*simulator, scenario, [](double) {}));
  EXPECT_EQ(simulator->spec().detector.effects, EffectsOfRung(Fidelity::kFootprint));
}

TEST(UseChosenFidelity, GivesTheSimulatorTheChosenEffects) {
  const ScenarioSpec scenario = Read({.has_wires = false, .mount = kSideways});
  const auto simulator = MakeSimulator(scenario, 0);
  ASSERT_NE(simulator->spec().detector.effects, Choose(scenario).effects);
  double done = -1.0;
  const FidelityChoice choice =
      UseChosenFidelity(*simulator, scenario, [&](double share) { done = share; });
  EXPECT_EQ(choice.effects, Choose(scenario).effects);
  EXPECT_EQ(simulator->spec().detector.effects, choice.effects);
  EXPECT_GT(done, 0.0);
}

std::vector<std::uint32_t> FramesFrom(const std::string& start_s_m) {
  const ScenarioSpec scenario = Read({.start_s_m = start_s_m});
  return SampleFrames(scenario, *MakeSimulator(scenario, 1), 3, 1.0);
}

TEST(SampleFrames, AreSoManySecondsApart) {
  EXPECT_THAT(FramesFrom("400"), ElementsAre(0, 10, 20));
}

TEST(SampleFrames, AreNearerWhereTheTrackEndsBefore) {
  // At 10 m/s the remaining 5 m last half a second, so that a span of 20 or 10 frames is too long
  // and one of 4 frames is not.
  EXPECT_THAT(FramesFrom("995"), ElementsAre(0, 2, 4));
  EXPECT_THAT(FramesFrom("1000"), ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace railcast
