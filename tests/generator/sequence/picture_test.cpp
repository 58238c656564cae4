#include <gtest/gtest.h>

#include <algorithm>

#include "core/io/image/png.h"
#include "generator/run/frame_maker.h"
#include "generator/sequence/summary.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

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
