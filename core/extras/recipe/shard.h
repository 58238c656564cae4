#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace railcast {

/// The part of a data set that one run makes: every `of`-th scenario, beginning with number - 1.
struct Shard {
  /// More would each hold hardly anything.
  static constexpr std::uint32_t kMost = 100'000;

  std::uint32_t number = 1;  ///< From 1 to `of`.
  std::uint32_t of = 1;      ///< 1 to kMost.

  [[nodiscard]] bool is_whole() const { return of == 1; }
  /// Number of its scenarios.
  [[nodiscard]] std::uint32_t NumOf(std::uint32_t num_scenarios) const {
    return num_scenarios < number ? 0 : (num_scenarios - number) / of + 1;
  }
  /// Its i-th scenario.
  [[nodiscard]] std::uint32_t ScenarioAt(std::uint32_t i) const { return number - 1 + i * of; }
};

/// Parses "2/7"; returns nothing if the text is not such a shard.
[[nodiscard]] std::optional<Shard> ParseShard(std::string_view text);

/// The rule that a text breaks if ParseShard() returns nothing; empty if it breaks none.
[[nodiscard]] std::string ShardRule(const std::string& text);

/// The shard as ParseShard() reads it.
[[nodiscard]] std::string ShardText(const Shard& shard);

}  // namespace railcast
