#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/io/stream/stream_layout.h"

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
