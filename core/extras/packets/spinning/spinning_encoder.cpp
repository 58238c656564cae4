#include "core/extras/packets/spinning/spinning_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/spinning/coded_return.h"
#include "core/extras/packets/spinning/scan_fit.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scan/at128.h"
#include "core/scan/spinning_pattern.h"
#include "core/scenario/json_rules.h"

namespace railcast {
namespace {

std::uint16_t DistanceOf(HesaiNoPoint reason) {
  return static_cast<std::uint16_t>(reason);
}

std::uint8_t ModeByte(ReturnMode return_mode) {
  switch (return_mode) {
    case ReturnMode::kFirst:
      return kFirstMode;
    case ReturnMode::kLast:
      return kLastMode;
    case ReturnMode::kDual:
      return kLastAndStrongestMode;
    default:
      return kStrongestMode;
  }
}

/// A laser's firing in a group of blocks.
struct GroupFiring {
  std::size_t place{};    ///< Place of its return, from the begin of the blocks on.
  std::size_t row{};      ///< Row in the frame.
  std::size_t cycle{};    ///< Which of the group's cycles.
  double near_m{};        ///< It is blind for what is nearer.
  bool sees_near = true;  ///< Whether that is as near as any laser sees.
};

std::vector<std::vector<GroupFiring>> FiringsOfLoops(const SpinningModel& model,
                                                     const std::vector<PacketFiring>& firings) {
  std::vector<std::vector<GroupFiring>> loops(model.loops.size());
  for (std::size_t cycle = 0; cycle < model.cycles_per_block(); ++cycle) {
    for (const PacketFiring& firing : firings) {
      const std::size_t laser = cycle * firings.size() + firing.laser;
      const bool sees_near =
          model.near_m == 0.0 || std::ranges::binary_search(model.near_lasers, firing.laser);
      loops[firing.loop].push_back({.place = model.ReturnPlace(0, laser) - model.header_size,
                                    .row = firing.row,
                                    .cycle = cycle,
                                    .near_m = sees_near ? model.near_m : model.far_m,
                                    .sees_near = sees_near});
    }
  }
  return loops;
}

/// The blocks of a loop, or of the cycles that share a block.
struct EncodedGroup {
  std::size_t loop{};
  std::uint16_t azimuth{};  ///< In the packets' units.
  std::uint8_t fine{};      ///< In 1/256 of these, where packets say so.
  /// Columns of its cycles, as ColumnsOfCycles() has them.
  std::array<std::uint32_t, 2> columns{};
  std::int64_t begin_ns{};  ///< When it begins, or would, since the frame's stamp.
  std::int64_t last_ns{};   ///< When its last laser fires, likewise.

