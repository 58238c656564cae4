#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "railcast/remark.h"

namespace railcast {

// The results of every command of railcast-analyze as plain data, from which page, text, JSON, CSV
// and charts are made (analysis/report/).

/// A bin of a quantity: "20 to 30" in every format; a chart puts it at its middle.
struct Span {
  double low{};
  double high{};
};

/// What a verdict means for whoever asks.
enum class Grade { kGood, kBad, kOpen };

/// The words of a verdict. All formats have the words; the page also colours them by their grade.
struct Judgement {
  std::string words{};
  Grade grade = Grade::kOpen;
};

/// One cell of a table. A NaN double is an absent figure; an Estimate without a value is one with
/// too few samples. Neither is ever written as a number.
using Cell = std::variant<std::string, std::uint64_t, double, Estimate, Span, Judgement>;

struct TableColumn {
  std::string key{};    ///< Lower snake case with unit, as in CSV and JSON: "range_m".
  std::string title{};  ///< Title for readers, without the unit: "Range".
  std::string unit{};   ///< "m"; empty if there is none.
};

/// Columns from a text such as "range_m: Range; points: Points". The unit follows from the key's
/// end, as in any name: "m" for range_m, "%" for share_percent. Where it does not, it is in
/// brackets: "auc [1]: Area". Defined in cell_text.cpp.
[[nodiscard]] std::vector<TableColumn> ColumnsOf(std::string_view text);

struct Table {
  std::string key{};    ///< Name of the CSV file, unique in a report: "dropout_by_range".
  std::string title{};  ///< "Dropout by range".
  /// What a reader must know about it: assumptions, definitions; may be empty.
  std::string note{};
  std::vector<TableColumn> columns{};
  std::vector<std::vector<Cell>> rows{};  ///< Each row has as many cells as `columns`.
  bool is_open{};                         ///< Whether the page shows its rows unfolded.
};

/// One point of a chart. A NaN y leaves a gap; low and high, where they are numbers, are the ends
/// of its interval.
struct ChartPoint {
  double x{};
  double y = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  std::string label{};  ///< Text beside the point; empty if none. Bars have no labels.
};

/// The point of an estimate in a chart.
[[nodiscard]] inline ChartPoint PointAt(double x, const Estimate& estimate) {
  return {x, estimate.value, estimate.low, estimate.high};
}

/// Bars need an axis with categories.
enum class SeriesStyle { kLine, kPoints, kLinePoints, kBars };

struct ChartSeries {
  std::string title{};
  SeriesStyle style = SeriesStyle::kLinePoints;
  std::vector<ChartPoint> points{};
};

struct ChartAxis {
  std::string title{};
  std::string unit{};  ///< Empty if there is none.
  bool is_log = false;
  /// Names of the positions 0, 1, 2, ... where x is not a number, else empty. For x axes only.
  std::vector<std::string> categories{};
};

/// A sentence that says what to see, with its full stop. It has no default: a chart without one
/// does not compile.
struct Caption {
  Caption(const char* sentence) : text(sentence) {}
  Caption(std::string sentence) : text(std::move(sentence)) {}

  std::string text;
};

struct Chart {
  std::string key{};    ///< Name of its SVG and PNG files, unique in a report.
  std::string title{};  ///< What the chart shows, in a few words.
  Caption caption;      ///< Below it.
  ChartAxis x{}, y{};
  std::vector<ChartSeries> series{};
};

/// A picture of clouds and images on a dark ground.
struct Picture {
  std::string key{};      ///< Name of its PNG file, unique among charts and pictures of a report.
  std::string title{};    ///< What the picture shows, in a few words.
  std::string caption{};  ///< One or two sentences below it; may be empty.
  std::string script{};   ///< gnuplot commands that draw it and set neither terminal nor output.
  int width_px{};
  int height_px{};
};

struct Section {
  std::string key{};
  std::string title{};
  std::vector<std::string> paragraphs{};  ///< Plain text: definitions, assumptions, findings.
  std::vector<Chart> charts{};
  std::vector<Table> tables{};
  std::vector<Picture> pictures{};  ///< Shown before the charts.
};

/// A key figure for the top of the report.
struct Headline {
  std::string title{};  ///< "Dropout".
  std::string unit{};
  Cell value{};
};

struct Report {
  std::string title{};    ///< "Statistics of out/demo".
  std::string command{};  ///< Command line that made it, for a reader to repeat.
  std::vector<std::pair<std::string, std::string>>
      facts{};                    ///< Input, frames, sensor, version, ...
  std::vector<Remark> remarks{};  ///< Remarks of the readers of its sources, which facts tell, too.
  std::vector<Headline> headlines{};
  std::vector<Section> sections{};
};

}  // namespace railcast
