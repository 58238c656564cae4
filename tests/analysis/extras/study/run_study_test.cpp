#include "analysis/extras/study/run_study.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "analysis/extras/study/approach_scan.h"
#include "core/base/text.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/io/run/object_survey.h"
#include "railcast/simulator.h"
#include "tests/analysis/extras/study/study_project.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

class Study : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path Path(const std::string& name) const {
    return directory_.path() / name;
  }
  [[nodiscard]] std::filesystem::path Write(std::uint32_t num_scenarios) const {
    return WriteStudy(directory_.path(), StudiedRecipe(num_scenarios));
  }
  /// Lets a study that Write() wrote ask about some objects.
  static void Ask(const std::filesystem::path& file, const std::vector<std::string>& objects) {
    nlohmann::json study = nlohmann::json::parse(ReadFileWhole(file));
    study["objects"] = objects;
    WriteFileWhole(file, study.dump());
  }
  [[nodiscard]] std::string Lines(const std::string& folder) const {
    return ReadFileWhole(Path(folder) / "approaches.jsonl");
  }

 private:
  TemporaryDirectory directory_;
};

// As `detect` reads it from a sequence, whose frames are whole.
RunCourses CoursesOfWholeFrames(const ScenarioSpec& scenario, std::uint32_t num_frames) {
  const auto simulator = MakeSimulator(scenario, 2);
  const auto world = MakeWorld(scenario);
  const OwnTrack track(*world, scenario.world.catenary);
  ObjectSurvey survey(simulator->world(), LabelTable(scenario.labels), scenario.lidar.range_max_m,
                      scenario.output);
  RunCourses courses;
  RecordedFrame recorded;
  for (std::uint32_t index = 0; index < num_frames; ++index) {
    simulator->Scan(index, recorded.frame);
    const auto described = survey.Describe(
        recorded.frame, std::vector<ObjectView>(simulator->world().objects().size()));
    recorded.objects.clear();
    for (const ObjectInFrame& object : described) {
      recorded.objects.push_back(
          {.name = object.name,
           .type = object.type,
           .label = object.label,
           .size_m = object.size_m,
           .sensor_from_box = recorded.frame.world_from_sensor.inverse() * object.world_from_box,
           .velocity_world_mps = object.velocity_world_mps,
           .points = object.points});
    }
    AddFrame(recorded, VehicleFromSensor(scenario.lidar.mount), track, courses);
  }
  return courses;
}

void ExpectSameDetection(const ObjectDetection& one, const ObjectDetection& other) {
  EXPECT_EQ(one.fate, other.fate);
  EXPECT_EQ(one.frame, other.frame);
  EXPECT_EQ(one.missed_frame, other.missed_frame);
  EXPECT_EQ(one.is_from_start, other.is_from_start);
  if (one.fate == Fate::kDetected) {
    EXPECT_EQ(one.distance_m, other.distance_m);
  }
  EXPECT_EQ(one.needed_m, other.needed_m);
  EXPECT_EQ(one.from_axis_m, other.from_axis_m);
}

TEST_F(Study, FindsTheVerdictsOfWholeFrames) {
  const StudySpec study = ReadStudy(Write(8));
  const Recipe recipe = ReadStudyRecipe(study);
  const ScenarioDrawer drawer(recipe);
  ApproachScanner scanner(2);
  std::vector<std::uint32_t> frames;
  for (std::uint32_t i = 0; i < recipe.num_frames; ++i) frames.push_back(i);
  std::size_t num_detected = 0;
  for (std::uint32_t number = 0; number < recipe.num_scenarios; ++number) {
    const ScenarioSpec scenario = drawer.Draw(number).scenario;
    const auto courses =
        scanner.Follow(scenario, frames, study.detect.rule, [] { return false; }).value();
    const RunCourses whole = CoursesOfWholeFrames(scenario, recipe.num_frames);
    ASSERT_EQ(courses.objects.size(), whole.objects.size());
    for (const auto& [name, course] : whole.objects) {
      const ObjectDetection expected =
          DetectObject(course, study.detect.rule, study.detect.braking, {});
      if (!expected.is_in_way) continue;
      num_detected += expected.fate == Fate::kDetected ? 1U : 0U;
      SCOPED_TRACE(name + " of scenario " + std::to_string(number));
      ExpectSameDetection(
          DetectObject(courses.objects.at(name), study.detect.rule, study.detect.braking, {}),
          expected);
    }
  }
  EXPECT_GE(num_detected, 4U);
  // Of 60 frames, those after the detection are left out, and those out of range.
  EXPECT_LT(scanner.effort().num_traced, 8U * 50U);
}

