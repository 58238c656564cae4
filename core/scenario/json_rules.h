#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

// What a value must be besides its type. A description gives each field at most one of these; the
// reader enforces it, the schema states it.

struct Anything {};

/// Of a number, or of each number in an array.
struct Limits {
  std::optional<double> above{};
  std::optional<double> at_least{};
  std::optional<double> at_most{};
};
[[nodiscard]] inline Limits Positive() {
  return {.above = 0.0};
}
[[nodiscard]] inline Limits NonNegative() {
  return {.at_least = 0.0};
}
[[nodiscard]] inline Limits AtLeast(double value) {
  return {.at_least = value};
}
[[nodiscard]] inline Limits Within(double at_least, double at_most) {
  return {.at_least = at_least, .at_most = at_most};
}
[[nodiscard]] inline Limits PositiveUpTo(double at_most) {
  return {.above = 0.0, .at_most = at_most};
}

/// Of a whole number.
struct NumberChoices {
  std::vector<int> numbers;
};
[[nodiscard]] inline NumberChoices OneNumberOf(std::vector<int> numbers) {
  return {std::move(numbers)};
}

/// Of a string.
struct AllowedNames {
  std::vector<std::string> names;
};
[[nodiscard]] inline AllowedNames OneOf(std::vector<std::string> names) {
  return {std::move(names)};
}
/// Without control characters: reports and messages show names as they are.
struct OneLine {};
/// The same, and not empty.
struct NonEmptyString {};
/// host:port. Of a string, or of each string in a list.
struct HostAndPort {};
/// Names a file, relative to the one that it is written in; becomes absolute.
struct ExistingFile {};

/// Of a list.
struct AtLeastElements {
  std::size_t count{};
  const char* instead = "";  ///< What to do instead of giving none.
};
[[nodiscard]] inline AtLeastElements NonEmptyList() {
  return {.count = 1};
}

/// Of a list whose elements are arrays of numbers or, if it names one of their keys, objects with
/// that number; it may be stricter than what describes it for all lists of such objects.
struct EachNumber {
  Limits limits;
  const char* key = "";
  std::size_t at_least = 0;  ///< Elements.
};
[[nodiscard]] inline EachNumber EachValue(const Limits& limits) {
  return {limits, "value"};
}

/// Of a list that may be empty, but not always: what else is given decides.
struct NonEmptyListIf {
  bool applies{};
  const char* instead = "";
};

/// How an alternative key gives another key's value.
struct Multiple {
  const char* of_key{};
  double factor{};
};

/// The "type" by which a struct is told apart from others in its place; each description of such a
/// struct specialises it.
template <class T>
inline constexpr const char* kTypeName = nullptr;

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t kCount>
inline constexpr bool kIsArray<std::array<T, kCount>> = true;

/// Whether an element of a list may be, or build on, a file: elements have no room for that where
/// they have a "file" of their own.
template <class T>
inline constexpr bool kElementMayBeFile = false;

/// The rule in words, "must be > 0 and <= 360", if the value breaks it.
[[nodiscard]] std::optional<std::string> Broken(const Limits& limits, double value);
[[nodiscard]] std::optional<std::string> Broken(const NumberChoices& choices, int value);
[[nodiscard]] std::optional<std::string> Broken(const AllowedNames& choices,
                                                std::string_view value);
[[nodiscard]] std::optional<std::string> Broken(NonEmptyString, std::string_view value);
[[nodiscard]] std::optional<std::string> Broken(OneLine, std::string_view value);
[[nodiscard]] std::optional<std::string> Broken(HostAndPort, std::string_view value);

/// `"a", "b" or "c"`, as messages show them.
[[nodiscard]] std::string InWords(const std::vector<std::string>& names);

/// The valid name that is nearest (fewest insertions, deletions and replacements of a letter), if
/// at most half of the letters are wrong.
[[nodiscard]] std::optional<std::string> Nearest(std::string_view name,
                                                 const std::vector<std::string>& valid);

/// What to say about a key, or a `kind` of name, that is none of `valid`: names the nearest one, or
/// all if none is near.
[[nodiscard]] std::string Unknown(std::string_view kind,
                                  std::string_view name,
                                  const std::vector<std::string>& valid);

}  // namespace railcast
