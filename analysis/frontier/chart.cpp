#include "analysis/frontier/chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/frontier/pareto.h"
#include "analysis/report/gnuplot.h"
#include "core/base/error.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr std::size_t kNumPanels = 4;
// Colour-blind safe (Okabe and Ito).
constexpr const char* kLadderColor = "#0072b2";
constexpr const char* kBruteForceColor = "#d55e00";

// What stands beside a point and where, in characters from it. The first rungs lie close together,
// at little more than one raw trace: two go to the left, where the axis has room.
struct PointLabel {
  std::string text;
  double right{};
  double up{};
  bool is_on_the_left = false;
};

PointLabel LabelOf(const FrontierRow& row) {
  if (row.name == "geometry") return {row.name, -0.8, 0.9, true};
  if (row.name == "plausibility") return {row.name, -0.8, -0.9, true};
  if (row.name == "surface") return {row.name, 0.4, 0.9};
  if (row.name == "surface+thin_conductors") return {"surface + wires", 0.8, -0.7};
  if (row.name == "footprint") return {row.name, -0.8, -0.8, true};
  return {row.name.substr(row.name.rfind('_') + 1), 0.8, 0.7};  // Brute force: rays a beam.
}

std::string Labels(const FrontierError& error, const std::vector<RowResult>& results) {
  std::string text = "unset label\n";
  // Geometry and plausibility stand close together: the label of the upper one goes up.
  std::array<double, 2> left{};
  for (const RowResult& result : results) {
    if (!result.difference) continue;
    if (result.row.name == "geometry") left[0] = error.of(*result.difference);
    if (result.row.name == "plausibility") left[1] = error.of(*result.difference);
  }
  const double up_of_geometry = left[0] > left[1] ? 0.9 : -0.9;
  for (const RowResult& result : results) {
    const bool is_brute_force = result.row.group == RowGroup::kBruteForce;
    if (!is_brute_force && result.row.group != RowGroup::kLadder) continue;
    const double value = error.scale * error.of(*result.difference);
    if (std::isnan(value)) continue;
    PointLabel label = LabelOf(result.row);
    if (result.row.name == "geometry") label.up = up_of_geometry;
    if (result.row.name == "plausibility") label.up = -up_of_geometry;
    text += "set label " + GnuplotQuoted(label.text) + " at " + GnuplotNumber(result.ratio()) +
            "," + GnuplotNumber(value) + " offset " + GnuplotNumber(label.right) + "," +
            GnuplotNumber(label.up) + (label.is_on_the_left ? " right" : " left") +
            " textcolor rgb '" + (is_brute_force ? kBruteForceColor : kLadderColor) + "'\n";
  }
  return text;
}

// One line of the chart as a named data block: ratio, error.
std::string DataBlock(const std::string& name,
                      RowGroup group,
                      const FrontierError& error,
                      const std::vector<RowResult>& results) {
  struct Point {
    double ratio{};
    std::string line;
  };
  std::vector<Point> points;
  for (const RowResult& result : results) {
    if (result.row.group != group || !result.difference) continue;
    const double value = error.scale * error.of(*result.difference);
    if (std::isnan(value)) continue;
    points.push_back(
        {result.ratio(), GnuplotNumber(result.ratio()) + " " + GnuplotNumber(value) + "\n"});
  }
  // Lines run from left to right.
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.ratio < b.ratio; });
  std::string text = "$" + name + " << EOD\n";
  for (const Point& point : points) text += point.line;
  // A block without a point is an error of gnuplot's.
  if (points.empty()) text += "NaN NaN\n";
  return text + "EOD\n";
}

/// Where the axes end.
struct Ends {
  double right = 1.0;  ///< The largest ratio.
  double top = 0.0;    ///< The largest error.
};

Ends EndsOf(const FrontierError& error, const std::vector<RowResult>& results) {
  Ends ends;
  for (const RowResult& result : results) {
    if (!result.difference || result.row.group == RowGroup::kReference) continue;
    const double value = error.scale * error.of(*result.difference);
    if (std::isnan(value)) continue;
    ends.right = std::max(ends.right, result.ratio());
    ends.top = std::max(ends.top, value);
  }
  if (ends.top == 0.0) ends.top = 1.0;
  return ends;
}

}  // namespace

std::string ChartScript(const std::vector<RowResult>& results, const std::string& title) {
  std::string text =
      "# gnuplot -e 'set terminal svg size 1200,900' this > frontier.svg\n"
      "set multiplot layout 2,2 title " +
      GnuplotQuoted(title) +
      "\n"
      "set logscale x 2\n"
      "set xlabel 'time per frame / raw trace'\n"
      "set grid\n"
      "set key top right\n"
      "set samples 2\n";
  for (std::size_t i = 0; i < kNumPanels; ++i) {
    const FrontierError& error = kFrontierErrors[i];
    const Ends ends = EndsOf(error, results);
    text += DataBlock("ladder", RowGroup::kLadder, error, results) +
            DataBlock("between", RowGroup::kBetween, error, results) +
            DataBlock("brute", RowGroup::kBruteForce, error, results) + Labels(error, results);
    text += "set ylabel " + GnuplotQuoted(error.title) +
            // Room for labels on all sides.
            "\nset xrange [0.5:" + GnuplotNumber(1.3 * ends.right) + "]\nset yrange [" +
            GnuplotNumber(-0.1 * ends.top) + ":" + GnuplotNumber(1.2 * ends.top) +
            "]\n"
            // Without the function gnuplot fails where no row has this error.
            "plot NaN notitle, $brute using 1:2 with linespoints linecolor rgb '" +
            kBruteForceColor +
            "' pointtype 5 pointsize 0.8 title 'brute force, rays a beam', \\\n"
            "  $ladder using 1:2 with linespoints linecolor rgb '" +
            kLadderColor +
            "' pointtype 7 pointsize 0.9 linewidth 2 title 'railcast', \\\n"
            "  $between using 1:2 with points linecolor rgb '" +
            kLadderColor +
            "' pointtype 6 pointsize 1.2 title 'footprint without thin_conductors'\n";
  }
  return text + "unset multiplot\n";
}

void DrawChart(const std::filesystem::path& script, const std::filesystem::path& picture) {
  const auto draw = [&](const std::string& terminal, const std::string& ending) {
    const std::string bytes = GnuplotOutput(script, "set terminal " + terminal);
    // gnuplot can draw nothing and call it success.
    if (bytes.empty()) throw InputError("gnuplot: failed (the numbers are written)");
    WriteFileWhole(picture.string() + ending, bytes);
  };
  draw("svg noenhanced size 1200,900 background '#ffffff' font 'sans,12'", ".svg");
  draw("pngcairo noenhanced size 1200,900 font 'sans,10'", ".png");
}

}  // namespace railcast
