#include <gtest/gtest.h>

#include <regex>

#include "core/base/units.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/field_layout.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

constexpr std::int64_t kHour_ns = 3600 * kNsPerS;
constexpr std::int64_t kDay_ns = 24 * kHour_ns;

TEST(GprmcSentence, CountsFromTheFirstOfJanuary2000) {
  // The checksum is the exclusive or of all characters between $ and *.
  EXPECT_EQ(GprmcSentence(0),
            "$GPRMC,000000,V,0000.0000,N,00000.0000,E,000.0,000.0,010100,000.0,E,N*03\r\n");
  EXPECT_EQ(GprmcSentence(kDay_ns - 1),
            "$GPRMC,235959,V,0000.0000,N,00000.0000,E,000.0,000.0,010100,000.0,E,N*02\r\n");
  EXPECT_EQ(GprmcSentence(kDay_ns),
            "$GPRMC,000000,V,0000.0000,N,00000.0000,E,000.0,000.0,020100,000.0,E,N*00\r\n");
  EXPECT_EQ(GprmcSentence(59 * kDay_ns + kHour_ns + 61 * kNsPerS),
            "$GPRMC,010101,V,0000.0000,N,00000.0000,E,000.0,000.0,290200,000.0,E,N*0B\r\n");
}

TEST(GprmcSentence, HasTheChecksumOfItsText) {
  for (std::int64_t hour = 0; hour < 9600; hour += 7) {
    const std::string sentence = GprmcSentence(hour * kHour_ns);
    const std::size_t star = sentence.find('*');
    ASSERT_EQ(star + 5, sentence.size());
    unsigned checksum = 0;
    for (const char c : sentence.substr(1, star - 1)) checksum ^= static_cast<unsigned char>(c);
    EXPECT_EQ(std::stoul(sentence.substr(star + 1, 2), nullptr, 16), checksum) << sentence;
  }
}

TEST(PositionPacket, SaysClockPulseAndSentenceWhereDecodersLook) {
  Datagrams datagrams;
  datagrams.bytes.resize(10);
  AppendPositionPacket(25 * kHour_ns + 17 * kNsPerS, 0, datagrams);
  ASSERT_EQ(datagrams.items.size(), 1U);
  EXPECT_EQ(datagrams.items[0].port, DatagramPort::kPosition);
  const auto packet = datagrams.BytesOf(datagrams.items[0]);
  ASSERT_EQ(packet.size(), 512U);
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 0xC6), 17'000'000U);
  EXPECT_EQ(packet[0xCA], 2);
  EXPECT_EQ(std::string(packet.data() + 0xCE),
            "$GPRMC,010017,V,0000.0000,N,00000.0000,E,000.0,000.0,020100,000.0,E,N*07\r\n");
}

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
