#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

namespace railcast {

/// Takes the next line off `text`, without its end (LF or CR LF); returns nothing if none is left.
[[nodiscard]] inline std::optional<std::string_view> TakeLine(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// Splits a line into its words, which are separated by blanks.
[[nodiscard]] inline std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = line.find_first_of(" \t");
    words.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return words;
    line.remove_prefix(end);
  }
}

/// Parses the whole word as a number; returns nothing if it is not one or does not fit the type.
template <typename Number>
[[nodiscard]] std::optional<Number> ParseNumber(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// As ParseNumber(), with a plus sign allowed before the number, which from_chars() rejects. "+-1"
/// is no number.
template <typename Number>
[[nodiscard]] std::optional<Number> ParseSignedNumber(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return ParseNumber<Number>(word);
}

}  // namespace railcast
