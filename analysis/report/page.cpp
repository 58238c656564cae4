#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstdlib>
#include <kainjow/mustache.hpp>
#include <set>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_script.h"
#include "analysis/report/formats.h"
#include "core/base/error.h"

namespace railcast {

// page.html, a Mustache template, and page.css; CMake embeds them as strings.
extern const char* const kPageHtml;
extern const char* const kPageCss;

namespace {

using kainjow::mustache::data;
using kainjow::mustache::list;
using kainjow::mustache::object;

// The template leaves out sections whose value is false.
data IfAny(const std::string& text) {
  return text.empty() ? data(false) : data(text);
}

template <typename Items, typename DataOfItem>
list ListOf(const Items& items, const DataOfItem& data_of) {
  list all;
  for (const auto& item : items) all.push_back(data_of(item));
  return all;
}

// Numbers with a real minus sign, which is as wide as a digit, and with powers of ten: "-3e-05"
// becomes "−3 × 10<sup>−5</sup>".
std::string NumberHtml(const std::string& numbers) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string html;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] == '-') {
      html += "−";
    } else if (numbers[i] == 'e' && i > 0 && is_digit(numbers[i - 1])) {
      std::size_t length = 0;
      const int power = std::stoi(numbers.substr(i + 1), &length);
      html += Joined({"\u202f×\u202f10<sup>", power < 0 ? "−" : "", std::to_string(std::abs(power)),
                      "</sup>"});
      i += length;
    } else {
      html += numbers[i];
    }
  }
  return html;
}

// The class of the style sheet for a verdict; nothing for any other cell.
data GradeData(const Cell& cell) {
  const auto* const judgement = std::get_if<Judgement>(&cell);
  if (judgement == nullptr) return false;
  if (judgement->grade == Grade::kOpen) return "open";
  return judgement->grade == Grade::kGood ? "good" : "bad";
}

data CellData(const Cell& cell, const PageColumn& column, bool is_first) {
  const CellText text = TextOf(cell);
  object cell_data = {{"is_wide", column.has_estimates},
                      {"grade", GradeData(cell)},
                      {"interval", NumberHtml(text.interval)},
                      {"samples", text.samples}};
  if (HasLongWord(text.value)) cell_data["breaks"] = true;
  if (is_first && !text.is_number) {
    cell_data["row_name"] = text.value;
  } else if (text.is_absent) {
    cell_data["absent"] = LineOf(text);
  } else if (text.is_number) {
    cell_data["number"] = NumberHtml(text.value);
  } else {
    cell_data["words"] = text.value;
  }
  return cell_data;
}

// Template data of a table with some of the columns.
data GridData(const Table& table,
              const std::vector<PageColumn>& columns,
              const std::vector<std::size_t>& shown) {
  return object{{"columns", ListOf(shown,
                                   [&](std::size_t i) {
                                     return object{{"title", table.columns[i].title},
                                                   {"unit", IfAny(table.columns[i].unit)},
                                                   {"is_number", columns[i].is_number},
                                                   {"is_wide", columns[i].has_estimates}};
                                   })},
                {"rows", ListOf(table.rows, [&](const std::vector<Cell>& row) {
                   return object{{"cells", ListOf(shown, [&](std::size_t i) {
                                    return CellData(row[i], columns[i], i == 0);
                                  })}};
                 })}};
}

// A table that is too wide is split into several that begin with the same column; one that is too
// long for paper is left to its file.
data TableData(const Table& table, bool is_on_paper) {
  const std::vector<PageColumn> columns = PageColumns(table);
  const auto grid_of = [&](const auto& block) { return GridData(table, columns, block); };
  return object{
      {"title", table.title},
      {"note", IfAny(table.note)},
      {"is_open", table.is_open},
      {"left_to", IfAny(is_on_paper ? "" : Joined({"csv/", table.key, ".csv"}))},
      {"num_rows", CountText(table.rows.size()) + (table.rows.size() == 1 ? " row" : " rows")},
      {"grids", ListOf(TableBlocks(table), grid_of)}};
}

