#include "core/extras/packets/spinning/spinning_packet.h"

#include <endian.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <chrono>
#include <cmath>

#include "core/base/join.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/spinning/scan_fit.h"
#include "core/extras/packets/spinning/sensor_turn.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"

namespace railcast {
namespace {

constexpr char kFactory = 0x42;
constexpr std::int64_t kUsPerSecond = 1'000'000;
constexpr std::size_t kHeaderWithFlags = 12;

std::uint8_t ByteAt(std::span<const char> payload, std::size_t place) {
  return static_cast<std::uint8_t>(payload[place]);
}

std::optional<std::string> RefuseByte(const char* what,
                                      std::size_t expected,
                                      std::size_t place,
                                      std::span<const char> payload) {
  const std::uint8_t got = ByteAt(payload, place);
  if (got == expected) return std::nullopt;
  return what + (" must be " + NumberText(expected)) + Got(got);
}

std::optional<std::string> RefuseVersion(const SpinningModel& model,
                                         std::span<const char> payload) {
  if (std::equal(model.version.begin(), model.version.end(), payload.begin() + 2,
                 [](std::uint8_t byte, char got) { return static_cast<char>(byte) == got; })) {
    return std::nullopt;
  }
  const auto text = [](std::uint8_t major, std::uint8_t minor) {
    return NumberText(major) + "." + NumberText(minor);
  };
  return "protocol must be " + text(model.version[0], model.version[1]) + " (got " +
         text(ByteAt(payload, 2), ByteAt(payload, 3)) + ")";
}

std::optional<std::string> RefuseHeader(const SpinningModel& model, std::span<const char> payload) {
  if (model.header_size == 0) return std::nullopt;
  const auto flag = LoadAt<std::uint16_t>(payload.data());
  if (flag != kHesaiFlag) return "flag must be 65518" + Got(flag);
  if (auto refusal = RefuseVersion(model, payload)) return refusal;
  if (auto refusal = RefuseByte("lasers", model.lasers, model.lasers_place, payload)) {
    return refusal;
  }
  return RefuseByte("blocks", model.blocks, model.blocks_place, payload);
}

bool HasRightChecksums(const SpinningModel& model, std::span<const char> packet) {
  return std::ranges::all_of(model.checked, [&](const auto& bytes) {
    const auto& [begin, end] = bytes;
    return LoadAt<std::uint32_t>(packet.data() + end) ==
           HesaiCrc(packet.subspan(begin, end - begin));
  });
}

std::optional<std::string> RefuseMode(const SpinningModel& model, std::uint8_t mode) {
  std::vector<std::uint8_t> modes = model.single_modes;
  modes.insert(modes.end(), model.dual_modes.begin(), model.dual_modes.end());
  if (modes.empty() || std::ranges::count(modes, mode) > 0) return std::nullopt;
  return "return mode must be " + JoinInProse(modes, " or ", NumberText<std::uint8_t>) + Got(mode);
}

std::optional<std::string> RefuseTail(const SpinningModel& model, std::span<const char> payload) {
  const auto time_us = LoadAt<std::uint32_t>(payload.data() + model.time_place);
  if (model.date_place == 0 && time_us >= kUsPerHour) {
    return "microseconds past the hour must be < 3600000000" + Got(time_us);
  }
  if (model.date_place > 0 && time_us >= kUsPerSecond) {
    return "microseconds of the second must be < 1000000" + Got(time_us);
  }
  if (model.mark_place > 0 && ByteAt(payload, model.mark_place) != model.mark_value) {
    return model.mark_rule + Got(ByteAt(payload, model.mark_place));
  }
  return RefuseMode(model, ModeOf(model, payload));
}

/// Whether all is zeros from a block's azimuth on.
bool IsZeros(const SpinningModel& model, std::span<const char> packet, std::size_t block) {
  const std::size_t head = model.azimuth_place();
  const auto bytes = packet.subspan(model.BlockPlace(block) + head, model.block_size() - head);
  return std::ranges::all_of(bytes, [](char byte) { return byte == 0; });
}

std::optional<std::string> RefuseBlock(const SpinningModel& model,
                                       std::span<const char> payload,
                                       std::size_t block) {
  const auto flag = LoadAt<std::uint16_t>(payload.data() + model.BlockPlace(block));
  const auto& flags = model.block_flags;
  if (!flags.empty() && flag != flags[block % flags.size()]) {
    return "flag must be " + NumberText(flags[block % flags.size()]) + Got(flag);
  }
  const std::uint16_t azimuth = AzimuthOf(model, payload, block);
  if (azimuth >= kAzimuthUnitsPerTurn) return "azimuth must be <= 35999" + Got(azimuth);
  // The fine azimuths of a pair need not be the same.
  if (model.has_fine_azimuth) return std::nullopt;
  const std::size_t in_group = BlocksInGroup(model, payload);
  const std::size_t first = block / in_group * in_group;
  if (azimuth != AzimuthOf(model, payload, first)) {
    return "azimuth must be that of its pair" + Got(azimuth);
  }
  const std::size_t loop = LoopOf(model, payload, block);
  if (loop >= model.loops.size()) return "azimuth state must be 0 or 1" + Got(loop);
  if (loop != LoopOf(model, payload, first)) {
    return "azimuth state must be that of its pair" + Got(loop);
  }
  return std::nullopt;
}

/// A window of the sensor is one gap within a packet; a wrong azimuth makes two.
std::optional<std::string> RefuseAzimuths(const SpinningModel& model,
                                          std::span<const char> payload,
                                          const std::vector<std::size_t>& loops) {
  constexpr std::int64_t kMostUneven = 50;
  const std::int64_t usual = UsualStep(model, payload, loops);
  int num_gaps = 0;
  for (std::size_t i = 1; i < loops.size(); ++i) {
    const std::int64_t step =
        StepTo(AzimuthOf(model, payload, loops[i]), AzimuthOf(model, payload, loops[i - 1]));
    const std::int64_t off = std::abs(step - usual);
    if (std::min(off, kAzimuthUnitsPerTurn - off) <= kMostUneven + 4 * usual) continue;
    if (++num_gaps == 2) return "azimuths of blocks must go on evenly" + Got(step);
  }
  return std::nullopt;
}

}  // namespace

std::uint8_t PercentByte(float intensity) {
  constexpr float kMost = 255.0F;
  // Written so that NaN gives 0, too.
  if (!(intensity > 0.0F)) return 0;
  return static_cast<std::uint8_t>(std::lround(std::min(100.0F * intensity, kMost)));
}

std::uint32_t HesaiCrc(std::span<const char> bytes) {
  boost::crc_optimal<32, 0x04C11DB7, 0xFFFFFFFF, 0, false, false> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

void StoreChecksums(const SpinningModel& model, std::span<char> packet) {
  for (const auto& [begin, end] : model.checked) {
    StoreAt<std::uint32_t>(packet.data() + end, HesaiCrc(packet.subspan(begin, end - begin)));
  }
}

bool HasHeaderOf(const SpinningModel& model, std::span<const char> payload) {
  return payload.size() >= model.header_size && !RefuseHeader(model, payload);
}

std::optional<std::string> RefusePacket(const SpinningModel& model, std::span<const char> payload) {
  if (payload.size() != model.packet_size) {
    return "must be " + NumberText(model.packet_size) + " bytes" + Got(payload.size());
  }
  if (auto refusal = RefuseHeader(model, payload)) {
    return model.header_rule.empty() ? refusal : model.header_rule;
  }
  if (UnitOf_m(model, payload) == 0.0) return "distance unit must be > 0" + Got(0);
  if (!HasRightChecksums(model, payload)) return std::string(kWrongChecksum);
  if (auto refusal = RefuseTail(model, payload)) return refusal;
  const std::vector<std::size_t> loops = LoopsIn(model, payload);
  if (loops.empty()) return "must have a block that is not all zeros";
  for (const std::size_t first : loops) {
    for (std::size_t i = first; i < first + BlocksInGroup(model, payload); ++i) {
      const auto refusal = RefuseBlock(model, payload, i);
      if (refusal) return "block " + NumberText(i) + ": " + *refusal;
    }
  }
  return RefuseAzimuths(model, payload, loops);
}

std::uint8_t ModeOf(const SpinningModel& model, std::span<const char> packet) {
  return model.mode_place > 0 ? ByteAt(packet, model.mode_place) : std::uint8_t{0};
}

std::size_t BlocksInGroup(const SpinningModel& model, std::span<const char> packet) {
  return model.blocks_per_loop() * (model.IsDual(ModeOf(model, packet)) ? 2U : 1U);
}

double UnitOf_m(const SpinningModel& model, std::span<const char> packet) {
  return 1e-3 * (model.unit_place > 0 ? ByteAt(packet, model.unit_place) : model.unit_mm);
}

std::uint16_t AzimuthOf(const SpinningModel& model,
                        std::span<const char> packet,
                        std::size_t block) {
  return LoadAt<std::uint16_t>(packet.data() + model.BlockPlace(block) + model.azimuth_place());
}

// It may be one that the sensor does not have.
std::size_t LoopOf(const SpinningModel& model, std::span<const char> packet, std::size_t block) {
  if (model.state_place > 0) {
    const auto states = LoadAt<std::uint16_t>(packet.data() + model.state_place);
    return (states >> (14 - 2 * block)) & 3U;
  }
  if (model.loop_place == 0) return 0;
  // An odd flag says that the packet begins with the first loop; from there on they alternate.
  const std::size_t begins = ByteAt(packet, model.loop_place);
  return (begins + block / BlocksInGroup(model, packet) + 1) % model.loops.size();
}

std::vector<std::size_t> LoopsIn(const SpinningModel& model, std::span<const char> packet) {
  const std::size_t in_group = BlocksInGroup(model, packet);
  std::vector<std::size_t> loops;
  std::vector<std::size_t> zeros;  // Which may be loops.
  for (std::size_t first = 0; first + in_group <= model.blocks; first += in_group) {
    bool has_zeros = false;
    bool has_flags = true;
    for (std::size_t i = first; i < first + in_group; ++i) {
      const bool is_zeros = IsZeros(model, packet, i);
      const auto flag = LoadAt<std::uint16_t>(packet.data() + model.BlockPlace(i));
      has_zeros = has_zeros || is_zeros;
      has_flags = has_flags && !(is_zeros && flag == 0 && !model.block_flags.empty());
    }
    if (has_flags) (has_zeros ? zeros : loops).push_back(first);
  }
  if (zeros.empty()) return loops;
  constexpr std::int64_t kNear = 500;
  const bool is_near_zero = std::ranges::any_of(loops, [&](std::size_t first) {
    const std::int64_t azimuth = AzimuthOf(model, packet, first);
    return azimuth < kNear || azimuth > kAzimuthUnitsPerTurn - kNear;
  });
  if (!loops.empty() && !is_near_zero) return loops;
  loops.insert(loops.end(), zeros.begin(), zeros.end());
  std::ranges::sort(loops);
  return loops;
}

std::int64_t UsualStep(const SpinningModel& model,
                       std::span<const char> packet,
                       const std::vector<std::size_t>& loops) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < loops.size(); ++i) {
    steps.push_back(
        StepTo(AzimuthOf(model, packet, loops[i]), AzimuthOf(model, packet, loops[i - 1])));
  }
  if (steps.empty()) return 0;
  std::ranges::sort(steps);
  const std::int64_t lower = steps[(steps.size() - 1) / 2];
  const std::int64_t upper = steps[steps.size() / 2];
  return lower > 0 && upper > 2 * lower ? lower : upper;
}

