#include "analysis/frontier/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "tests/analysis/made_results.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<RowResult> Results() {
  return {MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0),
          MadeResult("footprint", RowGroup::kLadder, 4.0, 5),
          MadeResult("surface", RowGroup::kLadder, 1.25, 40),
          MadeResult("brute_force_7", RowGroup::kBruteForce, 4.0, 20)};
}

std::filesystem::path WriteScript(const TemporaryFolder& folder, const std::string& text) {
  return folder.Write("a chart's script.gnuplot", text);
}

TEST(ChartScript, DrawsOurRungsFromLeftToRight) {
  EXPECT_THAT(ChartScript(Results(), "title"), HasSubstr("$ladder << EOD\n1.25 40\n4 5\nEOD\n"));
}

TEST(ChartScript, CallsBruteForceByItsRays) {
  EXPECT_THAT(ChartScript(Results(), "title"), HasSubstr("set label '7' at 4,20 "));
}

TEST(ChartScript, QuotesTheTitle) {
  EXPECT_THAT(ChartScript(Results(), R"(a "b" \c, it's `d`)"),
              HasSubstr(R"(title 'a "b" \c, it''s `d`')"));
}

TEST(DrawChart, MakesAPngAndAnSvg) {
  const TemporaryFolder folder;
  const auto script = WriteScript(folder, ChartScript(Results(), "it's a title"));
  const auto picture = script.parent_path() / "it's a picture";
  DrawChart(script, picture);
  EXPECT_THAT(ReadFileWhole(picture.string() + ".png"), StartsWith("\x89PNG\r\n"));
  const std::string svg = ReadFileWhole(picture.string() + ".svg");
  EXPECT_THAT(svg, StartsWith("<?xml"));
  EXPECT_THAT(svg, HasSubstr("second surfaces missed, %"));
  EXPECT_THAT(svg, HasSubstr("it's a title"));
}

TEST(DrawChart, SaysThatGnuplotFailed) {
  const TemporaryFolder folder;
  const auto script = WriteScript(folder, "plot nonsense nonsense\n");
  try {
    DrawChart(script, script.parent_path() / "frontier");
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "gnuplot: failed (the numbers are written)");
  }
}

}  // namespace
}  // namespace railcast
