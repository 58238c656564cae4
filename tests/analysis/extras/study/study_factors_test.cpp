#include "analysis/extras/study/study_factors.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/extras/study/approach_record.h"
#include "analysis/extras/study/study_report.h"

namespace railcast {
namespace {

// Approaches to a target that is detected at 100 m, by chance some 10 % off, in fog at half of
// that.
std::vector<ApproachRecord> FogApproaches(std::size_t num) {
  std::mt19937 random(5);
  std::normal_distribution<double> scatter(0.0, 0.1);
  std::uniform_real_distribution<double> unit;
  std::vector<ApproachRecord> approaches;
  for (std::size_t i = 0; i < num; ++i) {
    ApproachRecord approach{.scenario = static_cast<std::uint32_t>(i)};
    const bool is_fog = unit(random) < 0.5;
    approach.drawn["weather"] = is_fog ? "fog" : "clear";
    approach.drawn["/lidar/mount/roll_deg"] = unit(random);
    approach.drawn["/world/seed"] = i;
    StudiedObject object{.name = "person/1", .type = "person", .is_detected = true};
    object.distance_m = (is_fog ? 50.0 : 100.0) * std::exp(scatter(random));
    object.nearest_m = 10.0;
    object.farthest_m = 300.0;
    object.needed_m = 80.0;
    object.drawn["/person/clothing"] = unit(random) < 0.5 ? "plain" : "hi_vis";
    approach.objects.push_back(object);
    approaches.push_back(approach);
  }
  return approaches;
}

const FactorWeight* Find(const std::vector<FactorWeight>& weights, const std::string& name) {
  for (const FactorWeight& weight : weights) {
    if (weight.name == name) return &weight;
  }
  return nullptr;
}

TEST(StudyFactors, AreWhatDiffersButForSeeds) {
  const auto approaches = FogApproaches(100);
  std::vector<std::string> names;
  for (const Factor& factor : FactorsOf(ObservationsOf(approaches))) names.push_back(factor.name);
  EXPECT_EQ(names, (std::vector<std::string>{"weather", "/lidar/mount/roll_deg",
                                             "object /person/clothing"}));
}

TEST(StudyFactors, OfNumbersHaveThirdsAsLevels) {
  const auto approaches = FogApproaches(300);
  const auto observations = ObservationsOf(approaches);
  const Factor roll = FactorsOf(observations).at(1);
  ASSERT_EQ(roll.levels.size(), 3U);
  ASSERT_EQ(roll.numbers.size(), 300U);
  for (const std::size_t level : {0U, 1U, 2U}) {
    EXPECT_EQ(std::count(roll.level_of.begin(), roll.level_of.end(), level), 100);
  }
}

TEST(StudyFactors, ThatMatterWeighAndOthersDoNot) {
  const auto approaches = FogApproaches(600);
  const auto observations = ObservationsOf(approaches);
  const auto weights = WeighFactors(observations, FactorsOf(observations));
  ASSERT_EQ(weights.size(), 4U);
  EXPECT_EQ(weights[0].name, "distance");
  EXPECT_EQ(weights[1].name, "weather");
  EXPECT_LT(weights[1].p_value, 1e-6);
  double sum = 0.0;
  for (std::size_t i = 1; i < weights.size(); ++i) sum += weights[i].share;
  EXPECT_TRUE(std::isnan(weights[0].share));
  EXPECT_NEAR(sum, 1.0, 1e-12);
  for (const char* const name : {"/lidar/mount/roll_deg", "object /person/clothing"}) {
    EXPECT_GT(Find(weights, name)->p_value, 0.001) << name;
  }
}

// If nothing matters, the p-values are uniform: of 200 experiments, 5 % +- 3 standard deviations
// are below 0.05.
TEST(StudyFactors, ThatDoNotMatterAreRarelyTakenToMatter) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit;
  constexpr int kNumExperiments = 200;
  int num_rejected = 0;
  for (int experiment = 0; experiment < kNumExperiments; ++experiment) {
    std::vector<ApproachRecord> approaches(100);
    for (ApproachRecord& approach : approaches) {
      approach.drawn["kind"] = unit(random) < 0.5 ? "one" : "other";
      StudiedObject object{.name = "thing", .is_detected = true};
      object.distance_m = 30.0 * std::pow(10.0, unit(random));
      object.nearest_m = 30.0;
      object.farthest_m = 300.0;
      approach.objects.push_back(object);
    }
    const auto observations = ObservationsOf(approaches);
    const auto weights = WeighFactors(observations, FactorsOf(observations));
    num_rejected += Find(weights, "kind")->p_value < 0.05 ? 1 : 0;
  }
  const double expected = 0.05 * kNumExperiments;
  EXPECT_NEAR(num_rejected, expected, 3.0 * std::sqrt(expected * 0.95));
}

TEST(StudyFactors, AreNotWeighedWithTooFewApproaches) {
  const auto approaches = FogApproaches(30);
  const auto observations = ObservationsOf(approaches);
  EXPECT_TRUE(WeighFactors(observations, FactorsOf(observations)).empty());
}

// A recipe that draws a mount by name and a weather.
Json MountRecipe() {
  return Json::parse(R"({
    "groups": [
      {"name": "mount", "options": [
        {"name": "roof", "set": {"/lidar": {"mount": {"position_m": [0, 0, 3.6]}}}},
        {"name": "front", "set": {"/lidar/mount/position_m": [0, 0, 1.2]}}]},
      {"name": "weather", "options": [
        {"name": "clear", "set": {"/weather": {}}},
        {"name": "fog", "draws": {"/weather/visibility_m": {"type": "uniform"}}}]}
    ]
  })");
}

