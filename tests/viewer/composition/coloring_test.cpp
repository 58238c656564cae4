#include "viewer/composition/coloring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/viewer/pick/shown_cloud.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = FieldValues::Kind;
using Ends = std::array<double, 2>;

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

FieldValues Amounts(std::vector<double> values) {
  return {.kind = Kind::kAmount, .title = "range [m]", .values = std::move(values)};
}

FieldValues Differences(std::vector<double> values) {
  return {.kind = Kind::kDifference, .title = "noise [mm]", .values = std::move(values)};
}

FieldValues Kinds(std::vector<double> values) {
  return {.kind = Kind::kCategory, .title = "kind", .values = std::move(values)};
}

std::vector<double> ZeroTo(int last) {
  std::vector<double> values;
  // The values are out of order on purpose.
  for (int i = 0; i <= last; ++i) values.push_back((i * 37) % (last + 1));
  return values;
}

Coloring ColorKinds(std::vector<double> values, const std::string& name) {
  RecordingInfo info;
  info.labels = ExampleLabels();
  info.materials = {"none", "ballast", ""};
  RecordedFrame recorded;
  recorded.objects.resize(1);
  recorded.objects[0].name = "wagon_1";
  recorded.objects[0].instance = 3;
  return ColorByCategory(Kinds(std::move(values)), name, info, recorded);
}

std::vector<std::string> NamesOf(const Coloring& coloring) {
  std::vector<std::string> names;
  for (const Category& category : coloring.categories) names.push_back(category.name);
  return names;
}

TEST(FitScale, GoesFromThe1stToThe99thPercentile) {
  EXPECT_EQ(FitScale(Amounts(ZeroTo(100))), (Ends{1.0, 99.0}));
  EXPECT_EQ(FitScale(Amounts(ZeroTo(1000))), (Ends{10.0, 990.0}));
}

TEST(FitScale, TakesAllOfLessThanAHundred) {
  EXPECT_EQ(FitScale(Amounts({4.0, -2.0, 3.0})), (Ends{-2.0, 4.0}));
}

TEST(FitScale, ShowsAMarkThatFewPointsBear) {
  std::vector<double> marks(1000, 0.0);
  marks[500] = 1.0;
  EXPECT_EQ(FitScale(Amounts(marks)), (Ends{0.0, 1.0}));
}

TEST(FitScale, PassesOverWhatIsNoNumber) {
  EXPECT_EQ(FitScale(Amounts({kNoValue, 4.0, kInfinity, -2.0, -kInfinity})), (Ends{-2.0, 4.0}));
}

TEST(FitScale, GoesAsFarToEitherSideOfDifferences) {
  EXPECT_EQ(FitScale(Differences({-3.0, 1.0, 2.0})), (Ends{-3.0, 3.0}));
  EXPECT_EQ(FitScale(Differences({5.0, 8.0})), (Ends{-8.0, 8.0}));
}

TEST(FitScale, GoesAroundEqualValues) {
  EXPECT_EQ(FitScale(Amounts({7.0, 7.0, 7.0})), (Ends{6.5, 7.5}));
  EXPECT_EQ(FitScale(Differences({0.0, 0.0})), (Ends{-0.5, 0.5}));
}

TEST(FitScale, NeverHasEqualEndsHoweverGreatTheValues) {
  // Drivers mark missing values with the greatest float.
  for (const double value : {1e20, -1e20, static_cast<double>(std::numeric_limits<float>::max())}) {
    const FieldValues field = Amounts({value, value});
    const Ends ends = FitScale(field);
    EXPECT_LT(ends[0], ends[1]) << value;
    EXPECT_THAT(ColorByScale(field, ColorMap::kViridis, ends).colors,
                testing::Each(testing::Ne(kNoValueColor)));
  }
}

TEST(FitScale, HasEndsWithoutValues) {
  for (const std::vector<double>& none : {std::vector<double>{}, std::vector{kNoValue, kNoValue}}) {
    EXPECT_EQ(FitScale(Amounts(none)), (Ends{0.0, 1.0}));
    EXPECT_EQ(FitScale(Differences(none)), (Ends{-1.0, 1.0}));
  }
}

TEST(ColorByScale, HasTheMapsEndsAtTheScalesEndsAndBeyond) {
  for (const ColorMap map : {ColorMap::kViridis, ColorMap::kCoolwarm}) {
    const Rgb lowest = MapColor(map, 0.0);
    const Rgb highest = MapColor(map, 1.0);
    const Coloring coloring =
        ColorByScale(Amounts({10.0, 9.9, -kInfinity, 30.0, 31.0, kInfinity}), map, {10.0, 30.0});
    EXPECT_THAT(coloring.colors, ElementsAre(lowest, lowest, lowest, highest, highest, highest));
    EXPECT_EQ(coloring.title, "range [m]");
    EXPECT_EQ(coloring.ends, (Ends{10.0, 30.0}));
    EXPECT_EQ(coloring.map, map);
    EXPECT_THAT(coloring.categories, IsEmpty());
  }
}

