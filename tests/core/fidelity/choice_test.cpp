#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/detect/detector/effect_table.h"
#include "core/fidelity/choice_report.h"
#include "core/fidelity/effect_search.h"
#include "railcast/effects.h"
#include "railcast/fidelity.h"
#include "railcast/scenario.h"
#include "tests/core/fidelity/line_scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/sensor_sector.h"

namespace railcast {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

FidelityChoice Choose(const ScenarioSpec& scenario, int num_threads = 0) {
  const auto simulator = MakeSimulator(scenario, num_threads);
  return ChooseFidelity(*simulator, scenario, [](double) {});
}

const char* const kSideways = R"({"position_m": [0, 0, 6], "yaw_deg": 90, "pitch_deg": 35})";

const char* const kAnythingGoes = R"("tolerance": {"range_m": 100, "missed_share": 1,
    "false_share": 1, "thin_missed_share": 1, "intensity": 1000},)";

// Choices that several tests look at.
const FidelityChoice& OnTheLine() {
  static const FidelityChoice choice = Choose(ReadLine({}), 2);
  return choice;
}
const FidelityChoice& OnABarePlain() {
  static const FidelityChoice choice = Choose(ReadLine({.has_wires = false, .mount = kSideways}));
  return choice;
}
const FidelityChoice& WhereAnythingGoes() {
  static const FidelityChoice choice = Choose(ReadLine({.more = kAnythingGoes}));
  return choice;
}

TEST(ChooseFidelity, KeepsThinConductorsWhereThereAreWires) {
  EXPECT_TRUE(OnTheLine().effects.thin_conductors);
}

TEST(ChooseFidelity, LeavesOutTheFootprintOnABarePlainFarFromEdges) {
  const FidelityChoice& choice = OnABarePlain();
  EXPECT_FALSE(choice.effects.footprint);
  EXPECT_TRUE(choice.is_within_tolerance);
}

TEST(ChooseFidelity, KeepsAllThatMattersAtNoTolerance) {
  const ScenarioSpec scenario = ReadLine({.more = R"("tolerance": {"range_m": 0, "missed_share": 0,
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
  const FidelityChoice& choice = WhereAnythingGoes();
  EXPECT_FALSE(choice.effects.footprint);
  EXPECT_LT(choice.instructions, choice.full_instructions);
  EXPECT_TRUE(choice.is_within_tolerance);
}

// It would save 35 of 39,000 instructions, or of 4,000 where the user has switched the footprint
// off. Far away, where the sensor sees nothing, everything would then return.
TEST(ChooseFidelity, NeverLeavesOutTheThreshold) {
  EXPECT_TRUE(WhereAnythingGoes().effects.detection);
  const FidelityChoice choice = Choose(
      ReadLine({.more = std::string(R"("effects": {"footprint": false},)") + kAnythingGoes}));
  EXPECT_TRUE(choice.effects.detection);
  EXPECT_THAT(choice.kept, Contains("detection"));
  EXPECT_FALSE(choice.effects.detection_probability);
}

TEST(ChooseFidelity, KeepsWhatSavesLessThanOnePercent) {
  const FidelityChoice choice = Choose(ReadLine({.has_wires = false, .more = kAnythingGoes}));
  for (const Effect& effect : EffectTable()) {
    if (!effect.instructions || *effect.instructions >= 0.01 * choice.full_instructions) continue;
    const bool has_no_cause = std::ranges::count(choice.without_cause, effect.name) > 0;
    EXPECT_NE(choice.effects.*effect.is_on, has_no_cause) << effect.name;
  }
}

// Stakes of 3 cm beside the track, from 4.4 s after the start on: a ray meets one now and then.
TEST(ChooseFidelity, SeesWhatComesLater) {
  Line line{.has_wires = false, .mount = kSideways};
  EXPECT_FALSE(OnABarePlain().effects.footprint);
  line.objects = "[";
  for (int i = 0; i < 4; ++i) {
    line.objects += std::string(i == 0 ? "" : ", ") + R"({"name": "stake )" + std::to_string(i) +
                    R"(", "type": "pole", "s_m": )" + std::to_string(444 + i) +
                    R"(, "d_m": 9, "size_m": [0.03, 0.03, 2]})";
  }
  line.objects += "]";
  const FidelityChoice choice = Choose(ReadLine(line));
  EXPECT_TRUE(choice.effects.footprint);
  ASSERT_EQ(choice.measured[0].what, "footprint");
  EXPECT_LT(choice.measured[0].without.missed_share, 0.01) << "the mean does not show it";
  EXPECT_THAT(ChoiceText(choice), HasSubstr("    pole: "));
}

