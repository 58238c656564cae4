#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace railcast {

// What an option of a command line must be, in the form that CLI11's validators have: a function of
// the option's text that gives the broken rule, empty if none is. All programs share them, so that
// a number means the same to each.

/// A whole number as people write it: decimal digits and nothing else. Leading zeros change
/// nothing, as in the names of frames: "000030" is 30. Nothing if it is none or exceeds 64 bits.
[[nodiscard]] std::optional<std::uint64_t> ParseWholeNumber(std::string_view text);

/// For CLI::Option::transform: CLI11 itself takes 010 for octal and wraps -1 round, so the text
/// becomes the plain digits of its number.
struct WholeNumberRule {
  std::uint64_t at_least = 0;
  std::uint64_t at_most = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] std::string operator()(std::string& text) const;
  [[nodiscard]] std::string Range() const;  ///< "1 to 65535".
};

/// For CLI::Option::check: a decimal number. CLI11 itself takes 0x10 for one, and NaN for one in
/// any range.
struct NumberRule {
  double at_least{};
  double at_most{};

  [[nodiscard]] std::string operator()(const std::string& text) const;
  [[nodiscard]] std::string Range() const;
};

/// Of the name of a file or folder: the shell makes an empty one of an unset variable.
[[nodiscard]] std::string NonEmptyRule(const std::string& text);

}  // namespace railcast
