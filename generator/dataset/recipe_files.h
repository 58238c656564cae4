#pragma once

#include <string>

#include "generator/dataset/recipe.h"

namespace railcast {

/// One hash of the names and contents of all files that the values of a recipe name, and of those
/// that these name in turn or are read with: whatever is drawn, it is drawn from these. Empty if
/// there are none. The bases have hashes of their own (RecipeBases).
///
/// A text is taken for a file's name if there is such a file, so that the hash may be of some files
/// too many, but of none too few.
/// @throws InputError if a file cannot be read.
[[nodiscard]] std::string HashOfRecipeFiles(const Recipe& recipe);

}  // namespace railcast