TEST(ColorByScale, GoesInAStraightLineBetween) {
  std::vector<double> values;
  for (int i = 0; i <= 100; ++i) values.push_back(10.0 + 0.2 * i);
  const Coloring coloring = ColorByScale(Amounts(values), ColorMap::kMagma, {10.0, 30.0});
  ASSERT_EQ(coloring.colors.size(), values.size());
  for (int i = 0; i <= 100; ++i) {
    const Rgb exact = MapColor(ColorMap::kMagma, i / 100.0);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      // With 1024 steps, half a step is 0.0005 of the scale: 0.2 of 255 where the map is steepest.
      EXPECT_NEAR(coloring.colors[static_cast<std::size_t>(i)][channel], exact[channel], 1.0) << i;
    }
  }
}

TEST(ColorByScale, GreysPointsWithoutAValue) {
  const Coloring coloring =
      ColorByScale(Amounts({0.0, kNoValue, 1.0}), ColorMap::kViridis, {0.0, 1.0});
  EXPECT_THAT(coloring.colors, ElementsAre(MapColor(ColorMap::kViridis, 0.0), kNoValueColor,
                                           MapColor(ColorMap::kViridis, 1.0)));
}

TEST(ColorByCategory, NamesAndColoursTheLabelsThatOccur) {
  const Coloring coloring = ColorKinds({12, 1, 12, 90, 12}, "label");
  EXPECT_THAT(NamesOf(coloring), ElementsAre("rail", "wagon", "label 90"));
  ASSERT_EQ(coloring.categories.size(), 3U);
  EXPECT_EQ(coloring.categories[0].num_points, 1U);
  EXPECT_EQ(coloring.categories[1].num_points, 3U);
  EXPECT_EQ(coloring.categories[2].num_points, 1U);
  EXPECT_EQ(coloring.categories[1].value, 12.0);
  const Rgb rail = {230, 159, 0};
  const Rgb wagon = {213, 94, 0};
  EXPECT_THAT(coloring.colors, ElementsAre(wagon, rail, wagon, coloring.categories[2].rgb, wagon));
  EXPECT_EQ(coloring.title, "kind");
  EXPECT_EQ(coloring.ends, std::nullopt);
}

TEST(ColorByCategory, NamesOutcomesAndColoursThemAsBeams) {
  const Coloring coloring = ColorKinds({5, 0, 77}, "outcome");
  EXPECT_THAT(NamesOf(coloring), ElementsAre("returned", "clutter", "outcome 77"));
  EXPECT_EQ(coloring.colors[0], OutcomeRgb(Outcome::kClutter));
  EXPECT_EQ(coloring.colors[1], OutcomeRgb(Outcome::kReturned));
}

TEST(ColorByCategory, NamesMaterialsWhereTheirNamesAreKnown) {
  EXPECT_THAT(NamesOf(ColorKinds({3, 2, 1, 0}, "material")),
              ElementsAre("none", "ballast", "material 2", "material 3"));
}

TEST(ColorByCategory, NamesInstancesByTheirObjects) {
  const Coloring coloring = ColorKinds({0, 3, 4}, "instance");
  EXPECT_THAT(NamesOf(coloring), ElementsAre("no object", "wagon_1", "instance 4"));
  EXPECT_NE(coloring.colors[1], coloring.colors[2]);
  EXPECT_NE(coloring.colors[0], coloring.colors[1]);
}

TEST(ColorByCategory, NamesAnyOtherKindByItsNumber) {
  EXPECT_THAT(NamesOf(ColorKinds({2, 0, 2}, "return")), ElementsAre("0", "2"));
}

TEST(ColorByCategory, RefusesWhatIsNoWholeNumber) {
  const auto fault = [](double value) {
    return MessageOf([value] { (void)ColorKinds({7, value}, "label"); });
  };
  EXPECT_EQ(fault(1.5), "field label must hold whole numbers (got 1.5)");
  EXPECT_EQ(fault(-1.0), "field label must hold whole numbers (got -1)");
  EXPECT_EQ(fault(4294967296.0), "field label must hold whole numbers (got 4294967296)");
  EXPECT_EQ(fault(kNoValue), "field label must hold whole numbers (got nan)");
  EXPECT_EQ(fault(4294967295.0), "no error");
}

}  // namespace
}  // namespace railcast
