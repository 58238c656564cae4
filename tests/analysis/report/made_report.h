#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// A table with cells of every type, and with text that every format must escape.
[[nodiscard]] inline Table MadeTable() {
  return {"dropout_by_range",
          "Dropout by range",
          "Beams without a point <of all beams>.",
          {{"cause", "Cause", ""},
           {"beams", "Beams", ""},
           {"range_m", "Range", "m"},
           {"dropout", "Dropout", "%"}},
          {{std::string("no \"surface\", <b>bold</b>"), std::uint64_t{1234567}, 12.5,
            Estimate{12.3412, 11.9, 12.7811, 4512}},
           {std::string("it's rain & fog"), std::uint64_t{0}, kNoFigure, NotEnough(3)},
           {std::string("no interval"), std::uint64_t{7}, -0.25,
            Estimate{0.5, kNoFigure, kNoFigure, 20}}}};
}

/// A table with more columns than fit on paper.
[[nodiscard]] inline Table MadeWideTable() {
  Table table = {"wide", "Wide", "", {{"name", "Name", ""}}, {{std::string("row")}}};
  for (int i = 1; i <= 30; ++i) {
    table.columns.push_back({"column_" + std::to_string(i), "Column" + std::to_string(i), "m"});
    table.rows[0].emplace_back(Estimate{10.0 * i, 10.0 * i - 1.0, 10.0 * i + 1.0, 100});
  }
  return table;
}

/// y = x^exponent at 1, 2, ... with intervals and one gap.
[[nodiscard]] inline ChartSeries MadeCurve(const std::string& title,
                                           SeriesStyle style,
                                           double exponent,
                                           int num_points) {
  ChartSeries series{title, style, {}};
  for (int i = 1; i <= num_points; ++i) {
    const double y = i == 5 ? kNoFigure : std::pow(i, exponent);
    series.points.push_back({static_cast<double>(i), y, 0.8 * y, 1.25 * y});
  }
  return series;
}

[[nodiscard]] inline std::vector<Chart> MadeCharts() {
  using enum SeriesStyle;
  const ChartAxis range = {"Range", "m", false, {}};
  const ChartAxis share = {"Share", "%", false, {}};
  std::vector<Chart> charts;
  charts.push_back(
      {"lines",
       "Lines keep a gap where a figure is absent",
       "Bands are the 95 % intervals <of each>.",
       range,
       share,
       {MadeCurve("ground", kLinePoints, 1.0, 40), MadeCurve("mast & wire", kLine, 0.7, 40),
        MadeCurve("it's `date`", kPoints, 0.3, 40)}});
  charts.push_back({"log_log",
                    "A power law is a straight line",
                    "A straight line is a power law.",
                    {"Range", "m", true, {}},
                    {"Density", "1/m²", true, {}},
                    {MadeCurve("ground", kPoints, -3.0, 60), MadeCurve("fit", kLine, -3.0, 60)}});
  charts.push_back({"few_bars",
                    "Short names stand below",
                    "Names stand below their bars.",
                    {"", "", false, {"rain", "fog", "snow"}},
                    share,
                    {{"demo", kBars, {{0, 3, 2, 4}, {1, 5, 4.5, 5.5}, {2, 1.5, 1, 2}}},
                     {"other", kBars, {{0, 2, 1.5, 2.5}, {1, 4, 3, 6}, {2, kNoFigure}}}}});
  charts.push_back({"many_bars",
                    "Long names stand at the side",
                    "Names stand beside their bars.",
                    {"",
                     "",
                     false,
                     {"no_surface", "below_threshold", "rain_absorbed", "sensor_dropout",
                      "near_range", "a name that is far longer than any of the others"}},
                    share,
                    {{"",
                      kBars,
                      {{0, 30, 28, 32},
                       {1, 12, 11, 13},
                       {2, 3, 2, 4},
                       {3, 1, 0.5, 1.5},
                       {4, 0, 0, 0.1},
                       {5, 7, 6, 8}}}}});
  charts.push_back(
      {"empty", "Nothing to see", "There is nothing to see.", range, share, {{"none", kLine, {}}}});
  charts.push_back({"all_absent",
                    "All absent",
                    "There is nothing to see.",
                    {"", "", false, {"rain", "fog"}},
                    {"Share", "%", true, {}},
                    {{"none", kBars, {{0, kNoFigure}, {1, kNoFigure}}}}});
  charts.push_back({"one_point",
                    "One point",
                    "There is one point.",
                    {"Range", "m", true, {}},
                    share,
                    {{"one", kLinePoints, {{30, 2, 1, 3}}}}});
  return charts;
}

[[nodiscard]] inline Picture MadePicture() {
  return {.key = "seen",
          .title = "What is <seen>",
          .caption = "A line \"upwards\".",
          .script = "unset border\nunset tics\nplot x linecolor rgb '#ff0000' notitle\n",
          .width_px = 200,
          .height_px = 100};
}

[[nodiscard]] inline Report MadeReport() {
  Report report;
  report.title = "Statistics of <out/demo> & \"more\"";
  report.command = "railcast-analyze stats 'out/demo' --out <dir>";
  report.facts = {{"Input", "out/demo, a sequence"},
                  {"Frames", "50"},
                  {"Sensor", "VLP-16 <script>alert(1)</script>"},
                  {"Version", "railcast 0.5"}};
  report.headlines = {{"Dropout", "%", Estimate{12.3412, 11.9, 12.7811, 4512}},
                      {"Slope of the density on ground", "", Estimate{-2.98, -3.04, -2.92, 31}},
                      {"Temporal noise", "mm", NotEnough(3)},
                      {"Frames", "", std::uint64_t{12050}},
                      {"Farthest point", "m", 119.94},
                      {"Kind", "", std::string("sequence")}};
  report.sections.push_back({"charts",
                             "Charts of all kinds",
                             {"A beam counts as dropped if none of its returns gave a point."},
                             MadeCharts(),
                             {MadeTable()}});
  report.sections.push_back(
      {"words", "Words & little else", {"A <paragraph>."}, {}, {MadeWideTable()}, {MadePicture()}});
  return report;
}

}  // namespace railcast