// Each target is detected at 80 m from the roof and at 60 m from the front, a metre more or less.
std::vector<ApproachRecord> MountApproaches() {
  std::vector<ApproachRecord> approaches;
  for (std::uint32_t i = 0; i < 40; ++i) {
    ApproachRecord approach{.scenario = i};
    const bool is_roof = i % 2 == 0;
    approach.drawn["mount"] = is_roof ? "roof" : "front";
    approach.drawn["weather"] = i % 4 < 2 ? "clear" : "fog";
    StudiedObject object{.name = "cube", .type = "box", .is_detected = true};
    object.distance_m = (is_roof ? 80.0 : 60.0) + (i % 8 < 4 ? 1.0 : -1.0);
    object.nearest_m = 10.0;
    object.farthest_m = 300.0;
    object.needed_m = 70.0;
    approach.objects.push_back(object);
    approaches.push_back(approach);
  }
  return approaches;
}

TEST(StudyPlacement, ListsWhatDetectsFirstAboveAllElse) {
  const auto approaches = MountApproaches();
  const auto observations = ObservationsOf(approaches);
  const Section section =
      PlacementSection(observations, FactorsOf(observations), {}, MountRecipe());
  const Table& table = section.tables.at(0);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(std::get<std::string>(table.rows[0].at(1)), "roof");
  EXPECT_EQ(std::get<std::string>(table.rows[1].at(1)), "front");
  EXPECT_DOUBLE_EQ(std::get<Estimate>(table.rows[0].at(5)).value, 80.0);
  EXPECT_DOUBLE_EQ(std::get<Estimate>(table.rows[1].at(5)).value, 60.0);
  EXPECT_EQ(std::get<Estimate>(table.rows[0].at(4)).value, 100.0);
  EXPECT_EQ(std::get<Estimate>(table.rows[1].at(4)).value, 0.0);
  ASSERT_EQ(section.charts.size(), 1U);
  EXPECT_EQ(section.charts[0].x.categories, (std::vector<std::string>{"roof", "front"}));
}

TEST(StudyPlacement, IsNoSectionWhereNothingOfTheSensorIsDrawn) {
  const auto approaches = MountApproaches();
  const auto observations = ObservationsOf(approaches);
  Json recipe = MountRecipe();
  recipe["groups"].erase(0);
  EXPECT_TRUE(PlacementSection(observations, FactorsOf(observations), {}, recipe).tables.empty());
}

