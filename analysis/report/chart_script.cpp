#include "analysis/report/chart_script.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 380;
constexpr int kEmptyHeight_px = 200;
constexpr int kRowHeight_px = 26;  // Height per category where bars are horizontal.
constexpr int kFrameHeight_px = 110;
// More letters do not fit below an axis.
constexpr std::size_t kMaxLettersBelow = 70;
constexpr std::size_t kMaxNameLetters = 36;
constexpr std::size_t kMaxLyingCategories = 40;
constexpr std::size_t kMaxLabelsBelow = 20;

constexpr const char* kLegend =
    "set key outside top left Left reverse horizontal samplen 1.5 height 0.5\nset samples 2\n";
constexpr const char* kSvgTerminal = "set terminal svg noenhanced rounded font 'sans-serif,14'";
constexpr const char* kPngTerminal =
    "set terminal pngcairo noenhanced rounded fontscale 2 linewidth 2 pointscale 2 "
    "font 'sans-serif,10'";

// Whether names side by side would overlap. Each stands in the middle of its share of the axis.
bool HasLongCategories(const Chart& chart) {
  const std::vector<std::string>& names = chart.x.categories;
  if (names.size() > kMaxLyingCategories) return false;
  std::size_t most_letters = 0;  // Letters of two neighbours.
  for (std::size_t i = 1; i < names.size(); ++i) {
    most_letters = std::max(most_letters, names[i - 1].size() + names[i].size() + 4);
  }
  return most_letters * names.size() > 2 * kMaxLettersBelow;
}

// gnuplot's "set xtics (...)" or the like.
std::string Tics(const std::string& axis, const std::vector<AxisTick>& ticks) {
  std::string text = "set " + axis + "tics nomirror scale 0.4 (";
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (i > 0) text += ", ";
    text += GnuplotQuoted(ticks[i].label) + " " + GnuplotNumber(ticks[i].at);
  }
  return text + ")\n";
}

// Shortens a name so that the chart keeps its room; the tables have the full name.
std::string Shortened(const std::string& name) {
  if (name.size() <= kMaxNameLetters) return name;
  std::size_t end = kMaxNameLetters - 1;
  // Do not cut within a UTF-8 character.
  while ((static_cast<unsigned char>(name[end]) >> 6) == 2) --end;
  return Joined({name.substr(0, end), "…"});
}

std::vector<AxisTick> CategoryTicks(const std::vector<std::string>& names, bool is_lying) {
  const std::size_t stride = is_lying ? 1 : 1 + (names.size() - 1) / kMaxLabelsBelow;
  std::vector<AxisTick> ticks;
  for (std::size_t i = 0; i < names.size(); i += stride) {
    ticks.push_back({static_cast<double>(i), Shortened(names[i])});
  }
  return ticks;
}

// `axis` is gnuplot's: "x" or "y".
std::string AxisText(const std::string& axis,
                     const ChartAxis& ours,
                     const AxisRange& range,
                     bool is_lying) {
  constexpr int kNumTicks = 6;
  std::string text =
      "set " + axis + "label " + GnuplotQuoted(WithUnit(ours.title, ours.unit)) + "\n";
  const bool goes_down = is_lying && !ours.categories.empty();
  text += "set " + axis + "range [" + GnuplotNumber(goes_down ? range.high : range.low) + ":" +
          GnuplotNumber(goes_down ? range.low : range.high) + "]\n";
  if (ours.is_log) text += "set logscale " + axis + "\n";
  return text + Tics(axis, ours.categories.empty() ? TicksIn(range, ours.is_log, kNumTicks)
                                                   : CategoryTicks(ours.categories, is_lying));
}

std::string AxesText(const Drawing& drawing) {
  const Chart& chart = drawing.chart;
  const bool lies = drawing.is_lying;
  return AxisText(lies ? "y" : "x", chart.x, drawing.x, lies) +
         AxisText(lies ? "x" : "y", chart.y, drawing.y, lies) + "set grid " + (lies ? "x" : "y") +
         "tics back linetype 1 linewidth 0.8 linecolor rgb '" + kGridColor + "'\n";
}

