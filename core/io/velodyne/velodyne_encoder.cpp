#include "core/io/velodyne/velodyne_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/field_layout.h"
#include "core/io/velodyne/velodyne_model.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

/// Reports what in a scan does not fit one format.
class Fit {
 public:
  explicit Fit(const VelodyneFormat& format)
      : model_(*format.model), prefix_("--protocol " + std::string(format.name) + ": /lidar") {}

  void CheckPattern(const ScanSpec& scan) const {
    const auto* const pattern = std::get_if<SpinningSpec>(&scan.pattern);
    if (pattern == nullptr) Fail("/scan/pattern/type", "must be \"spinning\"");
    if (pattern->rotation != Rotation::kClockwise) {
      Fail("/scan/pattern/rotation", "must be \"clockwise\"", Quoted(NameOf(pattern->rotation)));
    }
    if (pattern->channels.size() != model_.lasers.size()) {
      Fail("/scan/pattern/channels",
           "must be " + NumberText(model_.lasers.size()) + " as " + std::string(model_.name) +
               " has",
           NumberText(pattern->channels.size()));
    }
    if (!model_.has_own_angles) {
      CheckNear("/scan/pattern/cycle_us", pattern->cycle_us, model_.cycle_us, kMaxTimeOffset_us);
      CheckChannels(pattern->channels);
    }
    CheckColumns(*pattern, scan.rate_hz);
  }

  [[noreturn]] void Fail(const std::string& place,
                         const std::string& rule,
                         const std::string& got = {}) const {
    throw InputError(prefix_ + place + ": " + rule + (got.empty() ? "" : " (got " + got + ")"));
  }

 private:
  void CheckNear(const std::string& place, double got, double expected, double tolerance) const {
    if (std::abs(got - expected) <= tolerance) return;
    Fail(place, "must be " + NumberText(expected) + " as of " + std::string(model_.name),
         NumberText(got));
  }

  void CheckChannels(const std::vector<ChannelSpec>& channels) const {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const std::string place = "/scan/pattern/channels/" + NumberText(i);
      const ChannelSpec& laser = model_.lasers[i];
      CheckNear(place + "/elevation_deg", channels[i].elevation_deg, laser.elevation_deg,
                kMaxChannelOffset_deg);
      CheckNear(place + "/azimuth_deg", channels[i].azimuth_deg, laser.azimuth_deg,
                kMaxChannelOffset_deg);
      CheckNear(place + "/time_us", channels[i].time_us, laser.time_us, kMaxTimeOffset_us);
    }
  }

  void CheckColumns(const SpinningSpec& pattern, double rate_hz) const {
    const std::size_t in_block = model_.cycles_per_block();
    // The margin is for rounding: 1800 x 55.5555556 us is slightly more than 100 ms.
    const double fitting = std::floor(1e6 / (rate_hz * pattern.cycle_us) * (1.0 + 1e-6));
    const double most = fitting - std::fmod(fitting, static_cast<double>(in_block));
    if (pattern.columns == most) return;
    Fail("/scan/pattern/columns", "must be " + NumberText(most) + ", a whole turn",
         NumberText(pattern.columns));
  }

  const VelodyneModel& model_;
  std::string prefix_;
};

/// One return as a packet encodes it; all zeros if there is none.
struct CodedReturn {
  std::uint16_t distance{};
  std::uint8_t reflectivity{};
};

void Store(const CodedReturn& coded, char* place) {
  StoreAt<std::uint16_t>(place, coded.distance);
  StoreAt<std::uint8_t>(place + sizeof(std::uint16_t), coded.reflectivity);
}

