#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "analysis/frontier/kept_frontier.h"
#include "analysis/frontier/measure.h"
#include "analysis/frontier/pareto.h"
#include "core/base/error.h"
#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "railcast/effects.h"
#include "tests/analysis/made_results.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

TEST(KeptFrontier, GivesBackWhatItKeptBitByBit) {
  const TemporaryDirectory directory;
  const Frame frame = ExampleFrame(3);
  const std::vector<float> steps_m = {0.25F, std::nanf(""), 1.0F / 3.0F};
  const std::vector<RowTimes> times = {{{1.0 / 3.0, 2.0}, {1.0}, {0.3, 1.9}}, {{}, {}}};
  {
    const KeptFrontier kept(directory.path() / "kept", "a run");
    EXPECT_FALSE(kept.HasFrame(3));
    EXPECT_TRUE(FrameBytes(kept.FrameOf(3, [&] { return frame; })) == FrameBytes(frame));
    EXPECT_EQ(kept.StepsOf(3, [&] { return steps_m; }).size(), 3U);
    EXPECT_EQ(kept.TimesOf(3, [&] { return times; }).size(), 2U);
  }
  const KeptFrontier kept(directory.path() / "kept", "a run");
  EXPECT_TRUE(kept.HasFrame(3));
  EXPECT_TRUE(kept.HasTimes(3));
  EXPECT_FALSE(kept.HasFrame(4));
  const auto never = []() -> Frame { throw std::logic_error("is made again"); };
  const Frame again = kept.FrameOf(3, never);
  EXPECT_TRUE(FrameBytes(again) == FrameBytes(frame));
  EXPECT_TRUE(again.world_from_sensor.matrix() == frame.world_from_sensor.matrix());
  EXPECT_EQ(again.stamp_ns, frame.stamp_ns);
  const auto kept_steps_m = kept.StepsOf(3, [] { return std::vector<float>(); });
  ASSERT_EQ(kept_steps_m.size(), 3U);
  EXPECT_TRUE(std::isnan(kept_steps_m[1]));
  EXPECT_EQ(kept_steps_m[2], steps_m[2]);
  const auto kept_times = kept.TimesOf(3, [] { return std::vector<RowTimes>(); });
  EXPECT_EQ(kept_times.at(0).times_ms, times[0].times_ms);
  EXPECT_EQ(kept_times.at(0).processor_ms, times[0].processor_ms);
  EXPECT_EQ(kept_times.at(1).times_ms, times[1].times_ms);
  kept.Remove();
  EXPECT_FALSE(exists(directory.path() / "kept"));
}

TEST(KeptFrontier, RefusesWhatAnotherRunHasLeftAndMakesAnewWhatIsDamaged) {
  const TemporaryDirectory directory;
  const auto folder = directory.path() / "kept";
  const auto make = [] { return ExampleFrame(3); };
  static_cast<void>(KeptFrontier(folder, "a run").FrameOf(3, make));
  EXPECT_EQ(
      MessageOf([&] { KeptFrontier(folder, "another run"); }),
      folder.string() + ": must be what the same command has written; remove it to start anew");
  std::ofstream(folder / "frame_3", std::ios::app) << "more";
  int num_made = 0;
  const auto make_again = [&] {
    ++num_made;
    return make();
  };
  for (int i = 0; i < 2; ++i) {
    static_cast<void>(KeptFrontier(folder, "a run").FrameOf(3, make_again));
  }
  EXPECT_EQ(num_made, 1);
}

// Whose files had the lists of each row under names of their own.
TEST(KeptFrontier, TimesAnewWhatEarlierBuildsHaveLeft) {
  for (const char* const before :
       {"[]", "[[]]", "[[[1.5], [1.0]]]", "[[[1.5], [1.0]], [[], []]]"}) {
    const TemporaryDirectory directory;
    const KeptFrontier kept(directory.path() / "kept", "a run");
    WriteFileWhole(directory.path() / "kept" / "times_3", before + ContentHash(before));
    EXPECT_FALSE(kept.HasTimes(3));
    for (int i = 0; i < 2; ++i) {
      int num_made = 0;
      const auto times = kept.TimesOf(3, [&] {
        ++num_made;
        return std::vector<RowTimes>{{{2.0}, {1.0}, {1.9}}};
      });
      EXPECT_EQ(num_made, i == 0 ? 1 : 0);
      EXPECT_EQ(times.at(0).processor_ms.at(0), 1.9);
    }
    EXPECT_TRUE(kept.HasTimes(3));
  }
}

/// Stands for Ctrl-C.
struct Stopped {};

