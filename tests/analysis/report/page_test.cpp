#include "analysis/report/formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/analysis/report/made_report.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string MadePage() {
  return ReportPage(MadeReport(), {{"lines", "<?xml?>\n<svg width=\"1\"><path/></svg>"}});
}

TEST(ReportPage, EscapesWhatUsersName) {
  const std::string page = MadePage();
  EXPECT_THAT(page,
              HasSubstr("<title>Statistics of &lt;out/demo&gt; &amp; &quot;more&quot;</title>"));
  EXPECT_THAT(page, HasSubstr("<dd>VLP-16 &lt;script&gt;alert(1)&lt;/script&gt;</dd>"));
  EXPECT_THAT(page, HasSubstr("no &quot;surface&quot;, &lt;b&gt;bold&lt;/b&gt;</th>"));
  EXPECT_THAT(page,
              HasSubstr("<code>railcast-analyze stats &apos;out/demo&apos; --out &lt;dir&gt;"));
  EXPECT_THAT(page, HasSubstr("Bands are the 95 % intervals &lt;of each&gt;.\""));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
}

TEST(ReportPage, SplitsEstimatesSoThatTheyLineUp) {
  const std::string page = MadePage();
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">12.34</td><td class=\"interval\">[11.90, 12.78]"
                              "</td><td class=\"samples\">n = 4,512</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"col\" colspan=\"3\" class=\"number\">Dropout"));
}

TEST(ReportPage, SaysWhatIsAbsent) {
  const std::string page = MadePage();
  EXPECT_THAT(page, HasSubstr("<td class=\"absent\" colspan=\"3\">not enough (n = 3)</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"absent\">-</td>"));
  // "nan" as a whole word, in any case.
  EXPECT_FALSE(std::regex_search(page, std::regex("\\bnan\\b", std::regex::icase)));
}

TEST(ReportPage, WritesPowersOfTenAsSuch) {
  Report report{.headlines = {{"Small", "bit", Estimate{3.0663e-5, 2.7741e-5, 3.3585e-5, 12}},
                              {"Large", "", -2.5e12}}};
  const std::string page = ReportPage(report, {});
  EXPECT_THAT(page, HasSubstr(">3.07\u202f×\u202f10<sup>−5</sup></span>"));
  EXPECT_THAT(page,
              HasSubstr("[2.77\u202f×\u202f10<sup>−5</sup>, 3.36\u202f×\u202f10<sup>−5</sup>]"));
  EXPECT_THAT(page, HasSubstr(">−2.500\u202f×\u202f10<sup>12</sup></span>"));
}

TEST(ReportPage, AsksForNothingFromAnywhere) {
  const std::string page = MadePage();
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"(?!#|data:)")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
}

TEST(ReportPage, PutsChartsInWithoutTheirFilesHead) {
  const std::string page = MadePage();
  EXPECT_THAT(page, HasSubstr("<svg class=\"chart\" role=\"img\" aria-label=\"Lines keep a gap"));
  EXPECT_THAT(page, Not(HasSubstr("<?xml")));
}

// The examples of RFC 4648, section 10.
TEST(ReportPage, HoldsPicturesThemselves) {
  const std::map<std::string, std::string> examples = {
      {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [png, letters] : examples) {
    EXPECT_THAT(ReportPage(MadeReport(), {{"seen", png}}),
                HasSubstr("<img alt=\"What is &lt;seen&gt;. A line &quot;upwards&quot;.\" "
                          "width=\"200\" height=\"100\" src=\"data:image/png;base64," +
                          letters + "\">"));
  }
  // Without gnuplot there are titles only.
  EXPECT_THAT(ReportPage(MadeReport(), {}), Not(HasSubstr("<img")));
}

TEST(ReportPage, LinksEverySection) {
  const std::string page = MadePage();
  EXPECT_THAT(page, HasSubstr("<a href=\"#section-words\">Words &amp; little else</a>"));
  EXPECT_THAT(page, HasSubstr("<section id=\"section-words\">"));
}

TEST(ReportPage, ShowsTheRowsOfOpenTablesUnasked) {
  Report report;
  const Table open{.key = "a", .title = "First", .columns = {{"x", "X", ""}}, .is_open = true};
  const Table closed{.key = "b", .title = "Second", .columns = {{"x", "X", ""}}};
  report.sections = {{.key = "s", .title = "S", .tables = {open, closed}}};
  const std::string page = ReportPage(report, {});
  EXPECT_THAT(page, HasSubstr("<details open>\n<summary>First"));
  EXPECT_THAT(page, HasSubstr("<details>\n<summary>Second"));
}

// A report of one table with so many rows.
Report ReportOfRows(std::size_t num_rows) {
  Report report;
  Table table{.key = "rows", .title = "Rows", .columns = {{"x", "X", ""}}};
  table.rows.assign(num_rows, {std::uint64_t{1}});
  report.sections = {{.key = "s", .title = "S", .tables = {std::move(table)}}};
  return report;
}

TEST(ReportPage, LeavesLongTablesToTheirFilesOnPaper) {
  EXPECT_THAT(ReportPage(ReportOfRows(200), {}),
              HasSubstr("Rows, 200 rows, not printed: <code>csv/rows.csv</code>"));
  EXPECT_THAT(ReportPage(ReportOfRows(20), {}), Not(HasSubstr("not printed")));
}

TEST(ReportPage, PrintsOpenTablesFirst) {
  Report report{.sections = {{.key = "s", .title = "S"}}};
  for (int i = 0; i < 60; ++i) {
    Table table{.key = "t" + std::to_string(i), .title = "T", .columns = {{"x", "X", ""}}};
    table.rows.assign(20, {std::uint64_t{1}});
    table.is_open = i == 59;
    report.sections[0].tables.push_back(std::move(table));
  }
  const std::string page = ReportPage(report, {});
  EXPECT_THAT(page, Not(HasSubstr("csv/t0.csv")));
  EXPECT_THAT(page, HasSubstr("csv/t58.csv"));
  EXPECT_THAT(page, Not(HasSubstr("csv/t59.csv")));
}

TEST(ReportPage, CanBeOfAnEmptyReport) {
  EXPECT_THAT(ReportPage({}, {}), HasSubstr("</html>"));
}

}  // namespace
}  // namespace railcast
