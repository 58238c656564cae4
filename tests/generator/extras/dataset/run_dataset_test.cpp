#include "generator/extras/dataset/run_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "core/extras/recipe/recipe_files.h"
#include "core/io/content_hash.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

void NoProgress(std::uint32_t /*num_done*/, std::uint32_t /*num_scenarios*/) {}

class RunDatasetTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return directory_.path() / name; }
  TemporaryDirectory directory_;
  Recipe recipe_ = ReadProjectRecipe(directory_.path() / "project", ProjectRecipe());
};

TEST_F(RunDatasetTest, WritesASequenceForEachScenario) {
  const DatasetResult result = MakeDataset(recipe_, Path("set"));
  EXPECT_TRUE(result.is_complete);
  EXPECT_EQ(result.num_frames, 18U);
  for (int i = 0; i < 6; ++i) {
    const fs::path folder = Path("set/sequences/000/00000" + std::to_string(i));
    EXPECT_TRUE(fs::exists(folder / "manifest.json")) << folder;
    EXPECT_NO_THROW((void)ReadScenario(folder / "scenario.resolved.json"));
  }
}

TEST_F(RunDatasetTest, TellsItsProgressAfterEveryFrame) {
  std::vector<double> done;
  const DatasetHooks hooks = {[&](const DatasetProgress& now) { done.push_back(now.done()); },
                              [] { return false; }};
  (void)RunDataset(recipe_, OnOneThread(Path("set")), hooks);
  EXPECT_TRUE(std::ranges::is_sorted(done));
  for (int frame = 0; frame <= 18; ++frame) {
    EXPECT_THAT(done, testing::Contains(testing::DoubleNear(frame / 18.0, 1e-12)));
  }
}

TEST_F(RunDatasetTest, TellsWhatAnEarlierRunDid) {
  int num_asked = 0;
  const DatasetHooks stopped = {NoDatasetHooks().on_progress, [&] { return ++num_asked > 12; }};
  const std::uint32_t num_done = RunDataset(recipe_, OnOneThread(Path("set")), stopped).num_done;
  std::vector<double> done;
  const DatasetHooks hooks = {[&](const DatasetProgress& now) { done.push_back(now.done()); },
                              [] { return false; }};
  (void)RunDataset(recipe_, OnOneThread(Path("set")), hooks);
  EXPECT_DOUBLE_EQ(done.front(), num_done / 6.0);
}

TEST_F(RunDatasetTest, NamesItsDataByAHashOfIndexAndSplitsToo) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set")));
  const Json manifest = Json::parse(ReadFileWhole(Path("set/manifest.json")));
  // All files but dataset.json, which names the program, and scenarios.jsonl.
  std::string hashes;
  for (const char* name : {"recipe.json", "index.jsonl", "report.json", "split/train.txt",
                           "split/val.txt", "split/test.txt"}) {
    hashes += HashFile(Path("set") / name).hash;
  }
  std::istringstream lines(ReadFileWhole(Path("set/scenarios.jsonl")));
  for (std::string line; std::getline(lines, line);) {
    const Json scenario = Json::parse(line);
    for (const Json& sequence : scenario.at("sequences")) {
      hashes += sequence.at("data_xxh3").get<std::string>();
    }
  }
  EXPECT_EQ(manifest.at("data_xxh3"), ContentHash(hashes));
}

TEST_F(RunDatasetTest, IndexAndReportAgree) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set")));
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  std::int64_t num_frames = 0;
  std::int64_t num_points = 0;
  std::int64_t num_persons = 0;
  for (std::string line; std::getline(lines, line); ++num_frames) {
    const Json frame = Json::parse(line);
    num_points += frame.at("points").get<std::int64_t>();
    for (const Json& object : frame.at("objects")) {
      if (object.at("type") == "person") ++num_persons;
    }
    const fs::path folder = Path("set") / frame.at("folder").get<std::string>();
    for (const Json& file : frame.at("files")) {
      EXPECT_TRUE(fs::exists(folder / file.get<std::string>()));
    }
  }
  EXPECT_EQ(num_frames, 18);
  EXPECT_GT(num_persons, 0);
  const Json report = Json::parse(ReadFileWhole(Path("set/report.json")));
  EXPECT_EQ(report.at("num_frames"), num_frames);
  EXPECT_EQ(report.at("points"), num_points);
  EXPECT_EQ(report.at("objects").at("person").at("in_frames"), num_persons);
}