TEST_F(Study, SharesTheGeometryOfTheLineAmongTrains) {
  const StudySpec study = ReadStudy(Write(1));
  const Recipe recipe = ReadStudyRecipe(study);
  ScenarioSpec scenario = ScenarioDrawer(recipe).Draw(0).scenario;
  scenario.world.objects.clear();
  TrainSpec train;
  train.name = "wagons";
  train.vehicles.resize(2);
  for (TrainVehicleSpec& vehicle : train.vehicles) vehicle.type = TypeNamed("open_wagon");
  scenario.world.trains = {train};
  std::vector<std::uint32_t> frames;
  for (std::uint32_t i = 0; i < 20; ++i) frames.push_back(i);
  const auto points_at = [&](double s_m, ApproachScanner& scanner) {
    scenario.world.trains[0].s_m = s_m;
    const auto courses =
        scanner.Follow(scenario, frames, {.min_points = 400}, [] { return false; });
    std::vector<std::uint32_t> points;
    for (const auto& [name, course] : courses.value().objects) {
      for (const Sighting& sighting : course.sightings) points.push_back(sighting.points);
    }
    return points;
  };
  ApproachScanner kept(2);
  const auto first = points_at(430.0, kept);
  scenario.world.trains[0].s_m = 425.0;
  EXPECT_TRUE(kept.HasSceneOf(scenario));
  ApproachScanner fresh(2);
  const auto second = points_at(425.0, fresh);
  EXPECT_GT(std::ranges::max(second), 100U);
  EXPECT_NE(first, second);
  EXPECT_EQ(points_at(425.0, kept), second);
}

TEST_F(Study, FollowsOnlyWhatItAsksAbout) {
  nlohmann::json recipe = StudiedRecipe(6);
  recipe["objects"][1]["object"]["d_m"] = 0;
  recipe["objects"][1]["count"]["values"] = {1};
  const auto file = Write(6);
  WriteFileWhole(Path("recipe.json"), recipe.dump());
  const StudyResult all = RunStudyIn(file, {.directory = Path("all")});
  Ask(file, {"worker"});
  const StudyResult asked = RunStudyIn(file, {.directory = Path("asked")});
  ASSERT_EQ(asked.approaches.size(), all.approaches.size());
  for (std::size_t i = 0; i < asked.approaches.size(); ++i) {
    EXPECT_EQ(all.approaches[i].objects.size(), 2U);
    ASSERT_EQ(asked.approaches[i].objects.size(), 1U);
    const StudiedObject& object = asked.approaches[i].objects.front();
    EXPECT_EQ(object.Target(), "worker");
    const auto same =
        std::ranges::find(all.approaches[i].objects, object.name, &StudiedObject::name);
    ASSERT_NE(same, all.approaches[i].objects.end());
    EXPECT_EQ(object.is_detected, same->is_detected);
    EXPECT_EQ(object.frame, same->frame);
  }
  EXPECT_LT(asked.num_traced, all.num_traced);
}

TEST_F(Study, SaysThatWhatItAsksAboutIsInNoScenario) {
  const auto file = Write(3);
  Ask(file, {"person", "person/1", "wagon/2"});
  EXPECT_EQ(MessageOf([&] { (void)RunStudyIn(file, {.directory = Path("out")}); }),
            ShownPath(file) + ": /objects/2: must be an object of a scenario (got \"wagon/2\")");
  EXPECT_FALSE(std::filesystem::exists(Path("out")));
}

TEST_F(Study, GivesTheSameLinesOnAnyNumberOfThreadsAndInShards) {
  const auto file = Write(7);
  const StudyResult all = RunStudyIn(file, {.directory = Path("one"), .num_threads = 1});
  ASSERT_TRUE(all.is_complete());
  EXPECT_EQ(all.num_made, 7U);
  (void)RunStudyIn(file, {.directory = Path("three"), .num_threads = 3});
  EXPECT_EQ(Lines("three"), Lines("one"));
  for (const std::uint32_t number : {1U, 2U}) {
    (void)RunStudyIn(file, {.directory = Path("shard" + std::to_string(number)),
                            .shard = {number, 2},
                            .num_threads = 1});
  }
  const StudyResult joined =
      RunStudyIn(file, {.directory = Path("joined"), .shards = {Path("shard2"), Path("shard1")}});
  EXPECT_TRUE(joined.is_complete());
  EXPECT_EQ(joined.num_traced, 0U);
  EXPECT_EQ(Lines("joined"), Lines("one"));
}

// 15 frames of whole scans from 60 m on.
nlohmann::json RecipeForADetector(std::uint32_t num_scenarios) {
  nlohmann::json recipe = StudiedRecipe(num_scenarios);
  recipe["num_frames"] = 15;
  recipe["objects"][0]["ahead_m"] = {{"type", "uniform"}, {"min", 60}, {"max", 62}};
  recipe["objects"][1]["ahead_m"] = {{"type", "uniform"}, {"min", 50}, {"max", 55}};
  return recipe;
}

