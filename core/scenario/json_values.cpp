#include "core/scenario/json_values.h"

#include <cmath>
#include <utility>

namespace railcast {
namespace {

// Doubles represent all integers up to this one exactly.
constexpr double kMaxExactWhole = 0x1p53;

std::optional<std::uint64_t> WholeNumberOf(const Json& json) {
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (!json.is_number_float()) return std::nullopt;
  const auto number = json.get<double>();  // Accepts 1808.0 like 1808.
  if (number < 0.0 || number > kMaxExactWhole || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

}  // namespace

void ReadValue(JsonSource& source, const Node& node, bool& value, Anything) {
  if (!node.json->is_boolean()) return source.Fault(node, "must be true or false");
  value = node.json->get<bool>();
}

void ReadValue(JsonSource& source, const Node& node, double& value, Anything) {
  ReadValue(source, node, value, Limits{});
}

void ReadValue(JsonSource& source, const Node& node, double& value, const Limits& limits) {
  if (!node.json->is_number()) return source.Fault(node, "must be a number");
  const auto number = node.json->get<double>();
  if (const auto broken = Broken(limits, number)) return source.Fault(node, *broken);
  value = number;
}

void ReadValue(JsonSource& source, const Node& node, int& value, const NumberChoices& choices) {
  const auto whole = WholeNumberOf(*node.json);
  const bool fits = whole && *whole <= std::numeric_limits<int>::max();
  // 0 is never among the choices, so that a value that is not an integer breaks the rule as well.
  const int number = fits ? static_cast<int>(*whole) : 0;
  if (const auto broken = Broken(choices, number)) return source.Fault(node, *broken);
  value = number;
}

void ReadValue(JsonSource& source, const Node& node, std::string& value, Anything) {
  if (!node.json->is_string()) return source.Fault(node, "must be a string");
  value = node.json->get<std::string>();
}

void ReadValue(JsonSource& source, const Node& node, std::string& value, ExistingFile) {
  if (const auto file = source.FileNamedBy(node)) value = file->string();
}

void ReadValue(JsonSource& source, const Node& node, ObjectType& value, Anything) {
  if (node.json->is_string()) {
    if (auto type = source.types().Find(node.json->get<std::string>())) {
      value = std::move(*type);
      return;
    }
    // The name may be that of a model with a fault.
    if (!source.unknown().IsKnown("/models")) return source.unknown().Add(node.resolved_pointer);
  }
  std::string name;
  ReadValue(source, node, name, OneOf(source.types().Names()));
}

std::optional<std::uint64_t> ReadWhole(JsonSource& source,
                                       const Node& node,
                                       std::uint64_t at_least,
                                       std::uint64_t at_most) {
  const auto whole = WholeNumberOf(*node.json);
  if (whole && *whole >= at_least && *whole <= at_most) return whole;
  source.Fault(node, "must be a whole number from " + std::to_string(at_least) + " to " +
                         std::to_string(at_most));
  return std::nullopt;
}

bool CheckEachNumber(JsonSource& source, const Node& list, const EachNumber& rule) {
  bool holds = true;
  const auto check = [&](const Node& number) {
    // Values that are not numbers have been reported already.
    if (!number.json->is_number()) return;
    if (const auto broken = Broken(rule.limits, number.json->get<double>())) {
      source.Fault(number, *broken);
      holds = false;
    }
  };
  for (std::size_t i = 0; i < list.json->size(); ++i) {
    const Node element = list.Child(i);
    if (element.json->is_object() && element.json->contains(rule.key)) {
      check(element.Child(rule.key));
    } else if (element.json->is_array()) {
      for (std::size_t k = 0; k < element.json->size(); ++k) check(element.Child(k));
    }
  }
  return holds;
}

bool CheckListOf(JsonSource& source, const Node& node, std::size_t count) {
  if (node.json->is_array() && node.json->size() == count) return true;
  source.Fault(node, "must be a list of " + std::to_string(count) + " values");
  return false;
}

bool CheckListOfAtLeast(JsonSource& source, const Node& node, const AtLeastElements& rule) {
  if (!node.json->is_array()) {
    source.Fault(node, "must be a list");
    return false;
  }
  if (node.json->size() < rule.count) {
    source.Fault(node, rule.count == 1
                           ? std::string("must not be empty") + rule.instead
                           : "must have at least " + std::to_string(rule.count) + " elements");
    return false;
  }
  return true;
}

}  // namespace railcast
