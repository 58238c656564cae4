#include "core/io/hesai/hesai_encoder.h"

#include <algorithm>
#include <cmath>
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

std::uint8_t PercentByte(float intensity) {
  constexpr float kMost = 255.0F;
  // Written so that NaN gives 0, too.
  if (!(intensity > 0.0F)) return 0;
  return static_cast<std::uint8_t>(std::lround(std::min(100.0F * intensity, kMost)));
}

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
  double begin_us{};       ///< Since the start of the cycle.
  double azimuth_us{};     ///< When the rotor is at the block's azimuth, likewise.
  std::size_t last_row{};  ///< The row that fires last.
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
    double last_us = -1.0;
    for (const std::uint8_t laser : lasers) {
      LoopFiring firing{.laser = laser, .row = rows[channel]};
      if (model.near_limits) {
        const HesaiNearLimits& limits = *model.near_limits;
        firing.sees_near = std::ranges::binary_search(limits.near_lasers, laser);
        firing.near_m = firing.sees_near ? limits.near_m : limits.far_m;
      }
      if (const double time_us = pattern.channels[channel++].time_us; time_us > last_us) {
        last_us = time_us;
        loop.last_row = firing.row;
      }
      loop.firings.push_back(firing);
    }
  }
  return loops;
}

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
        packet_(model, mode),
        fill_(model.layout.blocks) {}

  void Encode(const Frame& frame, Datagrams& datagrams) override {
    Check(frame.rows == pattern_.channels.size() && frame.columns == pattern_.columns,
          "the frame is the scan's");
    Check(frame.returns <= blocks_per_loop_, "frames have the mode's returns");
    fill_.BeginFrame(frame.index, frame.columns * loops_.size() * blocks_per_loop_);
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      for (std::size_t loop = 0; loop < loops_.size(); ++loop) {
        EncodeLoop(frame, column, loop);
        const std::uint64_t sequence = fill_.num_packets();
        if (fill_.Add(blocks_per_loop_)) AppendPacket(sequence, datagrams);
      }
    }
  }

 private:
  void EncodeLoop(const Frame& frame, std::uint32_t column, std::size_t index) {
    const EncodedLoop& loop = loops_[index];
    const double cycle_us = column * pattern_.cycle_us;
    const std::int64_t begin_ns = frame.stamp_ns + std::llround(1e3 * (cycle_us + loop.begin_us));
    const std::size_t block = fill_.num_blocks();
    if (block == 0 || !model_.states_first) stated_ns_ = begin_ns - model_.stated_loop_ns;
    const std::size_t first_slot = std::size_t{column} * frame.returns;
    last_ns_ = frame.stamp_ns + frame.time_ns[loop.last_row * frame.width() + first_slot];
    const double turns = rate_hz_ * (cycle_us + loop.azimuth_us) * 1e-6;
    for (std::size_t i = 0; i < blocks_per_loop_; ++i) {
      packet_.BeginBlock(block + i, index, RotorAzimuth(pattern_.start_azimuth_deg, turns));
    }
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
    const CodedReturn other =
        frame.returns == 2 ? CodeReturn(frame, slot + 1, firing) : CodedReturn{};
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
