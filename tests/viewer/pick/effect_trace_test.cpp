#include "viewer/pick/effect_trace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "core/io/run/scenario_identity.h"
#include "core/io/write_file.h"
#include "core/scenario/command_log.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/viewer/pick/shown_cloud.h"
#include "tests/viewer/session/held_frames.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

using testing::EndsWith;
using testing::HasSubstr;

RecordingInfo InfoOf(const fs::path& scenario) {
  RecordingInfo info;
  info.source = scenario.parent_path();
  info.scenario = ReadScenario(scenario);
  return info;
}

/// A frame of which nothing is known but its grid of slots.
RecordedFrame Grid(const Frame& frame) {
  RecordedFrame recorded;
  recorded.frame = frame;
  recorded.name = "frame";
  recorded.is_grid = true;
  return recorded;
}

/// A frame of a scenario, and the effect trace of its firings.
class Traced {
 public:
  explicit Traced(const fs::path& scenario, std::uint32_t frame_index = 3)
      : scenario_(scenario),
        simulator_(MakeSimulator(ReadScenario(scenario), 0)),
        trace_(InfoOf(scenario)) {
    Frame frame;
    simulator_->Scan(frame_index, frame);
    recorded_ = Grid(frame);
  }

  [[nodiscard]] const Frame& frame() const { return recorded_.frame; }
  [[nodiscard]] std::uint32_t SlotOf(std::uint32_t firing) const {
    const ScanPattern& pattern = simulator_->pattern();
    return (pattern.row.at(firing) * pattern.columns + pattern.column[firing]) * frame().returns;
  }
  /// Returns the first firing whose first slot fulfils the predicate.
  template <typename Predicate>
  [[nodiscard]] std::uint32_t FindFiring(Predicate&& is_so) const {
    std::uint32_t firing = 0;
    while (!is_so(SlotOf(firing))) ++firing;
    return firing;
  }
  [[nodiscard]] std::string Of(std::uint32_t slot) { return trace_.Of(recorded_, slot); }
  [[nodiscard]] std::string Printed(std::uint32_t firing) const {
    return Generate("trace " + scenario_.string() + " --frame " + std::to_string(frame().index) +
                    " --firing " + std::to_string(firing))
        .said;
  }

 private:
  fs::path scenario_;
  std::unique_ptr<Simulator> simulator_;
  EffectTrace trace_;
  RecordedFrame recorded_;
};

/// Writes a scenario based on one of the project's into a folder.
fs::path Vary(const TemporaryDirectory& folder, const std::string& base, const std::string& more) {
  fs::path file = folder.path() / "scenario.json";
  WriteFileWhole(file,
                 R"({"version": 1, "file": ")" + kScenariosFolder + base + R"(", )" + more + "}");
  return file;
}

// Returns the number at the end of the last step's line.
float LastRange_m(const std::string& story) {
  std::istringstream lines(story);
  std::string line;
  std::string last;
  while (std::getline(lines, line) && line.substr(0, 5) != "echo ") last = line;
  return std::stof(last.substr(last.find_last_of(' ') + 1));
}

TEST(EffectTrace, SaysWhatTheProgramPrints) {
  for (const char* name : {"minimal.json", "st_gallen_approach.json"}) {
    Traced traced(kScenariosFolder + name);
    const std::uint32_t missed =
        traced.FindFiring([&](std::uint32_t slot) { return std::isnan(traced.frame().x[slot]); });
    for (const std::uint32_t firing : {0U, 1000U, 28799U, missed}) {
      const std::string story = traced.Of(traced.SlotOf(firing));
      EXPECT_EQ(story, traced.Printed(firing)) << name;
      EXPECT_THAT(story, HasSubstr(" firing " + std::to_string(firing) + " at "));
    }
  }
}

