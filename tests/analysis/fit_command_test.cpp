#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

const std::string kVlp16 = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp16_dual.pcap";

/// Twelve frames on rung plausibility in heavy rain.
std::filesystem::path MakeSequence(const TemporaryFolder& folder) {
  const auto scenario = WriteScenario(folder, R"("weather": {"rain_rate_mmph": 40},)");
  const auto out = scenario.parent_path() / "sequence";
  const Ended run = RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --out " +
                               out.string() + " --frames 12");
  if (run.status != 0) throw std::runtime_error(run.said);
  return out;
}

Json RowOf(const Json& report, const std::string& table_key, const std::string& title) {
  for (const Json& section : report.at("sections")) {
    for (const Json& table : section.at("tables")) {
      if (table.at("key") != table_key) continue;
      for (const Json& row : table.at("rows")) {
        if (row.front() == title || row.value("parameter", "") == title) return row;
      }
    }
  }
  throw std::out_of_range(title);
}

TEST(FitCommand, WritesAScenarioOfWhatItFound) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder);
  const auto out = sequence.parent_path() / "out";
  const Ended run =
      Analyze("fit " + sequence.string() + " --rain-rate-mmph 40 --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;

  const Json fitted = Json::parse(ReadFileWhole(out / "fitted.json"));
  const Json& published = fitted.at("lidar").at("plausibility");
  // 9,600 firings a hundred: noise to a few per cent.
  EXPECT_NEAR(published.at("noise_sigma0_m").get<double>(), 0.01, 0.001);
  EXPECT_EQ(published.at("noise_shape"), "isotropic");
  EXPECT_NEAR(fitted.at("weather").at("rain_dropout_per_m").get<double>(), 3.65e-4, 1.5e-4);
  EXPECT_EQ(published.count("dropout_probability"), 1U);
  double ballast = 0.0;
  for (const Json& material : fitted.at("materials")) {
    if (material.at("name") == "ballast") ballast = material.at("reflectivity");
  }
  EXPECT_NEAR(ballast, 0.18, 1e-4);
  const Ended check =
      RunCommand(RAILCAST_GENERATE " check " + (out / "fitted_scenario.json").string());
  EXPECT_EQ(check.status, 0) << check.said;
  EXPECT_TRUE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(out / "charts" / "noise.svg"));
  EXPECT_TRUE(std::filesystem::exists(out / "csv" / "parameters.csv"));
}

TEST(FitCommand, GivesTheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder);
  const auto out = sequence.parent_path() / "out";
  std::string first;
  for (const char* threads : {"1", "2", "5"}) {
    const Ended run =
        Analyze("fit " + sequence.string() + " --threads " + threads + " --out " + out.string());
    ASSERT_EQ(run.status, 0) << run.said;
    nlohmann::json fit = nlohmann::json::parse(ReadFileWhole(out / "fit.json"));
    fit.erase("command");  // Names the number.
    const std::string bytes = fit.dump() + ReadFileWhole(out / "fitted_scenario.json");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads;
  }
}

TEST(FitCommand, RefusesOptionsThatWouldDoNothing) {
  const TemporaryFolder folder;
  const std::string sequence = MakeSequence(folder).string();
  Ended run = Analyze("fit " + sequence + " --format text --range-at-10-percent-m 100");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("must come with --intensity none"));
  run = Analyze("fit " + sequence + " --format text --intensity none --known marble=0.5");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("--known: no trial meets such a surface (got marble)"));
  run = Analyze("fit " + sequence + " --format text --intensity none --known ballast=dark");
  EXPECT_THAT(
      run.said,
      HasSubstr("--known: must be NAME=REFLECTANCE, the reflectance > 0 (got ballast=dark)"));
  run = Analyze("fit " + sequence + " --format text --rung surface --rain-rate-mmph 5");
  EXPECT_THAT(run.said, HasSubstr("--rain-rate-mmph: must come with rung plausibility"));
  EXPECT_EQ(Analyze("fit " + sequence + " --rung footprint --format text").status, 2);
}

// A wall of a workshop, 6.3 m off, seen by a real VLP-16.
const char* const kWall = R"({"version": 1, "planes": [{
  "name": "wall", "point_m": [-2.91, -6.25, 1.12], "normal": [0.03, 1.0, 0.01],
  "corners_m": [[-3.56, -6.24, 1.77], [-2.26, -6.27, 1.77],
                [-2.26, -6.26, 0.48], [-3.56, -6.22, 0.48]]
}]})";

TEST(FitCommand, FindsNoiseAndDropoutOfARealSensorOnAWall) {
  if (!std::filesystem::exists(kVlp16)) GTEST_SKIP() << "no " << kVlp16;
  const TemporaryFolder folder;
  const std::string planes = folder.Write("planes.json", kWall).string();
  const auto out = std::filesystem::path(planes).parent_path() / "out";
  const Ended run = Analyze("fit " + kVlp16 + " --planes " + planes + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const Json report = Json::parse(ReadFileWhole(out / "fit.json"));
  // Its data sheet says 3 cm at most; on walls others found about 1 cm.
  const Json noise = RowOf(report, "parameters", "Noise, whatever range and signal");
  EXPECT_GT(noise.at("value").at("value").get<double>(), 0.003);
  EXPECT_LT(noise.at("value").at("value").get<double>(), 0.02);
  const Json threshold = RowOf(report, "parameters", "Range at 10 %");
  EXPECT_TRUE(threshold.at("value").at("value").is_null());
  EXPECT_THAT(threshold.at("remark").get<std::string>(),
              HasSubstr("no beam is lost to the threshold"));
}

TEST(FitCommand, WantsTruthOrPlanes) {
  if (!std::filesystem::exists(kVlp16)) GTEST_SKIP() << "no " << kVlp16;
  const Ended run = Analyze("fit " + kVlp16 + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(
      run.said,
      HasSubstr("must have truth fields or labels, or planes given with --planes (got neither)"));
}

}  // namespace
}  // namespace railcast
