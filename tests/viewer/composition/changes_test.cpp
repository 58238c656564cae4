#include "viewer/composition/composer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/core/io/message_of.h"
#include "tests/viewer/composition/shared_clouds.h"
#include "viewer/color/palette.h"
#include "viewer/composition/composer.h"

namespace railcast {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// A cloud of points with intensities.
std::shared_ptr<const ShownFrame> Lit(const std::vector<Vector3>& points_m,
                                      const std::vector<float>& intensities) {
  RecordedFrame recorded = RecordedCloud("lit.pcd", points_m);
  recorded.fields.emplace("intensity");
  recorded.frame.intensity = intensities;
  return Shared(std::move(recorded));
}

std::vector<std::string> CountsIn(const Composition& composition) {
  std::vector<std::string> counts;
  for (const Category& category : composition.coloring.categories) {
    counts.push_back(category.name + " " + std::to_string(category.num_points));
  }
  return counts;
}

TEST(CompareFrames, TellsWhatWasAddedRemovedAndMadeWeaker) {
  const auto before = Lit({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {0.5F, 0.5F, 0.5F, 0.5F});
  const auto after = Lit({{1, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}}, {0.5F, 0.4F, 0.6F, 0.5F});
  const ChangedPoints changed = CompareFrames(*before, *after);
  EXPECT_THAT(changed.of_second,
              ElementsAre(Change::kSame, Change::kWeaker, Change::kStronger, Change::kAdded));
  EXPECT_THAT(changed.removed, ElementsAre(1));
}

TEST(CompareFrames, FindsPointsInAnyOrderAndInAnySlots) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const auto before = SharedCloud({{none, none, none}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  const auto after = SharedCloud({{7, 8, 9}, {4, 5, 6}, {1, 2, 3.5}, {none, none, none}});
  const ChangedPoints changed = CompareFrames(*before, *after);
  EXPECT_THAT(changed.of_second, ElementsAre(Change::kSame, Change::kSame, Change::kAdded));
  EXPECT_THAT(changed.removed, ElementsAre(0)) << "of the points; the slot without one has none";
}

TEST(CompareFrames, TellsPositionsApartThatDifferInTheirLastBit) {
  const double next_m = std::nextafter(50.0F, 51.0F);
  const ChangedPoints changed =
      CompareFrames(*SharedCloud({{50, 0, 0}}), *SharedCloud({{next_m, 0, 0}}));
  EXPECT_THAT(changed.of_second, ElementsAre(Change::kAdded));
  EXPECT_THAT(changed.removed, SizeIs(1));
}

TEST(CompareFrames, GivesEachOfSeveralPointsAtOnePlaceOneCounterpart) {
  const auto one = SharedCloud({{1, 0, 0}});
  const auto three = SharedCloud({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}});
  EXPECT_THAT(CompareFrames(*one, *three).of_second,
              ElementsAre(Change::kSame, Change::kAdded, Change::kAdded));
  EXPECT_THAT(CompareFrames(*three, *one).removed, ElementsAre(1, 2));
}

TEST(CompareFrames, ComparesNoIntensitiesThatOneDoesNotHave) {
  const ChangedPoints changed = CompareFrames(*Lit({{1, 0, 0}}, {0.5F}), *SharedCloud({{1, 0, 0}}));
  EXPECT_THAT(changed.of_second, ElementsAre(Change::kSame));
}

TEST(CompareFrames, KnowsWhatWasSubtractedFromFarPositions) {
  RecordedFrame low = RecordedCloud("a.pcd", {{499, 0, 0}});
  low.origin_m = {691000, 0, 0};
  RecordedFrame high = RecordedCloud("b.pcd", {{-501, 0, 0}});
  high.origin_m = {692000, 0, 0};
  EXPECT_THAT(CompareFrames(*Shared(low), *Shared(high)).of_second, ElementsAre(Change::kSame));
  EXPECT_THAT(CompareFrames(*SharedCloud({{499, 0, 0}}), *Shared(low)).removed, SizeIs(1));
}

TEST(CompareFrames, TakesAnEmptyFrame) {
  const auto none = SharedCloud({});
  const auto some = SharedCloud({{1, 0, 0}, {2, 0, 0}});
  EXPECT_THAT(CompareFrames(*none, *some).of_second, Each(Change::kAdded));
  EXPECT_THAT(CompareFrames(*some, *none).removed, ElementsAre(0, 1));
  EXPECT_THAT(CompareFrames(*none, *none).of_second, IsEmpty());
}

TEST(ComposeChanges, ShowsTheSecondFrameAndWhatOnlyTheFirstHas) {
  const auto before = Lit({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {0.5F, 0.5F, 0.5F});
  const auto after = Lit({{1, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {0.5F, 0.4F, 0.5F});
  const Composition composition = ComposeChanges(before, after, {});
  ASSERT_THAT(composition.clouds, SizeIs(2));
  EXPECT_EQ(composition.clouds[0].shown, after);
  EXPECT_EQ(composition.clouds[0].source, 1U);
  EXPECT_THAT(composition.clouds[0].colors, ElementsAre(kNoValueColor, kYellow, kVermillion));
  EXPECT_EQ(composition.clouds[1].source, 0U);
  EXPECT_THAT(composition.clouds[1].shown->positions_m, ElementsAre(2.0F, 0.0F, 0.0F));
  EXPECT_THAT(composition.clouds[1].shown->slots, ElementsAre(1));
  EXPECT_EQ(composition.clouds[1].shown->recorded, before->recorded);
  EXPECT_THAT(composition.clouds[1].colors, ElementsAre(kSkyBlue));
  EXPECT_THAT(CountsIn(composition), ElementsAre("in both 1", "weaker 1", "added 1", "removed 1"));
}

TEST(ComposeChanges, LaysTheFirstWhereItWasInTheSecondsAxes) {
  const Transform first = MakeTransform(RotationFromYawPitchRoll(0.3, 0.0, 0.0), {60, 0, 0});
  const Transform second = MakeTransform(RotationFromYawPitchRoll(-1.2, 0.1, 0.0), {90, 5, 1});
  const auto a = Posed({{100, 0, 0}}, first);
  const auto b = Posed({{100, 0, 0}}, second);
  const Composition composition = ComposeChanges(a, b, {});
  EXPECT_TRUE(composition.clouds[0].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  // Rounding of products of doubles of some 100 m.
  EXPECT_TRUE(composition.clouds[1].view_from_sensor.isApprox(second.inverse() * first, 1e-13));
}

TEST(ComposeChanges, MakesLabelsFaintThatAreNotSelectedInBoth) {
  RecordedFrame before = RecordedCloud("a.pcd", {{1, 2, 3}, {4, 5, 6}});
  before.fields.emplace("label");
  before.frame.label = {1, 12};
  RecordedFrame after = RecordedCloud("b.pcd", {{7, 8, 9}});
  after.fields.emplace("label");
  after.frame.label = {12};
  Choices choices{.labels = {1}};
  const Composition composition =
      ComposeChanges(Shared(std::move(before)), Shared(std::move(after)), choices);
  EXPECT_THAT(composition.clouds[0].is_faint, ElementsAre(true));
  EXPECT_THAT(composition.clouds[1].is_faint, ElementsAre(false, true));
}

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
