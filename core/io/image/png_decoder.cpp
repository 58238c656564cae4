#include "core/io/image/png_decoder.h"

#include <png.h>

#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/camera.h"

namespace railcast {
namespace {

/// What libpng's simplified interface keeps of one image that it reads.
class PngReader {
 public:
  PngReader() { image_.version = PNG_IMAGE_VERSION; }
  ~PngReader() { png_image_free(&image_); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  [[nodiscard]] const png_image& image() const { return image_; }

  /// Reads the header. This is not for the constructor: after a warning libpng keeps its memory,
  /// and only the destructor frees it.
  void Begin(std::string_view bytes) {
    constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
    if (!bytes.starts_with(kSignature)) throw InputError("is no PNG file");
    (void)png_image_begin_read_from_memory(&image_, bytes.data(), bytes.size());
    CheckFault();
  }

  void Read(void* pixels) {
    (void)png_image_finish_read(&image_, nullptr, pixels, 0, nullptr);
    CheckFault();
  }

 private:
  // A warning is a fault, too: the file is not as it was written.
  void CheckFault() const {
    if (image_.warning_or_error == 0) return;
    throw InputError("is no sound PNG file: " + ShownText(image_.message));
  }

  png_image image_{};
};

/// @param format PNG_FORMAT_RGB or PNG_FORMAT_LINEAR_Y, in which libpng changes no value of an
///   sRGB image of 8 bits or of a linear one of 16.
/// @param kind For the message.
template <typename Value>
DecodedImage<Value> DecodePng(std::string_view bytes, png_uint_32 format, const char* kind) {
  PngReader reader;
  reader.Begin(bytes);
  const png_image& image = reader.image();
  if (image.format != format) throw InputError(std::string("must be a PNG with ") + kind);
  const std::uint64_t num_pixels = std::uint64_t{image.width} * image.height;
  if (num_pixels > kMostPixels) {
    throw InputError("must have at most " + NumberText(kMostPixels) + " pixels" + Got(num_pixels));
  }
  DecodedImage<Value> decoded;
  decoded.size = {image.width, image.height};
  decoded.values.resize(num_pixels * PNG_IMAGE_SAMPLE_CHANNELS(format));
  reader.Read(decoded.values.data());
  return decoded;
}

}  // namespace

DecodedImage<std::uint8_t> DecodePngRgb(std::string_view bytes) {
  return DecodePng<std::uint8_t>(bytes, PNG_FORMAT_RGB, "8 bits each of red, green and blue");
}

DecodedImage<std::uint16_t> DecodePngGrey16(std::string_view bytes) {
  return DecodePng<std::uint16_t>(bytes, PNG_FORMAT_LINEAR_Y, "16 bits of grey");
}

}  // namespace railcast