TEST(EffectTrace, IsTheSameForAllReturnsOfAFiring) {
  const TemporaryDirectory folder;
  Traced traced(Vary(folder, "st_gallen_approach.json", R"("fidelity": "footprint",
      "lidar": {"file": ")" + kScenariosFolder + R"(sensors/vir2rail.json",
                "mount": {"position_m": [2.2, 0, 2.5]},
                "receiver": {"range_at_10_percent_m": 200, "return_mode": "dual"}})"));
  const Frame& frame = traced.frame();
  ASSERT_EQ(frame.returns, 2U);
  const std::uint32_t firing =
      traced.FindFiring([&](std::uint32_t slot) { return frame.return_count[slot] == 2; });
  const std::uint32_t slot = traced.SlotOf(firing);
  const std::string story = traced.Of(slot);
  EXPECT_EQ(story, traced.Printed(firing));
  EXPECT_EQ(traced.Of(slot + 1), story);
  EXPECT_THAT(story, HasSubstr("  " + std::to_string(slot) + "\n"));
  EXPECT_THAT(story, HasSubstr("  " + std::to_string(slot + 1) + "\n"));
}

TEST(EffectTrace, FindsTheFiringInARecordingWithoutItsSecondReturns) {
  const TemporaryDirectory folder;
  Traced traced(Vary(folder, "minimal.json", R"("fidelity": "footprint",
      "lidar": {"file": ")" + kScenariosFolder + R"(sensors/vir2rail.json",
                "mount": {"position_m": [2.2, 0, 2.5]},
                "receiver": {"range_at_10_percent_m": 200, "return_mode": "dual"}})"));
  RecordedFrame single = Grid(traced.frame());
  single.frame.Resize(traced.frame().rows, traced.frame().columns, 1);
  EffectTrace trace(InfoOf(folder.path() / "scenario.json"));
  EXPECT_EQ(trace.Of(single, traced.SlotOf(1000) / 2), traced.Printed(1000));
}

TEST(EffectTrace, ChoosesEffectsAsTheProgramDoesWhereFidelityIsAuto) {
  const TemporaryDirectory folder;
  const fs::path scenario = Vary(folder, "minimal.json", R"("fidelity": "auto",
      "lidar": {"range_max_m": 120, "beam": {"divergence_mrad": [3.0, 1.5]}, "scan": {
          "rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 30,
          "vertical_fov_deg": 20, "angular_resolution_deg": 1}}})");
  Traced traced(scenario);
  EXPECT_EQ(traced.Of(traced.SlotOf(100)), traced.Printed(100));
}

/// Traces of a generated sequence.
class TracedSequence : public testing::Test {
 protected:
  /// Makes a sequence of frames 0 and 1.
  [[nodiscard]] std::unique_ptr<Recording> Make(const std::string& scenario) const {
    const std::string out = (folder_.path() / "out").string();
    const Ended run = Generate("sequence " + scenario + " --frames 2 --out " + out);
    EXPECT_EQ(run.status, 0) << run.said;
    return OpenRecording(out);
  }
  [[nodiscard]] fs::path Out() const { return folder_.path() / "out"; }
  [[nodiscard]] fs::path Folder() const { return folder_.path(); }

 private:
  TemporaryDirectory folder_;
};

TEST_F(TracedSequence, MeasuresWhatTheStorySays) {
  const auto recording = Make(kScenariosFolder + "st_gallen_approach.json");
  (void)recording->Next();
  const RecordedFrame recorded = (*recording->Next())();
  const Frame& frame = recorded.frame;
  EffectTrace trace(recording->info());
  int num_points = 0;
  for (std::uint32_t slot = 0; slot < frame.num_slots(); slot += 997) {
    if (std::isnan(frame.range_m[slot])) continue;
    ++num_points;
    const std::string story = trace.Of(recorded, slot);
    EXPECT_EQ(story.substr(0, 15), "frame 1 firing ");
    EXPECT_THAT(story, HasSubstr(" ns, slot " + std::to_string(slot) + "\n"));
    // Six digits are printed, so half of the last is at most 5e-6 of the number.
    EXPECT_NEAR(LastRange_m(story), frame.range_m[slot], 5e-6F * frame.range_m[slot]);
  }
  EXPECT_GT(num_points, 10);
}

TEST_F(TracedSequence, IsRefusedIfCommandsChangedIt) {
  const std::string scenario = MakeProject(Folder() / "project").string();
  const fs::path log = Folder() / "log.jsonl";
  WriteFileWhole(log, CommandLogText({IdentityOf(ReadScenario(scenario)).scenario_hash,
                                      {{100'000'000, RemoveObject{"rock"}}}}));
  const auto recording = Make(scenario + " --commands " + log.string());
  const RecordedFrame recorded = (*recording->Next())();
  EXPECT_EQ(EffectTrace(recording->info()).Of(recorded, 0),
            "error: " + Out().string() +
                "/commands.jsonl: changed the run, so the scenario alone cannot repeat it");
}

TEST_F(TracedSequence, NamesAFileThatIsGone) {
  const auto recording = Make(MakeProject(Folder() / "project").string());
  const RecordedFrame recorded = (*recording->Next())();
  const std::string rock = recording->info().scenario->world.objects.at(0).file.value();
  EXPECT_TRUE(rock.starts_with(Out().string() + "/inputs/")) << rock;
  fs::remove(rock);
  EffectTrace trace(recording->info());
  EXPECT_THAT(trace.Of(recorded, 0), testing::StartsWith("error: "));
  EXPECT_THAT(trace.Of(recorded, 0), HasSubstr(rock));
}

TEST(EffectTrace, SaysWhatIsMissing) {
  RecordingInfo bare;
  bare.source = "cloud.pcd";
  RecordedFrame recorded = RecordedCloud("cloud.pcd", {{1, 0, 0}});
  EXPECT_EQ(EffectTrace(bare).Of(recorded, 0),
            "error: cloud.pcd: has no scenario to trace points with");
  EffectTrace trace(InfoOf(kScenariosFolder + "minimal.json"));
  EXPECT_EQ(trace.Of(recorded, 0),
            "error: cloud.pcd: is no grid of firings, so the firing of a point is not known "
            "(a stream needs the fields ring and column)");
  recorded.is_grid = true;
  EXPECT_EQ(trace.Of(recorded, 0),
            "error: cloud.pcd: must have the firings of its scenario, 120 x 240 (got 1 x 1)");
}

/// Waits for the answer.
std::string Await(EffectTrace& trace) {
  while (true) {
    if (auto answer = trace.Take()) return *answer;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(EffectTrace, AnswersTheLastOfSeveralQuestions) {
  const Traced traced(kScenariosFolder + "minimal.json");
  const auto recorded = std::make_shared<const RecordedFrame>(Grid(traced.frame()));
  EffectTrace trace(InfoOf(kScenariosFolder + "minimal.json"));
  EXPECT_EQ(trace.Take(), std::nullopt) << "nothing was asked";
  for (const std::uint32_t firing : {5U, 6U, 7U}) trace.Ask(recorded, traced.SlotOf(firing));
  EXPECT_THAT(Await(trace), HasSubstr(" firing 7 at "));
  EXPECT_EQ(trace.Take(), std::nullopt) << "answered once";
  trace.Ask(recorded, traced.SlotOf(8));
  EXPECT_THAT(Await(trace), HasSubstr(" firing 8 at "));
}

TEST(EffectTrace, MayBeAskedBothWaysAtOnce) {
  Traced traced(kScenariosFolder + "minimal.json");
  const auto recorded = std::make_shared<const RecordedFrame>(Grid(traced.frame()));
  EffectTrace trace(InfoOf(kScenariosFolder + "minimal.json"));
  trace.Ask(recorded, traced.SlotOf(5));
  EXPECT_THAT(trace.Of(*recorded, traced.SlotOf(6)), HasSubstr(" firing 6 at "));
  EXPECT_THAT(Await(trace), HasSubstr(" firing 5 at "));
}

TEST(EffectTrace, MayEndBeforeItsAnswerIsThere) {
  const Traced traced(kScenariosFolder + "minimal.json");
  const auto recorded = std::make_shared<const RecordedFrame>(Grid(traced.frame()));
  RecordingInfo info = InfoOf(kScenariosFolder + "minimal.json");
  info.scenario->fidelity = Fidelity::kAuto;
  EffectTrace trace(info);
  trace.Ask(recorded, 0);
  trace.Ask(recorded, 1);
}

/// A recording without a scenario. Its answer is an error with the source's name, which comes at
/// once and tells the sources apart.
RecordingInfo Named(const std::string& name) {
  RecordingInfo info;
  info.source = name;
  return info;
}

std::string AnswerOf(Tracing& tracing) {
  for (;;) {
    if (auto answer = tracing.Take()) return *answer;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(Tracing, AnswersOfTheSourceThatWasAsked) {
  const auto recorded = std::make_shared<const RecordedFrame>(NumberedCloud(0));
  Tracing tracing(2);
  EXPECT_FALSE(tracing.Take());
  tracing.Ask(1, Named("b"), recorded, 0);
  EXPECT_EQ(AnswerOf(tracing), "error: b: has no scenario to trace points with");
  EXPECT_FALSE(tracing.Take()) << "once";
  tracing.Ask(0, Named("a"), recorded, 0);
  EXPECT_EQ(AnswerOf(tracing), "error: a: has no scenario to trace points with");
}

TEST(Tracing, ForgetsWhatIsOfNoInterestAnyMore) {
  const auto recorded = std::make_shared<const RecordedFrame>(NumberedCloud(0));
  Tracing tracing(2);
  tracing.Ask(0, Named("a"), recorded, 0);
  tracing.Forget();
  tracing.Ask(1, Named("b"), recorded, 0);
  EXPECT_EQ(AnswerOf(tracing), "error: b: has no scenario to trace points with");
  EXPECT_FALSE(tracing.Take());
}

}  // namespace
}  // namespace railcast
