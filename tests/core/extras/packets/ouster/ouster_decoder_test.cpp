#include "core/extras/packets/ouster/ouster_decoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/base/bytes.h"
#include "core/base/units.h"
#include "tests/core/extras/packets/ouster/shared_captures.h"
#include "tests/support/decode_packet.h"
#include "tests/support/decoded_turns.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

/// All turns of a capture.
std::vector<SensorTurn> TurnsOf(const OusterCapture& capture) {
  OusterDecoder decoder(capture.metadata());
  return TurnsOfPackets(decoder, LidarPacketsOf(capture));
}

/// Ouster's manual, "lidar range to XYZ": the sum of the beam's way and of the arm's, less the
/// arm's length along the beam, and then the transform to the sensor.
Vector3 PlaceOfManual(const OusterMetadata& metadata,
                      const OusterBeam& beam,
                      std::uint16_t measurement_id,
                      std::uint32_t range_mm) {
  const double encoder_rad =
      2.0 * std::numbers::pi *
      (1.0 - measurement_id / static_cast<double>(metadata.columns_per_frame));
  const double azimuth_rad = -RadFromDeg(beam.azimuth_deg);
  const double altitude_rad = RadFromDeg(beam.altitude_deg);
  const double arm_mm = 1e3 * metadata.beam_origin_m[0];
  const Vector3 in_lidar_mm(
      (range_mm - arm_mm) * std::cos(encoder_rad + azimuth_rad) * std::cos(altitude_rad) +
          arm_mm * std::cos(encoder_rad),
      (range_mm - arm_mm) * std::sin(encoder_rad + azimuth_rad) * std::cos(altitude_rad) +
          arm_mm * std::sin(encoder_rad),
      (range_mm - arm_mm) * std::sin(altitude_rad));
  return metadata.sensor_from_lidar * (1e-3 * in_lidar_mm);
}

class DecodedCapture : public testing::TestWithParam<OusterCapture> {};

TEST_P(DecodedCapture, HasEachPointWhereTheManualPutsIt) {
  const OusterCapture& capture = GetParam();
  if (!capture.is_there()) GTEST_SKIP() << capture.pcap << " is not there";
  const OusterMetadata metadata = capture.metadata();
  const OusterLayout layout(metadata);
  // By frame, column and pixel, return.
  std::map<std::tuple<std::uint32_t, std::int64_t, std::uint16_t, std::size_t>, Vector3> places;
  for (const std::vector<char>& packet : LidarPacketsOf(capture)) {
    for (std::size_t i = 0; i < layout.num_columns(); ++i) {
      const OusterColumn column = layout.ColumnOf(packet, i);
      for (const OusterBeam& beam : metadata.beams) {
        const OusterPixel pixel = layout.PixelOf(packet, i, beam.pixel);
        for (std::size_t r = 0; column.is_valid && r < 2; ++r) {
          const std::uint32_t range_mm = pixel.returns[r].range_mm;
          if (range_mm == 0) continue;
          places[{0, static_cast<std::int64_t>(column.time_ns), beam.pixel, r}] =
              PlaceOfManual(metadata, beam, column.measurement_id, range_mm);
        }
      }
    }
  }
  std::size_t num_points = 0;
  for (const SensorTurn& turn : TurnsOf(capture)) {
    for (const TurnPoint& point : turn.points) {
      const auto found =
          places.find({0, turn.stamp_ns + point.time_ns, point.laser, point.return_index});
      ASSERT_NE(found, places.end());
      // float32 resolves 500 m to 0.03 mm.
      constexpr double kFloat_m = 5e-5;
      ASSERT_NEAR(static_cast<double>(point.x), found->second.x(), kFloat_m);
      ASSERT_NEAR(static_cast<double>(point.y), found->second.y(), kFloat_m);
      ASSERT_NEAR(static_cast<double>(point.z), found->second.z(), kFloat_m);
      ++num_points;
    }
    EXPECT_EQ(turn.is_dual, layout.is_dual());
  }
  EXPECT_EQ(num_points, places.size());
  EXPECT_GT(num_points, 100U);
}

