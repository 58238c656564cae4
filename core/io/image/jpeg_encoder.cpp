#include "core/io/image/jpeg_encoder.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <new>
#include <utility>

// jpeglib.h needs the headers above.
#include <jpeglib.h>

#include "core/base/error.h"

namespace railcast {
namespace {

// libjpeg reports faults by a call that must not return. The only one left here is lack of memory.
[[noreturn]] void FailJpeg(j_common_ptr) {
  throw std::bad_alloc();
}

/// libjpeg's state while one image is encoded, and the bytes that it makes. They are kept in memory
/// of this class: libjpeg's own jpeg_mem_dest() leaves a pointer to freed memory behind when it
/// fails to grow its buffer.
class JpegWriter {
 public:
  JpegWriter() {
    state_.err = jpeg_std_error(&errors_);
    errors_.error_exit = &FailJpeg;
    jpeg_create_compress(&state_);
    destination_.init_destination = &StartBlock;
    destination_.empty_output_buffer = &KeepFullBlock;
    destination_.term_destination = &KeepLastBlock;
    state_.dest = &destination_;
    state_.client_data = this;
  }
  ~JpegWriter() { jpeg_destroy_compress(&state_); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  [[nodiscard]] jpeg_compress_struct& state() { return state_; }
  [[nodiscard]] std::string TakeBytes() { return std::move(bytes_); }

 private:
  static void StartBlock(j_compress_ptr state) {
    JpegWriter& writer = *static_cast<JpegWriter*>(state->client_data);
    writer.destination_.next_output_byte = writer.block_.data();
    writer.destination_.free_in_buffer = writer.block_.size();
  }
  static boolean KeepFullBlock(j_compress_ptr state) {
    JpegWriter& writer = *static_cast<JpegWriter*>(state->client_data);
    // All of it: libjpeg does not keep `free_in_buffer` up to date before this call.
    writer.Keep(writer.block_.size());
    StartBlock(state);
    return TRUE;
  }
  static void KeepLastBlock(j_compress_ptr state) {
    JpegWriter& writer = *static_cast<JpegWriter*>(state->client_data);
    writer.Keep(writer.block_.size() - writer.destination_.free_in_buffer);
  }
  // Lack of memory passes through libjpeg as it does from FailJpeg().
  void Keep(std::size_t num_bytes) {
    bytes_.append(reinterpret_cast<const char*>(block_.data()), num_bytes);
  }

  static constexpr std::size_t kBlockSize = 16'384;
  jpeg_error_mgr errors_{};
  jpeg_destination_mgr destination_{};
  jpeg_compress_struct state_{};
  std::array<JOCTET, kBlockSize> block_;
  std::string bytes_;
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
  return writer.TakeBytes();
}

}  // namespace railcast
