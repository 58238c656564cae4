#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/scenario_identity.h"
#include "generator/extras/dataset/inserted_scenarios.h"
#include "generator/extras/dataset/run_dataset.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "generator/extras/insert/run/insert_run.h"
#include "tests/core/extras/recipe/drawn_value.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/recording_recipe.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(RecordingRecipe, DrawsPlansForFramesOfSeveralRecordings) {
  nlohmann::json json = Boxes();
  json["num_scenarios"] = 20;
  const Recipe recipe = Read(json);
  std::set<std::string> recordings;
  std::set<std::uint32_t> first_frames;
  for (const DrawnScenario& drawn : DrawAllOf(recipe)) {
    ASSERT_TRUE(drawn.run && drawn.scenario.world.recording);
    recordings.insert(DrawnOf(drawn.record, "recording"));
    first_frames.insert(drawn.first_frame);
    EXPECT_LE(drawn.first_frame + 5, kNumRecorded);
    const double start_s_m = drawn.run->frames().at(drawn.first_frame).s_m;
    EXPECT_NEAR(start_s_m, 2.0 * drawn.first_frame, 0.01);
    EXPECT_EQ(drawn.record.start_s_m, start_s_m);
    ASSERT_EQ(drawn.scenario.world.objects.size(), 1U);
    const double ahead_m = drawn.scenario.world.objects[0].s_m - start_s_m;
    EXPECT_TRUE(ahead_m >= 15.0 && ahead_m <= 30.0) << ahead_m;
    // That is where `insert` puts it.
    const InsertPlan plan = MakeInsertPlan(RunOf(*drawn.run), drawn.scenario);
    const Vector3 vehicle =
        plan.world->WorldFromVehicle(plan.frame_times_ns[drawn.first_frame]).translation();
    EXPECT_NEAR(plan.world->WorldFromObject(0, 0).translation().x() - vehicle.x(), ahead_m, 0.01);
  }
  EXPECT_THAT(recordings, ElementsAre("one", "two"));
  EXPECT_GT(first_frames.size(), 10U);
}

TEST_F(RecordingRecipe, DependsOnTheRecipeAndTheNumberAlone) {
  const Recipe recipe = Read(Boxes());
  const std::vector<DrawnScenario> all = DrawAllOf(recipe);
  const DrawnScenario again = ScenarioDrawer(Read(Boxes())).Draw(4);
  EXPECT_EQ(again.scenario, all[4].scenario);
  EXPECT_EQ(RecordText(again.record), RecordText(all[4].record));
}

