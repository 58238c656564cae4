#include "core/io/stream/stream_datagram.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <zlib.h>

#include "core/io/field_layout.h"
#include "railcast/camera.h"
#include "railcast/io/stream.h"

namespace railcast {
namespace {

using Pose = std::array<double, 7>;

/// What a datagram says of its share of a whole: of a frame's points, or of an image's bytes.
struct ShareOfWhole {
  std::uint64_t total{};  ///< In the whole.
  std::uint64_t first{};  ///< Place of this datagram's first one.
  std::uint64_t here{};   ///< In this datagram.
  std::uint32_t packet{};
  std::uint32_t num_packets{};
};

// Whether the values are finite and the quaternion is a rotation.
bool IsPose(const WirePose& wire) {
  // Allows for quaternions rounded to float32.
  constexpr double kNormTolerance = 1e-6;
  const auto pose = std::bit_cast<Pose>(wire);
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
  return LoadAt<std::uint32_t>(&datagram[checked]) == crc;
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

bool IsImageSize(const ImageHead& head) {
  const std::uint64_t num_pixels = std::uint64_t{head.width_px} * head.height_px;
  return num_pixels > 0 && num_pixels <= kMostPixels;
}

bool IsLens(const WireDoubles<8>& wire) {
  const auto lens = std::bit_cast<std::array<double, 8>>(wire);
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
  const auto type = static_cast<StreamType>(list[0]);
  const std::size_t length = static_cast<std::uint8_t>(list[1]);
  if (SizeOf(type) == 0 || list.size() < kBeforeName + length) return std::nullopt;
  const std::string_view name(list.data() + kBeforeName, length);
  list = list.subspan(kBeforeName + length);
  if (!IsName(name)) return std::nullopt;
  return WireField{type, name};
}

bool AreFieldsRight(const PointsHead& head, std::span<const char> list) {
  if (head.num_fields == 0 || head.num_fields > kMaxStreamFields) return false;
  std::array<std::string_view, kMaxStreamFields> names;
  std::size_t point_size = 0;
  for (std::size_t i = 0; i < head.num_fields; ++i) {
    const auto field = TakeField(list);
    const auto before = std::span(names).first(i);
    if (!field || std::ranges::find(before, field->name) != before.end()) return false;
    names[i] = field->name;
    point_size += SizeOf(field->type);
  }
  return list.empty() && point_size == head.point_size;
}

// Whether the frame has no more points than slots. Each product fits into 64 bits.
bool FitsIntoSlots(const PointsHead& head) {
  const std::uint64_t cells = std::uint64_t{head.rows} * head.columns;
  if (cells == 0 || head.returns == 0) return false;
  const bool has_all = (head.flags & kAllSlotsFlag) != 0;
  if (cells > 0xFFFFFFFF) return !has_all;
  return has_all ? cells * head.returns == head.frame_points
                 : cells * head.returns >= head.frame_points;
}

Transform PoseOf(const WirePose& wire) {
  const auto pose = std::bit_cast<Pose>(wire);
  const Eigen::Quaterniond rotation(pose[6], pose[3], pose[4], pose[5]);
  return MakeTransform(rotation.normalized().toRotationMatrix(), {pose[0], pose[1], pose[2]});
}

// Checks a datagram whose checksum is right, so that its bytes are those that were sent.
std::optional<StreamFault> FaultOfWhole(std::span<const char> bytes) {
  if (bytes.size() < PointsHead::kSize + kTrailerSize || bytes.size() > kMaxStreamDatagram) {
    return StreamFault::kSize;
  }
  const auto head = HeadOf<PointsHead>(bytes);
  if (head.magic != PointsHead().magic) return StreamFault::kMagic;
  if (head.version != PointsHead().version) return StreamFault::kVersion;
  if (!IsChecksumRight(bytes)) return StreamFault::kChecksum;
  const bool has_axes =
      (head.flags >> kAxesShift & kAxesMask) <= static_cast<int>(StreamAxes::kWorld);
  if (head.flags > kAllFlags || !has_axes) return StreamFault::kVersion;
  const std::size_t points_size = std::size_t{head.num_points} * head.point_size;
  if (head.header_size < PointsHead::kSize ||
      head.header_size + points_size + kTrailerSize != bytes.size()) {
    return StreamFault::kSize;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageDatagram> CheckImageDatagram(std::span<const char> bytes) {
  if (bytes.size() <= ImageHead::kSize + kTrailerSize || bytes.size() > kMaxStreamDatagram) {
    return std::nullopt;
  }
  const auto head = HeadOf<ImageHead>(bytes);
  const ImageHead ours;
  if (head.magic != ours.magic || head.version != ours.version || head.encoding != ours.encoding ||
      head.header_size != ours.header_size || !IsChecksumRight(bytes)) {
    return std::nullopt;
  }
  const auto piece =
      bytes.subspan(ImageHead::kSize, bytes.size() - ImageHead::kSize - kTrailerSize);
  const auto bytes_each = CountEach({.total = head.num_bytes,
                                     .first = head.first_byte,
                                     .here = piece.size(),
                                     .packet = head.packet,
                                     .num_packets = head.num_packets});
  if (!bytes_each || !IsImageSize(head) || !IsPose(head.pose) || !IsLens(head.lens)) {
    return std::nullopt;
  }
  return ImageDatagram{head, *bytes_each, piece};
}

std::optional<StreamDatagram> CheckStreamDatagram(std::span<const char> bytes, StreamFault& fault) {
  const auto refuse = [&](StreamFault why) {
    fault = why;
    return std::nullopt;
  };
  if (const auto why = FaultOfWhole(bytes)) return refuse(*why);
  const auto head = HeadOf<PointsHead>(bytes);
  const auto header = bytes.first(head.header_size);
  if (!AreFieldsRight(head, header.subspan(PointsHead::kSize))) {
    return refuse(StreamFault::kFields);
  }
  const auto points_each = CountEach({.total = head.frame_points,
                                      .first = head.first_point,
                                      .here = head.num_points,
                                      .packet = head.packet,
                                      .num_packets = head.num_packets});
  if (!points_each || !FitsIntoSlots(head)) return refuse(StreamFault::kCounts);
  if (!IsPose(head.pose) || !IsPose(head.end_pose)) return refuse(StreamFault::kPose);
  return StreamDatagram{head, static_cast<std::uint16_t>(*points_each), header,
                        bytes.subspan(header.size(), bytes.size() - header.size() - kTrailerSize)};
}

bool DescribeOneFrame(std::span<const char> header_a, std::span<const char> header_b) {
  return HeadOf<PointsHead>(header_a).OfWhole() == HeadOf<PointsHead>(header_b).OfWhole() &&
         std::ranges::equal(header_a.subspan(PointsHead::kSize),
                            header_b.subspan(PointsHead::kSize));
}

StreamHeader ReadStreamHeader(std::span<const char> header) {
  const auto head = HeadOf<PointsHead>(header);
  StreamHeader read{.has_all_slots = (head.flags & kAllSlotsFlag) != 0,
                    .axes = static_cast<StreamAxes>(head.flags >> kAxesShift & kAxesMask),
                    .is_left_handed = (head.flags & kLeftHandedFlag) != 0,
                    .run = head.run,
                    .sensor = head.sensor,
                    .frame = head.frame,
                    .stamp_ns = head.stamp_ns,
                    .duration_ns = head.duration_ns,
                    .num_points = head.frame_points,
                    .rows = head.rows,
                    .columns = head.columns,
                    .returns = head.returns,
                    .point_size = head.point_size,
                    .world_from_sensor = PoseOf(head.pose),
                    .world_from_sensor_end = PoseOf(head.end_pose),
                    .fields = {}};
  std::uint16_t offset = 0;
  std::span<const char> list = header.subspan(PointsHead::kSize);
  while (const auto field = TakeField(list)) {
    read.fields.push_back({std::string(field->name), field->type, offset});
    offset = static_cast<std::uint16_t>(offset + SizeOf(field->type));
  }
  return read;
}

}  // namespace railcast
