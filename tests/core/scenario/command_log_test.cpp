#include "core/scenario/command_log.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

constexpr const char* kHeader = "{\"railcast_commands\":2,\"scenario_xxh3\":\"5ce0a410\"}\n";
/// Of logs without counts.
constexpr const char* kOldHeader = "{\"railcast_commands\":1,\"scenario_xxh3\":\"5ce0a410\"}\n";

class CommandLogFile : public testing::Test {
 protected:
  CommandLog Read(const std::string& text) const {
    return ReadCommandLog(folder_.Write("log.jsonl", text));
  }
  // The message about a faulty log, without the name of its file.
  std::string FaultOf(const std::string& text) const {
    try {
      static_cast<void>(Read(text));
    } catch (const InputError& error) {
      const std::string said = error.what();
      return said.substr(said.find("log.jsonl: ") + 11);
    }
    return "none";
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(CommandLogFile, IsReadAsItIsWritten) {
  PlaceObject place;
  place.object.name = "bob";
  place.object.type = ObjectType::kPerson;
  place.object.s_m = 2240.1;
  const CommandLog log{"5ce0a410",
                       {{0, SetSpeed{11.1, 0.3}},
                        {1'500'000'001, place},
                        {1'500'000'001, Stop{}},
                        {9'000'000'000'000'000, RemoveObject{"bob"}}}};
  const std::string text = CommandLogText(log);
  EXPECT_EQ(text.find(kHeader), 0U);
  EXPECT_EQ(Read(text), log);
  EXPECT_EQ(CommandLogText(Read(text)), text);
}

TEST_F(CommandLogFile, IsEmptyWhereNothingWasCommanded) {
  EXPECT_EQ(Read(kHeader + CommandLogEnd(0)), (CommandLog{"5ce0a410", {}}));
  EXPECT_EQ(Read(kOldHeader), (CommandLog{"5ce0a410", {}}));
}

TEST_F(CommandLogFile, SaysWhatCameAfterTheLastReset) {
  std::string text = kHeader;
  text += CommandLogLine({5'000'000'000, Brake{}}, 1);
  text += CommandLogLine({0, Reset{}}, 2);
  text += CommandLogLine({100'000'000, Stop{}}, 3);
  text += CommandLogEnd(3);
  EXPECT_EQ(Read(text), (CommandLog{"5ce0a410", {{100'000'000, Stop{}}}}));
}

TEST_F(CommandLogFile, LeavesStepsOut) {
  const std::string step = "{\"time_ns\": 3, \"command\": {\"command\": \"step\"}}\n";
  EXPECT_EQ(Read(kOldHeader + step).commands.size(), 0U);
}

TEST_F(CommandLogFile, NoticesThatALineIsMissing) {
  const std::vector<std::string> lines = {CommandLogLine({5, Brake{}}, 1),
                                          CommandLogLine({0, Reset{}}, 2),
                                          CommandLogLine({7, Stop{}}, 3), CommandLogEnd(3)};
  const std::string counted =
      ", the count of the commands up to here: lines are missing or were added ";
  const std::vector<std::string> faults = {
      "line 2: /number: must be 1" + counted + "(got 2)",
      "line 3: /number: must be 2" + counted + "(got 3)",
      "line 4: /num_commands: must be 2" + counted + "(got 3)",
      R"(must end in {"num_commands":3}, unless the run was killed or lines are missing)"};
  for (std::size_t missing = 0; missing < lines.size(); ++missing) {
    std::string text = kHeader;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (i != missing) text += lines[i];
    }
    EXPECT_EQ(FaultOf(text), faults[missing]);
  }
  EXPECT_EQ(FaultOf(kHeader + CommandLogEnd(0) + CommandLogEnd(0)),
            "line 3: must not come after the log's end");
}

TEST_F(CommandLogFile, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(FaultOf(""), "is empty");
  EXPECT_EQ(FaultOf("{\"time_ns\": 0, \"command\": {\"command\": \"stop\"}}\n"),
            "line 1: must be {\"railcast_commands\": 2, \"scenario_xxh3\": ...}");
  EXPECT_EQ(FaultOf(std::string(kOldHeader) + "{\"time_ns\": 0}\n"), "line 2: /command: missing");
  EXPECT_EQ(FaultOf(std::string(kOldHeader) +
                    "{\"time_ns\": -1, \"command\": {\"command\": \"stop\"}}\n"),
            "line 2: /time_ns: must be a whole number from 0 to 3200000000000000000 (got -1)");
  EXPECT_EQ(FaultOf(std::string(kOldHeader) +
                    "{\"time_ns\": 0, \"command\": {\"command\": \"set_speed\"}}\n"),
            "line 2: /command/speed_mps: missing");
  const std::string torn = "{\"time_ns\": 0, \"command\": {\"command\": \"stop\"}}";
  EXPECT_EQ(FaultOf(kOldHeader + torn), "line 2: must end in a line break");
  EXPECT_EQ(FaultOf(kHeader + CommandLogLine({7, Stop{}}, 1) + CommandLogLine({6, Stop{}}, 2)),
            "line 3: /time_ns: must be at least 7, that of the command before it (got 6)");
  EXPECT_EQ(FaultOf(std::string(kOldHeader) +
                    "{\"time_ns\": 0, \"when\": 1, \"command\": {\"command\": \"stop\"}}\n"),
            "line 2: /when: unknown key, must be \"time_ns\" or \"command\"");
  EXPECT_EQ(
      FaultOf(std::string(kHeader) + "{\"time_ns\": 0, \"command\": {\"command\": \"stop\"}}\n"),
      "line 2: /number: missing");
}

}  // namespace
}  // namespace railcast
