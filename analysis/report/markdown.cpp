#include "analysis/report/cell_text.h"
#include "analysis/report/formats.h"

namespace railcast {
namespace {

// Text without a meaning in Markdown, on one line.
std::string EscapedText(std::string_view text) {
  constexpr std::string_view kMarks = "\\`*_{}[]<>&#|~$";
  std::string plain;
  for (const char letter : text) {
    if (kMarks.find(letter) != std::string_view::npos) plain += '\\';
    plain += letter == '\n' ? ' ' : letter;
  }
  return plain;
}

std::string LineText(const std::string& name, const std::string& value) {
  return Joined({"- **", EscapedText(name), "**: ", EscapedText(value), "\n"});
}

std::string GridText(const Table& table) {
  std::string head = "|", rule = "|", rows;
  for (const TableColumn& column : table.columns) {
    head += Joined({" ", EscapedText(WithUnit(column.title, column.unit)), " |"});
    rule += " --- |";
  }
  for (const std::vector<Cell>& row : table.rows) {
    rows += "|";
    for (const Cell& cell : row) rows += Joined({" ", EscapedText(LineOf(TextOf(cell))), " |"});
    rows += "\n";
  }
  return Joined({head, "\n", rule, "\n", rows});
}

std::string MarkdownTable(const Table& table) {
  if (!table.is_open)
    return Joined({"\n[", EscapedText(table.title), "](csv/", table.key, ".csv)\n"});
  return Joined({"\n### ", EscapedText(table.title), "\n\n", EscapedText(table.note),
                 table.note.empty() ? "" : "\n\n", GridText(table)});
}

// The text of a chart or a picture.
template <typename Drawing>
std::string DrawingText(const Drawing& drawing, const std::string& caption) {
  return Joined({"\n![", EscapedText(drawing.title), "](charts/", drawing.key, ".png)\n\n",
                 EscapedText(caption), caption.empty() ? "" : "\n"});
}

}  // namespace

std::string ReportMarkdown(const Report& report) {
  std::string text = Joined({"# ", EscapedText(report.title), "\n\n"});
  for (const auto& [name, value] : report.facts) text += LineText(name, value);
  for (const Headline& headline : report.headlines) {
    text += LineText(WithUnit(headline.title, headline.unit), LineOf(TextOf(headline.value)));
  }
  for (const Section& section : report.sections) {
    text += Joined({"\n## ", EscapedText(section.title), "\n"});
    for (const std::string& paragraph : section.paragraphs) {
      text += Joined({"\n", EscapedText(paragraph), "\n"});
    }
    for (const Picture& picture : section.pictures) {
      text += DrawingText(picture, picture.caption);
    }
    for (const Chart& chart : section.charts) text += DrawingText(chart, chart.caption.text);
    for (const Table& table : section.tables) text += MarkdownTable(table);
  }
  return text;
}

}  // namespace railcast
