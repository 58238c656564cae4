#include "core/scenario/ouster_metadata.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <tuple>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/units.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = RAILCAST_SHARED_DATA_DIR "/ouster_more/metadata/metadata";

OusterMetadata ReadShared(const std::string& name) {
  return ParseOusterMetadata(ReadFileWhole(kShared / name));
}

// Firmware 1.12 to 3.0.1, both layouts.
TEST(OusterMetadata, OfEveryFirmwareIsReadAndMakesAScan) {
  if (!exists(kShared)) GTEST_SKIP() << kShared << " is not there";
  int num_files = 0;
  for (const auto& entry : fs::directory_iterator(kShared)) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path());
    LidarSpec lidar;
    ASSERT_NO_THROW(UseOusterMetadata(ReadFileWhole(entry.path()), lidar));
    const ScanPattern pattern = BuildScanPattern(lidar.scan);
    const OusterMetadata metadata = ParseOusterMetadata(ReadFileWhole(entry.path()));
    EXPECT_EQ(pattern.rows, metadata.beams.size());
    EXPECT_EQ(pattern.columns, metadata.num_window_columns());
    EXPECT_EQ(pattern.origin_x_m.size(), pattern.num_firings());
    ++num_files;
  }
  EXPECT_GE(num_files, 26);
}

// The same sensor, 991913000010, which firmware 1.12 did not ask for its beams' origin.
TEST(OusterMetadata, OfOldFirmwareAreCompletedByWhatLaterFirmwareSaysOfTheSensor) {
  if (!exists(kShared)) GTEST_SKIP() << kShared << " is not there";
  const OusterMetadata old = ReadShared("1_12_os1-991913000010-64.json");
  const OusterMetadata late = ReadShared("2_1_2_os1-991913000010-64.json");
  EXPECT_EQ(old.serial_number, late.serial_number);
  EXPECT_EQ(old.pixels_per_column, late.pixels_per_column);
  EXPECT_EQ(old.columns_per_packet, late.columns_per_packet);
  EXPECT_EQ(old.column_window, late.column_window);
  EXPECT_EQ(old.beam_origin_m, late.beam_origin_m);
  EXPECT_EQ(old.profile, OusterProfile::kLegacy);
  ASSERT_EQ(old.beams.size(), late.beams.size());
  EXPECT_EQ(old.beams[7].altitude_deg, late.beams[7].altitude_deg);
  EXPECT_TRUE(old.sensor_from_lidar.isApprox(late.sensor_from_lidar));
}

TEST(OusterMetadata, OfTheTwoLayoutsSayTheSame) {
  if (!exists(kShared)) GTEST_SKIP() << kShared << " is not there";
  for (const std::string name : {"2_1_2_os1-991913000010-64", "2_2_os-992119000444-128",
                                 "2_5_0_os-992146000760-128", "3_0_1_os-122246000293-128"}) {
    SCOPED_TRACE(name);
    const OusterMetadata sections = ReadShared(name + ".json");
    const OusterMetadata flat = ReadShared(name + "_legacy.json");
    EXPECT_EQ(sections.product_line, flat.product_line);
    EXPECT_EQ(sections.serial_number, flat.serial_number);
    EXPECT_EQ(sections.column_window, flat.column_window);
    EXPECT_EQ(sections.profile, flat.profile);
    EXPECT_EQ(sections.beam_origin_m, flat.beam_origin_m);
    ASSERT_EQ(sections.beams.size(), flat.beams.size());
    EXPECT_EQ(sections.beams.back().azimuth_deg, flat.beams.back().azimuth_deg);
  }
}

