// A sensor given by an Ouster sensor's metadata in a scenario.
#include <gtest/gtest.h>

#include <fstream>

#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

class OusterPreset : public testing::Test {
 protected:
  /// Reads a scenario whose lidar has these keys.
  [[nodiscard]] ScenarioSpec Read(const std::string& lidar) const {
    return ReadScenarioText(R"({"version": 1, "lidar": )" + lidar + R"(,
      "world": {"alignment": {"course": {"type": "elements",
                "elements": [{"type": "straight", "length_m": 600}]}}},
      "materials": ")" RAILCAST_SOURCE_DIR R"(/scenarios/materials/railway.json",
      "labels": ")" RAILCAST_SOURCE_DIR R"(/scenarios/labels.json"})",
                            file());
  }
  [[nodiscard]] std::string FaultOf(const std::string& lidar) const {
    const std::string message = MessageOf([&] { static_cast<void>(Read(lidar)); });
    const std::string folder = directory_.path().string() + "/";
    std::string shown = message;
    for (std::size_t at = shown.find(folder); at != std::string::npos; at = shown.find(folder)) {
      shown.erase(at, folder.size());
    }
    return shown;
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_.path() / name) << text;
  }
  [[nodiscard]] std::filesystem::path file() const { return directory_.path() / "a.json"; }

 private:
  TemporaryDirectory directory_;
};

TEST_F(OusterPreset, HasTheScanOfTheMetadataAndWhatTheScenarioSays) {
  Write("os.json", MadeOusterMetadataText());
  const LidarSpec lidar =
      Read(R"({"ouster_metadata": "os.json", "range_max_m": 77, "phase_s": 0.02})").lidar;
  EXPECT_EQ(lidar.scan.rate_hz, 10.0);
  EXPECT_EQ(lidar.scan.phase_s, 0.02);
  EXPECT_EQ(std::get<SpinningSpec>(lidar.scan.pattern).channels.size(), 4U);
  EXPECT_EQ(lidar.range_max_m, 77.0);
  EXPECT_EQ(lidar.receiver.range_at_10_percent_m, 55.0);
  EXPECT_EQ(lidar.plausibility.reference_range_m, 55.0);
  EXPECT_EQ(lidar.name, "OS-1-4");
}

TEST_F(OusterPreset, IsWrittenAsItWasGivenAndReadsBack) {
  Write("os.json", MadeOusterMetadataText());
  const ScenarioSpec scenario = Read(R"({"ouster_metadata": "os.json"})");
  const std::string text = ResolvedScenarioJson(scenario);
  EXPECT_EQ(text.find("\"channels\""), std::string::npos) << "they stand in the metadata";
  EXPECT_EQ(ReadScenarioText(text, "/elsewhere/b.json"), scenario);
}

TEST_F(OusterPreset, WithFaultyMetadataSaysWhereTheFaultIs) {
  nlohmann::ordered_json metadata = MadeOusterMetadata();
  metadata["config_params"].erase("lidar_mode");
  Write("os.json", metadata.dump());
  EXPECT_EQ(FaultOf(R"({"ouster_metadata": "os.json"})"),
            "os.json: /config_params/lidar_mode: missing");
  Write("os.json", "{");
  EXPECT_EQ(FaultOf(R"({"ouster_metadata": "os.json"})").substr(0, 9), "os.json: ");
  EXPECT_EQ(FaultOf(R"({"ouster_metadata": "none.json"})"),
            "a.json: /lidar/ouster_metadata: no such file (got \"none.json\")");
  EXPECT_EQ(FaultOf("{}"), "a.json: /lidar/scan: missing");
}

TEST_F(OusterPreset, TakesThePlaceOfAScan) {
  Write("os.json", MadeOusterMetadataText());
  const std::string scan = R"("scan": {"rate_hz": 10, "pattern": {"type": "raster",
      "horizontal_fov_deg": 4, "vertical_fov_deg": 2, "angular_resolution_deg": 1}})";
  EXPECT_EQ(FaultOf(R"({"ouster_metadata": "os.json", )" + scan + "}").substr(0, 66),
            "a.json: /lidar/scan: must be left out with ouster_metadata (got {\"");
  Write("base.json", R"({"version": 1, )" + scan + "}");
  const LidarSpec lidar = Read(R"({"file": "base.json", "ouster_metadata": "os.json"})").lidar;
  EXPECT_TRUE(std::holds_alternative<SpinningSpec>(lidar.scan.pattern));
}

}  // namespace
}  // namespace railcast
