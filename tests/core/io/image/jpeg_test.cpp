#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/io/image/jpeg.h"
#include "tests/core/io/message_of.h"

// jpeglib.h needs the headers above.
#include <jpeglib.h>

namespace railcast {
namespace {

constexpr int kQuality = 90;

// Random greys: every coefficient of every block is rounded.
std::vector<std::uint8_t> GreyNoise(const ImageSize& size) {
  std::minstd_rand random(1);
  std::vector<std::uint8_t> rgb;
  for (std::uint32_t i = 0; i < size.width_px * size.height_px; ++i) {
    rgb.insert(rgb.end(), 3, static_cast<std::uint8_t>(random() >> 8U));
  }
  return rgb;
}

std::string FaultOf(const std::string& jpeg, const ImageSize& size) {
  return MessageOf([&] { (void)DecodeJpegRgb(jpeg, size); });
}

// Encodes 16 x 16 pixels with libjpeg itself, as EncodeJpeg() does not.
std::string OtherJpeg(const std::function<void(jpeg_compress_struct&)>& change) {
  jpeg_error_mgr errors{};
  jpeg_compress_struct jpeg{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long num_bytes = 0;
  jpeg_mem_dest(&jpeg, &bytes, &num_bytes);
  jpeg.image_width = jpeg.image_height = 16;
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  change(jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(std::size_t{16} * 4, 100);
  JSAMPLE* rows = row.data();
  while (jpeg.next_scanline < jpeg.image_height) jpeg_write_scanlines(&jpeg, &rows, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string made(reinterpret_cast<const char*>(bytes), num_bytes);
  std::free(bytes);
  return made;
}

// Quality 90 rounds the coefficients of grey to a fifth of the steps of ISO/IEC 10918-1, table K.1.
// No error exceeds half a step, and the transform keeps the sum of squares, so the mean square of
// the pixels' errors is below a quarter of the mean square of those steps, 179.9. Rounding to bytes
// adds up to a half.
TEST(Jpeg, KeepsGreysWithinItsRoundingOfCoefficients) {
  const ImageSize size{64, 48};
  const auto rgb = GreyNoise(size);
  const auto image = DecodeJpegRgb(EncodeJpeg(size, rgb, kQuality), size);
  ASSERT_EQ(image.values.size(), rgb.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < rgb.size(); ++i) sum += std::pow(image.values[i] - rgb[i], 2);
  const double mean_square = sum / static_cast<double>(rgb.size());
  const double most = std::pow(std::sqrt(179.9 / 4.0) + 0.5, 2);
  EXPECT_GT(10.0 * std::log10(255.0 * 255.0 / mean_square),
            10.0 * std::log10(255.0 * 255.0 / most));
  EXPECT_GT(mean_square, 1.0) << "noise cannot be kept as it is";
}

// A block of one colour has no coefficient but its mean, with a step of 3/8 in brightness and
// colour each. Red, green and blue are at most 1 + 1.772 times half of it off, and half a byte for
// each of the three roundings. The size is no multiple of a block's.
TEST(Jpeg, KeepsColoursAndTheirPlaces) {
  const ImageSize size{70, 50};
  const auto color_at = [](std::uint32_t x, std::uint32_t y) {
    return std::array<int, 3>{x < 32 ? 200 : 20, y < 32 ? 40 : 180, x < 32 && y < 32 ? 250 : 90};
  };
  std::vector<std::uint8_t> rgb;
  for (std::uint32_t i = 0; i < size.width_px * size.height_px; ++i) {
    for (const int value : color_at(i % size.width_px, i / size.width_px)) {
      rgb.push_back(static_cast<std::uint8_t>(value));
    }
  }
  const auto image = DecodeJpegRgb(EncodeJpeg(size, rgb, kQuality), size);
  EXPECT_EQ(image.size.width_px, size.width_px);
  EXPECT_EQ(image.size.height_px, size.height_px);
  ASSERT_EQ(image.values.size(), rgb.size());
  for (std::uint32_t i = 0; i < size.width_px * size.height_px; ++i) {
    const std::uint32_t x = i % size.width_px;
    const std::uint32_t y = i / size.width_px;
    // Colours have half the resolution and are interpolated across the edges.
    if (x == 31 || x == 32 || y == 31 || y == 32) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(image.values[3 * i + channel], color_at(x, y)[channel], 2) << x << ',' << y;
    }
  }
}

TEST(Jpeg, MayBeOnePixel) {
  const std::vector<std::uint8_t> rgb = {128, 128, 128};
  EXPECT_EQ(DecodeJpegRgb(EncodeJpeg({1, 1}, rgb, kQuality), {1, 1}).values, rgb);
}

TEST(Jpeg, HasTheSizeThatIsExpected) {
  const std::string jpeg = EncodeJpeg({64, 48}, GreyNoise({64, 48}), kQuality);
  EXPECT_EQ(FaultOf(jpeg, {48, 64}), "must have 48 x 64 pixels (got 64 x 48)");
  EXPECT_EQ(FaultOf(jpeg, {64, 49}), "must have 64 x 49 pixels (got 64 x 48)");
}

TEST(Jpeg, IsRefusedIfItIsOfAnotherKind) {
  EXPECT_EQ(FaultOf("GIF89a, for example", {1, 1}), "is no JPEG file");
  EXPECT_EQ(FaultOf("", {1, 1}), "is no sound JPEG file: Empty input file");
  EXPECT_EQ(FaultOf(OtherJpeg([](auto&) {}), {16, 16}), "no error");
  const std::string rule = "must be a baseline JPEG with three colours in one scan";
  EXPECT_EQ(FaultOf(OtherJpeg([](auto& jpeg) { jpeg_simple_progression(&jpeg); }), {16, 16}), rule);
  EXPECT_EQ(FaultOf(OtherJpeg([](auto& jpeg) { jpeg.arith_code = TRUE; }), {16, 16}), rule);
  EXPECT_EQ(
      FaultOf(OtherJpeg([](auto& jpeg) { jpeg_set_colorspace(&jpeg, JCS_GRAYSCALE); }), {16, 16}),
      rule);
  EXPECT_EQ(FaultOf(OtherJpeg([](auto& jpeg) { jpeg_set_colorspace(&jpeg, JCS_RGB); }), {16, 16}),
            rule);
  // One scan for each colour.
  std::vector<jpeg_scan_info> scans;
  for (const int color : {0, 1, 2}) scans.push_back({1, {color}, 0, 63, 0, 0});
  EXPECT_EQ(FaultOf(OtherJpeg([&](auto& jpeg) {
                      jpeg.scan_info = scans.data();
                      jpeg.num_scans = 3;
                    }),
                    {16, 16}),
            rule);
}

TEST(Jpeg, IsRefusedIfItIsCutOff) {
  const ImageSize size{32, 32};
  const std::string whole = EncodeJpeg(size, GreyNoise(size), kQuality);
  ASSERT_EQ(FaultOf(whole, size), "no error");
  for (std::size_t num_bytes = 2; num_bytes < whole.size(); ++num_bytes) {
    const std::string fault = FaultOf(whole.substr(0, num_bytes), size);
    EXPECT_TRUE(fault.starts_with("is no sound JPEG file: ")) << num_bytes << ' ' << fault;
  }
}

// The file has no checksums, so that not every change is noticed; but none does harm.
TEST(Jpeg, HasItsSizeWhateverIsChangedInIt) {
  const ImageSize size{32, 32};
  const std::string whole = EncodeJpeg(size, GreyNoise(size), kQuality);
  std::size_t num_refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const char flip : {char(1), char(0x80), char(0xFF)}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      try {
        EXPECT_EQ(DecodeJpegRgb(damaged, size).values.size(), std::size_t{3} * 32 * 32);
      } catch (const InputError&) {
        ++num_refused;
      }
    }
  }
  EXPECT_GT(num_refused, 100U);
}

}  // namespace
}  // namespace railcast
