#include "core/io/hesai/hesai_decoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/hesai/hesai_packet.h"
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
  return payload.data() + layout.BlockPlace(index);
}

std::uint16_t BlockAzimuth(std::span<const char> payload,
                           const HesaiLayout& layout,
                           std::size_t block) {
  const std::size_t place = layout.block_head_size() - sizeof(std::uint16_t);
  return LoadAt<std::uint16_t>(BlockOf(payload, layout, block) + place);
}

std::uint8_t ModeOf(const HesaiLayout& layout, std::span<const char> payload) {
  return ByteAt(payload, layout.tail.mode_place);
}

double UnitOf(const HesaiLayout& layout, std::span<const char> payload) {
  return 1e-3 * (layout.header ? ByteAt(payload, layout.header->unit_place) : kHesaiUnit_mm);
}

std::size_t BlocksPerLoop(const HesaiModel& model, std::span<const char> payload) {
  return model.IsDual(ModeOf(model.layout, payload)) ? 2 : 1;
}

/// The loop of a block, by what the packet says; it may be one that the sensor does not have.
std::size_t LoopOf(const HesaiModel& model, std::span<const char> payload, std::size_t block) {
  const HesaiLayout& layout = model.layout;
  if (layout.state_place) {
    const auto states = LoadAt<std::uint16_t>(payload.data() + *layout.state_place);
    return (states >> (14 - 2 * block)) & 3U;
  }
  if (!layout.loop_place) return 0;
  // An odd flag says that the packet begins with the first loop; from there on they alternate.
  const std::size_t begins = ByteAt(payload, *layout.loop_place);
  return (begins + block / BlocksPerLoop(model, payload) + 1) % model.loops.size();
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

std::optional<std::string> RefuseVersion(const HesaiHeader& header, std::span<const char> payload) {
  if (!header.version) return std::nullopt;
  const auto text = [](std::uint8_t major, std::uint8_t minor) {
    return NumberText(major) + "." + NumberText(minor);
  };
  const auto [major, minor] = *header.version;
  if (ByteAt(payload, 2) == major && ByteAt(payload, 3) == minor) return std::nullopt;
  return "protocol must be " + text(major, minor) + " (got " +
         text(ByteAt(payload, 2), ByteAt(payload, 3)) + ")";
}

std::optional<std::string> RefuseHeader(const HesaiLayout& layout, std::span<const char> payload) {
  if (payload.size() != layout.packet_size) {
    return "must be " + NumberText(layout.packet_size) + " bytes" + Got(payload.size());
  }
  if (!layout.header) return std::nullopt;
  const HesaiHeader& header = *layout.header;
  const auto flag = LoadAt<std::uint16_t>(payload.data());
  if (flag != kHesaiFlag) return "flag must be 65518" + Got(flag);
  if (auto refusal = RefuseVersion(header, payload)) return refusal;
  const std::uint8_t lasers = ByteAt(payload, header.lasers_place);
  if (lasers != layout.lasers) return "lasers must be " + NumberText(layout.lasers) + Got(lasers);
  const std::uint8_t blocks = ByteAt(payload, header.blocks_place);
  if (blocks != layout.blocks) return "blocks must be " + NumberText(layout.blocks) + Got(blocks);
  if (ByteAt(payload, header.unit_place) == 0) return "distance unit must be > 0" + Got(0);
  return std::nullopt;
}

std::optional<std::string> RefuseTail(const HesaiModel& model, std::span<const char> payload) {
  const HesaiLayout& layout = model.layout;
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + layout.tail.time_place);
  if (time_us >= kUsPerSecond) {
    return "microseconds of the second must be < 1000000" + Got(time_us);
  }
  if (layout.mark && ByteAt(payload, layout.mark->place) != layout.mark->value) {
    return std::string(layout.mark->what) + " must be " + NumberText(layout.mark->value) +
           Got(ByteAt(payload, layout.mark->place));
  }
  return RefuseMode(model, ModeOf(layout, payload));
}

std::optional<std::string> RefuseBlock(const HesaiModel& model,
                                       std::span<const char> payload,
                                       std::size_t block) {
  const HesaiLayout& layout = model.layout;
  const std::string place = "block " + NumberText(block) + ": ";
  const auto flag = LoadAt<std::uint16_t>(BlockOf(payload, layout, block));
  if (layout.has_block_flags && flag != kHesaiBlockFlag) {
    return place + "flag must be 61183" + Got(flag);
  }
  const std::uint16_t azimuth = BlockAzimuth(payload, layout, block);
  if (azimuth >= kAzimuthUnitsPerTurn) return place + "azimuth must be <= 35999" + Got(azimuth);
  const std::size_t in_group = BlocksPerLoop(model, payload);
  const std::size_t first = block / in_group * in_group;
  if (azimuth != BlockAzimuth(payload, layout, first)) {
    return place + "azimuth must be that of its pair" + Got(azimuth);
  }
  const std::size_t loop = LoopOf(model, payload, block);
  if (loop >= model.loops.size()) return place + "azimuth state must be 0 or 1" + Got(loop);
  if (loop != LoopOf(model, payload, first)) {
    return place + "azimuth state must be that of its pair" + Got(loop);
  }
  return std::nullopt;
}

