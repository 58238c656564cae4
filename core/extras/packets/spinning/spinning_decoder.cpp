#include "core/extras/packets/spinning/spinning_decoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/units.h"
#include "core/extras/packets/spinning/scan_fit.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scan/at128.h"

namespace railcast {
namespace {

/// Bytes of a return: distance and intensity. Reserved bytes may follow.
constexpr std::size_t kMeasuredSize = 3;
constexpr double kDegPerUsPerRpm = 360.0 / 60e6;

}  // namespace

SpinningDecoder::SpinningDecoder(SpinningModel model)
    : model_(std::move(model)), loops_(model_.loops.size()), cycle_(model_.loops.size()) {
  const std::vector<PacketFiring> firings = FiringsOf(model_, model_.channels);
  for (std::uint32_t cycle = 0; cycle < model_.cycles_per_block(); ++cycle) {
    const double cycle_us = cycle * model_.cycle_us;
    for (std::size_t i = 0; i < firings.size(); ++i) {
      const ChannelSpec& spec = model_.channels[i];
      const double elevation_rad = RadFromDeg(spec.elevation_deg);
      const std::size_t place =
          model_.ReturnPlace(0, cycle * firings.size() + firings[i].laser) - model_.header_size;
      loops_[firings[i].loop].push_back({.sine = std::sin(elevation_rad),
                                         .cosine = std::cos(elevation_rad),
                                         .azimuth_deg = spec.azimuth_deg,
                                         .turned_us = cycle_us + firings[i].turned_us,
                                         .time_ns = std::llround(spec.time_us * 1e3),
                                         .cycle = cycle,
                                         .place = static_cast<std::uint32_t>(place),
                                         .ring = firings[i].row,
                                         .laser = firings[i].laser});
    }
  }
}

std::int64_t SpinningDecoder::PacketNs(std::uint32_t us_past_hour) {
  // Keeps a clock that jumps ahead with every packet from overflowing the counter.
  constexpr std::int64_t kMostHours = 10'000;
  if (!last_packet_us_ || std::abs(*last_packet_us_) > kMostHours * kUsPerHour) {
    last_packet_us_ = us_past_hour;
  }
  // Take the nearest time that has these microseconds, since packets may also come late.
  std::int64_t since_last_us = (us_past_hour - *last_packet_us_ % kUsPerHour) % kUsPerHour;
  if (since_last_us > kUsPerHour / 2) since_last_us -= kUsPerHour;
  if (since_last_us < -kUsPerHour / 2) since_last_us += kUsPerHour;
  *last_packet_us_ += since_last_us;
  return *last_packet_us_ * kNsPerUs;
}

std::optional<std::string> SpinningDecoder::Refuse(std::span<const char> payload) const {
  return RefusePacket(model_, payload);
}

PacketMark SpinningDecoder::MarkOf(std::span<const char> payload) const {
  return railcast::MarkOf(model_, payload);
}

std::size_t SpinningDecoder::NumEmptyBlocks(std::span<const char> payload) const {
  return model_.blocks - LoopsIn(model_, payload).size() * BlocksInGroup(model_, payload);
}

void SpinningDecoder::TakePacket(std::span<const char> payload, std::vector<SensorTurn>& turns) {
  ++num_packets_;
  if (model_.date_place > 0) {
    TakeDated(payload, turns);
  } else {
    TakeUndated(payload, turns);
  }
}

void SpinningDecoder::TakeDated(std::span<const char> payload, std::vector<SensorTurn>& turns) {
  const std::size_t in_group = BlocksInGroup(model_, payload);
  const auto speed_rpm = LoadAt<std::uint16_t>(payload.data() + model_.speed_place);
  const double speed_deg_per_us = model_.correction ? 0.0 : kDegPerUsPerRpm * speed_rpm;
  const std::int64_t stated_ns = StatedNs(model_, payload) + model_.stated_loop_ns;
  for (const std::size_t i : LoopsIn(model_, payload)) {
    const auto loops_before = static_cast<std::int64_t>(i / in_group);
    const auto loops_left = static_cast<std::int64_t>((model_.blocks - i) / in_group) - 1;
    const std::int64_t loops = model_.states_first ? loops_before : -loops_left;
    Take(payload, i, stated_ns + model_.loop_ns * loops, speed_deg_per_us, turns);
  }
}

void SpinningDecoder::TakeUndated(std::span<const char> payload, std::vector<SensorTurn>& turns) {
  const std::size_t in_group = BlocksInGroup(model_, payload);
  const std::vector<std::size_t> loops = LoopsIn(model_, payload);
  const double group_us = static_cast<double>(model_.cycles_per_block()) * model_.cycle_us;
  const std::int64_t usual_step = UsualStep(model_, payload, loops);
  const double speed_deg_per_us = static_cast<double>(usual_step) * kAzimuthUnit_deg / group_us;
  const std::int64_t packet_ns =
      PacketNs(LoadAt<std::uint32_t>(payload.data() + model_.time_place));
  auto group_index = static_cast<std::int64_t>(loops.front() / in_group);
  for (const std::size_t i : loops) {
    const std::uint16_t azimuth = AzimuthOf(model_, payload, i);
    if (i > loops.front()) group_index += GroupsTo(azimuth, usual_step, 1e3 * group_us);
    const double since_packet_us = static_cast<double>(group_index) * group_us;
    last_group_ns_ = packet_ns + std::llround(since_packet_us * 1e3);
    Take(payload, i, last_group_ns_, speed_deg_per_us, turns);
    // Only a packet's first group has a time of its own.
    if (i == loops.front() && !stated_) stated_ = {azimuth, last_group_ns_};
  }
}

std::int64_t SpinningDecoder::GroupsTo(std::uint16_t azimuth,
                                       std::int64_t usual_step,
                                       double group_ns) const {
  const std::int64_t step = StepTo(azimuth, *last_azimuth_);
  // A rotor that trembles may seem to step back.
  constexpr std::int64_t kMostBack = 100;
  if (2 * step <= 3 * usual_step || step >= kAzimuthUnitsPerTurn - kMostBack) return 1;
  if (usual_step == 0) return 1;
  // The speed since the turn began is known better than that of a packet.
  const auto usual = static_cast<double>(usual_step);
  double units_per_group = usual;
  if (stated_ && last_group_ns_ > stated_->time_ns) {
    units_per_group = group_ns * (*last_azimuth_ - stated_->azimuth) /
                      static_cast<double>(last_group_ns_ - stated_->time_ns);
  }
  return std::llround(static_cast<double>(step) /
                      std::clamp(units_per_group, 0.5 * usual, 2.0 * usual));
}

void SpinningDecoder::Take(std::span<const char> payload,
                           std::size_t block,
                           std::int64_t time_ns,
                           double speed_deg_per_us,
                           std::vector<SensorTurn>& turns) {
  const std::size_t loop = LoopOf(model_, payload, block);
  const std::int64_t loop_ns = model_.loop_ns;
  const bool follows = num_loops_ > 0 && loop == num_loops_ &&
                       2 * std::abs(time_ns - cycle_[loop - 1].time_ns - loop_ns) < loop_ns;
  if (!follows) {
    for (; num_loops_ > 0; --num_loops_) LeaveOut(cycle_[num_loops_ - 1].packet);
  }
  // A recording may begin within a cycle.
  if (loop != num_loops_ && num_packets_ > 1) LeaveOut(num_packets_ - 1);
  if (loop != num_loops_) return;
  const std::size_t in_group = BlocksInGroup(model_, payload);
  const std::size_t place = model_.BlockPlace(block);
  const std::uint8_t mode = ModeOf(model_, payload);
  Group& group = cycle_[num_loops_++];
  group.blocks.assign(
      payload.begin() + static_cast<std::ptrdiff_t>(place),
      payload.begin() + static_cast<std::ptrdiff_t>(model_.BlockPlace(block + in_group)));
  group.packet = num_packets_ - 1;
  group.place = static_cast<std::uint32_t>(place);
  group.loop = loop;
  group.time_ns = time_ns;
  group.azimuth = AzimuthOf(model_, payload, block);
  const double fine =
      model_.has_fine_azimuth ? LoadAt<std::uint8_t>(payload.data() + place + 2) / 256.0 : 0.0;
  group.azimuth_deg = kAzimuthUnit_deg * (group.azimuth + fine);
  group.unit_m = UnitOf_m(model_, payload);
  group.speed_deg_per_us = speed_deg_per_us;
  group.is_dual = model_.IsDual(mode);
  group.has_last_second = mode == kFirstAndLastMode && !model_.has_last_first;
  if (num_loops_ < cycle_.size()) return;
  AddCycle(turns);
  num_loops_ = 0;
}

void SpinningDecoder::LeaveOut(std::uint32_t packet) {
  if (last_incomplete_ == packet) return;
  last_incomplete_ = packet;
  ++num_incomplete_;
}

SensorTurn SpinningDecoder::TakeUnfinished() {
  last_azimuth_.reset();
  stated_.reset();
  return std::exchange(turn_, {});
}

std::optional<std::string> SpinningDecoder::Store(const EditedReturns& returns,
                                                  const FiringPlace& place,
                                                  std::span<char> packet) const {
  const std::uint8_t mode = ModeOf(model_, packet);
  const bool says_why = model_.least_distance() > 1;
  const auto none = says_why ? HesaiNoPoint::kNoReturn : HesaiNoPoint::kNotFired;
  return StoreReturns(returns, place,
                      {.unit_m = UnitOf_m(model_, packet),
                       .least = model_.least_distance(),
                       .none = static_cast<std::uint16_t>(none),
                       .has_last = mode == kLastAndStrongestMode || mode == kFirstAndLastMode},
                      packet);
}

void SpinningDecoder::Seal(std::span<char> packet) const {
  StoreChecksums(model_, packet);
}

bool SpinningDecoder::BeginsTurn(const Group& first) {
  if (!model_.correction) return last_azimuth_ && first.azimuth < *last_azimuth_;
  const std::size_t before = std::exchange(field_, model_.correction->FieldAt(first.azimuth_deg));
  return last_azimuth_ && field_ != before;
}

void SpinningDecoder::AddCycle(std::vector<SensorTurn>& turns) {
  const Group& first = cycle_.front();
  if (BeginsTurn(first) || turn_.num_columns() >= kMaxTurnColumns) {
    turns.push_back(TakeUnfinished());
  }
  if (!last_azimuth_) turn_.stamp_ns = first.time_ns;
  last_azimuth_ = first.azimuth;
  for (std::size_t cycle = 0; cycle < model_.cycles_per_block(); ++cycle) {
    const double cycle_us = static_cast<double>(cycle) * model_.cycle_us;
    turn_.column_time_ns.push_back(first.time_ns - turn_.stamp_ns + std::llround(cycle_us * 1e3));
    for (const Group& group : cycle_) {
      turn_.aims.push_back(
          {group.azimuth_deg + group.speed_deg_per_us * cycle_us, group.speed_deg_per_us});
    }
  }
  turn_.places.resize(turn_.num_columns() * model_.channels.size());
  for (const Group& group : cycle_) AddGroup(group);
}

void SpinningDecoder::AddGroup(const Group& group) {
  turn_.is_dual = turn_.is_dual || group.is_dual;
  const std::size_t first_column = turn_.num_columns() - model_.cycles_per_block();
  const auto other_place =
      static_cast<std::uint32_t>(model_.blocks_per_loop() * model_.block_size());
  TurnPoint point{};
  for (const Channel& channel : loops_[group.loop]) {
    const char* place = group.blocks.data() + channel.place;
    point.column = static_cast<std::uint32_t>(first_column) + channel.cycle;
    FiringPlace& firing = turn_.places[point.column * model_.channels.size() + channel.ring];
    firing = {.packet = group.packet, .first = group.place + channel.place};
    point.time_ns = turn_.column_time_ns[point.column] + channel.time_ns;
    point.ring = channel.ring;
    point.laser = channel.laser;
    point.return_index = 0;
    if (!group.is_dual) {
      AddPoint(place, group, channel, point);
      continue;
    }
    const char* other = place + other_place;
    firing.second = firing.first + other_place;
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

void SpinningDecoder::AddPoint(const char* place,
                               const Group& group,
                               const Channel& channel,
                               TurnPoint point) {
  const auto distance = LoadAt<std::uint16_t>(place);
  if (distance < model_.least_distance()) return;
  const double range_m = distance * group.unit_m;
  double azimuth_deg =
      group.azimuth_deg + channel.azimuth_deg + group.speed_deg_per_us * channel.turned_us;
  azimuth_deg -= 360.0 * std::floor(azimuth_deg / 360.0);
  double sine = channel.sine;
  double cosine = channel.cosine;
  if (model_.correction) {
    const auto direction = model_.correction->At(group.azimuth_deg, field_, channel.laser);
    azimuth_deg = direction.azimuth_deg;
    sine = std::sin(RadFromDeg(direction.elevation_deg));
    cosine = std::cos(RadFromDeg(direction.elevation_deg));
  }
  const double azimuth_rad = RadFromDeg(azimuth_deg);
  const double horizontal_m = range_m * cosine;
  point.range_m = static_cast<float>(range_m);
  point.azimuth_rad = static_cast<float>(azimuth_rad);
  point.x = static_cast<float>(horizontal_m * std::cos(azimuth_rad));
  // Not -0 where that is 0.
  point.y = static_cast<float>(0.0 - horizontal_m * std::sin(azimuth_rad));
  point.z = static_cast<float>(range_m * sine);
  point.intensity = LoadAt<std::uint8_t>(place + sizeof distance);
  turn_.points.push_back(point);
}

}  // namespace railcast