  [[nodiscard]] bool fires() const { return columns[0] != kNotFired || columns[1] != kNotFired; }
};

/// What the packets of a sensor take from the scan of its frames.
struct EncodedScan {
  std::vector<PacketFiring> firings;  ///< Firings of a cycle.
  std::size_t num_columns{};          ///< Columns of a frame.
  double turns_hz{};                  ///< Turns of the rotor.
  /// The groups of a frame. If there are several, frames have them in turn, as many in each.
  std::vector<std::vector<EncodedGroup>> frames;
};

std::vector<EncodedGroup> GroupsOf(const SpinningModel& model,
                                   const SpinningSpec& pattern,
                                   double rate_hz,
                                   const std::vector<PacketFiring>& firings) {
  std::vector<double> begins_us(model.loops.size());
  std::vector<double> lasts_us(model.loops.size());
  for (std::size_t i = 0; i < firings.size(); ++i) {
    const std::size_t loop = firings[i].loop;
    begins_us[loop] = firings[i].of_cycle_us;
    lasts_us[loop] = std::max(lasts_us[loop], pattern.channels[i].time_us);
  }
  // From the azimuth of a block to the begin of its loop.
  const double turned_us =
      model.turns_azimuths ? -*std::ranges::max_element(lasts_us) / 2.0 : model.turned_us;
  const std::vector<std::uint32_t> columns = ColumnsOfCycles(pattern, rate_hz);
  const auto in_block = static_cast<std::uint32_t>(model.cycles_per_block());
  std::vector<EncodedGroup> groups;
  for (std::uint32_t cycle = 0; cycle < columns.size(); cycle += in_block) {
    const double cycle_us = cycle * pattern.cycle_us;
    for (std::size_t loop = 0; loop < model.loops.size(); ++loop) {
      EncodedGroup group{.loop = loop, .columns = {columns[cycle], kNotFired}};
      if (in_block == 2) group.columns[1] = columns[cycle + 1];
      if (model.date_place == 0 && !group.fires()) continue;
      const double turns = rate_hz * (cycle_us + (begins_us[loop] - turned_us)) * 1e-6;
      group.azimuth = RotorAzimuth(pattern.start_azimuth_deg, turns);
      group.begin_ns = std::llround(1e3 * (cycle_us + begins_us[loop]));
      const std::uint32_t last = group.columns[1] == kNotFired ? cycle : cycle + 1;
      group.last_ns = std::llround(1e3 * (last * pattern.cycle_us + lasts_us[loop]));
      groups.push_back(group);
    }
  }
  return groups;
}

EncodedScan ScanOfRotor(const SpinningModel& model, const SpinningSpec& pattern, double rate_hz) {
  EncodedScan scan{.firings = FiringsOf(model, pattern.channels),
                   .num_columns = FiredCycles(pattern, rate_hz).size(),
                   .turns_hz = rate_hz,
                   .frames = {}};
  scan.frames.push_back(GroupsOf(model, pattern, rate_hz, scan.firings));
  return scan;
}

EncodedScan ScanOfMirrors(const SpinningModel& model,
                          const At128Correction& correction,
                          double rate_hz) {
  EncodedScan scan{.firings = FiringsOf(model, At128Channels(correction)),
                   .num_columns = At128Columns(rate_hz),
                   .turns_hz = rate_hz / At128Correction::kFields,
                   .frames = {}};
  const auto last_ns = std::int64_t{std::ranges::max(kAt128Firing_ns)};
  for (std::uint32_t field = 0; field < At128Correction::kFields; ++field) {
    auto& groups = scan.frames.emplace_back();
    for (std::uint32_t column = 0; column < scan.num_columns; ++column) {
      const std::uint32_t azimuth = At128Azimuth(correction, rate_hz, field, column);
      const std::int64_t begin_ns = std::llround(1e3 * kAt128Block_us * column);
      groups.push_back({.azimuth = static_cast<std::uint16_t>(azimuth / 256),
                        .fine = static_cast<std::uint8_t>(azimuth % 256),
                        .columns = {column, kNotFired},
                        .begin_ns = begin_ns,
                        .last_ns = begin_ns + last_ns});
    }
  }
  return scan;
}

/// Which packets are sent: those with a block in which lasers fire. Blocks go on through all turns,
/// so that the packets of a turn begin where those before it have ended.
class SentPackets {
 public:
  SentPackets(const std::vector<EncodedGroup>& groups, std::size_t groups_per_packet) {
    const std::size_t per_turn = groups.size();
    const std::size_t period = per_turn / std::gcd(per_turn, groups_per_packet);
    for (std::size_t packet = 0; packet < period; ++packet) {
      bool fires = false;
      for (std::size_t i = 0; i < groups_per_packet; ++i) {
        fires = fires || groups[(packet * groups_per_packet + i) % per_turn].fires();
      }
      num_before_.push_back(num_before_.back() + (fires ? 1 : 0));
    }
  }

  /// Number of packets sent before this one, counted from the first.
  [[nodiscard]] std::uint64_t NumBefore(std::uint64_t packet) const {
    const std::uint64_t period = num_before_.size() - 1;
    return packet / period * num_before_.back() + num_before_[packet % period];
  }
  [[nodiscard]] bool IsSent(std::uint64_t packet) const {
    return NumBefore(packet + 1) > NumBefore(packet);
  }

 private:
  std::vector<std::uint64_t> num_before_ = {0};  ///< For the packets after which all repeats.
};

/// Counts the blocks of packets that span frames. Of frames that are left out, their packets are
/// left out, too, and all others are as if every frame had come.
class PacketFill {
 public:
  explicit PacketFill(std::size_t blocks_per_packet) : blocks_per_packet_(blocks_per_packet) {}

  /// Counts the frames that were left out since the last one.
  /// @param frame Its number; numbers rise.
  void BeginFrame(std::uint32_t frame, std::uint64_t blocks_per_frame) {
    if (next_frame_ && frame > *next_frame_) {
      total_ += blocks_per_frame * (frame - *next_frame_);
      lacks_blocks_ = num_blocks() > 0;
    }
    next_frame_ = frame + 1;
  }

  /// Returns whether these blocks complete a packet that lacks none.
  [[nodiscard]] bool Add(std::size_t num_blocks_added) {
    total_ += num_blocks_added;
    if (num_blocks() > 0) return false;
    const bool is_whole = !lacks_blocks_;
    lacks_blocks_ = false;
    return is_whole;
  }

