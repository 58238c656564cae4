#include "core/extras/recipe/split_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>

#include "tests/core/extras/recipe/recipe_project.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

/// Plans of the project's recipe with other numbers and shares.
class SplitPlanTest : public testing::Test {
 protected:
  static nlohmann::json ByPlace() {
    nlohmann::json recipe = ProjectRecipe();
    recipe["num_scenarios"] = 20;
    recipe["start_s_m"] = {{"type", "uniform"}, {"min", 0}, {"max", 1000}};
    recipe["split"] = {{"by", "place"}, {"cell_m", 100}, {"sight_m", 20},
                       {"train", 0.7},  {"val", 0.15},   {"test", 0.15}};
    return recipe;
  }
  [[nodiscard]] Recipe Read(const nlohmann::json& recipe) const {
    return ReadProjectRecipe(directory_.path(), recipe);
  }
  [[nodiscard]] std::string Refusal(const nlohmann::json& recipe) const {
    return MessageOf([&] { (void)Read(recipe); });
  }
  /// "recipe.json: " with its path.
  [[nodiscard]] std::string Place() const {
    return (directory_.path() / "recipe.json").string() + ": ";
  }

  TemporaryDirectory directory_;
};

PerPart<double> SharesGiven(const SplitPlan& plan, std::uint32_t num_scenarios) {
  PerPart<double> shares{};
  for (std::uint32_t i = 0; i < num_scenarios; ++i) {
    shares.at(static_cast<std::size_t>(plan.PartOf(i))) += 1.0 / num_scenarios;
  }
  return shares;
}

TEST_F(SplitPlanTest, HoldsTheSharesOfManyRecipesWithinTwoPoints) {
  Recipe recipe = Read(ProjectRecipe());
  const RecipeBases bases(recipe);
  int num_refused = 0;
  for (const auto& [train, val] : {std::pair(0.7, 0.15), {0.8, 0.1}, {0.64, 0.32}, {0.78, 0.02}}) {
    recipe.split.train = train;
    recipe.split.val = val;
    recipe.split.test = 1.0 - train - val;
    for (std::uint32_t num = 1; num < 200; num += 1 + num / 10) {
      for (recipe.seed = 0; recipe.seed < 5; ++recipe.seed) {
        recipe.num_scenarios = num;
        if (QuotaFault(SharesOf(recipe.split), num)) {
          ++num_refused;
          continue;
        }
        const PerPart<double> given = SharesGiven(SplitPlan(recipe, bases), num);
        EXPECT_NEAR(given[0], train, kShareTolerance + 1e-9) << num;
        EXPECT_NEAR(given[1], val, kShareTolerance + 1e-9) << num;
      }
    }
  }
  EXPECT_GT(num_refused, 0);
}

TEST_F(SplitPlanTest, RefusesNumbersThatDoNotDivide) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 24;
  recipe["split"] = {{"train", 0.7}, {"val", 0.15}, {"test", 0.15}};
  EXPECT_EQ(Refusal(recipe),
            Place() +
                "/num_scenarios: must divide into train, val and test of 0.7, 0.15 and 0.15 "
                "within 0.02, as 21 and 25 do (got 24, at best divided into 17, 4 and 3)");
  // Where nothing is asked for, nothing is refused.
  recipe.erase("split");
  EXPECT_NO_THROW((void)Read(recipe));
}

TEST_F(SplitPlanTest, EachPartHasGroundOfItsOwn) {
  for (int seed = 0; seed < 10; ++seed) {
    nlohmann::json json = ByPlace();
    json["seed"] = seed;
    const Recipe recipe = Read(json);
    const SplitPlan plan(recipe, RecipeBases(recipe));
    std::set<Split> parts;
    for (double s_m = 10.0; s_m < 1000.0; s_m += 100.0) {
      parts.insert(plan.PartOf(0, {s_m, s_m + 80.0}).value());
    }
    EXPECT_EQ(parts.size(), kNumSplits);
  }
}

TEST_F(SplitPlanTest, GroundWhereNoScenarioStartsGoesWithTheNearestThatHasOne) {
  nlohmann::json json = ByPlace();
  json["start_s_m"] = {{"type", "choice"}, {"values", {250, 550, 850}}};
  const Recipe recipe = Read(json);
  const SplitPlan plan(recipe, RecipeBases(recipe));
  const auto part_at = [&](double s_m) { return plan.PartOf(0, {s_m, s_m}).value(); };
  for (const double s_m : {-500.0, 50.0, 150.0, 350.0}) EXPECT_EQ(part_at(s_m), part_at(250.0));
  for (const double s_m : {450.0, 650.0}) EXPECT_EQ(part_at(s_m), part_at(550.0));
  for (const double s_m : {750.0, 950.0, 5000.0}) EXPECT_EQ(part_at(s_m), part_at(850.0));
  EXPECT_EQ(plan.PartOf(0, {250.0, 550.0}), std::nullopt);
}

TEST_F(SplitPlanTest, DrawsEachBaseForThePartsThatItHasGroundOf) {
  nlohmann::json json = ByPlace();
  json["start_s_m"] = {{"type", "uniform"}, {"min", 0}, {"max", 900}};
  json["bases"] = {{{"file", "scenario.json"}, {"weight", 3}},
                   {{"file", "scenario.json"},
                    {"weight", 1},
                    {"start_s_m", {{"type", "choice"}, {"values", {950}}}}}};
  const Recipe recipe = Read(json);
  const SplitPlan plan(recipe, RecipeBases(recipe));
  double sum = 0.0;
  int num_parts_with_second = 0;
  for (const Split part : {Split::kTrain, Split::kVal, Split::kTest}) {
    EXPECT_GT(plan.BaseWeights(part)[0], 0.0);
    sum += plan.BaseWeights(part)[1];
    num_parts_with_second += plan.BaseWeights(part)[1] > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(num_parts_with_second, 1);
  EXPECT_DOUBLE_EQ(sum, 1.0);
}

TEST_F(SplitPlanTest, RefusesALineWithTooFewPlaces) {
  nlohmann::json recipe = ByPlace();
  recipe["split"]["cell_m"] = 600;
  EXPECT_EQ(Refusal(recipe),
            Place() +
                "/split: must have a place for each of train, val and test (got 2 cells of "
                "600 m where scenarios start; one sees 40 m, which cells must exceed)");
}

TEST_F(SplitPlanTest, RefusesPlacesThatAreTooShortForAScenario) {
  nlohmann::json recipe = ByPlace();
  recipe["split"]["cell_m"] = 30;
  recipe["split"]["sight_m"] = 100;
  EXPECT_EQ(Refusal(recipe),
            Place() +
                "/split: must have room for a scenario in the places of val (got 34 cells of "
                "30 m where scenarios start; one sees 200 m, which cells must exceed)");
}

}  // namespace
}  // namespace railcast
