#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

// What every command of railcast-analyze finds out, as plain data: page, text, JSON, CSV and charts
// are made of it (analysis/report/).

/// One cell of a table. A double that is NaN is an absent figure, an Estimate without a value one
/// for which the samples were not enough: neither is ever written as a number.
using Cell = std::variant<std::string, std::uint64_t, double, Estimate>;

struct TableColumn {
  std::string key{};    ///< Lower snake case with its unit, as in CSV and JSON: "range_m".
  std::string title{};  ///< For people, without the unit: "Range".
  std::string unit{};   ///< "m"; empty = none.
};

struct Table {
  std::string key{};    ///< Names the CSV file, unique in a report: "dropout_by_range".
  std::string title{};  ///< "Dropout by range".
  std::string note{};   ///< What a reader must know of it: assumptions, definitions; may be empty.
  std::vector<TableColumn> columns{};
  std::vector<std::vector<Cell>> rows{};  ///< Each as long as `columns`.
  bool is_open{};                         ///< Whether the page shows its rows unasked.
};

/// One point of a chart. NaN in y leaves a gap; low and high, where they are numbers, are the ends
/// of its interval.
struct ChartPoint {
  double x{};
  double y = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

enum class SeriesStyle { kLine, kPoints, kLinePoints, kBars };

struct ChartSeries {
  std::string title{};
  SeriesStyle style = SeriesStyle::kLinePoints;
  std::vector<ChartPoint> points{};
};

struct ChartAxis {
  std::string title{};
  std::string unit{};  ///< Empty = none.
  bool is_log = false;
  /// Names of the places 0, 1, 2, ... where x is no number; empty = it is one. Of x axes only.
  std::vector<std::string> categories{};
};

struct Chart {
  std::string key{};      ///< Names its SVG and PNG files, unique in a report.
  std::string title{};    ///< What one should see in it, in a few words.
  std::string caption{};  ///< A sentence or two below it; may be empty.
  ChartAxis x{}, y{};
  std::vector<ChartSeries> series{};
};

struct Section {
  std::string key{};
  std::string title{};
  std::vector<std::string> paragraphs{};  ///< Plain text: definitions, assumptions, findings.
  std::vector<Chart> charts{};
  std::vector<Table> tables{};
};

/// A figure worth reading first.
struct Headline {
  std::string title{};  ///< "Dropout".
  std::string unit{};
  Cell value{};
};

struct Report {
  std::string title{};    ///< "Statistics of out/demo".
  std::string command{};  ///< That made it, for a reader to repeat.
  std::vector<std::pair<std::string, std::string>>
      facts{};  ///< Input, frames, sensor, version, ...
  std::vector<Headline> headlines{};
  std::vector<Section> sections{};
};

}  // namespace railcast