INSTANTIATE_TEST_SUITE_P(OusterDecoder,
                         DecodedCapture,
                         testing::ValuesIn(kOusterCaptures),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

TEST(OusterDecoder, MakesATurnOfEachFrame) {
  const OusterCapture& capture = kOusterCaptures[2];
  if (!capture.is_there()) GTEST_SKIP() << capture.pcap << " is not there";
  const std::vector<SensorTurn> turns = TurnsOf(capture);
  ASSERT_EQ(turns.size(), 3U);
  for (const SensorTurn& turn : turns) EXPECT_EQ(turn.num_columns(), 1024U);
  EXPECT_NEAR(static_cast<double>(turns[1].stamp_ns - turns[0].stamp_ns), 1e8, 1e6);
}

// The first has its window in the turn, the second across its end.
TEST(OusterDecoder, OfAWindowHasItsColumns) {
  if (!kOusterCaptures[8].is_there()) GTEST_SKIP() << "no windowed captures";
  EXPECT_EQ(TurnsOf(kOusterCaptures[8]).at(0).num_columns(), 256U);
  EXPECT_EQ(TurnsOf(kOusterCaptures[9]).at(0).num_columns(), 86U + 142U);
}

/// Packets of a made sensor: each column has one point, as far away as its number in cm.
class MadePackets {
 public:
  explicit MadePackets(const std::string& profile = "RNG19_RFL8_SIG16_NIR16")
      : MadePackets(ParseOusterMetadata(MadeOusterMetadataText(profile))) {}
  explicit MadePackets(OusterMetadata metadata)
      : metadata_(std::move(metadata)), layout_(metadata_) {}

  [[nodiscard]] const OusterMetadata& metadata() const { return metadata_; }
  [[nodiscard]] std::vector<char> Packet(std::uint32_t frame, std::uint16_t first) const {
    std::vector<char> packet(layout_.packet_size());
    layout_.Store({.frame_id = frame,
                   .initialization_id = *metadata_.initialization_id,
                   .serial_number = *metadata_.serial_number},
                  packet);
    for (std::uint16_t i = 0; i < 16; ++i) {
      const auto number = static_cast<std::uint16_t>(first + i);
      layout_.Store({.time_ns = 1'000'000'000ULL * frame + 1000U * number,
                     .measurement_id = number,
                     .is_valid = true},
                    i, frame, 0, packet);
      OusterPixel pixel;
      pixel.returns[0] = {.range_mm = 1000U + 10U * number, .reflectivity = 50, .signal = 7};
      layout_.Store(pixel, i, 2, packet);
    }
    StoreChecksum(packet);
    return packet;
  }

 private:
  OusterMetadata metadata_;
  OusterLayout layout_;
};

TEST(OusterDecoder, PutsPacketsInOrderAndLeavesOutLateAndRepeatedOnes) {
  const MadePackets made;
  OusterDecoder decoder(made.metadata());
  const std::vector<SensorTurn> turns = TurnsOfPackets(
      decoder, std::vector{made.Packet(7, 32), made.Packet(7, 0), made.Packet(7, 32),
                           made.Packet(8, 0), made.Packet(7, 16), made.Packet(8, 16)});
  ASSERT_EQ(turns.size(), 2U);
  ASSERT_EQ(turns[0].points.size(), 32U);
  EXPECT_EQ(turns[0].stamp_ns, 7'000'000'000);
  EXPECT_EQ(turns[0].column_time_ns[16], 32'000);
  EXPECT_EQ(turns[0].points[16].column, 16U);
  EXPECT_NEAR(static_cast<double>(turns[0].points[16].range_m), 1.32 - 0.015806, 1e-6);
  EXPECT_EQ(turns[0].points[16].ring, 1U) << "the second lowest";
  EXPECT_EQ(turns[0].fields[0].name, "signal");
  EXPECT_EQ(turns[0].fields[0].values[16], 7.0F);
  EXPECT_EQ(turns[1].points.size(), 32U);
}

TEST(OusterDecoder, OrdersPacketsOfUnmeasuredColumnsByTheirNumbers) {
  const MadePackets made;
  const OusterDecoder decoder(made.metadata());
  const OusterLayout layout(made.metadata());
  std::vector<char> packet = made.Packet(7, 32);
  const PacketMark mark = decoder.MarkOf(packet);
  const auto store = [&](std::uint16_t first, std::uint16_t step) {
    for (std::uint16_t i = 0; i < 16; ++i) {
      layout.Store({.measurement_id = static_cast<std::uint16_t>(first + step * i)}, i, 7, 0,
                   packet);
    }
  };
  store(32, 1);
  EXPECT_EQ(decoder.MarkOf(packet).number, mark.number);
  EXPECT_TRUE(decoder.MarkOf(packet).has_number);
  store(0, 0);
  EXPECT_FALSE(decoder.MarkOf(packet).has_number);
  store(60'000, 1);
  EXPECT_FALSE(decoder.MarkOf(packet).has_number);
}

/// LEGACY packets of a firmware, with as many columns each.
OusterMetadata LegacyOf(const char* firmware, int columns) {
  auto metadata = MadeOusterMetadata("LEGACY");
  metadata["sensor_info"]["build_rev"] = firmware;
  metadata["lidar_data_format"]["columns_per_packet"] = columns;
  return ParseOusterMetadata(metadata.dump());
}

TEST(OusterDecoder, KeepsAll16BitsOfReflectivityOfFirmwareBefore2_1) {
  for (const int columns : {16, 64}) {
    const MadePackets made(LegacyOf("v2.0.0-rc.2", columns));
    const OusterLayout layout(made.metadata());
    OusterDecoder decoder(made.metadata());
    std::vector<char> packet = made.Packet(1, 0);
    const OusterPixel recorded{{OusterReturn{.range_mm = 5000, .reflectivity = 16'237}}, 9};
    layout.Store(recorded, 3, 2, packet);
    const std::vector<SensorTurn> turns =
        TurnsOfPackets(decoder, std::vector<std::vector<char>>{packet});
    EXPECT_EQ(turns.at(0).points.at(3).intensity, 16'237U);
    // What stays is written as it was; what is new has none.
    const std::vector<char> before = packet;
    const FiringPlace place{.packet = 0,
                            .first = static_cast<std::uint32_t>(layout.PlaceOfPixel(3, 2))};
    EXPECT_EQ(decoder.Store({EditedReturn{.from = 0}}, place, packet), std::nullopt);
    EXPECT_EQ(packet, before);
    EXPECT_EQ(decoder.Store({EditedReturn{.range_m = 7.0F}}, place, packet), std::nullopt);
    EXPECT_EQ(layout.PixelOf(packet, 3, 2).returns[0].reflectivity, 0U);
    EXPECT_EQ(layout.PixelOf(packet, 3, 2).returns[0].range_mm, 7016U);
  }
}

TEST(OusterDecoder, TakesTheByteOfReflectivityOfFirmwareSince2_1) {
  const MadePackets made(LegacyOf("v2.1.2", 16));
  const OusterLayout layout(made.metadata());
  OusterDecoder decoder(made.metadata());
  std::vector<char> packet = made.Packet(1, 0);
  StoreAt<std::uint16_t>(packet.data() + layout.PlaceOfPixel(3, 2) + 4, 0x3F6D);
  EXPECT_EQ(
      TurnsOfPackets(decoder, std::vector<std::vector<char>>{packet}).at(0).points.at(3).intensity,
      0x6DU);
}

// LEGACY packets do not say which metadata are theirs.
TEST(OusterDecoder, RefusesLegacyPacketsOfAnotherMode) {
  const MadePackets made("LEGACY");
  const OusterDecoder decoder(made.metadata());
  const OusterLayout layout(made.metadata());
  std::vector<char> packet = made.Packet(1, 16);
  EXPECT_EQ(decoder.Refuse(packet), std::nullopt);
  const auto refusal = [&](std::uint32_t ticks) {
    layout.Store({.measurement_id = 20, .is_valid = true}, 4, 1, ticks, packet);
    return decoder.Refuse(packet);
  };
  EXPECT_EQ(refusal(20 * 176 + 3), std::nullopt);
  EXPECT_EQ(refusal(0), std::nullopt) << "as other programs write it";
  EXPECT_EQ(refusal(20 * 88),
            "column 4: encoder count must be near 3520 by its measurement id and the metadata's "
            "lidar mode (got 1760)");
  EXPECT_NE(refusal(20 * 352), std::nullopt);
  // Nor is the first packet of a turn taken.
  std::vector<char> first = made.Packet(1, 0);
  layout.Store({.measurement_id = 8, .is_valid = true}, 8, 1, 8 * 88, first);
  EXPECT_NE(decoder.Refuse(first), std::nullopt);
}

TEST(OusterDecoder, SaysWhyAPacketIsRefused) {
  const MadePackets made;
  const auto refusal = [&](const auto& change) {
    std::vector<char> packet = made.Packet(1, 0);
    change(packet);
    OusterDecoder decoder(made.metadata());
    std::vector<SensorTurn> turns;
    return DecodePacket(decoder, packet, turns).value_or("accepted");
  };
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_EQ(refusal([](auto& packet) { packet.pop_back(); }), "must be 1024 bytes (got 1023)");
  EXPECT_EQ(refusal([](auto& packet) { packet[0] = 2; }), "packet type must be 1 (got 2)");
  EXPECT_EQ(refusal([](auto& packet) { packet[7] = 0; }),
            "serial number must be 122201000998 (got 122201000960)");
  EXPECT_EQ(refusal([](auto& packet) { packet[4] = 0; }),
            "initialization id must be 7109750 (got 7109632)");
  EXPECT_EQ(refusal([](auto& packet) { packet[32 + 9] = 2; }),
            "column 0: measurement id must be < 512 (got 512)");
  EXPECT_EQ(refusal([](auto& packet) { packet[32 + 7] = '\x41'; }).substr(0, 45),
            "column 0: time must be <= 4611686018427387904");
  EXPECT_EQ(refusal([](auto& packet) { packet[100] ^= 1; }),
            "the checksum must be that of its bytes");
}

}  // namespace
}  // namespace railcast
