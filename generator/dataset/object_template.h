#pragma once

#include <cstdint>
#include <string>

#include "core/scenario/json_text.h"
#include "generator/dataset/drafted_scenario.h"
#include "generator/dataset/keyed_draws.h"
#include "generator/dataset/recipe.h"
#include "generator/dataset/recipe_values.h"

namespace railcast {

/// Which object is drawn, and how.
struct ObjectTurn {
  const KeyedDraws& draws;
  std::uint32_t number{};   ///< 1 for the first of its kind.
  std::uint32_t attempt{};  ///< Each draws anew.
  const ForcedValues& forced;
};

/// An object as drawn.
struct ObjectDraw {
  Json object;  ///< As in world.objects.
  Json drawn;   ///< What was drawn, by JSON pointer.
  double ahead_m{};
};

/// Draws one of recipe.objects[index].
/// @param draft The scenario that it belongs to, for the vehicle's place.
/// @throws InputError if a draw points to nothing.
[[nodiscard]] ObjectDraw DrawObject(const Recipe& recipe,
                                    std::size_t index,
                                    const ObjectTurn& turn,
                                    DraftedScenario& draft);

/// Adds the object to the scenario.
void AddObject(const ObjectDraw& drawn,
               const Recipe& recipe,
               std::size_t index,
               DraftedScenario& draft);

}  // namespace railcast
