#include "analysis/report/page.h"

#include "analysis/report/cell_text.h"
#include "analysis/report/joined.h"
#include "analysis/report/page_style.h"
#include "analysis/report/svg.h"

namespace railcast {
namespace {

// "<h2>text</h2>", the text escaped.
std::string Element(const std::string& tag, const std::string& text) {
  return Joined({"<", tag, ">", EscapedHtml(text), "</", tag.substr(0, tag.find(' ')), ">"});
}

// Numbers with a real minus sign, which is as wide as a digit, and powers of ten as such:
// "-3e-05" as "−3 × 10<sup>−5</sup>".
std::string NumberHtml(const std::string& numbers) {
  std::string html;
  bool is_power = false;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const char c = numbers[i];
    const bool is_digit = c >= '0' && c <= '9';
    if (c == 'e' && i > 0 && numbers[i - 1] >= '0' && numbers[i - 1] <= '9') {
      html += "\u202f×\u202f10<sup>";
      is_power = true;
    } else if (is_power &&
               (c == '+' || (c == '0' && !(numbers[i - 1] >= '1' && numbers[i - 1] <= '9')))) {
      // "e+09" and "e-05" have more signs than a power needs.
    } else if (is_power && !is_digit && c != '-') {
      html += Joined({"</sup>", std::string_view(&c, 1)});
      is_power = false;
    } else if (c == '-') {
      html += "−";
    } else {
      html += EscapedHtml(std::string(1, c));
    }
  }
  return is_power ? html + "</sup>" : html;
}

std::string UnitHtml(const std::string& unit) {
  if (unit.empty()) return {};
  return Joined({" <span class=\"unit\">", EscapedHtml(unit), "</span>"});
}

std::string HeadHtml(const Report& report) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      // The page can ask nobody for anything, not even for an icon.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n";
  html += Element("title", report.title);
  html += "\n<style>\n" + PageStyle();
  return html += "</style>\n</head>\n";
}

std::string FactsHtml(const Report& report) {
  std::string html = "<dl class=\"facts\">\n";
  for (const auto& [name, fact] : report.facts) {
    html += Joined({"<div>", Element("dt", name), Element("dd", fact), "</div>\n"});
  }
  return html += "</dl>\n";
}

std::string CardHtml(const Headline& headline) {
  const CellText text = TextOf(headline.value);
  const std::string value = text.is_number ? NumberHtml(text.value) : EscapedHtml(text.value);
  const char* const comma = text.interval.empty() || text.samples.empty() ? "" : ", ";
  return Joined({"<div class=\"card\">", Element("dt", headline.title),
                 text.is_absent ? "<dd class=\"absent\">" : "<dd>", "<span class=\"figure\">",
                 value, "</span>", text.is_absent ? "" : UnitHtml(headline.unit),
                 "<span class=\"interval\">", NumberHtml(text.interval), comma,
                 "<span class=\"samples\">", text.samples, "</span></span></dd></div>\n"});
}

std::string CardsHtml(const Report& report) {
  if (report.headlines.empty()) return {};
  std::string html = "<dl class=\"cards\">\n";
  for (const Headline& headline : report.headlines) html += CardHtml(headline);
  return html += "</dl>\n";
}

// A place in the page that no other has: sections and charts have keys of their own.
std::string AnchorOf(const Section& section) {
  return Joined({"section-", EscapedHtml(section.key)});
}

std::string ContentsHtml(const Report& report) {
  std::string html = "<nav aria-label=\"Contents\">\n<ol>\n";
  for (const Section& section : report.sections) {
    html += Joined(
        {"<li><a href=\"#", AnchorOf(section), "\">", EscapedHtml(section.title), "</a></li>\n"});
  }
  return html += "</ol>\n</nav>\n";
}

std::string ChartHtml(const Chart& chart, const std::map<std::string, std::string>& svgs) {
  std::string html = Joined({"<figure>\n", Element("h3", chart.title), "\n"});
  const auto svg = svgs.find(chart.key);
  if (svg != svgs.end()) {
    const std::string label =
        Joined({chart.title, chart.caption.empty() ? "" : ". ", chart.caption});
    const std::string attributes =
        Joined({"class=\"chart\" role=\"img\" aria-label=\"", EscapedHtml(label), "\" "});
    html += Joined({"<div class=\"drawing\">", InlineSvg(svg->second, attributes), "</div>\n"});
  }
  if (!chart.caption.empty()) html += Element("figcaption", chart.caption);
  return html += "\n</figure>\n";
}