  /// Number of blocks in the packet under construction.
  [[nodiscard]] std::size_t num_blocks() const {
    return static_cast<std::size_t>(total_ % blocks_per_packet_);
  }
  /// Number of packets before the one under construction, those left out included.
  [[nodiscard]] std::uint64_t num_packets() const { return total_ / blocks_per_packet_; }

 private:
  std::size_t blocks_per_packet_;
  std::uint64_t total_{};  ///< Blocks.
  bool lacks_blocks_ = false;
  std::optional<std::uint32_t> next_frame_;
};

class SpinningEncoder final : public FrameEncoder {
 public:
  SpinningEncoder(const SpinningModel& model, EncodedScan scan, ReturnMode return_mode)
      : model_(model),
        scan_(std::move(scan)),
        speed_rpm_(static_cast<std::uint16_t>(std::lround(60.0 * scan_.turns_hz))),
        returns_(return_mode == ReturnMode::kDual ? 2 : 1),
        unit_m_(1e-3 * model.unit_mm),
        least_(model.least_distance()),
        byte_of_(model.intensity == IntensityBytes::kVelodyne ? ReflectivityByte : PercentByte),
        other_place_(model.blocks_per_loop() * model.block_size()),
        loops_(FiringsOfLoops(model, scan_.firings)),
        blocks_per_group_(model.blocks_per_loop() * returns_),
        sent_(scan_.frames.front(), model.blocks / blocks_per_group_),
        packet_(model, ModeByte(return_mode)),
        fill_(model.blocks) {}

  void Encode(const Frame& frame, Datagrams& datagrams) override {
    Check(frame.rows == scan_.firings.size() && frame.columns == scan_.num_columns,
          "the frame is the scan's");
    Check(frame.returns <= returns_, "frames have the mode's returns");
    if (!next_position_ns_) {
      const std::int64_t clock_ns = frame.stamp_ns + clock_ahead_ns();
      next_position_ns_ = (clock_ns + kNsPerS - 1) / kNsPerS * kNsPerS - clock_ahead_ns();
    }
    const auto& groups = scan_.frames[frame.index % scan_.frames.size()];
    fill_.BeginFrame(frame.index, groups.size() * blocks_per_group_);
    for (const EncodedGroup& group : groups) {
      EncodeGroup(frame, group);
      const std::uint64_t packet = fill_.num_packets();
      const bool is_whole = fill_.Add(blocks_per_group_);
      if (is_whole && sent_.IsSent(packet)) AppendPacket(sent_.NumBefore(packet), datagrams);
    }
  }

 private:
  // Lasers outside of the azimuth window do not fire, which distance 0 says.
  void EncodeGroup(const Frame& frame, const EncodedGroup& group) {
    const std::size_t block = fill_.num_blocks();
    if (block == 0 || !model_.states_first) {
      stated_ns_ = frame.stamp_ns + group.begin_ns - model_.stated_loop_ns;
    }
    last_ns_ = frame.stamp_ns + group.last_ns;
    for (std::size_t i = 0; i < blocks_per_group_; ++i) {
      packet_.BeginBlock(block + i, group.loop, group.azimuth, group.fine);
    }
    if (!group.fires()) return;
    const std::size_t begin = model_.BlockPlace(block);
    for (const GroupFiring& firing : loops_[group.loop]) {
      const std::uint32_t column = group.columns[firing.cycle];
      if (column == kNotFired) continue;
      StoreFiring(frame, firing.row * frame.width() + std::size_t{column} * frame.returns, firing,
                  begin + firing.place);
    }
  }

  [[nodiscard]] CodedReturn CodeReturn(const Frame& frame,
                                       std::size_t slot,
                                       const GroupFiring& firing) const {
    const std::uint16_t distance = CodedDistance(frame.range_m[slot], unit_m_);
    if (model_.near_m > 0.0) {
      const HesaiNoPoint reason = WhyNoPoint(frame, slot, firing, distance);
      if (reason != HesaiNoPoint::kNotFired) return {DistanceOf(reason), 0};
    }
    if (distance == 0) return {};
    return {distance, byte_of_(frame.intensity[slot])};
  }

