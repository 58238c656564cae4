#include "core/scenario/command.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scenario/command_log.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

std::vector<Command> OneOfEachCommand() {
  PlaceObject place{ObjectAt("bob \"the\" builder \xC3\xA4", ObjectType::kPerson, 2240.25, -0.1)};
  place.object.h_m = 0.0;
  place.object.size_m = {0.5, 0.5, 1.9};
  place.object.material = "clothing";
  place.object.motion = MotionSpec{{{0.0, std::nullopt, 1.25}}, true};
  PlaceObject on_map{ObjectAt("b", ObjectType::kPerson, 0.0)};
  on_map.object.longitude_deg = 15.7528944;
  on_map.object.latitude_deg = 48.2396283;
  SetWeather weather;
  weather.weather.visibility_m = 80.0;
  weather.weather.snow_rate_mmph = 1.5;
  weather.weather.sun.illuminance_klx = 60.0;
  return {SetSpeed{11.1, 0.3},   Brake{0.7}, Stop{}, place,  on_map,
          RemoveObject{"wagon"}, weather,    Step{}, Reset{}};
}

// All faults of a line in one string.
std::string LineFaultsOf(const std::string& line) {
  const CommandLine read = ReadCommand(line);
  EXPECT_EQ(read.command.has_value(), read.faults.empty());
  std::string faults;
  for (const std::string& fault : read.faults) faults += (faults.empty() ? "" : "\n") + fault;
  return faults;
}

TEST(Command, IsReadAsItIsWritten) {
  for (const Command& command : OneOfEachCommand()) {
    const CommandTag tag{"k3v9 \xC3\xA4", 9'007'199'254'740'992U};
    const std::string line = WriteCommand(command, tag);
    const CommandLine read = ReadCommand(line);
    ASSERT_TRUE(read.faults.empty()) << line << "\n" << read.faults.front();
    EXPECT_EQ(*read.command, command) << line;
    EXPECT_EQ(read.tag, tag);
    EXPECT_EQ(WriteCommand(*read.command, read.tag), line);
  }
}

TEST(Command, TakesDefaultsForWhatIsLeftOut) {
  const CommandLine speed =
      ReadCommand(R"({"session": "a", "id": 7, "command": "set_speed", "speed_mps": 10})");
  EXPECT_EQ(speed.command, Command(SetSpeed{10.0, 0.5}));
  EXPECT_EQ(speed.tag, (CommandTag{"a", 7U}));
  const CommandLine brake = ReadCommand("{\"command\": \"brake\"}\n");
  EXPECT_EQ(brake.command, Command(Brake{0.5}));
  EXPECT_EQ(brake.tag, CommandTag{});
  const CommandLine weather =
      ReadCommand(R"({"command": "set_weather", "weather": {"rain_intensity": 0.5}})");
  WeatherSpec rain;
  rain.rain_rate_mmph = 25.0;
  EXPECT_EQ(weather.command, Command(SetWeather{rain}));
}

TEST(Command, IsWrittenOnOneLine) {
  EXPECT_EQ(
      WriteCommand(SetSpeed{10.0, 0.5}, {"a", 7}),
      R"({"session":"a","id":7,"command":"set_speed","speed_mps":10.0,"acceleration_mps2":0.5})");
  EXPECT_EQ(WriteCommand(Stop{}), R"({"command":"stop"})");
}

TEST(Command, SaysWhatIsWrongWithALine) {
  EXPECT_EQ(LineFaultsOf(""), "command: is empty");
  EXPECT_EQ(LineFaultsOf("[]"), "command: must be an object (got [])");
  EXPECT_EQ(LineFaultsOf("{}"), "command: /command: missing");
  EXPECT_EQ(LineFaultsOf(R"({"command": "dance"})"),
            "command: /command: must be \"set_speed\", \"brake\", \"stop\", \"place_object\", "
            "\"remove_object\", \"set_weather\", \"step\" or \"reset\" (got \"dance\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_speed"})"), "command: /speed_mps: missing");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_speed", "speed_mps": -1})"),
            "command: /speed_mps: must be >= 0 and <= 200 (got -1)");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_speed", "speed_mps": "fast"})"),
            "command: /speed_mps: must be a number (got \"fast\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_speed", "speed_mps": 1, "speed_mps": 2})"),
            "command: /speed_mps: duplicate key");
  EXPECT_EQ(LineFaultsOf(R"({"command": "brake", "decelaration_mps2": 1})"),
            "command: /decelaration_mps2: unknown key, the nearest is \"deceleration_mps2\"");
  EXPECT_EQ(LineFaultsOf(R"({"command": "stop", "zzzzzzz": 1})"),
            "command: /zzzzzzz: unknown key, must be \"session\", \"id\" or \"command\"");
  EXPECT_EQ(LineFaultsOf(R"({"command": "brake", "deceleration_mps2": 0})"),
            "command: /deceleration_mps2: must be >= 0.001 and <= 10 (got 0)");
  EXPECT_EQ(LineFaultsOf(R"({"command": "place_object", "object": {"name": "a", "type": "box",
                         "s_m": 1}})"),
            "command: /object/size_m: must be given for type \"box\"");
  EXPECT_EQ(LineFaultsOf("{\"command\": \"stop\"} {}"),
            "command: line 1, column 21: syntax error while parsing value - unexpected '{'; "
            "expected end of input");
}

