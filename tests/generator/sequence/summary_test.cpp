#include "generator/sequence/summary.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/io/image/png.h"
#include "generator/run/frame_maker.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

SequenceResult ExampleResult() {
  SequenceResult result;
  result.num_done = 6;
  result.is_complete = true;
  result.elapsed_s = 0.5;
  result.counts.points = 400;
  result.counts.points_per_label = {{"ballast", 100}, {"rail", 300}};
  result.counts.outcomes[0] = 400;
  result.counts.outcomes[4] = 100;
  return result;
}

TEST(Summary, TellsRateLabelsOutcomesAndPlace) {
  EXPECT_EQ(Summary(ExampleRun("/data/run"), ExampleResult()),
            "made 6 frames in 0.5 s (12.0 frames/s)\n"
            "points by label (400)\n"
            "  rail                     300   75.0 %\n"
            "  ballast                  100   25.0 %\n"
            "firings by outcome (500)\n"
            "  returned                 400   80.0 %\n"
            "  rain_absorbed            100   20.0 %\n"
            "6 of 6 frames in /data/run\n");
}

TEST(Summary, TellsWhatWasThereBefore) {
  SequenceResult result = ExampleResult();
  result.num_resumed = 5;
  EXPECT_EQ(Summary(ExampleRun("/data/run"), result).substr(0, 64),
            "made 1 frame in 0.5 s (2.0 frames/s); 5 were already there\npoint");
  result.was_complete = true;
  EXPECT_EQ(Summary(ExampleRun("/data/run"), result).substr(0, 31),
            "already complete: nothing to do");
}

TEST(SummaryJson, IsOneLineOfTheSameNumbers) {
  SequenceResult result = ExampleResult();
  result.num_resumed = 5;
  const SequenceSpec spec = ExampleRun("/data/run");
  const std::string text = SummaryJson({{"front", spec, result}});
  EXPECT_EQ(text,
            R"({"command":"sequence","sensors":[{"name":"front","directory":"/data/run",)"
            R"("frames":6,"frames_done":6,"frames_made":1,"is_complete":true,"elapsed_s":0.5,)"
            R"("points":400,"outcomes":{"returned":400,"rain_absorbed":100},)"
            R"("points_per_label":{"ballast":100,"rail":300}}]})"
            "\n");
}

TEST(ProgressLine, EstimatesWhatIsLeftFromTheFramesMadeNow) {
  EXPECT_EQ(SequenceProgressText(0, 50, 0, 0.0), "frame 0 of 50");
  EXPECT_EQ(SequenceProgressText(12, 50, 2, 5.0), "frame 12 of 50, 2.0 frames/s, 0:19 left");
  EXPECT_EQ(SequenceProgressText(1, 500, 0, 1.0), "frame 1 of 500, 1.0 frames/s, 8:19 left");
}

TEST(PictureOfFrame, ShowsPointsInTheColoursOfWhatTheCameraSeesThere) {
  ScenarioSpec scenario = ReadScenario(ScenariosDir() / "minimal.json");
  scenario.camera = {.width_px = 320, .height_px = 180, .horizontal_fov_deg = 40.0};
  RunChoices choices;
  choices.directory = "out";
  const RunPlan plan = PlanRun(scenario, choices, "minimal.json");
  constexpr std::uint32_t kFrame = 3;
  FrameMaker maker(plan.sensors.front().scenario, 0);
  MadeFrame made;
  maker.Begin(0, kFrame)(made);
  const auto picture = DecodePngRgb(PictureOfFrame(plan, kFrame, 0));
  ASSERT_EQ(picture.values.size(), made.image.rgb.size());
  std::size_t num_drawn = 0;
  std::size_t num_alike = 0;
  for (std::size_t i = 0; i < made.image.num_pixels(); ++i) {
    const auto first = picture.values.begin() + static_cast<std::ptrdiff_t>(3 * i);
    if (std::equal(first, first + 3, made.image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i))) {
      continue;
    }
    ++num_drawn;
    const auto is_its = [&](const Label& label) {
      return std::equal(first, first + 3, label.rgb.begin());
    };
    EXPECT_TRUE(std::ranges::any_of(maker.labels().labels(), is_its)) << i;
    const Label* const seen = maker.labels().Find(made.image.label[i]);
    num_alike += seen != nullptr && is_its(*seen) ? 1 : 0;
  }
  EXPECT_GT(num_drawn, made.image.num_pixels() / 20);
  // The others are at the edges of things: a point covers nine pixels.
  EXPECT_GT(num_alike, num_drawn * 8 / 10);
}

}  // namespace
}  // namespace railcast
