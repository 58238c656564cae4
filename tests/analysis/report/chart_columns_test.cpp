#include "analysis/report/chart_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/report/made_report.h"

namespace railcast {
namespace {

using testing::ElementsAre;

Table Bins() {
  return {"t",
          "",
          "",
          {{"range_m", "", "m"}, {"share", "", ""}},
          {{Span{0, 10}, Estimate{0.5, 0.4, 0.6, 20}},
           {Span{10, 20}, NotEnough(3)},
           {Span{20, 30}, Estimate{0.7, 0.6, 0.8, 20}},
           {Span{50, 60}, 0.9}}};
}

Table Objects() {
  return {"t",
          "",
          "",
          {{"name", "", ""}, {"range_m", "", "m"}, {"points", "", ""}},
          {{std::string("b"), 1.0, std::uint64_t{5}},
           {std::string("a"), 2.0, std::uint64_t{6}},
           {std::string("b"), 3.0, std::uint64_t{7}},
           {std::string("b"), 4.0, kNoFigure},
           {std::string("c"), 5.0, kNoFigure}}};
}

std::vector<double> PlacesOf(const ChartSeries& series) {
  std::vector<double> places;
  for (const ChartPoint& point : series.points) places.push_back(point.x);
  return places;
}

TEST(SeriesOf, PutsBinsAtTheirMiddlesWithTheirIntervals) {
  const ChartSeries series = SeriesOf(Bins(), {"range_m", "share"}, "title");
  EXPECT_EQ(series.title, "title");
  EXPECT_EQ(series.points[0].x, 5.0);
  EXPECT_EQ(series.points[0].y, 0.5);
  EXPECT_EQ(series.points[0].low, 0.4);
  EXPECT_EQ(series.points[0].high, 0.6);
}

TEST(SeriesOf, LeavesAGapWhereABinOrItsFigureIsMissing) {
  const ChartSeries series = SeriesOf(Bins(), {"range_m", "share"}, "");
  ASSERT_EQ(series.points.size(), 5U);
  EXPECT_TRUE(std::isnan(series.points[1].y));  // Too few samples.
  EXPECT_EQ(series.points[2].y, 0.7);
  EXPECT_TRUE(std::isnan(series.points[3].y));  // The missing bin from 30 to 50.
  EXPECT_EQ(series.points[3].x, 40.0);
  EXPECT_EQ(series.points[4].y, 0.9);
}

TEST(SeriesOf, GoesOnBetweenMeasuredPlaces) {
  EXPECT_THAT(PlacesOf(SeriesOf(Objects(), {"range_m", "points"}, "")), ElementsAre(1, 2, 3));
}

TEST(SeriesOf, NumbersNamesAndLabelsPoints) {
  const ChartSeries series = SeriesOf(Objects(), {"name", "range_m", "points"}, "");
  EXPECT_THAT(PlacesOf(series), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(series.points[1].label, "6");
  EXPECT_THAT(TextsOf(Objects(), "name"), ElementsAre("b", "a", "b", "b", "c"));
}

TEST(SeriesByName, MakesOneForEachNameThatHasAFigure) {
  const auto all = SeriesByName(Objects(), {"range_m", "points", "", "name"});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].title, "b");
  EXPECT_THAT(PlacesOf(all[0]), ElementsAre(1, 3));
  EXPECT_EQ(all[1].title, "a");
}

TEST(SeriesOfDeathTest, RefusesAColumnThatIsNotThere) {
  EXPECT_DEATH(static_cast<void>(SeriesOf(Bins(), {"range_m", "shares"}, "")),
               "a chart names columns of its table");
}

TEST(SeriesByRow, AreLinesOverTheOtherColumnsOfTheFirstRows) {
  const Table table = {"t",
                       "",
                       "",
                       {{"name", "", ""}, {"near", "", ""}, {"far", "", ""}},
                       {{std::string("a"), std::uint64_t{5}, kNoFigure},
                        {std::string("b"), std::uint64_t{6}, 2.5},
                        {std::string("c"), std::uint64_t{7}, 3.5}}};
  const std::vector<ChartSeries> series = SeriesByRow(table, 2);
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[1].title, "b");
  EXPECT_THAT(PlacesOf(series[1]), ElementsAre(0.0, 1.0));
  EXPECT_EQ(series[1].points[0].y, 6.0);
  EXPECT_EQ(series[1].points[1].y, 2.5);
  EXPECT_TRUE(std::isnan(series[0].points[1].y));
}

}  // namespace
}  // namespace railcast
