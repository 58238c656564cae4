#include "core/io/image/jpeg_decoder.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <new>
#include <string>

// jpeglib.h needs the headers above.
#include <jpeglib.h>

// jerror.h needs jpeglib.h.
#include <jerror.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/camera.h"

namespace railcast {
namespace {

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
