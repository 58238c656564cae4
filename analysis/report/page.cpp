#include "analysis/report/page.h"

#include "analysis/report/cell_text.h"
#include "analysis/report/html_text.h"
#include "analysis/report/joined.h"
#include "analysis/report/page_style.h"
#include "analysis/report/page_table.h"
#include "analysis/report/svg.h"

namespace railcast {
namespace {

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
                 text.is_absent ? "<dd class=\"absent\">" : "<dd>",
                 text.is_number ? "<span class=\"figure\">" : "<span class=\"figure words\">",
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
