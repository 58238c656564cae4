#include "core/io/hesai/hesai_decoder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

constexpr std::int64_t kUsPerSecond = 1'000'000;
/// Of a return: distance and reflectivity. Reserved bytes may follow.
constexpr std::size_t kMeasuredSize = 3;
constexpr double kDegPerUsPerRpm = 360.0 / 60e6;

std::uint8_t ByteAt(std::span<const char> payload, std::size_t place) {
  return static_cast<std::uint8_t>(payload[place]);
}

const char* BlockOf(std::span<const char> payload, const HesaiLayout& layout, std::size_t index) {
  return payload.data() + layout.header_size + index * layout.block_size();
}

bool IsDual(const HesaiModel& model, std::uint8_t mode) {
  return std::ranges::count(model.dual_modes, mode) > 0;
}

std::size_t BlocksPerLoop(const HesaiModel& model, std::span<const char> payload) {
  return IsDual(model, ByteAt(payload, model.layout.mode_place)) ? 2 : 1;
}

std::optional<std::string> RefuseMode(const HesaiModel& model, std::uint8_t mode) {
  std::vector<std::uint8_t> modes = model.single_modes;
  modes.insert(modes.end(), model.dual_modes.begin(), model.dual_modes.end());
  if (std::ranges::count(modes, mode) > 0) return std::nullopt;
  std::string rule = "return mode must be ";
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (i > 0) rule += i + 1 < modes.size() ? ", " : " or ";
    rule += NumberText(modes[i]);
  }
  return rule + Got(mode);
}

std::optional<std::string> RefuseHeader(const HesaiLayout& layout, std::span<const char> payload) {
  if (payload.size() != layout.packet_size) {
    return "must be " + NumberText(layout.packet_size) + " bytes" + Got(payload.size());
  }
  const auto flag = LoadAt<std::uint16_t>(payload.data());
  if (flag != kHesaiFlag) return "flag must be 65518" + Got(flag);
  if (layout.version) {
    const auto text = [](std::uint8_t major, std::uint8_t minor) {
      return NumberText(major) + "." + NumberText(minor);
    };
    const auto [major, minor] = *layout.version;
    if (ByteAt(payload, 2) != major || ByteAt(payload, 3) != minor) {
      return "protocol must be " + text(major, minor) + " (got " +
             text(ByteAt(payload, 2), ByteAt(payload, 3)) + ")";
    }
  }
  const std::uint8_t lasers = ByteAt(payload, layout.lasers_place);
  if (lasers != layout.lasers) return "lasers must be " + NumberText(layout.lasers) + Got(lasers);
  const std::uint8_t blocks = ByteAt(payload, layout.blocks_place);
  if (blocks != layout.blocks) return "blocks must be " + NumberText(layout.blocks) + Got(blocks);
  if (ByteAt(payload, layout.unit_place) == 0) return "distance unit must be > 0" + Got(0);
  return std::nullopt;
}

// Returns why the payload is not a data packet of this sensor, or nothing if it is one.
std::optional<std::string> RefuseHesai(const HesaiModel& model, std::span<const char> payload) {
  const HesaiLayout& layout = model.layout;
  if (auto refusal = RefuseHeader(layout, payload)) return refusal;
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + layout.time_place);
  if (time_us >= kUsPerSecond) {
    return "microseconds of the second must be < 1000000" + Got(time_us);
  }
  if (auto refusal = RefuseMode(model, ByteAt(payload, layout.mode_place))) return refusal;
  const std::size_t in_group = BlocksPerLoop(model, payload);
  for (std::size_t i = 0; i < layout.blocks; ++i) {
    const auto azimuth = LoadAt<std::uint16_t>(BlockOf(payload, layout, i));
    if (azimuth >= kAzimuthUnitsPerTurn) {
      return "block " + NumberText(i) + ": azimuth must be <= 35999" + Got(azimuth);
    }
    if (azimuth != LoadAt<std::uint16_t>(BlockOf(payload, layout, i / in_group * in_group))) {
      return "block " + NumberText(i) + ": azimuth must be that of its pair" + Got(azimuth);
    }
  }
  return std::nullopt;
}

// The time that the packet states, since 1970.
std::int64_t PacketNs(const HesaiLayout& layout, std::span<const char> payload) {
  const auto date = [&](std::size_t i) { return ByteAt(payload, layout.date_place + i); };
  const std::chrono::year_month_day day(std::chrono::year(1900 + date(0)),
                                        std::chrono::month(date(1)), std::chrono::day(date(2)));
  const std::int64_t days = day.ok() ? std::chrono::sys_days(day).time_since_epoch().count() : 0;
  const std::int64_t hours = 24 * days + date(3);
  const std::int64_t seconds = 3600 * hours + std::int64_t{60} * date(4) + date(5);
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + layout.time_place);
  return (seconds * kUsPerSecond + time_us) * 1000;
}

}  // namespace

HesaiDecoder::HesaiDecoder(const HesaiModel& model) : model_(&model) {
  const std::vector<std::uint16_t> rows = RowsByElevation(model.channels);
  std::size_t next = 0;
  for (std::size_t loop = 0; loop < model.loops.size(); ++loop) {
    const double loop_us = 1e-3 * static_cast<double>(model.loop_ns) * static_cast<double>(loop);
    std::vector<Channel>& channels = loops_.emplace_back();
    for (const std::uint8_t laser : model.loops[loop]) {
      const ChannelSpec& spec = model.channels[next];
      const double elevation_rad = RadFromDeg(spec.elevation_deg);
      channels.push_back(
          {.sine = std::sin(elevation_rad),
           .cosine = std::cos(elevation_rad),
           .azimuth_deg = spec.azimuth_deg,
           .turned_us = model.turned_us ? *model.turned_us + spec.time_us - loop_us : 0.0,
           .time_ns = std::llround(spec.time_us * 1e3),
           .ring = rows[next++],
           .laser = laser});
    }
  }
}

