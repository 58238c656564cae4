#include "analysis/report/formats.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/report/cell_text.h"
#include "core/base/text.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

// JSON has neither NaN nor infinity.
Json NumberOf(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

struct CellJson {
  Json operator()(const std::string& text) const { return text; }
  Json operator()(std::uint64_t count) const { return count; }
  Json operator()(double value) const { return NumberOf(value); }
  Json operator()(const Estimate& estimate) const {
    return {{"value", NumberOf(estimate.value)},
            {"low", NumberOf(estimate.low)},
            {"high", NumberOf(estimate.high)},
            {"samples", estimate.num}};
  }
  Json operator()(const Span& span) const {
    return {{"low", NumberOf(span.low)}, {"high", NumberOf(span.high)}};
  }
  Json operator()(const Judgement& judgement) const { return judgement.words; }
};

Json JsonOf(const Cell& cell) {
  return std::visit(CellJson{}, cell);
}

Json JsonOf(const Table& table) {
  Json columns = Json::array();
  for (const TableColumn& column : table.columns) {
    columns.push_back({{"key", column.key}, {"title", column.title}, {"unit", column.unit}});
  }
  Json rows = Json::array();
  for (const std::vector<Cell>& row : table.rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i].key] = JsonOf(row[i]);
    rows.push_back(std::move(object));
  }
  return {{"key", table.key},
          {"title", table.title},
          {"note", table.note},
          {"columns", std::move(columns)},
          {"rows", std::move(rows)}};
}

Json JsonOf(const ChartAxis& axis) {
  Json object = {{"title", axis.title}, {"unit", axis.unit}};
  if (!axis.categories.empty()) object["categories"] = axis.categories;
  return object;
}

Json JsonOf(const Chart& chart) {
  Json series = Json::array();
  for (const ChartSeries& one : chart.series) {
    Json points = Json::array();
    for (const ChartPoint& point : one.points) {
      points.push_back({{"x", NumberOf(point.x)},
                        {"y", NumberOf(point.y)},
                        {"low", NumberOf(point.low)},
                        {"high", NumberOf(point.high)}});
      if (!point.label.empty()) points.back()["label"] = point.label;
    }
    series.push_back({{"title", one.title}, {"points", std::move(points)}});
  }
  return {{"key", chart.key},
          {"title", chart.title},
          {"x", JsonOf(chart.x)},
          {"y", JsonOf(chart.y)},
          {"series", std::move(series)}};
}

Json JsonOf(const Section& section) {
  Json tables = Json::array();
  for (const Table& table : section.tables) tables.push_back(JsonOf(table));
  Json charts = Json::array();
  for (const Chart& chart : section.charts) charts.push_back(JsonOf(chart));
  Json pictures = Json::array();
  for (const Picture& picture : section.pictures) pictures.push_back({{"key", picture.key}});
  return {{"key", section.key},
          {"title", section.title},
          {"tables", std::move(tables)},
          {"charts", std::move(charts)},
          {"pictures", std::move(pictures)}};
}

std::string CsvText(const std::string& text) {
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::ostringstream quoted;
  quoted << std::quoted(text, '"', '"');
  return quoted.str();
}

std::string CsvNumber(double value) {
  return std::isnan(value) ? std::string() : NumberText(value);
}

struct CellCsv {
  std::string operator()(const std::string& text) const { return CsvText(text); }
  std::string operator()(std::uint64_t count) const { return NumberText(count); }
  std::string operator()(double value) const { return CsvNumber(value); }
  std::string operator()(const Estimate& estimate) const {
    std::string text = CsvNumber(estimate.value);
    text += ',' + CsvNumber(estimate.low);
    text += ',' + CsvNumber(estimate.high);
    return text += ',' + NumberText(estimate.num);
  }
  std::string operator()(const Span& span) const { return SpanText(span); }
  std::string operator()(const Judgement& judgement) const { return CsvText(judgement.words); }
};

bool HasEstimates(const Table& table, std::size_t column) {
  for (const std::vector<Cell>& row : table.rows) {
    if (std::holds_alternative<Estimate>(row[column])) return true;
  }
  return false;
}

}  // namespace

std::string ReportJson(const Report& report, const std::string& details) {
  Json facts = Json::object();
  for (const auto& [name, fact] : report.facts) facts[name] = fact;
  Json remarks = Json::array();
  for (const Remark& remark : report.remarks) {
    remarks.push_back({{"name", remark.type().name},
                       {"number", remark.number},
                       {"place", remark.place},
                       {"text", remark.Text()}});
  }
  Json headlines = Json::array();
  for (const Headline& headline : report.headlines) {
    headlines.push_back(
        {{"title", headline.title}, {"unit", headline.unit}, {"value", JsonOf(headline.value)}});
  }
  Json sections = Json::array();
  for (const Section& section : report.sections) sections.push_back(JsonOf(section));
  Json json = {{"title", report.title},
               {"command", report.command},
               {"facts", std::move(facts)},
               {"remarks", std::move(remarks)},
               {"headlines", std::move(headlines)},
               {"sections", std::move(sections)}};
  json.update(Json::parse(details));
  // File names may be invalid UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string TableCsv(const Table& table) {
  std::string text;
  std::vector<bool> has_estimates;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string key = CsvText(table.columns[i].key);
    has_estimates.push_back(HasEstimates(table, i));
    if (i > 0) text += ',';
    text += key;
    if (!has_estimates[i]) continue;
    text += ',' + key + "_low";
    text += ',' + key + "_high";
    text += ',' + key + "_samples";
  }
  text += '\n';
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      text += std::visit(CellCsv{}, row[i]);
      if (has_estimates[i] && !std::holds_alternative<Estimate>(row[i])) text += ",,,";
    }
    text += '\n';
  }
  return text;
}

}  // namespace railcast
