#include "analysis/compare/ablation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/compare/compare_report.h"
#include "analysis/report/formats.h"
#include "core/detect/detector/effect_table.h"
#include "railcast/effects.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr auto kReturned = static_cast<std::size_t>(Outcome::kReturned);
constexpr auto kRainAbsorbed = static_cast<std::size_t>(Outcome::kRainAbsorbed);
constexpr auto kBelowThreshold = static_cast<std::size_t>(Outcome::kBelowThreshold);
constexpr auto kSensorDropout = static_cast<std::size_t>(Outcome::kSensorDropout);
constexpr auto kOutOfRange = static_cast<std::size_t>(Outcome::kOutOfRange);

// Ground and a wall in front of the sensor, in rain and noise.
Simulator MakeStudied(const EffectSet& effects, double resolution_deg = 0.25) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeFloor(-2.0F, 200.0F), 2, 1}, {MakeWall(60.0F, 20.0F), 1, 2}};
  SimulatorSpec spec{.detector = {.range_max_m = 150.0, .effects = effects}};
  spec.detector.plausibility.dropout_probability = 0.05;
  spec.detector.weather.rain_rate_mmph = 30.0;
  return {world, MakeRaster(40.0, 30.0, resolution_deg), TestMaterials(), spec, 1};
}

std::vector<EffectStudy> Study(const EffectSet& effects,
                               std::vector<std::uint32_t> frames = {0, 1}) {
  Simulator simulator = MakeStudied(effects);
  return Ablate(simulator, frames, {0.1}, [](const std::string&, double) {});
}

// Made once, for several tests look at it.
const std::vector<EffectStudy>& Published() {
  static const std::vector<EffectStudy> studies = Study(EffectsOfRung(Fidelity::kPlausibility));
  return studies;
}

std::vector<std::string> NamesOfStudied(Fidelity rung) {
  std::vector<std::string> names;
  for (const EffectStudy& study : Study(EffectsOfRung(rung), {})) names.push_back(study.effect);
  return names;
}

EffectStudy Of(const std::vector<EffectStudy>& studies, const std::string& effect) {
  const auto at = std::find_if(studies.begin(), studies.end(),
                               [&](const EffectStudy& s) { return s.effect == effect; });
  EXPECT_NE(at, studies.end()) << effect;
  return *at;
}

// Number of beams whose outcome changed in any other way than between the two given.
std::uint64_t OtherTransitions(const BeamChanges& beams, std::size_t from, std::size_t to) {
  return beams.num_outcome_changed - beams.transitions[from][to];
}

TEST(Ablation, FindsThatRainTakesBeamsAndTouchesNoOther) {
  const EffectStudy rain = Of(Published(), "rain");
  EXPECT_TRUE(rain.is_in_scenario);
  EXPECT_GT(rain.beams.num_removed, 100U);
  EXPECT_EQ(rain.beams.num_added, 0U);
  EXPECT_EQ(OtherTransitions(rain.beams, kReturned, kRainAbsorbed), 0U);
  EXPECT_EQ(rain.beams.num_identical + rain.beams.transitions[kReturned][kRainAbsorbed],
            rain.beams.num_beams);
  EXPECT_EQ(rain.beams.num_moved, 0U);
}

TEST(Ablation, FindsThatNoiseMovesPointsAndChangesNoOutcomeButAtTheGate) {
  const EffectStudy noise = Of(Published(), "noise");
  EXPECT_EQ(OtherTransitions(noise.beams, kReturned, kOutOfRange), 0U);
  EXPECT_EQ(noise.beams.num_moved, noise.beams.num_both);
  EXPECT_EQ(noise.beams.num_intensity_changed, 0U);
  // The noise is isotropic with a sigma of 10 to 25 mm; the median of its length is 1.54 sigma.
  EXPECT_GT(noise.beams.moved_m.Median().value, 0.015);
  EXPECT_LT(noise.beams.moved_m.Median().value, 0.04);
}

TEST(Ablation, FindsThatTheSensorsDropoutTakesItsShare) {
  const EffectStudy dropout = Of(Published(), "sensor_dropout");
  std::uint64_t num_dropped = 0;
  for (const auto& row : dropout.beams.transitions) num_dropped += row[kSensorDropout];
  const double num_beams = static_cast<double>(dropout.beams.num_beams);
  // Five standard deviations of a binomial share.
  EXPECT_NEAR(static_cast<double>(num_dropped) / num_beams, 0.05,
              5.0 * std::sqrt(0.05 * 0.95 / num_beams));
  EXPECT_EQ(dropout.beams.num_moved, 0U);
}

TEST(Ablation, SwitchesOnWhatTheScenarioLeavesOff) {
  EffectSet effects = EffectsOfRung(Fidelity::kPlausibility);
  effects.rain = false;
  const EffectStudy off = Of(Study(effects), "rain");
  const EffectStudy on = Of(Published(), "rain");
  EXPECT_FALSE(off.is_in_scenario);
  // The study compares without and with rain, whichever of both the scenario has.
  EXPECT_EQ(off.beams.transitions, on.beams.transitions);
  EXPECT_EQ(off.beams.num_removed, on.beams.num_removed);
}

TEST(Ablation, FindsNothingOfAnEffectWithoutItsWeather) {
  const EffectStudy snow = Of(Published(), "snow");
  EXPECT_EQ(snow.beams.num_identical, snow.beams.num_beams);
  EXPECT_EQ(snow.clouds.summaries()[0].largest, 0.0);
}

