#include "core/io/velodyne/calibration_xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

SpinningSpec Hdl64e() {
  return std::get<SpinningSpec>(ReadSensor("hdl64e").pattern);
}

std::string Said(const std::string& xml) {
  return MessageOf([&] { (void)ReadCalibrationXml(xml, "db.xml"); });
}

/// Our file with the first `from` replaced.
std::string SaidWith(const std::string& from, const std::string& to) {
  std::string xml = CalibrationXml(Hdl64e());
  const std::size_t place = xml.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return Said(xml.replace(place, from.size(), to));
}

TEST(CalibrationXml, ReadsBackWhatItWrote) {
  const SpinningSpec pattern = Hdl64e();
  const auto calibration = ReadCalibrationXml(CalibrationXml(pattern), "db.xml");
  ASSERT_EQ(calibration.size(), 64U);
  for (std::size_t i = 0; i < 64; ++i) {
    const LaserCalibration expected{.elevation_deg = pattern.channels[i].elevation_deg,
                                    .azimuth_deg = pattern.channels[i].azimuth_deg};
    EXPECT_EQ(calibration[i], expected) << i;
  }
}

TEST(CalibrationXml, AgreesWithTheSensorThatOurTableComesFrom) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/velodyne_calibration/ros-drivers/64e_s2.1-sztaki.xml";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto calibration = ReadCalibrationXml(ReadFileWhole(file), file.string());
  const SpinningSpec pattern = Hdl64e();
  ASSERT_EQ(calibration.size(), 64U);
  // The table has three decimals.
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(calibration[i].elevation_deg, pattern.channels[i].elevation_deg, 5.1e-4);
    EXPECT_NEAR(calibration[i].azimuth_deg, pattern.channels[i].azimuth_deg, 5.1e-4);
  }
  // <distCorrection_>143.29738, <vertOffsetCorrection_>12.086253, <horizOffsetCorrection_>-2.6
  EXPECT_NEAR(calibration[63].range_offset_m, 1.4329738, 1e-9);
  EXPECT_NEAR(calibration[63].vertical_offset_m, 0.12086253, 1e-9);
  EXPECT_NEAR(calibration[63].horizontal_offset_m, -0.025999999, 1e-9);
}

TEST(CalibrationXml, SaysWhatIsWrongWithAFile) {
  EXPECT_EQ(Said(""), "db.xml: line 1: must be XML (no element found)");
  EXPECT_EQ(Said("<a><b></a>"), "db.xml: line 1: must be XML (mismatched tag)");
  EXPECT_EQ(Said("<a/>"), "db.xml: must have a <px> with id_ 0");
  EXPECT_EQ(SaidWith("<id_>63</id_>", "<id_>5</id_>"),
            "db.xml: line 902: every id_ must be there once (got \"5\")");
  EXPECT_EQ(SaidWith("<id_>0</id_>", "<id_>64</id_>"),
            "db.xml: line 20: id_ must be 0 to 63 (got \"64\")");
  EXPECT_EQ(SaidWith("<id_>0</id_>", ""), "db.xml: line 20: id_ must be 0 to 63 (got \"nan\")");
  EXPECT_EQ(SaidWith("<vertCorrection_>-8.769<", "<vertCorrection_>-98.769<"),
            "db.xml: line 20: vertCorrection_ must be >= -90 and <= 90 (got \"-98.769\")");
  EXPECT_EQ(SaidWith("<distCorrection_>0<", "<distCorrection_>1e300<"),
            "db.xml: line 20: corrections of distance and place must be >= -1000 and <= 1000 (got "
            "\"1e+300\")");
  EXPECT_EQ(SaidWith("<rotCorrection_>-7.156<", "<rotCorrection_>7,1<"),
            "db.xml: line 11: rotCorrection_ must be a number (got \"7,1\")");
  EXPECT_EQ(SaidWith("<rotCorrection_>-7.156<", "<rotCorrection_>inf<"),
            "db.xml: line 11: rotCorrection_ must be a number (got \"inf\")");
  EXPECT_EQ(SaidWith("0.2</distLSB_>", "0.4</distLSB_>"),
            "db.xml: line 5: distLSB_ must be 0.2 (got \"0.4\")");
  EXPECT_EQ(Said(std::string((1U << 20U) + 1, ' ')),
            "db.xml: must have at most 1048576 bytes (got 1048577)");
}

TEST(CalibrationXml, SurvivesNestingAndEntitiesThatGrow) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_EQ(Said(deep), "db.xml: line 1: must be XML (no element found)");
  std::string laughs = "<!DOCTYPE a [<!ENTITY a0 \"lol\">";
  for (int i = 1; i < 30; ++i) {
    const std::string last = "&a" + std::to_string(i - 1) + ";";
    laughs += "<!ENTITY a" + std::to_string(i) + " \"" + last + last + last + last + "\">";
  }
  EXPECT_THAT(Said(laughs + "]><a>&a29;</a>"), testing::StartsWith("db.xml: line 1: must be XML"));
}

}  // namespace
}  // namespace railcast
