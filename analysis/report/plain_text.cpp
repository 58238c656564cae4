#include "analysis/report/formats.h"

#include <algorithm>
#include <sstream>

#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kTableWidth = 160;
constexpr const char* kGap = "  ";

// Counts characters rather than bytes: only the bytes that begin a UTF-8 character.
std::size_t WidthOf(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::string Padded(const std::string& text, std::size_t width, bool is_on_the_right) {
  const std::string spaces(width - std::min(width, WidthOf(text)), ' ');
  return is_on_the_right ? spaces + text : text + spaces;
}

std::string Underlined(const std::string& text, char line) {
  return Joined({text, "\n", std::string(WidthOf(text), line), "\n"});
}

// Wraps text at spaces.
std::string Paragraph(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t width = 0;
  for (std::string word; words >> word;) {
    const std::size_t added = WidthOf(word);
    if (width > 0 && width + 1 + added > kWidth) {
      lines += '\n';
      width = 0;
    }
    if (width > 0) lines += ' ';
    lines += word;
    width += added + (width > 0 ? 1 : 0);
  }
  return lines += '\n';
}

// One column of a table, formatted: all cells have the same width.
struct TextColumn {
  std::string title;
  bool is_number = false;
  std::vector<std::string> cells;
};

// The parts of estimates are aligned separately.
TextColumn ColumnOf(const Table& table, std::size_t index) {
  TextColumn column;
  column.title = WithUnit(table.columns[index].title, table.columns[index].unit);
  std::vector<CellText> texts;
  std::size_t value_width = 0, interval_width = 0, samples_width = 0;
  for (const std::vector<Cell>& row : table.rows) {
    texts.push_back(TextOf(row[index]));
    const CellText& text = texts.back();
    column.is_number = column.is_number || text.is_number;
    if (text.is_absent) continue;
    value_width = std::max(value_width, WidthOf(text.value));
    interval_width = std::max(interval_width, WidthOf(text.interval));
    samples_width = std::max(samples_width, WidthOf(text.samples));
  }
  for (const CellText& text : texts) {
    if (text.samples.empty() || text.is_absent) {
      column.cells.push_back(LineOf(text));
      continue;
    }
    // The comma follows the interval, or the value where there is none.
    const std::string interval = text.interval.empty() ? "" : Joined({" ", text.interval});
    column.cells.push_back(Joined({Padded(text.value, value_width, true),
                                   Padded(Joined({interval, ","}), interval_width + 2, false), " ",
                                   Padded(text.samples, samples_width, false)}));
  }
  return column;
}

std::size_t WidthOf(const TextColumn& column) {
  std::size_t width = WidthOf(column.title);
  for (const std::string& cell : column.cells) width = std::max(width, WidthOf(cell));
  return width;
}

// One block of a table, its columns side by side.
std::string ColumnsText(const std::vector<TextColumn>& columns) {
  std::vector<std::string> lines(columns.empty() ? 0 : columns[0].cells.size() + 1);
  for (const TextColumn& column : columns) {
    const std::size_t width = WidthOf(column);
    lines[0] += Joined({kGap, Padded(column.title, width, column.is_number)});
    for (std::size_t row = 0; row < column.cells.size(); ++row) {
      lines[row + 1] += Joined({kGap, Padded(column.cells[row], width, column.is_number)});
    }
  }
  std::string text;
  for (const std::string& line : lines) {
    text += line.substr(0, line.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string TableText(const Table& table) {
  std::vector<TextColumn> columns;
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    columns.push_back(ColumnOf(table, i));
    widths.push_back(WidthOf(columns.back()) + WidthOf(kGap));
  }
  std::string text;
  for (const std::vector<std::size_t>& block : BlocksOf(widths, kTableWidth)) {
    std::vector<TextColumn> shown;
    for (const std::size_t i : block) shown.push_back(columns[i]);
    text += Joined({text.empty() ? "" : "\n", ColumnsText(shown)});
  }
  return Joined({table.title, "\n", table.note.empty() ? "" : Paragraph(table.note), text});
}

std::string PairsText(const std::vector<std::pair<std::string, std::string>>& pairs) {
  std::size_t width = 0;
  for (const auto& [name, value] : pairs) width = std::max(width, WidthOf(name));
  std::string text;
  for (const auto& [name, value] : pairs) {
    text += Joined({kGap, Padded(name, width, false), kGap, value, "\n"});
  }
  return text;
}

}  // namespace

std::vector<std::vector<std::size_t>> BlocksOf(const std::vector<std::size_t>& widths,
                                               std::size_t max_width) {
  std::vector<std::vector<std::size_t>> blocks(1);
  std::size_t width = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (blocks.back().size() > 1 && width + widths[i] > max_width) {
      blocks.push_back({0});
      width = widths[0];
    }
    blocks.back().push_back(i);
    width += widths[i];
  }
  return blocks;
}

std::string HeadlinesText(const Report& report) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const Headline& headline : report.headlines) {
    lines.emplace_back(WithUnit(headline.title, headline.unit), LineOf(TextOf(headline.value)));
  }
  return PairsText(lines);
}

std::string ReportText(const Report& report) {
  std::string text = Joined({Underlined(report.title, '='), PairsText(report.facts),
                             report.headlines.empty() ? "" : "\n", HeadlinesText(report)});
  for (const Section& section : report.sections) {
    text += Joined({"\n", Underlined(section.title, '-')});
    for (const std::string& paragraph : section.paragraphs) text += Paragraph(paragraph);
    for (const Table& table : section.tables) text += Joined({"\n", TableText(table)});
  }
  return text;
}

}  // namespace railcast
