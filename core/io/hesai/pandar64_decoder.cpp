#include "core/io/hesai/pandar64_decoder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/hesai/pandar64_packet.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/channel_rows.h"

namespace railcast {
namespace {

constexpr std::int64_t kUsPerSecond = 1'000'000;
constexpr std::int64_t kLastBlockToEnd_ns = 42'580;
constexpr std::int64_t kCycle_ns = 55'560;
/// Time from the first firing of a cycle to the end of its block.
constexpr std::int64_t kFirstToBlockEnd_ns = 54'668;

std::uint8_t ByteAt(std::span<const char> payload, std::size_t place) {
  return static_cast<std::uint8_t>(payload[place]);
}

const char* BlockOf(std::span<const char> payload, std::size_t index) {
  return payload.data() + kPandar64HeaderSize + index * kPandar64BlockSize;
}

bool IsDual(std::uint8_t mode) {
  return mode == kPandar64LastAndStrongest || mode == kPandar64FirstAndLast ||
         mode == kPandar64FirstAndStrongest;
}

bool IsMode(std::uint8_t mode) {
  return IsDual(mode) || mode == kPandar64First || mode == kPandar64Strongest ||
         mode == kPandar64Last;
}

std::optional<std::string> RefuseEnds(std::span<const char> payload) {
  if (payload.size() != kPandar64PacketSize) return "must be 1198 bytes" + Got(payload.size());
  const auto flag = LoadAt<std::uint16_t>(payload.data());
  if (flag != kHesaiFlag) return "flag must be 65518" + Got(flag);
  const std::uint8_t lasers = ByteAt(payload, kPandar64LasersPlace);
  if (lasers != kPandar64Lasers) return "lasers must be 64" + Got(lasers);
  const std::uint8_t blocks = ByteAt(payload, kPandar64BlocksPlace);
  if (blocks != kPandar64Blocks) return "blocks must be 6" + Got(blocks);
  if (ByteAt(payload, kPandar64UnitPlace) == 0) return "distance unit must be > 0" + Got(0);
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + kPandar64TimePlace);
  if (time_us >= kUsPerSecond) {
    return "microseconds of the second must be < 1000000" + Got(time_us);
  }
  const std::uint8_t mode = ByteAt(payload, kPandar64ModePlace);
  if (!IsMode(mode)) return "return mode must be 51, 55, 56, 57, 59 or 60" + Got(mode);
  return std::nullopt;
}

// Returns why the payload is not a data packet of this sensor, or nothing if it is one.
std::optional<std::string> RefusePandar64(std::span<const char> payload) {
  if (auto refusal = RefuseEnds(payload)) return refusal;
  const std::size_t in_group = IsDual(ByteAt(payload, kPandar64ModePlace)) ? 2 : 1;
  for (std::size_t i = 0; i < kPandar64Blocks; ++i) {
    const auto azimuth = LoadAt<std::uint16_t>(BlockOf(payload, i));
    if (azimuth >= kAzimuthUnitsPerTurn) {
      return "block " + NumberText(i) + ": azimuth must be <= 35999" + Got(azimuth);
    }
    if (azimuth != LoadAt<std::uint16_t>(BlockOf(payload, i / in_group * in_group))) {
      return "block " + NumberText(i) + ": azimuth must be that of its pair" + Got(azimuth);
    }
  }
  return std::nullopt;
}

// The time at which the packet ends, since 1970.
std::int64_t PacketNs(std::span<const char> payload) {
  const auto date = [&](std::size_t i) { return ByteAt(payload, kPandar64DatePlace + i); };
  const std::chrono::year_month_day day(std::chrono::year(1900 + date(0)),
                                        std::chrono::month(date(1)), std::chrono::day(date(2)));
  const std::int64_t days = day.ok() ? std::chrono::sys_days(day).time_since_epoch().count() : 0;
  const std::int64_t hours = 24 * days + date(3);
  const std::int64_t seconds = 3600 * hours + std::int64_t{60} * date(4) + date(5);
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + kPandar64TimePlace);
  return (seconds * kUsPerSecond + time_us) * 1000;
}

}  // namespace

