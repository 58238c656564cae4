#include "analysis/report/words.h"

#include <kainjow/mustache.hpp>
#include <sstream>

#include "analysis/report/chart_columns.h"
#include "core/base/error.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

/// One entry of a file of words.
class WordEntry {
 public:
  WordEntry(const char* words, const char* kind, const std::string& key, const WordValues& values)
      : json(Json::parse(words).at(kind).value(key, Json())) {
    Check(!json.is_null(), "words.json has what a report shows");
    for (const auto& [name, text] : values) {
      values_.set(name, text.empty() ? kainjow::mustache::data(false) : text);
    }
  }

  [[nodiscard]] std::string Filled(const std::string& text) const {
    if (text.find("{{") == std::string::npos) return text;
    kainjow::mustache::mustache template_of_text(text);
    template_of_text.set_custom_escape([](const std::string& value) { return value; });
    return template_of_text.render(values_);
  }
  /// Empty if the entry has none.
  [[nodiscard]] std::string TextOf(const char* name) const { return Filled(json.value(name, "")); }
  /// ["Range", "m", "log"]: title, unit and whether it is logarithmic, of which the last may be
  /// left out.
  [[nodiscard]] ChartAxis AxisOf(const char* name) const {
    const auto parts = json.value(name, std::vector<std::string>());
    ChartAxis axis;
    if (!parts.empty()) axis.title = Filled(parts[0]);
    if (parts.size() > 1) axis.unit = parts[1];
    axis.is_log = parts.size() > 2;
    return axis;
  }

  Json json;

 private:
  kainjow::mustache::data values_;
};

Chart EmptyChart(const WordEntry& entry, const std::string& key) {
  // A chart must say what to see.
  Check(entry.json.contains("caption"), "words.json has a caption for each chart");
  return {.key = key,
          .title = entry.TextOf("title"),
          .caption = entry.TextOf("caption"),
          .x = entry.AxisOf("x"),
          .y = entry.AxisOf("y")};
}

}  // namespace

std::string SentencesOf(const char* words, const std::string& key, const WordValues& values) {
  const WordEntry entry(words, "texts", key, values);
  return entry.Filled(entry.json.get<std::string>());
}

Section SectionOf(const char* words, const std::string& key, const WordValues& values) {
  const WordEntry entry(words, "sections", key, values);
  Section section{.key = key, .title = entry.TextOf("title")};
  for (const auto& text : entry.json.value("paragraphs", std::vector<std::string>())) {
    std::istringstream lines(entry.Filled(text));
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty()) section.paragraphs.push_back(line);
    }
  }
  return section;
}

Table TableOf(const char* words, const std::string& key, const WordValues& values) {
  const WordEntry entry(words, "tables", key, values);
  Table table{.key = key,
              .title = entry.TextOf("title"),
              .note = entry.TextOf("note"),
              .is_open = entry.json.value("open", false)};
  if (const std::string columns = entry.TextOf("columns"); !columns.empty()) {
    table.columns = ColumnsOf(columns);
  }
  return table;
}

Chart ChartOf(const char* words, const std::string& key, const WordValues& values) {
  return EmptyChart(WordEntry(words, "charts", key, values), key);
}

Chart ChartOfTable(const char* words,
                   const std::string& key,
                   const Table& table,
                   const WordValues& values) {
  const WordEntry entry(words, "charts", key, values);
  Chart chart = EmptyChart(entry, key);
  const bool has_bars = entry.json.value("style", "") == "bars";
  const std::string by = entry.json.value("by", "");
  for (const auto& columns : entry.json.at("series").get<std::vector<std::vector<std::string>>>()) {
    if (!by.empty()) {
      chart.series = SeriesByName(table, {columns.at(0), columns.at(1), "", by});
      continue;
    }
    if (has_bars) chart.x.categories = TextsOf(table, columns.at(0));
    chart.series.push_back(SeriesOf(table, {columns.at(0), columns.at(1)},
                                    columns.size() > 2 ? entry.Filled(columns[2]) : "",
                                    has_bars ? SeriesStyle::kBars : SeriesStyle::kLinePoints));
  }
  return chart;
}

}  // namespace railcast
