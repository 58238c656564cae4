#include "core/io/jpeg_encoder.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>

// jpeglib.h needs the headers above.
#include <jpeglib.h>

#include "core/base/error.h"

namespace railcast {
namespace {

// libjpeg reports faults by a call that must not return. The only one left here is lack of memory.
[[noreturn]] void FailJpeg(j_common_ptr) {
  throw std::bad_alloc();
}

/// libjpeg's state while one image is encoded, and the bytes that it makes.
class JpegWriter {
 public:
  JpegWriter() {
    state_.err = jpeg_std_error(&errors_);
    errors_.error_exit = &FailJpeg;
    jpeg_create_compress(&state_);
    jpeg_mem_dest(&state_, &bytes_, &num_bytes_);
  }
  ~JpegWriter() {
    jpeg_destroy_compress(&state_);
    std::free(bytes_);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  [[nodiscard]] jpeg_compress_struct& state() { return state_; }
  [[nodiscard]] std::string bytes() const {
    return {reinterpret_cast<const char*>(bytes_), num_bytes_};
  }

 private:
  jpeg_error_mgr errors_{};
  jpeg_compress_struct state_{};
  unsigned char* bytes_ = nullptr;
  unsigned long num_bytes_ = 0;  // NOLINT(google-runtime-int): as libjpeg has it.
};

}  // namespace

std::string EncodeJpeg(const ImageSize& size, std::span<const std::uint8_t> rgb, int quality) {
  const std::size_t row_size = std::size_t{3} * size.width_px;
  Check(rgb.size() == row_size * size.height_px, "an image has three bytes a pixel");
  JpegWriter writer;
  jpeg_compress_struct& jpeg = writer.state();
  jpeg.image_width = size.width_px;
  jpeg.image_height = size.height_px;
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    // libjpeg does not write to the row.
    auto* row = const_cast<JSAMPLE*>(&rgb[jpeg.next_scanline * row_size]);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return writer.bytes();
}

}  // namespace railcast
