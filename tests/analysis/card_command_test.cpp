#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/made_dataset.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::MatchesRegex;
using Json = nlohmann::json;

TEST(CardCommand, ShowsWhatADataSetHoldsAndWhatItWasMadeOf) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "--format mcap --fields x,y,z,label");
  const fs::path out = set.parent_path() / "card";
  const Ended run = Analyze("card " + set.string() + "/ --licence CC-BY-4.0 --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("README.md in " + out.string()));
  const std::string card = ReadFileWhole(out / "README.md");
  EXPECT_TRUE(card.starts_with("# Data set set\n\n- **Licence**: CC-BY-4.0\n")) << card;
  EXPECT_THAT(card, HasSubstr("- **Frames**: 6\n"));
  EXPECT_THAT(card, HasSubstr("| Seed | 1 |\n"));
  EXPECT_THAT(card, HasSubstr("--format mcap --fields x,y,z,label --isa "));
  EXPECT_THAT(card, HasSubstr("## What is not modelled\n"));
  // Classes with the numbers of the data set's own report.
  const Json report = Json::parse(ReadFileWhole(set / "report.json"));
  ASSERT_GT(report["labels"].size(), 1U);
  for (const auto& [label, counts] : report["labels"].items()) {
    const std::string points = std::to_string(counts["points"].get<int>());
    const std::string name = std::regex_replace(label, std::regex("_"), "\\_");
    const auto row = card.find("| " + name + " | ");
    ASSERT_NE(row, std::string::npos) << label;
    const std::string line = card.substr(row, card.find('\n', row) - row);
    EXPECT_EQ(std::regex_replace(line, std::regex(","), "").find("| " + name + " | " + points), 0U)
        << line;
  }
}

// A card is copied with its pictures to wherever the data set is given away.
TEST(CardCommand, RefersOnlyToFilesThatItWrote) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  const fs::path out = set.parent_path() / "card";
  ASSERT_EQ(Analyze("card " + set.string() + " --out " + out.string()).status, 0);
  const std::string card = ReadFileWhole(out / "README.md");
  EXPECT_THAT(card, HasSubstr("- **Licence**: not stated\n"));
  const std::regex link(R"(\]\(([^)]*)\))");
  std::size_t num_pictures = 0;
  for (std::sregex_iterator i(card.begin(), card.end(), link), end; i != end; ++i) {
    const fs::path file = out / (*i)[1].str();
    EXPECT_TRUE(fs::is_regular_file(file)) << file;
    num_pictures += file.extension() == ".png" ? 1 : 0;
  }
  EXPECT_GE(num_pictures, 2U);
  EXPECT_EQ(Analyze("verify " + set.string()).status, 0);
}

TEST(CardCommand, RefusesWhatIsNoWholeDataSetInOneLine) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "--shard 1/2");
  const Ended shard = Analyze("card " + set.string() + " --format text");
  EXPECT_EQ(shard.status, 1);
  EXPECT_EQ(shard.said, set.string() +
                            ": must be a whole data set (got shard 1/2); railcast-generate merge "
                            "makes one of shards\n");
  const fs::path sequence = set / "sequences/000/000000";
  const Ended other = Analyze("card " + sequence.string() + " --format text");
  EXPECT_EQ(other.status, 1);
  EXPECT_EQ(other.said, sequence.string() + ": must be a data set of railcast-generate dataset\n");
}

TEST(CardCommand, KeepsOutOfTheDataSet) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  const fs::path out = set / "card";
  const Ended run = Analyze("card " + set.string() + " --out " + out.string());
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said,
            "--out: must be outside the data set, which holds nothing but its own files (got " +
                out.string() + ")\n");
  EXPECT_FALSE(fs::exists(out));
}

TEST(CardCommand, RefusesARecipeThatHasChanged) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  WriteFileWhole(set / "recipe.json", "{}");
  const Ended run = Analyze("card " + set.string() + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said,
              MatchesRegex((set / "recipe.json").string() + ": [^\n]*manifest.json[^\n]*\n"));
}

}  // namespace
}  // namespace railcast
