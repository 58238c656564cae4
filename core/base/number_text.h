#pragma once

#include <array>
#include <charconv>
#include <string>

namespace railcast {

/// The shortest text that reads back as the same number: 29556.1, not 29556.100000.
template <typename Number>
[[nodiscard]] std::string NumberText(Number number) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

}  // namespace railcast
