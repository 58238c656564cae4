#include "core/io/velodyne/velodyne_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/coded_return.h"
#include "core/io/field_layout.h"
#include "core/io/packet_fill.h"
#include "core/io/scan_fit.h"
#include "core/io/velodyne/velodyne_model.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

void Store(const CodedReturn& coded, char* place) {
  StoreAt<std::uint16_t>(place, coded.distance);
  StoreAt<std::uint8_t>(place + sizeof(std::uint16_t), coded.reflectivity);
}

/// The firing cycles of one azimuth, of which at least one fires: one cycle, or two that share a
/// block.
struct CyclesOfAzimuth {
  std::uint16_t azimuth{};             ///< Where the first of them begins, in the packets' units.
  std::vector<std::uint32_t> columns;  ///< As ColumnsOfCycles() has them.
};

std::vector<CyclesOfAzimuth> FiredAzimuths(const SpinningSpec& pattern,
                                           double rate_hz,
                                           std::size_t cycles_per_block) {
  const std::vector<std::uint32_t> columns = ColumnsOfCycles(pattern, rate_hz);
  const auto step = static_cast<std::uint32_t>(cycles_per_block);
  std::vector<CyclesOfAzimuth> azimuths;
  for (std::uint32_t cycle = 0; cycle < columns.size(); cycle += step) {
    const auto begin = columns.begin() + cycle;
    if (std::count(begin, begin + step, kNotFired) == step) continue;
    const double turns = rate_hz * cycle * pattern.cycle_us * 1e-6;
    azimuths.push_back({RotorAzimuth(pattern.start_azimuth_deg, turns), {begin, begin + step}});
  }
  return azimuths;
}

class VelodyneEncoder final : public FrameEncoder {
 public:
  VelodyneEncoder(const VelodyneFormat& format,
                  const SpinningSpec& pattern,
                  double rate_hz,
                  std::uint8_t mode)
      : model_(*format.model),
        is_dual_(format.is_dual),
        rows_(RowsByElevation(pattern.channels)),
        num_columns_(FiredCycles(pattern, rate_hz).size()),
        azimuths_(FiredAzimuths(pattern, rate_hz, model_.cycles_per_block())) {
    const auto [first, last] =
        std::ranges::minmax_element(pattern.channels, {}, &ChannelSpec::time_us);
    first_row_ = rows_[static_cast<std::size_t>(first - pattern.channels.begin())];
    last_row_ = rows_[static_cast<std::size_t>(last - pattern.channels.begin())];
    if (model_.has_mode_and_id) {
      packet_[kModePlace] = static_cast<char>(mode);
      packet_[kModelPlace] = static_cast<char>(model_.id);
    }
  }

  void Encode(const Frame& frame, Datagrams& datagrams) override {
    Check(frame.rows == rows_.size() && frame.columns == num_columns_, "the frame is the scan's");
    Check(frame.returns == 1 || (is_dual_ && frame.returns == 2), "frames have the mode's returns");
    if (!next_position_ns_) {
      const std::int64_t clock_ns = frame.stamp_ns + clock_ahead_ns();
      next_position_ns_ = (clock_ns + kNsPerS - 1) / kNsPerS * kNsPerS - clock_ahead_ns();
    }
    fill_.BeginFrame(frame.index, azimuths_.size() * BlocksPerAzimuth());
    for (const CyclesOfAzimuth& cycles : azimuths_) {
      EncodeCycles(frame, cycles);
      if (fill_.Add(BlocksPerAzimuth())) AppendPacket(datagrams);
    }
  }

 private:
  [[nodiscard]] static std::int64_t FiringNs(const Frame& frame,
                                             std::size_t row,
                                             std::size_t column) {
    return frame.stamp_ns + frame.time_ns[row * frame.width() + column * frame.returns];
  }

  [[nodiscard]] std::size_t BlocksPerAzimuth() const {
    return model_.blocks_per_cycle() * (is_dual_ ? 2U : 1U);
  }

  // Encodes the blocks of one azimuth: those of one firing cycle, or one block with two cycles, one
  // of which may not have fired.
  void EncodeCycles(const Frame& frame, const CyclesOfAzimuth& cycles) {
    const std::vector<std::uint32_t>& columns = cycles.columns;
    if (fill_.num_blocks() == 0) first_ns_ = BeginNs(frame, columns);
    const std::size_t num_blocks = BlocksPerAzimuth();
    char* const blocks = packet_.data() + fill_.num_blocks() * kBlockSize;
    for (std::size_t i = 0; i < num_blocks; ++i) {
      const bool is_upper = i % model_.blocks_per_cycle() == 1;
      StoreAt<std::uint16_t>(blocks + i * kBlockSize, is_upper ? kUpperBlockFlag : kLowerBlockFlag);
      StoreAt<std::uint16_t>(blocks + i * kBlockSize + kAzimuthPlace, cycles.azimuth);
    }
    std::size_t place_in_block = 0;
    for (const std::uint32_t column : columns) {
      if (column != kNotFired) last_ns_ = FiringNs(frame, last_row_, column);
      for (std::size_t laser = 0; laser < rows_.size(); ++laser, ++place_in_block) {
        const std::size_t block = place_in_block / kLasersPerBlock;
        char* const place = blocks + block * kBlockSize + kReturnsPlace +
                            place_in_block % kLasersPerBlock * kReturnSize;
        StoreFiring(frame, rows_[laser], column, place);
      }
    }
  }

