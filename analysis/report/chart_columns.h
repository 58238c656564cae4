#pragma once

#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Keys of the table columns that a series of a chart shows.
struct SeriesColumns {
  std::string x{};      ///< Numbers, bins, or names, which stand at 0, 1, 2, ...
  std::string y{};      ///< Numbers or estimates.
  std::string label{};  ///< Text beside each point; empty = none.
  /// Only rows with `name` in the column `group`; all rows if empty.
  std::string group{}, name{};
};

/// Makes a series from a table. A row without a figure and a missing bin leave a gap; where x is a
/// measured number, the line continues.
/// @pre The columns exist.
[[nodiscard]] ChartSeries SeriesOf(const Table& table,
                                   const SeriesColumns& columns,
                                   const std::string& title,
                                   SeriesStyle style = SeriesStyle::kLinePoints);

/// Makes a series for each name in the column `group`, in the order of the rows; series without any
/// point are left out.
[[nodiscard]] std::vector<ChartSeries> SeriesByName(const Table& table, SeriesColumns columns);

/// Makes a line for each of a table's first rows, named by the first column, over the other
/// columns, which hold numbers.
[[nodiscard]] std::vector<ChartSeries> SeriesByRow(const Table& table, std::size_t max_rows);

/// The texts of a column, as the categories of an axis.
[[nodiscard]] std::vector<std::string> TextsOf(const Table& table, const std::string& column);

}  // namespace railcast
