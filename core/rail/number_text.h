#pragma once

#include <array>
#include <charconv>
#include <string>

namespace railcast {

/// The shortest text that reads back as `value`, for messages: 29556.1, not 29556.100000.
[[nodiscard]] inline std::string NumberText(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

}  // namespace railcast
