#include "generator/dataset/scenario_lines.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

class ScenarioLinesTest : public testing::Test {
 protected:
  void Write(const std::string& text) const {
    WriteFileWhole(directory_.path() / "scenarios.jsonl", text);
  }
  [[nodiscard]] ScenarioLines Open() const { return {directory_.path(), {2, 3}}; }
  TemporaryDirectory directory_;
};

TEST_F(ScenarioLinesTest, ComeOneAfterTheOtherAlsoAfterAPause) {
  Write("{\"scenario\":1}\n{\"scenario\":4}\n{\"scenario\":7}\n");
  ScenarioLines lines = Open();
  for (const int expected : {1, 4, 7}) {
    const auto line = lines.Next();
    ASSERT_TRUE(line);
    EXPECT_EQ(line->at("scenario"), expected);
    lines.Pause();
  }
  EXPECT_FALSE(lines.Next());
  EXPECT_EQ(lines.size(), 3U * 15U);
}

TEST_F(ScenarioLinesTest, EndBeforeALineThatIsNotTheShardsNext) {
  const std::string first = "{\"scenario\":1}\n";
  for (const std::string rest :
       {"", "{\"scenario\":4}", "{\"scenario\":2}\n", "{\"scen\n", "[]\n", "{}\n"}) {
    Write(first + rest);
    ScenarioLines lines = Open();
    EXPECT_EQ(lines.Skip(), 1U) << rest;
    EXPECT_EQ(lines.size(), first.size());
    EXPECT_FALSE(lines.Next());
  }
}

TEST_F(ScenarioLinesTest, AreSkippedAsFarAsIsAskedFor) {
  Write("{\"scenario\":1}\n{\"scenario\":4}\n");
  ScenarioLines lines = Open();
  EXPECT_EQ(lines.Skip(1), 1U);
  EXPECT_EQ(lines.Next()->at("scenario"), 4);
  EXPECT_EQ(lines.Skip(1), 0U);
}

TEST_F(ScenarioLinesTest, AreNoneWithoutAFile) {
  EXPECT_EQ(Open().Skip(), 0U);
}

}  // namespace
}  // namespace railcast