PacketMark MarkOf(const SpinningModel& model, std::span<const char> packet) {
  constexpr std::int64_t kUint32s = std::int64_t{1} << 32U;
  const bool has_date = model.date_place > 0;
  PacketMark mark;
  mark.time_ns = has_date ? StatedNs(model, packet)
                          : kNsPerUs * LoadAt<std::uint32_t>(packet.data() + model.time_place);
  mark.time_period_ns = has_date ? 0 : kUsPerHour * kNsPerUs;
  mark.is_counted = model.sequence_place > 0;
  mark.number =
      mark.is_counted ? LoadAt<std::uint32_t>(packet.data() + model.sequence_place) : mark.time_ns;
  mark.period = mark.is_counted ? kUint32s : mark.time_period_ns;
  const double loop_ns = has_date
                             ? static_cast<double>(model.loop_ns)
                             : 1e3 * model.cycle_us * static_cast<double>(model.cycles_per_block());
  const std::size_t num_loops = model.blocks / BlocksInGroup(model, packet);
  mark.packet_ns = std::llround(loop_ns * static_cast<double>(num_loops));
  const std::vector<std::size_t> loops = LoopsIn(model, packet);
  mark.azimuth_step = UsualStep(model, packet, loops);
  mark.first_azimuth = AzimuthOf(model, packet, loops.front());
  mark.last_azimuth = AzimuthOf(model, packet, loops.back());
  // More than the blocks that may be missing within the packet take.
  const std::int64_t most = mark.azimuth_step * static_cast<std::int64_t>(2 * num_loops) + 100;
  const std::int64_t turned = StepTo(mark.last_azimuth, mark.first_azimuth);
  if (mark.azimuth_step > 0) {
    mark.turn_ns = mark.packet_ns * kAzimuthUnitsPerTurn /
                   (mark.azimuth_step * static_cast<std::int64_t>(num_loops));
  }
  if (turned <= most || turned >= kAzimuthUnitsPerTurn - most) return mark;
  std::int64_t longest = 0;
  for (std::size_t i = 1; i < loops.size(); ++i) {
    const std::int64_t before = AzimuthOf(model, packet, loops[i - 1]);
    const std::int64_t after = AzimuthOf(model, packet, loops[i]);
    if (StepTo(after, before) <= longest) continue;
    longest = StepTo(after, before);
    mark.silent_from = before;
    mark.silent_to = after;
  }
  return mark;
}

