#pragma once

#include <string>
#include <string_view>

#include "core/extras/recipe/dataset_record.h"

namespace railcast {

/// The word that was drawn of a name; empty if there is none.
inline std::string DrawnOf(const ScenarioRecord& record, std::string_view name) {
  for (const auto& [drawn, value] : record.drawn) {
    if (drawn == name) return value.get<std::string>();
  }
  return "";
}

}  // namespace railcast
