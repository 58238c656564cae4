#include "core/io/velodyne/velodyne_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

/// The most points of a turn; a longer turn is cut, so that a rotor that stands still cannot fill
/// the memory. The densest real turn (VLS-128 at 5 Hz) has 480 thousand points.
constexpr std::size_t kMaxTurnPoints = std::size_t{1} << 20U;
constexpr double kFullTurn_deg = 360.0;

std::uint16_t FlagOf(const char* block) {
  return LoadAt<std::uint16_t>(block);
}
std::uint16_t AzimuthOf(const char* block) {
  return LoadAt<std::uint16_t>(block + kAzimuthPlace);
}

bool IsDualPacket(const VelodyneModel& model, std::span<const char> payload) {
  return model.has_mode_and_id && static_cast<std::uint8_t>(payload[kModePlace]) == kDualMode;
}

std::optional<std::string> RefuseEnd(const VelodyneModel& model, const char* packet) {
  const auto time_us = LoadAt<std::uint32_t>(packet + kTimePlace);
  if (time_us >= kUsPerHour)
    return "microseconds past the hour must be < 3600000000" + Got(time_us);
  if (!model.has_mode_and_id) return std::nullopt;
  const auto id = LoadAt<std::uint8_t>(packet + kModelPlace);
  if (id != model.id) {
    return "model must be " + NumberText(model.id) + ", " + std::string(model.name) + Got(id);
  }
  const auto mode = LoadAt<std::uint8_t>(packet + kModePlace);
  // A dual packet of VLS-128 holds one cycle and four blocks of padding.
  const bool has_dual = model.blocks_per_cycle() == 1;
  if (mode < kStrongestMode || mode > (has_dual ? kDualMode : kLastMode)) {
    return std::string("return mode must be ") + (has_dual ? "55, 56 or 57" : "55 or 56") +
           Got(mode);
  }
  return std::nullopt;
}

// Returns why the payload is not a data packet of this model, or nothing if it is one.
std::optional<std::string> RefuseVelodyne(const VelodyneModel& model,
                                          std::span<const char> payload) {
  if (payload.size() != kVelodynePacketSize) {
    return "must be 1206 bytes" + Got(payload.size());
  }
  if (auto refusal = RefuseEnd(model, payload.data())) return refusal;
  const std::size_t in_group = model.blocks_per_cycle() * (IsDualPacket(model, payload) ? 2U : 1U);
  for (std::size_t i = 0; i < kBlocksPerPacket; ++i) {
    const char* const block = payload.data() + i * kBlockSize;
    const std::uint16_t flag = kBlockFlags.at(i % model.blocks_per_cycle());
    if (FlagOf(block) != flag) {
      return "block " + NumberText(i) + ": flag must be " + NumberText(flag) + Got(FlagOf(block));
    }
    if (AzimuthOf(block) >= kAzimuthUnitsPerTurn) {
      return "block " + NumberText(i) + ": azimuth must be <= 35999" + Got(AzimuthOf(block));
    }
    const char* const first = payload.data() + i / in_group * in_group * kBlockSize;
    if (AzimuthOf(block) != AzimuthOf(first)) {
      return "block " + NumberText(i) + ": azimuth must be that of its pair" +
             Got(AzimuthOf(block));
    }
  }
  return std::nullopt;
}

// From one azimuth to the next, in units; past 0, too.
std::int64_t StepTo(std::uint16_t azimuth, std::uint16_t before) {
  const std::int64_t step = std::int64_t{azimuth} - before;
  return step < 0 ? step + kAzimuthUnitsPerTurn : step;
}

// Returns the median step between groups of blocks, so that a gap between two turns or the end of
// an azimuth window does not affect it: of two steps, one of which is such a gap, the other.
std::int64_t UsualStep(std::span<const char> payload, std::size_t in_group) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = in_group; i < kBlocksPerPacket; i += in_group) {
    steps.push_back(StepTo(AzimuthOf(payload.data() + i * kBlockSize),
                           AzimuthOf(payload.data() + (i - in_group) * kBlockSize)));
  }
  std::ranges::sort(steps);
  const std::int64_t lower = steps[(steps.size() - 1) / 2];
  const std::int64_t upper = steps[steps.size() / 2];
  return lower > 0 && upper > 2 * lower ? lower : upper;
}

