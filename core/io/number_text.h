#pragma once

#include <array>
#include <charconv>
#include <string>

namespace railcast {

/// The shortest digits that give the same number back.
template <typename Number>
[[nodiscard]] std::string NumberText(Number number) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

}  // namespace railcast
