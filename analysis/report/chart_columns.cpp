#include "analysis/report/chart_columns.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/report/cell_text.h"
#include "core/base/error.h"

namespace railcast {
namespace {

std::size_t ColumnIndexOf(const Table& table, const std::string& key) {
  const auto at = std::ranges::find(table.columns, key, &TableColumn::key);
  Check(at != table.columns.end(), "a chart names columns of its table");
  return static_cast<std::size_t>(at - table.columns.begin());
}

// Position of a cell on an axis; `num_before` is the number of names before it.
struct PlaceOf {
  std::size_t num_before{};

  double operator()(const std::string&) const { return static_cast<double>(num_before); }
  double operator()(std::uint64_t count) const { return static_cast<double>(count); }
  double operator()(double value) const { return value; }
  double operator()(const Estimate& estimate) const { return estimate.value; }
  double operator()(const Span& span) const { return 0.5 * (span.low + span.high); }
  double operator()(const Judgement&) const { return static_cast<double>(num_before); }
};

ChartPoint PointOf(double x, const Cell& y) {
  if (const auto* const estimate = std::get_if<Estimate>(&y)) return PointAt(x, *estimate);
  return {x, std::visit(PlaceOf{}, y)};
}

}  // namespace

ChartSeries SeriesOf(const Table& table,
                     const SeriesColumns& columns,
                     const std::string& title,
                     SeriesStyle style) {
  const std::size_t x_index = ColumnIndexOf(table, columns.x);
  const std::size_t y_index = ColumnIndexOf(table, columns.y);
  ChartSeries series{title, style, {}};
  std::optional<double> last_end;  // Upper end of the previous bin.
  for (const std::vector<Cell>& row : table.rows) {
    if (!columns.group.empty() &&
        std::get<std::string>(row[ColumnIndexOf(table, columns.group)]) != columns.name) {
      continue;
    }
    const double x = std::visit(PlaceOf{series.points.size()}, row[x_index]);
    ChartPoint point = PointOf(x, row[y_index]);
    const bool is_measured = std::holds_alternative<double>(row[x_index]);
    if (is_measured && std::isnan(point.y)) continue;
    if (const auto* const bin = std::get_if<Span>(&row[x_index])) {
      if (last_end && bin->low > *last_end) {
        series.points.push_back({0.5 * (*last_end + bin->low)});
      }
      last_end = bin->high;
    }
    if (!columns.label.empty())
      point.label = TextOf(row[ColumnIndexOf(table, columns.label)]).value;
    series.points.push_back(std::move(point));
  }
  return series;
}

std::vector<ChartSeries> SeriesByName(const Table& table, SeriesColumns columns) {
  std::vector<ChartSeries> all;
  std::vector<std::string> names;
  for (const std::string& name : TextsOf(table, columns.group)) {
    if (std::ranges::find(names, name) != names.end()) continue;
    names.push_back(name);
    columns.name = name;
    ChartSeries series = SeriesOf(table, columns, name);
    const bool is_empty = std::ranges::all_of(
        series.points, [](const ChartPoint& point) { return std::isnan(point.y); });
    if (!is_empty) all.push_back(std::move(series));
  }
  return all;
}

std::vector<ChartSeries> SeriesByRow(const Table& table, std::size_t max_rows) {
  std::vector<ChartSeries> all;
  for (const std::vector<Cell>& row : table.rows) {
    if (all.size() == max_rows) break;
    ChartSeries series{TextOf(row[0]).value, SeriesStyle::kLinePoints, {}};
    for (std::size_t i = 1; i < row.size(); ++i) {
      series.points.push_back(PointOf(static_cast<double>(i - 1), row[i]));
    }
    all.push_back(std::move(series));
  }
  return all;
}

std::vector<std::string> TextsOf(const Table& table, const std::string& column) {
  const std::size_t index = ColumnIndexOf(table, column);
  std::vector<std::string> texts;
  for (const std::vector<Cell>& row : table.rows) texts.push_back(TextOf(row[index]).value);
  return texts;
}

}  // namespace railcast