TEST_F(Study, WithADetectorRecordsAlarmsAndMetresDriven) {
  const auto file = WriteStudy(Path(""), RecipeForADetector(4));
  WriteFileWhole(file, R"({"version": 1, "recipe": "recipe.json", "detector": {"type": "clusters"},
                           "detection": {"frames": 2, "of_frames": 3}})");
  const StudyResult all = RunStudyIn(file, {.directory = Path("one"), .num_threads = 1});
  ASSERT_TRUE(all.is_complete());
  std::size_t num_detected = 0;
  std::size_t num_beside = 0;
  for (const ApproachRecord& approach : all.approaches) {
    ASSERT_TRUE(approach.alarms);
    EXPECT_NEAR(approach.alarms->driven_m, 14 * 2.0, 1e-6);
    EXPECT_TRUE(approach.alarms->alarms.empty());
    for (const std::string& name : approach.alarms->beside) EXPECT_EQ(TargetOf(name), "worker");
    num_beside += approach.alarms->beside.size();
    ASSERT_EQ(approach.objects.size(), 1U);
    EXPECT_EQ(approach.objects[0].Target(), "person");
    num_detected += approach.objects[0].is_detected ? 1U : 0U;
  }
  EXPECT_GT(num_detected, 0U);
  EXPECT_GT(num_beside, 0U);
  (void)RunStudyIn(file, {.directory = Path("three"), .num_threads = 3});
  EXPECT_EQ(Lines("three"), Lines("one"));
}

TEST_F(Study, GoesOnWhereItWasStopped) {
  const auto file = Write(5);
  (void)RunStudyIn(file, {.directory = Path("whole"), .num_threads = 1});
  (void)RunStudyIn(file, {.directory = Path("begun"), .num_threads = 1});
  // As a run leaves it that was killed in the middle of a line.
  const std::string lines = Lines("begun");
  const std::size_t second = lines.find('\n', lines.find('\n') + 1);
  WriteFileWhole(Path("begun/approaches.jsonl"), lines.substr(0, second + 20));
  const StudyResult result = RunStudyIn(file, {.directory = Path("begun"), .num_threads = 1});
  EXPECT_EQ(result.num_made, 3U);
  EXPECT_EQ(Lines("begun"), Lines("whole"));
}

TEST_F(Study, SaysWhatItCannotStudy) {
  const auto message = [&](nlohmann::json recipe) {
    const auto file = WriteStudy(Path(""), recipe);
    return MessageOf(
        [&] { (void)RunStudyIn(file, {.directory = Path("faulty"), .num_threads = 1}); });
  };
  nlohmann::json recipe = StudiedRecipe(1);
  recipe["set"]["/fidelity"] = "auto";
  EXPECT_NE(message(recipe).find(
                "recipe.json: scenario 0: /fidelity: must name a rung: a study says which model it "
                "used (got \"auto\")"),
            std::string::npos)
      << message(recipe);
  recipe = StudiedRecipe(1);
  recipe["bases"][0]["recordings"] = {"base.json"};
  EXPECT_NE(message(recipe).find("recipe.json: /bases/0/recordings: must be left out: only data "
                                 "sets are made of recordings"),
            std::string::npos)
      << message(recipe);
}

TEST_F(Study, IsNotMixedWithAnother) {
  const auto file = Write(2);
  (void)RunStudyIn(file, {.directory = Path("out"), .num_threads = 1});
  (void)Write(3);
  const std::string message =
      MessageOf([&] { (void)RunStudyIn(file, {.directory = Path("out"), .num_threads = 1}); });
  EXPECT_NE(message.find("out: holds the same study of another recipe, of other bases or of other "
                         "files; choose another --out"),
            std::string::npos)
      << message;
}

TEST_F(Study, OfAFaultyFileNamesEachFault) {
  const auto file = Write(1);
  WriteFileWhole(file, R"({"version": 1, "recipe": "none.json", "detection": {"frames": 4,
                           "of_frames": 3}, "braking": {"deceleration_mps2": 0}, "what": 1,
                           "detector": {"type": "net"}, "gauge": {"width_m": 0}})");
  const std::string message = MessageOf([&] { (void)ReadStudy(file); });
  for (const char* const line :
       {"/recipe: ", "/detection/of_frames: must be >= frames (got 3)",
        "/braking/deceleration_mps2: must be >= 0.01 and <= 10 (got 0)",
        "/what: ", "/detector/type: must be \"clusters\" (got \"net\")",
        "/gauge/width_m: must be >= 0.1 and <= 10 (got 0)", "/gauge/height_m: missing"}) {
    EXPECT_NE(message.find(line), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace railcast
