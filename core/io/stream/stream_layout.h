#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace railcast::stream_layout {

// Values are copied to and from the wire without swapping bytes.
static_assert(std::endian::native == std::endian::little);

inline constexpr std::array<char, 4> kMagic = {'R', 'C', 'S', 'T'};
inline constexpr std::uint8_t kVersion = 1;

// The flags: one bit tells whether all slots are sent, two bits hold a StreamAxes, one the
// handedness.
inline constexpr std::uint8_t kAllSlotsFlag = 1;
inline constexpr unsigned kAxesShift = 1;
inline constexpr std::uint8_t kAxesMask = 3;
inline constexpr std::uint8_t kLeftHandedFlag = 8;
inline constexpr std::uint8_t kAllFlags = 15;

/// Offsets of the parts of a datagram's header; docs/stream.md explains them.
inline constexpr std::size_t kMagicAt = 0;
inline constexpr std::size_t kVersionAt = 4;
inline constexpr std::size_t kFlagsAt = 5;
inline constexpr std::size_t kHeaderSizeAt = 6;
inline constexpr std::size_t kRunAt = 8;
inline constexpr std::size_t kSensorAt = 12;
inline constexpr std::size_t kDatagramPointsAt = 14;
inline constexpr std::size_t kFrameAt = 16;
inline constexpr std::size_t kPacketAt = 20;
inline constexpr std::size_t kNumPacketsAt = 22;
inline constexpr std::size_t kStampAt = 24;
inline constexpr std::size_t kDurationAt = 32;
inline constexpr std::size_t kFramePointsAt = 36;
inline constexpr std::size_t kFirstPointAt = 40;
inline constexpr std::size_t kRowsAt = 44;
inline constexpr std::size_t kColumnsAt = 48;
inline constexpr std::size_t kReturnsAt = 52;
inline constexpr std::size_t kPointSizeAt = 54;
inline constexpr std::size_t kPoseAt = 56;
inline constexpr std::size_t kEndPoseAt = 112;
inline constexpr std::size_t kNumFieldsAt = 168;
inline constexpr std::size_t kFieldsAt = 170;

inline constexpr std::size_t kNumPoseValues = 7;  ///< x y z qx qy qz qw, f64 each.
inline constexpr std::size_t kTrailerSize = 4;    ///< CRC-32 of all bytes before it.

template <typename T>
void Put(char* place, T value) {
  std::memcpy(place, &value, sizeof value);
}

template <typename T>
[[nodiscard]] T Get(const char* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

}  // namespace railcast::stream_layout

namespace railcast::image_layout {

inline constexpr std::array<char, 4> kImageMagic = {'R', 'C', 'S', 'I'};
inline constexpr std::uint8_t kImageVersion = 1;
inline constexpr std::uint8_t kJpeg = 1;

/// Offsets of the parts of an image datagram's header; docs/stream.md explains them.
inline constexpr std::size_t kImageVersionAt = 4;
inline constexpr std::size_t kEncodingAt = 5;
inline constexpr std::size_t kImageHeaderSizeAt = 6;
inline constexpr std::size_t kImageRunAt = 8;
inline constexpr std::size_t kImageFrameAt = 12;
inline constexpr std::size_t kImageStampAt = 16;
inline constexpr std::size_t kImagePacketAt = 24;
inline constexpr std::size_t kNumImagePacketsAt = 26;
inline constexpr std::size_t kImageBytesAt = 28;
inline constexpr std::size_t kFirstByteAt = 32;
inline constexpr std::size_t kWidthAt = 36;
inline constexpr std::size_t kHeightAt = 40;
inline constexpr std::size_t kImagePoseAt = 44;
inline constexpr std::size_t kLensAt = 100;
inline constexpr std::size_t kNumLensValues = 8;  ///< focal cx cy k1 k2 p1 p2 k3, f64 each.
inline constexpr std::size_t kImageHeaderSize = kLensAt + kNumLensValues * sizeof(double);

}  // namespace railcast::image_layout
