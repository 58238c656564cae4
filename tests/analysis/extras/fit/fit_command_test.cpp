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
using PlainJson = nlohmann::json;

const std::string kVlp16 = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp16_dual.pcap";

/// Twelve frames with rung plausibility in heavy rain.
std::filesystem::path MakeFitSequence(const TemporaryFolder& folder) {
  static const TemporaryFolder kept;
  static const auto scenario = WriteScenario(kept, R"("weather": {"rain_rate_mmph": 40},)");
  const auto out = folder.Write("scenario.json", "").parent_path() / "sequence";
  GenerateOnce("sequence " + scenario.string() + " --frames 12", out);
  return out;
}

PlainJson RowOf(const PlainJson& report, const std::string& table_key, const std::string& title) {
  for (const PlainJson& section : report.at("sections")) {
    for (const PlainJson& table : section.at("tables")) {
      if (table.at("key") != table_key) continue;
      for (const PlainJson& row : table.at("rows")) {
        if (row.front() == title || row.value("parameter", "") == title) return row;
      }
    }
  }
  throw std::out_of_range(title);
}

TEST(FitCommand, WritesAScenarioOfWhatItFound) {
  const TemporaryFolder folder;
  const auto sequence = MakeFitSequence(folder);
  const auto out = sequence.parent_path() / "out";
  const Ended run =
      Analyze("fit " + sequence.string() + " --rain-rate-mmph 40 --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;

  const PlainJson fitted = PlainJson::parse(ReadFileWhole(out / "fitted.json"));
  // With 11,000 firings the interval reaches about 10 % to either side.
  const double k_per_m = fitted.at("weather").at("rain_dropout_per_m");
  EXPECT_NEAR(k_per_m, 3.65e-4, 5e-5);
  EXPECT_EQ(fitted.at("lidar").at("plausibility").count("dropout_probability"), 1U);
  // The few beams only meet ballast at grazing incidence: the noise stays that of the scenario.
  EXPECT_EQ(fitted.at("lidar").at("plausibility").at("noise_shape"), "isotropic");
  const PlainJson scenario = PlainJson::parse(ReadFileWhole(out / "fitted_scenario.json"));
  EXPECT_EQ(scenario.at("weather").at("rain_dropout_per_m"), k_per_m);
  const Ended check =
      RunCommand(RAILCAST_GENERATE " check " + (out / "fitted_scenario.json").string());
  EXPECT_EQ(check.status, 0) << check.said;
  EXPECT_TRUE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(out / "charts" / "losses.svg"));
  EXPECT_TRUE(std::filesystem::exists(out / "csv" / "parameters.csv"));
}

TEST(FitCommand, GivesTheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto sequence = MakeFitSequence(folder);
  const auto out = sequence.parent_path() / "out";
  std::string first;
  for (const char* threads : {"1", "2", "5"}) {
    const Ended run =
        Analyze("fit " + sequence.string() + " --threads " + threads + " --out " + out.string());
    ASSERT_EQ(run.status, 0) << run.said;
    nlohmann::json fit = nlohmann::json::parse(ReadFileWhole(out / "fit.json"));
    fit.erase("command");  // The command line contains the number of threads.
    const std::string bytes = fit.dump() + ReadFileWhole(out / "fitted_scenario.json");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads;
  }
}

TEST(FitCommand, RefusesOptionsThatWouldDoNothing) {
  const TemporaryFolder folder;
  const std::string sequence = MakeFitSequence(folder).string();
  Ended run = Analyze("fit " + sequence + " --format text --range-at-10-percent-m 100");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("--range-at-10-percent-m: must come with rung surface"));
  run = Analyze("fit " + sequence +
                " --format text --rung surface --intensity none --range-at-10-percent-m 100");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("must come with --intensity reflectance"));
  run = Analyze("fit " + sequence + " --format text --rung surface --rain-rate-mmph 5");
  EXPECT_THAT(run.said, HasSubstr("--rain-rate-mmph: must come with rung plausibility"));
  EXPECT_EQ(Analyze("fit " + sequence + " --rung footprint --format text").status, 2);
}