// Without wires, because they have twelve echoes here, of which a second missed one decides.
TEST(ChooseFidelity, SendsFewerSubRaysWhereTheySuffice) {
  const FidelityChoice choice = Choose(ReadLine({.has_wires = false, .trees_per_hectare = "100"}));
  EXPECT_EQ(choice.footprint_rays, 16) << ChoiceText(choice);
  EXPECT_TRUE(choice.effects.footprint) << ChoiceText(choice);
  EXPECT_EQ(choice.full_instructions - choice.instructions, kInstructionsOfMoreSubRays);
}

// With a tolerance of 10 %, the 130 echoes beyond 100 m of one world would decide.
TEST(ChooseFidelity, IsTheSameInAllWorlds) {
  Line line{.has_wires = false,
            .more = R"("tolerance": {"missed_share": 0.2, "false_share": 0.2},)",
            .trees_per_hectare = "100"};
  const FidelityChoice first = Choose(ReadLine(line));
  for (line.world_seed = 2; line.world_seed <= 4; ++line.world_seed) {
    const FidelityChoice choice = Choose(ReadLine(line));
    EXPECT_EQ(choice.effects, first.effects) << line.world_seed;
    EXPECT_EQ(choice.footprint_rays, first.footprint_rays) << line.world_seed;
    if (HasFailure()) ADD_FAILURE() << ChoiceText(first) << ChoiceText(choice);
  }
}

TEST(ChooseFidelity, KeepsStatisticsThatHaveACause) {
  const ScenarioSpec rain = ReadLine({.more = R"("weather": {"rain_rate_mmph": 20},)"});
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
      ReadLine({.has_wires = false,
                .more = R"("effects": {"thin_conductors": true, "surface_response": false},)"});
  const FidelityChoice choice = Choose(scenario);
  EXPECT_TRUE(choice.effects.thin_conductors);
  EXPECT_FALSE(choice.effects.surface_response);
  EXPECT_THAT(choice.kept, Contains("thin_conductors"));
}

// Of these classes, beams without a width lose nothing: the errors are those of all beams.
TEST(ChooseFidelity, GivesOnlyThoseBeamsAWidthThatMayMeetTheClassesOfTheTolerance) {
  ScenarioSpec scenario = ReadLine({.more = R"("tolerance": {"of": ["mast", "rail"]},)"});
  const FidelityChoice of_some = Choose(scenario);
  EXPECT_THAT(of_some.footprint_of, ElementsAre("mast", "rail"));
  EXPECT_THAT(ChoiceText(of_some), HasSubstr(" of mast and rail\n"));
  for (const Label& label : scenario.labels) {
    const bool is_of_echoes = std::ranges::any_of(EffectTable(), [&](const Effect& effect) {
      return std::ranges::find(effect.labels, label.name, &EffectLabel::name) !=
             effect.labels.end();
    });
    if (!is_of_echoes) scenario.lidar.beam.footprint_of.push_back(label.name);
  }
  const FidelityChoice of_all = Choose(scenario);
  EXPECT_EQ(of_some.full_deviation, of_all.full_deviation);
  EXPECT_LT(of_some.full_deviation.missed_share, 0.5);
  EXPECT_LT(of_some.full_instructions, OnTheLine().full_instructions);
  EXPECT_THAT(OnTheLine().footprint_of, IsEmpty());
}