/// Approaches to a person, each with its distance of detection; 0 = never.
std::vector<ApproachRecord> ApproachesThatDetectAt(const std::vector<double>& detected_m,
                                                   double needed_m) {
  std::vector<ApproachRecord> approaches;
  for (const double distance_m : detected_m) {
    StudiedObject object;
    object.name = "person";
    object.is_detected = distance_m > 0.0;
    object.distance_m = object.is_detected ? distance_m : std::numeric_limits<double>::quiet_NaN();
    object.nearest_m = 5.0;
    object.farthest_m = 200.0;
    object.needed_m = needed_m;
    ApproachRecord approach{.scenario = static_cast<std::uint32_t>(approaches.size()),
                            .objects = {object}};
    approaches.push_back(std::move(approach));
  }
  return approaches;
}

TargetResult TargetThatIsDetectedAt(const std::vector<double>& detected_m, double needed_m) {
  const std::vector<ApproachRecord> approaches = ApproachesThatDetectAt(detected_m, needed_m);
  return TargetsOf(ObservationsOf(approaches)).at(0);
}

/// 91, 92, ... in no order.
std::vector<double> DistancesBeyond90(int num) {
  std::vector<double> distances_m;
  for (int i = 0; i < num; ++i) distances_m.push_back(91.0 + (i * 27) % num);
  return distances_m;
}

TEST(StudyTargets, AreDetectedInTimeWhereAllApproachesDetectThemFartherAway) {
  const TargetResult target = TargetThatIsDetectedAt(DistancesBeyond90(64), 77.0);
  EXPECT_EQ(target.d90_95_m, 93.0);  // The third nearest of 64.
  EXPECT_EQ(AnswerOf(target.seen).words, "yes");
}

TEST(StudyTargets, AreDetectedTooLateOnlyIfTheRanksShowIt) {
  // The 10th of 64 distances is what 90 % do not exceed with 95 % confidence, or the 11th.
  EXPECT_EQ(AnswerOf(TargetThatIsDetectedAt(DistancesBeyond90(64), 150.0).seen).words, "no");
  EXPECT_EQ(AnswerOf(TargetThatIsDetectedAt(DistancesBeyond90(64), 95.0).seen).words, "not shown");
}

TEST(StudyTargets, HaveNoDistanceWhereTooManyApproachesDetectNothing) {
  std::vector<double> detected_m = DistancesBeyond90(64);
  detected_m[3] = detected_m[17] = 0.0;
  EXPECT_EQ(TargetThatIsDetectedAt(detected_m, 77.0).d90_95_m, 91.0);
  detected_m[40] = 0.0;
  const TargetResult target = TargetThatIsDetectedAt(detected_m, 77.0);
  EXPECT_TRUE(std::isnan(target.d90_95_m));
  EXPECT_EQ(AnswerOf(target.seen).words, "not shown");
}

TEST(StudyTargets, HaveNoAnswerOfFewerThan60Approaches) {
  const TargetResult target = TargetThatIsDetectedAt(DistancesBeyond90(59), 77.0);
  EXPECT_TRUE(std::isnan(target.d90_95_m));
  EXPECT_EQ(AnswerOf(target.seen).words, "too few approaches: 60 are needed");
}

TEST(StudyTargets, StandBesideTheDriverWhereHisDistanceIsPublished) {
  std::vector<TargetResult> targets(3);
  targets[0] = {.name = "walker", .type = "person", .d90_95_m = 120.0};
  targets[1] = {.name = "cube of 20 cm", .type = "box", .d90_95_m = 35.0};
  targets[2] = {.name = "wagon", .type = "open_wagon", .d90_95_m = 180.0};
  const Section section = YardsticksSection(targets);
  const Table& table = section.tables.at(0);
  ASSERT_EQ(table.rows.size(), 2U);  // No driver's distance of wagons is published.
  EXPECT_EQ(std::get<double>(table.rows[0][2]), 240.0);
  EXPECT_EQ(std::get<double>(table.rows[0][3]), 50.0);
  EXPECT_EQ(std::get<double>(table.rows[1][2]), 175.0);
  EXPECT_EQ(std::get<double>(table.rows[1][3]), 20.0);
}

}  // namespace
}  // namespace railcast
