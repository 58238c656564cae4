#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/json_rules.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// The archive that checks (see describe_scenario.h): holds the numbers of a struct that was made
/// in C++ against the rules of its description. A fault's place is a JSON pointer:
/// "/beam/wavelength_nm: must be 905 or 1550 (got 1064)".
class SpecChecker {
 public:
  SpecChecker(std::string pointer, ErrorList& errors)
      : pointer_(std::move(pointer)), errors_(errors) {}

  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* /*doc*/, const Rule& rule = {}) {
    const std::string place = pointer_ + PointerStep(key);
    const std::size_t num_faults = errors_.faults().size();
    CheckValue(place, value, rule);
    if (errors_.faults().size() == num_faults) sound_[std::string(key)] = TextOf(value);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* doc, const Rule& rule = {}) {
    Required(key, value, doc, rule);
  }

  // Of files only: another way to give a value.
  void OneOfTwo(std::string_view, std::string_view) {}
  void Alternative(std::string_view, double, const Multiple&, const char*, const Limits&) {}

  void Ensure(const std::vector<std::string>& keys, bool holds, const std::string& rule) {
    const auto is_sound = [&](const std::string& key) { return sound_.contains(key); };
    if (holds || !std::ranges::all_of(keys, is_sound)) return;
    errors_.Add({pointer_ + PointerStep(keys.front()), rule, sound_.at(keys.front())});
  }

 private:
  template <class T>
  [[nodiscard]] static std::string TextOf(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      return NumberText(value);
    } else if constexpr (requires { value.has_value(); }) {
      return value ? TextOf(*value) : "";
    } else {
      return "";
    }
  }
  template <class T, class Rule>
  void CheckValue(const std::string& place, T& value, const Rule& rule) {
    if constexpr (requires { value.has_value(); }) {
      if (value) CheckValue(place, *value, rule);
    } else if constexpr (kIsArray<T>) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        CheckValue(place + "/" + std::to_string(i), value[i], rule);
      }
    } else if constexpr (std::is_class_v<T>) {
      SpecChecker checker(place, errors_);
      Describe(checker, value);
    } else if constexpr (!std::is_same_v<Rule, Anything>) {
      if (const auto broken = Broken(rule, value)) errors_.Add({place, *broken, NumberText(value)});
    }
  }

  std::string pointer_;
  ErrorList& errors_;
  std::map<std::string, std::string> sound_;  // The values that break no rule, by key.
};

}  // namespace railcast