TEST(ChooseFidelity, IsTheSameAtAnyNumberOfThreads) {
  EXPECT_EQ(ChoiceJson(Choose(ReadLine({}), 1)), ChoiceJson(OnTheLine()));
}

TEST(ChooseFidelity, IsNotMadeOnTheFramesItIsCheckedWith) {
  const FidelityChoice& choice = OnABarePlain();
  ASSERT_EQ(choice.held_back.size(), 3U);
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    EXPECT_THAT(choice.sample_frames, Not(Contains(held.frame)));
    EXPECT_TRUE(held.is_within_tolerance);
  }
}

TEST(ChooseFidelity, SaysWhichSceneDetailHolds) {
  const FidelityChoice& choice = OnABarePlain();
  EXPECT_THAT(ChoiceText(choice), HasSubstr("\n  scene detail: auto, as the scenario has it: "));
  EXPECT_THAT(ChoiceJson(choice), HasSubstr("\"detail\": \"auto\""));
  ScenarioSpec scenario = ReadLine({.has_wires = false, .mount = kSideways});
  scenario.world.detail = SceneDetail::kFull;
  const FidelityChoice in_full = Choose(scenario);
  EXPECT_THAT(ChoiceText(in_full), HasSubstr("\n  scene detail: full, as the scenario has it\n"));
  EXPECT_THAT(ChoiceJson(in_full), HasSubstr("\"detail\": \"full\""));
}

TEST(ChoiceText, TellsWhatIsNeededFromWhatChangesNothing) {
  FidelityChoice choice;
  choice.measured = {{.what = "thin_conductors", .is_kept = true, .without = {.missed_share = 0.5}},
                     {.what = "range_noise", .is_kept = false, .without = {.range_m = 0.001}},
                     {.what = "footprint", .is_kept = false, .without = choice.full_deviation}};
  const std::string text = ChoiceText(choice);
  EXPECT_THAT(text,
              HasSubstr("\n  needs thin_conductors: without it range 0.0 mm, missed 50.00 %, "));
  EXPECT_THAT(text, HasSubstr("\n  without range_noise: range 1.0 mm, missed 0.00 %, "));
  EXPECT_THAT(text, HasSubstr("\n  without footprint: changes nothing here\n"));
}

TEST(ChooseFidelity, HoldsNoFrameBackBeyondTheEndOfTheTrack) {
  const FidelityChoice choice = Choose(ReadLine({.mount = kSideways, .start_s_m = "460"}));
  EXPECT_THAT(choice.sample_frames, ElementsAre(0));
  EXPECT_THAT(choice.held_back, IsEmpty());
  EXPECT_THAT(ChoiceText(choice), HasSubstr("held back: not measured, the run has one frame"));
}

TEST(ChooseFidelity, KeepsAllWhereNothingIsSeen) {
  const FidelityChoice choice =
      Choose(ReadLine({.has_wires = false, .mount = R"({"pitch_deg": -80})"}));
  EXPECT_FALSE(choice.has_echoes);
  EXPECT_TRUE(choice.effects.footprint);
  EXPECT_THAT(ChoiceText(choice), HasSubstr("no echo to compare with: all are kept\n"));
}

TEST(ChooseFidelity, KeepsAllWhereNothingOfTheTolerancesClassesIsSeen) {
  ScenarioSpec scenario = ReadLine({.has_wires = false, .mount = kSideways});
  scenario.tolerance.of = {"person"};
  const FidelityChoice choice = Choose(scenario);
  EXPECT_FALSE(choice.has_echoes);
  EXPECT_TRUE(choice.effects.footprint);
}

