#include "core/io/stream/stream_encoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <string>

#include <tbb/parallel_for.h>
#include <zlib.h>

#include "core/base/error.h"
#include "core/io/field_layout.h"
#include "core/io/image/jpeg.h"
#include "railcast/io/stream.h"

namespace railcast {
namespace {

WirePose WirePoseOf(const Transform& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Vector3 position_m = pose.translation();
  return std::bit_cast<WirePose>(std::array<double, 7>{position_m.x(), position_m.y(),
                                                       position_m.z(), q.x(), q.y(), q.z(), q.w()});
}

/// Writes the checksum behind the bytes of a datagram.
void PutTrailer(char* datagram, std::size_t checked) {
  const auto crc = ::crc32_z(0, reinterpret_cast<const unsigned char*>(datagram), checked);
  StoreAt<std::uint32_t>(datagram + checked, crc);
}

constexpr int kJpegQuality = 90;

ImageHead HeadOf(const CameraImage& image, const CameraSpec& spec, const ImageSending& sending) {
  ImageHead head;
  head.run = sending.run;
  head.frame = sending.frame;
  head.stamp_ns = image.stamp_ns + sending.clock_ahead_ns;
  head.width_px = image.width_px;
  head.height_px = image.height_px;
  head.pose = WirePoseOf(image.world_from_camera);
  const Intrinsics k = IntrinsicsOf(spec);
  const DistortionSpec d = spec.distortion.value_or(DistortionSpec{});
  head.lens = std::bit_cast<WireDoubles<8>>(
      std::array<double, 8>{k.focal_px, k.cx_px, k.cy_px, d.k1, d.k2, d.p1, d.p2, d.k3});
  return head;
}

std::uint8_t FlagsOf(const StreamSpec& spec) {
  const auto axes = spec.output.frame == OutputFrame::kWorld     ? StreamAxes::kWorld
                    : spec.output.frame == OutputFrame::kVehicle ? StreamAxes::kVehicle
                                                                 : StreamAxes::kSensor;
  unsigned flags = static_cast<unsigned>(axes) << kAxesShift;
  if (spec.has_all_slots) flags |= kAllSlotsFlag;
  if (spec.output.handedness == Handedness::kLeft) flags |= kLeftHandedFlag;
  return static_cast<std::uint8_t>(flags);
}

template <std::size_t size>
void GatherValues(const char* values,
                  std::span<const std::uint32_t> slots,
                  std::size_t step,
                  char* to) {
  for (const std::uint32_t slot : slots) {
    std::memcpy(to, values + std::size_t{slot} * size, size);
    to += step;
  }
}

}  // namespace

void EncodeImageDatagrams(const CameraImage& image,
                          const CameraSpec& spec,
                          const ImageSending& sending,
                          Datagrams& datagrams) {
  const std::string jpeg = EncodeJpeg({image.width_px, image.height_px}, image.rgb, kJpegQuality);
  constexpr std::size_t kBytesEach = kMaxStreamDatagram - ImageHead::kSize - kTrailerSize;
  const std::size_t num_packets = (jpeg.size() + kBytesEach - 1) / kBytesEach;
  Check(num_packets <= std::numeric_limits<std::uint16_t>::max(),
        "images have at most 2^24 pixels");
  ImageHead head = HeadOf(image, spec, sending);
  head.num_packets = static_cast<std::uint16_t>(num_packets);
  head.num_bytes = static_cast<std::uint32_t>(jpeg.size());
  for (std::size_t packet = 0; packet < num_packets; ++packet) {
    const std::size_t first = packet * kBytesEach;
    const std::size_t count = std::min(kBytesEach, jpeg.size() - first);
    head.packet = static_cast<std::uint16_t>(packet);
    head.first_byte = static_cast<std::uint32_t>(first);
    const std::size_t offset = datagrams.bytes.size();
    const std::size_t checked = ImageHead::kSize + count;
    datagrams.bytes.resize(offset + checked + kTrailerSize);
    char* const datagram = datagrams.bytes.data() + offset;
    PutHead(head, datagram);
    std::copy_n(jpeg.data() + first, count, datagram + ImageHead::kSize);
    PutTrailer(datagram, checked);
    const std::int64_t since_stamp_ns = sending.spread_ns / static_cast<std::int64_t>(num_packets) *
                                        static_cast<std::int64_t>(packet);
    datagrams.items.push_back({offset, static_cast<std::uint16_t>(checked + kTrailerSize),
                               DatagramPort::kData, image.stamp_ns + since_stamp_ns});
  }
}

StreamEncoder::StreamEncoder(const ScanPattern& pattern, const StreamSpec& spec)
    : StreamEncoder(spec) {
  shape_ = Shape{pattern.rows, pattern.columns};
  cells_.reserve(pattern.num_firings());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    cells_.push_back(std::uint32_t{pattern.row[i]} * pattern.columns + pattern.column[i]);
  }
}

StreamEncoder::StreamEncoder(const StreamSpec& spec) : spec_(spec) {
  ForEachPossibleField([&](std::string_view name, std::string_view, const auto& values) {
    if (!spec_.fields.Has(name)) return;
    using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
    static_assert(sizeof(Stored) == sizeof(ElementOf<decltype(values)>));
    list_ += {static_cast<char>(kStreamTypeOf<Stored>), static_cast<char>(name.size())};
    list_ += name;
    point_size_ += sizeof(Stored);
  });
  head_.flags = FlagsOf(spec);
  head_.header_size = static_cast<std::uint16_t>(PointsHead::kSize + list_.size());
  head_.run = spec.run;
  head_.sensor = spec.sensor;
  head_.point_size = static_cast<std::uint16_t>(point_size_);
  head_.num_fields = static_cast<std::uint16_t>(spec.fields.names().size());
}

