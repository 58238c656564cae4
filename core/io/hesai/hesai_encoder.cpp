#include "core/io/hesai/hesai_encoder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/coded_return.h"
#include "core/io/hesai/hesai_packet.h"
#include "core/io/packet_fill.h"
#include "core/io/scan_fit.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

constexpr double kCodedUnit_m = 1e-3 * kHesaiUnit_mm;

std::uint16_t DistanceOf(HesaiNoPoint reason) {
  return static_cast<std::uint16_t>(reason);
}

std::uint8_t HesaiModeOf(ReturnMode return_mode) {
  switch (return_mode) {
    case ReturnMode::kFirst:
      return kHesaiFirst;
    case ReturnMode::kLast:
      return kHesaiLast;
    case ReturnMode::kDual:
      return kHesaiLastAndStrongest;
    default:
      return kHesaiStrongest;
  }
}

/// A laser's firing in a loop.
struct LoopFiring {
  std::size_t laser{};
  std::size_t row{};      ///< Of the frame.
  double near_m{};        ///< It is blind for what is nearer.
  bool sees_near = true;  ///< Whether that is as near as any laser sees.
};

struct EncodedLoop {
  std::vector<LoopFiring> firings;
  double begin_us{};    ///< Since the start of the cycle.
  double azimuth_us{};  ///< When the rotor is at the block's azimuth, likewise.
  double last_us{};     ///< When the last laser fires, likewise.
};

/// From the azimuth of a block to the begin of its loop.
double TurnedUs(const HesaiModel& model, const std::vector<ChannelSpec>& channels) {
  if (model.turned_us) return *model.turned_us;
  return -std::ranges::max(channels, {}, &ChannelSpec::time_us).time_us / 2.0;
}

std::vector<EncodedLoop> LoopsOf(const HesaiModel& model, const SpinningSpec& pattern) {
  const std::vector<std::uint16_t> rows = RowsByElevation(pattern.channels);
  const double turned_us = TurnedUs(model, pattern.channels);
  std::vector<EncodedLoop> loops;
  std::size_t channel = 0;
  for (const std::vector<std::uint8_t>& lasers : model.loops) {
    EncodedLoop& loop = loops.emplace_back();
    loop.begin_us =
        1e-3 * static_cast<double>(model.loop_ns) * static_cast<double>(loops.size() - 1);
    loop.azimuth_us = loop.begin_us - turned_us;
    for (const std::uint8_t laser : lasers) {
      LoopFiring firing{.laser = laser, .row = rows[channel]};
      if (model.near_limits) {
        const HesaiNearLimits& limits = *model.near_limits;
        firing.sees_near = std::ranges::binary_search(limits.near_lasers, laser);
        firing.near_m = firing.sees_near ? limits.near_m : limits.far_m;
      }
      loop.last_us = std::max(loop.last_us, pattern.channels[channel++].time_us);
      loop.firings.push_back(firing);
    }
  }
  return loops;
}

