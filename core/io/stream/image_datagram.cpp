#include "core/io/stream/image_datagram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/io/stream/image_layout.h"
#include "core/io/stream/wire_values.h"
#include "railcast/camera.h"
#include "railcast/io/stream.h"

namespace railcast {
namespace {

using namespace image_layout;
using stream_layout::Get;
using stream_layout::kTrailerSize;

bool IsOfThisProtocol(std::span<const char> bytes) {
  return bytes.size() > kImageHeaderSize + kTrailerSize && bytes.size() <= kMaxStreamDatagram &&
         Get<std::array<char, 4>>(bytes.data()) == kImageMagic &&
         Get<std::uint8_t>(&bytes[kImageVersionAt]) == kImageVersion &&
         Get<std::uint8_t>(&bytes[kEncodingAt]) == kJpeg &&
         Get<std::uint16_t>(&bytes[kImageHeaderSizeAt]) == kImageHeaderSize;
}

bool IsImageSize(const ImageSize& size) {
  const std::uint64_t num_pixels = std::uint64_t{size.width_px} * size.height_px;
  return num_pixels > 0 && num_pixels <= kMostPixels;
}

bool IsLens(const std::array<double, kNumLensValues>& lens) {
  return lens[0] > 0.0 &&
         std::ranges::all_of(lens, [](double value) { return std::isfinite(value); });
}

}  // namespace

std::optional<ImageDatagram> CheckImageDatagram(std::span<const char> bytes) {
  if (!IsOfThisProtocol(bytes) || !IsChecksumRight(bytes)) return std::nullopt;
  ImageDatagram datagram;
  datagram.header = bytes.first(kImageHeaderSize);
  datagram.piece = bytes.subspan(kImageHeaderSize, bytes.size() - kImageHeaderSize - kTrailerSize);
  const char* const header = datagram.header.data();
  datagram.run = Get<std::uint32_t>(header + kImageRunAt);
  datagram.frame = Get<std::uint32_t>(header + kImageFrameAt);
  datagram.stamp_ns = Get<std::int64_t>(header + kImageStampAt);
  datagram.packet = Get<std::uint16_t>(header + kImagePacketAt);
  datagram.num_packets = Get<std::uint16_t>(header + kNumImagePacketsAt);
  datagram.size = {Get<std::uint32_t>(header + kWidthAt), Get<std::uint32_t>(header + kHeightAt)};
  const auto bytes_each = CountEach({.total = Get<std::uint32_t>(header + kImageBytesAt),
                                     .first = Get<std::uint32_t>(header + kFirstByteAt),
                                     .here = datagram.piece.size(),
                                     .packet = datagram.packet,
                                     .num_packets = datagram.num_packets});
  if (!bytes_each || !IsImageSize(datagram.size) || !IsPose(Get<WirePose>(header + kImagePoseAt)) ||
      !IsLens(Get<std::array<double, kNumLensValues>>(header + kLensAt))) {
    return std::nullopt;
  }
  datagram.bytes_each = *bytes_each;
  return datagram;
}

bool DescribeOneImage(std::span<const char> header_a, std::span<const char> header_b) {
  const auto same = [&](std::size_t begin, std::size_t end) {
    return std::ranges::equal(header_a.subspan(begin, end - begin),
                              header_b.subspan(begin, end - begin));
  };
  return same(0, kImagePacketAt) && same(kNumImagePacketsAt, kFirstByteAt) &&
         same(kWidthAt, kImageHeaderSize);
}

}  // namespace railcast
