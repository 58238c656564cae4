#pragma once

#include <string>
#include <vector>

#include "core/extras/recipe/recipe.h"
#include "core/scenario/json_text.h"
#include "railcast/scenario.h"

namespace railcast {

/// The bases of a recipe, read.
class RecipeBases {
 public:
  /// @throws InputError with the faults of all bases.
  explicit RecipeBases(const Recipe& recipe);

  /// A base with all its defaults and files written out.
  [[nodiscard]] const Json& json(std::size_t base) const { return jsons_.at(base); }
  /// IdentityOf() of the base: changes with any value and with any file that it names. Of a plan it
  /// changes with its recording, too.
  [[nodiscard]] const std::string& hash(std::size_t base) const { return hashes_.at(base); }
  [[nodiscard]] const ScenarioSpec& spec(std::size_t base) const { return specs_.at(base); }

 private:
  std::vector<ScenarioSpec> specs_;
  std::vector<Json> jsons_;
  std::vector<std::string> hashes_;
};

/// One hash of the names and contents of all files that the values of a recipe name, and of those
/// that these name in turn or are read with: whatever is drawn, it is drawn from these. Empty if
/// there are none. The bases have hashes of their own (RecipeBases).
///
/// A text is taken for a file's name if there is such a file, so that the hash may be of some files
/// too many, but of none too few.
/// @throws InputError if a file cannot be read.
[[nodiscard]] std::string HashOfRecipeFiles(const Recipe& recipe);

}  // namespace railcast