std::int64_t StatedNs(const SpinningModel& model, std::span<const char> packet) {
  const auto date = [&](std::size_t i) { return ByteAt(packet, model.date_place + i); };
  const int year = date(0) < 100 ? model.year_zero + date(0) : 1900 + date(0);
  const std::chrono::year_month_day day(std::chrono::year(year), std::chrono::month(date(1)),
                                        std::chrono::day(date(2)));
  const std::int64_t days = day.ok() ? std::chrono::sys_days(day).time_since_epoch().count() : 0;
  const std::int64_t hours = 24 * days + date(3);
  std::int64_t seconds = 3600 * hours + std::int64_t{60} * date(4) + date(5);
  if (model.counts_seconds && date(0) == 0) {
    seconds = 0;
    for (std::size_t i = 2; i < 6; ++i) seconds = 256 * seconds + date(i);
  }
  const auto time_us = LoadAt<std::uint32_t>(packet.data() + model.time_place);
  return (seconds * kUsPerSecond + time_us) * kNsPerUs;
}

SpinningPacket::SpinningPacket(const SpinningModel& model, std::uint8_t mode)
    : model_(&model), bytes_(model.packet_size) {
  WriteHeader(mode);
  const auto store = [&](std::size_t place, std::uint8_t byte) {
    if (place > 0) StoreAt<std::uint8_t>(bytes_.data() + place, byte);
  };
  store(model.mode_place, mode);
  store(model.factory_place, kFactory);
  store(model.mark_place, model.mark_value);
}