  /// Why a laser that fired has no point, or kNotFired if it has one.
  [[nodiscard]] HesaiNoPoint WhyNoPoint(const Frame& frame,
                                        std::size_t slot,
                                        const GroupFiring& firing,
                                        std::uint16_t distance) const {
    const Outcome outcome = frame.outcome[slot];
    const bool has_point = HasPoint(outcome);
    const float hit_m = has_point ? frame.range_m[slot] : frame.true_range_m[slot];
    // Written so that NaN, where nothing was hit, is not near.
    const bool is_near = static_cast<double>(hit_m) < firing.near_m;
    const bool is_blinded = outcome == Outcome::kCoverBlocked;
    if (is_blinded ||
        (is_near && (has_point || outcome == Outcome::kNearRange || outcome == Outcome::kEgo))) {
      const bool is_too_near_for_all =
          is_blinded || firing.sees_near || static_cast<double>(hit_m) < model_.near_m;
      return is_too_near_for_all ? HesaiNoPoint::kTooNear : HesaiNoPoint::kTooNearForItsLaser;
    }
    if (!has_point || distance < least_) return HesaiNoPoint::kNoReturn;
    return HesaiNoPoint::kNotFired;
  }

  void StoreFiring(const Frame& frame,
                   std::size_t slot,
                   const GroupFiring& firing,
                   std::size_t place) {
    const CodedReturn strongest = CodeReturn(frame, slot, firing);
    if (returns_ == 1) {
      packet_.SetReturn(place, strongest);
      return;
    }
    const CodedReturn other = frame.returns == 2 ? CodeReturn(frame, slot + 1, firing) : strongest;
    const CodedPair pair = LastAndOther(strongest, other, least_);
    packet_.SetReturn(place, pair.last);
    packet_.SetReturn(place + other_place_, pair.other);
  }

  void AppendPacket(std::uint64_t sequence, Datagrams& datagrams) {
    // Packets with a date say themselves what position packets say.
    for (; model_.date_place == 0 && *next_position_ns_ <= last_ns_;
         *next_position_ns_ += kNsPerS) {
      AppendPositionPacket(*next_position_ns_, clock_ahead_ns(), datagrams);
    }
    const auto packet =
        packet_.Close({.time_ns = kSimulationEpoch_s * kNsPerS + clock_ahead_ns() + stated_ns_,
                       .speed_rpm = speed_rpm_,
                       .sequence = static_cast<std::uint32_t>(sequence)});
    datagrams.Append(packet, {.port = DatagramPort::kData, .due_ns = last_ns_});
  }

  const SpinningModel& model_;
  EncodedScan scan_;
  std::uint16_t speed_rpm_;
  std::size_t returns_;
  double unit_m_;
  std::uint16_t least_;  ///< Raw distance that is one.
  std::uint8_t (*byte_of_)(float intensity);
  std::size_t other_place_;  ///< From the first return's place to the second's.
  std::vector<std::vector<GroupFiring>> loops_;
  std::size_t blocks_per_group_;
  SentPackets sent_;

  // The packet under construction.
  SpinningPacket packet_;
  PacketFill fill_;
  std::int64_t stated_ns_{};  ///< The simulation time that it states.
  std::int64_t last_ns_{};    ///< Time of its last firing.
  std::optional<std::int64_t> next_position_ns_;
};

}  // namespace

std::unique_ptr<FrameEncoder> MakeSpinningEncoder(const SpinningModel& model,
                                                  const ScanSpec& scan,
                                                  ReturnMode return_mode) {
  const ScanFit fit(model.protocol);
  const bool is_rotor = model.name != kAt128Name;
  if (is_rotor) {
    fit.CheckPattern(scan, {.name = model.name,
                            .channels = model.channels,
                            .cycle_us = model.cycle_us,
                            .has_own_angles = model.has_own_angles,
                            .cycles_per_block = model.cycles_per_block()});
  }
  const auto* const table = std::get_if<FiringTableSpec>(&scan.pattern);
  if (!is_rotor && (table == nullptr || !IsAt128File(table->file))) {
    fit.Fail("/scan/pattern", "must be a table whose file is the correction file of an AT128");
  }
  const std::string mode(NameOf(return_mode));
  if (std::ranges::count(model.sends, mode) == 0) {
    fit.Fail("/receiver/return_mode", "must be " + InWords(model.sends), Quoted(mode));
  }
  EncodedScan encoded = is_rotor
                            ? ScanOfRotor(model, std::get<SpinningSpec>(scan.pattern), scan.rate_hz)
                            : ScanOfMirrors(model, ReadAt128Correction(table->file), scan.rate_hz);
  return std::make_unique<SpinningEncoder>(model, std::move(encoded), return_mode);
}

}  // namespace railcast
