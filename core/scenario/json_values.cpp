#include "core/scenario/json_reader.h"

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

void ReadBool(JsonSource& source, const Node& node, bool& value) {
  if (!node.json->is_boolean()) return source.Fault(node, "must be true or false");
  value = node.json->get<bool>();
}

void ReadNumber(JsonSource& source, const Node& node, double& value, const RuleRef& rule) {
  if (!node.json->is_number()) return source.Fault(node, "must be a number");
  const auto number = node.json->get<double>();
  if (const auto* const limits = rule.As<Limits>()) {
    if (const auto broken = Broken(*limits, number)) return source.Fault(node, *broken);
  }
  value = number;
}

void ReadWhole(JsonSource& source, const Node& node, const ValueRef& value, const RuleRef& rule) {
  const auto whole = WholeNumberOf(*node.json);
  const std::uint64_t most = value.type->most;
  if (const auto* const choices = rule.As<NumberChoices>()) {
    // 0 is never among the choices, so that a value that is not an integer breaks the rule as well.
    const std::uint64_t number = whole && *whole <= most ? *whole : 0;
    if (const auto broken = Broken(*choices, static_cast<int>(number))) {
      return source.Fault(node, *broken);
    }
    return value.type->set_whole(value.place, number);
  }
  const auto* const limits = rule.As<Limits>();
  const auto limit = [](const std::optional<double>& given, std::uint64_t otherwise) {
    return given ? static_cast<std::uint64_t>(*given) : otherwise;
  };
  const std::uint64_t at_least = limits != nullptr ? limit(limits->at_least, 0) : 0;
  const std::uint64_t at_most = limits != nullptr ? limit(limits->at_most, most) : most;
  if (whole && *whole >= at_least && *whole <= at_most) {
    return value.type->set_whole(value.place, *whole);
  }
  source.Fault(node, "must be a whole number from " + std::to_string(at_least) + " to " +
                         std::to_string(at_most));
}

void ReadSigned(JsonSource& source, const Node& node, std::int64_t& value) {
  const Json& json = *node.json;
  const bool is_whole = json.is_number_integer() && !json.is_number_unsigned();
  const bool fits = is_whole || (json.is_number_unsigned() &&
                                 std::in_range<std::int64_t>(json.get<std::uint64_t>()));
  if (!fits) return source.Fault(node, "must be a whole number of at most 63 bits");
  value = json.get<std::int64_t>();
}

void ReadText(JsonSource& source, const Node& node, std::string& value, const RuleRef& rule) {
  if (rule.As<ExistingFile>() != nullptr) {
    if (const auto file = source.FileNamedBy(node)) value = file->string();
    return;
  }
  if (!node.json->is_string()) return source.Fault(node, "must be a string");
  const auto text = node.json->get<std::string>();
  std::optional<std::string> broken;
  if (const auto* const names = rule.As<AllowedNames>()) broken = Broken(*names, text);
  if (rule.As<OneLine>() != nullptr) broken = Broken(OneLine(), text);
  if (rule.As<NonEmptyString>() != nullptr) broken = Broken(NonEmptyString(), text);
  if (rule.As<HostAndPort>() != nullptr) broken = Broken(HostAndPort(), text);
  if (broken) return source.Fault(node, *broken);
  value = text;
}

void ReadName(JsonSource& source, const Node& node, const ValueRef& value) {
  std::string name = value.type->name(value.place);
  ReadText(source, node, name, OneOf(value.type->names()));
  value.type->set_name(value.place, name);
}

void ReadObjectType(JsonSource& source, const Node& node, ObjectType& value) {
  if (node.json->is_string()) {
    if (auto type = source.types().Find(node.json->get<std::string>())) {
      value = std::move(*type);
      return;
    }
    // The name may be that of a model with a fault.
    if (!source.unknown().IsKnown("/models")) return source.unknown().Add(node.resolved_pointer);
  }
  std::string name;
  ReadText(source, node, name, OneOf(source.types().Names()));
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
