#include "core/io/image/png.h"

#include <png.h>

#include <memory>
#include <new>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/camera.h"

namespace railcast {
namespace {

void AppendPngBytes(png_structp png, png_bytep bytes, std::size_t num_bytes) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), num_bytes);
}

void FlushNothing(png_structp) {}

// libpng reports faults by a call that must not return. The only one left here is lack of memory.
[[noreturn]] void FailToEncode(png_structp, png_const_charp) {
  throw std::bad_alloc();
}

/// libpng's state while one image is encoded.
class PngWriter {
 public:
  explicit PngWriter(std::string& bytes)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, &FailToEncode, nullptr)) {
    if (png_ == nullptr) throw std::bad_alloc();
    info_ = png_create_info_struct(png_);
    png_set_write_fn(png_, &bytes, &AppendPngBytes, &FlushNothing);
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  void Begin(const ImageSize& size, int bit_depth, int color_type) {
    if (info_ == nullptr) throw std::bad_alloc();
    // Higher levels take several times as long for a tenth less.
    constexpr int kLevel = 3;
    png_set_compression_level(png_, kLevel);
    png_set_IHDR(png_, info_, size.width_px, size.height_px, bit_depth, color_type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // Ids have no gradients that a filter could predict.
    const bool has_colors = color_type == PNG_COLOR_TYPE_RGB;
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, has_colors ? PNG_FILTER_SUB : PNG_FILTER_NONE);
    if (has_colors) png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png_, info_);
  }
  void WriteRow(const std::uint8_t* row) { png_write_row(png_, row); }
  void End() { png_write_end(png_, nullptr); }

 private:
  png_structp png_;
  png_infop info_ = nullptr;
};

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

std::string EncodePngRgb(const ImageSize& size, std::span<const std::uint8_t> rgb) {
  const std::size_t row_size = std::size_t{3} * size.width_px;
  Check(rgb.size() == row_size * size.height_px, "an image has three bytes a pixel");
  std::string bytes;
  PngWriter writer(bytes);
  writer.Begin(size, 8, PNG_COLOR_TYPE_RGB);
  for (std::size_t row = 0; row < size.height_px; ++row) writer.WriteRow(&rgb[row * row_size]);
  writer.End();
  return bytes;
}

std::string EncodePngGrey16(const ImageSize& size, std::span<const std::uint32_t> values) {
  Check(values.size() == std::size_t{size.width_px} * size.height_px,
        "an image has all its pixels");
  std::string bytes;
  PngWriter writer(bytes);
  writer.Begin(size, 16, PNG_COLOR_TYPE_GRAY);
  std::vector<std::uint8_t> row;
  for (std::size_t first = 0; first < values.size(); first += size.width_px) {
    row.clear();
    for (const std::uint32_t value : values.subspan(first, size.width_px)) {
      row.push_back(static_cast<std::uint8_t>(value >> 8U));
      row.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    }
    writer.WriteRow(row.data());
  }
  writer.End();
  return bytes;
}

DecodedImage<std::uint8_t> DecodePngRgb(std::string_view bytes) {
  return DecodePng<std::uint8_t>(bytes, PNG_FORMAT_RGB, "8 bits each of red, green and blue");
}

DecodedImage<std::uint16_t> DecodePngGrey16(std::string_view bytes) {
  return DecodePng<std::uint16_t>(bytes, PNG_FORMAT_LINEAR_Y, "16 bits of grey");
}

}  // namespace railcast
