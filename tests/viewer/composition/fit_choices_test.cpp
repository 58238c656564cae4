#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"
#include "tests/viewer/composition/shared_clouds.h"
#include "viewer/composition/composer.h"

namespace railcast {
namespace {

TEST(FitChoices, FillsInTheFieldAndTheEndsOfItsScale) {
  Choices by_height;
  FitChoices(*SharedCloud({{1, 2, 3}, {1, 2, 5}}), by_height);
  EXPECT_EQ(by_height.color_by, "height");
  EXPECT_EQ(by_height.ends, (std::array{3.0, 5.0}));
  Choices by_label;
  FitChoices(*LabelledCloud(), by_label);
  EXPECT_EQ(by_label.color_by, "label");
  EXPECT_EQ(by_label.ends, std::nullopt);
}

TEST(FitChoices, KeepsWhatIsChosen) {
  Choices choices = By("range");
  choices.ends = {{2.0, 90.0}};
  FitChoices(*LabelledCloud(), choices);
  EXPECT_EQ(choices.color_by, "range");
  EXPECT_EQ(choices.ends, (std::array{2.0, 90.0}));
}

TEST(FitChoices, RefusesWhatCannotBeDone) {
  const auto fault = [](const ShownFrame& shown, Choices choices) {
    return MessageOf([&] { FitChoices(shown, choices); });
  };
  const auto bare = SharedCloud({{1, 2, 3}});
  EXPECT_EQ(fault(*bare, By("power")),
            "a.pcd: has no field power to color by (has: range, height, x, y)");
  EXPECT_EQ(fault(*bare, {.color_by = "height", .labels = {12}}),
            "a.pcd: has no field label to select by");
  EXPECT_EQ(fault(*LabelledCloud(), {.color_by = "label", .ends = {{0.0, 1.0}}}),
            "a.pcd: field label has no scale with a range");
}

}  // namespace
}  // namespace railcast
