#pragma once

#include "generator/dataset/recipe.h"

namespace railcast {

/// Checks a recipe beyond its own rules: that no value overwrites another one, and that the reader
/// of scenarios accepts what is drawn, with every extreme of every distribution and with every
/// option, on every base.
/// @throws InputError with a line for every fault, which names the recipe's key.
void CheckRecipe(const Recipe& recipe);

}  // namespace railcast
