#include "core/extras/recipe/recipe.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/drafted_scenario.h"
#include "core/extras/recipe/json_place.h"
#include "core/extras/recipe/object_placement.h"
#include "core/extras/recipe/recipe_files.h"
#include "core/extras/recipe/recipe_values.h"
#include "core/extras/recipe/split_plan.h"
#include "core/extras/recipe/split_quota.h"
#include "core/scenario/json_source.h"

namespace railcast {
namespace {

/// A place of the scenario that the recipe gives a value, and the key that gives it.
struct Written {
  std::string pointer;
  std::string recipe_pointer;
};

std::vector<Written> WrittenBy(const SetList& set, const std::string& place) {
  std::vector<Written> written;
  for (const PointedValue& value : set.values) {
    written.push_back({value.pointer, place + PointerStep(value.pointer)});
  }
  return written;
}

std::vector<Written> WrittenBy(const DrawList& draws, const std::string& place) {
  std::vector<Written> written;
  for (const PointedDraw& draw : draws.draws) {
    written.push_back({draw.pointer, place + PointerStep(draw.pointer)});
  }
  return written;
}

std::string IndexStep(std::size_t index) {
  return "/" + std::to_string(index);
}

/// Checks the rules that concern several keys.
class KeyCheck {
 public:
  KeyCheck(const Recipe& recipe, ErrorList& errors)
      : recipe_(recipe), shown_(ShownPath(recipe.file.lexically_normal())), errors_(errors) {}

  void Run() {
    CheckOverwriting();
    CheckNumbers();
    CheckSplit();
    CheckPlans();
  }

 private:
  void Add(const std::string& pointer, const std::string& rule, const std::string& value = "") {
    errors_.Add({shown_ + ": " + pointer, rule, value});
  }

  // What is put later must not hold the place of what was put earlier.
  void Follow(std::vector<Written>& earlier, const std::vector<Written>& later) {
    for (const Written& own : later) {
      for (const Written& other : earlier) {
        if (!LiesWithin(other.pointer, own.pointer)) continue;
        Add(own.recipe_pointer, "must not overwrite " + other.recipe_pointer);
        break;
      }
    }
    earlier.insert(earlier.end(), later.begin(), later.end());
  }

  void CheckOverwriting() {
    std::vector<Written> earlier;
    Follow(earlier, WrittenBy(recipe_.set, "/set"));
    for (std::size_t i = 0; i < recipe_.groups.size(); ++i) {
      const DrawGroup& group = recipe_.groups[i];
      const std::string place = "/groups" + IndexStep(i);
      std::vector<Written> after = earlier;
      if (!group.random_weather.empty()) Follow(after, {{"/weather", place + "/random_weather"}});
      for (std::size_t j = 0; j < group.options.size(); ++j) {
        const std::string option = place + "/options" + IndexStep(j);
        std::vector<Written> of_option = earlier;
        Follow(of_option, WrittenBy(group.options[j].set, option + "/set"));
        Follow(of_option, WrittenBy(group.options[j].draws, option + "/draws"));
        const auto begin = of_option.begin() + static_cast<std::ptrdiff_t>(earlier.size());
        after.insert(after.end(), begin, of_option.end());
      }
      earlier = std::move(after);
    }
    const std::vector<Written> drawn = WrittenBy(recipe_.draws, "/draws");
    std::vector<Written> all = earlier;
    for (const Written& own : drawn) {
      std::vector<Written> others = earlier;
      Follow(others, {own});
    }
    all.insert(all.end(), drawn.begin(), drawn.end());
    if (recipe_.start_s_m) Follow(all, {{"/vehicle/start_s_m", "/start_s_m"}});
    for (std::size_t i = 0; i < recipe_.bases.size(); ++i) {
      if (!recipe_.bases[i].start_s_m) continue;
      std::vector<Written> others = drawn;
      others.insert(others.end(), earlier.begin(), earlier.end());
      Follow(others, {{"/vehicle/start_s_m", recipe_.bases[i].pointer + "/start_s_m"}});
    }
  }

  void CheckNumber(const Distribution& distribution,
                   const std::string& place,
                   const std::string& rule,
                   const std::function<bool(double)>& holds) {
    for (const Json& value : ExtremesOf(distribution)) {
      if (value.is_number() && holds(value.get<double>())) continue;
      return Add(place, rule, ValueText(value));
    }
  }

