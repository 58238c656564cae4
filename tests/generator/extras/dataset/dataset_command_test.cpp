#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>

#include "core/io/run/run_folder.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_in_format.h"
#include "tests/generator/extras/dataset/dataset_project.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Runs the command on the project's recipe in a folder.
class DatasetCommand : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return directory_.path() / name; }
  [[nodiscard]] std::string Command(const std::string& out, const std::string& options = "") const {
    return Scenarios(out, "--threads 1 " + options);
  }
  [[nodiscard]] std::string Scenarios(const std::string& out, const std::string& options) const {
    return "dataset " + recipe_.string() + " --out " + Path(out).string() + " " + options;
  }
  TemporaryDirectory directory_;
  fs::path recipe_ = WriteProjectRecipe(directory_.path() / "project", ProjectRecipe());
};

TEST_F(DatasetCommand, ContinuesAfterItWasKilledWithTheSameBytes) {
  ASSERT_EQ(Generate(Command("whole")).status, 0);
  for (const char* const killed_after_s : {"0.05", "0.1", "0.15", "0.2", "0.3"}) {
    const std::string program = std::string(RAILCAST_GENERATE) + " " + Command("killed");
    (void)RunCommand("timeout -s KILL " + std::string(killed_after_s) + " " + program);
  }
  EXPECT_THAT(Generate(Command("killed")), ExitsWith(0));
  EXPECT_EQ(FilesOfDataset(Path("killed")), FilesOfDataset(Path("whole")));
}

TEST_F(DatasetCommand, SaysWhatItMadeAndHowToMerge) {
  EXPECT_THAT(
      Generate(Command("1", "--shard 1/2")),
      ExitsWith(0, testing::AllOf(
                       HasSubstr("3 of 3 scenarios in " + Path("1").string()),
                       HasSubstr("shard 1/2 is complete; railcast-generate merge makes one"))));
  EXPECT_EQ(Generate(Command("2", "--shard 2/2")).status, 0);
  const std::string merge = "merge " + Path("1").string() + " " + Path("2").string() + " --out ";
  EXPECT_THAT(Generate(merge + Path("1/merged").string()),
              ExitsWith(1, testing::StartsWith("--out: must be outside ")));
  EXPECT_THAT(Generate(merge + Path("merged").string()),
              ExitsWith(0, "6 scenarios of 2 shards in " + Path("merged").string() + "\n"));
  EXPECT_THAT(Generate(Command("merged")).said, HasSubstr("already complete: nothing to do\n"));
}

TEST_F(DatasetCommand, WritesTheScenariosAlone) {
  EXPECT_THAT(Generate(Scenarios("scenarios", "--scenarios-only")), ExitsWith(0));
  for (int i = 0; i < 6; ++i) {
    const fs::path file =
        Path("scenarios/sequences/000/00000" + std::to_string(i)) / "scenario.resolved.json";
    EXPECT_EQ(Generate("check " + file.string()).status, 0) << file;
  }
}

TEST_F(DatasetCommand, WritesTheScenariosAloneWhereNoOtherRunDoes) {
  const FolderLock lock(Path("out"));
  EXPECT_THAT(Generate(Scenarios("out", "--scenarios-only")),
              ExitsWith(1, Path("out").string() + ": another run is writing here\n"));
}

TEST_F(DatasetCommand, ReportsThePartsOfScenariosAlone) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 20;
  recipe["objects"][0]["count"] = {{"type", "choice"}, {"values", {1}}};
  recipe["split"] = {{"train", 0.7}, {"val", 0.15}, {"test", 0.15}};
  (void)WriteProjectRecipe(directory_.path() / "project", recipe);
  const Ended run = Generate(Scenarios("scenarios", "--scenarios-only"));
  EXPECT_THAT(run.said, HasSubstr("  train        14 scenarios, 70.0 % (asked for: 70.0 %)\n"
                                  "  val           3 scenarios, 15.0 % (asked for: 15.0 %)\n"
                                  "  test          3 scenarios, 15.0 % (asked for: 15.0 %)\n"
                                  "  bases: scenario.json 20\n"
                                  "  weathers: rain 20\n"
                                  "  placed: person 20\n"));
  const auto num_lines = [&](const char* part) {
    const std::string text = ReadFileWhole(Path("scenarios/split") / part);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(num_lines("train.txt"), 14);
  EXPECT_EQ(num_lines("val.txt"), 3);
  EXPECT_EQ(num_lines("test.txt"), 3);
  const Json report = Json::parse(ReadFileWhole(Path("scenarios/report.json")));
  EXPECT_EQ(report.at("splits").at("train").at("scenarios"), 14);
  EXPECT_EQ(report.at("splits").at("train").at("asked"), 0.7);
}

