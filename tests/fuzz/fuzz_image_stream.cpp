#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/io/image/jpeg.h"
#include "core/io/stream/image_receiver.h"
#include "railcast/camera.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/input_datagrams.h"

namespace railcast {
namespace {

void CheckReceived(const ReceivedImage& image) {
  const std::uint64_t num_pixels = std::uint64_t{image.size.width_px} * image.size.height_px;
  Check(num_pixels > 0 && num_pixels <= kMostPixels, "an image has pixels, but not too many");
  Check(!image.jpeg.empty(), "an image has bytes");
  try {
    const auto decoded = DecodeJpegRgb(image.jpeg, image.size);
    Check(decoded.values.size() == 3 * num_pixels, "an image is whole");
  } catch (const InputError& error) {
    const std::string_view fault = error.what();
    Check(fault.starts_with("is no ") || fault.starts_with("must "), "a fault is a rule");
    Check(fault.find('\n') == std::string_view::npos, "a fault is one line");
  }
}

void AssembleImages(std::span<const char> bytes) {
  ImageAssembler assembler;
  std::vector<ReceivedImage> images;
  const std::uint64_t num_datagrams = ForEachDatagram(
      bytes, [&](const std::string& datagram) { assembler.Take(datagram, images); });
  std::size_t num_kept = 0;
  for (const ReceivedImage& image : images) {
    CheckReceived(image);
    num_kept += image.jpeg.size();
  }
  const ImageCounts& counts = assembler.counts();
  Check(num_kept <= bytes.size(), "memory is for what arrived");
  Check(counts.received_packets + counts.stray_packets + counts.other_sender_packets +
                counts.refused_packets ==
            num_datagrams,
        "every datagram is counted once");
  Check(counts.complete_images == images.size(), "images are counted");
}

}  // namespace
}  // namespace railcast

/// datagrams as ForEachDatagram() separates them.
RAILCAST_FUZZ_TARGET(image_stream) {
  railcast::AssembleImages(std::span(reinterpret_cast<const char*>(data), size));
  return 0;
}
