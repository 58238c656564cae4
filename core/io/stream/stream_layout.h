#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace railcast {

// Values are copied to and from the wire without swapping bytes.
static_assert(std::endian::native == std::endian::little);

inline constexpr std::size_t kTrailerSize = 4;  ///< CRC-32 of all bytes before it.

/// Doubles on the wire, where they need not be aligned.
template <std::size_t kNum>
using WireDoubles = std::array<std::uint32_t, 2 * kNum>;
using WirePose = WireDoubles<7>;  ///< x y z qx qy qz qw

// The flags: one bit tells whether all slots are sent, two bits hold a StreamAxes, one the
// handedness.
inline constexpr std::uint8_t kAllSlotsFlag = 1;
inline constexpr unsigned kAxesShift = 1;
inline constexpr std::uint8_t kAxesMask = 3;
inline constexpr std::uint8_t kLeftHandedFlag = 8;
inline constexpr std::uint8_t kAllFlags = 15;

/// The beginning of a datagram of points, byte for byte; docs/stream.md explains it. The fields
/// follow.
struct PointsHead {
  std::array<char, 4> magic = {'R', 'C', 'S', 'T'};
  std::uint8_t version = 1;
  std::uint8_t flags{};
  std::uint16_t header_size{};
  std::uint32_t run{};
  std::uint16_t sensor{};
  std::uint16_t num_points{};  ///< Points of this datagram.
  std::uint32_t frame{};
  std::uint16_t packet{};
  std::uint16_t num_packets{};
  std::int64_t stamp_ns{};
  std::uint32_t duration_ns{};
  std::uint32_t frame_points{};
  std::uint32_t first_point{};
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::uint16_t returns{};
  std::uint16_t point_size{};
  WirePose pose{};
  WirePose end_pose{};
  std::uint16_t num_fields{};

  static constexpr std::size_t kSize = 170;
  bool operator==(const PointsHead&) const = default;
  /// What all datagrams of a frame share.
  [[nodiscard]] PointsHead OfWhole() const {
    PointsHead whole = *this;
    whole.num_points = whole.packet = 0;
    whole.first_point = 0;
    return whole;
  }
};
static_assert(offsetof(PointsHead, num_fields) + sizeof(std::uint16_t) == PointsHead::kSize);

inline constexpr std::uint8_t kJpeg = 1;

/// The beginning of a datagram of an image, likewise.
struct ImageHead {
  std::array<char, 4> magic = {'R', 'C', 'S', 'I'};
  std::uint8_t version = 1;
  std::uint8_t encoding = kJpeg;
  std::uint16_t header_size = kSize;
  std::uint32_t run{};
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  std::uint16_t packet{};
  std::uint16_t num_packets{};
  std::uint32_t num_bytes{};
  std::uint32_t first_byte{};
  std::uint32_t width_px{};
  std::uint32_t height_px{};
  WirePose pose{};
  WireDoubles<8> lens{};  ///< focal cx cy k1 k2 p1 p2 k3

  static constexpr std::size_t kSize = 164;
  bool operator==(const ImageHead&) const = default;
  /// What all datagrams of an image share.
  [[nodiscard]] ImageHead OfWhole() const {
    ImageHead whole = *this;
    whole.packet = 0;
    whole.first_byte = 0;
    return whole;
  }
};
static_assert(offsetof(ImageHead, lens) + sizeof(WireDoubles<8>) == ImageHead::kSize);

/// @pre There are as many bytes.
template <typename Head>
[[nodiscard]] Head HeadOf(std::span<const char> bytes) {
  Head head;
  std::memcpy(static_cast<void*>(&head), bytes.data(), Head::kSize);
  return head;
}

template <typename Head>
void PutHead(const Head& head, char* to) {
  std::memcpy(to, &head, Head::kSize);
}

}  // namespace railcast