TEST(ChooseFidelity, LeavesTheSimulatorAsItWas) {
  const ScenarioSpec scenario = ReadLine({.has_wires = false, .mount = kSideways});
  const auto simulator = MakeSimulator(scenario, 0);
  static_cast<void>(ChooseFidelity(*simulator, scenario, [](double) {}));
  EXPECT_EQ(simulator->spec().detector.effects, EffectsOfRung(Fidelity::kFootprint));
}

TEST(UseChosenFidelity, GivesTheSimulatorTheChosenEffects) {
  const ScenarioSpec scenario = ReadLine({.has_wires = false, .mount = kSideways});
  const auto simulator = MakeSimulator(scenario, 0);
  ASSERT_NE(simulator->spec().detector.effects, OnABarePlain().effects);
  double done = -1.0;
  const FidelityChoice choice =
      UseChosenFidelity(*simulator, scenario, [&](double share) { done = share; });
  EXPECT_EQ(choice.effects, OnABarePlain().effects);
  EXPECT_EQ(simulator->spec().detector.effects, choice.effects);
  EXPECT_EQ(simulator->spec().detector.beam.footprint_rays, choice.footprint_rays);
  EXPECT_GT(done, 0.0);
}

TEST(UseChosenFidelity, GivesTheSimulatorTheClassesOfTheTolerance) {
  const ScenarioSpec scenario = ReadLine(
      {.has_wires = false, .mount = kSideways, .more = R"("tolerance": {"of": ["rail"]},)"});
  const auto simulator = MakeSimulator(scenario, 0);
  EXPECT_THAT(simulator->spec().detector.footprint_labels, IsEmpty());
  static_cast<void>(UseChosenFidelity(*simulator, scenario, [](double) {}));
  EXPECT_THAT(simulator->spec().detector.footprint_labels, ElementsAre(1));
}

// Fidelity `auto` keeps its promise whatever the pattern of the beams: on the open line, what it
// chooses stays within the default tolerance, also on the frames held back, except where all
// effects together miss too much (far away, where few sub-rays meet grazing ground). Ten degrees to
// either side or five, and the whole of the rosette.

ScenarioSpec OpenLineWith(const std::string& sensor) {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "scenario.json";
  std::ofstream(file) << R"({"version": 1, "fidelity": "auto", "file": ")" << scenarios
                      << R"(open_line.json", "lidar": {"file": ")" << scenarios << "sensors/"
                      << sensor
                      << R"(.json", "mount": {"position_m": [2.0, 0, 4.6], "pitch_deg": 3}}})";
  ScenarioSpec scenario = ReadScenario(file);
  // VLS-128 has as many beams in a sector half as wide as Pandar64.
  scenario.lidar.scan =
      CutSector(scenario.lidar.scan, {sensor == "vls128" ? 5.0 : 10.0, -90.0, 90.0});
  scenario.lidar.beam.reference_rays = 64;
  // The vehicle stops after 44 m, so that few windows have to be built.
  scenario.vehicle.motion.profile = {{0.0, {}, 22.2}, {4.0, {}, 0.0}};
  return scenario;
}

class FidelityAutoOn : public testing::TestWithParam<std::string> {};

TEST_P(FidelityAutoOn, StaysWithinTheToleranceOnTheOpenLine) {
  const ScenarioSpec scenario = OpenLineWith(GetParam());
  const auto simulator = MakeSimulator(scenario, 0);
  const FidelityChoice choice = ChooseFidelity(*simulator, scenario, [](double) {});
  EXPECT_TRUE(IsWithinOrAsFull(choice.deviation, choice.full_deviation, scenario.tolerance));
  EXPECT_LT(choice.deviation.missed_share, 0.1);
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    EXPECT_TRUE(held.is_within_tolerance) << "frame " << held.frame;
  }
  EXPECT_EQ(choice.held_back.size(), 3U);
  if (HasFailure()) ADD_FAILURE() << ChoiceText(choice);
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         FidelityAutoOn,
                         testing::Values("vir2rail", "pandar64", "vls128", "rosette"),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
