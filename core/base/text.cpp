#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <vector>

namespace railcast {

namespace {

constexpr std::size_t kMaxLength = 60;

std::uint8_t ByteAt(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0;
}

/// Length in bytes of the UTF-8 character (RFC 3629) that `text` begins with; 0 if it is invalid.
std::size_t LengthOfCharacter(std::string_view text) {
  const std::uint8_t first = ByteAt(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2   ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((ByteAt(text, i) & 0xC0U) != 0x80) return 0;
  }
  const std::uint8_t second = ByteAt(text, 1);
  // Overlong encodings, UTF-16 surrogates, and code points beyond U+10FFFF.
  const bool is_forbidden = (first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) ||
                            (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90);
  return is_forbidden ? 0 : length;
}

std::string Escaped(const char* format, unsigned number) {
  std::array<char, 8> text{};
  const int length = std::snprintf(text.data(), text.size(), format, number);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::string Shown(std::string_view character) {
  switch (character.front()) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      break;
  }
  const std::uint8_t first = ByteAt(character, 0);
  const bool is_c0 = first < 0x20 || first == 0x7F;
  const bool is_c1 = first == 0xC2 && ByteAt(character, 1) < 0xA0;
  if (is_c0) return Escaped("\\u%04x", first);
  if (is_c1) return Escaped("\\u%04x", ByteAt(character, 1));
  return std::string(character);
}

/// Removes the first character from `text`, or the first byte if no valid character begins there.
/// @return Its printable form.
std::string TakeCharacter(std::string_view& text) {
  const std::size_t length = LengthOfCharacter(text);
  const std::string shown =
      length == 0 ? Escaped("\\x%02x", ByteAt(text, 0)) : Shown(text.substr(0, length));
  text.remove_prefix(length == 0 ? 1 : length);
  return shown;
}

}  // namespace

std::string ShownText(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::string next = TakeCharacter(text);
    if (shown.size() + next.size() > kMaxLength) return shown + "...";
    shown += next;
  }
  return shown;
}

std::string ShownPath(const std::filesystem::path& path) {
  std::string shown;
  for (std::string_view rest = path.native(); !rest.empty();) shown += TakeCharacter(rest);
  return shown;
}

std::string ShownLines(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const bool is_end = text.front() == '\n';
    const std::string next = TakeCharacter(text);
    shown += is_end ? "\n" : next;
  }
  return shown;
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace railcast
