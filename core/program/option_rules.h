#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace railcast {

// Rules for the values of command-line options, in the form of CLI11's validators: functions of the
// option's text that return the broken rule, or an empty string if none is broken. All programs
// share them, so that every program reads a number the same way.

/// Parses a whole number in its plain form: decimal digits and nothing else. Leading zeros are
/// ignored, as in the names of frames: "000030" is 30. Returns nothing if the text is not such a
/// number or exceeds 64 bits.
[[nodiscard]] std::optional<std::uint64_t> ParseWholeNumber(std::string_view text);

/// For CLI::Option::transform. CLI11 itself reads 010 as octal and wraps -1 around, so the text is
/// replaced by the plain digits of its number.
struct WholeNumberRule {
  std::uint64_t at_least = 0;
  std::uint64_t at_most = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] std::string operator()(std::string& text) const;
  [[nodiscard]] std::string Range() const;  ///< "1 to 65535".
};

/// For CLI::Option::check: a decimal number. CLI11 itself also accepts 0x10, and NaN in any range.
struct NumberRule {
  double at_least{};
  double at_most{};

  [[nodiscard]] std::string operator()(const std::string& text) const;
  [[nodiscard]] std::string Range() const;
};

/// For the name of a file or folder, which is empty where the shell expands an unset variable.
[[nodiscard]] std::string NonEmptyRule(const std::string& text);

}  // namespace railcast
