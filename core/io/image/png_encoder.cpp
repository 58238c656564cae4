#include "core/io/image/png_encoder.h"

#include <png.h>

#include <memory>
#include <new>
#include <vector>

#include "core/base/error.h"

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

}  // namespace railcast
