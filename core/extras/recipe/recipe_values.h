#pragma once

#include <map>
#include <string>

#include "core/extras/recipe/distribution.h"
#include "core/extras/recipe/drafted_scenario.h"
#include "core/extras/recipe/recipe.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// Values that are taken instead of drawn ones, by the name of the draw.
using ForcedValues = std::map<std::string, Json>;

// The names of draws (KeyedDraws).
[[nodiscard]] std::string NameOfGroupDraw(const DrawGroup& group);
[[nodiscard]] std::string NameOfOptionDraw(const DrawGroup& group,
                                           const GroupOption& option,
                                           const std::string& pointer);
/// @param object "person/1".
/// @param what A pointer into it, or "ahead_m".
[[nodiscard]] std::string NameOfObjectDraw(const std::string& object, const std::string& what);

/// Puts the recipe's values into a scenario: first what is set, then the groups, then the draws,
/// those nearest to the root first.
/// @return What was drawn, by the names of groups and by JSON pointer.
Json PutRecipeValues(const Recipe& recipe,
                     const KeyedDraws& draws,
                     std::uint32_t scenario,
                     const ForcedValues& forced,
                     DraftedScenario& draft);

}  // namespace railcast