TEST_F(RecordingRecipe, ThingsThatMoveSetOffInTheFirstFrameOfTheirScenario) {
  nlohmann::json json = Boxes();
  json["objects"][0]["object"]["motion"] = {
      {"path", {{"speed_mps", 2}, {"points", {{{"s_m", 0}, {"d_m", 6}}}}}}};
  nlohmann::json car = json["objects"][0];
  car["name"] = "car";
  car["object"]["d_m"] = 9;
  car["draws"] = nlohmann::json::object();
  car["object"]["motion"] = {{"profile", {{{"time_s", 0}, {"speed_mps", 3}}}}};
  json["objects"].push_back(car);
  for (const DrawnScenario& drawn : DrawAllOf(Read(json))) {
    const InsertPlan plan = MakeInsertPlan(RunOf(*drawn.run), drawn.scenario);
    const std::int64_t begin_ns = plan.frame_times_ns[drawn.first_frame];
    for (const std::size_t object : {0U, 1U}) {
      const auto place = [&](std::int64_t time_ns) -> Vector3 {
        return plan.world->WorldFromObject(object, time_ns).translation();
      };
      const auto& spec = drawn.scenario.world.objects[object];
      EXPECT_NEAR(place(begin_ns).x(), place(0).x(), 0.01);
      EXPECT_NEAR(place(begin_ns).y(), spec.d_m, 0.02);
      EXPECT_GT((place(begin_ns + 1'000'000'000) - place(begin_ns)).norm(), 0.4) << spec.name;
    }
  }
}

TEST_F(RecordingRecipe, WritesARecordingWithItsIndexForEachPlan) {
  const DatasetResult result = Make(Read(Boxes()), "set");
  EXPECT_TRUE(result.is_complete);
  EXPECT_EQ(result.num_frames, 30U);
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  std::size_t num_frames = 0;
  std::int64_t num_box_points = 0;
  for (std::string line; std::getline(lines, line); ++num_frames) {
    const Json frame = Json::parse(line);
    const fs::path folder = Path("set") / frame.at("folder").get<std::string>();
    ASSERT_EQ(frame.at("files").size(), 1U);
    EXPECT_TRUE(fs::exists(folder / frame.at("files")[0].get<std::string>()));
    EXPECT_TRUE(fs::exists(folder.parent_path() / "insert.jsonl"));
    for (const Json& object : frame.at("objects")) {
      if (object.at("name") == "box/1") num_box_points += object.at("points").get<std::int64_t>();
    }
    EXPECT_THAT(frame.at("drawn").at("recording").get<std::string>(), testing::AnyOf("one", "two"));
  }
  EXPECT_EQ(num_frames, 30U);
  EXPECT_GT(num_box_points, 30);
  const Json report = Json::parse(ReadFileWhole(Path("set/report.json")));
  EXPECT_EQ(report.at("objects").at("box").at("in_frames"), 30);
  EXPECT_EQ(report.at("drawn").at("recording").size(), 2U);
}

TEST_F(RecordingRecipe, WritesWhatInsertWritesOfTheDrawnPlan) {
  const Recipe recipe = Read(Boxes());
  (void)Make(recipe, "set");
  const DrawnScenario drawn = ScenarioDrawer(recipe).Draw(2);
  WriteFileWhole(Path("drawn.json"), IdentityOf(drawn.scenario).scenario_json);
  InsertChoices choices;
  choices.recording = drawn.run->recording();
  choices.recording_name = "two";
  choices.directory = Path("inserted");
  choices.first_frame = drawn.first_frame;
  choices.last_frame = drawn.first_frame + 4;
  (void)RunInsert(choices, ReadInsertPlan(Path("drawn.json"), drawn.run->recording()),
                  {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
  const auto of_set = FilesOfDataset(Path("set/sequences/000/000002"));
  const auto of_insert = FilesOfDataset(Path("inserted"));
  for (const auto& [name, bytes] : of_set) {
    // The remarks of the sensor differ: the drawn plan names it.
    if (name == "manifest.json") continue;
    EXPECT_EQ(of_insert.at(name), bytes) << name;
  }
}

TEST_F(RecordingRecipe, CertifiesThePlansThatHaveObjects) {
  nlohmann::json json = Boxes();
  json["objects"][0]["count"]["values"] = {0, 1};
  const Recipe recipe = Read(json);
  DatasetChoices choices = Choices("certified");
  choices.certify = "5000%";
  (void)RunDataset(recipe, choices, NoDatasetHooks());
  std::set<bool> has_certificate;
  for (std::uint32_t i = 0; i < recipe.num_scenarios; ++i) {
    const fs::path folder = Path("certified") / SequenceFolderOf(i);
    const bool has_object = !ScenarioDrawer(recipe).Draw(i).scenario.world.objects.empty();
    const Json manifest = Json::parse(ReadFileWhole(folder / "manifest.json"));
    EXPECT_EQ(manifest.contains("certificate"), has_object) << i;
    if (has_object) {
      EXPECT_GT(manifest.at("certificate").at("drawn"), 10) << i;
    }
    has_certificate.insert(has_object);
  }
  EXPECT_EQ(has_certificate.size(), 2U);
  // With the same frames as without.
  (void)Make(recipe, "plain");
  for (const auto& [name, bytes] : FilesOfDataset(Path("plain"))) {
    if (!name.ends_with(".pcd")) continue;
    EXPECT_EQ(ReadFileWhole(Path("certified") / name), bytes) << name;
  }
  // If it is asked for, at least one must have objects.
  json["objects"][0]["count"]["values"] = {0};
  choices.must_certify = true;
  choices.directory = Path("refused");
  EXPECT_EQ(MessageOf([&] { (void)RunDataset(Read(json), choices, NoDatasetHooks()); }),
            "--certify: must be left out: all scenarios of " + ShownPath(Path("recipe.json")) +
                " have no objects, or are of fidelity reference, which it compares with");
}

TEST_F(RecordingRecipe, HasTheSameBytesInShardsAfterStopsAndOnSeveralThreads) {
  const Recipe recipe = Read(Boxes());
  (void)Make(recipe, "whole");
  const auto whole = FilesOfDataset(Path("whole"));
  (void)Make(recipe, "a", {1, 2});
  (void)Make(recipe, "b", {2, 2});
  fs::remove_all(Path("merged"));
  EXPECT_EQ(
      MergeShards({Path("b"), Path("a")}, Path("merged"), [](std::uint32_t, std::uint32_t) {}), 6U);
  EXPECT_EQ(FilesOfDataset(Path("merged")), whole);
  fs::remove_all(Path("stopped"));
  for (int after = 1; after < 40; after += 6) {
    std::atomic<int> num_asked = 0;
    const DatasetHooks hooks = {NoDatasetHooks().on_progress, [&] { return ++num_asked > after; }};
    DatasetChoices choices = Choices("stopped");
    choices.num_threads = 3;
    (void)RunDataset(recipe, choices, hooks);
  }
  EXPECT_TRUE(RunDataset(recipe, Choices("stopped"), NoDatasetHooks()).is_complete);
  EXPECT_EQ(FilesOfDataset(Path("stopped")), whole);
}

TEST_F(RecordingRecipe, MendsWhatIsDamaged) {
  const Recipe recipe = Read(Boxes());
  (void)Make(recipe, "set");
  const auto whole = FilesOfDataset(Path("set"));
  const fs::path scenario = Path("set/sequences/000/000003");
  for (const char* const file : {"insert.jsonl", "manifest.json", "run.json", "plan.resolved.json",
                                 "recording/manifest.json", "recording/run.json", "recording"}) {
    SCOPED_TRACE(file);
    fs::remove_all(scenario / file);
    const DatasetResult mended = RunDataset(recipe, Choices("set"), NoDatasetHooks());
    EXPECT_THAT(mended.changed, testing::Contains(HasSubstr(std::string("000003/") + file)));
    EXPECT_EQ(FilesOfDataset(Path("set")), whole);
  }
}

TEST_F(RecordingRecipe, KnowsItsRecordingsByTheirContents) {
  fs::remove_all(Path("clouds"));
  fs::copy(Path("one/frames"), Path("clouds"));
  nlohmann::json json = Boxes();
  json["bases"] = nlohmann::json::parse(R"([{"file": "standing.json", "recordings": ["clouds"]}])");
  WriteFileWhole(Path("standing.json"), StandingPlan());
  (void)Make(Read(json), "set", {1, 2});
  fs::rename(Path("clouds/000000.pcd"), Path("exchanged"));
  fs::rename(Path("clouds/000001.pcd"), Path("clouds/000000.pcd"));
  fs::rename(Path("exchanged"), Path("clouds/000001.pcd"));
  const Recipe changed = Read(json);
  EXPECT_EQ(MessageOf([&] {
              (void)RunDataset(changed, Choices("set", {1, 2}), NoDatasetHooks());
            }),
            ShownPath(Path("set")) +
                ": holds a data set of the same recipe with other bases; choose another --out");
  (void)Make(changed, "other", {2, 2});
  EXPECT_EQ(
      MessageOf([&] {
        MergeShards({Path("set"), Path("other")}, Path("merged"), [](auto, auto) {});
      }),
      ShownPath(Path("other")) + ": is a shard of another data set than " + ShownPath(Path("set")));
}

TEST_F(RecordingRecipe, VerifiesEveryFile) {
  (void)Make(Read(Boxes()), "set");
  const auto verify = [] { return VerifyDataset(Path("set"), [](double) {}); };
  const Verification sound = verify();
  EXPECT_THAT(sound.faults, IsEmpty());
  EXPECT_EQ(sound.num_frames, 30U);
  const fs::path points = Path("set/sequences/000/000003/insert.jsonl");
  WriteFileWhole(points, ReadFileWhole(points) + " ");
  WriteFileWhole(Path("set/sequences/000/000004/recording/note"), "mine");
  const auto faults = verify().faults;
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_THAT(faults[0], HasSubstr("000003/insert.jsonl: must have the hash "));
  EXPECT_EQ(faults[1], ShownPath(Path("set/sequences/000/000004/recording/note")) +
                           ": is not named in " + ShownPath(Path("set/scenarios.jsonl")) + ":5");
}

TEST_F(RecordingRecipe, NoPlaceOfARecordingIsInTwoParts) {
  nlohmann::json json = Boxes();
  json["num_scenarios"] = 40;
  json["num_frames"] = 2;
  json["split"] = {{"by", "place"}, {"train", 0.5}, {"val", 0.25},
                   {"test", 0.25},  {"cell_m", 15}, {"sight_m", 4}};
  std::map<std::pair<std::string, int>, std::set<std::string>> parts;
  for (const DrawnScenario& drawn : DrawAllOf(Read(json))) {
    const ScenarioRecord& record = drawn.record;
    const double begin_s_m = record.seen_s_m[0];
    const double end_s_m = record.seen_s_m[1];
    EXPECT_NEAR(end_s_m - begin_s_m, 10.0, 0.01);
    for (int cell = static_cast<int>(std::floor(begin_s_m)); cell < end_s_m; ++cell) {
      parts[{DrawnOf(record, "recording"), cell}].insert(record.split);
    }
  }
  std::set<std::string> all;
  for (const auto& [place, names] : parts) {
    EXPECT_EQ(names.size(), 1U) << place.first << " " << place.second;
    all.insert(names.begin(), names.end());
  }
  EXPECT_EQ(all.size(), 3U);
}

TEST_F(RecordingRecipe, NoRecordingIsInTwoParts) {
  nlohmann::json json = Boxes();
  json["split"] = {{"by", "line"}, {"train", 0.5}, {"val", 0.5}, {"test", 0.0}};
  std::map<std::string, std::set<std::string>> parts;
  for (const DrawnScenario& drawn : DrawAllOf(Read(json))) {
    parts[DrawnOf(drawn.record, "recording")].insert(drawn.record.split);
  }
  ASSERT_EQ(parts.size(), 2U);
  for (const auto& [recording, names] : parts) EXPECT_EQ(names.size(), 1U) << recording;
  json["bases"] = nlohmann::json::parse(
      R"([{"file": "plan.json", "recordings": ["one"], "split": "val"},
          {"file": "plan.json", "recordings": ["two"], "split": "train"}])");
  for (const DrawnScenario& drawn : DrawAllOf(Read(json))) {
    const bool is_one = DrawnOf(drawn.record, "recording") == "one";
    EXPECT_EQ(drawn.record.split, is_one ? "val" : "train");
  }
}

TEST_F(RecordingRecipe, IndexesCloudsInAnotherFormatByWhatInsertSaysOfThem) {
  const Recipe recipe = Read(Boxes());
  (void)Make(recipe, "same");
  fs::remove_all(Path("pcd"));
  DatasetChoices choices = Choices("pcd");
  choices.format = "pcd";
  EXPECT_TRUE(RunDataset(recipe, choices, NoDatasetHooks()).is_complete);
  EXPECT_THAT(VerifyDataset(Path("pcd"), [](double) {}).faults, IsEmpty());
  std::istringstream of_same(ReadFileWhole(Path("same/index.jsonl")));
  std::istringstream of_pcd(ReadFileWhole(Path("pcd/index.jsonl")));
  std::string same_line;
  std::size_t num_frames = 0;
  for (std::string line; std::getline(of_pcd, line); ++num_frames) {
    ASSERT_TRUE(std::getline(of_same, same_line));
    const Json frame = Json::parse(line);
    const Json same = Json::parse(same_line);
    for (const char* const key : {"scenario", "frame", "stamp_ns", "points", "drawn", "folder"}) {
      EXPECT_EQ(frame.at(key), same.at(key)) << key;
    }
    const fs::path folder = Path("pcd") / frame.at("folder").get<std::string>();
    EXPECT_TRUE(fs::exists(folder / frame.at("files").at(0).get<std::string>()));
    EXPECT_EQ(frame.at("objects").back().at("points"), same.at("objects").back().at("points"));
    for (const char* const key : {"outcomes", "points_per_label"}) {
      EXPECT_TRUE(same.contains(key) && !frame.contains(key)) << key << " is not known of clouds";
    }
  }
  EXPECT_EQ(num_frames, 30U);
  const Json report = Json::parse(ReadFileWhole(Path("pcd/report.json")));
  EXPECT_GT(report.at("points"), 0);
  EXPECT_FALSE(report.contains("outcomes"));
}

TEST_F(RecordingRecipe, NamesWhatCannotBeDrawn) {
  const auto with = [](const std::string& key, const nlohmann::json& value) {
    nlohmann::json json = Boxes();
    json[key] = value;
    return Fault(json);
  };
  EXPECT_EQ(with("stride", 2), "recipe.json: /stride: must be 1 with plans (got 2)");
  EXPECT_EQ(with("warm_up_frames", 3),
            "recipe.json: /warm_up_frames: must be 0 with plans (got 3)");
  EXPECT_EQ(with("num_frames", 41),
            "recipe.json: /bases/0/recordings/0: must have at least the recipe's 41 frames (got "
            "40)\nrecipe.json: /bases/0/recordings/1: must have at least the recipe's 41 frames "
            "(got 40)");
  EXPECT_EQ(with("start_s_m", {{"type", "uniform"}, {"min", 0}, {"max", 9}}),
            "recipe.json: /start_s_m: must be left out: plans begin in any frame");
  EXPECT_EQ(with("set", {{"/lidar/mount/position_m", {0, 0, 3}}}),
            "recipe.json: /set/~1lidar~1mount~1position_m: must be given in the plan: the "
            "recording's line depends on it");
  EXPECT_EQ(with("set", {{"/world/vegetation/grass", false}}),
            "recipe.json: /set/~1world~1vegetation~1grass: /world/vegetation: must be left out of "
            "a plan, whose world is a recording");
  const auto base = [&](const char* text) { return with("bases", nlohmann::json::parse(text)); };
  EXPECT_EQ(base(R"([{"file": "plan.json", "recordings": ["three"]}])"),
            "recipe.json: /bases/0/recordings/0: must be an existing file or directory (got "
            "\"three\")");
  EXPECT_EQ(base(R"([{"file": "plan.json", "recordings": []}])"),
            "recipe.json: /bases/0/recordings: must have a recording (got [])");
  EXPECT_THAT(base(R"([{"file": "plan.json"}])"),
              testing::MatchesRegex("recipe.json: /bases/0/recordings: missing: .*plan.json is a "
                                    "plan, whose world is a recording"));
  EXPECT_THAT(base(R"([{"file": "project/scenario.json", "recordings": ["one"]}])"),
              HasSubstr("project/scenario.json: /world/recording: missing\n"));
  EXPECT_EQ(base(R"([{"file": "project/scenario.json"},
                     {"file": "plan.json", "recordings": ["one"]}])"),
            "recipe.json: /bases: must be either all plans with recordings or all scenarios");
}

TEST_F(RecordingRecipe, NoticesAnotherRecording) {
  (void)Make(Read(Boxes()), "set", {1, 2});
  fs::copy(Path("one"), Path("changed"), fs::copy_options::recursive);
  const std::string manifest = ReadFileWhole(Path("one/manifest.json"));
  std::string other = manifest;
  other.replace(other.find("manifest_xxh3") + 17, 1, "x");
  WriteFileWhole(Path("one/manifest.json"), other);
  const std::string message = MessageOf([&] {
    (void)RunDataset(Read(Boxes()), Choices("set", {1, 2}), NoDatasetHooks());
  });
  WriteFileWhole(Path("one/manifest.json"), manifest);
  EXPECT_THAT(message, HasSubstr("one/manifest.json"));
}

TEST_F(RecordingRecipe, ChoosesNothingThatRecordingsSay) {
  DatasetChoices choices = Choices("chosen");
  choices.fields = "x,y,z";
  EXPECT_EQ(MessageOf([&] { (void)RunDataset(Read(Boxes()), choices, NoDatasetHooks()); }),
            "--fields: must be left out: the bases are plans for recordings");
  EXPECT_FALSE(fs::exists(Path("chosen")));
  EXPECT_EQ(
      MessageOf([&] { (void)RunDataset(Read(Boxes()), Choices("two/chosen"), NoDatasetHooks()); }),
      "--out: must not be in the recording's directory (got " + ShownPath(Path("two/chosen")) +
          ")");
  EXPECT_FALSE(fs::exists(Path("two/chosen")));
}

}  // namespace
}  // namespace railcast
