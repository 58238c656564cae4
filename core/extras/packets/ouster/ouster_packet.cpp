#include "core/extras/packets/ouster/ouster_packet.h"

#include <boost/crc.hpp>
#include <cstring>

#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/field_layout.h"

namespace railcast {
namespace {

constexpr std::size_t kOusterHeaderSize = 32;
constexpr std::size_t kOusterFooterSize = 32;
constexpr std::size_t kChecksumSize = 8;
/// What firmware 2.3 has in the place of a checksum; that of 2.2 has 0.
constexpr std::uint64_t kBlankFooter = 0xDEADBEEF0000C0DE;

// In a column.
constexpr std::size_t kMeasurementPlace = 8;
constexpr std::size_t kStatusPlace = 10;
constexpr std::size_t kLegacyFramePlace = 10;
constexpr std::size_t kEncoderPlace = 12;
constexpr std::uint32_t kLegacyValid = 0xFFFFFFFF;

// Fields of a header: the byte at which they begin, and their number of bits, from the lowest on.
struct HeaderField {
  std::size_t place{};
  unsigned bits{};
};
struct HeaderPlaces {
  HeaderField type, frame, initialization, serial, alerts;
};
constexpr HeaderPlaces kStandardHeader = {{0, 16}, {2, 16}, {4, 24}, {7, 40}, {12, 8}};
constexpr HeaderPlaces kFusaHeader = {{0, 8}, {4, 32}, {1, 24}, {11, 40}, {8, 8}};
constexpr std::size_t kShutdownCountdownPlace = 16;
constexpr std::size_t kShotCountdownPlace = 17;
constexpr std::size_t kShutdownPlace = 18;
constexpr std::size_t kShotLimitingPlace = 19;
constexpr std::uint8_t kFourBits = 0xF;

std::uint64_t LoadField(const char* header, const HeaderField& field) {
  std::uint64_t value = 0;
  std::memcpy(&value, header + field.place, field.bits / 8);
  return value;
}

void StoreField(char* header, const HeaderField& field, std::uint64_t value) {
  std::memcpy(header + field.place, &value, field.bits / 8);
}

/// How the first word of a return holds range and flags: bits from the lowest on.
struct ReturnWord {
  std::size_t num_bytes{};
  unsigned range_bits{};
  unsigned flags_begin{};
  unsigned flags_bits{};
  std::uint32_t unit_mm = 1;
};
constexpr ReturnWord kLegacyWord = {4, 20, 28, 4};
constexpr ReturnWord kFullRateWord = {3, 19, 19, 5};
constexpr ReturnWord kLowRateWord = {2, 15, 15, 1, 8};
// Place of the byte that states the photons of the background.
constexpr std::uint16_t kLowRateNearIr = 16;

/// The bytes of a pixel at which its fields begin.
struct ReturnPlaces {
  std::size_t word{};
  std::size_t reflectivity{};
  std::size_t signal{};  ///< Absent at low rate.
};
struct PixelFormat {
  ReturnWord word;
  std::array<ReturnPlaces, 2> returns;
  std::size_t near_ir{};
};
// In the order of OusterProfile.
constexpr std::array<PixelFormat, 6> kPixelFormats = {{
    {kLegacyWord, {{{0, 4, 6}}}, 8},
    {kFullRateWord, {{{0, 4, 6}}}, 8},
    {kFullRateWord, {{{0, 3, 8}, {4, 7, 10}}}, 12},
    {kLowRateWord, {{{0, 2}}}, 3},
    {kLowRateWord, {{{0, 2}, {4, 6}}}, 3},
    {kLowRateWord, {{{0, 2}, {4, 6}}}, 3},
}};

const PixelFormat& FormatOf(OusterProfile profile) {
  return kPixelFormats.at(static_cast<std::size_t>(profile));
}

constexpr std::uint32_t LowestBits(unsigned num) {
  return (1U << num) - 1;
}

}  // namespace

OusterLayout::OusterLayout(const OusterMetadata& metadata)
    : profile_(metadata.profile),
      has_fusa_header_(metadata.has_fusa_header),
      has_wide_reflectivity_(metadata.has_wide_reflectivity),
      num_columns_(metadata.columns_per_packet),
      num_pixels_(metadata.pixels_per_column),
      header_size_(is_legacy() ? 0 : kOusterHeaderSize),
      column_header_size_(is_legacy() ? 16 : 12),
      packet_size_(OusterPacketSize(metadata)) {
  const std::size_t footer_size = is_legacy() ? 0 : kOusterFooterSize;
  column_size_ = (packet_size_ - header_size_ - footer_size) / num_columns_;
  const std::size_t column_footer_size = is_legacy() ? 4 : 0;
  pixel_size_ = (column_size_ - column_header_size_ - column_footer_size) / num_pixels_;
}

std::uint32_t OusterLayout::most_range_mm() const {
  const ReturnWord& word = FormatOf(profile_).word;
  return word.unit_mm * LowestBits(word.range_bits);
}

OusterHeader OusterLayout::HeaderOf(std::span<const char> packet) const {
  if (is_legacy()) {
    return {.frame_id = LoadAt<std::uint16_t>(packet.data() + kLegacyFramePlace)};
  }
  const HeaderPlaces& at = has_fusa_header_ ? kFusaHeader : kStandardHeader;
  const char* const header = packet.data();
  return {.packet_type = static_cast<std::uint16_t>(LoadField(header, at.type)),
          .frame_id = static_cast<std::uint32_t>(LoadField(header, at.frame)),
          .initialization_id = static_cast<std::uint32_t>(LoadField(header, at.initialization)),
          .serial_number = LoadField(header, at.serial),
          .alert_flags = static_cast<std::uint8_t>(LoadField(header, at.alerts)),
          .shutdown_countdown_s = LoadAt<std::uint8_t>(header + kShutdownCountdownPlace),
          .shot_limiting_countdown_s = LoadAt<std::uint8_t>(header + kShotCountdownPlace),
          .thermal_shutdown =
              static_cast<std::uint8_t>(LoadAt<std::uint8_t>(header + kShutdownPlace) & kFourBits),
          .shot_limiting = static_cast<std::uint8_t>(
              LoadAt<std::uint8_t>(header + kShotLimitingPlace) & kFourBits)};
}

void OusterLayout::Store(const OusterHeader& header, std::span<char> packet) const {
  if (is_legacy()) return;
  const HeaderPlaces& at = has_fusa_header_ ? kFusaHeader : kStandardHeader;
  char* const place = packet.data();
  StoreField(place, at.type, header.packet_type);
  StoreField(place, at.frame, header.frame_id);
  StoreField(place, at.initialization, header.initialization_id);
  StoreField(place, at.serial, header.serial_number);
  StoreField(place, at.alerts, header.alert_flags);
  StoreAt<std::uint8_t>(place + kShutdownCountdownPlace, header.shutdown_countdown_s);
  StoreAt<std::uint8_t>(place + kShotCountdownPlace, header.shot_limiting_countdown_s);
  StoreAt<std::uint8_t>(place + kShutdownPlace, header.thermal_shutdown & kFourBits);
  StoreAt<std::uint8_t>(place + kShotLimitingPlace, header.shot_limiting & kFourBits);
}

OusterColumn OusterLayout::ColumnOf(std::span<const char> packet, std::size_t column) const {
  const char* const place = packet.data() + PlaceOfColumn(column);
  const bool is_valid =
      is_legacy()
          ? LoadAt<std::uint32_t>(place + column_size_ - sizeof(kLegacyValid)) == kLegacyValid
          : (LoadAt<std::uint16_t>(place + kStatusPlace) & 1U) != 0;
  return {.time_ns = LoadAt<std::uint64_t>(place),
          .measurement_id = LoadAt<std::uint16_t>(place + kMeasurementPlace),
          .is_valid = is_valid};
}

std::uint32_t OusterLayout::EncoderTicksOf(std::span<const char> packet, std::size_t column) const {
  return LoadAt<std::uint32_t>(packet.data() + PlaceOfColumn(column) + kEncoderPlace);
}

void OusterLayout::Store(const OusterColumn& column,
                         std::size_t place,
                         std::uint32_t frame_id,
                         std::uint32_t encoder_ticks,
                         std::span<char> packet) const {
  char* const begin = packet.data() + PlaceOfColumn(place);
  StoreAt<std::uint64_t>(begin, column.time_ns);
  StoreAt<std::uint16_t>(begin + kMeasurementPlace, column.measurement_id);
  if (!is_legacy()) {
    StoreAt<std::uint16_t>(begin + kStatusPlace, column.is_valid ? 1 : 0);
    return;
  }
  StoreAt<std::uint16_t>(begin + kLegacyFramePlace, frame_id);
  StoreAt<std::uint32_t>(begin + kEncoderPlace, encoder_ticks);
  StoreAt<std::uint32_t>(begin + column_size_ - sizeof(kLegacyValid),
                         column.is_valid ? kLegacyValid : 0);
}

OusterPixel OusterLayout::PixelAt(std::span<const char> packet, std::size_t place) const {
  const auto& [word, returns, near_ir] = FormatOf(profile_);
  const char* const begin = packet.data() + place;
  OusterPixel pixel;
  for (std::size_t i = 0; i < num_returns(); ++i) {
    const auto bits = LoadAt<std::uint32_t>(begin + returns[i].word);
    OusterReturn& coded = pixel.returns[i];
    coded.range_mm = word.unit_mm * (bits & LowestBits(word.range_bits));
    coded.flags = static_cast<std::uint8_t>(bits >> word.flags_begin & LowestBits(word.flags_bits));
    const char* const reflectivity = begin + returns[i].reflectivity;
    coded.reflectivity = has_wide_reflectivity_ ? LoadAt<std::uint16_t>(reflectivity)
                                                : LoadAt<std::uint8_t>(reflectivity);
    if (has_signal()) coded.signal = LoadAt<std::uint16_t>(begin + returns[i].signal);
  }
  pixel.near_ir =
      has_low_rate()
          ? static_cast<std::uint16_t>(kLowRateNearIr * LoadAt<std::uint8_t>(begin + near_ir))
          : LoadAt<std::uint16_t>(begin + near_ir);
  return pixel;
}

void OusterLayout::StorePixel(const OusterPixel& pixel,
                              std::size_t place,
                              std::span<char> packet) const {
  const auto& [word, returns, near_ir] = FormatOf(profile_);
  char* const begin = packet.data() + place;
  for (std::size_t i = 0; i < num_returns(); ++i) {
    const OusterReturn& coded = pixel.returns[i];
    const std::uint32_t bits = (coded.range_mm / word.unit_mm & LowestBits(word.range_bits)) |
                               (coded.flags & LowestBits(word.flags_bits)) << word.flags_begin;
    std::memcpy(begin + returns[i].word, &bits, word.num_bytes);
    std::memcpy(begin + returns[i].reflectivity, &coded.reflectivity,
                has_wide_reflectivity_ ? 2 : 1);
    if (has_signal()) StoreAt<std::uint16_t>(begin + returns[i].signal, coded.signal);
  }
  if (has_low_rate()) {
    StoreAt<std::uint8_t>(begin + near_ir, pixel.near_ir / kLowRateNearIr);
  } else {
    StoreAt<std::uint16_t>(begin + near_ir, pixel.near_ir);
  }
}

std::uint64_t OusterChecksum(std::span<const char> bytes) {
  constexpr std::uint64_t kAllBits = ~std::uint64_t{0};
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693, kAllBits, kAllBits, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

bool StatesChecksum(std::span<const char> packet) {
  const auto stated = LoadAt<std::uint64_t>(packet.data() + packet.size() - kChecksumSize);
  return stated != 0 && stated != kBlankFooter;
}

bool HasRightChecksum(std::span<const char> packet) {
  const std::span<const char> before = packet.first(packet.size() - kChecksumSize);
  return !StatesChecksum(packet) ||
         LoadAt<std::uint64_t>(packet.data() + before.size()) == OusterChecksum(before);
}

void StoreChecksum(std::span<char> packet) {
  const std::span<char> before = packet.first(packet.size() - kChecksumSize);
  StoreAt<std::uint64_t>(packet.data() + before.size(), OusterChecksum(before));
}

OusterImu ImuOf(std::span<const char, kOusterImuPacketSize> packet) {
  OusterImu imu{.system_time_ns = LoadAt<std::uint64_t>(packet.data()),
                .acceleration_time_ns = LoadAt<std::uint64_t>(packet.data() + 8),
                .rotation_time_ns = LoadAt<std::uint64_t>(packet.data() + 16)};
  for (std::size_t i = 0; i < 3; ++i) {
    imu.acceleration_g[i] = LoadAt<float>(packet.data() + 24 + 4 * i);
    imu.rotation_degps[i] = LoadAt<float>(packet.data() + 36 + 4 * i);
  }
  return imu;
}

void StoreImu(const OusterImu& imu, std::span<char, kOusterImuPacketSize> packet) {
  StoreAt<std::uint64_t>(packet.data(), imu.system_time_ns);
  StoreAt<std::uint64_t>(packet.data() + 8, imu.acceleration_time_ns);
  StoreAt<std::uint64_t>(packet.data() + 16, imu.rotation_time_ns);
  for (std::size_t i = 0; i < 3; ++i) {
    StoreAt<float>(packet.data() + 24 + 4 * i, imu.acceleration_g[i]);
    StoreAt<float>(packet.data() + 36 + 4 * i, imu.rotation_degps[i]);
  }
}

}  // namespace railcast
