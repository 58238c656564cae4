#include "analysis/extras/study/study_factors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

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

}  // namespace
}  // namespace railcast
