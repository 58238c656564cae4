#include "analysis/frontier/measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "railcast/effects.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

using testing::ElementsAre;

std::vector<std::string> NamesOf(const std::vector<FrontierRow>& rows) {
  std::vector<std::string> names;
  for (const FrontierRow& row : rows) names.push_back(row.name);
  return names;
}

TEST(FrontierRows, AreSoundSetsOfEffects) {
  for (const FrontierRow& row : AllFrontierRows()) {
    EXPECT_EQ(ConflictIn(row.effects), std::nullopt) << row.name;
  }
}

TEST(FrontierRows, OfBruteForceHaveTheirNamesNumberOfRays) {
  int num_rows = 0;
  for (const FrontierRow& row : AllFrontierRows()) {
    if (row.group != RowGroup::kBruteForce) continue;
    EXPECT_EQ(row.name, "brute_force_" + std::to_string(row.sub_rays.value() + 1));
    EXPECT_TRUE(row.effects.dense_footprint);
    EXPECT_FALSE(row.effects.thin_conductors);
    EXPECT_FALSE(row.effects.sampled_waveform);
    ++num_rows;
  }
  EXPECT_EQ(num_rows, 4);
}

TEST(FrontierRows, CanBeChosenAndKeepTheRawTrace) {
  EXPECT_THAT(NamesOf(ChooseFrontierRows("footprint,surface")),
              ElementsAre("raw_trace", "surface", "footprint"));
  EXPECT_EQ(NamesOf(ChooseFrontierRows("all")), NamesOf(AllFrontierRows()));
}

TEST(FrontierRows, AreNamedWhereOneIsUnknown) {
  EXPECT_EQ(MessageOf([&] { static_cast<void>(ChooseFrontierRows("surface,best")); }),
            "--rows: must be all, or of raw_trace geometry plausibility surface "
            "surface+thin_conductors footprint-thin_conductors footprint_16 footprint auto "
            "surface+thin_conductors+auto_detail footprint_16+auto_detail "
            "footprint+auto_detail brute_force_4 brute_force_7 brute_force_19 brute_force_64 "
            "reference_16 "
            "reference_64 reference_256 (got best)");
}

TEST(FrontierRows, TakeWhatFidelityAutoChooses) {
  std::vector<FrontierRow> rows = ChooseFrontierRows("footprint,auto");
  FidelityChoice choice;
  choice.effects = EffectsOfRung(Fidelity::kSurface);
  choice.footprint_rays = 16;
  UseChoice(choice, rows);
  EXPECT_EQ(SpecOfRow(rows[1], {}).detector.effects, EffectsOfRung(Fidelity::kFootprint));
  EXPECT_EQ(SpecOfRow(rows[1], {}).detector.beam.footprint_rays, 64);
  EXPECT_EQ(SpecOfRow(rows[2], {}).detector.effects, EffectsOfRung(Fidelity::kSurface));
  EXPECT_EQ(SpecOfRow(rows[2], {}).detector.beam.footprint_rays, 16);
}

TEST(SpecOfRow, GivesThePublishedModelThePhysicalThreshold) {
  SimulatorSpec scenario;
  scenario.detector.receiver.range_at_10_percent_m = 140.0;
  scenario.detector.beam.reference_rays = 77;
  const SimulatorSpec spec = SpecOfRow(
      {"plausibility", RowGroup::kLadder, EffectsOfRung(Fidelity::kPlausibility)}, scenario);
  EXPECT_EQ(spec.detector.plausibility.reference_threshold, 0.1);
  EXPECT_EQ(spec.detector.plausibility.reference_range_m, 140.0);
  EXPECT_EQ(spec.detector.effects, EffectsOfRung(Fidelity::kPlausibility));
  EXPECT_EQ(spec.detector.beam.reference_rays, 77);
}

}  // namespace
}  // namespace railcast
