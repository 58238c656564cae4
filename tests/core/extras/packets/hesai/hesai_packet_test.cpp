#include "core/extras/packets/spinning/spinning_packet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/support/captures.h"
#include "tests/support/decode_packet.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

// The check value of this CRC in the published catalogues.
TEST(HesaiCrc, IsThatOfMpeg2) {
  const std::string digits = "123456789";
  EXPECT_EQ(HesaiCrc(digits), 0x0376E6E7U);
}

using Packets = std::vector<std::vector<char>>;

/// What the decoder finds in the packets of whole cycles, as packets again.
class Remade {
 public:
  Remade(const SpinningModel& model, const Packets& packets) : model_(model), packets_(packets) {
    SpinningDecoder decoder(model);
    std::vector<SensorTurn> turns;
    for (const std::vector<char>& packet : packets) {
      EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
    }
    is_one_turn_ = turns.empty();
    turn_ = decoder.TakeUnfinished();
    const std::vector<std::uint16_t> rows = RowsByElevation(model.channels);
    std::size_t channel = 0;
    for (std::size_t loop = 0; loop < model.loops.size(); ++loop) {
      for (std::size_t i = 0; i < model.loops[loop].size(); ++i, ++channel) {
        places_[rows[channel]] = {loop, channel};
      }
    }
    for (const TurnPoint& point : turn_.points) Add(point);
  }

  [[nodiscard]] bool is_one_turn() const { return is_one_turn_; }

  [[nodiscard]] std::vector<char> Packet(std::size_t index) const {
    const std::vector<char>& real = packets_[index];
    const auto mode = static_cast<std::uint8_t>(real[model_.mode_place]);
    const std::size_t in_group = BlocksInGroup(model_, real);
    const bool is_dual = model_.IsDual(mode);
    const bool has_last_second = mode == kFirstAndLastMode && !model_.has_last_first;
    SpinningPacket packet(model_, mode);
    const std::size_t groups = model_.blocks / in_group;
    std::int64_t loop_ns = 0;
    for (std::size_t group = 0; group < groups; ++group) {
      const std::size_t number = index * groups + group;
      const std::size_t column = number / model_.loops.size();
      const std::size_t loop = number % model_.loops.size();
      if (group == 0 || !model_.states_first) {
        loop_ns = turn_.stamp_ns + turn_.column_time_ns.at(column) +
                  model_.loop_ns * static_cast<std::int64_t>(loop);
      }
      for (std::size_t i = 0; i < in_group; ++i) {
        packet.BeginBlock(group * in_group + i, loop, azimuths_.at(number));
      }
      for (const auto& [key, coded] : returns_) {
        const auto& [point_column, point_loop, laser, return_index] = key;
        if (point_column != column || point_loop != loop) continue;
        const std::size_t first = has_last_second ? 1 : 0;
        packet.SetReturn(model_.ReturnPlace(group * in_group + (return_index ^ first), laser),
                         coded);
        const bool is_repeated =
            return_index == 0 && is_dual &&
            !returns_.contains({point_column, point_loop, laser, std::size_t{1}});
        if (is_repeated) {
          packet.SetReturn(model_.ReturnPlace(group * in_group + (1 - first), laser), coded);
        }
      }
    }
    const auto bytes =
        packet.Close({.time_ns = loop_ns - model_.stated_loop_ns,
                      .speed_rpm = LoadAt<std::uint16_t>(real.data() + model_.speed_place),
                      .sequence = model_.sequence_place > 0
                                      ? LoadAt<std::uint32_t>(real.data() + model_.sequence_place)
                                      : 0});
    return {bytes.begin(), bytes.end()};
  }

 private:
  [[nodiscard]] double Speed_deg_per_us() const {
    const std::vector<char>& packet = packets_[0];
    if (model_.speed_place == 0) {
      const std::int64_t step = UsualStep(model_, packet, LoopsIn(model_, packet));
      return 0.01 * static_cast<double>(step) / model_.cycle_us;
    }
    return 6e-6 * LoadAt<std::uint16_t>(packet.data() + model_.speed_place);
  }

  using Key = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>;