std::vector<LaserCalibration> CalibrationOf(const VelodyneModel& model) {
  Check(!model.has_own_angles, "the model's angles are in its data sheet");
  std::vector<LaserCalibration> table;
  for (const ChannelSpec& laser : model.lasers) {
    table.push_back({.elevation_deg = laser.elevation_deg, .azimuth_deg = laser.azimuth_deg});
  }
  return table;
}

}  // namespace

VelodyneDecoder::VelodyneDecoder(const VelodyneModel& model)
    : VelodyneDecoder(model, CalibrationOf(model)) {}

VelodyneDecoder::VelodyneDecoder(const VelodyneModel& model,
                                 const std::vector<LaserCalibration>& calibration)
    : model_(model) {
  Check(calibration.size() == model.lasers.size(), "every laser has a calibration");
  std::vector<ChannelSpec> channels = model.lasers;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    channels[i].elevation_deg = calibration[i].elevation_deg;
  }
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const double elevation_rad = RadFromDeg(calibration[i].elevation_deg);
    lasers_.push_back({.sine = std::sin(elevation_rad),
                       .cosine = std::cos(elevation_rad),
                       .azimuth_deg = calibration[i].azimuth_deg,
                       .time_us = model.lasers[i].time_us,
                       .calibration = calibration[i],
                       .ring = rows[i]});
  }
}

