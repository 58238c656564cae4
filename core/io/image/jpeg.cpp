#include "core/io/image/jpeg.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <new>
#include <utility>

// jpeglib.h needs the headers above.
#include <jpeglib.h>

// jerror.h needs jpeglib.h.
#include <jerror.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/camera.h"

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

// libjpeg reports faults by a call that must not return.
[[noreturn]] void RefuseJpeg(j_common_ptr state) {
  if (state->err->msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (state->err->msg_code == JERR_NO_SOI) throw InputError("is no JPEG file");
  std::array<char, JMSG_LENGTH_MAX> words{};
  state->err->format_message(state, words.data());
  throw InputError("is no sound JPEG file: " + ShownText(words.data()));
}

// A warning (a negative level) is a fault, too: the file is not as it was written.
void HearJpeg(j_common_ptr state, int level) {
  if (level < 0) RefuseJpeg(state);
}

/// libjpeg's state while one image is decoded.
class JpegReader {
 public:
  JpegReader() {
    state_.err = jpeg_std_error(&errors_);
    errors_.error_exit = &RefuseJpeg;
    errors_.emit_message = &HearJpeg;
    jpeg_create_decompress(&state_);
  }
  ~JpegReader() { jpeg_destroy_decompress(&state_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  [[nodiscard]] jpeg_decompress_struct& state() { return state_; }

 private:
  jpeg_error_mgr errors_{};
  jpeg_decompress_struct state_{};
};

std::string SizeText(std::uint32_t width_px, std::uint32_t height_px) {
  return NumberText(width_px) + " x " + NumberText(height_px);
}

// Other kinds would take more time or memory than their size says, for example those that send each
// part of the image many times.
void CheckKind(jpeg_decompress_struct& jpeg) {
  const bool is_baseline = jpeg.progressive_mode == FALSE && jpeg.arith_code == FALSE;
  const bool is_rgb = jpeg.num_components == 3 && jpeg.jpeg_color_space == JCS_YCbCr;
  if (!is_baseline || !is_rgb || jpeg_has_multiple_scans(&jpeg) != FALSE) {
    throw InputError("must be a baseline JPEG with three colours in one scan");
  }
}

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

DecodedImage<std::uint8_t> DecodeJpegRgb(std::string_view bytes, const ImageSize& size) {
  Check(std::uint64_t{size.width_px} * size.height_px <= kMostPixels,
        "the size of an image is checked before it is decoded");
  JpegReader reader;
  jpeg_decompress_struct& jpeg = reader.state();
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  (void)jpeg_read_header(&jpeg, TRUE);
  if (jpeg.image_width != size.width_px || jpeg.image_height != size.height_px) {
    throw InputError("must have " + SizeText(size.width_px, size.height_px) + " pixels (got " +
                     SizeText(jpeg.image_width, jpeg.image_height) + ")");
  }
  CheckKind(jpeg);
  jpeg.out_color_space = JCS_RGB;
  (void)jpeg_start_decompress(&jpeg);
  DecodedImage<std::uint8_t> image;
  image.size = size;
  const std::size_t row_size = std::size_t{3} * size.width_px;
  image.values.resize(row_size * size.height_px);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPLE* row = &image.values[jpeg.output_scanline * row_size];
    (void)jpeg_read_scanlines(&jpeg, &row, 1);
  }
  (void)jpeg_finish_decompress(&jpeg);
  return image;
}

}  // namespace railcast
