#include "analysis/frontier/kept_frontier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "analysis/frontier/measure.h"
#include "core/base/error.h"
#include "core/io/write_file.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

TEST(KeptFrontier, GivesBackWhatItKeptBitByBit) {
  const TemporaryDirectory directory;
  const Frame frame = ExampleFrame(3);
  const std::vector<float> steps_m = {0.25F, std::nanf(""), 1.0F / 3.0F};
  const std::vector<RowTimes> times = {{{1.0 / 3.0, 2.0}, {1.0}}, {{}, {}}};
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
  EXPECT_EQ(kept_times.at(1).times_ms, times[1].times_ms);
  kept.Remove();
  EXPECT_FALSE(exists(directory.path() / "kept"));
}

TEST(KeptFrontier, RefusesWhatAnotherRunHasLeftAndMakesAnewWhatIsDamaged) {
  const TemporaryDirectory directory;
  const auto folder = directory.path() / "kept";
  const auto make = [] { return ExampleFrame(3); };
  static_cast<void>(KeptFrontier(folder, "a run").FrameOf(3, make));
  EXPECT_EQ(MessageOf([&] { KeptFrontier(folder, "another run"); }),
            folder.string() + ": must be what the same command has left; remove it to begin anew");
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
  const std::string times = ReadFileWhole(kept_folder / "times_0");
  const auto ignore = [](const std::string&, double) {};
  const auto resumed = measure(plan, kept, ignore);
  EXPECT_EQ(ReadFileWhole(kept_folder / "times_0"), times) << "timed again";
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

}  // namespace
}  // namespace railcast
