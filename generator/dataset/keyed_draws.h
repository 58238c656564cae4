#pragma once

#include <cstdint>
#include <string_view>

namespace railcast {

/// The random numbers of one scenario of a recipe. Each depends on the recipe's seed, the number of
/// the scenario and the name of what is drawn, and on nothing else: a new name moves no other draw.
class KeyedDraws {
 public:
  KeyedDraws(std::uint64_t seed, std::uint32_t scenario) : seed_(seed), scenario_(scenario) {}

  /// Uniform in [0, 1), with 53 bits.
  /// @param turn Which of several draws of that name.
  [[nodiscard]] double Unit(std::string_view name, std::uint32_t turn = 0) const;
  /// A seed for draws of another kind.
  [[nodiscard]] std::uint64_t Seed(std::string_view name) const;

 private:
  std::uint64_t seed_;
  std::uint32_t scenario_;
};

}  // namespace railcast
