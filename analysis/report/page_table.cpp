#include "analysis/report/page_table.h"

#include <algorithm>
#include <numeric>

#include "analysis/report/cell_text.h"
#include "analysis/report/html_text.h"
#include "analysis/report/joined.h"

namespace railcast {
namespace {

// What a page of paper takes, in letters.
constexpr std::size_t kPaperWidth = 150;
// Between two cells, in letters.
constexpr std::size_t kCellGap = 2;

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
  std::string number = Joined({"<td class=\"number\">", NumberHtml(text.value), "</td>"});
  if (!column.has_estimates) return number;
  return Joined({number, "<td class=\"interval\">", NumberHtml(text.interval), "</td>",
                 Element("td class=\"samples\"", text.samples)});
}

// One table of some of the columns.
std::string GridHtml(const Table& table,
                     const std::vector<PageColumn>& columns,
                     const std::vector<std::size_t>& shown) {
  std::string html = "<table>\n<thead><tr>";
  for (const std::size_t i : shown) {
    const TableColumn& column = table.columns[i];
    html += Joined({"<th scope=\"col\"", columns[i].has_estimates ? kSpan : "",
                    columns[i].is_number ? " class=\"number\">" : ">", EscapedHtml(column.title),
                    UnitHtml(column.unit), "</th>"});
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    html += "<tr>";
    for (const std::size_t i : shown) html += CellHtml(row[i], columns[i], i == 0);
    html += "</tr>\n";
  }
  return html += "</tbody>\n</table>\n";
}

// In letters. Headers break at spaces.
std::size_t WidthOf(const Table& table, std::size_t column, const PageColumn& page_column) {
  const std::string& title = table.columns[column].title;
  std::size_t width = table.columns[column].unit.size(), word = 0;
  for (const char c : title) {
    word = c == ' ' ? 0 : word + 1;
    width = std::max(width, word);
  }
  for (const std::vector<Cell>& row : table.rows) {
    width = std::max(width, LineOf(TextOf(row[column])).size());
  }
  return width + (page_column.has_estimates ? 3 : 1) * kCellGap;
}

// The columns of each table on paper; the first comes every time.
std::vector<std::vector<std::size_t>> PaperBlocks(const Table& table,
                                                  const std::vector<PageColumn>& columns) {
  std::vector<std::vector<std::size_t>> blocks(1);
  std::size_t width = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t added = WidthOf(table, i, columns[i]);
    if (blocks.back().size() > 1 && width + added > kPaperWidth) {
      blocks.push_back({0});
      width = WidthOf(table, 0, columns[0]);
    }
    blocks.back().push_back(i);
    width += added;
  }
  return blocks;
}

}  // namespace

std::string TableHtml(const Table& table) {
  const std::vector<PageColumn> columns = PageColumns(table);
  std::string html =
      Joined({table.is_open ? "<details open>" : "<details>", "\n<summary>",
              EscapedHtml(table.title), " <span class=\"rows\">", CountText(table.rows.size()),
              table.rows.size() == 1 ? " row" : " rows", "</span></summary>\n"});
  if (!table.note.empty()) html += Element("p class=\"note\"", table.note);
  const std::vector<std::vector<std::size_t>> blocks = PaperBlocks(table, columns);
  std::vector<std::size_t> all(columns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  html += Joined({"<div class=\"scroll", blocks.size() > 1 ? " screen" : "",
                  "\" tabindex=\"0\" role=\"region\" aria-label=\"", EscapedHtml(table.title),
                  "\">", GridHtml(table, columns, all), "</div>\n"});
  if (blocks.size() > 1) {
    html += "<div class=\"paper\">\n";
    for (const std::vector<std::size_t>& block : blocks) html += GridHtml(table, columns, block);
    html += "</div>\n";
  }
  return html += "</details>\n";
}

}  // namespace railcast