TEST(OusterMetadata, HaveA16BitReflectivityInLegacyPacketsOfFirmwareBefore2_1) {
  const auto is_wide = [](const char* build, const char* image, const char* profile) {
    auto metadata = MadeOusterMetadata("LEGACY");
    auto& info = metadata["sensor_info"];
    info.erase("image_rev");
    if (build != nullptr) info["build_rev"] = build;
    if (image != nullptr) info["image_rev"] = image;
    metadata["lidar_data_format"].erase("udp_profile_lidar");
    if (profile != nullptr) metadata["lidar_data_format"]["udp_profile_lidar"] = profile;
    return ParseOusterMetadata(metadata.dump()).has_wide_reflectivity;
  };
  for (const char* old : {"v1.12.0", "v1.14.0-beta.1-928-g6cccd78", "v2.0.0", "v2.0.0-rc.2"}) {
    EXPECT_TRUE(is_wide(old, nullptr, nullptr)) << old;
    EXPECT_TRUE(is_wide(old, nullptr, "LEGACY")) << old;
  }
  for (const char* late : {"v2.1.2", "v2.2.0-rc.1", "v2.10.0", "v3.1.0-alpha.1", "v10.0.0"}) {
    EXPECT_FALSE(is_wide(late, nullptr, nullptr)) << late;
  }
  EXPECT_FALSE(is_wide("v2.0.0", nullptr, "RNG19_RFL8_SIG16_NIR16"));
  // Of builds that are numbered by their sources the image says it.
  EXPECT_TRUE(is_wide("767798045", "ousteros-image-prod-aries-v2.0.0+20201124065024", nullptr));
  EXPECT_FALSE(is_wide("035522cb7", "ousteros-image-dev-bootes-v3.2.0-alpha.1", "LEGACY"));
  // Where no firmware is named, the name of a profile is of a later one.
  EXPECT_TRUE(is_wide(nullptr, nullptr, nullptr));
  EXPECT_TRUE(is_wide("dev", "", nullptr));
  EXPECT_FALSE(is_wide(nullptr, nullptr, "LEGACY"));
}

// Of 64 pixels, 16 belong to beams.
TEST(OusterMetadata, LeaveOutPixelsWithoutABeam) {
  if (!exists(kShared)) GTEST_SKIP() << kShared << " is not there";
  const OusterMetadata metadata = ReadShared("1_13_os1-991937000062-16A0_legacy.json");
  EXPECT_EQ(metadata.pixels_per_column, 64U);
  EXPECT_EQ(metadata.beams.size(), 16U);
  EXPECT_GT(metadata.beams.front().pixel, 0U);
}

std::string FaultOfShared(const std::string& name) {
  return MessageOf([&] { static_cast<void>(ReadShared("malformed/" + name)); });
}

TEST(OusterMetadata, ThatAreIncompleteAreRefused) {
  if (!exists(kShared)) GTEST_SKIP() << kShared << " is not there";
  EXPECT_EQ(FaultOfShared("complete_but_all_zeros_legacy.json"),
            "/beam_altitude_angles: must not be 0 for all beams");
  EXPECT_EQ(FaultOfShared("incomplete_data_format_legacy.json"),
            "/data_format/columns_per_frame: missing");
  EXPECT_EQ(FaultOfShared("incomplete_data_format_nonlegacy.json"),
            "/lidar_data_format/pixels_per_column: missing");
  EXPECT_EQ(FaultOfShared("incorrect_nbeam_angles_legacy_113.json"),
            "/beam_azimuth_angles: must have 63 angles, one for each pixel of a column (got 64)");
}

/// The fault of made metadata in which a value is replaced.
std::string FaultWith(const std::string& pointer, const nlohmann::ordered_json& value) {
  nlohmann::ordered_json metadata = MadeOusterMetadata();
  metadata[nlohmann::ordered_json::json_pointer(pointer)] = value;
  return MessageOf([&] { static_cast<void>(ParseOusterOfPackets(metadata.dump())); });
}

TEST(OusterMetadata, WithoutAModeHaveColumnsAndRateOfTheFormat) {
  nlohmann::ordered_json made = MadeOusterMetadata();
  made["config_params"].erase("lidar_mode");
  made["lidar_data_format"]["fps"] = 20;
  const OusterMetadata metadata = ParseOusterMetadata(made.dump());
  EXPECT_EQ(metadata.columns_per_frame, 512U);
  EXPECT_EQ(metadata.rate_hz, 20.0);
}

