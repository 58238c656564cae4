#include "core/io/hesai/at128_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/field_layout.h"
#include "core/io/hesai/hesai_model.h"
#include "core/io/hesai/hesai_packet.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

// Packets: HesaiLidar_SDK_2.0, udp_protocol_v4_3.h; tier4/nebula, pandar_at128.hpp, where the times
// come from, too: a block begins 9.249 us and 41.666 us for each block from it to the end before
// the packet's time stamp.
constexpr std::size_t kBlocks = 2;
constexpr std::size_t kReturnBytes = 4;
constexpr std::size_t kBlockHead = 3;  // u16 azimuth in 0.01 deg, u8 in 1/256 of that.
constexpr std::size_t kFirstBlock = 12;
constexpr std::size_t kBlockBytes = kBlockHead + kAt128Lasers * kReturnBytes;
static_assert(kAt128CheckedBytes[0].end == kFirstBlock + kBlocks * kBlockBytes);
constexpr std::size_t kUnit = 9;
constexpr HesaiTail kTail = {.mode_place = 1070,
                             .speed_place = 1064,
                             .date_place = 1072,
                             .time_place = 1066,
                             .factory_place = 1071,
                             .sequence_place = 1078};
constexpr std::int64_t kEnd_ns = -9'249;
constexpr std::int64_t kBlock_ns = 41'666;

constexpr std::array<std::int16_t, kAt128Lasers> kFiring_ns = {
    0,     0,     8240,  4112,  4144,  8240,  0,     0,     12424, 4144,  4112,  8264,  12376,
    12376, 8264,  12424, 0,     0,     4112,  8240,  4144,  0,     0,     4144,  12424, 8264,
    4112,  12376, 12376, 12424, 8264,  848,   2504,  4976,  6616,  6616,  9112,  2504,  848,
    10768, 13280, 13280, 4976,  9112,  14928, 14928, 10768, 2504,  848,   6616,  4976,  9112,
    6616,  848,   2504,  13280, 10768, 4976,  13280, 14928, 9112,  10768, 14928, 13280, 848,
    9112,  13280, 2504,  4976,  848,   2504,  14928, 10768, 10768, 14928, 4976,  6616,  6616,
    9112,  848,   13280, 13280, 9112,  4976,  2504,  2504,  848,   10768, 14928, 14928, 10768,
    6616,  4976,  9112,  6616,  4112,  12424, 0,     4144,  0,     0,     12424, 0,     8264,
    4112,  4144,  8240,  8240,  8264,  12376, 12376, 12424, 4112,  4144,  0,     0,     0,
    0,     0,     12424, 8264,  8240,  4144,  8264,  8240,  12376, 12376, 8264};

const char* BlockOfAt128(std::span<const char> payload, std::size_t block) {
  return payload.data() + kFirstBlock + block * kBlockBytes;
}

double BlockDeg(const char* block) {
  const auto fine = LoadAt<std::uint8_t>(block + sizeof(std::uint16_t));
  return kAzimuthUnit_deg * (LoadAt<std::uint16_t>(block) + fine / 256.0);
}

/// As HesaiStatedNs(), or by the seconds since 1970 that stand in place of a date if its first byte
/// is 0.
std::int64_t StatedNsOfAt128(std::span<const char> payload) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint8_t>(payload[kTail.date_place + i]);
  };
  if (byte(0) != 0) return HesaiStatedNs(kTail, 1900, payload);
  std::int64_t seconds = 0;
  for (std::size_t i = 2; i < 6; ++i) seconds = 256 * seconds + byte(i);
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + kTail.time_place);
  return seconds * kNsPerS + kNsPerUs * time_us;
}

std::uint8_t ModeOfAt128(std::span<const char> payload) {
  return static_cast<std::uint8_t>(payload[kTail.mode_place]);
}

bool IsDualAt128(std::span<const char> payload) {
  return ModeOfAt128(payload) == kHesaiLastAndStrongest;
}

std::optional<std::string> RefuseAt128(std::span<const char> payload) {
  if (payload.size() != kAt128PacketSize) {
    return "must be 1118 bytes" + Got(payload.size());
  }
  if (!IsAt128Packet(payload)) return "must begin as an AT128's, protocol 4.3, 2 blocks of 128";
  if (!HasRightHesaiChecksums(kAt128CheckedBytes, payload)) return std::string(kWrongChecksum);
  if (payload[kUnit] == 0) return "distance unit must be > 0 (got 0)";
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + kTail.time_place);
  if (time_us >= 1'000'000) return "microseconds of the second must be < 1000000" + Got(time_us);
  const std::uint8_t mode = ModeOfAt128(payload);
  if (mode != kHesaiStrongest && mode != kHesaiLast && mode != kHesaiLastAndStrongest) {
    return "return mode must be 55, 56 or 57" + Got(mode);
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const auto azimuth = LoadAt<std::uint16_t>(BlockOfAt128(payload, block));
    if (azimuth < kAzimuthUnitsPerTurn) continue;
    return "block " + NumberText(block) + ": azimuth must be <= 35999" + Got(azimuth);
  }
  return std::nullopt;
}

}  // namespace

