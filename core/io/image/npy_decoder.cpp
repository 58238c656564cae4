#include "core/io/image/npy_decoder.h"

#include <charconv>
#include <cstring>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/camera.h"

namespace railcast {
namespace {

constexpr std::string_view kNpyMagic("\x93NUMPY\x01\x00", 8);

bool TakeText(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

std::optional<std::uint32_t> TakeNumber(std::string_view& text) {
  std::uint32_t number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// Returns the size that a header states; nothing if it is not one of EncodeNpy().
std::optional<ImageSize> SizeIn(std::string_view header) {
  if (!TakeText(header, "{'descr': '<f4', 'fortran_order': False, 'shape': (")) return {};
  const auto height_px = TakeNumber(header);
  if (!height_px || !TakeText(header, ", ")) return {};
  const auto width_px = TakeNumber(header);
  if (!width_px || !TakeText(header, "), }")) return {};
  // What follows is padding.
  const bool is_padded = header.find_first_not_of(' ') == header.size() - 1;
  if (!is_padded || header.back() != '\n') return {};
  return ImageSize{*width_px, *height_px};
}

}  // namespace

DecodedImage<float> DecodeNpy(std::string_view bytes) {
  std::string_view left = bytes;
  if (!TakeText(left, kNpyMagic) || left.size() < 2) {
    throw InputError("is no NumPy file of version 1.0");
  }
  const auto byte_at = [&](std::size_t at) { return static_cast<std::uint8_t>(left[at]); };
  const std::size_t header_size = byte_at(0) + std::size_t{256} * byte_at(1);
  left.remove_prefix(2);
  const auto size = SizeIn(left.substr(0, header_size));
  if (!size) throw InputError("must be a NumPy array of little-endian float32 in rows");
  left.remove_prefix(header_size);
  const std::uint64_t num_values = std::uint64_t{size->width_px} * size->height_px;
  if (num_values == 0 || num_values > kMostPixels) {
    throw InputError("must have 1 to " + NumberText(kMostPixels) + " values" + Got(num_values));
  }
  if (left.size() != num_values * sizeof(float)) {
    throw InputError("must have " + NumberText(num_values * sizeof(float)) +
                     " bytes after its header" + Got(left.size()));
  }
  DecodedImage<float> decoded{*size, std::vector<float>(num_values)};
  std::memcpy(decoded.values.data(), left.data(), left.size());
  return decoded;
}

}  // namespace railcast