/// Returns the azimuth of every column in the units of the packets.
std::vector<std::uint16_t> ColumnAzimuths(const SpinningSpec& pattern, double rate_hz) {
  std::vector<std::uint16_t> azimuths;
  for (std::uint32_t column = 0; column < pattern.columns; ++column) {
    const double turns = rate_hz * column * pattern.cycle_us * 1e-6;
    const std::int64_t units =
        std::llround((pattern.start_azimuth_deg + 360.0 * turns) / kAzimuthUnit_deg);
    const std::int64_t in_turn = units % kAzimuthUnitsPerTurn;
    azimuths.push_back(
        static_cast<std::uint16_t>(in_turn < 0 ? in_turn + kAzimuthUnitsPerTurn : in_turn));
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
        azimuths_(ColumnAzimuths(pattern, rate_hz)) {
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
    Check(frame.rows == rows_.size() && frame.columns == azimuths_.size(),
          "the frame is the scan's");
    Check(frame.returns == 1 || (is_dual_ && frame.returns == 2), "frames have the mode's returns");
    if (!next_position_ns_) {
      next_position_ns_ = (frame.stamp_ns + kNsPerS - 1) / kNsPerS * kNsPerS;
    }
    const auto step = static_cast<std::uint32_t>(model_.cycles_per_block());
    if (next_frame_ && frame.index > *next_frame_) LeaveOut(frame.index - *next_frame_, step);
    next_frame_ = frame.index + 1;
    for (std::uint32_t column = 0; column < frame.columns; column += step) {
      EncodeCycles(frame, column, column + step);
      if (num_blocks_ < kBlocksPerPacket) continue;
      if (!lacks_blocks_) AppendPacket(datagrams);
      num_blocks_ = 0;
      lacks_blocks_ = false;
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

  // Skips the frames that are left out and continues in the packet in which the next frame begins.
  void LeaveOut(std::uint32_t num_frames, std::uint32_t step) {
    const std::uint64_t num_azimuths = azimuths_.size() / step * std::uint64_t{num_frames};
    const std::uint64_t num_blocks = num_blocks_ + num_azimuths * BlocksPerAzimuth();
    num_blocks_ = static_cast<std::size_t>(num_blocks % kBlocksPerPacket);
    lacks_blocks_ = num_blocks_ > 0;
  }

  // Encodes the blocks of one azimuth: those of one firing cycle, or one block with two cycles.
  void EncodeCycles(const Frame& frame, std::uint32_t column, std::uint32_t end) {
    const std::size_t num_blocks = BlocksPerAzimuth();
    if (num_blocks_ == 0) first_ns_ = FiringNs(frame, first_row_, column);
    last_ns_ = FiringNs(frame, last_row_, end - 1);
    char* const blocks = packet_.data() + num_blocks_ * kBlockSize;
    for (std::size_t i = 0; i < num_blocks; ++i) {
      const bool is_upper = i % model_.blocks_per_cycle() == 1;
      StoreAt<std::uint16_t>(blocks + i * kBlockSize, is_upper ? kUpperBlockFlag : kLowerBlockFlag);
      StoreAt<std::uint16_t>(blocks + i * kBlockSize + kAzimuthPlace, azimuths_[column]);
    }
    std::size_t place_in_block = 0;
    for (std::uint32_t c = column; c < end; ++c) {
      for (std::size_t laser = 0; laser < rows_.size(); ++laser, ++place_in_block) {
        const std::size_t block = place_in_block / kLasersPerBlock;
        char* const place = blocks + block * kBlockSize + kReturnsPlace +
                            place_in_block % kLasersPerBlock * kReturnSize;
        StoreFiring(frame,
                    rows_[laser] * std::size_t{frame.width()} + std::size_t{c} * frame.returns,
                    place);
      }
    }
    num_blocks_ += num_blocks;
  }

  [[nodiscard]] CodedReturn CodeReturn(const Frame& frame, std::size_t slot) const {
    const double distance = static_cast<double>(frame.range_m[slot]) / model_.distance_unit_m + 0.5;
    // Written so that NaN, which means no return, is left out, too.
    if (!(distance >= 1.0 && distance < 65536.0)) return {};
    return {static_cast<std::uint16_t>(distance), ReflectivityByte(frame.intensity[slot])};
  }

  void StoreFiring(const Frame& frame, std::size_t slot, char* place) const {
    const CodedReturn strongest = CodeReturn(frame, slot);
    if (!is_dual_) {
      Store(strongest, place);
      return;
    }
    // The second slot holds the last return if that differs from the strongest, and otherwise the
    // second strongest, which is then nearer. In both cases the even block gets the farther return
    // and the odd block the nearer.
    const CodedReturn other = frame.returns == 2 ? CodeReturn(frame, slot + 1) : CodedReturn{};
    CodedReturn farther = strongest;
    CodedReturn nearer = other;
    if (nearer.distance > farther.distance) std::swap(nearer, farther);
    if (nearer.distance == 0) nearer = farther;
    Store(farther, place);
    Store(nearer, place + kBlockSize);
  }

  void AppendPacket(Datagrams& datagrams) {
    for (; *next_position_ns_ <= last_ns_; *next_position_ns_ += kNsPerS) {
      AppendPositionPacket(*next_position_ns_, datagrams);
    }
    StoreAt<std::uint32_t>(packet_.data() + kTimePlace, MicrosecondsPastHour(first_ns_));
    datagrams.items.push_back({.offset = datagrams.bytes.size(),
                               .size = kVelodynePacketSize,
                               .port = DatagramPort::kData,
                               .due_ns = last_ns_});
    datagrams.bytes.insert(datagrams.bytes.end(), packet_.begin(), packet_.end());
  }

  const VelodyneModel& model_;
  bool is_dual_;
  std::vector<std::uint16_t> rows_;  // Row of each laser.
  std::vector<std::uint16_t> azimuths_;
  std::size_t first_row_{};  // The row that fires first in a cycle.
  std::size_t last_row_{};

  // The packet under construction.
  std::array<char, kVelodynePacketSize> packet_{};
  std::size_t num_blocks_{};
  // Set if the packet's first blocks belong to a frame that was left out.
  bool lacks_blocks_ = false;
  std::optional<std::uint32_t> next_frame_;
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
  const Fit fit(format);
  fit.CheckPattern(scan);
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