std::vector<ChannelSpec> At128Channels(const At128Correction& correction) {
  std::vector<ChannelSpec> channels;
  for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
    channels.push_back(
        {.elevation_deg = correction.elevation_deg(laser), .time_us = 1e-3 * kFiring_ns[laser]});
  }
  return channels;
}

bool IsAt128Packet(std::span<const char> payload) {
  constexpr std::array<std::uint8_t, 4> kStart = {0xEE, 0xFF, 4, 3};
  if (payload.size() < kFirstBlock) return false;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(payload[i]); };
  for (std::size_t i = 0; i < kStart.size(); ++i) {
    if (byte(i) != kStart[i]) return false;
  }
  return byte(6) == kAt128Lasers && byte(7) == kBlocks;
}

At128Decoder::At128Decoder(std::shared_ptr<const At128Correction> correction)
    : correction_(std::move(correction)), rows_(RowsByElevation(At128Channels(*correction_))) {}

std::optional<std::string> At128Decoder::Decode(std::span<const char> payload,
                                                std::vector<SensorTurn>& turns) {
  ++num_packets_;
  if (auto refusal = RefuseAt128(payload)) return refusal;
  for (std::size_t block = 0; block < kBlocks; block += IsDualAt128(payload) ? 2 : 1) {
    AddColumn(payload, block, turns);
  }
  return std::nullopt;
}

SensorTurn At128Decoder::TakeUnfinished() {
  field_.reset();
  return std::exchange(turn_, {});
}

std::optional<std::string> At128Decoder::Store(const EditedReturns& returns,
                                               const FiringPlace& place,
                                               std::span<char> packet) const {
  const double unit_m = 1e-3 * static_cast<std::uint8_t>(packet[kUnit]);
  return StoreReturns(returns, place, {.unit_m = unit_m}, packet);
}

void At128Decoder::Seal(std::span<char> packet) const {
  StoreHesaiChecksums(kAt128CheckedBytes, packet);
}

void At128Decoder::AddColumn(std::span<const char> payload,
                             std::size_t block,
                             std::vector<SensorTurn>& turns) {
  const bool is_dual = IsDualAt128(payload);
  const char* const begin = BlockOfAt128(payload, block);
  const double block_deg = BlockDeg(begin);
  const std::size_t field = correction_->FieldAt(block_deg);
  if ((field_ && field != *field_) || turn_.num_columns() >= kMaxTurnColumns) {
    turns.push_back(TakeUnfinished());
  }
  const auto blocks_left = static_cast<std::int64_t>(is_dual ? 1 : kBlocks - block);
  const std::int64_t time_ns = StatedNsOfAt128(payload) + kEnd_ns - kBlock_ns * blocks_left;
  if (!field_) turn_.stamp_ns = time_ns;
  field_ = field;
  turn_.is_dual = turn_.is_dual || is_dual;
  TurnPoint point{};
  point.column = static_cast<std::uint32_t>(turn_.num_columns());
  turn_.column_time_ns.push_back(time_ns - turn_.stamp_ns);
  turn_.aims.push_back({.azimuth_deg = block_deg});
  turn_.places.resize(turn_.num_columns() * kAt128Lasers);
  const double unit_m = 1e-3 * static_cast<std::uint8_t>(payload[kUnit]);
  for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
    const char* const place = begin + kBlockHead + laser * kReturnBytes;
    const auto in_packet = static_cast<std::uint32_t>(place - payload.data());
    turn_.places[point.column * kAt128Lasers + rows_[laser]] = {
        .packet = num_packets_ - 1,
        .first = in_packet,
        .second = is_dual ? in_packet + static_cast<std::uint32_t>(kBlockBytes) : 0};
    point.laser = static_cast<std::uint8_t>(laser);
    point.ring = rows_[laser];
    point.time_ns = turn_.column_time_ns.back() + kFiring_ns[laser];
    point.return_index = 0;
    AddPoint(place, unit_m, block_deg, point);
    constexpr std::size_t kMeasured = 3;  // Distance and reflectivity.
    if (!is_dual || std::equal(place, place + kMeasured, place + kBlockBytes)) continue;
    point.return_index = 1;
    AddPoint(place + kBlockBytes, unit_m, block_deg, point);
  }
}

void At128Decoder::AddPoint(const char* place, double unit_m, double block_deg, TurnPoint point) {
  const auto distance = LoadAt<std::uint16_t>(place);
  if (distance == 0) return;
  const auto [azimuth_deg, elevation_deg] = correction_->At(block_deg, *field_, point.laser);
  const double range_m = distance * unit_m;
  const double azimuth_rad = RadFromDeg(azimuth_deg);
  const double horizontal_m = range_m * std::cos(RadFromDeg(elevation_deg));
  point.range_m = static_cast<float>(range_m);
  point.azimuth_rad = static_cast<float>(azimuth_rad);
  point.x = static_cast<float>(horizontal_m * std::cos(azimuth_rad));
  point.y = static_cast<float>(-horizontal_m * std::sin(azimuth_rad));
  point.z = static_cast<float>(range_m * std::sin(RadFromDeg(elevation_deg)));
  point.intensity = LoadAt<std::uint8_t>(place + sizeof distance);
  turn_.points.push_back(point);
}

}  // namespace railcast
