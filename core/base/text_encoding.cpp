#include "core/base/text_encoding.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "core/base/inputs.h"

namespace railcast {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

enum class ByteOrder : std::uint8_t { kNone, kLittle, kBig };

bool IsTextLetter(char letter) {
  return (letter >= ' ' && letter <= '~') || letter == '\t' || letter == '\r' || letter == '\n';
}

/// The order of the bytes of UTF-16; none if it is something else.
ByteOrder Utf16Of(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) return ByteOrder::kLittle;
  if (bytes.starts_with("\xFE\xFF")) return ByteOrder::kBig;
  // Binary data that begin with a short name have more than one zero behind it.
  constexpr std::size_t kTwoUnits = 4;
  if (bytes.size() < kTwoUnits || (bytes[2] == '\0' && bytes[3] == '\0')) return ByteOrder::kNone;
  if (IsTextLetter(bytes[0]) && bytes[1] == '\0') return ByteOrder::kLittle;
  if (bytes[0] == '\0' && IsTextLetter(bytes[1])) return ByteOrder::kBig;
  return ByteOrder::kNone;
}

/// Appends a code point. What is none in UTF-16 becomes the replacement character.
void AppendUtf8(std::uint32_t code, std::string& text) {
  constexpr std::array<std::uint32_t, 3> kFirstOfLength = {0x80, 0x800, 0x10000};
  if (code < kFirstOfLength[0]) {
    text += static_cast<char>(code);
    return;
  }
  const int num_more = code < kFirstOfLength[1] ? 1 : code < kFirstOfLength[2] ? 2 : 3;
  const std::uint32_t mark = (0xFF00U >> static_cast<unsigned>(num_more + 1)) & 0xFFU;
  text += static_cast<char>(mark | (code >> static_cast<unsigned>(6 * num_more)));
  for (int i = num_more - 1; i >= 0; --i) {
    text += static_cast<char>(0x80U | ((code >> static_cast<unsigned>(6 * i)) & 0x3FU));
  }
}

}  // namespace

bool IsUtf16(std::string_view bytes) {
  return Utf16Of(bytes) != ByteOrder::kNone;
}

std::string_view WithoutMark(std::string_view bytes) {
  if (bytes.starts_with(kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  return bytes;
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return lower;
}

std::string AsUtf8(std::string bytes) {
  if (bytes.starts_with(kUtf8Mark)) bytes.erase(0, kUtf8Mark.size());
  const ByteOrder order = Utf16Of(bytes);
  if (order == ByteOrder::kNone) return bytes;
  const auto unit_at = [&](std::size_t place) {
    const auto first = static_cast<unsigned char>(bytes[place]);
    const auto second = static_cast<unsigned char>(bytes[place + 1]);
    return static_cast<std::uint32_t>(order == ByteOrder::kLittle ? second << 8U | first
                                                                  : first << 8U | second);
  };
  std::string text;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit_at(i);
    if (i == 0 && code == 0xFEFF) continue;
    const bool is_high = code >= 0xD800 && code < 0xDC00;
    const std::uint32_t low = is_high && i + 3 < bytes.size() ? unit_at(i + 2) : 0;
    if (low >= 0xDC00 && low < 0xE000) {
      code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
      i += 2;
    } else if (code >= 0xD800 && code < 0xE000) {
      code = 0xFFFD;
    }
    AppendUtf8(code, text);
  }
  return text;
}

std::string ReadTextWhole(const std::filesystem::path& file) {
  return AsUtf8(*ReadInput(file));
}

}  // namespace railcast