TEST_F(RunDatasetTest, SplitsNameEachScenarioOnce) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set")));
  std::string all;
  for (const char* const split : {"train", "val", "test"}) {
    all += ReadFileWhole(Path("set/split") / (std::string(split) + ".txt"));
  }
  for (int i = 0; i < 6; ++i) {
    const std::string line = "sequences/000/00000" + std::to_string(i) + "\n";
    EXPECT_EQ(all.find(line), all.rfind(line));
    EXPECT_NE(all.find(line), std::string::npos);
  }
}

TEST_F(RunDatasetTest, MergedShardsHaveTheBytesOfOneRun) {
  (void)MakeOnce(recipe_, OnOneThread(Path("whole")));
  for (const std::uint32_t num : {2U, 9U}) {
    std::vector<fs::path> shards;
    for (std::uint32_t i = num; i > 0; --i) {
      shards.push_back(Path(std::to_string(i) + "_of_" + std::to_string(num)));
      EXPECT_TRUE(MakeDataset(recipe_, shards.back(), {i, num}).is_complete);
    }
    const fs::path merged = Path("merged_" + std::to_string(num));
    EXPECT_EQ(MergeShards(shards, merged, NoProgress), 6U);
    EXPECT_EQ(FilesOfDataset(merged), FilesOfDataset(Path("whole")));
  }
}

TEST_F(RunDatasetTest, AnyNumberOfThreadsGivesTheSameBytes) {
  (void)MakeOnce(recipe_, OnOneThread(Path("1")));
  for (const int num_threads : {2, 4, 0}) {
    DatasetChoices choices = OnOneThread(Path("threads_" + std::to_string(num_threads)));
    choices.num_threads = num_threads;
    EXPECT_TRUE(RunDataset(recipe_, choices, NoDatasetHooks()).is_complete);
    EXPECT_EQ(FilesOfDataset(choices.directory), FilesOfDataset(Path("1")));
  }
}

TEST_F(RunDatasetTest, AStoppedRunOnThreeThreadsContinuesOnOneWithTheSameBytes) {
  (void)MakeOnce(recipe_, OnOneThread(Path("whole")));
  for (const int after : {3, 9, 15}) {
    std::atomic<int> num_asked = 0;
    const DatasetHooks hooks = {NoDatasetHooks().on_progress, [&] { return ++num_asked > after; }};
    DatasetChoices choices = OnOneThread(Path("stopped_" + std::to_string(after)));
    choices.num_threads = 3;
    (void)RunDataset(recipe_, choices, hooks);
    choices.num_threads = 1;
    EXPECT_TRUE(RunDataset(recipe_, choices, NoDatasetHooks()).is_complete);
    EXPECT_EQ(FilesOfDataset(choices.directory), FilesOfDataset(Path("whole")));
  }
}

TEST_F(RunDatasetTest, MergingContinuesWhereItWasInterrupted) {
  (void)MakeOnce(recipe_, OnOneThread(Path("a"), {1, 2}));
  (void)MakeOnce(recipe_, OnOneThread(Path("b"), {2, 2}));
  (void)MergeShards({Path("a"), Path("b")}, Path("merged"), NoProgress);
  const auto whole = FilesOfDataset(Path("merged"));
  const std::string& lines = whole.at("scenarios.jsonl");
  std::size_t end = 0;
  for (int i = 0; i < 3; ++i) {
    end = lines.find('\n', end) + 1;
    fs::remove(Path("merged/manifest.json"));
    WriteFileWhole(Path("merged/scenarios.jsonl"), lines.substr(0, end + 10));
    std::uint32_t first = 6;
    const auto note_first = [&](std::uint32_t num_done, std::uint32_t /*num_scenarios*/) {
      first = std::min(first, num_done);
    };
    (void)MergeShards({Path("a"), Path("b")}, Path("merged"), note_first);
    EXPECT_EQ(first, static_cast<std::uint32_t>(i + 1));
    EXPECT_EQ(FilesOfDataset(Path("merged")), whole);
  }
}

