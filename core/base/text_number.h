#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>

#include "core/base/text.h"

namespace railcast {

/// Parses a real number that programs write otherwise than from_chars() has it: what is not a
/// number or infinite as C libraries of any age do, "1.#QNAN", "-1.#IND", "NaNQ", and what is too
/// large or too small for a double, which becomes infinite or 0.
[[nodiscard]] std::optional<double> ParseOddReal(std::string_view word);

/// Parses a number in a text of another program, the whole word: as ParseSignedNumber() and
/// ParseOddReal(), and whole numbers written as reals, "1.000000", "1e3".
template <typename Number>
[[nodiscard]] std::optional<Number> ParseTextNumber(std::string_view word) {
  if (const auto number = ParseSignedNumber<Number>(word)) return number;
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  if constexpr (std::is_floating_point_v<Number>) {
    const auto odd = ParseOddReal(word);
    return odd ? std::optional(static_cast<Number>(*odd)) : std::nullopt;
  } else {
    const std::size_t last = word.find_last_not_of('0');
    if (last != std::string_view::npos && word[last] == '.' && last > 0) {
      return ParseNumber<Number>(word.substr(0, last));
    }
    const auto real = ParseNumber<double>(word);
    constexpr double kAllWholeNumbers = 0x1p53;
    const auto limit = static_cast<double>(std::numeric_limits<Number>::max());
    const bool fits = real && *real == std::floor(*real) && std::abs(*real) <= kAllWholeNumbers &&
                      *real <= limit && (std::is_signed_v<Number> ? *real >= -limit : *real >= 0.0);
    return fits ? std::optional(static_cast<Number>(*real)) : std::nullopt;
  }
}

}  // namespace railcast