  void CheckNumbers() {
    const auto is_any = [](double) { return true; };
    const auto is_count = [](double value) {
      constexpr double kMostObjects = 1000.0;
      return value >= 0.0 && value <= kMostObjects && std::floor(value) == value;
    };
    if (recipe_.start_s_m) {
      CheckNumber(*recipe_.start_s_m, "/start_s_m", "must give numbers", is_any);
    }
    for (std::size_t i = 0; i < recipe_.bases.size(); ++i) {
      if (!recipe_.bases[i].start_s_m) continue;
      CheckNumber(*recipe_.bases[i].start_s_m, recipe_.bases[i].pointer + "/start_s_m",
                  "must give numbers", is_any);
    }
    for (std::size_t i = 0; i < recipe_.objects.size(); ++i) {
      const PlacedObjects& objects = recipe_.objects[i];
      const std::string place = "/objects" + IndexStep(i);
      CheckNumber(objects.ahead_m, place + "/ahead_m", "must give numbers", is_any);
      const bool may_be_broken = std::holds_alternative<UniformDraw>(objects.count) ||
                                 std::holds_alternative<NormalDraw>(objects.count) ||
                                 std::holds_alternative<LogUniformDraw>(objects.count);
      if (may_be_broken) {
        Add(place + "/count", "must be of type \"integer\" or \"choice\"");
      } else {
        CheckNumber(objects.count, place + "/count", "must give whole numbers from 0 to 1000",
                    is_count);
      }
    }
  }

  void CheckSplit() {
    const PerPart<double> shares = SharesOf(recipe_.split);
    if (recipe_.has_split) {
      if (const auto fault = QuotaFault(shares, recipe_.num_scenarios))
        Add("/num_scenarios", *fault);
    }
    if (recipe_.split.by != SplitBy::kScenario) CheckLinesAreFixed();
    for (std::size_t i = 0; i < recipe_.bases.size(); ++i) {
      if (!recipe_.bases[i].split) continue;
      const std::string place = recipe_.bases[i].pointer + "/split";
      if (recipe_.split.by != SplitBy::kLine) {
        Add(place, "must be given with /split/by \"line\" only");
      } else if (shares[static_cast<std::size_t>(*recipe_.bases[i].split)] == 0.0) {
        Add(place, "must be a part that has a share", ValueText(NameOf(*recipe_.bases[i].split)));
      }
    }
  }

  /// What the options of groups and the draws give.
  [[nodiscard]] std::vector<Written> Drawn() const {
    std::vector<Written> drawn = WrittenBy(recipe_.draws, "/draws");
    for (std::size_t i = 0; i < recipe_.groups.size(); ++i) {
      for (std::size_t j = 0; j < recipe_.groups[i].options.size(); ++j) {
        const GroupOption& option = recipe_.groups[i].options[j];
        const std::string place = "/groups" + IndexStep(i) + "/options" + IndexStep(j);
        for (const auto& of_option :
             {WrittenBy(option.set, place + "/set"), WrittenBy(option.draws, place + "/draws")}) {
          drawn.insert(drawn.end(), of_option.begin(), of_option.end());
        }
      }
    }
    return drawn;
  }

  // What follows from the recording cannot be drawn for it.
  void CheckPlans() {
    const auto is_plan = [](const RecipeBase& base) { return base.run != nullptr; };
    if (std::ranges::none_of(recipe_.bases, is_plan)) return;
    if (!std::ranges::all_of(recipe_.bases, is_plan)) {
      return Add("/bases", "must be either all plans with recordings or all scenarios");
    }
    if (recipe_.stride != 1) Add("/stride", "must be 1 with plans", NumberText(recipe_.stride));
    if (recipe_.warm_up_frames != 0) {
      Add("/warm_up_frames", "must be 0 with plans", NumberText(recipe_.warm_up_frames));
    }
    if (recipe_.sensor) Add("/sensor", "must be left out: plans have one sensor");
    if (recipe_.start_s_m) Add("/start_s_m", "must be left out: plans begin in any frame");
    for (const RecipeBase& base : recipe_.bases) {
      const std::uint32_t num = base.run->num_frames();
      if (base.start_s_m) {
        Add(base.pointer + "/start_s_m", "must be left out: plans begin in any frame");
      }
      if (num >= recipe_.num_frames) continue;
      Add(base.recording_pointer, "must have at least the recipe's " +
                                      NumberText(recipe_.num_frames) + " frames (got " +
                                      NumberText(num) + ")");
    }
    std::vector<Written> written = WrittenBy(recipe_.set, "/set");
    for (const Written& own : Drawn()) written.push_back(own);
    for (const Written& own : written) {
      for (const std::string_view fixed : {"/world/recording", "/lidar/mount", "/lidar/scan"}) {
        if (!LiesWithin(own.pointer, fixed) && !LiesWithin(fixed, own.pointer)) continue;
        Add(own.recipe_pointer, "must be given in the plan: the recording's line depends on it");
        break;
      }
    }
  }

  // Only lines that are known beforehand can be divided so that the shares hold.
  void CheckLinesAreFixed() {
    constexpr std::string_view kLine = "/world/alignment";
    for (const Written& own : Drawn()) {
      if (!LiesWithin(own.pointer, kLine) && !LiesWithin(kLine, own.pointer)) continue;
      Add(own.recipe_pointer, "must not draw the line with /split/by \"" +
                                  std::string(NameOf(recipe_.split.by)) +
                                  "\"; bases may have lines of their own");
    }
  }

