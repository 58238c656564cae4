#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/recipe.h"
#include "core/scenario/json_text.h"
#include "railcast/error.h"
#include "railcast/scenario.h"

namespace railcast {

/// The JSON of a scenario while a recipe's values are put into it. Remembers which key of the
/// recipe each value comes from, so that faults name it.
class DraftedScenario {
 public:
  /// @param number Of the scenario, for messages; absent while the recipe is checked.
  /// @param base The resolved base, and its index.
  DraftedScenario(const Recipe& recipe,
                  std::optional<std::uint32_t> number,
                  const Json& base,
                  std::size_t base_index);

  /// Puts a value at a place. A file that an earlier value names is read first if the place is
  /// inside that value.
  /// @param recipe_pointer The key of the recipe that the value comes from.
  /// @throws InputError "recipe: /draws/...: rule" if there is no such place.
  void Set(const std::string& pointer, const Json& value, const std::string& recipe_pointer);

  /// Says that the value at a place comes from a key of the recipe.
  void Note(const std::string& pointer, const std::string& recipe_pointer);

  /// Reads the scenario as any other. Names of files are relative to the recipe's folder.
  /// @throws InputError as ReadScenario(), but with the recipe's keys as places.
  [[nodiscard]] ScenarioSpec Read() const;

  /// A plan that was read, with the line of its recording in place of that; other scenarios as they
  /// are.
  /// @throws InputError as OnRecordedLine(), but with the recipe's keys as places.
  [[nodiscard]] ScenarioSpec OnLine(ScenarioSpec scenario) const;
  [[nodiscard]] bool is_plan() const { return run_ != nullptr; }

  /// Where the vehicle of a plan is when its first frame begins: places of objects count from
  /// there.
  struct Start {
    double s_m{};
    double direction = 1.0;  ///< 1 where the vehicle faces rising chainage, else -1.
    double time_s{};         ///< By the clock of the recording.
  };
  void StartAt(const Start& start) { start_ = start; }
  /// The scenario's own start unless StartAt() was called.
  [[nodiscard]] Start start() const;

  /// Returns what `work` on the scenario that was read returns.
  /// @throws InputError as `work`, but with the recipe's keys as places.
  template <class Work>
  decltype(auto) Located(const Work& work) const {
    try {
      return work();
    } catch (const InputError& error) {
      throw InputError(InRecipe(error));
    }
  }

  /// A fault of this scenario at a key of the recipe.
  [[nodiscard]] Fault FaultAt(const std::string& recipe_pointer, const std::string& rule) const;

  [[nodiscard]] Json& json() { return json_; }

 private:
  struct Origin {
    std::string pointer;
    std::string recipe_pointer;
  };
  [[nodiscard]] std::vector<Fault> InRecipe(const InputError& error) const;
  [[nodiscard]] std::string RecipePointerOf(const std::string& pointer) const;
  void ResolveFiles();

  std::filesystem::path file_;  ///< The recipe.
  std::string shown_;           ///< The recipe's name in messages.
  std::string number_;          ///< "scenario 12: ", or nothing.
  Json json_;
  std::vector<Origin> origins_;
  std::vector<std::string> unread_;  ///< Places whose values name files.
  const RecordedBase* run_;          ///< The recording of a plan; null for a scenario.
  std::optional<Start> start_;
};

}  // namespace railcast