int HeightOf_px(const Drawing& drawing) {
  if (!drawing.is_lying) return kHeight_px;
  const int rows_px = kRowHeight_px * static_cast<int>(drawing.chart.x.categories.size());
  return std::max(kHeight_px / 2, kFrameHeight_px + rows_px);
}

// Axes of a chart without any point.
std::string EmptyAxesText(const Chart& chart) {
  return "set xlabel " + GnuplotQuoted(WithUnit(chart.x.title, chart.x.unit)) + "\nset ylabel " +
         GnuplotQuoted(WithUnit(chart.y.title, chart.y.unit)) +
         "\nset xrange [0:1]\nset yrange [0:1]\nunset xtics\nunset ytics\nset label 1 'not enough "
         "data' at graph 0.5, 0.5 center textcolor rgb '" +
         kMutedColor + "'\n";
}

// The gnuplot commands of a chart, without its terminal.
struct ChartText {
  std::string settings;
  std::string plot;
  int height_px{};
};

ChartText TextOf(const Chart& chart, const SeriesPaints& paints) {
  const std::optional<AxisRange> x = RangeOfX(chart);
  const std::optional<AxisRange> y = RangeOfY(chart);
  const bool is_empty = !x || !y;
  const Drawing drawing = is_empty ? Drawing{chart, paints, {}, {}}
                                   : Drawing{chart, paints, *x, *y, HasLongCategories(chart)};
  const PlotText plot = PlotOf(drawing);
  return {Joined({"reset\n", plot.data, "set border ", drawing.is_lying ? "2" : "1",
                  " linewidth 1 linecolor rgb '#000000'\n", kLegend,
                  is_empty ? EmptyAxesText(chart) : AxesText(drawing)}),
          plot.command, is_empty ? kEmptyHeight_px : HeightOf_px(drawing)};
}

}  // namespace

// Colours the graph whose nodes are titles and whose edges join those that meet in a chart, in the
// order in which they first appear. As few charts have more than seven series, dashes are rare.
SeriesPaints PaintsOf(const std::vector<Chart>& charts) {
  std::map<std::string, std::set<std::string>> met_by_title;
  for (const Chart& chart : charts) {
    for (const ChartSeries& one : chart.series) {
      for (const ChartSeries& other : chart.series) met_by_title[one.title].insert(other.title);
    }
  }
  SeriesPaints paints;
  for (const Chart& chart : charts) {
    for (const ChartSeries& series : chart.series) {
      if (paints.contains(series.title)) continue;
      std::set<std::size_t> taken;
      for (const std::string& title : met_by_title[series.title]) {
        if (const auto met = paints.find(title); met != paints.end()) taken.insert(met->second);
      }
      std::size_t paint = 0;
      while (taken.contains(paint)) ++paint;
      paints.emplace(series.title, paint);
    }
  }
  return paints;
}

std::string GnuplotQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += c;
    // A line break would end the command.
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted += "'";
}

std::string GnuplotNumber(double value) {
  if (!std::isfinite(value)) return "NaN";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string DrawingOf(const Chart& chart,
                      const SeriesPaints& paints,
                      const std::filesystem::path& svg,
                      const std::filesystem::path& png) {
  const ChartText text = TextOf(chart, paints);
  const auto output = [&](int scale, const std::filesystem::path& file) {
    return Joined({" size ", std::to_string(scale * kWidth_px), ",",
                   std::to_string(scale * text.height_px), "\nset output ",
                   GnuplotQuoted(file.string()), "\n", text.plot});
  };
  return Joined({text.settings, kSvgTerminal, output(1, svg), "set title ",
                 GnuplotQuoted(chart.title), "\n", kPngTerminal, output(2, png), "set output\n"});
}

std::string SheetOf(const std::vector<Chart>& charts, const std::string& title) {
  std::string script =
      "# gnuplot -e 'set terminal svg noenhanced size 1200,900' this > picture.svg\nset multiplot "
      "layout " +
      std::to_string((charts.size() + 1) / 2) + ",2 title " + GnuplotQuoted(title) + "\n";
  const SeriesPaints paints = PaintsOf(charts);
  for (const Chart& chart : charts) {
    const ChartText text = TextOf(chart, paints);
    script += text.settings + text.plot;
  }
  return script + "unset multiplot\n";
}

}  // namespace railcast