TEST(Command, KeepsTheTagOfAFaultyLineForTheAnswer) {
  const CommandTag tag{"a", 5U};
  EXPECT_EQ(ReadCommand(R"({"session": "a", "id": 5, "command": "dance"})").tag, tag);
  EXPECT_EQ(ReadCommand(R"({"session": "a", "id": 5, "command": "set_speed"})").tag, tag);
  const CommandLine broken = ReadCommand(R"({"session": "a", "id": -5, "command": "stop"})");
  EXPECT_EQ(broken.tag, (CommandTag{"a", std::nullopt}));
  EXPECT_EQ(broken.faults, (std::vector<std::string>{
                               "command: /id: must be a whole number from 0 to 9007199254740992 "
                               "(got -5)"}));
}

TEST(Command, HasASessionAndAnIdOrNeither) {
  const CommandLine alone = ReadCommand(R"({"id": 5, "command": "stop"})");
  EXPECT_EQ(alone.faults,
            (std::vector<std::string>{"command: /id: must be given with session, which a client "
                                      "chooses when it starts"}));
  EXPECT_EQ(alone.tag, (CommandTag{std::nullopt, 5U}));
  EXPECT_EQ(LineFaultsOf(R"({"session": "a", "command": "stop"})"),
            "command: /session: must be given with id");
  EXPECT_EQ(LineFaultsOf(R"({"session": "", "id": 1, "command": "stop"})"),
            "command: /session: must not be empty (got \"\")");
  EXPECT_EQ(LineFaultsOf(R"({"session": 7, "id": 1, "command": "stop"})"),
            "command: /session: must be a string (got 7)");
  const std::string longest(kMaxSessionBytes, 's');
  EXPECT_EQ(LineFaultsOf(R"({"session": ")" + longest + R"(", "id": 1, "command": "stop"})"), "");
  EXPECT_EQ(LineFaultsOf(R"({"session": ")" + longest + R"(x", "id": 1, "command": "stop"})")
                .find("command: /session: must have at most 64 bytes (got \"sss"),
            0U);
}

// A peer must not be able to make the simulator read files or to learn from its answers which files
// exist.
TEST(Command, NamesNoFiles) {
  EXPECT_EQ(
      LineFaultsOf(R"({"command": "place_object", "object": {"name": "a", "type": "mesh",
                         "s_m": 1, "file": "/etc/passwd"}})"),
      "command: /object/type: must be no mesh, since a command reads no files (got \"mesh\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "place_object", "object": "/etc/passwd"})"),
            "command: /object: must not name a file (got \"/etc/passwd\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_weather", "weather": "/etc/passwd"})"),
            "command: /weather: must not name a file (got \"/etc/passwd\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_weather", "weather": {"file": "/no/such/file"}})"),
            "command: /weather/file: must not name a file (got \"/no/such/file\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_weather", "weather": {"sun": "/etc/passwd"}})"),
            "command: /weather/sun: must not name a file (got \"/etc/passwd\")");
  EXPECT_EQ(LineFaultsOf(R"({"command": "place_object", "object": {"name": "a", "type": "person",
                         "s_m": 1, "motion": "/etc/passwd"}})"),
            "command: /object/motion: must not name a file (got \"/etc/passwd\")");
}