  const Recipe& recipe_;
  std::string shown_;
  ErrorList& errors_;
};

/// Reads scenarios with the extremes of all draws.
class ExtremesCheck {
 public:
  ExtremesCheck(const Recipe& recipe, ErrorList& errors)
      : recipe_(recipe), bases_(recipe), draws_(recipe.seed, 0), errors_(errors) {}

  void Run() {
    CheckPins();
    for (base_ = 0; base_ < recipe_.bases.size(); ++base_) {
      usual_.reset();
      Try({});
      for (const PointedDraw& draw : recipe_.draws.draws) {
        for (const Json& value : ExtremesOf(draw.distribution)) Try({{draw.pointer, value}});
      }
      for (const DrawGroup& group : recipe_.groups) TryGroup(group);
      for (std::size_t i = 0; i < recipe_.objects.size(); ++i) TryObjects(i);
    }
  }

 private:
  // Bases on one line must not be pinned to several parts.
  void CheckPins() {
    for (std::size_t i = 1; i < recipe_.bases.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (recipe_.bases[i].split == recipe_.bases[j].split) continue;
        if (LineOf(i) != LineOf(j)) continue;
        errors_.Add({ShownPath(recipe_.file.lexically_normal()) + ": " + recipe_.bases[i].pointer +
                         "/split",
                     "must be that of " + recipe_.bases[j].pointer + ", which is on the same line",
                     ""});
      }
    }
  }

  [[nodiscard]] std::string LineOf(std::size_t base) const {
    const DraftedScenario draft(recipe_, {}, bases_.json(base), base);
    return LineHash(Json::parse(ResolvedScenarioJson(draft.OnLine(draft.Read()))));
  }

  // Forces the first extreme of each draw unless another value is forced: so a faulty one gives the
  // same line again and again, which is listed once.
  [[nodiscard]] ForcedValues WithFirstExtremes(ForcedValues forced) const {
    for (const PointedDraw& draw : recipe_.draws.draws) {
      forced.emplace(draw.pointer, ExtremesOf(draw.distribution).front());
    }
    for (const DrawGroup& group : recipe_.groups) {
      for (const GroupOption& option : group.options) {
        for (const PointedDraw& draw : option.draws.draws) {
          forced.emplace(NameOfOptionDraw(group, option, draw.pointer),
                         ExtremesOf(draw.distribution).front());
        }
      }
    }
    return forced;
  }

  void TryGroup(const DrawGroup& group) {
    const std::string name = NameOfGroupDraw(group);
    for (const std::string& family : group.random_weather) Try({{name, family}});
    for (const GroupOption& option : group.options) {
      Try({{name, option.name}});
      for (const PointedDraw& draw : option.draws.draws) {
        const std::string inner = NameOfOptionDraw(group, option, draw.pointer);
        for (const Json& value : ExtremesOf(draw.distribution)) {
          Try({{name, option.name}, {inner, value}});
        }
      }
    }
  }

  void TryObjects(std::size_t index) {
    const PlacedObjects& objects = recipe_.objects[index];
    TryObject(index, {});
    for (const PointedDraw& draw : objects.draws.draws) {
      for (const Json& value : ExtremesOf(draw.distribution)) {
        TryObject(index, {{draw.pointer, value}});
      }
    }
  }

  [[nodiscard]] DraftedScenario Draft(const ForcedValues& forced) const {
    DraftedScenario draft(recipe_, {}, bases_.json(base_), base_);
    static_cast<void>(PutRecipeValues(recipe_, draws_, 0, WithFirstExtremes(forced), draft));
    return draft;
  }

  void Try(const ForcedValues& forced) {
    static_cast<void>(Attempt("", errors_, [&] {
      const DraftedScenario draft = Draft(forced);
      return draft.OnLine(draft.Read());
    }));
  }

  void TryObject(std::size_t index, const ForcedValues& forced) {
    static_cast<void>(Attempt("", errors_, [&] {
      if (!usual_) usual_ = Draft({});
      DraftedScenario draft = *usual_;
      ForcedValues all = forced;
      for (const PointedDraw& draw : recipe_.objects[index].draws.draws) {
        all.emplace(draw.pointer, ExtremesOf(draw.distribution).front());
      }
      const ObjectDraw drawn = DrawObject(recipe_, index, {draws_, 1, 0, all}, draft);
      AddObject(drawn, recipe_, index, draft);
      return draft.Read();
    }));
  }

  const Recipe& recipe_;
  RecipeBases bases_;
  KeyedDraws draws_;
  ErrorList& errors_;
  std::size_t base_ = 0;
  std::optional<DraftedScenario> usual_;  ///< The base to which objects are added.
};

}  // namespace

void CheckRecipe(const Recipe& recipe) {
  ErrorList errors;
  KeyCheck(recipe, errors).Run();
  errors.ThrowIfAny();
  ExtremesCheck(recipe, errors).Run();
  errors.ThrowIfAny();
  static_cast<void>(SplitPlan(recipe, RecipeBases(recipe)));
}

}  // namespace railcast
