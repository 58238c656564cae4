#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>

#include "core/base/error.h"

namespace railcast {

/// Faults of a world, and the values that are unknown because of these or earlier faults. Pointers
/// refer to the scenario: "/world/..." and "/vehicle/...".
struct WorldFaults {
  ErrorList errors;
  UnknownPlaces unknown;

  /// Reports a fault of the value at `pointer`, which becomes unknown.
  void Add(const std::string& pointer, const std::string& rule, const std::string& value = "") {
    errors.Add({pointer, rule, value});
    unknown.Add(pointer);
  }
  [[nodiscard]] bool AreKnown(std::initializer_list<std::string> pointers) const {
    return std::all_of(pointers.begin(), pointers.end(),
                       [&](const std::string& pointer) { return unknown.IsKnown(pointer); });
  }
};

}  // namespace railcast