void SpinningPacket::WriteHeader(std::uint8_t mode) {
  if (model_->header_size == 0) return;
  char* const start = bytes_.data();
  StoreAt<std::uint16_t>(start, kHesaiFlag);
  std::ranges::copy(model_->version, start + 2);
  StoreAt<std::uint8_t>(start + model_->lasers_place, model_->lasers);
  StoreAt<std::uint8_t>(start + model_->blocks_place, model_->blocks);
  StoreAt<std::uint8_t>(start + model_->unit_place, model_->unit_mm);
  if (model_->header_size < kHeaderWithFlags) return;
  const bool is_dual = model_->IsDual(mode);
  StoreAt<std::uint8_t>(start + 8, is_dual ? 1 : 0);
  StoreAt<std::uint8_t>(start + 10, is_dual ? 2 : 1);
  StoreAt<std::uint8_t>(start + 11, model_->header_flags);
}

void SpinningPacket::BeginBlock(std::size_t block,
                                std::size_t loop,
                                std::uint16_t azimuth,
                                std::uint8_t fine) {
  char* const start = bytes_.data() + model_->BlockPlace(block);
  std::fill_n(start, model_->block_size(), '\0');
  const auto& flags = model_->block_flags;
  if (!flags.empty()) StoreAt<std::uint16_t>(start, flags[block % flags.size()]);
  StoreAt<std::uint16_t>(start + model_->azimuth_place(), azimuth);
  if (model_->has_fine_azimuth) StoreAt<std::uint8_t>(start + 2, fine);
  if (model_->loop_place > 0 && block == 0) bytes_[model_->loop_place] = loop == 0 ? 1 : 0;
  if (model_->state_place == 0) return;
  char* const states = bytes_.data() + model_->state_place;
  const auto state = LoadAt<std::uint16_t>(states);
  const std::size_t shift = 14 - 2 * block;
  StoreAt<std::uint16_t>(states, (state & ~(3U << shift)) | (loop << shift));
}