TEST_F(RunDatasetTest, MergingNeedsAllShardsOfOneDataSet) {
  (void)MakeOnce(recipe_, OnOneThread(Path("a"), {1, 3}));
  (void)MakeOnce(recipe_, OnOneThread(Path("b"), {3, 3}));
  const auto message = [&](const std::vector<fs::path>& shards) {
    return MessageOf([&] { (void)MergeShards(shards, Path("merged"), NoProgress); });
  };
  EXPECT_EQ(message({Path("a"), Path("b")}), "shard 2 of 3 is missing");
  EXPECT_EQ(message({Path("a"), Path("a"), Path("b")}),
            Path("a").string() + ": is a second shard 1\nshard 2 of 3 is missing");
  nlohmann::json other = ProjectRecipe();
  other["seed"] = 6;
  const Recipe changed = ReadProjectRecipe(directory_.path() / "project", other);
  (void)MakeDataset(changed, Path("c"), {2, 3});
  EXPECT_EQ(message({Path("a"), Path("c"), Path("b")}),
            Path("c").string() + ": is a shard of another data set than " + Path("a").string());
  EXPECT_FALSE(fs::exists(Path("merged")));
}

TEST_F(RunDatasetTest, MergingNeedsFinishedShards) {
  (void)MakeOnce(recipe_, OnOneThread(Path("a"), {1, 2}));
  const DatasetHooks hooks = {NoDatasetHooks().on_progress, [] { return true; }};
  (void)RunDataset(recipe_, OnOneThread(Path("b"), {2, 2}), hooks);
  EXPECT_EQ(MessageOf([&] {
              (void)MergeShards({Path("a"), Path("b")}, Path("m"), NoProgress);
            }),
            Path("b").string() +
                ": is unfinished, with 0 of 3 scenarios; the command that began it continues");
}

TEST_F(RunDatasetTest, AStoppedRunContinuesWithTheSameBytes) {
  (void)MakeOnce(recipe_, OnOneThread(Path("whole")));
  for (const int after : {1, 6, 11, 16}) {
    const fs::path stopped = Path("stopped_" + std::to_string(after));
    std::atomic<int> num_asked = 0;
    const DatasetHooks hooks = {NoDatasetHooks().on_progress, [&] { return ++num_asked > after; }};
    const DatasetChoices choices = OnOneThread(stopped);
    // How often a run asks depends on how long scenes take to build: it may end before.
    const bool is_complete = RunDataset(recipe_, choices, hooks).is_complete;
    EXPECT_EQ(fs::exists(stopped / "manifest.json"), is_complete);
    EXPECT_FALSE(is_complete && after == 1);
    EXPECT_TRUE(RunDataset(recipe_, choices, NoDatasetHooks()).is_complete);
    EXPECT_EQ(FilesOfDataset(stopped), FilesOfDataset(Path("whole")));
  }
}

// A scenario on the reference needs no certificate, and is not another run for that.
TEST_F(RunDatasetTest, AStoppedRunOnTheReferenceContinuesThoughOthersAreCertified) {
  nlohmann::json drawn = ProjectRecipe();
  drawn["num_scenarios"] = 1;
  drawn["draws"]["/fidelity"] = {{"type", "choice"}, {"values", {"reference"}}};
  const Recipe recipe = ReadProjectRecipe(Path("project"), drawn);
  DatasetChoices choices = OnOneThread(Path("set"));
  choices.certify = "1%";
  // Stopped as soon as the scenario has its folder.
  const fs::path run = Path("set") / SequenceFolderOf(0) / "run.json";
  const DatasetHooks hooks = {NoDatasetHooks().on_progress, [&] { return fs::exists(run); }};
  EXPECT_FALSE(RunDataset(recipe, choices, hooks).is_complete);
  ASSERT_TRUE(fs::exists(run));
  EXPECT_TRUE(RunDataset(recipe, choices, NoDatasetHooks()).is_complete);
}

