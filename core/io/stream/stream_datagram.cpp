#include "core/io/stream/stream_datagram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <zlib.h>

#include "core/io/stream/stream_layout.h"
#include "railcast/camera.h"
#include "railcast/io/stream.h"

namespace railcast {
namespace {

using namespace image_layout;
using namespace stream_layout;

/// A pose as datagrams carry it: x y z qx qy qz qw.
using WirePose = std::array<double, kNumPoseValues>;

/// What a datagram says of its share of a whole: of a frame's points, or of an image's bytes.
struct ShareOfWhole {
  std::uint64_t total{};  ///< In the whole.
  std::uint64_t first{};  ///< Place of this datagram's first one.
  std::uint64_t here{};   ///< In this datagram.
  std::uint32_t packet{};
  std::uint32_t num_packets{};
};

// Whether the values are finite and the quaternion is a rotation.
bool IsPose(const WirePose& pose) {
  // Allows for quaternions rounded to float32.
  constexpr double kNormTolerance = 1e-6;
  const double norm2 =
      pose[3] * pose[3] + pose[4] * pose[4] + pose[5] * pose[5] + pose[6] * pose[6];
  return std::ranges::all_of(pose, [](double value) { return std::isfinite(value); }) &&
         std::abs(norm2 - 1.0) < kNormTolerance;
}

// Whether the last four bytes of a datagram are the CRC of those before them.
// @pre The datagram has at least four bytes.
bool IsChecksumRight(std::span<const char> datagram) {
  const std::size_t checked = datagram.size() - kTrailerSize;
  const auto crc = ::crc32_z(0, reinterpret_cast<const unsigned char*>(datagram.data()), checked);
  return Get<std::uint32_t>(&datagram[checked]) == crc;
}

// Returns how many each datagram of the whole but the last holds, at most kMaxStreamDatagram, or
// nothing if the counts contradict each other.
std::optional<std::uint32_t> CountEach(const ShareOfWhole& share) {
  if (share.packet >= share.num_packets) return std::nullopt;
  const std::uint64_t num_full = share.num_packets - 1U;
  std::uint64_t each = share.here;
  if (share.packet == num_full) {
    if (share.first + share.here != share.total) return std::nullopt;
    if (num_full > 0) each = share.first / num_full;
  }
  const bool is_placed = share.first == each * share.packet;
  const bool is_counted =
      num_full == 0 || (each * num_full < share.total && share.total <= each * (num_full + 1));
  // `each` exceeds what a datagram holds where a last datagram misstates `first`.
  if (!is_placed || !is_counted || each > kMaxStreamDatagram) return std::nullopt;
  return static_cast<std::uint32_t>(each);
}

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

bool IsName(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

struct WireField {
  StreamType type{};
  std::string_view name;
};

// Takes the next field off `list`; returns nothing if there is no whole and valid one.
std::optional<WireField> TakeField(std::span<const char>& list) {
  constexpr std::size_t kBeforeName = 2;
  if (list.size() < kBeforeName) return std::nullopt;
  const auto type = static_cast<StreamType>(Get<std::uint8_t>(list.data()));
  const std::size_t length = Get<std::uint8_t>(&list[1]);
  if (SizeOf(type) == 0 || list.size() < kBeforeName + length) return std::nullopt;
  const std::string_view name(list.data() + kBeforeName, length);
  list = list.subspan(kBeforeName + length);
  if (!IsName(name)) return std::nullopt;
  return WireField{type, name};
}

bool AreFieldsRight(std::span<const char> header) {
  const std::size_t num_fields = Get<std::uint16_t>(&header[kNumFieldsAt]);
  if (num_fields == 0 || num_fields > kMaxStreamFields) return false;
  std::array<std::string_view, kMaxStreamFields> names;
  std::span<const char> list = header.subspan(kFieldsAt);
  std::size_t point_size = 0;
  for (std::size_t i = 0; i < num_fields; ++i) {
    const auto field = TakeField(list);
    const auto before = std::span(names).first(i);
    if (!field || std::ranges::find(before, field->name) != before.end()) return false;
    names[i] = field->name;
    point_size += SizeOf(field->type);
  }
  return list.empty() && point_size == Get<std::uint16_t>(&header[kPointSizeAt]);
}

// Whether the frame has no more points than slots. Each product fits into 64 bits.
bool FitsIntoSlots(const char* header) {
  const std::uint64_t cells =
      std::uint64_t{Get<std::uint32_t>(header + kRowsAt)} * Get<std::uint32_t>(header + kColumnsAt);
  const std::uint64_t returns = Get<std::uint16_t>(header + kReturnsAt);
  const std::uint64_t total = Get<std::uint32_t>(header + kFramePointsAt);
  if (cells == 0 || returns == 0) return false;
  const bool has_all = (Get<std::uint8_t>(header + kFlagsAt) & kAllSlotsFlag) != 0;
  if (cells > 0xFFFFFFFF) return !has_all;
  return has_all ? cells * returns == total : cells * returns >= total;
}

Transform MakePose(const WirePose& pose) {
  const Eigen::Quaterniond rotation(pose[6], pose[3], pose[4], pose[5]);
  return MakeTransform(rotation.normalized().toRotationMatrix(), {pose[0], pose[1], pose[2]});
}

// Checks a datagram whose checksum is right, so that its bytes are those that were sent.
std::optional<StreamFault> FaultOfWhole(std::span<const char> bytes) {
  if (bytes.size() < kFieldsAt + kTrailerSize || bytes.size() > kMaxStreamDatagram) {
    return StreamFault::kSize;
  }
  if (Get<std::array<char, 4>>(bytes.data()) != kMagic) return StreamFault::kMagic;
  if (Get<std::uint8_t>(&bytes[kVersionAt]) != kVersion) return StreamFault::kVersion;
  if (!IsChecksumRight(bytes)) return StreamFault::kChecksum;
  const auto flags = Get<std::uint8_t>(&bytes[kFlagsAt]);
  const bool has_axes = (flags >> kAxesShift & kAxesMask) <= static_cast<int>(StreamAxes::kWorld);
  if (flags > kAllFlags || !has_axes) return StreamFault::kVersion;
  const std::size_t header_size = Get<std::uint16_t>(&bytes[kHeaderSizeAt]);
  const std::size_t points_size = std::size_t{Get<std::uint16_t>(&bytes[kDatagramPointsAt])} *
                                  Get<std::uint16_t>(&bytes[kPointSizeAt]);
  if (header_size < kFieldsAt || header_size + points_size + kTrailerSize != bytes.size()) {
    return StreamFault::kSize;
  }
  return std::nullopt;
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

std::optional<StreamDatagram> CheckStreamDatagram(std::span<const char> bytes, StreamFault& fault) {
  const auto refuse = [&](StreamFault why) {
    fault = why;
    return std::nullopt;
  };
  if (const auto why = FaultOfWhole(bytes)) return refuse(*why);
  StreamDatagram datagram;
  datagram.header = bytes.first(Get<std::uint16_t>(&bytes[kHeaderSizeAt]));
  datagram.points =
      bytes.subspan(datagram.header.size(), bytes.size() - datagram.header.size() - kTrailerSize);
  const char* const header = datagram.header.data();
  datagram.run = Get<std::uint32_t>(header + kRunAt);
  datagram.sensor = Get<std::uint16_t>(header + kSensorAt);
  datagram.frame = Get<std::uint32_t>(header + kFrameAt);
  datagram.packet = Get<std::uint16_t>(header + kPacketAt);
  datagram.num_packets = Get<std::uint16_t>(header + kNumPacketsAt);
  datagram.num_points = Get<std::uint16_t>(header + kDatagramPointsAt);
  if (!AreFieldsRight(datagram.header)) return refuse(StreamFault::kFields);
  const auto points_each = CountEach({.total = Get<std::uint32_t>(header + kFramePointsAt),
                                      .first = Get<std::uint32_t>(header + kFirstPointAt),
                                      .here = datagram.num_points,
                                      .packet = datagram.packet,
                                      .num_packets = datagram.num_packets});
  if (!points_each || !FitsIntoSlots(header)) return refuse(StreamFault::kCounts);
  datagram.points_each = static_cast<std::uint16_t>(*points_each);
  for (const std::size_t at : {kPoseAt, kEndPoseAt}) {
    if (!IsPose(Get<WirePose>(header + at))) return refuse(StreamFault::kPose);
  }
  return datagram;
}

bool DescribeOneFrame(std::span<const char> header_a, std::span<const char> header_b) {
  if (header_a.size() != header_b.size()) return false;
  const auto same = [&](std::size_t begin, std::size_t end) {
    return std::equal(header_a.begin() + static_cast<std::ptrdiff_t>(begin),
                      header_a.begin() + static_cast<std::ptrdiff_t>(end),
                      header_b.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  return same(0, kDatagramPointsAt) && same(kFrameAt, kPacketAt) &&
         same(kNumPacketsAt, kFirstPointAt) && same(kRowsAt, header_a.size());
}

StreamHeader ReadStreamHeader(std::span<const char> header) {
  StreamHeader read;
  const char* const from = header.data();
  const auto flags = Get<std::uint8_t>(from + kFlagsAt);
  read.has_all_slots = (flags & kAllSlotsFlag) != 0;
  read.axes = static_cast<StreamAxes>(flags >> kAxesShift & kAxesMask);
  read.is_left_handed = (flags & kLeftHandedFlag) != 0;
  read.run = Get<std::uint32_t>(from + kRunAt);
  read.sensor = Get<std::uint16_t>(from + kSensorAt);
  read.frame = Get<std::uint32_t>(from + kFrameAt);
  read.stamp_ns = Get<std::int64_t>(from + kStampAt);
  read.duration_ns = Get<std::uint32_t>(from + kDurationAt);
  read.num_points = Get<std::uint32_t>(from + kFramePointsAt);
  read.rows = Get<std::uint32_t>(from + kRowsAt);
  read.columns = Get<std::uint32_t>(from + kColumnsAt);
  read.returns = Get<std::uint16_t>(from + kReturnsAt);
  read.point_size = Get<std::uint16_t>(from + kPointSizeAt);
  read.world_from_sensor = MakePose(Get<WirePose>(from + kPoseAt));
  read.world_from_sensor_end = MakePose(Get<WirePose>(from + kEndPoseAt));
  std::uint16_t offset = 0;
  std::span<const char> list = header.subspan(kFieldsAt);
  while (const auto field = TakeField(list)) {
    read.fields.push_back({std::string(field->name), field->type, offset});
    offset = static_cast<std::uint16_t>(offset + SizeOf(field->type));
  }
  return read;
}

}  // namespace railcast
