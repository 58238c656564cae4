#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

#include "core/io/image/npy_decoder.h"
#include "core/io/image/png.h"
#include "core/io/run/camera_files.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(PngDecoder, GivesBackEveryColourThatWasEncoded) {
  std::vector<std::uint8_t> rgb(std::size_t{3} * 256 * 2);
  std::iota(rgb.begin(), rgb.end(), std::uint8_t{0});
  const auto image = DecodePngRgb(EncodePngRgb({256, 2}, rgb));
  EXPECT_EQ(image.size.width_px, 256U);
  EXPECT_EQ(image.size.height_px, 2U);
  EXPECT_EQ(image.values, rgb);
}

TEST(PngDecoder, GivesBackEveryIdThatWasEncoded) {
  std::vector<std::uint32_t> ids(65'536);
  std::iota(ids.begin(), ids.end(), 0U);
  const auto image = DecodePngGrey16(EncodePngGrey16({512, 128}, ids));
  EXPECT_EQ(image.size.width_px, 512U);
  EXPECT_EQ(image.size.height_px, 128U);
  EXPECT_EQ(std::vector<std::uint32_t>(image.values.begin(), image.values.end()), ids);
}

TEST(PngDecoder, RefusesFilesOfAnotherKind) {
  const std::string rgb = EncodePngRgb({1, 1}, std::vector<std::uint8_t>{1, 2, 3});
  const std::string grey = EncodePngGrey16({1, 1}, std::vector<std::uint32_t>{7});
  EXPECT_EQ(MessageOf([&] { (void)DecodePngRgb(grey); }),
            "must be a PNG with 8 bits each of red, green and blue");
  EXPECT_EQ(MessageOf([&] { (void)DecodePngGrey16(rgb); }), "must be a PNG with 16 bits of grey");
}

TEST(PngDecoder, RefusesDamagedFiles) {
  const std::string whole = EncodePngGrey16({64, 64}, std::vector<std::uint32_t>(4096, 7));
  const auto fault_of = [](const std::string& bytes) {
    return MessageOf([&] { (void)DecodePngGrey16(bytes); });
  };
  EXPECT_EQ(fault_of(""), "is no PNG file");
  EXPECT_EQ(fault_of("GIF89a, for example"), "is no PNG file");
  for (std::size_t size = 8; size < whole.size() - 16; ++size) {
    EXPECT_TRUE(fault_of(whole.substr(0, size)).starts_with("is no sound PNG file: ")) << size;
  }
  // Every part but the last, which holds nothing, has a checksum.
  for (std::size_t i = 0; i + 12 < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    EXPECT_NE(fault_of(damaged), "no error") << i;
  }
}

TEST(NpyDecoder, GivesBackTheDepthsThatWereEncoded) {
  const std::vector<float> depths_m = {
      1.5F, std::numeric_limits<float>::quiet_NaN(), 3.0F, -0.0F, 200.0F, 1e-30F};
  const auto image = DecodeNpy(EncodeNpy(2, 3, depths_m));
  EXPECT_EQ(image.size.width_px, 2U);
  EXPECT_EQ(image.size.height_px, 3U);
  ASSERT_EQ(image.values.size(), depths_m.size());
  EXPECT_EQ(std::memcmp(image.values.data(), depths_m.data(), 6 * sizeof(float)), 0);
}

TEST(NpyDecoder, RefusesAllElse) {
  const std::string whole = EncodeNpy(2, 3, std::vector<float>(6));
  const auto fault_of = [&](const std::string& from, const std::string& to) {
    std::string bytes = whole;
    bytes.replace(bytes.find(from), from.size(), to);
    return MessageOf([&] { (void)DecodeNpy(bytes); });
  };
  const std::string other = "must be a NumPy array of little-endian float32 in rows";
  EXPECT_EQ(fault_of("NUMPY", "numpy"), "is no NumPy file of version 1.0");
  EXPECT_EQ(MessageOf([&] { (void)DecodeNpy(whole.substr(0, 9)); }),
            "is no NumPy file of version 1.0");
  EXPECT_EQ(fault_of("<f4", "<f8"), other);
  EXPECT_EQ(fault_of("False", "True "), other);
  EXPECT_EQ(fault_of("(3, 2)", "(6,)  "), other);
  EXPECT_EQ(fault_of("(3, 2)", "(3,-2)"), other);
  EXPECT_EQ(fault_of(" \n", "  "), other);
  EXPECT_EQ(MessageOf([&] { (void)DecodeNpy(whole.substr(0, 40)); }), other);
  EXPECT_EQ(fault_of("(3, 2)", "(3, 0)"), "must have 1 to 16777216 values (got 0)");
  EXPECT_EQ(fault_of("(3, 2), }        ", "(4097, 4096), }  "),
            "must have 1 to 16777216 values (got 16781312)");
  EXPECT_EQ(fault_of("(3, 2)", "(3, 3)"), "must have 36 bytes after its header (got 24)");
  EXPECT_EQ(MessageOf([&] { (void)DecodeNpy(whole + "x"); }),
            "must have 24 bytes after its header (got 25)");
}

}  // namespace
}  // namespace railcast
