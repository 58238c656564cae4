#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;

/// Writes a scenario with one of the shipped sensors.
std::string WriteSensorScenario(const TemporaryFolder& folder, const std::string& sensor) {
  const std::string scenarios = ScenariosDir().string();
  return folder
      .Write("sensor.json", R"({"version": 1, "file": ")" + scenarios +
                                R"(/minimal.json", "fidelity": "surface", "lidar": {"file": ")" +
                                scenarios + "/sensors/" + sensor + R"(.json"}})")
      .string();
}

const std::string kVlp16Capture = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp16_dual.pcap";

TEST(PresetCommand, WritesAReportOfACapture) {
  if (!std::filesystem::exists(kVlp16Capture)) GTEST_SKIP() << kVlp16Capture << " is not there";
  const TemporaryFolder folder;
  const std::string scenario = WriteSensorScenario(folder, "vlp16");
  const auto out = std::filesystem::path(scenario).parent_path() / "out";
  const Ended run = Analyze("preset " + kVlp16Capture + " --scenario " + scenario +
                            " --sectors odd --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const nlohmann::json report = nlohmann::json::parse(ReadFileWhole(out / "preset.json"));
  EXPECT_EQ(report.at("facts").at("Recording"), "capture of VLP-16");
  EXPECT_EQ(report.at("facts").at("Turns"), "4");
  EXPECT_EQ(report.at("headlines").size(), 9U);
  EXPECT_TRUE(exists(out / "report.html"));
  EXPECT_TRUE(exists(out / "csv" / "preset_by_range.csv"));
}

TEST(PresetCommand, GivesTheSameReportOnAnyNumberOfThreads) {
  if (!std::filesystem::exists(kVlp16Capture)) GTEST_SKIP() << kVlp16Capture << " is not there";
  const TemporaryFolder folder;
  const std::string scenario = WriteSensorScenario(folder, "vlp16");
  const auto text = [&](const std::string& threads) {
    const std::string said = Analyze("preset " + kVlp16Capture + " --scenario " + scenario +
                                     " --format text --threads " + threads)
                                 .said;
    // The command line, which names the number of threads, stands in the first lines.
    return said.substr(said.find("Error of points"));
  };
  EXPECT_EQ(text("1"), text("3"));
}

TEST(PresetCommand, RefusesASensorThatDoesNotFit) {
  if (!std::filesystem::exists(kVlp16Capture)) GTEST_SKIP() << kVlp16Capture << " is not there";
  const TemporaryFolder folder;
  const Ended run = Analyze("preset " + kVlp16Capture + " --scenario " +
                            WriteSensorScenario(folder, "vls128") + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("must have the 128 rings of the scenario's sensor (got 16)"));
}

}  // namespace
}  // namespace railcast