TEST(OusterMetadata, OfPacketsThatAreNotKnownHaveBeamsColumnsAndRate) {
  nlohmann::ordered_json made = MadeOusterMetadata();
  made["config_params"]["lidar_mode"] = "720x15";
  made["lidar_data_format"]["columns_per_frame"] = 720;
  made["lidar_data_format"]["column_window"] = {0, 719};
  made["lidar_data_format"]["udp_profile_lidar"] = "RNG19_RFL8_SIG16_NIR16_ZONE16";
  made["lidar_data_format"]["header_type"] = "LATER";
  const OusterMetadata metadata = ParseOusterMetadata(made.dump());
  EXPECT_EQ(metadata.columns_per_frame, 720U);
  EXPECT_EQ(metadata.rate_hz, 15.0);
  EXPECT_EQ(metadata.beams.size(), ParseOusterMetadata(MadeOusterMetadataText()).beams.size());
  EXPECT_EQ(metadata.packet_faults.size(), 2U);
  LidarSpec lidar;
  UseOusterMetadata(made.dump(), lidar);
  EXPECT_EQ(lidar.scan.rate_hz, 15.0);
}

TEST(OusterMetadata, WithAWrongValueSayWhichRuleItBreaks) {
  EXPECT_EQ(FaultWith("/sensor_info/status", 1), "no error") << "nothing depends on it";
  EXPECT_EQ(FaultWith("/config_params/lidar_mode", "1000x0"),
            "/config_params/lidar_mode: must be COLUMNSxRATE, up to 65536 and 1000, such as "
            "1024x10 (got \"1000x0\")");
  EXPECT_EQ(FaultWith("/lidar_data_format/columns_per_frame", 1024),
            "/lidar_data_format/columns_per_frame: must be 512 as of lidar_mode (got 1024)");
  EXPECT_EQ(FaultWith("/lidar_data_format/columns_per_packet", 15),
            "/lidar_data_format/columns_per_packet: must divide 512, the columns of a turn (got "
            "15)");
  EXPECT_EQ(FaultWith("/lidar_data_format/column_window", {0, 512}),
            "/lidar_data_format/column_window/1: must be a whole number from 0 to 511 (got 512)");
  EXPECT_EQ(FaultWith("/lidar_data_format/udp_profile_lidar", "RNG20"),
            "/lidar_data_format/udp_profile_lidar: must be LEGACY, RNG19_RFL8_SIG16_NIR16, "
            "RNG19_RFL8_SIG16_NIR16_DUAL, RNG15_RFL8_NIR8, RNG15_RFL8_NIR8_DUAL or "
            "FUSA_RNG15_RFL8_NIR8_DUAL for packets to be read (got \"RNG20\")");
  EXPECT_EQ(FaultWith("/beam_intrinsics/beam_altitude_angles/2", "low"),
            "/beam_intrinsics/beam_altitude_angles/2: must be a number from -90 to 90 (got "
            "\"low\")");
  EXPECT_EQ(FaultWith("/beam_intrinsics/beam_altitude_angles", {3, 2, 1}),
            "/beam_intrinsics/beam_altitude_angles: must have 4 angles, one for each pixel of a "
            "column (got 3)");
  EXPECT_EQ(FaultWith("/beam_intrinsics/beam_to_lidar_transform", {1, 2}),
            "/beam_intrinsics/beam_to_lidar_transform: must have 16 numbers (got [1,2])");
  EXPECT_EQ(FaultWith("/lidar_intrinsics/lidar_to_sensor_transform/0", 2),
            "/lidar_intrinsics/lidar_to_sensor_transform: must turn and shift, and nothing else "
            "(got [2,0,0,0,0,-1,0,0,0,0,1,36.18,0,0,0,1])");
  EXPECT_EQ(FaultWith("/beam_altitude_angles", {1}),
            "/beam_altitude_angles: must not stand beside /beam_intrinsics, which has it, too (got "
            "[1])");
  EXPECT_EQ(MessageOf([] { static_cast<void>(ParseOusterMetadata("[]")); }),
            "must be an object, the metadata of an Ouster sensor");
}

// Ouster's manual: columns begin behind the sensor, at its connector, and go round clockwise.
TEST(OusterScan, BeginsBehindTheSensorAndGoesRoundClockwise) {
  LidarSpec lidar;
  UseOusterMetadata(MadeOusterMetadataText(), lidar);
  const auto& spinning = std::get<SpinningSpec>(lidar.scan.pattern);
  EXPECT_EQ(spinning.rotation, Rotation::kClockwise);
  EXPECT_NEAR(std::abs(spinning.start_azimuth_deg), 180.0, 1e-9);
  EXPECT_EQ(spinning.columns, 512U);
  EXPECT_NEAR(spinning.cycle_us, 1e5 / 512.0, 1e-9);
  const ScanPattern pattern = BuildScanPattern(lidar.scan);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const double turned_rad = RadFromDeg(360.0 * pattern.column[i] / 512.0);
    // Behind the sensor first, then to its left.
    EXPECT_NEAR(static_cast<double>(pattern.origin_x_m[i]), -0.015806 * std::cos(turned_rad), 1e-8);
    EXPECT_NEAR(static_cast<double>(pattern.origin_y_m[i]), 0.015806 * std::sin(turned_rad), 1e-8);
    EXPECT_NEAR(static_cast<double>(pattern.origin_z_m[i]), 0.03618, 1e-8);
  }
}

