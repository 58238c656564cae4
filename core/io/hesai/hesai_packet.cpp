#include "core/io/hesai/hesai_packet.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <chrono>
#include <cmath>

#include "core/base/units.h"
#include "core/io/field_layout.h"
#include "core/io/velodyne/velodyne_packet.h"

namespace railcast {
namespace {

constexpr char kFactory = 0x42;

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

std::vector<HesaiCheckedBytes> HesaiCheckedBytesOf(const HesaiLayout& layout) {
  constexpr std::size_t kCrcSize = 4;
  if (!layout.checked_size) return {};
  const std::size_t blocks_end = layout.BlockPlace(layout.blocks);
  const std::size_t safety = blocks_end + kCrcSize;
  const std::size_t tail = safety + kHesaiSafetySize;
  return {{layout.header_size(), blocks_end},
          {safety + 1, tail - kCrcSize},
          {tail, *layout.checked_size - kCrcSize}};
}

void StoreHesaiChecksums(std::span<const HesaiCheckedBytes> checked, std::span<char> packet) {
  for (const auto [begin, end] : checked) {
    StoreAt<std::uint32_t>(packet.data() + end, HesaiCrc(packet.subspan(begin, end - begin)));
  }
}

bool HasRightHesaiChecksums(std::span<const HesaiCheckedBytes> checked,
                            std::span<const char> packet) {
  return std::ranges::all_of(checked, [&](const HesaiCheckedBytes& bytes) {
    const auto [begin, end] = bytes;
    return LoadAt<std::uint32_t>(packet.data() + end) ==
           HesaiCrc(packet.subspan(begin, end - begin));
  });
}

std::int64_t HesaiStatedNs(const HesaiTail& tail, int year_zero, std::span<const char> packet) {
  constexpr std::int64_t kUsPerSecond = 1'000'000;
  const auto date = [&](std::size_t i) {
    return static_cast<std::uint8_t>(packet[tail.date_place + i]);
  };
  const int year = date(0) < 100 ? year_zero + date(0) : 1900 + date(0);
  const std::chrono::year_month_day day(std::chrono::year(year), std::chrono::month(date(1)),
                                        std::chrono::day(date(2)));
  const std::int64_t days = day.ok() ? std::chrono::sys_days(day).time_since_epoch().count() : 0;
  const std::int64_t hours = 24 * days + date(3);
  const std::int64_t seconds = 3600 * hours + std::int64_t{60} * date(4) + date(5);
  const auto time_us = LoadAt<std::uint32_t>(packet.data() + tail.time_place);
  return (seconds * kUsPerSecond + time_us) * kNsPerUs;
}

HesaiPacket::HesaiPacket(const HesaiModel& model, std::uint8_t mode)
    : model_(&model), bytes_(model.layout.packet_size) {
  WriteHeader(mode);
  const HesaiTail& tail = model.layout.tail;
  StoreAt<std::uint8_t>(bytes_.data() + tail.mode_place, mode);
  bytes_[tail.factory_place] = kFactory;
  const auto& mark = model.layout.mark;
  if (mark) StoreAt<std::uint8_t>(bytes_.data() + mark->place, mark->value);
}

void HesaiPacket::WriteHeader(std::uint8_t mode) {
  if (!model_->layout.header) return;
  const HesaiHeader& header = *model_->layout.header;
  char* const start = bytes_.data();
  StoreAt<std::uint16_t>(start, kHesaiFlag);
  if (header.version) std::ranges::copy(*header.version, start + 2);
  StoreAt<std::uint8_t>(start + header.lasers_place, model_->layout.lasers);
  StoreAt<std::uint8_t>(start + header.blocks_place, model_->layout.blocks);
  StoreAt<std::uint8_t>(start + header.unit_place, kHesaiUnit_mm);
  constexpr std::size_t kWithFlags = 12;
  if (header.size < kWithFlags) return;
  const bool is_dual = model_->IsDual(mode);
  StoreAt<std::uint8_t>(start + 8, is_dual ? 1 : 0);
  StoreAt<std::uint8_t>(start + 10, is_dual ? 2 : 1);
  StoreAt<std::uint8_t>(start + 11, header.flags);
}

void HesaiPacket::BeginBlock(std::size_t block, std::size_t loop, std::uint16_t azimuth) {
  const HesaiLayout& layout = model_->layout;
  char* const start = bytes_.data() + layout.BlockPlace(block);
  std::fill_n(start, layout.block_size(), '\0');
  if (layout.has_block_flags) StoreAt<std::uint16_t>(start, kHesaiBlockFlag);
  StoreAt<std::uint16_t>(start + layout.block_head_size() - sizeof azimuth, azimuth);
  if (layout.loop_place && block == 0) bytes_[*layout.loop_place] = loop == 0 ? 1 : 0;
  if (!layout.state_place) return;
  char* const states = bytes_.data() + *layout.state_place;
  const auto state = LoadAt<std::uint16_t>(states);
  const std::size_t shift = 14 - 2 * block;
  StoreAt<std::uint16_t>(states, (state & ~(3U << shift)) | (loop << shift));
}

void HesaiPacket::SetReturn(std::size_t block, std::size_t laser, const CodedReturn& coded) {
  const HesaiLayout& layout = model_->layout;
  char* const place = bytes_.data() + layout.BlockPlace(block) + layout.block_head_size() +
                      laser * layout.return_size;
  StoreAt<std::uint16_t>(place, coded.distance);
  StoreAt<std::uint8_t>(place + sizeof coded.distance, coded.reflectivity);
}

std::span<const char> HesaiPacket::Close(const HesaiEnd& end) {
  const HesaiTail& tail = model_->layout.tail;
  StoreAt<std::uint16_t>(bytes_.data() + tail.speed_place, end.speed_rpm);
  if (tail.sequence_place) {
    StoreAt<std::uint32_t>(bytes_.data() + *tail.sequence_place, end.sequence);
  }
  WriteTime(end.time_ns);
  if (model_->layout.checked_size) WriteSafety(end.time_ns);
  StoreHesaiChecksums(HesaiCheckedBytesOf(model_->layout), bytes_);
  return bytes_;
}

void HesaiPacket::WriteTime(std::int64_t time_ns) {
  using std::chrono::floor;
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(time_ns)};
  const auto midnight = floor<std::chrono::days>(time);
  const auto second = floor<std::chrono::seconds>(time);
  const std::chrono::year_month_day day(midnight);
  const std::chrono::hh_mm_ss clock(second - midnight);
  char* const date = bytes_.data() + model_->layout.tail.date_place;
  StoreAt<std::uint8_t>(date, static_cast<int>(day.year()) - model_->year_zero);
  StoreAt<std::uint8_t>(date + 1, static_cast<unsigned>(day.month()));
  StoreAt<std::uint8_t>(date + 2, static_cast<unsigned>(day.day()));
  StoreAt<std::uint8_t>(date + 3, clock.hours().count());
  StoreAt<std::uint8_t>(date + 4, clock.minutes().count());
  StoreAt<std::uint8_t>(date + 5, clock.seconds().count());
  const auto us = std::chrono::floor<std::chrono::microseconds>(time - second);
  StoreAt<std::uint32_t>(bytes_.data() + model_->layout.tail.time_place, us.count());
}

void HesaiPacket::WriteSafety(std::int64_t time_ns) {
  constexpr std::size_t kCrcSize = 4;
  // "Normal", with a counter that a real sensor raises every 5 ms.
  constexpr std::uint8_t kVersion = 1;
  constexpr std::uint8_t kNormal = 1U << 5U;
  constexpr std::int64_t kCount_ns = 5'000'000;
  const HesaiLayout& layout = model_->layout;
  char* const safety = bytes_.data() + layout.BlockPlace(layout.blocks) + kCrcSize;
  StoreAt<std::uint8_t>(safety, kVersion);
  StoreAt<std::uint8_t>(safety + 1, kNormal | (time_ns / kCount_ns & 7));
}

}  // namespace railcast
