#include <algorithm>
#include <limits>

#include "analysis/report/cell_text.h"
#include "analysis/report/formats.h"

namespace railcast {
namespace {

// Width of a page in letters of a wide font, which take 0.6 of its size: printed, 186 mm of 7.5
// points; on a screen of 1300 pixels, 966 of 13.
constexpr std::size_t kPaperWidth = 118;
// Longer words are broken.
constexpr std::size_t kLongWord = 24;
// Longer texts of several words become several lines.
constexpr std::size_t kWordsWidth = 36;
// Gap between two cells in letters.
constexpr std::size_t kCellGap = 2;
// In lines of a table: a page of A4 has about 58. Two of the ten pages are reserved for the gaps
// that page breaks leave.
constexpr std::size_t kPageLines = 58;
constexpr std::size_t kReportLines = 8 * kPageLines;
constexpr std::size_t kMaxTableLines = kPageLines;
constexpr std::size_t kHeadLines = 15;
constexpr std::size_t kSectionLines = 5;
constexpr std::size_t kChartLines = 17;  // Two stand side by side.
constexpr std::size_t kPictureLines = 20;
constexpr std::size_t kLeftLines = 2;  // What is left of a table that goes to its file.

std::size_t LongestWord(const std::string& text) {
  std::size_t longest = 0, word = 0;
  for (const char c : text) {
    word = c == ' ' ? 0 : word + 1;
    longest = std::max(longest, word);
  }
  return longest;
}

// Width in letters; headers, which are bold, and words break at spaces.
std::size_t ColumnWidthOf(const Table& table, std::size_t column, const PageColumn& page_column) {
  std::size_t width =
      std::max(table.columns[column].unit.size(), LongestWord(table.columns[column].title) + 1);
  for (const std::vector<Cell>& row : table.rows) {
    const CellText text = TextOf(row[column]);
    const bool is_words = !text.is_number && !text.is_absent;
    const std::size_t length = LineOf(text).size();
    width = std::max(width, is_words ? std::min(length, kWordsWidth) : length);
  }
  return width + (page_column.has_estimates ? 2 : 1) * kCellGap;
}

// Lines of a table that is printed.
std::size_t LinesOf(const Table& table) {
  constexpr std::size_t kHeaderLines = 2;
  return TableBlocks(table).size() * (table.rows.size() + kHeaderLines) +
         table.note.size() / kPaperWidth + 3;
}

// Lines of a section without its tables' rows.
std::size_t LinesOf(const Section& section) {
  // Paragraphs are narrower and larger than tables.
  constexpr std::size_t kParagraphWidth = 100;
  std::size_t lines = kSectionLines + kChartLines * ((section.charts.size() + 1) / 2) +
                      kPictureLines * section.pictures.size() + kLeftLines * section.tables.size();
  for (const std::string& text : section.paragraphs) lines += text.size() / kParagraphWidth + 2;
  return lines;
}

}  // namespace

std::vector<PageColumn> PageColumns(const Table& table) {
  std::vector<PageColumn> columns(table.columns.size());
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      columns[i].is_number = columns[i].is_number || TextOf(row[i]).is_number;
      columns[i].has_estimates =
          columns[i].has_estimates || std::holds_alternative<Estimate>(row[i]);
    }
  }
  return columns;
}

bool HasLongWord(const std::string& text) {
  return LongestWord(text) > kLongWord;
}

std::vector<std::vector<std::size_t>> TableBlocks(const Table& table) {
  const std::vector<PageColumn> columns = PageColumns(table);
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    widths.push_back(ColumnWidthOf(table, i, columns[i]));
  }
  const bool is_scrolled = table.rows.size() > kMaxTableLines;
  return BlocksOf(widths, is_scrolled ? std::numeric_limits<std::size_t>::max() : kPaperWidth);
}

std::set<std::string> TablesOnPaper(const Report& report) {
  std::size_t used = kHeadLines;
  std::vector<const Table*> tables;
  for (const Section& section : report.sections) {
    used += LinesOf(section);
    for (const Table& table : section.tables) tables.push_back(&table);
  }
  std::stable_partition(tables.begin(), tables.end(), [](const Table* t) { return t->is_open; });
  std::set<std::string> printed;
  for (const Table* const table : tables) {
    const std::size_t lines = LinesOf(*table);
    if (lines > kMaxTableLines || used + lines > kReportLines) continue;
    used += lines;
    printed.insert(table->key);
  }
  return printed;
}

}  // namespace railcast