// What a column of a table takes in the page.
struct PageColumn {
  bool is_number = false;
  bool has_estimates = false;
};

std::vector<PageColumn> PageColumns(const Table& table) {
  std::vector<PageColumn> columns(table.columns.size());
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      columns[i].is_number = columns[i].is_number || !std::holds_alternative<std::string>(row[i]);
      columns[i].has_estimates =
          columns[i].has_estimates || std::holds_alternative<Estimate>(row[i]);
    }
  }
  return columns;
}

// Estimates take three cells, so that figures, intervals and counts line up.
constexpr const char* kSpan = " colspan=\"3\"";

std::string CellHtml(const Cell& cell, const PageColumn& column, bool is_row_header) {
  const CellText text = TextOf(cell);
  if (is_row_header && !text.is_number) return Element("th scope=\"row\"", text.value);
  const std::string span = column.has_estimates ? kSpan : "";
  if (text.is_absent) {
    return Element("td class=\"absent\"" + span, LineOf(text));
  }
  if (!text.is_number) return Element("td" + span, text.value);
  const std::string number = Joined({"<td class=\"number\">", NumberHtml(text.value), "</td>"});
  if (!column.has_estimates) return number;
  return Joined({number, "<td class=\"interval\">", NumberHtml(text.interval), "</td>",
                 Element("td class=\"samples\"", text.samples)});
}

std::string TableHtml(const Table& table) {
  const std::vector<PageColumn> columns = PageColumns(table);
  std::string html = Joined({"<details>\n<summary>", EscapedHtml(table.title),
                             " <span class=\"rows\">", CountText(table.rows.size()),
                             table.rows.size() == 1 ? " row" : " rows", "</span></summary>\n"});
  if (!table.note.empty()) html += Element("p class=\"note\"", table.note);
  html += Joined({"<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"",
                  EscapedHtml(table.title), "\"><table>\n<thead><tr>"});
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    html += Joined({"<th scope=\"col\"", columns[i].has_estimates ? kSpan : "",
                    columns[i].is_number ? " class=\"number\">" : ">", EscapedHtml(column.title),
                    UnitHtml(column.unit), "</th>"});
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += CellHtml(row[i], columns[i], i == 0);
    html += "</tr>\n";
  }
  return html += "</tbody>\n</table></div>\n</details>\n";
}

std::string SectionHtml(const Section& section, const std::map<std::string, std::string>& svgs) {
  std::string html =
      Joined({"<section id=\"", AnchorOf(section), "\">\n", Element("h2", section.title), "\n"});
  for (const std::string& paragraph : section.paragraphs) html += Element("p", paragraph);
  if (!section.charts.empty()) {
    html += "<div class=\"charts\">\n";
    for (const Chart& chart : section.charts) html += ChartHtml(chart, svgs);
    html += "</div>\n";
  }
  for (const Table& table : section.tables) html += TableHtml(table);
  return html += "</section>\n";
}

}  // namespace

std::string EscapedHtml(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string ReportPage(const Report& report, const std::map<std::string, std::string>& svgs) {
  std::string html = Joined({HeadHtml(report), "<body>\n<header>\n", Element("h1", report.title),
                             "\n", FactsHtml(report), "</header>\n<div class=\"page\">\n",
                             ContentsHtml(report), "<main>\n", CardsHtml(report)});
  for (const Section& section : report.sections) html += SectionHtml(section, svgs);
  html +=
      "</main>\n</div>\n<footer>\n<p>Figures stand before their 95 % confidence interval, in "
      "brackets, and the number of samples, n.</p>\n";
  if (!report.command.empty()) {
    html += Joined({"<p>Made by <code>", EscapedHtml(report.command), "</code></p>\n"});
  }
  return html += "</footer>\n</body>\n</html>\n";
}

}  // namespace railcast