TEST(OusterScan, OfAWindowAcrossTheEndOfATurnGoesOnBehindIt) {
  LidarSpec lidar;
  UseOusterMetadata(MadeOusterMetadataText("LEGACY", 384, 127), lidar);
  const auto& spinning = std::get<SpinningSpec>(lidar.scan.pattern);
  EXPECT_EQ(spinning.columns, 256U);
  // Three quarters of a turn from behind, clockwise: right of the sensor.
  EXPECT_NEAR(spinning.start_azimuth_deg, 90.0, 1e-9);
}

TEST(OusterScan, BringsTheRangeAndBeamOfItsProductLine) {
  LidarSpec lidar;
  UseOusterMetadata(MadeOusterMetadataText("RNG19_RFL8_SIG16_NIR16_DUAL"), lidar);
  EXPECT_EQ(lidar.name, "OS-1-4");
  EXPECT_EQ(lidar.receiver.return_mode, ReturnMode::kDual);
  EXPECT_EQ(lidar.receiver.range_at_10_percent_m, 55.0);
  // 0.18 deg at half maximum; between 1/e^2 points 2 / 1.1774 as wide.
  EXPECT_NEAR(lidar.beam.divergence_mrad[0], 1e3 * RadFromDeg(0.18) * 2.0 / 1.17741, 1e-4);
  EXPECT_EQ(lidar.receiver.range_noise_floor_m, 0.005);
  nlohmann::ordered_json unknown = MadeOusterMetadata();
  unknown["sensor_info"].erase("prod_line");
  LidarSpec other;
  other.name = "roof";
  UseOusterMetadata(unknown.dump(), other);
  EXPECT_EQ(other.name, "roof");
  EXPECT_EQ(other.receiver.range_at_10_percent_m, ReceiverSpec{}.range_at_10_percent_m);
}

TEST(OusterScan, BringsTheNarrowBeamOfTheFirstGenerationWhereBeamsLeaveAsFarOut) {
  for (const auto& [line, origin_mm, width_deg, floor_m] :
       {std::tuple("OS-1-64", 12.163, 0.13, 0.002),
        {"OS-1-64", 15.806, 0.18, 0.005},
        {"OS-1-128", 12.163, 0.18, 0.005},
        {"OS-2-128", 13.762, 0.09, 0.015}}) {
    nlohmann::ordered_json metadata = MadeOusterMetadata();
    metadata["sensor_info"]["prod_line"] = line;
    metadata["beam_intrinsics"]["lidar_origin_to_beam_origin_mm"] = origin_mm;
    LidarSpec lidar;
    UseOusterMetadata(metadata.dump(), lidar);
    EXPECT_NEAR(lidar.beam.divergence_mrad[0], 1e3 * RadFromDeg(width_deg) * 2.0 / 1.17741, 1e-4);
    EXPECT_EQ(lidar.receiver.range_noise_floor_m, floor_m) << line << ' ' << origin_mm;
  }
}

TEST(OusterScan, IsRefusedWhereTheLidarDoesNotStandUpright) {
  nlohmann::ordered_json metadata = MadeOusterMetadata();
  metadata["lidar_intrinsics"]["lidar_to_sensor_transform"] = {1, 0, 0, 0, 0, 0, -1, 0,
                                                               0, 1, 0, 0, 0, 0, 0,  1};
  LidarSpec lidar;
  EXPECT_EQ(MessageOf([&] { UseOusterMetadata(metadata.dump(), lidar); }),
            "lidar_to_sensor_transform: must turn about the z axis and shift along it for a scan");
}

// A sensor given by an Ouster sensor's metadata in a scenario.

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
