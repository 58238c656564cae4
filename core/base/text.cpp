#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/text_number.h"

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
  std::array<char, 12> text{};
  const int length = std::snprintf(text.data(), text.size(), format, number);
  return {text.data(), static_cast<std::size_t>(length)};
}

/// The code point of a valid UTF-8 character.
char32_t CodePoint(std::string_view character) {
  constexpr std::array<unsigned, 5> kFirstBits = {0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t point = ByteAt(character, 0) & kFirstBits.at(character.size());
  for (std::size_t i = 1; i < character.size(); ++i) {
    point = (point << 6U) | (ByteAt(character, i) & 0x3FU);
  }
  return point;
}

/// Whether a character is never seen, but may change the order of others, end a line or make two
/// names look the same: Default_Ignorable_Code_Point, line and paragraph separators, the marks of
/// bidirectional text and annotation controls (Unicode 15, DerivedCoreProperties.txt).
bool IsInvisible(char32_t point) {
  struct Range {
    char32_t first;
    char32_t last;
  };
  constexpr auto kRanges = std::to_array<Range>({{0xAD, 0xAD},
                                                 {0x34F, 0x34F},
                                                 {0x61C, 0x61C},
                                                 {0x115F, 0x1160},
                                                 {0x17B4, 0x17B5},
                                                 {0x180B, 0x180F},
                                                 {0x200B, 0x200F},
                                                 {0x2028, 0x202E},
                                                 {0x2060, 0x206F},
                                                 {0x3164, 0x3164},
                                                 {0xFE00, 0xFE0F},
                                                 {0xFEFF, 0xFEFF},
                                                 {0xFFA0, 0xFFA0},
                                                 {0xFFF0, 0xFFFB},
                                                 {0x1BCA0, 0x1BCA3},
                                                 {0x1D173, 0x1D17A},
                                                 {0xE0000, 0xE0FFF}});
  return std::ranges::any_of(
      kRanges, [&](const Range& range) { return point >= range.first && point <= range.last; });
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
  const char32_t point = CodePoint(character);
  const bool is_control = point < 0x20 || (point >= 0x7F && point < 0xA0);
  if (is_control || IsInvisible(point)) {
    return Escaped(point > 0xFFFF ? "\\U%08x" : "\\u%04x", static_cast<unsigned>(point));
  }
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

std::optional<double> ParseOddReal(std::string_view word) {
  const bool is_negative = word.starts_with('-');
  if (is_negative) word.remove_prefix(1);
  double number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (error == std::errc::result_out_of_range && end == word.data() + word.size()) {
    const std::size_t exponent = word.find_first_of("eE");
    const bool is_small = exponent == std::string_view::npos
                              ? word.starts_with("0")
                              : word.substr(exponent + 1).starts_with('-');
    number = is_small ? 0.0 : kInfinity;
    return is_negative ? -number : number;
  }
  std::string lower;
  for (const char letter : word) {
    lower += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  std::string_view rest = lower;
  // Microsoft's: "1.#IND00", to so many decimals; with the comma of other languages, too.
  const bool is_marked = rest.starts_with("1.#") || rest.starts_with("1,#");
  if (is_marked) rest.remove_prefix(3);
  const std::size_t letters =
      std::min(rest.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), rest.size());
  const std::string_view name = rest.substr(0, letters);
  const std::string_view tail = rest.substr(letters);
  const bool has_tail = tail.find_first_not_of("0123456789") == std::string_view::npos ||
                        (tail.starts_with('(') && tail.ends_with(')'));
  if (!has_tail) return std::nullopt;
  for (const char* const infinite : {"inf", "infinity"}) {
    if (name == infinite) return is_negative ? -kInfinity : kInfinity;
  }
  for (const char* const none : {"nan", "nanq", "nans", "qnan", "snan", "ind"}) {
    if (name == none) return std::numeric_limits<double>::quiet_NaN();
  }
  return std::nullopt;
}

}  // namespace railcast