TEST(Command, SurvivesHostileLines) {
  EXPECT_EQ(LineFaultsOf(std::string(65'507, '[')),
            "command: must be at most 8192 bytes long (got 65507)");
  EXPECT_EQ(LineFaultsOf(std::string(8000, '[')), "command: nested deeper than 64 levels");
  EXPECT_EQ(LineFaultsOf("{\"command\": \"sto\xFFp\"}").find("command: line 1, column "), 0U);
  EXPECT_EQ(LineFaultsOf(R"({"command": "set_speed", "speed_mps": 1e999})"),
            "command: line 1, column 43: number too large for a double");
  EXPECT_EQ(LineFaultsOf(R"({"session": "a", "id": 1e300, "command": "stop"})"),
            "command: /id: must be a whole number from 0 to 9007199254740992 (got 1e+300)");
  EXPECT_EQ(LineFaultsOf(std::string("\0{}", 3)).find("command: line 1, column 1: "), 0U);
}

TEST(Command, SaysEachFaultOnOneLine) {
  EXPECT_EQ(
      LineFaultsOf(R"({"command": "stop", "a\nb\u0000\u001b": 1})"),
      "command: /a\\nb\\u0000\\u001b: unknown key, must be \"session\", \"id\" or \"command\"");
}

TEST(Command, AnswersManyFaultsInFewWords) {
  std::string line = R"({"command": "stop")";
  for (int i = 0; i < 500; ++i) line += ", \"k" + std::to_string(i) + "\": 1";
  const CommandLine read = ReadCommand(line + "}");
  EXPECT_EQ(read.faults.size(), 9U);
  EXPECT_EQ(read.faults.back(), "command: 492 more");
  const CommandLine cut =
      ReadCommand(R"({"command": "set_weather", "weather": {"zzzzzzzzzzzzzzz": 1}})");
  ASSERT_EQ(cut.faults.size(), 1U);
  EXPECT_LE(cut.faults.front().size(), 303U);
  EXPECT_TRUE(cut.faults.front().ends_with("...")) << cut.faults.front();
}

TEST(Command, CutsALongKeyBetweenLetters) {
  std::string name;
  for (int i = 0; i < 1000; ++i) name += "\xC3\xA4";  // Two bytes each.
  EXPECT_EQ(LineFaultsOf("{\"command\": \"stop\", \"" + name + "\": 1}"),
            "command: /" + name.substr(0, 60) +
                "...: unknown key, must be \"session\", \"id\" or \"command\"");
}

constexpr const char* kLogHeader = "{\"railcast_commands\":2,\"scenario_xxh3\":\"5ce0a410\"}\n";
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
  const PlaceObject place{ObjectAt("bob", ObjectType::kPerson, 2240.1)};
  const CommandLog log{"5ce0a410",
                       {{0, SetSpeed{11.1, 0.3}},
                        {1'500'000'001, place},
                        {1'500'000'001, Stop{}},
                        {9'000'000'000'000'000, RemoveObject{"bob"}}}};
  const std::string text = CommandLogText(log);
  EXPECT_EQ(text.find(kLogHeader), 0U);
  EXPECT_EQ(Read(text), log);
  EXPECT_EQ(CommandLogText(Read(text)), text);
}

TEST_F(CommandLogFile, IsEmptyWhereNothingWasCommanded) {
  EXPECT_EQ(Read(kLogHeader + CommandLogEnd(0)), (CommandLog{"5ce0a410", {}}));
  EXPECT_EQ(Read(kOldHeader), (CommandLog{"5ce0a410", {}}));
}

TEST_F(CommandLogFile, SaysWhatCameAfterTheLastReset) {
  std::string text = kLogHeader;
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
    std::string text = kLogHeader;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (i != missing) text += lines[i];
    }
    EXPECT_EQ(FaultOf(text), faults[missing]);
  }
  EXPECT_EQ(FaultOf(kLogHeader + CommandLogEnd(0) + CommandLogEnd(0)),
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
  EXPECT_EQ(FaultOf(kLogHeader + CommandLogLine({7, Stop{}}, 1) + CommandLogLine({6, Stop{}}, 2)),
            "line 3: /time_ns: must be at least 7, that of the command before it (got 6)");
  EXPECT_EQ(FaultOf(std::string(kOldHeader) +
                    "{\"time_ns\": 0, \"when\": 1, \"command\": {\"command\": \"stop\"}}\n"),
            "line 2: /when: unknown key, must be \"time_ns\" or \"command\"");
  EXPECT_EQ(
      FaultOf(std::string(kLogHeader) + "{\"time_ns\": 0, \"command\": {\"command\": \"stop\"}}\n"),
      "line 2: /number: missing");
}

}  // namespace
}  // namespace railcast
