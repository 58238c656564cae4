#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using PlainJson = nlohmann::json;

TEST(RailcastAnalyze, KnowsItsVersionAndItsUse) {
  EXPECT_THAT(Analyze("--version").said, testing::StartsWith("railcast " RAILCAST_VERSION));
  EXPECT_THAT(Analyze("frontier --help").said, HasSubstr("--rows"));
  EXPECT_EQ(Analyze("").status, 2);
  EXPECT_EQ(Analyze("frontier").status, 2);
  EXPECT_EQ(Analyze("frontier a.json --out b --frames 0").status, 2);
}

TEST(RailcastAnalyze, TakesDecimalDigitsAloneForNumbers) {
  const auto fault_of = [](const std::string& arguments) {
    const Ended run = Analyze(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    return run.said.substr(0, run.said.find('\n'));
  };
  EXPECT_EQ(fault_of("frontier a.json --out b --frames 0x10"),
            "--frames: must be a whole number from 1 to 1000 (got 0x10)");
  EXPECT_EQ(fault_of("compare --ablate a.json --out b --seed -1"),
            "--seed: must be a whole number from 0 to 18446744073709551615 (got -1)");
  EXPECT_EQ(fault_of("receive --frames 1.5"),
            "--frames: must be a whole number from 1 to 18446744073709551615 (got 1.5)");
  EXPECT_EQ(fault_of("detect a --out b --points 1e3"),
            "--points: must be a whole number from 1 to 1000000 (got 1e3)");
  for (const std::string command : {"stats a", "fit a", "compare a b", "frontier a"}) {
    EXPECT_EQ(fault_of(command + " --out b --threads +1"),
              "--threads: must be a whole number from 0 to 1024 (got +1)");
  }
}

TEST(RailcastAnalyze, NamesAMisspeltCommandAndAnOptionWithoutAName) {
  EXPECT_THAT(Analyze("stat a").said,
              HasSubstr("unknown command, the nearest is \"stats\" (got stat)\n"));
  EXPECT_EQ(Analyze("stat a").status, 2);
  EXPECT_THAT(Analyze("stats a --out ''").said, HasSubstr("--out: must not be empty\n"));
  EXPECT_EQ(Analyze("stats a --out ''").status, 2);
}

TEST(RailcastAnalyze, NamesAnUnknownRowAndAMissingScenario) {
  EXPECT_EQ(Analyze("frontier a.json --out /tmp/none --rows best").status, 1);
  const Ended missing = Analyze("frontier /no/such.json --out /tmp/none");
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.said, HasSubstr("/no/such.json"));
}

TEST(RailcastAnalyze, ChartsAScenario) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder, "", "1.0");
  const auto out = scenario.parent_path() / "out";
  const Ended run = Analyze("frontier " + scenario.string() + " --out " + out.string() +
                            " --frames 1 --rows footprint,brute_force_4");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("fidelity auto uses "));
  const PlainJson json = PlainJson::parse(ReadFileWhole(out / "frontier.json"));
  ASSERT_EQ(json["rows"].size(), 3U);
  // Brute force with 4 rays misses more wires than the closed forms do.
  EXPECT_GT(json["rows"][2]["errors"]["thin_recall"]["num"], 0);
  EXPECT_GT(json["rows"][1]["errors"]["thin_recall"]["share"],
            json["rows"][2]["errors"]["thin_recall"]["share"]);
  ASSERT_EQ(json["sections"][0]["charts"].size(), 4U);
  // Only rows that were run stand in the legend.
  const PlainJson& series = json["sections"][0]["charts"][0]["series"];
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0]["title"], "railcast");
  EXPECT_EQ(series[1]["title"], "brute force, rays a beam");
  for (const char* name : {"frontier.csv", "frontier.png", "frontier.svg", "frontier.gnuplot",
                           "report.html", "csv/found.csv", "charts/range_median_mm.svg",
                           "csv/by_range.csv", "charts/missed_percent_by_range.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  }
}

TEST(RailcastAnalyze, LeavesTheNumbersWhereGnuplotIsMissing) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder, "", "2.0");
  const auto out = scenario.parent_path() / "out";
  const Ended run = RunCommand("PATH=/nowhere " RAILCAST_ANALYZE " frontier " + scenario.string() +
                               " --out " + out.string() + " --frames 1 --rows geometry");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, testing::EndsWith("gnuplot: not found; install gnuplot-nox (the numbers "
                                          "are written)\n"));
  EXPECT_TRUE(std::filesystem::exists(out / "frontier.json"));
  EXPECT_FALSE(std::filesystem::exists(out / "frontier.png"));
}

// Of PCL's libraries, those that read files, draw or register depend on VTK, which is most of what
// a user would install, or take longer to load than a short report takes to be made.
TEST(RailcastAnalyze, LoadsOfPclOnlyWhatNeedsNoFurtherPackages) {
  const Ended run = RunCommand("ldd " RAILCAST_ANALYZE);
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.said.find("libembree"), std::string::npos) << run.said;
  EXPECT_NE(run.said.find("libpcl_common"), std::string::npos) << run.said;
  for (const std::string library :
       {"libpcl_io", "libpcl_filters", "libpcl_features", "libpcl_segmentation",
        "libpcl_registration", "libpcl_visualization", "libvtk", "libgdal"}) {
    EXPECT_EQ(run.said.find(library), std::string::npos) << run.said;
  }
}

}  // namespace
}  // namespace railcast