// The class of a figure that is too long to be as large as others: so many digits fit into a card.
std::string FigureSize(const CellText& text) {
  constexpr double kMostLarge = 8.0;
  constexpr double kMostUsual = 12.0;
  if (!text.is_number) return " words";
  double num_digits = 0.0;
  for (const char letter : text.value) {
    const bool is_narrow = letter == ',' || letter == '.';
    // NumberHtml() puts "×10" for "e".
    num_digits += is_narrow ? 0.5 : letter == 'e' ? 3.0 : 1.0;
  }
  if (num_digits <= kMostLarge) return " number";
  return num_digits <= kMostUsual ? " number long" : " number longest";
}

data HeadlineData(const Headline& headline) {
  const CellText text = TextOf(headline.value);
  return object{{"title", headline.title},
                {"figure_size", FigureSize(text)},
                {"unit", IfAny(text.is_absent ? "" : headline.unit)},
                {"is_number", text.is_number},
                {"is_absent", text.is_absent},
                {"grade", GradeData(headline.value)},
                {"number", NumberHtml(text.value)},
                {"words", text.value},
                {"interval", NumberHtml(text.interval)},
                {"has_both", !text.interval.empty() && !text.samples.empty()},
                {"samples", text.samples}};
}

// A PNG as the URL that a page shows without asking for anything.
std::string PngUrl(const std::string& png) {
  using namespace boost::archive::iterators;
  using Letters = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string url = "data:image/png;base64,";
  url.append(Letters(png.begin()), Letters(png.end()));
  return url.append((3 - png.size() % 3) % 3, '=');
}

data PictureData(const Picture& picture, const std::map<std::string, std::string>& drawn) {
  const auto png = drawn.find(picture.key);
  return object{{"title", picture.title},
                {"caption", IfAny(picture.caption)},
                {"width", std::to_string(picture.width_px)},
                {"height", std::to_string(picture.height_px)},
                {"url", png == drawn.end() ? data(false) : data(PngUrl(png->second))}};
}

// The drawing from the attributes of its <svg> element on; the template writes the tag.
data DrawingData(const Chart& chart, const std::map<std::string, std::string>& drawn) {
  const auto svg = drawn.find(chart.key);
  if (svg == drawn.end()) return false;
  return svg->second.substr(svg->second.find("<svg") + 4);
}

data SectionData(const Section& section,
                 const std::map<std::string, std::string>& drawn,
                 const std::set<std::string>& on_paper) {
  const auto chart_data = [&](const Chart& chart) {
    return object{{"title", chart.title},
                  {"caption", IfAny(chart.caption.text)},
                  {"drawing", DrawingData(chart, drawn)}};
  };
  const auto table_data = [&](const Table& table) {
    return TableData(table, on_paper.contains(table.key));
  };
  const auto picture_data = [&](const Picture& picture) { return PictureData(picture, drawn); };
  return object{{"key", section.key},
                {"title", section.title},
                {"paragraphs", ListOf(section.paragraphs, [](const auto& text) { return text; })},
                {"pictures", ListOf(section.pictures, picture_data)},
                {"has_charts", !section.charts.empty()},
                {"charts", ListOf(section.charts, chart_data)},
                {"tables", ListOf(section.tables, table_data)}};
}

// The colours of charts as they occur in the drawings, with the style sheet's names for them.
list Paints() {
  list paints = {object{{"color", kGridColor}, {"name", "grid"}},
                 object{{"color", kMutedColor}, {"name", "muted"}}};
  for (std::size_t i = 0; i < kSeriesColors.size(); ++i) {
    paints.push_back(
        object{{"color", kSeriesColors[i]}, {"name", "series-" + std::to_string(i + 1)}});
  }
  return paints;
}

}  // namespace

std::string ReportPage(const Report& report, const std::map<std::string, std::string>& drawn) {
  const auto fact_data = [](const auto& fact) {
    return object{{"name", fact.first}, {"fact", fact.second}};
  };
  const std::set<std::string> on_paper = TablesOnPaper(report);
  const auto section_data = [&](const Section& section) {
    return SectionData(section, drawn, on_paper);
  };
  kainjow::mustache::mustache page(kPageHtml);
  Check(page.is_valid(), "the page's template is sound");
  return page.render(object{{"title", report.title},
                            {"style", kPageCss},
                            {"paints", Paints()},
                            {"facts", ListOf(report.facts, fact_data)},
                            {"has_headlines", !report.headlines.empty()},
                            {"headlines", ListOf(report.headlines, HeadlineData)},
                            {"sections", ListOf(report.sections, section_data)},
                            {"command", IfAny(report.command)}});
}

}  // namespace railcast