std::span<const char> SpinningPacket::Close(const PacketEnd& end) {
  char* const start = bytes_.data();
  if (model_->speed_place > 0) StoreAt<std::uint16_t>(start + model_->speed_place, end.speed_rpm);
  if (model_->sequence_place > 0) {
    StoreAt<std::uint32_t>(start + model_->sequence_place, end.sequence);
  }
  WriteTime(end.time_ns);
  if (model_->safety_place > 0) WriteSafety(end.time_ns);
  StoreChecksums(*model_, bytes_);
  return bytes_;
}

void SpinningPacket::WriteTime(std::int64_t time_ns) {
  using std::chrono::floor;
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(time_ns)};
  const auto second = floor<std::chrono::seconds>(time);
  const auto hour = floor<std::chrono::hours>(time);
  const auto us = floor<std::chrono::microseconds>(time - (model_->date_place > 0 ? second : hour));
  StoreAt<std::uint32_t>(bytes_.data() + model_->time_place, us.count());
  if (model_->date_place == 0) return;
  if (model_->counts_seconds) {
    const auto seconds = static_cast<std::uint32_t>(second.time_since_epoch().count());
    StoreAt<std::uint32_t>(bytes_.data() + model_->date_place + 2, htobe32(seconds));
    return;
  }
  const auto midnight = floor<std::chrono::days>(time);
  const std::chrono::year_month_day day(midnight);
  const std::chrono::hh_mm_ss clock(second - midnight);
  char* const date = bytes_.data() + model_->date_place;
  StoreAt<std::uint8_t>(date, static_cast<int>(day.year()) - model_->year_zero);
  StoreAt<std::uint8_t>(date + 1, static_cast<unsigned>(day.month()));
  StoreAt<std::uint8_t>(date + 2, static_cast<unsigned>(day.day()));
  StoreAt<std::uint8_t>(date + 3, clock.hours().count());
  StoreAt<std::uint8_t>(date + 4, clock.minutes().count());
  StoreAt<std::uint8_t>(date + 5, clock.seconds().count());
}

// "Normal", with a counter that a real sensor raises every 5 ms.
void SpinningPacket::WriteSafety(std::int64_t time_ns) {
  constexpr std::uint8_t kVersion = 1;
  constexpr std::uint8_t kNormal = 1U << 5U;
  constexpr std::int64_t kCount_ns = 5'000'000;
  char* const safety = bytes_.data() + model_->safety_place;
  StoreAt<std::uint8_t>(safety, kVersion);
  StoreAt<std::uint8_t>(safety + 1, kNormal | (time_ns / kCount_ns & 7));
}

}  // namespace railcast