TEST_F(DatasetCommand, RefusesChoicesOfFramesWhereItWritesNone) {
  for (const std::string choice :
       {"--format kitti", "--fields x", "--merged", "--isa avx2", "--threads 3", "--certify 5%"}) {
    const std::string option = choice.substr(0, choice.find(' '));
    EXPECT_THAT(Generate(Scenarios("out", "--scenarios-only " + choice)),
                ExitsWith(2, HasSubstr(option + ": must not come with --scenarios-only\n")));
  }
}

TEST_F(DatasetCommand, LeavesAnEmptyFolderWhereItIsStoppedInScenariosAlone) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 20'000;
  (void)WriteProjectRecipe(directory_.path() / "project", recipe);
  const std::string log = Path("log").string();
  EXPECT_THAT(RunCommand(std::string(RAILCAST_GENERATE) + " " +
                         Scenarios("out", "--scenarios-only") + " > " + log +
                         " 2>&1 & for i in $(seq 1000); do [ -d " + Path("out/sequences").string() +
                         " ] && break; sleep 0.02; done; kill $!; wait $!; s=$?; tail -n 1 " + log +
                         "; (exit $s)"),
              ExitsWith(130, "interrupted; the same command begins anew\n"));
  EXPECT_TRUE(fs::is_empty(Path("out")));
}

TEST_F(DatasetCommand, TakesNoFolderForWhatItCannotMake) {
  for (const char* const choices :
       {"--merged", "--format kitti --fields x", "--format osi --fields x,y"}) {
    EXPECT_THAT(Generate(Command("out", choices)), ExitsWith(1)) << choices;
    EXPECT_FALSE(fs::exists(Path("out"))) << choices;
  }
  nlohmann::json recipe = ProjectRecipe();
  recipe["objects"][0]["draws"]["/d_m"] = {{"type", "uniform"}, {"min", 30}, {"max", 31}};
  recipe["objects"][0]["gauge"] = "foul";
  (void)WriteProjectRecipe(directory_.path() / "project", recipe);
  EXPECT_THAT(Generate(Command("out")), ExitsWith(1));
  EXPECT_FALSE(fs::exists(Path("out")));
}

TEST_F(DatasetCommand, RefusesShardsThatAreNone) {
  for (const char* const shard : {"0/2", "3/2", "1", "1/0", "a/2", "1/2/3", "-1/2"}) {
    const Ended run = Generate(Command("out", "--shard " + std::string(shard)));
    EXPECT_EQ(run.status, 2) << shard;
    EXPECT_THAT(run.said, HasSubstr("must be I/N with I from 1 to N and N at most 100000 (got " +
                                    std::string(shard) + ")"));
  }
}

TEST_F(DatasetCommand, RefusesAFormatThatCannotHoldTheOutput) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["set"]["/output"] = {{"frame", "vehicle"}};
  (void)WriteProjectRecipe(directory_.path() / "project", recipe);
  EXPECT_THAT(Generate(Command("out", "--format kitti")),
              ExitsWith(1, recipe_.string() +
                               ": scenario 0: /output: must be right-handed sensor coordinates for "
                               "--format kitti (got right-handed vehicle)\n"));
}

