#include "core/extras/recipe/recipe_values.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/extras/recipe/random_weather.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

/// Puts the values of one scenario.
class ValuePutter {
 public:
  ValuePutter(const KeyedDraws& draws,
              std::uint32_t scenario,
              const ForcedValues& forced,
              DraftedScenario& draft)
      : draws_(draws), scenario_(scenario), forced_(forced), draft_(draft) {}

  void PutSet(const SetList& set, const std::string& recipe_pointer) {
    for (const auto& [pointer, value] : set.values) {
      draft_.Set(pointer, value, recipe_pointer + PointerStep(pointer));
    }
  }

  void PutDraw(const PointedDraw& draw, const std::string& name, const std::string& list) {
    const auto known = forced_.find(name);
    const Json value =
        known == forced_.end() ? DrawValue(draw.distribution, draws_, name) : known->second;
    draft_.Set(draw.pointer, value, list + PointerStep(draw.pointer));
    drawn_[draw.pointer] = value;
  }

  void PutGroup(const DrawGroup& group, const std::string& recipe_pointer) {
    if (!group.random_weather.empty()) return PutWeather(group, recipe_pointer);
    const std::size_t index = IndexOfOption(group);
    const GroupOption& option = group.options[index];
    const std::string place = recipe_pointer + "/options/" + std::to_string(index);
    drawn_[group.name] = option.name;
    PutSet(option.set, place + "/set");
    for (const PointedDraw& draw : option.draws.draws) {
      PutDraw(draw, NameOfOptionDraw(group, option, draw.pointer), place + "/draws");
    }
  }

  [[nodiscard]] Json Take() { return std::move(drawn_); }

 private:
  [[nodiscard]] std::size_t IndexOfOption(const DrawGroup& group) const {
    const std::string name = NameOfGroupDraw(group);
    if (const auto known = forced_.find(name); known != forced_.end()) {
      const auto option =
          std::ranges::find(group.options, known->second.get<std::string>(), &GroupOption::name);
      return static_cast<std::size_t>(option - group.options.begin());
    }
    std::vector<double> weights;
    for (const GroupOption& option : group.options) weights.push_back(option.weight);
    return IndexByWeight(weights, draws_.Unit(name));
  }

  void PutWeather(const DrawGroup& group, const std::string& recipe_pointer) {
    std::vector<WeatherFamily> families;
    const std::string name = NameOfGroupDraw(group);
    const auto known = forced_.find(name);
    for (const std::string& family : group.random_weather) {
      const bool is_possible = known == forced_.end() || known->second == family;
      if (is_possible) families.push_back(ValueNamed<WeatherFamily>(family).value());
    }
    const RandomWeather weather = DrawWeather(draws_.Seed(name), scenario_, families);
    draft_.Set("/weather", weather.section, recipe_pointer + "/random_weather");
    drawn_[group.name] = NameOf(weather.family);
  }

  const KeyedDraws& draws_;
  std::uint32_t scenario_;
  const ForcedValues& forced_;
  DraftedScenario& draft_;
  Json drawn_ = Json::object();
};

}  // namespace

std::string NameOfGroupDraw(const DrawGroup& group) {
  return "group\n" + group.name;
}

std::string NameOfOptionDraw(const DrawGroup& group,
                             const GroupOption& option,
                             const std::string& pointer) {
  return "group\n" + group.name + "\n" + option.name + "\n" + pointer;
}

std::string NameOfObjectDraw(const std::string& object, const std::string& what) {
  return "object\n" + object + "\n" + what;
}

Json PutRecipeValues(const Recipe& recipe,
                     const KeyedDraws& draws,
                     std::uint32_t scenario,
                     const ForcedValues& forced,
                     DraftedScenario& draft) {
  ValuePutter putter(draws, scenario, forced, draft);
  putter.PutSet(recipe.set, "/set");
  for (std::size_t i = 0; i < recipe.groups.size(); ++i) {
    putter.PutGroup(recipe.groups[i], "/groups/" + std::to_string(i));
  }
  std::vector<const PointedDraw*> by_depth;
  for (const PointedDraw& draw : recipe.draws.draws) by_depth.push_back(&draw);
  std::ranges::stable_sort(
      by_depth, {}, [](const PointedDraw* draw) { return std::ranges::count(draw->pointer, '/'); });
  for (const PointedDraw* draw : by_depth) putter.PutDraw(*draw, draw->pointer, "/draws");
  return putter.Take();
}

}  // namespace railcast
