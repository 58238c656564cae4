#include "analysis/extras/study/finished_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "analysis/extras/study/kept_files.h"
#include "analysis/extras/study/study_directory.h"
#include "core/base/input_file.h"
#include "core/io/content_hash.h"
#include "tests/analysis/extras/study/study_project.h"
#include "tests/core/io/damage.h"
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
  std::filesystem::remove(folder() / "manifest.json");
  EXPECT_EQ(MessageOfReading(),
            folder().string() +
                ": must be a finished study (got 1 of 6 approaches and no manifest.json); the "
                "command that began it, railcast-analyze study, continues it");
}

// A line that was changed is no line that is yet to be made.
TEST_F(FinishedStudies, AreRefusedByALineThatWasChanged) {
  Make();
  std::filesystem::remove(folder() / "manifest.json");
  const auto lines = folder() / "approaches.jsonl";
  const std::string text = ReadFileWhole(lines);
  for (const std::size_t line : {0U, 2U, 5U}) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < line; ++i) at = text.find('\n', at) + 1;
    WriteFileWhole(lines, Flipped(text, text.find("\"seed\":", at) + 8));
    EXPECT_THAT(MessageOfReading(),
                testing::StartsWith(lines.string() + ":" + std::to_string(line + 1) +
                                    ": /line_xxh3: must be "));
  }
  // The end of an interrupted line is only missing.
  WriteFileWhole(lines, text.substr(0, text.size() - 5));
  EXPECT_THAT(MessageOfReading(), testing::HasSubstr("got 5 of 6 approaches"));
}

TEST_F(FinishedStudies, AreStudies) {
  EXPECT_THAT(MessageOfReading(), testing::EndsWith("study.json: no such file or directory"));
  for (const auto& [file, kind] : std::vector<std::pair<std::string, std::string>>{
           {"dataset.json", "a data set"}, {"insert.jsonl", "a recording with insertions"}}) {
    std::filesystem::create_directories(folder());
    WriteFileWhole(folder() / file, "");
    EXPECT_EQ(MessageOfReading(), folder().string() + ": must be a study (got " + kind + ")");
    std::filesystem::remove(folder() / file);
  }
}

class VerifiedStudies : public FinishedStudies {
 protected:
  /// The fault lines, each without the folder.
  [[nodiscard]] std::vector<std::string> Faults() const {
    std::vector<std::string> faults = VerifyStudy(folder(), [](double) {}).faults;
    for (std::string& fault : faults) fault.erase(0, folder().string().size() + 1);
    return faults;
  }
};

TEST_F(VerifiedStudies, AreWholeAsTheyWereWritten) {
  Make();
  const Verification found = VerifyStudy(folder(), [](double) {});
  EXPECT_THAT(found.faults, testing::IsEmpty());
  EXPECT_THAT(found.unchecked, testing::IsEmpty());
  EXPECT_EQ(found.num_files, 4U + 6U);
  WriteFileWhole(folder() / "report.html", "drawn");
  EXPECT_THAT(VerifyStudy(folder(), [](double) {}).unchecked,
              testing::ElementsAre(folder().string() +
                                   ": its report, csv and charts have no hashes; the same command "
                                   "writes them anew"));
}

TEST_F(VerifiedStudies, AreChangedWithAnyByte) {
  Make();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder())) {
    if (!entry.is_regular_file()) continue;
    const std::string bytes = ReadFileWhole(entry.path());
    WriteFileWhole(entry.path(), Flipped(bytes, bytes.size() / 2));
    const std::string name = entry.path().lexically_relative(folder()).string();
    std::vector<std::string> faults;
    const std::string message = MessageOf([&] { faults = Faults(); });
    // Without its record, a study cannot be verified.
    if (message != "no error") {
      EXPECT_THAT(message, testing::StartsWith(entry.path().string() + ":"));
    } else {
      EXPECT_THAT(faults, testing::Contains(testing::StartsWith(name + ":"))) << name;
    }
    WriteFileWhole(entry.path(), bytes);
  }
}

TEST_F(VerifiedStudies, HaveTheFilesThatTheirManifestNames) {
  Make();
  WriteFileWhole(folder() / "sample/notes.txt", "mine");
  EXPECT_THAT(Faults(), testing::ElementsAre("sample/notes.txt: is not named in manifest.json"));
  std::filesystem::remove(folder() / "sample/notes.txt");
  std::filesystem::remove(folder() / "inputs/recipe.json");
  EXPECT_THAT(Faults(), testing::ElementsAre("inputs/recipe.json: no such file or directory"));
  std::filesystem::remove(folder() / "manifest.json");
  const std::string lines = ReadFileWhole(folder() / "approaches.jsonl");
  WriteFileWhole(folder() / "approaches.jsonl", lines.substr(0, lines.find('\n') + 9));
  EXPECT_THAT(Faults(),
              testing::ElementsAre("manifest.json: missing: the study is unfinished",
                                   "approaches.jsonl: must have a line for each of 6 approaches "
                                   "(got 1)"));
}

// Of rare failures, a recipe does not say how many approaches there are.
TEST_F(VerifiedStudies, AreReadWithoutProgressBeyondTheirEnd) {
  Make();
  const auto file = folder() / "study.json";
  nlohmann::json identity = nlohmann::json::parse(ReadFileWhole(file));
  for (const bool is_rare : {false, true}) {
    for (const int num_scenarios : {1, 2, 6, 12}) {
      if (is_rare) identity["rare"] = "per_stage 300";
      identity["num_scenarios"] = num_scenarios;
      WriteFileWhole(file, identity.dump());
      std::vector<double> shares;
      (void)VerifyStudy(folder(), [&](double share) { shares.push_back(share); });
      EXPECT_EQ(shares.size(), is_rare ? 0U : 6U);
      EXPECT_THAT(shares, testing::Each(testing::AllOf(testing::Ge(0.0), testing::Le(1.0))));
    }
  }
}

TEST_F(VerifiedStudies, MayBeShards) {
  MakeKeptStudy(folder(), {.number = 2, .of = 3});
  // They keep no files.
  for (const char* const name : {"manifest.json", "inputs", "sample"}) {
    std::filesystem::remove_all(folder() / name);
  }
  EXPECT_THAT(Faults(), testing::IsEmpty());
  const std::string lines = ReadFileWhole(folder() / "approaches.jsonl");
  WriteFileWhole(folder() / "approaches.jsonl", lines.substr(lines.find('\n') + 1));
  EXPECT_THAT(Faults(), testing::ElementsAre(
                            "approaches.jsonl:1: must be the line of scenario 1 (got 4)",
                            "approaches.jsonl: must have a line for each of 2 approaches (got 1)"));
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