// A run that is stopped at its last frame goes on there, with the same figures in the end.
TEST(MeasureFrontier, GoesOnWhereAnEarlierRunWasStopped) {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  const auto file = folder.Write("scenario.json", R"({"version": 1, "file": ")" + scenarios +
                                                      R"(/minimal.json",
    "world": {"alignment": {"course": {"type": "elements",
        "elements": [{"type": "straight", "length_m": 1000}]}},
      "vegetation": {"trees_per_hectare": 0, "grass": false}},
    "lidar": {"file": ")" + scenarios + R"(/sensors/vir2rail.json",
      "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 20,
        "vertical_fov_deg": 40, "angular_resolution_deg": 0.5}}}})");
  ScenarioSpec scenario = ReadScenario(file);
  scenario.world.detail = SceneDetail::kFull;
  // Each run is a program of its own.
  const auto measure = [&](const FrontierPlan& plan, const KeptFrontier& kept,
                           const FrontierProgress& on_progress) {
    return MeasureFrontier(plan, scenario, *MakeSimulator(scenario, 2), kept, on_progress);
  };
  const FrontierPlan plan{.rows = ChooseFrontierRows("geometry,footprint_16"),
                          .frames = {0, 5},
                          .approach_frames = {2},
                          .num_threads = 2,
                          .num_rounds = 1,
                          .yardstick_rays = 16};
  const auto kept_folder = file.parent_path() / "kept";
  const KeptFrontier kept(kept_folder, "a run");
  std::vector<std::string> whats;
  EXPECT_EQ(KeptShare(plan, kept), 0.0);
  EXPECT_THROW((void)measure(plan, kept,
                             [&](const std::string& what, double done) {
                               EXPECT_LE(done, 1.0);
                               whats.push_back(what);
                               if (what == "errors of frame 5") throw Stopped();
                             }),
               Stopped);
  EXPECT_THAT(whats,
              testing::ElementsAre("timing frame 0", "reference of frame 0", "errors of frame 0",
                                   "timing frame 5", "reference of frame 5", "errors of frame 5"));
  // Of 2 frames and one on the way, 2.5 in all, what is left are the errors, 0.1 each, and the
  // frame on the way, 0.5.
  EXPECT_NEAR(KeptShare(plan, kept), 1.8 / 2.5, 1e-9);
  const std::string times = ReadFileWhole(kept_folder / "spent_0");
  const auto ignore = [](const std::string&, double) {};
  const auto resumed = measure(plan, kept, ignore);
  EXPECT_EQ(ReadFileWhole(kept_folder / "spent_0"), times) << "timed again";
  const auto whole = measure(plan, KeptFrontier(), ignore);
  ASSERT_EQ(resumed.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    // How often a frame is timed depends on how long that takes.
    EXPECT_EQ(resumed[i].times_ms.empty(), whole[i].times_ms.empty());
    ASSERT_EQ(resumed[i].difference.has_value(), whole[i].difference.has_value());
    if (!whole[i].difference) continue;
    EXPECT_EQ(resumed[i].difference->reference_echoes.num_matched,
              whole[i].difference->reference_echoes.num_matched);
    EXPECT_EQ(resumed[i].difference->range_m.median, whole[i].difference->range_m.median);
  }
}

const FrontierError& Missed() {
  return kFrontierErrors.front();
}

TEST(ParetoFront, HoldsWhatNothingElseBeats) {
  const std::vector<RowResult> results = {MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0),
                                          MadeResult("a", RowGroup::kLadder, 1.1, 30),
                                          MadeResult("b", RowGroup::kLadder, 2.0, 40),
                                          MadeResult("c", RowGroup::kBruteForce, 3.0, 20),
                                          MadeResult("d", RowGroup::kBetween, 3.0, 10),
                                          MadeResult("e", RowGroup::kReference, 2.5, 0)};
  EXPECT_THAT(ParetoFront(results, Missed()), ElementsAre("a", "d"));
}

TEST(ParetoFront, HoldsBothOfTwoEquals) {
  const std::vector<RowResult> results = {MadeResult("a", RowGroup::kLadder, 2.0, 30),
                                          MadeResult("b", RowGroup::kLadder, 2.0, 30)};
  EXPECT_THAT(ParetoFront(results, Missed()), ElementsAre("a", "b"));
}

TEST(ParetoFront, LeavesOutWhatHasNoSuchError) {
  const auto intensity = std::find_if(
      kFrontierErrors.begin(), kFrontierErrors.end(),
      [](const FrontierError& error) { return std::string(error.name) == "intensity_median"; });
  EXPECT_THAT(ParetoFront({MadeResult("a", RowGroup::kLadder, 1.0, 0)}, *intensity), IsEmpty());
}