TEST(Ablation, BinsByTheRangeOfTheSurface) {
  const EffectStudy threshold = Of(Published(), "threshold");
  std::uint64_t num_beams = 0, num_changed = 0;
  for (const BeamChanges::RangeBin& bin : threshold.beams.range_bins) {
    num_beams += bin.num_beams;
    num_changed += bin.num_outcome_changed;
  }
  EXPECT_GT(threshold.beams.transitions[kReturned][kBelowThreshold], 0U);
  EXPECT_EQ(num_changed, threshold.beams.num_outcome_changed);
  EXPECT_LT(num_beams, threshold.beams.num_beams);  // Beams into the sky have no range.
}

TEST(Ablation, LeavesTheSimulatorAsItWas) {
  Simulator simulator = MakeStudied(EffectsOfRung(Fidelity::kPlausibility));
  Frame before, after;
  simulator.Scan(3, before);
  (void)Ablate(simulator, {0}, {0.1}, [](const std::string&, double) {});
  simulator.Scan(3, after);
  EXPECT_EQ(before.outcome, after.outcome);
  EXPECT_TRUE(simulator.spec().detector.effects == EffectsOfRung(Fidelity::kPlausibility));
}

TEST(Ablation, StudiesEffectsThatGoTogetherWithTheOthers) {
  EXPECT_THAT(NamesOfStudied(Fidelity::kPlausibility),
              ElementsAre("threshold", "rain", "snow", "noise", "sensor_dropout"));
  const std::vector<std::string> of_footprint = NamesOfStudied(Fidelity::kFootprint);
  EXPECT_THAT(of_footprint, Contains("thin_conductors"));
  EXPECT_THAT(of_footprint, Contains("sampled_waveform"));
  EXPECT_THAT(of_footprint, Not(Contains("rain")));
  // It would count wires twice.
  EXPECT_THAT(of_footprint, Not(Contains("dense_footprint")));
  // The dense footprint needs the effect footprint.
  EXPECT_THAT(NamesOfStudied(Fidelity::kReference), Not(Contains("footprint")));
}

TEST(Ablation, StudiesWhatDoesNotGoTogetherOnTheFirstRungThatHasIt) {
  constexpr double kResolution_deg = 1.0;
  Simulator simulator = MakeStudied(EffectsOfRung(Fidelity::kSurface), kResolution_deg);
  const auto silent = [](const std::string&, double) {};
  const std::vector<EffectStudy> all = Ablate(simulator, {0}, {0.1}, silent, StudyScope::kAll);
  EXPECT_EQ(all.size(), EffectNames().size());
  const EffectStudy rain = Of(all, "rain");
  EXPECT_EQ(rain.rung, Fidelity::kPlausibility);
  EXPECT_GT(rain.beams.num_removed, 0U);
  Simulator published = MakeStudied(EffectsOfRung(Fidelity::kPlausibility), kResolution_deg);
  const EffectStudy alone = Of(Ablate(published, {0}, {0.1}, silent), "rain");
  EXPECT_EQ(rain.beams.transitions, alone.beams.transitions);
  EXPECT_EQ(alone.rung, std::nullopt);
  EXPECT_EQ(Of(all, "extinction").rung, std::nullopt);
}

TEST(AblationReport, HasARowForEveryEffect) {
  const std::vector<EffectStudy>& studies = Published();
  const Report report = MakeAblationReport(studies, "Effects", {}, "");
  for (const Section& section : report.sections) {
    for (const Table& table : section.tables) {
      for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.key;
    }
  }
  const std::string json = ReportJson(report);
  EXPECT_THAT(json, HasSubstr("\"effect\": \"sensor_dropout\""));
  EXPECT_EQ(report.sections[0].tables[0].rows.size(), studies.size());
}

TEST(AblationReport, SaysHowFarFramesDiffer) {
  const EffectSet effects = EffectsOfRung(Fidelity::kPlausibility);
  std::vector<double> outcomes, points;  // In percent, of each frame by itself.
  for (const std::uint32_t frame : {0U, 1U}) {
    const BeamChanges alone = Of(Study(effects, {frame}), "rain").beams;
    const auto num_beams = static_cast<double>(alone.num_beams);
    outcomes.push_back(100.0 * static_cast<double>(alone.num_outcome_changed) / num_beams);
    points.push_back(100.0 * static_cast<double>(alone.num_removed + alone.num_added) / num_beams);
  }
  ASSERT_NE(outcomes[0], outcomes[1]);
  const std::vector<EffectStudy> studies = Study(effects);
  const Report report = MakeAblationReport(studies, "Effects", {}, "");
  const Table& table = report.sections[0].tables[1];
  ASSERT_EQ(table.key, "frames");
  ASSERT_EQ(table.rows.size(), studies.size());
  for (const auto& row : table.rows) {
    if (std::get<std::string>(row[0]) != "rain") continue;
    EXPECT_EQ(std::get<std::uint64_t>(row[1]), 2U);
    EXPECT_DOUBLE_EQ(std::get<double>(row[2]), std::ranges::min(outcomes));
    EXPECT_DOUBLE_EQ(std::get<double>(row[4]), std::ranges::max(outcomes));
    EXPECT_DOUBLE_EQ(std::get<double>(row[5]), std::ranges::min(points));
    EXPECT_DOUBLE_EQ(std::get<double>(row[7]), std::ranges::max(points));
  }
}

}  // namespace
}  // namespace railcast
