#include "core/scenario/json_rules.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/base/join.h"
#include "core/base/text.h"

namespace railcast {
namespace {

// Formats a number without a trailing ".0": 0.5 as "0.5", 360 as "360".
std::string Number(double value) {
  std::string text = nlohmann::json(value).dump();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

}  // namespace

std::optional<std::string> Broken(const Limits& limits, double value) {
  const bool holds = (!limits.above || value > *limits.above) &&
                     (!limits.at_least || value >= *limits.at_least) &&
                     (!limits.at_most || value <= *limits.at_most);
  if (holds) return std::nullopt;
  std::string rule = "must be";
  if (limits.above) rule += " > " + Number(*limits.above);
  if (limits.at_least) rule += " >= " + Number(*limits.at_least);
  if (limits.at_most) {
    rule += (limits.above || limits.at_least ? " and <= " : " <= ") + Number(*limits.at_most);
  }
  return rule;
}

std::optional<std::string> Broken(const NumberChoices& choices, int value) {
  const auto& numbers = choices.numbers;
  if (std::find(numbers.begin(), numbers.end(), value) != numbers.end()) return std::nullopt;
  std::vector<std::string> names;
  for (const int number : numbers) names.push_back(std::to_string(number));
  return "must be " + Alternatives(names);
}

std::optional<std::string> Broken(const AllowedNames& choices, std::string_view value) {
  const auto& names = choices.names;
  if (std::find(names.begin(), names.end(), value) != names.end()) return std::nullopt;
  // As many names as an object has types are more than a line should list.
  constexpr std::size_t kMany = 16;
  const std::optional<std::string> nearest =
      names.size() > kMany ? Nearest(value, names) : std::nullopt;
  if (!nearest) return "must be " + InWords(names);
  return "must be one of " + std::to_string(names.size()) + " names, the nearest is " +
         Quoted(*nearest);
}

std::optional<std::string> Broken(NonEmptyString, std::string_view value) {
  if (!value.empty()) return Broken(OneLine(), value);
  return "must not be empty";
}

std::optional<std::string> Broken(OneLine, std::string_view value) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::none_of(value.begin(), value.end(), is_control)) return std::nullopt;
  return "must not hold control characters";
}

std::optional<std::string> Broken(HostAndPort, std::string_view value) {
  const std::size_t colon = value.rfind(':');
  if (std::ranges::count(value, ':') > 1 && !(value.starts_with('[') && value[colon - 1] == ']')) {
    return "must be [host]:port where the host is an IPv6 address";
  }
  if (colon != std::string_view::npos && colon > 0) {
    const std::string_view digits = value.substr(colon + 1);
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), port);
    if (error == std::errc() && end == digits.end() && port > 0) return std::nullopt;
  }
  return "must be host:port with a port from 1 to 65535";
}

std::string Alternatives(const std::vector<std::string>& names) {
  return JoinInProse(names, " or ");
}

std::string InWords(const std::vector<std::string>& names) {
  return JoinInProse(names, " or ", Quoted);
}

std::optional<std::string> Nearest(std::string_view name, const std::vector<std::string>& valid) {
  std::optional<std::string> nearest;
  // A name with more than half of its letters wrong is not a typing error.
  std::size_t distance = name.size() / 2 + 1;
  for (const std::string& other : valid) {
    // The distance is at least the difference in length.
    if (std::max(name.size(), other.size()) - std::min(name.size(), other.size()) >= distance)
      continue;
    const std::size_t to_other = EditDistance(name, other);
    if (to_other >= distance) continue;
    distance = to_other;
    nearest = other;
  }
  return nearest;
}

std::string Unknown(std::string_view kind,
                    std::string_view name,
                    const std::vector<std::string>& valid) {
  const std::string unknown = "unknown " + std::string(kind) + ", ";
  if (valid.empty()) return unknown + "there is none";
  const std::optional<std::string> nearest = Nearest(name, valid);
  return unknown + (nearest ? "the nearest is " + Quoted(*nearest) : "must be " + InWords(valid));
}

}  // namespace railcast
