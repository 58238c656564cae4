#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "analysis/report/chart_script.h"
#include "analysis/report/formats.h"
#include "core/io/write_file.h"
#include "tests/analysis/report/made_report.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using enum SeriesStyle;

std::vector<std::string> Labels(const AxisRange& range, bool is_log) {
  std::vector<std::string> labels;
  for (const AxisTick& tick : TicksIn(range, is_log, 6)) labels.push_back(tick.label);
  return labels;
}

// Draws one chart and returns its SVG.
std::string Drawn(Chart chart, const TemporaryFolder& folder) {
  chart.key = "chart";
  Report report;
  report.sections.push_back({"s", "S", {}, {std::move(chart)}, {}});
  const auto here = folder.Write("here", "").parent_path() / "charts";
  const auto svgs = DrawAll(report, here);
  EXPECT_THAT(ReadFileWhole(here / "chart.png"), StartsWith("\x89PNG\r\n"));
  EXPECT_EQ(ReadFileWhole(here / "chart.svg"), svgs.at("chart"));
  return svgs.at("chart");
}

std::ptrdiff_t CountOf(const std::string& text, const std::string& part) {
  std::ptrdiff_t num = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++num;
  return num;
}

TEST(AxisTicks, AreRoundNumbers) {
  EXPECT_THAT(Labels({0.0, 10.5}, false), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(Labels({-0.011, 0.012}, false),
              ElementsAre("−0.010", "−0.005", "0", "0.005", "0.010"));
  EXPECT_THAT(Labels({0.0, 12.7}, false), ElementsAre("0", "2.5", "5.0", "7.5", "10.0", "12.5"));
  EXPECT_THAT(Labels({0.0, 5200.0}, false),
              ElementsAre("0", "1,000", "2,000", "3,000", "4,000", "5,000"));
  EXPECT_THAT(Labels({0.0, 5.2e7}, false),
              ElementsAre("0", "10⁷", "2×10⁷", "3×10⁷", "4×10⁷", "5×10⁷"));
}

TEST(AxisTicks, OfLogarithmsAreDecadesOrTheirParts) {
  EXPECT_THAT(Labels({0.9, 60.0}, true), ElementsAre("1", "2", "5", "10", "20", "50"));
  EXPECT_THAT(Labels({1e-5, 1.0}, true),
              ElementsAre("10⁻⁵", "0.0001", "0.001", "0.01", "0.1", "1"));
}

TEST(AxisRange, BeginsAtZeroWhereValuesComeNear) {
  const Chart near = {"", "", "", {}, {}, {{"", kLine, {{0, 1}, {1, 10}}}}};
  EXPECT_EQ(RangeOfY(near)->low, 0.0);
  const Chart far = {"", "", "", {}, {}, {{"", kLine, {{0, 9}, {1, 10}}}}};
  EXPECT_GT(RangeOfY(far)->low, 8.0);
  const Chart bars = {"", "", "", {}, {}, {{"", kBars, {{0, 9}, {1, 10}}}}};
  EXPECT_EQ(RangeOfY(bars)->low, 0.0);
}

TEST(AxisRange, IsNotStretchedByOneHugeInterval) {
  const Chart chart = {"", "", "", {}, {}, {{"", kPoints, {{0, 1, -900, 900}, {1, 2, 1.9, 2.1}}}}};
  EXPECT_LT(RangeOfY(chart)->high, 5.0);
  EXPECT_GT(RangeOfY(chart)->low, -2.0);
}

TEST(AxisRange, IsNoneWithoutAPointThatHasAPlace) {
  EXPECT_FALSE(RangeOfY({"", "", "", {}, {}, {{"", kLine, {{0, kNoFigure}}}}}));
  EXPECT_FALSE(RangeOfY({"", "", "", {}, {"", "", true, {}}, {{"", kLine, {{1, 0}, {2, -1}}}}}));
  EXPECT_FALSE(RangeOfX({"", "", "", {}, {}, {}}));
}

TEST(DrawAll, DrawsOneElementForEveryPoint) {
  const TemporaryFolder folder;
  const std::string svg = Drawn(
      {"", "", "", {}, {}, {{"", kPoints, {{0, 1}, {1, 2}, {2, kNoFigure}, {3, 5}}}}}, folder);
  EXPECT_EQ(CountOf(svg, " color='#0072b2'"), 3);
}

TEST(DrawAll, SaysThatThereIsNotEnoughData) {
  const TemporaryFolder folder;
  for (const Chart& chart : MadeCharts()) {
    const bool is_empty = chart.key == "empty" || chart.key == "all_absent";
    EXPECT_EQ(Drawn(chart, folder).find("not enough data") != std::string::npos, is_empty)
        << chart.key;
  }
}

TEST(DrawAll, DrawsNothingThatIsNoNumber) {
  const TemporaryFolder folder;
  for (const Chart& chart : MadeCharts()) {
    EXPECT_THAT(Drawn(chart, folder), Not(HasSubstr("nan"))) << chart.key;
  }
}

TEST(DrawAll, SetsTextAsItIs) {
  const TemporaryFolder folder;
  Chart chart = {"",
                 "",
                 "",
                 {"a_1^2 & <b>", "m", false, {}},
                 {"it's `date` {/Symbol a}", "", false, {}},
                 {{"@macro $(x) \\n \"q\"", kLine, {{0, 1}, {1, 2}}}}};
  const std::string svg = Drawn(chart, folder);
  EXPECT_THAT(svg, HasSubstr("a_1^2 &amp; &lt;b> (m)"));
  EXPECT_THAT(svg, HasSubstr("it's `date` {/Symbol a}"));
  EXPECT_THAT(svg, HasSubstr("@macro $(x) \\n \"q\""));
}

TEST(DrawAll, PutsLongNamesInFull) {
  const TemporaryFolder folder;
  const std::string svg = Drawn(MadeCharts()[3], folder);
  EXPECT_THAT(svg, HasSubstr("<text>sensor_dropout</text>"));
  EXPECT_THAT(svg, HasSubstr("a name that is far longer"));
}

// A chart of lines with these titles.
Chart ChartOf(const std::vector<std::string>& titles) {
  Chart chart = {"", "", "", {}, {}, {}};
  for (const std::string& title : titles) chart.series.push_back({title, kLine, {{0, 1}, {1, 2}}});
  return chart;
}

TEST(PaintsOf, AreThoseOfTheTitlesInAllCharts) {
  const SeriesPaints paints = PaintsOf({ChartOf({"ground", "tree"}), ChartOf({"tree", "rail"})});
  EXPECT_EQ(paints.at("ground"), 0U);
  EXPECT_EQ(paints.at("tree"), 1U);
  // "rail" never meets "ground", but does meet "tree".
  EXPECT_EQ(paints.at("rail"), 0U);
}

TEST(PaintsOf, KeepTitlesApartThatMeetInALaterChart) {
  const SeriesPaints paints = PaintsOf({ChartOf({"a"}), ChartOf({"b"}), ChartOf({"b", "a"})});
  EXPECT_NE(paints.at("a"), paints.at("b"));
}

TEST(PaintsOf, GoOnBeyondTheColours) {
  const SeriesPaints paints = PaintsOf({ChartOf({"1", "2", "3", "4", "5", "6", "7", "8"})});
  EXPECT_EQ(paints.at("8"), 7U);
  EXPECT_STREQ(PaintColor(paints.at("8")), PaintColor(paints.at("1")));
}

TEST(DrawAll, KeepsTheColourOfASeriesThroughAReport) {
  const TemporaryFolder folder;
  Report report;
  report.sections.push_back({"s", "S", {}, {ChartOf({"a", "b"}), ChartOf({"b"})}, {}});
  report.sections[0].charts[0].key = "both";
  report.sections[0].charts[1].key = "one";
  const auto svgs = DrawAll(report, folder.Write("here", "").parent_path() / "charts");
  EXPECT_THAT(svgs.at("both"), HasSubstr(kSeriesColors[1]));
  EXPECT_THAT(svgs.at("one"), HasSubstr(kSeriesColors[1]));
  EXPECT_THAT(svgs.at("one"), Not(HasSubstr(kSeriesColors[0])));
}

TEST(DrawAll, MarksPlacesWithoutAFigure) {
  const TemporaryFolder folder;
  const ChartSeries whole = {"whole", kLinePoints, {{0, 1}, {1, 2}, {2, 3}}};
  const ChartSeries broken = {"broken", kLinePoints, {{0, 1}, {1, kNoFigure}, {2, 3}}};
  const ChartSeries limit = {"limit", kLine, {{0, 2}, {2, 2}}};
  EXPECT_THAT(Drawn({"", "", "", {}, {}, {broken, limit}}, folder), HasSubstr("no figure"));
  // Where another line goes on, the gap shows by itself.
  EXPECT_THAT(Drawn({"", "", "", {}, {}, {broken, whole}}, folder), Not(HasSubstr("no figure")));
}

TEST(DrawAll, TellsABarThatIsMissingFromOneOfZero) {
  const TemporaryFolder folder;
  const auto bars = [](double second) {
    return Chart{"", "", "", {"", "", false, {"a", "b"}}, {}, {{"", kBars, {{0, 1}, {1, second}}}}};
  };
  EXPECT_THAT(Drawn(bars(kNoFigure), folder), HasSubstr("no figure"));
  EXPECT_THAT(Drawn(bars(0.0), folder), Not(HasSubstr("no figure")));
}

// Two nearly coincident points, each with a label.
Chart LabelledChart() {
  Chart chart = {"", "", "", {"Time", "s"}, {"Error", "mm"}, {{"a", kLinePoints, {}}}};
  chart.series[0].points = {{1.0, 5.0}, {1.02, 5.1}, {9.0, 1.0}};
  chart.series[0].points[0].label = "it's first";
  chart.series[0].points[1].label = "second";
  return chart;
}

TEST(DrawAll, SetsLabelsBesideTheirPoints) {
  const TemporaryFolder folder;
  const std::string svg = Drawn(LabelledChart(), folder);
  EXPECT_EQ(CountOf(svg, "it's first"), 1);
  EXPECT_EQ(CountOf(svg, "second"), 1);
}

TEST(LabelsText, KeepsTheLabelsOfNeighboursApart) {
  const Chart chart = LabelledChart();
  const std::string text =
      LabelsText({chart, PaintsOf({chart}), *RangeOfX(chart), *RangeOfY(chart)});
  const std::string first = text.substr(0, text.find('\n'));
  const std::string second = text.substr(text.find('\n') + 1);
  EXPECT_THAT(first, StartsWith("set label 'it''s first' at 1,5 "));
  EXPECT_THAT(second, StartsWith("set label 'second' at 1.02,5.1 "));
  const auto side_of = [](const std::string& line) {
    return line.substr(line.find("offset"), line.find('\n') - line.find("offset"));
  };
  EXPECT_NE(side_of(first), side_of(second));
}

/// A label as gnuplot draws it, in letters of a drawing on a sheet of four: 78 letters wide and 18
/// lines high.
struct DrawnLabel {
  std::string text;
  double left{}, right{}, low{}, high{};
};

std::vector<DrawnLabel> DrawnLabels(const Drawing& drawing) {
  std::vector<DrawnLabel> labels;
  std::istringstream lines(LabelsText(drawing));
  for (std::string line; std::getline(lines, line);) {
    const std::regex form(
        "set label '([^']*)' at ([^,]*),([^ ]*) (left|right) offset ([^,]*),([^ ]*)");
    std::smatch parts;
    EXPECT_TRUE(std::regex_match(line, parts, form)) << line;
    const auto number = [&](std::size_t i) { return std::stod(parts[i]); };
    const double x =
        std::log(number(2) / drawing.x.low) / std::log(drawing.x.high / drawing.x.low) * 78.0;
    const double y = (number(3) - drawing.y.low) / (drawing.y.high - drawing.y.low) * 18.0;
    const double near = x + number(5);
    const double width = static_cast<double>(parts[1].length()) * (parts[4] == "left" ? 1.0 : -1.0);
    labels.push_back({parts[1], std::min(near, near + width), std::max(near, near + width),
                      y + number(6) - 0.5, y + number(6) + 0.5});
  }
  return labels;
}

// The rows of the open line, with their times and wires missed: four close together, and one whose
// name reaches to that of the next.
TEST(LabelsText, KeepsTheNamesOfAFrontiersRowsApart) {
  Chart chart = {"",
                 "",
                 "",
                 {"Time", "", true},
                 {"Wires missed", "%"},
                 {{"railcast", kLinePoints, {}}, {"brute force", kLinePoints, {}}}};
  const auto add = [&](std::size_t series, const char* name, double x, double y) {
    chart.series[series].points.push_back({.x = x, .y = y});
    chart.series[series].points.back().label = name;
  };
  add(0, "geometry", 1.09, 83.9);
  add(0, "plausibility", 1.12, 83.9);
  add(0, "surface", 1.26, 84.5);
  add(0, "surface + wires", 1.41, 0.2);
  add(0, "footprint_16", 8.8, 0.2);
  add(0, "footprint", 10.5, 0.2);
  add(1, "4", 5.1, 53.0);
  add(1, "19", 20.0, 15.5);
  add(1, "64", 58.0, 3.7);
  const SeriesPaints paints = PaintsOf({chart});
  const auto labels = DrawnLabels({chart, paints, *RangeOfX(chart), *RangeOfY(chart)});
  ASSERT_EQ(labels.size(), 9U);
  for (const DrawnLabel& a : labels) {
    EXPECT_GE(a.left, 0.0) << a.text;
    EXPECT_LE(a.right, 78.0) << a.text;
    for (const DrawnLabel& b : labels) {
      if (&a == &b) break;
      EXPECT_FALSE(a.left < b.right && b.left < a.right && a.low < b.high && b.low < a.high)
          << a.text << " and " << b.text;
    }
  }
}

TEST(DrawingOf, LaysBarsDownWhereNamesSideBySideWouldOverlap) {
  const auto lies = [](const std::vector<std::string>& names) {
    Chart chart{"c", "C", "", {}, {}, {}};
    chart.x.categories = names;
    chart.series = {{"share", kBars}};
    for (std::size_t i = 0; i < names.size(); ++i) {
      chart.series[0].points.push_back({.x = static_cast<double>(i), .y = 1.0});
    }
    return CountOf(DrawingOf(chart, PaintsOf({chart}), "c.svg", "c.png"),
                   "set ytics nomirror scale 0.4 ('" + names[0] + "'") == 1;
  };
  EXPECT_FALSE(lies({"weather", "person", "speed", "place", "time"}));
  // 54 letters, 14 a name: but the two long ones are neighbours.
  EXPECT_TRUE(lies({"a", "reflectivity of clothes", "distance of the tree", "time", "b"}));
  EXPECT_FALSE(lies({"the only name, which has all the room"}));
}

TEST(DrawSheet, MakesAPngAnSvgAndTheirScript) {
  const TemporaryFolder folder;
  const auto picture = folder.Write("here", "").parent_path() / "it's a picture";
  DrawSheet({LabelledChart(), MadeCharts()[0], MadeCharts()[3]}, "it's a title", picture);
  EXPECT_THAT(ReadFileWhole(picture.string() + ".png"), StartsWith("\x89PNG\r\n"));
  EXPECT_THAT(ReadFileWhole(picture.string() + ".gnuplot"), Not(HasSubstr("set output")));
  const std::string svg = ReadFileWhole(picture.string() + ".svg");
  for (const char* const text : {"it's a title", "Error (mm)", "mast &amp; wire", "near_range"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(DrawSheet, SaysThatGnuplotFailed) {
  const TemporaryFolder folder;
  const auto fake = folder.Write("gnuplot", "#!/bin/sh\nexit 1\n");
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", fake.parent_path().c_str(), 1);
  EXPECT_EQ(MessageOf([&] { DrawSheet({LabelledChart()}, "", fake.parent_path() / "picture"); }),
            "gnuplot: failed (the numbers are written)");
  ::setenv("PATH", path.c_str(), 1);
}

TEST(DrawAll, DrawsNothingWithoutCharts) {
  EXPECT_TRUE(DrawAll({}, "/no/such/folder").empty());
}

TEST(CleanSvg, TakesTheColourOfTheTextAround) {
  EXPECT_EQ(CleanSvg("<g fill=\"none\" color=\"black\" stroke=\"currentColor\"><path "
                     "stroke='rgb(  0,   0,   0)'/><polygon fill = 'rgb(  0, 114, 178)'/></g>",
                     "a"),
            "<g fill=\"none\" stroke=\"currentColor\"><path "
            "stroke='currentColor'/><polygon fill='#0072b2'/></g>");
}

TEST(CleanSvg, KeepsNamesOfTwoChartsApart) {
  EXPECT_EQ(CleanSvg("<path id='gpPt0'/><use xlink:href='#gpPt0'/><title>t</title>", "a"),
            "<path id='a-gpPt0'/><use xlink:href='#a-gpPt0'/>");
}

}  // namespace
}  // namespace railcast