// Returns why the payload is not a data packet of this sensor, or nothing if it is one.
std::optional<std::string> RefuseHesai(const HesaiModel& model, std::span<const char> payload) {
  if (auto refusal = RefuseHeader(model.layout, payload)) return refusal;
  if (!HasRightHesaiChecksums(HesaiCheckedBytesOf(model.layout), payload)) {
    return std::string(kWrongChecksum);
  }
  if (auto refusal = RefuseTail(model, payload)) return refusal;
  for (std::size_t i = 0; i < model.layout.blocks; ++i) {
    if (auto refusal = RefuseBlock(model, payload, i)) return refusal;
  }
  return std::nullopt;
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
  ++num_packets_;
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
  const auto speed_rpm = LoadAt<std::uint16_t>(payload.data() + layout.tail.speed_place);
  const auto loops_before = static_cast<std::int64_t>(block / in_group);
  const auto loops_left = static_cast<std::int64_t>((layout.blocks - block) / in_group) - 1;
  const std::int64_t since_stated_ns =
      model_->loop_ns * (model_->states_first ? loops_before : -loops_left);
  const std::uint8_t mode = ModeOf(layout, payload);
  return {.blocks = {blocks, blocks + in_group * layout.block_size()},
          .packet = num_packets_ - 1,
          .place = static_cast<std::uint32_t>(layout.BlockPlace(block)),
          .loop = LoopOf(*model_, payload, block),
          .time_ns = HesaiStatedNs(layout.tail, model_->year_zero, payload) +
                     model_->stated_loop_ns + since_stated_ns,
          .azimuth = BlockAzimuth(payload, layout, block),
          .unit_m = UnitOf(layout, payload),
          .speed_deg_per_us = kDegPerUsPerRpm * speed_rpm,
          .is_dual = in_group == 2,
          .has_last_second = mode == kHesaiFirstAndLast && !model_->has_last_first};
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

std::optional<std::string> HesaiDecoder::Store(const EditedReturns& returns,
                                               const FiringPlace& place,
                                               std::span<char> packet) const {
  const std::uint8_t mode = ModeOf(model_->layout, packet);
  const auto none = model_->near_limits ? HesaiNoPoint::kNoReturn : HesaiNoPoint::kNotFired;
  return StoreReturns(returns, place,
                      {.unit_m = UnitOf(model_->layout, packet),
                       .least = model_->least_distance(),
                       .none = static_cast<std::uint16_t>(none),
                       .has_last = mode == kHesaiLastAndStrongest || mode == kHesaiFirstAndLast},
                      packet);
}

void HesaiDecoder::Seal(std::span<char> packet) const {
  StoreHesaiChecksums(HesaiCheckedBytesOf(model_->layout), packet);
}

void HesaiDecoder::AddCycle(std::vector<SensorTurn>& turns) {
  const Group& first = cycle_.front();
  const bool is_new_turn = last_azimuth_ && first.azimuth < *last_azimuth_;
  if (is_new_turn || turn_.num_columns() >= kMaxTurnColumns) turns.push_back(TakeUnfinished());
  if (!last_azimuth_) turn_.stamp_ns = first.time_ns;
  last_azimuth_ = first.azimuth;
  turn_.column_time_ns.push_back(first.time_ns - turn_.stamp_ns);
  turn_.places.resize(turn_.num_columns() * model_->channels.size());
  for (const Group& group : cycle_) AddGroup(group);
}

void HesaiDecoder::AddGroup(const Group& group) {
  const HesaiLayout& layout = model_->layout;
  turn_.is_dual = turn_.is_dual || group.is_dual;
  turn_.aims.push_back({group.azimuth * kAzimuthUnit_deg, group.speed_deg_per_us});
  TurnPoint point{};
  point.column = static_cast<std::uint32_t>(turn_.num_columns() - 1);
  for (const Channel& channel : loops_[group.loop]) {
    const std::size_t in_block = layout.block_head_size() + channel.laser * layout.return_size;
    const char* place = group.blocks.data() + in_block;
    FiringPlace& firing = turn_.places[point.column * model_->channels.size() + channel.ring];
    firing = {.packet = group.packet, .first = group.place + static_cast<std::uint32_t>(in_block)};
    point.time_ns = turn_.column_time_ns.back() + channel.time_ns;
    point.ring = channel.ring;
    point.laser = channel.laser;
    point.return_index = 0;
    if (!group.is_dual) {
      AddPoint(place, group, channel, point);
      continue;
    }
    const char* other = place + layout.block_size();
    firing.second = firing.first + static_cast<std::uint32_t>(layout.block_size());
    if (group.has_last_second) {
      std::swap(place, other);
      std::swap(firing.first, firing.second);
    }
    AddPoint(place, group, channel, point);
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
  if (distance < model_->least_distance()) return;
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