  void Add(const TurnPoint& point) {
    const auto [loop, channel] = places_.at(point.ring);
    const auto distance = static_cast<std::uint16_t>(std::lround(250.0F * point.range_m));
    returns_[{point.column, loop, point.laser, point.return_index}] = {
        distance, static_cast<std::uint8_t>(point.intensity)};
    const double speed_deg_per_us = Speed_deg_per_us();
    const ChannelSpec& spec = model_.channels[channel];
    const double loop_us = 1e-3 * static_cast<double>(model_.loop_ns) * static_cast<double>(loop);
    const double turned_us =
        model_.turns_azimuths ? 0.0 : model_.turned_us + spec.time_us - loop_us;
    const double azimuth_deg = DegFromRad(static_cast<double>(point.azimuth_rad)) -
                               spec.azimuth_deg - speed_deg_per_us * turned_us;
    const std::int64_t units = std::llround(100.0 * azimuth_deg);
    azimuths_[point.column * model_.loops.size() + loop] =
        static_cast<std::uint16_t>((units + 36'000) % 36'000);
  }

  const SpinningModel& model_;
  const Packets& packets_;
  bool is_one_turn_{};
  SensorTurn turn_;
  std::map<std::uint16_t, std::pair<std::size_t, std::size_t>> places_;  // Loop and channel.
  std::map<Key, CodedReturn> returns_;
  std::map<std::size_t, std::uint16_t> azimuths_;
};

/// Where a real packet has something that the decoder keeps: not the reflectivity of what is no
/// return, and not that the second return of two is missing rather than a repetition of the first.
std::vector<bool> KeptReturns(const SpinningModel& model, const std::vector<char>& real) {
  std::vector<bool> kept(real.size(), false);
  const bool is_dual = model.IsDual(static_cast<std::uint8_t>(real[model.mode_place]));
  const auto distance = [&](std::size_t block, std::size_t laser) {
    return LoadAt<std::uint16_t>(real.data() + DistancePlace(model, block, laser));
  };
  for (std::size_t block = 0; block < model.blocks; ++block) {
    for (std::size_t laser = 0; laser < model.lasers; ++laser) {
      const bool is_return = distance(block, laser) > 0;
      const bool is_missing =
          is_dual && block % 2 == 1 && !is_return && distance(block - 1, laser) > 0;
      const auto place =
          kept.begin() + static_cast<std::ptrdiff_t>(DistancePlace(model, block, laser));
      std::fill_n(place, 2, !is_missing);
      place[2] = is_return;
    }
  }
  return kept;
}

/// The bytes that are neither reserved nor the vendor's own: confidences, temperatures, the state
/// of the sensor, and the checksums that depend on these.
/// @param states_time Whether the packet is the one whose time the decoder keeps, the first of a
///   cycle.
std::vector<bool> OwnBytes(const SpinningModel& model,
                           const std::vector<char>& real,
                           bool states_time) {
  std::vector<bool> own = KeptReturns(model, real);
  const auto mark = [&](std::size_t place, std::size_t size) {
    std::fill_n(own.begin() + static_cast<std::ptrdiff_t>(place), size, true);
  };
  mark(0, model.header_size);
  if (model.header_size == 12) own[4] = own[5] = false;
  for (std::size_t block = 0; block < model.blocks; ++block) {
    mark(model.BlockPlace(block), model.block_head_size());
  }
  mark(model.mode_place, 1);
  if (model.mark_place > 0) mark(model.mark_place, 1);
  if (model.date_place > 0) mark(model.date_place, 6);
  if (model.speed_place > 0) mark(model.speed_place, 2);
  if (model.factory_place > 0) mark(model.factory_place, 1);
  if (states_time) mark(model.time_place, 4);
  if (model.sequence_place > 0) mark(model.sequence_place, 4);
  if (model.loop_place > 0) mark(model.loop_place, 1);
  return own;
}

struct RealCapture {
  const char* name;
  std::size_t first;        ///< The packet with which a cycle begins.
  std::size_t per_cycle;    ///< Packets of a cycle.
  std::size_t num_packets;  ///< But for those in which a turn ends.
};

void PrintTo(const RealCapture& capture, std::ostream* out) {
  *out << capture.name;
}

/// The capture of this sensor; empty if there is but a bag.
std::string RealCaptureFile(const std::string& name) {
  const std::string folder = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/";
  if (name == "pandar64") return folder + "pandar64.pcap";
  return name.starts_with("v") ? folder + name + "_single.pcap" : "";
}

std::string WhyNoCapture(const std::string& name) {
  const std::string file = RealCaptureFile(name);
  if (file.empty()) return WhyNoHesaiBag(name);
  return std::filesystem::exists(file) ? "" : file + " is not there";
}

Packets RealPacketsOf(const std::string& name) {
  if (const std::string file = RealCaptureFile(name); !file.empty()) return PacketsInCapture(file);
  const TemporaryDirectory folder;
  return PacketsInCapture(CaptureOfHesaiBag(name, folder));
}

class SpinningPacketOf : public testing::TestWithParam<RealCapture> {};

TEST_P(SpinningPacketOf, ARealCaptureIsRemadeByteByByte) {
  const std::string name = GetParam().name;
  const auto& [_, first, per_cycle, num_expected] = GetParam();
  if (const std::string why = WhyNoCapture(name); !why.empty()) GTEST_SKIP() << why;
  const Packets packets = RealPacketsOf(name);
  const bool is_dated = !name.starts_with("v");
  const SpinningModel& model =
      is_dated ? ModelOfSize(name, packets[0].size()) : *FindSpinningModel(name);
  std::size_t num_packets = 0;
  std::size_t num_bytes = 0;
  std::size_t num_different = 0;
  for (std::size_t i = first; i + per_cycle <= packets.size(); i += per_cycle) {
    const auto begin = packets.begin() + static_cast<std::ptrdiff_t>(i);
    const Packets cycle(begin, begin + static_cast<std::ptrdiff_t>(per_cycle));
    const Remade remade(model, cycle);
    if (!remade.is_one_turn()) continue;
    for (std::size_t k = 0; k < per_cycle; ++k) {
      const std::vector<char> ours = remade.Packet(k);
      ASSERT_EQ(ours.size(), cycle[k].size());
      const std::vector<bool> own = OwnBytes(model, cycle[k], k == 0);
      for (std::size_t b = 0; b < ours.size(); ++b) {
        num_bytes += own[b];
        if (!own[b] || ours[b] == cycle[k][b]) continue;
        ++num_different;
        ADD_FAILURE() << "packet " << i + k << ", byte " << b;
        ASSERT_LT(num_different, 10U);
      }
      ++num_packets;
    }
  }
  RecordProperty("bytes", std::to_string(num_bytes));
  EXPECT_EQ(num_packets, num_expected);
}

INSTANTIATE_TEST_SUITE_P(Captures,
                         SpinningPacketOf,
                         testing::Values(RealCapture{"pandar64", 0, 1, 2396},
                                         RealCapture{"xt32", 0, 1, 1996},
                                         RealCapture{"qt128", 1, 2, 1798},
                                         RealCapture{"pandar40p", 0, 1, 1436},
                                         RealCapture{"qt64", 0, 1, 1200},
                                         RealCapture{"vlp32c", 0, 1, 374},
                                         RealCapture{"vls128", 0, 1, 2190}),
                         [](const auto& test) { return std::string(test.param.name); });

// A QT128's: of the blocks, of the functional safety without its version, of the rest.
TEST(HesaiCrc, IsThatOfEveryPacketOfARealSensor) {
  if (const std::string why = WhyNoHesaiBag("qt128"); !why.empty()) GTEST_SKIP() << why;
  const Packets packets = RealPacketsOf("qt128");
  ASSERT_EQ(packets.size(), 1800U);
  for (const std::vector<char>& packet : packets) {
    const std::span<const char> bytes(packet);
    const auto crc = [&](std::size_t place) {
      return LoadAt<std::uint32_t>(packet.data() + place);
    };
    ASSERT_EQ(HesaiCrc(bytes.subspan(12, 1028)), crc(1040));
    ASSERT_EQ(HesaiCrc(bytes.subspan(1045, 12)), crc(1057));
    ASSERT_EQ(HesaiCrc(bytes.subspan(1061, 30)), crc(1091));
  }
}

}  // namespace
}  // namespace railcast
