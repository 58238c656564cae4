#include "core/extras/recipe/scenario_lines.h"

#include <gtest/gtest.h>

#include <string>

#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

class ScenarioLinesTest : public testing::Test {
 protected:
  void Write(const std::string& text) const {
    WriteFileWhole(directory_.path() / "scenarios.jsonl", text);
  }
  [[nodiscard]] ScenarioLines Open() const {
    return {directory_.path() / "scenarios.jsonl", {2, 3}};
  }
  TemporaryDirectory directory_;
};

/// A line of scenarios.jsonl.
std::string LineOf(int scenario) {
  return WithLineHash("{\"scenario\":" + std::to_string(scenario) + "}") + "\n";
}

TEST_F(ScenarioLinesTest, ComeOneAfterTheOtherAlsoAfterAPause) {
  Write(LineOf(1) + LineOf(4) + LineOf(7));
  ScenarioLines lines = Open();
  for (const int expected : {1, 4, 7}) {
    const auto line = lines.Next();
    ASSERT_TRUE(line);
    EXPECT_EQ(line->text + "\n", LineOf(expected));
    lines.Pause();
  }
  EXPECT_FALSE(lines.Next());
  EXPECT_EQ(lines.size(), 3U * LineOf(1).size());
}

TEST_F(ScenarioLinesTest, EndBeforeALineThatIsNotTheShardsNext) {
  const std::string first = LineOf(1);
  std::string changed = LineOf(4);
  changed.replace(changed.find("4"), 1, "04");
  const std::string torn = LineOf(4).substr(0, LineOf(4).size() - 1);
  for (const std::string& rest :
       {std::string(), torn, LineOf(2), changed, std::string("{\"scenario\":4}\n"),
        std::string("{\"scen\n"), std::string("[]\n"), std::string("{}\n")}) {
    Write(first + rest);
    ScenarioLines lines = Open();
    EXPECT_EQ(lines.Skip(), 1U) << rest;
    EXPECT_EQ(lines.size(), first.size());
    EXPECT_FALSE(lines.Next());
  }
}

TEST_F(ScenarioLinesTest, AreSkippedAsFarAsIsAskedFor) {
  Write(LineOf(1) + LineOf(4));
  ScenarioLines lines = Open();
  EXPECT_EQ(lines.Skip(1), 1U);
  EXPECT_EQ(lines.Next()->text + "\n", LineOf(4));
  EXPECT_EQ(lines.Skip(1), 0U);
}

TEST_F(ScenarioLinesTest, OfFinishedScenariosAreNamedIfTheyAreNotAsTheyWereWritten) {
  const std::string file = (directory_.path() / "scenarios.jsonl").string();
  const auto message = [&](const std::string& second) {
    Write(LineOf(1) + second);
    ScenarioLines lines = Open();
    EXPECT_EQ(lines.Need().text + "\n", LineOf(1));
    return MessageOf([&] { (void)lines.Need(); });
  };
  EXPECT_EQ(message(""), file + ":2: missing");
  EXPECT_EQ(message(LineOf(2)), file + ":2: must be the line of scenario 4 (got 2)");
  EXPECT_EQ(message("{\"scen\n"), file + ":2: must end with line_xxh3, the hash of all before it");
  EXPECT_EQ(message("{\"scenario\":4}\n"),
            file + ":2: must end with line_xxh3, the hash of all before it");
}

TEST_F(ScenarioLinesTest, AreNoneWithoutAFile) {
  EXPECT_EQ(Open().Skip(), 0U);
}

}  // namespace
}  // namespace railcast