void StreamEncoder::OrderCells(const Frame& frame) {
  cells_.resize(std::size_t{frame.rows} * frame.columns);
  std::iota(cells_.begin(), cells_.end(), 0U);
  std::ranges::stable_sort(cells_, {}, [&](std::uint32_t cell) {
    return frame.time_ns[std::size_t{cell} * frame.returns];
  });
}

void StreamEncoder::FindSources(const Frame& frame) {
  sources_.clear();
  std::size_t offset = 0;
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto& values) {
    if (!spec_.fields.Has(name)) return;
    const std::size_t size = sizeof(ElementOf<decltype(values)>);
    sources_.push_back({reinterpret_cast<const char*>(values.data()), size, offset});
    offset += size;
  });
  Check(sources_.size() == spec_.fields.names().size(), "frames have the fields that are sent");
}

void StreamEncoder::ChooseSlots(const Frame& frame) {
  slots_.resize(frame.num_slots());
  std::size_t count = 0;
  for (const std::uint32_t cell : cells_) {
    for (std::uint32_t r = 0; r < frame.returns; ++r) {
      const std::uint32_t slot = cell * frame.returns + r;
      slots_[count] = slot;
      count += spec_.has_all_slots || HasPoint(frame.outcome[slot]) ? 1 : 0;
    }
  }
  slots_.resize(count);
}

void StreamEncoder::BeginFrame(const Frame& frame) {
  head_.frame = frame.index;
  head_.stamp_ns = frame.stamp_ns + clock_ahead_ns();
  head_.duration_ns = frame.duration_ns;
  head_.frame_points = static_cast<std::uint32_t>(slots_.size());
  head_.rows = frame.rows;
  head_.columns = frame.columns;
  head_.returns = static_cast<std::uint16_t>(frame.returns);
  head_.pose = WirePoseOf(frame.world_from_sensor);
  head_.end_pose = WirePoseOf(frame.world_from_sensor_end);
}

void StreamEncoder::WriteDatagram(std::size_t packet,
                                  std::size_t points_each,
                                  char* datagram) const {
  const std::size_t first = packet * points_each;
  const std::size_t count = std::min(points_each, slots_.size() - first);
  PointsHead head = head_;
  head.packet = static_cast<std::uint16_t>(packet);
  head.num_points = static_cast<std::uint16_t>(count);
  head.first_point = static_cast<std::uint32_t>(first);
  PutHead(head, datagram);
  list_.copy(datagram + PointsHead::kSize, list_.size());
  const std::span slots = std::span(slots_).subspan(first, count);
  char* const points = datagram + head.header_size;
  for (const FieldSource& source : sources_) {
    char* const to = points + source.offset;
    if (source.size == 4) {
      GatherValues<4>(source.values, slots, point_size_, to);
    } else if (source.size == 2) {
      GatherValues<2>(source.values, slots, point_size_, to);
    } else {
      GatherValues<1>(source.values, slots, point_size_, to);
    }
  }
  const std::size_t checked = head.header_size + count * point_size_;
  PutTrailer(datagram, checked);
}

void StreamEncoder::Encode(const Frame& frame, Datagrams& datagrams) {
  if (!shape_) OrderCells(frame);
  Check(!shape_ || (frame.rows == shape_->rows && frame.columns == shape_->columns),
        "frames are of the encoder's pattern");
  const std::size_t overhead = head_.header_size + kTrailerSize;
  const std::size_t points_each = (kMaxStreamDatagram - overhead) / point_size_;
  constexpr std::size_t kMaxPackets = std::numeric_limits<std::uint16_t>::max();
  if (frame.num_slots() > kMaxPackets * points_each) {
    throw InputError("stream: a frame must fit into 65535 datagrams (got " +
                     std::to_string(frame.num_slots()) + " slots of " +
                     std::to_string(point_size_) + " bytes); send fewer fields");
  }
  FindSources(frame);
  ChooseSlots(frame);
  BeginFrame(frame);
  const std::size_t num_points = slots_.size();
  const std::size_t num_packets =
      std::max<std::size_t>(1, (num_points + points_each - 1) / points_each);
  head_.num_packets = static_cast<std::uint16_t>(num_packets);
  const std::size_t begin = datagrams.bytes.size();
  std::size_t offset = begin;
  datagrams.bytes.resize(offset + num_packets * overhead + num_points * point_size_);
  for (std::size_t packet = 0; packet < num_packets; ++packet) {
    const std::size_t first = packet * points_each;
    const std::size_t count = std::min(points_each, num_points - first);
    const std::uint32_t last_ns =
        count == 0 ? frame.duration_ns : frame.time_ns[slots_[first + count - 1]];
    const std::size_t size = overhead + count * point_size_;
    datagrams.items.push_back({offset, static_cast<std::uint16_t>(size), DatagramPort::kData,
                               frame.stamp_ns + std::int64_t{last_ns}});
    offset += size;
  }
  // In pieces, since a frame of a small scan is written within a millisecond.
  constexpr std::size_t kPacketsEach = 64;
  const std::size_t size_each = overhead + points_each * point_size_;
  char* const bytes = datagrams.bytes.data() + begin;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, num_packets, kPacketsEach),
                    [&](const tbb::blocked_range<std::size_t>& some) {
                      for (std::size_t packet = some.begin(); packet < some.end(); ++packet) {
                        WriteDatagram(packet, points_each, bytes + packet * size_each);
                      }
                    });
}

}  // namespace railcast
