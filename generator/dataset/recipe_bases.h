#pragma once

#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "generator/dataset/recipe.h"
#include "railcast/scenario.h"

namespace railcast {

/// The bases of a recipe, read.
class RecipeBases {
 public:
  /// @throws InputError with the faults of all bases.
  explicit RecipeBases(const Recipe& recipe);

  /// A base with all its defaults and files written out.
  [[nodiscard]] const Json& json(std::size_t base) const { return jsons_.at(base); }
  /// IdentityOf() of the base: changes with any value and with any file that it names.
  [[nodiscard]] const std::string& hash(std::size_t base) const { return hashes_.at(base); }
  [[nodiscard]] const ScenarioSpec& spec(std::size_t base) const { return specs_.at(base); }

 private:
  std::vector<ScenarioSpec> specs_;
  std::vector<Json> jsons_;
  std::vector<std::string> hashes_;
};

}  // namespace railcast