TEST_F(DatasetCommand, RefusesToCertifyTheReferenceAloneIfItIsAskedTo) {
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 1;
  recipe["set"]["/fidelity"] = "reference";
  (void)WriteProjectRecipe(directory_.path() / "project", recipe);
  EXPECT_THAT(Generate(Command("out", "--certify 1%")),
              ExitsWith(1, "--certify: must be left out: all scenarios of " + recipe_.string() +
                               " are of fidelity reference, which it compares with\n"));
  EXPECT_FALSE(fs::exists(Path("out")));
  EXPECT_EQ(Generate(Command("out")).status, 0);
}

/// Data sets whose clouds are in bags of ROS 2.
class DatasetOfBags : public DatasetInFormat {
 protected:
  [[nodiscard]] std::string BagName() const {
    return GetParam() == std::string("mcap") ? "frames.mcap" : "rosbag2";
  }
};

INSTANTIATE_TEST_SUITE_P(Formats, DatasetOfBags, testing::Values("mcap", "rosbag2"));

TEST_P(DatasetOfBags, SaysInItsIndexWhereTheCloudsAre) {
  Make("set");
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  std::size_t num_lines = 0;
  for (std::string line; std::getline(lines, line); ++num_lines) {
    const Json frame = Json::parse(line);
    const std::string sensor = frame.at("sensor");
    EXPECT_EQ(frame.at("files"), Json::array());
    EXPECT_EQ(frame.at("bag"),
              Json({{"path", "../" + BagName()}, {"topics", {"/" + sensor + "/points"}}}));
    const fs::path bag = Path("set") / frame.at("folder").get<std::string>() / "..";
    EXPECT_TRUE(fs::exists(bag / BagName()));
  }
  EXPECT_EQ(num_lines, 3U * (2 + 4));
  EXPECT_THAT(FaultsOf("set"), IsEmpty());
}

TEST_P(DatasetOfBags, IsTheSameOfShardsAndIsWholeThen) {
  ExpectTheSameOfShards();
}

TEST_P(DatasetOfBags, HasTheSameBytesAfterAnInterruption) {
  ExpectTheSameAfterAnInterruption();
}

TEST_P(DatasetOfBags, IsMendedWhereABagIsMissing) {
  ExpectMendedWithout(BagName());
}

TEST_P(DatasetOfBags, HasThePointsOfOneOfFiles) {
  recipe_ = ReadProjectRecipe(directory_.path() / "other", ProjectRecipe());
  Make("bags");
  (void)MakeDataset(recipe_, Path("files"));
  const DatasetContent content = ReadDatasetContent(Path("bags"));
  const auto sequences = FinishedSequences(Path("bags"), content);
  ASSERT_EQ(sequences.size(), 6U);
  for (const fs::path& sequence : sequences) {
    const auto frames = ReadAll(sequence);
    const auto expected = ReadAll(Path("files") / sequence.lexically_relative(Path("bags")));
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].frame.label, expected[i].frame.label);
      EXPECT_EQ(frames[i].frame.time_ns, expected[i].frame.time_ns);
    }
  }
  EXPECT_THAT(FaultsOf("bags"), IsEmpty());
}

// All clouds are there.
TEST_P(DatasetOfBags, IsNotMergedWithAChangedBag) {
  Make("a", {1, 2});
  Make("b", {2, 2});
  const std::string name =
      GetParam() == std::string("mcap") ? "frames.mcap" : "rosbag2/metadata.yaml";
  const fs::path changed = Path("b/sequences/000/000001") / name;
  fs::resize_file(changed, fs::file_size(changed) - 1);
  EXPECT_THAT(MessageOf([&] {
                (void)MergeShards({Path("a"), Path("b")}, Path("merged"), [](auto, auto) {});
              }),
              HasSubstr(changed.string() + ": must have the hash "));
}

TEST_P(DatasetOfBags, IsNotWholeWithAStrangerBesideABag) {
  Make("set");
  WriteFileWhole(Path("set/sequences/000/000001/frames.mcap.old"), "x");
  EXPECT_THAT(FaultsOf("set"),
              ElementsAre(Path("set/sequences/000/000001/frames.mcap.old").string() +
                          ": belongs to none of the run's sensors"));
}

}  // namespace
}  // namespace railcast