/// A scenario with the sensor of the capture.
std::string WriteVlp16Scenario(const TemporaryFolder& folder) {
  const std::string scenarios = ScenariosDir().string();
  return folder
      .Write("vlp16.json", R"({"version": 1, "file": ")" + scenarios +
                               R"(/minimal.json", "fidelity": "surface", "lidar": {"file": ")" +
                               scenarios + R"(/sensors/vlp16.json"}})")
      .string();
}

TEST(FitCommand, FindsNoiseAndDropoutOfARealSensor) {
  if (!std::filesystem::exists(kVlp16)) GTEST_SKIP() << "no " << kVlp16;
  const TemporaryFolder folder;
  const auto out = folder.Write("none", "").parent_path() / "out";
  const Ended run = Analyze("fit " + kVlp16 + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const PlainJson report = PlainJson::parse(ReadFileWhole(out / "fit.json"));
  // The data sheet states 3 cm at most; published measurements on walls found about 1 cm.
  const PlainJson floor = RowOf(report, "parameters", "Range noise at high signal");
  EXPECT_GT(floor.at("value").at("value").get<double>(), 0.003);
  EXPECT_LT(floor.at("value").at("value").get<double>(), 0.02);
  const PlainJson dropout = RowOf(report, "parameters", "Dropout probability");
  EXPECT_NEAR(dropout.at("value").at("value").get<double>(), 0.013, 0.005);
  const PlainJson scale = RowOf(report, "parameters", "Range noise scale");
  EXPECT_TRUE(scale.at("value").at("value").is_null());
  EXPECT_THAT(scale.at("remark").get<std::string>(), HasSubstr("the signal is not known"));
  EXPECT_TRUE(std::filesystem::exists(out / "charts" / "noise.svg"));
  // What was not replayed belongs into no scenario.
  EXPECT_FALSE(std::filesystem::exists(out / "fitted.json"));
}

TEST(FitCommand, ReplaysWhatItFoundInACaptureAndSaysWhatIsWorse) {
  if (!std::filesystem::exists(kVlp16)) GTEST_SKIP() << "no " << kVlp16;
  const TemporaryFolder folder;
  const std::string scenario = WriteVlp16Scenario(folder);
  const auto out = std::filesystem::path(scenario).parent_path() / "out";
  const Ended run = Analyze("fit " + kVlp16 + " --scenario " + scenario + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const PlainJson report = PlainJson::parse(ReadFileWhole(out / "fit.json"));
  const PlainJson fitted = PlainJson::parse(ReadFileWhole(out / "fitted_scenario.json"));
  int num_judged = 0;
  for (const PlainJson& row : report.at("sections").at(0).at("tables").at(0).at("rows")) {
    const std::string verdict = row.at("verdict");
    if (verdict.empty()) continue;
    ++num_judged;
    const PlainJson& written =
        fitted.at(PlainJson::json_pointer("/" + row.at("key").get<std::string>()));
    EXPECT_EQ(written == row.at("scenario"), verdict == "worse: not written") << row;
  }
  EXPECT_GE(num_judged, 2);
  const Ended check =
      RunCommand(RAILCAST_GENERATE " check " + (out / "fitted_scenario.json").string());
  EXPECT_EQ(check.status, 0) << check.said;
}

TEST(FitCommand, RefusesAScenarioOfASensorWithOtherRings) {
  if (!std::filesystem::exists(kVlp16)) GTEST_SKIP() << "no " << kVlp16;
  const Ended run = Analyze("fit " + kVlp16 + " --format text --scenario " +
                            (ScenariosDir() / "brake_wagon.json").string());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("rings of the scenario's sensor (got 16)"));
}

TEST(FitCommand, RefusesAScenarioBesideThatOfASequence) {
  const TemporaryFolder folder;
  const std::string sequence = MakeFitSequence(folder).string();
  const Ended run = Analyze("fit " + sequence + " --format text --scenario mine.json");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("--scenario: must be left out for sequences, which have their "
                                  "own (got mine.json)"));
}

}  // namespace
}  // namespace railcast
