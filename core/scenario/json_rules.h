#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

// Rules for values beyond their types. A description gives each field at most one rule; the reader
// enforces it and the schema states it.

struct Anything {};

/// Limits of a number, or of each number in an array.
struct Limits {
  std::optional<double> above{};
  std::optional<double> at_least{};
  std::optional<double> at_most{};
};
[[nodiscard]] inline Limits Within(double at_least, double at_most) {
  return {.at_least = at_least, .at_most = at_most};
}
[[nodiscard]] inline Limits PositiveUpTo(double at_most) {
  return {.above = 0.0, .at_most = at_most};
}

/// The allowed values of an integer.
struct NumberChoices {
  std::vector<int> numbers;
};
[[nodiscard]] inline NumberChoices OneNumberOf(std::vector<int> numbers) {
  return {std::move(numbers)};
}

/// The allowed values of a string.
struct AllowedNames {
  std::vector<std::string> names;
};
[[nodiscard]] inline AllowedNames OneOf(std::vector<std::string> names) {
  return {std::move(names)};
}
/// A string without control characters: reports and messages show names as they are.
struct OneLine {};
/// A string as OneLine, but not empty.
struct NonEmptyString {};
/// A string, or a list of strings, of the form host:port, with brackets around a host of IPv6.
struct HostAndPort {};
/// A string that names an existing file relative to the file it is written in; the reader makes the
/// name absolute.
struct ExistingFile {};

/// The least number of elements of a list.
struct AtLeastElements {
  std::size_t count{};
  const char* instead = "";  ///< Advice for users who gave an empty list.
};
[[nodiscard]] inline AtLeastElements NonEmptyList() {
  return {.count = 1};
}

/// Limits of the numbers in a list. Its elements are arrays of numbers or, if `key` is given,
/// objects with a number under that key. The limits may be stricter than those in the description
/// of the objects.
struct EachNumber {
  Limits limits;
  const char* key = "";
  std::size_t at_least = 0;  ///< Least number of elements.
};
[[nodiscard]] inline EachNumber EachValue(const Limits& limits) {
  return {limits, "value"};
}

/// A list that may be empty only if the rule does not apply, which depends on other keys.
struct NonEmptyListIf {
  bool applies{};
  const char* instead = "";
};

/// The value of key `of_key` as a multiple of that of an alternative key.
struct Multiple {
  const char* of_key{};
  double factor{};
};

/// What a file of another format gives to a struct: the value of a required key, which is then left
/// out, and defaults of others.
struct FilePreset {
  const char* gives{};  ///< The required key.
  /// Throws InputError with a fault for each place of the file.
  std::function<void(const std::string& text)> use;
};

/// The rule in words, "must be > 0 and <= 360", if the value breaks it.
[[nodiscard]] std::optional<std::string> Broken(const Limits& limits, double value);
[[nodiscard]] std::optional<std::string> Broken(const NumberChoices& choices, int value);
[[nodiscard]] std::optional<std::string> Broken(const AllowedNames& choices,
                                                std::string_view value);
[[nodiscard]] std::optional<std::string> Broken(NonEmptyString, std::string_view value);
[[nodiscard]] std::optional<std::string> Broken(OneLine, std::string_view value);
[[nodiscard]] std::optional<std::string> Broken(HostAndPort, std::string_view value);

/// Lists names in prose: `a, b or c`.
[[nodiscard]] std::string Alternatives(const std::vector<std::string>& names);

/// Lists names as messages show them: `"a", "b" or "c"`.
[[nodiscard]] std::string InWords(const std::vector<std::string>& names);

/// The valid name nearest to `name` (fewest insertions, deletions and replacements of letters), if
/// at most half of the letters are wrong.
[[nodiscard]] std::optional<std::string> Nearest(std::string_view name,
                                                 const std::vector<std::string>& valid);

/// The message about a key, or another `kind` of name, that is not in `valid`. It suggests the
/// nearest valid name, or lists all if none is near.
[[nodiscard]] std::string Unknown(std::string_view kind,
                                  std::string_view name,
                                  const std::vector<std::string>& valid);

}  // namespace railcast
