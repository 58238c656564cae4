#include "analysis/extras/study/finished_study.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "analysis/extras/study/kept_files.h"
#include "core/base/input_file.h"
#include "core/io/content_hash.h"
#include "tests/analysis/extras/study/study_project.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

/// Makes a study, or a shard of it, and keeps its files.
void MakeKeptStudy(const std::filesystem::path& folder, const Shard& shard) {
  const TemporaryDirectory project;
  const StudySpec spec = ReadStudy(WriteStudy(project.path(), StudiedRecipe(6)));
  const Recipe recipe = ReadStudyRecipe(spec);
  const ScenarioDrawer drawer(recipe);
  StudyChoices choices{.directory = folder, .shard = shard};
  const StudyResult result = RunStudy(spec, drawer, choices, NoStudyHooks());
  const std::vector<Observation> observations = ObservationsOf(result.approaches);
  KeepFiles(
      spec, [&](std::uint32_t number) { return drawer.Draw(number); }, {}, SampleOf(observations),
      folder);
}

class FinishedStudies : public testing::Test {
 protected:
  static void TearDownTestSuite() { made_.reset(); }
  [[nodiscard]] std::filesystem::path folder() const { return directory_.path() / "made"; }

  /// The study is made once, and each test has a copy.
  void Make() const {
    if (!made_) {
      made_ = std::make_unique<TemporaryDirectory>();
      MakeKeptStudy(made_->path() / "made", {});
    }
    std::filesystem::copy(made_->path() / "made", folder(),
                          std::filesystem::copy_options::recursive);
  }
  [[nodiscard]] std::string MessageOfReading() const {
    return MessageOf([&] { static_cast<void>(ReadFinishedStudy(folder())); });
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> made_;
  TemporaryDirectory directory_;
};

TEST_F(FinishedStudies, AreReadFromTheirFolderAlone) {
  Make();
  const FinishedStudy study = ReadFinishedStudy(folder());
  EXPECT_EQ(study.spec.question, "Seen?");
  EXPECT_EQ(study.spec.detect.rule.min_points, 4U);
  EXPECT_EQ(study.result.approaches.size(), 6U);
  EXPECT_EQ(study.frames.size(), 60U);
  EXPECT_EQ(study.recipe.at("num_scenarios"), 6);
  const std::vector<ScenarioSpec> sample = ReadSample(study);
  ASSERT_EQ(sample.size(), 6U);
  EXPECT_EQ(sample.front().world.objects.front().name.substr(0, 6), "person");
}

TEST_F(FinishedStudies, AreRefusedWhereAFileWasChanged) {
  Make();
  for (const std::string name : {"inputs/study.json", "inputs/recipe.json", "study.json",
                                 "approaches.jsonl", "sample/000003/scenario.resolved.json"}) {
    const auto file = folder() / name;
    const std::string text = ReadFileWhole(file);
    WriteFileWhole(file, text + " ");
    EXPECT_EQ(MessageOfReading(), file.string() + ": must have the hash " + ContentHash(text) +
                                      ", as manifest.json says (got " + ContentHash(text + " ") +
                                      ")");
    std::filesystem::remove(file);
    EXPECT_NE(MessageOfReading(), "no error") << name;
    WriteFileWhole(file, text);
  }
  EXPECT_EQ(MessageOfReading(), "no error");
}

// Another scenario beside those of the sample is none of it.
TEST_F(FinishedStudies, HaveTheSampleThatTheyKept) {
  Make();
  std::filesystem::copy(folder() / "sample/000003", folder() / "sample/000009",
                        std::filesystem::copy_options::recursive);
  EXPECT_EQ(ReadSample(ReadFinishedStudy(folder())).size(), 6U);
}

TEST_F(FinishedStudies, AreRefusedWithoutTheirHashes) {
  Make();
  std::filesystem::remove(folder() / "manifest.json");
  EXPECT_EQ(MessageOfReading(),
            folder().string() +
                ": must be a finished study (got 6 of 6 approaches and no manifest.json); the "
                "command that began it, railcast-analyze study, continues it");
}

TEST_F(FinishedStudies, AreRefusedWhereApproachesAreMissing) {
  Make();
  const auto lines = folder() / "approaches.jsonl";
  const std::string text = ReadFileWhole(lines);
  WriteFileWhole(lines, text.substr(0, text.find('\n') + 1));
  EXPECT_EQ(MessageOfReading(),
            folder().string() +
                ": must be a finished study (got 1 of 6 approaches); the command that began it, "
                "railcast-analyze study, continues it");
}

TEST_F(FinishedStudies, AreRefusedIfTheyAreShards) {
  MakeKeptStudy(folder(), {.number = 2, .of = 3});
  EXPECT_EQ(MessageOfReading(), (folder() / "study.json").string() +
                                    ": /shard: must be absent: railcast-analyze study --shards "
                                    "joins shards (got \"2/3\")");
}

TEST_F(FinishedStudies, AreRefusedIfAnotherVersionMadeThem) {
  Make();
  const auto file = folder() / "study.json";
  nlohmann::json identity = nlohmann::json::parse(ReadFileWhole(file));
  const std::string ours = identity.at("version");
  identity["version"] = "0.1.0";
  WriteFileWhole(file, identity.dump());
  EXPECT_EQ(MessageOfReading(), file.string() + ": /version: must be " + ours +
                                    ", that of this program: make the study again, or use the "
                                    "program that made it (got \"0.1.0\")");
}

TEST_F(FinishedStudies, SampleScenariosSpreadOverAll) {
  std::vector<ApproachRecord> approaches(100);
  for (std::uint32_t i = 0; i < 100; ++i) {
    approaches[i].scenario = i;
    approaches[i].objects.emplace_back();
    approaches[i].objects.back().nearest_m = 1.0;
    approaches[i].objects.back().farthest_m = 100.0;
  }
  const std::vector<std::uint32_t> sample = SampleOf(ObservationsOf(approaches));
  ASSERT_EQ(sample.size(), 16U);
  EXPECT_EQ(sample.front(), 3U);
  EXPECT_EQ(sample.back(), 96U);
}

}  // namespace
}  // namespace railcast