/// Which packets are sent: those with a block in which lasers fire. Blocks go on through all turns,
/// so that the packets of a turn begin where those before it have ended.
class SentPackets {
 public:
  /// @param columns As ColumnsOfCycles() has them.
  SentPackets(const std::vector<std::uint32_t>& columns,
              std::size_t blocks_per_cycle,
              std::size_t blocks_per_packet) {
    const std::size_t per_turn = columns.size() * blocks_per_cycle;
    const std::size_t period = per_turn / std::gcd(per_turn, blocks_per_packet);
    for (std::size_t packet = 0; packet < period; ++packet) {
      bool fires = false;
      for (std::size_t i = 0; i < blocks_per_packet; ++i) {
        const std::size_t block = (packet * blocks_per_packet + i) % per_turn;
        fires = fires || columns[block / blocks_per_cycle] != kNotFired;
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
  std::vector<std::uint64_t> num_before_ = {0};  ///< Of the packets after which all repeats.
};

class HesaiEncoder final : public FrameEncoder {
 public:
  HesaiEncoder(const HesaiModel& model,
               const SpinningSpec& pattern,
               double rate_hz,
               std::uint8_t mode)
      : model_(model),
        pattern_(pattern),
        rate_hz_(rate_hz),
        blocks_per_loop_(model.IsDual(mode) ? 2 : 1),
        loops_(LoopsOf(model, pattern)),
        columns_(ColumnsOfCycles(pattern, rate_hz)),
        num_columns_(FiredCycles(pattern, rate_hz).size()),
        sent_(columns_, loops_.size() * blocks_per_loop_, model.layout.blocks),
        packet_(model, mode),
        fill_(model.layout.blocks) {}

  void Encode(const Frame& frame, Datagrams& datagrams) override {
    Check(frame.rows == pattern_.channels.size() && frame.columns == num_columns_,
          "the frame is the scan's");
    Check(frame.returns <= blocks_per_loop_, "frames have the mode's returns");
    fill_.BeginFrame(frame.index, columns_.size() * loops_.size() * blocks_per_loop_);
    for (std::uint32_t cycle = 0; cycle < columns_.size(); ++cycle) {
      for (std::size_t loop = 0; loop < loops_.size(); ++loop) {
        EncodeLoop(frame, cycle, loop);
        const std::uint64_t packet = fill_.num_packets();
        const bool is_whole = fill_.Add(blocks_per_loop_);
        if (is_whole && sent_.IsSent(packet)) AppendPacket(sent_.NumBefore(packet), datagrams);
      }
    }
  }

 private:
  // Lasers outside of the azimuth window do not fire, which distance 0 says.
  void EncodeLoop(const Frame& frame, std::uint32_t cycle, std::size_t index) {
    const EncodedLoop& loop = loops_[index];
    const double cycle_us = cycle * pattern_.cycle_us;
    const std::int64_t begin_ns = frame.stamp_ns + std::llround(1e3 * (cycle_us + loop.begin_us));
    const std::size_t block = fill_.num_blocks();
    if (block == 0 || !model_.states_first) stated_ns_ = begin_ns - model_.stated_loop_ns;
    last_ns_ = frame.stamp_ns + std::llround(1e3 * (cycle_us + loop.last_us));
    const double turns = rate_hz_ * (cycle_us + loop.azimuth_us) * 1e-6;
    for (std::size_t i = 0; i < blocks_per_loop_; ++i) {
      packet_.BeginBlock(block + i, index, RotorAzimuth(pattern_.start_azimuth_deg, turns));
    }
    if (columns_[cycle] == kNotFired) return;
    const std::size_t first_slot = std::size_t{columns_[cycle]} * frame.returns;
    for (const LoopFiring& firing : loop.firings) {
      StoreFiring(frame, firing.row * frame.width() + first_slot, firing, block);
    }
  }

  [[nodiscard]] CodedReturn CodeReturn(const Frame& frame,
                                       std::size_t slot,
                                       const LoopFiring& firing) const {
    const std::uint16_t distance = CodedDistance(frame.range_m[slot], kCodedUnit_m);
    if (model_.near_limits) {
      const HesaiNoPoint reason = WhyNoPoint(frame, slot, firing, distance);
      if (reason != HesaiNoPoint::kNotFired) return {DistanceOf(reason), 0};
    }
    if (distance == 0) return {};
    return {distance, PercentByte(frame.intensity[slot])};
  }

  /// Why a laser that fired has no point, or kNotFired if it has one.
  [[nodiscard]] HesaiNoPoint WhyNoPoint(const Frame& frame,
                                        std::size_t slot,
                                        const LoopFiring& firing,
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
          is_blinded || firing.sees_near || static_cast<double>(hit_m) < model_.near_limits->near_m;
      return is_too_near_for_all ? HesaiNoPoint::kTooNear : HesaiNoPoint::kTooNearForItsLaser;
    }
    if (!has_point || distance < model_.least_distance()) return HesaiNoPoint::kNoReturn;
    return HesaiNoPoint::kNotFired;
  }

  void StoreFiring(const Frame& frame,
                   std::size_t slot,
                   const LoopFiring& firing,
                   std::size_t block) {
    const CodedReturn strongest = CodeReturn(frame, slot, firing);
    if (blocks_per_loop_ == 1) {
      packet_.SetReturn(block, firing.laser, strongest);
      return;
    }
    const CodedReturn other = frame.returns == 2 ? CodeReturn(frame, slot + 1, firing) : strongest;
    const CodedPair pair = LastAndOther(strongest, other, model_.least_distance());
    packet_.SetReturn(block, firing.laser, pair.last);
    packet_.SetReturn(block + 1, firing.laser, pair.other);
  }

  void AppendPacket(std::uint64_t sequence, Datagrams& datagrams) {
    const auto packet =
        packet_.Close({.time_ns = kSimulationEpoch_s * kNsPerS + clock_ahead_ns() + stated_ns_,
                       .speed_rpm = static_cast<std::uint16_t>(std::lround(60.0 * rate_hz_)),
                       .sequence = static_cast<std::uint32_t>(sequence)});
    datagrams.items.push_back({.offset = datagrams.bytes.size(),
                               .size = static_cast<std::uint16_t>(packet.size()),
                               .port = DatagramPort::kData,
                               .due_ns = last_ns_});
    datagrams.bytes.insert(datagrams.bytes.end(), packet.begin(), packet.end());
  }

  const HesaiModel& model_;
  SpinningSpec pattern_;
  double rate_hz_;
  std::size_t blocks_per_loop_;
  std::vector<EncodedLoop> loops_;
  std::vector<std::uint32_t> columns_;  ///< As ColumnsOfCycles() has them.
  std::size_t num_columns_;             ///< Of a frame.
  SentPackets sent_;

  // The packet under construction.
  HesaiPacket packet_;
  PacketFill fill_;
  std::int64_t stated_ns_{};  ///< The simulation time that it states.
  std::int64_t last_ns_{};    ///< Of its last firing.
};

}  // namespace

std::unique_ptr<FrameEncoder> MakeHesaiEncoder(const HesaiModel& model,
                                               const ScanSpec& scan,
                                               ReturnMode return_mode) {
  const ScanFit fit(model.protocol);
  const auto* const pattern = std::get_if<SpinningSpec>(&scan.pattern);
  // The cycle of all loops, of which the model has but the parts.
  fit.CheckPattern(scan, {.name = model.name,
                          .channels = model.channels,
                          .cycle_us = 1e-3 * static_cast<double>(model.loop_ns) *
                                      static_cast<double>(model.loops.size())});
  if (return_mode == ReturnMode::kTriple) {
    fit.Fail("/receiver/return_mode", "must be \"strongest\", \"first\", \"last\" or \"dual\"",
             Quoted(NameOf(return_mode)));
  }
  return std::make_unique<HesaiEncoder>(model, *pattern, scan.rate_hz, HesaiModeOf(return_mode));
}

}  // namespace railcast
