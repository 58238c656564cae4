#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/extras/recipe/distribution.h"
#include "core/extras/recipe/drafted_scenario.h"
#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/recipe_values.h"
#include "core/scenario/json_text.h"
#include "railcast/rail_world.h"

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

/// The moments at which placed objects are compared with all else.
struct MadeStamps {
  std::vector<std::uint32_t> frames;    ///< Frame 0 and those that are made.
  std::vector<std::int64_t> stamps_ns;  ///< Theirs.
};

/// How often an object is drawn anew until it finds a place.
inline constexpr std::uint32_t kMostAttempts = 100;

/// Places the recipe's objects in a scenario, one after the other. Each is drawn anew while it
/// touches or overlaps another object or the sensor's vehicle in any frame, is in a structure,
/// breaks the rule about what is in the way, or cannot stand there at all.
/// @param world The world of the draft without them.
/// @return A list of what was placed: name, s_m, ahead_m, attempt and what was drawn.
/// @throws InputError if an object finds no place.
[[nodiscard]] Json PlaceObjects(const Recipe& recipe,
                                const KeyedDraws& draws,
                                const MadeStamps& stamps,
                                std::shared_ptr<const RailWorld> world,
                                DraftedScenario& draft);

}  // namespace railcast