TEST_F(RunDatasetTest, LeavesOtherFoldersAlone) {
  WriteFileWhole(Path("note.txt"), "mine");
  EXPECT_THAT(MessageOf([&] { (void)MakeDataset(recipe_, directory_.path()); }),
              HasSubstr("--out: must be a new or an empty folder, or that of a data set"));
  (void)MakeOnce(recipe_, OnOneThread(Path("set")));
  nlohmann::json other = ProjectRecipe();
  other["num_frames"] = 4;
  const Recipe changed = ReadProjectRecipe(directory_.path() / "project", other);
  EXPECT_EQ(MessageOf([&] { (void)MakeDataset(changed, Path("set")); }),
            Path("set").string() + ": holds a data set of another recipe; choose another --out");
}

TEST_F(RunDatasetTest, LeavesAStrangersUnfinishedFileAlone) {
  for (const char* const bytes : {"mine", "{\n  \"version\": \"mine"}) {
    const fs::path file = Path("other") / "dataset.json.part";
    fs::create_directories(Path("other"));
    WriteFileWhole(Path("theirs"), bytes);
    fs::rename(Path("theirs"), file);
    EXPECT_THAT(MessageOf([&] { (void)MakeDataset(recipe_, Path("other")); }),
                HasSubstr("--out: must be a new or an empty folder, or that of a data set"));
    EXPECT_EQ(ReadFileWhole(file), bytes);
    fs::remove(file);
  }
}

TEST_F(RunDatasetTest, ContinuesARunThatWasKilledWhileItBegan) {
  (void)MakeOnce(recipe_, OnOneThread(Path("whole")));
  const std::string text = ReadFileWhole(Path("whole/dataset.json"));
  fs::create_directories(Path("killed"));
  WriteFileWhole(Path("half"), text.substr(0, text.size() / 2));
  fs::rename(Path("half"), Path("killed/dataset.json.part"));
  EXPECT_TRUE(MakeDataset(recipe_, Path("killed")).is_complete);
  EXPECT_EQ(FilesOfDataset(Path("killed")), FilesOfDataset(Path("whole")));
}

TEST_F(RunDatasetTest, MendsALineThatWasChangedSinceItWasComplete) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set"), {1, 2}));
  const auto whole = FilesOfDataset(Path("set"));
  const fs::path file = Path("set/scenarios.jsonl");
  std::string lines = ReadFileWhole(file);
  lines.replace(lines.rfind("\"start_s_m\":"), 12, "\"start_s_m\":1");
  WriteFileWhole(file, lines);
  EXPECT_THAT(MakeDataset(recipe_, Path("set"), {1, 2}).changed,
              testing::Contains(HasSubstr(file.string() + ":3: /line_xxh3: must be ")));
  EXPECT_TRUE(FilesOfDataset(Path("set")) == whole);
}

TEST_F(RunDatasetTest, MakesAnUnfinishedScenarioWhoseLineWasChangedAnew) {
  (void)MakeOnce(recipe_, OnOneThread(Path("whole"), {1, 2}));
  (void)MakeOnce(recipe_, OnOneThread(Path("set"), {1, 2}));
  fs::remove(Path("set/manifest.json"));
  std::string lines = ReadFileWhole(Path("set/scenarios.jsonl"));
  lines.replace(lines.find("\"points\":"), 9, "\"points\":1");
  WriteFileWhole(Path("set/scenarios.jsonl"), lines);
  EXPECT_TRUE(MakeDataset(recipe_, Path("set"), {1, 2}).is_complete);
  EXPECT_EQ(FilesOfDataset(Path("set")), FilesOfDataset(Path("whole")));
}

/// What may happen to the files of a data set.
struct Damage {
  const char* name;
  std::function<void(const fs::path& scenario)> cause;
  const char* fault;  ///< Part of what is said of it.
};

