#include "core/io/stream/image_encoder.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/io/image/jpeg.h"
#include "core/io/stream/image_layout.h"
#include "railcast/io/stream.h"

namespace railcast {
namespace {

using namespace image_layout;
using stream_layout::kTrailerSize;
using stream_layout::Put;

constexpr int kJpegQuality = 90;

std::array<char, kImageHeaderSize> ImageHeader(const CameraImage& image,
                                               const CameraSpec& spec,
                                               const ImageSending& sending) {
  std::array<char, kImageHeaderSize> header{};
  const auto put = [&](std::size_t at, auto value) { Put(header.data() + at, value); };
  put(0, kImageMagic);
  put(kImageVersionAt, kImageVersion);
  put(kEncodingAt, kJpeg);
  put(kImageHeaderSizeAt, static_cast<std::uint16_t>(kImageHeaderSize));
  put(kImageRunAt, sending.run);
  put(kImageFrameAt, sending.frame);
  put(kImageStampAt, image.stamp_ns);
  put(kWidthAt, image.width_px);
  put(kHeightAt, image.height_px);
  const Eigen::Quaterniond q(image.world_from_camera.linear());
  const Vector3 position_m = image.world_from_camera.translation();
  put(kImagePoseAt,
      std::array{position_m.x(), position_m.y(), position_m.z(), q.x(), q.y(), q.z(), q.w()});
  const Intrinsics k = IntrinsicsOf(spec);
  const DistortionSpec d = spec.distortion.value_or(DistortionSpec{});
  put(kLensAt, std::array<double, kNumLensValues>{k.focal_px, k.cx_px, k.cy_px, d.k1, d.k2, d.p1,
                                                  d.p2, d.k3});
  return header;
}

}  // namespace

void EncodeImageDatagrams(const CameraImage& image,
                          const CameraSpec& spec,
                          const ImageSending& sending,
                          Datagrams& datagrams) {
  const std::string jpeg = EncodeJpeg({image.width_px, image.height_px}, image.rgb, kJpegQuality);
  constexpr std::size_t kBytesEach = kMaxStreamDatagram - kImageHeaderSize - kTrailerSize;
  const std::size_t num_packets = (jpeg.size() + kBytesEach - 1) / kBytesEach;
  Check(num_packets <= std::numeric_limits<std::uint16_t>::max(),
        "images have at most 2^24 pixels");
  std::array<char, kImageHeaderSize> header = ImageHeader(image, spec, sending);
  Put(header.data() + kNumImagePacketsAt, static_cast<std::uint16_t>(num_packets));
  Put(header.data() + kImageBytesAt, static_cast<std::uint32_t>(jpeg.size()));
  for (std::size_t packet = 0; packet < num_packets; ++packet) {
    const std::size_t first = packet * kBytesEach;
    const std::size_t count = std::min(kBytesEach, jpeg.size() - first);
    Put(header.data() + kImagePacketAt, static_cast<std::uint16_t>(packet));
    Put(header.data() + kFirstByteAt, static_cast<std::uint32_t>(first));
    const std::size_t offset = datagrams.bytes.size();
    const std::size_t checked = header.size() + count;
    datagrams.bytes.resize(offset + checked + kTrailerSize);
    char* const datagram = datagrams.bytes.data() + offset;
    std::copy(header.begin(), header.end(), datagram);
    std::copy_n(jpeg.data() + first, count, datagram + header.size());
    const auto crc = ::crc32_z(0, reinterpret_cast<const unsigned char*>(datagram), checked);
    Put(datagram + checked, static_cast<std::uint32_t>(crc));
    const std::int64_t since_stamp_ns = sending.spread_ns / static_cast<std::int64_t>(num_packets) *
                                        static_cast<std::int64_t>(packet);
    datagrams.items.push_back({offset, static_cast<std::uint16_t>(checked + kTrailerSize),
                               DatagramPort::kData, image.stamp_ns + since_stamp_ns});
  }
}

}  // namespace railcast