  // When the first of these cycles begins, or would.
  [[nodiscard]] std::int64_t BeginNs(const Frame& frame,
                                     const std::vector<std::uint32_t>& columns) const {
    if (columns.front() != kNotFired) return FiringNs(frame, first_row_, columns.front());
    return FiringNs(frame, first_row_, columns.back()) - std::llround(1e3 * model_.cycle_us);
  }

  [[nodiscard]] CodedReturn CodeReturn(const Frame& frame, std::size_t slot) const {
    const std::uint16_t distance = CodedDistance(frame.range_m[slot], model_.distance_unit_m);
    if (distance == 0) return {};
    return {distance, ReflectivityByte(frame.intensity[slot])};
  }

  void StoreFiring(const Frame& frame, std::size_t row, std::uint32_t column, char* place) const {
    CodedReturn strongest;
    CodedReturn other;
    if (column != kNotFired) {
      const std::size_t slot = row * frame.width() + std::size_t{column} * frame.returns;
      strongest = CodeReturn(frame, slot);
      if (frame.returns == 2) other = CodeReturn(frame, slot + 1);
    }
    if (!is_dual_) {
      Store(strongest, place);
      return;
    }
    const CodedPair pair = LastAndOther(strongest, other, 1);
    Store(pair.last, place);
    Store(pair.other, place + kBlockSize);
  }

  void AppendPacket(Datagrams& datagrams) {
    for (; *next_position_ns_ <= last_ns_; *next_position_ns_ += kNsPerS) {
      AppendPositionPacket(*next_position_ns_, clock_ahead_ns(), datagrams);
    }
    StoreAt<std::uint32_t>(packet_.data() + kTimePlace,
                           MicrosecondsPastHour(first_ns_ + clock_ahead_ns()));
    datagrams.items.push_back({.offset = datagrams.bytes.size(),
                               .size = kVelodynePacketSize,
                               .port = DatagramPort::kData,
                               .due_ns = last_ns_});
    datagrams.bytes.insert(datagrams.bytes.end(), packet_.begin(), packet_.end());
  }

  const VelodyneModel& model_;
  bool is_dual_;
  std::vector<std::uint16_t> rows_;  // Row of each laser.
  std::size_t num_columns_;
  std::vector<CyclesOfAzimuth> azimuths_;
  std::size_t first_row_{};  // The row that fires first in a cycle.
  std::size_t last_row_{};

  // The packet under construction.
  std::array<char, kVelodynePacketSize> packet_{};
  PacketFill fill_{kBlocksPerPacket};
  std::int64_t first_ns_{};
  std::int64_t last_ns_{};
  std::optional<std::int64_t> next_position_ns_;
};

std::uint8_t ModeByte(ReturnMode return_mode) {
  if (return_mode == ReturnMode::kDual) return kDualMode;
  return return_mode == ReturnMode::kLast ? kLastMode : kStrongestMode;
}

}  // namespace

void CheckFits(const VelodyneFormat& format, const ScanSpec& scan, ReturnMode return_mode) {
  const VelodyneModel& model = *format.model;
  const ScanFit fit(format.name);
  fit.CheckPattern(scan, {.name = model.name,
                          .channels = model.lasers,
                          .cycle_us = model.cycle_us,
                          .has_own_angles = model.has_own_angles,
                          .cycles_per_block = model.cycles_per_block()});
  const std::string got = Quoted(NameOf(return_mode));
  if (format.is_dual && return_mode != ReturnMode::kDual) {
    fit.Fail("/receiver/return_mode", "must be \"dual\"", got);
  }
  if (!format.is_dual && return_mode != ReturnMode::kStrongest &&
      return_mode != ReturnMode::kLast) {
    fit.Fail("/receiver/return_mode", "must be \"strongest\" or \"last\"", got);
  }
}

std::unique_ptr<FrameEncoder> MakeVelodyneEncoder(std::string_view format,
                                                  const ScanSpec& scan,
                                                  ReturnMode return_mode) {
  const VelodyneFormat found = FindVelodyneFormat(format);
  CheckFits(found, scan, return_mode);
  return std::make_unique<VelodyneEncoder>(found, std::get<SpinningSpec>(scan.pattern),
                                           scan.rate_hz, ModeByte(return_mode));
}

}  // namespace railcast