const std::vector<Damage>& Damages() {
  static const std::vector<Damage> damages = {
      {"frame changed",
       [](const fs::path& it) {
         WriteFileWhole(it / "frames/000001.pcd", ReadFileWhole(it / "frames/000001.pcd") + "x");
       },
       "/frames/000001.pcd: must have "},
      {"frame removed", [](const fs::path& it) { fs::remove(it / "frames/000000.pcd"); },
       "/frames/000000.pcd: no such file"},
      {"objects cut", [](const fs::path& it) { WriteFileWhole(it / "objects.jsonl", ""); },
       "/objects.jsonl: "},
      {"manifest removed", [](const fs::path& it) { fs::remove(it / "manifest.json"); },
       "/manifest.json: missing"},
      {"run removed", [](const fs::path& it) { fs::remove(it / "run.json"); }, "/run.json: "},
      {"scenario removed", [](const fs::path& it) { fs::remove_all(it); }, "/000003"},
      {"unfinished file",
       [](const fs::path& it) {
         fs::copy_file(it / "frames/000001.pcd", it / "frames/000001.pcd.part");
       },
       "/frames/000001.pcd.part: "}};
  return damages;
}

// docs/files.md: what was changed is named and made anew.
TEST_F(RunDatasetTest, NamesWhatIsDamagedAndMendsIt) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set")));
  const auto whole = FilesOfDataset(Path("set"));
  for (const Damage& damage : Damages()) {
    SCOPED_TRACE(damage.name);
    damage.cause(Path("set/sequences/000/000003"));
    const DatasetResult mended = MakeDataset(recipe_, Path("set"));
    if (std::string_view(damage.name) != "unfinished file") {
      EXPECT_THAT(mended.changed, testing::Contains(HasSubstr(damage.fault)));
    }
    EXPECT_TRUE(mended.is_complete);
    EXPECT_EQ(mended.num_resumed, mended.changed.empty() ? 6U : 5U);
    EXPECT_LE(mended.num_frames, 3U);
    EXPECT_TRUE(FilesOfDataset(Path("set")) == whole);
  }
}

TEST_F(RunDatasetTest, LeavesAStrangersFileInAScenarioAloneWhenItMends) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set")));
  const fs::path letter = Path("set/sequences/000/000003/letter.txt");
  WriteFileWhole(letter, "dear");
  fs::remove(Path("set/manifest.json"));
  EXPECT_THAT(MessageOf([&] { (void)MakeDataset(recipe_, Path("set")); }),
              HasSubstr("holds a file that does not belong to this run (letter.txt)"));
  EXPECT_EQ(ReadFileWhole(letter), "dear");
}

TEST_F(RunDatasetTest, MergingMendsWhatIsDamaged) {
  (void)MakeOnce(recipe_, OnOneThread(Path("a"), {1, 2}));
  (void)MakeOnce(recipe_, OnOneThread(Path("b"), {2, 2}));
  const auto merge = [&] { (void)MergeShards({Path("a"), Path("b")}, Path("set"), NoProgress); };
  merge();
  const auto whole = FilesOfDataset(Path("set"));
  const fs::path frame = Path("set/sequences/000/000002/frames/000001.pcd");
  fs::remove(frame);  // It is linked to that of the shard.
  WriteFileWhole(frame, "x");
  WriteFileWhole(frame.string() + ".part", "x");
  merge();
  EXPECT_TRUE(FilesOfDataset(Path("set")) == whole);
}

TEST_F(RunDatasetTest, MergingLeavesAStrangersFileAlone) {
  (void)MakeOnce(recipe_, OnOneThread(Path("a"), {1, 1}));
  const auto merge = [&] { (void)MergeShards({Path("a")}, Path("set"), NoProgress); };
  merge();
  const fs::path letter = Path("set/sequences/000/000002/letter.txt");
  WriteFileWhole(letter, "dear");
  fs::remove(Path("set/manifest.json"));
  EXPECT_THAT(MessageOf(merge), HasSubstr("000002/letter.txt: is named neither in "));
  EXPECT_EQ(ReadFileWhole(letter), "dear");
}

TEST_F(RunDatasetTest, NoticesAChangedBase) {
  (void)MakeOnce(recipe_, OnOneThread(Path("set"), {1, 2}));
  const fs::path base = directory_.path() / "project/scenario.json";
  std::string text = ReadFileWhole(base);
  text.replace(text.find("\"start_s_m\": 400"), 16, "\"start_s_m\": 401");
  WriteFileWhole(base, text);
  EXPECT_EQ(MessageOf([&] {
              (void)MakeDataset(recipe_, Path("set"), {1, 2});
            }),
            Path("set").string() +
                ": holds a data set of the same recipe with other bases; choose another --out");
}

