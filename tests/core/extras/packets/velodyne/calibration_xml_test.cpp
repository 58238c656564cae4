#include "core/extras/packets/velodyne/velodyne_packet.h"

#include <gtest/gtest.h>

#include <regex>

#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

// That PCL reads and uses the file is tested in pcl_grabber_test.cpp.
TEST(CalibrationXml, HasTheAnglesOfEveryLaser) {
  const auto pattern = std::get<SpinningSpec>(ReadSensor("hdl64e").pattern);
  const std::string xml = CalibrationXml(pattern);
  const std::regex laser(
      "<id_>(\\d+)</id_>\\s*<rotCorrection_>([-.\\d]+)</rotCorrection_>\\s*"
      "<vertCorrection_>([-.\\d]+)</vertCorrection_>");
  std::size_t num = 0;
  for (std::sregex_iterator it(xml.begin(), xml.end(), laser), end; it != end; ++it, ++num) {
    ASSERT_EQ(std::stoul((*it)[1]), num);
    EXPECT_EQ(std::stod((*it)[2]), 0.0 - pattern.channels[num].azimuth_deg) << num;
    EXPECT_EQ(std::stod((*it)[3]), pattern.channels[num].elevation_deg) << num;
  }
  EXPECT_EQ(num, 64U);
}

}  // namespace
}  // namespace railcast
