#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

inline constexpr std::size_t kNanosecondDigits = 9;

/// A number or a time in a name.
struct NameValue {
  bool is_time{};
  std::int64_t time_ns{};  ///< Since 1970, in UTC where no zone is stated.
  bool has_sign{};
  bool is_negative{};  ///< Unless the sign is a hyphen between words (SettleValues()).
  bool has_point{};
  std::string written;   ///< All of it.
  std::string whole;     ///< Without zeros in front.
  std::string fraction;  ///< As written, but for zeros behind nanoseconds.

  [[nodiscard]] std::weak_ordering operator<=>(const NameValue& other) const;
  bool operator==(const NameValue& other) const { return (*this <=> other) == 0; }
};

/// The stem of a name: its values, and the texts before, between and behind them.
struct CloudName {
  std::vector<std::string> texts;
  std::vector<NameValue> values;

  /// The stem with # in place of the values that run, or of all.
  [[nodiscard]] std::string Label(const std::vector<bool>& runs = {}) const;
  /// Whether a letter stands right before or behind a value, as in "lidar2".
  [[nodiscard]] bool IsInWord(std::size_t place) const;
};

/// Parses the stem of a name.
/// @param with_times Whether dates with times are one value, as ISO 8601 has them or with other
///   marks between their numbers or none: "2026-11-30T09-59-59.8", "20261130_095959".
[[nodiscard]] CloudName ParseCloudName(std::string_view stem, bool with_times);

/// Takes the digits off the front of the text.
[[nodiscard]] std::string_view TakeAllDigits(std::string_view& text);
[[nodiscard]] std::string_view WithoutZeros(std::string_view digits);

}  // namespace railcast