// One of two weathers is drawn; nothing else names their files.
TEST_F(RunDatasetTest, NoticesAChangedFileThatDrawsName) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["draws"] = {{"/weather", {{"type", "choice"}, {"values", {"wet.json", "dry.json"}}}}};
  const fs::path project = directory_.path() / "project";
  WriteFileWhole(project / "wet.json", R"({"version": 1, "wetness": 0.8})");
  WriteFileWhole(project / "dry.json", R"({"version": 1, "wetness": 0})");
  const Recipe drawn = ReadProjectRecipe(project, recipe);
  (void)MakeDataset(drawn, Path("set"), {1, 2});
  WriteFileWhole(project / "wet.json", R"({"version": 1, "wetness": 0.7})");
  EXPECT_EQ(MessageOf([&] {
              (void)MakeDataset(drawn, Path("set"), {1, 2});
            }),
            Path("set").string() +
                ": holds a data set of the same recipe with other contents of the files that it "
                "names; choose another --out");
}

// Parts of scenarios name files, too, and meshes are read with others.
TEST_F(RunDatasetTest, FilesOfARecipeAreAllThatItsValuesLeadTo) {
  nlohmann::json recipe = ProjectRecipe();
  const fs::path project = directory_.path() / "project";
  const auto hash = [&] { return HashOfRecipeFiles(ReadProjectRecipe(project, recipe)); };
  EXPECT_EQ(hash(), "");
  recipe["set"]["/lidar"] = "lidar.json";
  recipe["objects"][0]["object"] = {{"type", "mesh"}, {"file", "rock.obj"}};
  WriteFileWhole(project / "lidar.json", R"({"version": 1, "name": "beams", "range_max_m": 60,
      "scan": {"rate_hz": 10, "pattern": {"type": "table", "file": "beams.csv"}}})");
  WriteFileWhole(project / "rock.mtl", "newmtl stone\nKd 0.5 0.5 0.5\n");
  const auto with_library = [&] {
    const std::string file = WriteProjectRecipe(project, recipe).string();
    WriteFileWhole(project / "rock.obj", "mtllib rock.mtl\n" + std::string(kPyramidObj));
    return HashOfRecipeFiles(ReadRecipe(file));
  };
  const std::string before = with_library();
  EXPECT_NE(before, "");
  WriteFileWhole(project / "rock.mtl", "newmtl stone\nKd 0.4 0.5 0.5\n");
  const std::string other_colour = with_library();
  EXPECT_NE(other_colour, before);
  recipe["set"]["/lidar"] = nlohmann::json::parse(ReadFileWhole(project / "lidar.json"));
  recipe["set"]["/lidar"].erase("version");
  EXPECT_NE(with_library(), other_colour);  // lidar.json is no longer named, beams.csv is.
}

TEST_F(RunDatasetTest, StrideAndWarmUpChooseTheFrames) {
  nlohmann::json sparse = ProjectRecipe();
  sparse["stride"] = 4;
  sparse["warm_up_frames"] = 2;
  const Recipe recipe = ReadProjectRecipe(directory_.path() / "project", sparse);
  (void)MakeDataset(recipe, Path("set"));
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  for (const int expected : {2, 6, 10}) {
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(Json::parse(line).at("frame"), expected);
  }
}

// Their frames have no files that could be the same.
TEST_F(RunDatasetTest, FramesOfObjectsAloneAreNoDuplicates) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 1;
  DatasetChoices choices = OnOneThread(Path("set"));
  choices.format = "objects";
  (void)RunDataset(ReadProjectRecipe(Path("project"), recipe), choices, NoDatasetHooks());
  const Json report = Json::parse(ReadFileWhole(Path("set/report.json")));
  EXPECT_EQ(report.at("num_frames"), 3U);
  EXPECT_EQ(report.at("duplicate_frames"), 0U);
}

}  // namespace
}  // namespace railcast