Pandar64Decoder::Pandar64Decoder() {
  const std::vector<ChannelSpec>& channels = Pandar64Channels();
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const double elevation_rad = RadFromDeg(channels[i].elevation_deg);
    lasers_.push_back({.sine = std::sin(elevation_rad),
                       .cosine = std::cos(elevation_rad),
                       .azimuth_deg = channels[i].azimuth_deg,
                       .time_ns = std::llround(channels[i].time_us * 1e3),
                       .ring = rows[i]});
  }
}

std::optional<std::string> Pandar64Decoder::Decode(std::span<const char> payload,
                                                   std::vector<SensorTurn>& turns) {
  if (auto refusal = RefusePandar64(payload)) return refusal;
  const bool is_dual = IsDual(ByteAt(payload, kPandar64ModePlace));
  const std::size_t in_group = is_dual ? 2 : 1;
  const std::int64_t packet_ns = PacketNs(payload);
  for (std::size_t i = 0; i < kPandar64Blocks; i += in_group) {
    const char* const blocks = BlockOf(payload, i);
    const Group group{.blocks = blocks,
                      .azimuth = LoadAt<std::uint16_t>(blocks),
                      .unit_m = 1e-3 * ByteAt(payload, kPandar64UnitPlace),
                      .is_dual = is_dual};
    const auto cycles_left = static_cast<std::int64_t>((kPandar64Blocks - i) / in_group) - 1;
    const std::int64_t time_ns =
        packet_ns - kLastBlockToEnd_ns - kCycle_ns * cycles_left - kFirstToBlockEnd_ns;
    const bool is_new_turn = last_azimuth_ && group.azimuth < *last_azimuth_;
    if (is_new_turn || turn_.num_columns() >= kMaxTurnColumns) turns.push_back(TakeUnfinished());
    if (!last_azimuth_) turn_.stamp_ns = time_ns;
    last_azimuth_ = group.azimuth;
    DecodeGroup(group, time_ns - turn_.stamp_ns);
  }
  return std::nullopt;
}

SensorTurn Pandar64Decoder::TakeUnfinished() {
  last_azimuth_.reset();
  return std::exchange(turn_, {});
}

void Pandar64Decoder::DecodeGroup(const Group& group, std::int64_t since_stamp_ns) {
  turn_.is_dual = turn_.is_dual || group.is_dual;
  TurnPoint point{};
  point.column = static_cast<std::uint32_t>(turn_.num_columns());
  turn_.column_time_ns.push_back(since_stamp_ns);
  for (std::size_t i = 0; i < lasers_.size(); ++i) {
    const char* const place = group.blocks + sizeof group.azimuth + i * kPandar64ReturnSize;
    point.time_ns = since_stamp_ns + lasers_[i].time_ns;
    point.ring = lasers_[i].ring;
    point.laser = static_cast<std::uint8_t>(i);
    point.return_index = 0;
    AddPoint(place, group, point);
    if (!group.is_dual) continue;
    const char* const other = place + kPandar64BlockSize;
    if (std::equal(place, place + kPandar64ReturnSize, other)) continue;
    point.return_index = 1;
    AddPoint(other, group, point);
  }
}

void Pandar64Decoder::AddPoint(const char* place, const Group& group, TurnPoint point) {
  const auto distance = LoadAt<std::uint16_t>(place);
  if (distance == 0) return;
  const Laser& laser = lasers_[point.laser];
  const double range_m = distance * group.unit_m;
  const double azimuth_deg = group.azimuth * kAzimuthUnit_deg + laser.azimuth_deg;
  const double azimuth_rad = RadFromDeg(azimuth_deg - 360.0 * std::floor(azimuth_deg / 360.0));
  const double horizontal_m = range_m * laser.cosine;
  point.range_m = static_cast<float>(range_m);
  point.azimuth_rad = static_cast<float>(azimuth_rad);
  point.x = static_cast<float>(horizontal_m * std::cos(azimuth_rad));
  point.y = static_cast<float>(-horizontal_m * std::sin(azimuth_rad));
  point.z = static_cast<float>(range_m * laser.sine);
  point.intensity = LoadAt<std::uint8_t>(place + sizeof distance);
  turn_.points.push_back(point);
}

}  // namespace railcast