std::optional<std::string> HesaiDecoder::Decode(std::span<const char> payload,
                                                std::vector<SensorTurn>& turns) {
  if (auto refusal = RefuseHesai(*model_, payload)) return refusal;
  const std::size_t in_group = BlocksPerLoop(*model_, payload);
  for (std::size_t i = 0; i < model_->layout.blocks; i += in_group) {
    Take(GroupOf(payload, i), turns);
  }
  return std::nullopt;
}

HesaiDecoder::Group HesaiDecoder::GroupOf(std::span<const char> payload, std::size_t block) const {
  const HesaiLayout& layout = model_->layout;
  const std::size_t in_group = BlocksPerLoop(*model_, payload);
  const char* const blocks = BlockOf(payload, layout, block);
  const auto speed_rpm = LoadAt<std::uint16_t>(payload.data() + layout.speed_place);
  const auto loops_left = static_cast<std::int64_t>((layout.blocks - block) / in_group) - 1;
  // An odd flag says that the packet begins with the first loop; from there on they alternate.
  const std::size_t loop =
      layout.loop_place
          ? (ByteAt(payload, *layout.loop_place) + block / in_group + 1) % model_->loops.size()
          : 0;
  return {
      .blocks = {blocks, blocks + in_group * layout.block_size()},
      .loop = loop,
      .time_ns = PacketNs(layout, payload) + model_->last_loop_ns - model_->loop_ns * loops_left,
      .azimuth = LoadAt<std::uint16_t>(blocks),
      .unit_m = 1e-3 * ByteAt(payload, layout.unit_place),
      .speed_deg_per_us = kDegPerUsPerRpm * speed_rpm,
      .is_dual = in_group == 2};
}

void HesaiDecoder::Take(Group group, std::vector<SensorTurn>& turns) {
  const bool follows =
      !cycle_.empty() && group.loop == cycle_.size() &&
      2 * std::abs(group.time_ns - cycle_.back().time_ns - model_->loop_ns) < model_->loop_ns;
  if (!follows) cycle_.clear();
  if (group.loop != cycle_.size()) return;
  cycle_.push_back(std::move(group));
  if (cycle_.size() < loops_.size()) return;
  AddCycle(turns);
  cycle_.clear();
}

SensorTurn HesaiDecoder::TakeUnfinished() {
  last_azimuth_.reset();
  return std::exchange(turn_, {});
}

void HesaiDecoder::AddCycle(std::vector<SensorTurn>& turns) {
  const Group& first = cycle_.front();
  const bool is_new_turn = last_azimuth_ && first.azimuth < *last_azimuth_;
  if (is_new_turn || turn_.num_columns() >= kMaxTurnColumns) turns.push_back(TakeUnfinished());
  if (!last_azimuth_) turn_.stamp_ns = first.time_ns;
  last_azimuth_ = first.azimuth;
  turn_.column_time_ns.push_back(first.time_ns - turn_.stamp_ns);
  for (const Group& group : cycle_) AddGroup(group);
}

void HesaiDecoder::AddGroup(const Group& group) {
  const HesaiLayout& layout = model_->layout;
  turn_.is_dual = turn_.is_dual || group.is_dual;
  TurnPoint point{};
  point.column = static_cast<std::uint32_t>(turn_.num_columns() - 1);
  for (const Channel& channel : loops_[group.loop]) {
    const char* const place =
        group.blocks.data() + sizeof group.azimuth + channel.laser * layout.return_size;
    point.time_ns = turn_.column_time_ns.back() + channel.time_ns;
    point.ring = channel.ring;
    point.laser = channel.laser;
    point.return_index = 0;
    AddPoint(place, group, channel, point);
    if (!group.is_dual) continue;
    const char* const other = place + layout.block_size();
    if (std::equal(place, place + kMeasuredSize, other)) continue;
    point.return_index = 1;
    AddPoint(other, group, channel, point);
  }
}

void HesaiDecoder::AddPoint(const char* place,
                            const Group& group,
                            const Channel& channel,
                            TurnPoint point) {
  const auto distance = LoadAt<std::uint16_t>(place);
  if (distance == 0) return;
  const double range_m = distance * group.unit_m;
  const double azimuth_deg = group.azimuth * kAzimuthUnit_deg + channel.azimuth_deg +
                             group.speed_deg_per_us * channel.turned_us;
  const double azimuth_rad = RadFromDeg(azimuth_deg - 360.0 * std::floor(azimuth_deg / 360.0));
  const double horizontal_m = range_m * channel.cosine;
  point.range_m = static_cast<float>(range_m);
  point.azimuth_rad = static_cast<float>(azimuth_rad);
  point.x = static_cast<float>(horizontal_m * std::cos(azimuth_rad));
  point.y = static_cast<float>(-horizontal_m * std::sin(azimuth_rad));
  point.z = static_cast<float>(range_m * channel.sine);
  point.intensity = LoadAt<std::uint8_t>(place + sizeof distance);
  turn_.points.push_back(point);
}

}  // namespace railcast
