#include "analysis/extras/study/rare_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/input_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/extras/study/study_project.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

// Fog is drawn and a normal number; the worker beside the track is left out.
nlohmann::json RareRecipe() {
  nlohmann::json recipe = StudiedRecipe(10);
  recipe["groups"][0]["options"][0]["weight"] = 3;
  recipe["groups"][0]["options"][1] = nlohmann::json::parse(
      R"({"name": "fog", "draws": {"/weather/visibility_m": {"type": "log_uniform", "min": 40, "max": 400}}})");
  recipe["draws"]["/weather/wetness"] = {
      {"type", "normal"}, {"mean", 0.5}, {"sd", 0.3}, {"min", 0}, {"max", 1}};
  recipe["objects"].erase(1);
  return recipe;
}

class RareStudyTest : public testing::Test {
 protected:
  static constexpr std::uint32_t kMostApproaches = 40;
  [[nodiscard]] std::filesystem::path Path(const std::string& name) const {
    return directory_.path() / name;
  }
  [[nodiscard]] std::filesystem::path Write() const {
    return WriteStudy(directory_.path(), RareRecipe());
  }
  /// Seeks the failures of a study that Write() wrote.
  [[nodiscard]] static std::optional<RareStudy> Run(const std::filesystem::path& file,
                                                    const StudyChoices& choices,
                                                    const StudyHooks& hooks = NoStudyHooks()) {
    StudySpec study = ReadStudy(file);
    study.rare = RareSpec{.cheap = "geometry", .per_stage = 10, .most_approaches = kMostApproaches};
    const Recipe recipe = ReadStudyRecipe(study);
    return RunRareStudy(study, ScenarioDrawer(recipe), choices, hooks);
  }
  [[nodiscard]] std::string Lines(const std::string& folder) const {
    return ReadFileWhole(Path(folder) / "approaches.jsonl");
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(RareStudyTest, GivesTheRecipeTheValuesOfAPoint) {
  const Recipe recipe = ReadStudyRecipe(ReadStudy(Write()));
  const auto factors = FactorsOfRecipe(recipe);
  ASSERT_EQ(factors.size(), 5U);
  EXPECT_EQ(factors[0].law.probabilities, (std::vector<double>{0.75, 0.25}));
  EXPECT_EQ(factors[1].shown, "/weather/visibility_m");
  EXPECT_EQ(factors[1].law.only_with->value, 1U);
  EXPECT_EQ(factors[3].shown, "person/1 /d_m");
  // The medians of all numbers, in fog, and the second physique.
  const ScenarioDrawer drawer(recipe);
  const DrawnScenario drawn = drawer.Draw(17, QuantilesAt(factors, {1, 0, 0, 0, 1}));
  std::map<std::string, Json> values(drawn.record.drawn.begin(), drawn.record.drawn.end());
  EXPECT_EQ(values.at("weather"), "fog");
  EXPECT_NEAR(values.at("/weather/visibility_m").get<double>(), std::sqrt(40.0 * 400.0), 1e-6);
  EXPECT_NEAR(values.at("/weather/wetness").get<double>(), 0.5, 1e-6);
  const Json& placed = drawn.record.placed.at(0);
  if (placed.at("attempt") == 1) {
    EXPECT_NEAR(placed.at("drawn").at("/d_m").get<double>(), 0.0, 1e-6);
    EXPECT_EQ(placed.at("drawn").at("/person/physique"), "child");
  }
  // What is no factor is drawn as ever.
  EXPECT_EQ(drawn.record.seed, drawer.Draw(17).record.seed);
}

TEST_F(RareStudyTest, GivesTheSameLinesOnAnyNumberOfThreadsAndAfterAStop) {
  const auto file = Write();
  const auto whole = Run(file, {.directory = Path("one"), .num_threads = 1});
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->cheap, "geometry");
  EXPECT_EQ(whole->dear, "surface");
  EXPECT_EQ(whole->approaches.size(), whole->run.trials.size());
  EXPECT_LE(whole->approaches.size(), kMostApproaches);
  EXPECT_EQ(whole->num_made, whole->approaches.size());
  EXPECT_GT(whole->run.figure.correction.num, 0U);
  ASSERT_TRUE(Run(file, {.directory = Path("three"), .num_threads = 3}));
  EXPECT_EQ(Lines("three"), Lines("one"));
  int num_asked = 0;
  const StudyHooks stop = {[](std::uint32_t, std::uint32_t) {}, [&] { return ++num_asked > 150; }};
  EXPECT_FALSE(Run(file, {.directory = Path("begun"), .num_threads = 1}, stop));
  const auto rest = Run(file, {.directory = Path("begun"), .num_threads = 1});
  ASSERT_TRUE(rest);
  EXPECT_LT(rest->num_made, whole->num_made);
  EXPECT_EQ(Lines("begun"), Lines("one"));
  // A plain study does not go on with it.
  EXPECT_THROW((void)RunStudyIn(file, {.directory = Path("one"), .num_threads = 1}), InputError);
}

TEST_F(RareStudyTest, RefusesMoreUnseenApproachesThanThereMayBe) {
  const auto file = Write();
  nlohmann::json study = nlohmann::json::parse(ReadFileWhole(file));
  study["rare"] = {{"most_approaches", 4000}, {"unseen", 1e-3}};
  std::ofstream(file) << study;
  EXPECT_EQ(MessageOf([&] { (void)ReadStudy(file); }),
            file.string() + ": /rare/unseen: must be at least 12 / most_approaches (got 0.001)");
}

TEST_F(RareStudyTest, RefusesOnTheCommandLineWhatIsNoShareOfItsRange) {
  const auto file = Write();
  nlohmann::json study = nlohmann::json::parse(ReadFileWhole(file));
  study["rare"] = {{"most_approaches", 4000}};
  std::ofstream(file) << study;
  for (const std::string unseen : {"nan", "inf", "0", "-0.01", "0.002", "0.2"}) {
    const Ended run = Analyze("study " + file.string() + " --out " + Path("out").string() +
                              " --unseen=" + unseen);
    EXPECT_NE(run.status, 0);
    EXPECT_EQ(run.said, "--unseen: must be from 0.003 to 0.1 (got " + unseen + ")\n");
    EXPECT_FALSE(exists(Path("out")));
  }
}

TEST_F(RareStudyTest, RefusesRecipesOfSeveralRungs) {
  const auto message_of = [&](const std::string& folder, const nlohmann::json& rungs) {
    nlohmann::json recipe = RareRecipe();
    std::filesystem::create_directories(Path(folder));
    recipe["draws"]["/fidelity"] = {{"type", "choice"}, {"values", rungs}};
    const auto file = WriteStudy(Path(folder), recipe);
    return MessageOf([&] { (void)Run(file, {.directory = Path(folder + "_out")}); });
  };
  EXPECT_THAT(message_of("two", {"surface", "footprint"}),
              testing::HasSubstr("/fidelity: must be the same in all scenarios with --rare"));
  EXPECT_THAT(message_of("auto", {"auto"}), testing::HasSubstr("/fidelity: must name a rung"));
}

}  // namespace
}  // namespace railcast
