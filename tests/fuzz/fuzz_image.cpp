#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/image/jpeg.h"
#include "core/io/image/npy_decoder.h"
#include "core/io/image/png.h"
#include "core/io/run/camera_files.h"
#include "railcast/camera.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

template <typename Value>
void CheckImage(const DecodedImage<Value>& image, std::size_t num_channels) {
  const std::uint64_t num_pixels = std::uint64_t{image.size.width_px} * image.size.height_px;
  Check(num_pixels > 0 && num_pixels <= kMostPixels, "an image has pixels, but not too many");
  Check(image.values.size() == num_pixels * num_channels, "an image is whole");
}

// The size that is expected comes first, a byte each.
void DecodeJpeg(std::string_view bytes) {
  if (bytes.size() < 2) return;
  const ImageSize size{static_cast<std::uint8_t>(bytes[0]), static_cast<std::uint8_t>(bytes[1])};
  CheckImage(DecodeJpegRgb(bytes.substr(2), size), 3);
}

void Decode(char kind, std::string_view bytes) {
  try {
    if (kind == 'c') CheckImage(DecodePngRgb(bytes), 3);
    if (kind == 'l') CheckImage(DecodePngGrey16(bytes), 1);
    if (kind == 'j') DecodeJpeg(bytes);
    if (kind != 'd') return;
    const auto depths = DecodeNpy(bytes);
    CheckImage(depths, 1);
    const std::string again = EncodeNpy(depths.size.width_px, depths.size.height_px, depths.values);
    Check(again.substr(again.size() - 4 * depths.values.size()) ==
              bytes.substr(bytes.size() - 4 * depths.values.size()),
          "depths are as they were stored");
  } catch (const InputError& error) {
    const std::string_view fault = error.what();
    Check(fault.starts_with("is no ") || fault.starts_with("must "), "a fault is a rule");
    Check(fault.find('\n') == std::string_view::npos, "a fault is one line");
  }
}

}  // namespace
}  // namespace railcast

/// a letter for the kind of image (c: colours, l: labels, d: depths, j:
/// JPEG) and the bytes of its file.
RAILCAST_FUZZ_TARGET(image) {
  if (size == 0) return 0;
  railcast::Decode(static_cast<char>(data[0]), {reinterpret_cast<const char*>(data) + 1, size - 1});
  return 0;
}