TEST(FindDefeats, NamesBruteForceThatIsFasterAndMoreAccurate) {
  const std::vector<RowResult> results = {MadeResult("surface", RowGroup::kLadder, 2.0, 30),
                                          MadeResult("footprint", RowGroup::kLadder, 5.0, 10),
                                          MadeResult("between", RowGroup::kBetween, 9.0, 90),
                                          MadeResult("brute_4", RowGroup::kBruteForce, 4.0, 9)};
  const std::vector<Defeat> defeats = FindDefeats(results);
  ASSERT_FALSE(defeats.empty());
  EXPECT_EQ(defeats[0].brute_force, "brute_4");
  EXPECT_EQ(defeats[0].ours, "footprint");
  EXPECT_EQ(defeats[0].error, "missed_share");
  EXPECT_THAT(DefeatsText(results),
              StartsWith("Faster and more accurate than a rung: brute_4 than footprint in "
                         "missed_share"));
}

TEST(FindDefeats, FindsNoneWhereBruteForceIsSlowerOrWorse) {
  const std::vector<RowResult> results = {MadeResult("footprint", RowGroup::kLadder, 3.0, 10),
                                          MadeResult("brute_4", RowGroup::kBruteForce, 2.0, 20),
                                          MadeResult("brute_64", RowGroup::kBruteForce, 20.0, 2)};
  std::vector<Defeat> missed = FindDefeats(results);
  std::erase_if(missed, [](const Defeat& defeat) { return defeat.error != "missed_share"; });
  EXPECT_THAT(missed, IsEmpty());
  const std::vector<RowResult> alike = {MadeResult("footprint", RowGroup::kLadder, 3.0, 10),
                                        MadeResult("brute_4", RowGroup::kBruteForce, 3.0, 10)};
  EXPECT_EQ(DefeatsText(alike), "No row of brute force is faster and more accurate than a rung.");
}

TEST(FindDefeats, ClaimNothingWithoutRowsOfBothKinds) {
  const std::string none =
      "Brute force is not compared with the rungs: there must be rows of both.";
  EXPECT_EQ(DefeatsText({}), none);
  EXPECT_EQ(DefeatsText({MadeResult("footprint", RowGroup::kLadder, 3.0, 10),
                         MadeResult("d", RowGroup::kBetween, 3.0, 10)}),
            none);
  EXPECT_EQ(DefeatsText({MadeResult("brute_4", RowGroup::kBruteForce, 2.0, 20)}), none);
}

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
            "surface+thin_conductors footprint-thin_conductors footprint_of footprint_16 "
            "footprint auto surface+thin_conductors+auto_detail footprint_16+auto_detail "
            "footprint+auto_detail brute_force_4 brute_force_7 brute_force_19 brute_force_64 "
            "reference_16 "
            "reference_64 reference_256 (got best)");
}

TEST(FrontierRows, TakeWhatFidelityAutoChooses) {
  std::vector<FrontierRow> rows = ChooseFrontierRows("footprint,auto");
  FidelityChoice choice;
  choice.effects = EffectsOfRung(Fidelity::kSurface);
  choice.footprint_rays = 16;
  choice.footprint_of = {"person"};
  UseChoice(choice, LabelTable({{4, "ground", {}, {}, {}, 0, 0}, {13, "person", {}, {}, {}, 0, 0}}),
            rows);
  EXPECT_EQ(SpecOfRow(rows[1], {}).detector.effects, EffectsOfRung(Fidelity::kFootprint));
  EXPECT_EQ(SpecOfRow(rows[1], {}).detector.beam.footprint_rays, 64);
  EXPECT_EQ(SpecOfRow(rows[2], {}).detector.effects, EffectsOfRung(Fidelity::kSurface));
  EXPECT_EQ(SpecOfRow(rows[2], {}).detector.beam.footprint_rays, 16);
  EXPECT_THAT(SpecOfRow(rows[1], {}).detector.footprint_labels, IsEmpty());
  EXPECT_THAT(SpecOfRow(rows[2], {}).detector.footprint_labels, ElementsAre(13));
}

TEST(FrontierRows, GiveBeamsAWidthThatMayMeetThingsUnlessClassesAreAskedFor) {
  const LabelTable labels({{13, "person", {}, {}, {}, 0, 0},
                           {4, "ground", {}, {}, {}, 0, 0},
                           {10, "mast", {}, {}, {}, 0, 0}});
  std::vector<FrontierRow> rows = ChooseFrontierRows("footprint_of");
  FidelityChoice choice;
  UseChoice(choice, labels, rows);
  EXPECT_THAT(rows[1].footprint_labels, ElementsAre(10, 13));
  choice.footprint_of = {"person"};
  UseChoice(choice, labels, rows);
  EXPECT_THAT(rows[1].footprint_labels, ElementsAre(13));
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
