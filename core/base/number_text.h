#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string>

namespace railcast {

/// The shortest text that reads back as the same number: 29556.1, not 29556.100000.
template <typename Number>
[[nodiscard]] std::string NumberText(Number number) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

/// "5.4 s". Divided, unlike SecondsFromNs: multiplying by 1e-9 gives 0.30000000000000004.
[[nodiscard]] inline std::string SecondsText(std::int64_t time_ns) {
  constexpr double kNsPerS = 1e9;
  return NumberText(static_cast<double>(time_ns) / kNsPerS) + " s";
}

}  // namespace railcast