std::int64_t VelodyneDecoder::PacketNs(std::uint32_t us_past_hour) {
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

std::optional<std::string> VelodyneDecoder::Decode(std::span<const char> payload,
                                                   std::vector<SensorTurn>& turns) {
  ++num_packets_;
  if (auto refusal = RefuseVelodyne(model_, payload)) return refusal;
  const bool is_dual = IsDualPacket(model_, payload);
  const std::size_t in_group = model_.blocks_per_cycle() * (is_dual ? 2U : 1U);
  const double group_us = static_cast<double>(model_.cycles_per_block()) * model_.cycle_us;
  const std::int64_t usual_step = UsualStep(payload, in_group);
  const double speed_deg_per_us = static_cast<double>(usual_step) * kAzimuthUnit_deg / group_us;
  const std::int64_t packet_ns = PacketNs(LoadAt<std::uint32_t>(payload.data() + kTimePlace));
  std::int64_t group_index = 0;
  for (std::size_t i = 0; i < kBlocksPerPacket; i += in_group) {
    const char* const blocks = payload.data() + i * kBlockSize;
    if (i > 0) group_index += GroupsTo(AzimuthOf(blocks), usual_step, 1e3 * group_us);
    const double since_packet_us = static_cast<double>(group_index) * group_us;
    const Group group{.blocks = blocks,
                      .place = static_cast<std::uint32_t>(i * kBlockSize),
                      .azimuth = AzimuthOf(blocks),
                      .time_ns = packet_ns + std::llround(since_packet_us * 1e3),
                      .is_dual = is_dual};
    const bool is_new_turn = last_azimuth_ && group.azimuth < *last_azimuth_;
    if (is_new_turn || turn_.points.size() >= kMaxTurnPoints ||
        turn_.num_columns() >= kMaxTurnColumns) {
      turns.push_back(TakeUnfinished());
    }
    if (!last_azimuth_) turn_.stamp_ns = group.time_ns;
    // Only a packet's first group has a time of its own.
    if (i == 0 && !stated_) stated_ = {group.azimuth, group.time_ns};
    last_azimuth_ = group.azimuth;
    last_group_ns_ = group.time_ns;
    DecodeGroup(group, speed_deg_per_us);
  }
  return std::nullopt;
}

std::int64_t VelodyneDecoder::GroupsTo(std::uint16_t azimuth,
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

SensorTurn VelodyneDecoder::TakeUnfinished() {
  last_azimuth_.reset();
  stated_.reset();
  return std::exchange(turn_, {});
}

std::optional<std::string> VelodyneDecoder::Store(const EditedReturns& returns,
                                                  const FiringPlace& place,
                                                  std::span<char> packet) const {
  return StoreReturns(returns, place, {.unit_m = model_.distance_unit_m}, packet);
}

void VelodyneDecoder::DecodeGroup(const Group& group, double speed_deg_per_us) {
  const std::size_t num_cycles = model_.cycles_per_block();
  turn_.is_dual = turn_.is_dual || group.is_dual;
  for (std::size_t cycle = 0; cycle < num_cycles; ++cycle) {
    const auto column = static_cast<std::uint32_t>(turn_.num_columns());
    const double cycle_us = static_cast<double>(cycle) * model_.cycle_us;
    turn_.column_time_ns.push_back(group.time_ns - turn_.stamp_ns + std::llround(cycle_us * 1e3));
    turn_.aims.push_back(
        {group.azimuth * kAzimuthUnit_deg + speed_deg_per_us * cycle_us, speed_deg_per_us});
    turn_.places.resize(turn_.num_columns() * lasers_.size());
    for (std::size_t i = 0; i < lasers_.size(); ++i) {
      const std::size_t index = cycle * lasers_.size() + i;
      const std::size_t in_group = index / kLasersPerBlock * kBlockSize + kReturnsPlace +
                                   index % kLasersPerBlock * kReturnSize;
      const char* const place = group.blocks + in_group;
      const auto in_packet = group.place + static_cast<std::uint32_t>(in_group);
      turn_.places[column * lasers_.size() + lasers_[i].ring] = {
          .packet = num_packets_ - 1,
          .first = in_packet,
          .second = group.is_dual ? in_packet + static_cast<std::uint32_t>(kBlockSize) : 0};
      const double since_group_us = cycle_us + lasers_[i].time_us;
      const double azimuth_deg = group.azimuth * kAzimuthUnit_deg +
                                 speed_deg_per_us * since_group_us + lasers_[i].azimuth_deg;
      TurnPoint point{};
      point.time_ns = group.time_ns - turn_.stamp_ns + std::llround(since_group_us * 1e3);
      point.column = column;
      point.ring = lasers_[i].ring;
      point.laser = static_cast<std::uint8_t>(i);
      AddPoint(place, point, azimuth_deg);
      if (!group.is_dual) continue;
      const char* const other = place + kBlockSize;
      if (std::equal(place, place + kReturnSize, other)) continue;
      point.return_index = 1;
      AddPoint(other, point, azimuth_deg);
    }
  }
}

void VelodyneDecoder::AddPoint(const char* place, TurnPoint point, double azimuth_deg) {
  const auto distance = LoadAt<std::uint16_t>(place);
  if (distance == 0) return;
  const Laser& laser = lasers_[point.laser];
  const double range_m = distance * model_.distance_unit_m + laser.calibration.range_offset_m;
  const double in_turn_deg = azimuth_deg - kFullTurn_deg * std::floor(azimuth_deg / kFullTurn_deg);
  const double azimuth_rad = RadFromDeg(in_turn_deg);
  const double sin_azimuth = std::sin(azimuth_rad);
  const double cos_azimuth = std::cos(azimuth_rad);
  const double horizontal_m = range_m * laser.cosine;
  const double left_m = laser.calibration.horizontal_offset_m;
  point.range_m = static_cast<float>(range_m);
  point.azimuth_rad = static_cast<float>(azimuth_rad);
  point.x = static_cast<float>(horizontal_m * cos_azimuth + left_m * sin_azimuth);
  point.y = static_cast<float>(left_m * cos_azimuth - horizontal_m * sin_azimuth);
  point.z = static_cast<float>(range_m * laser.sine + laser.calibration.vertical_offset_m);
  point.intensity = LoadAt<std::uint8_t>(place + sizeof distance);
  turn_.points.push_back(point);
}

}  // namespace railcast
