#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/run/scenario_identity.h"
#include "core/io/write_file.h"
#include "core/scenario/command_log.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A project's scenario, logs of runs of it, and sequences made from both.
class Replay : public testing::Test {
 protected:
  fs::path WriteLog(const std::string& name, const std::vector<TimedCommand>& commands) const {
    const CommandLog log{IdentityOf(ReadScenario(scenario_)).scenario_hash, commands};
    WriteFileWhole(folder_.path() / name, CommandLogText(log));
    return folder_.path() / name;
  }
  Ended Sequence(const std::string& out, const std::string& options) const {
    return Generate("sequence " + scenario_.string() + " --frames 6 --out " + Out(out).string() +
                    " " + options);
  }
  fs::path Out(const std::string& out) const { return folder_.path() / out; }

  static std::vector<TimedCommand> PersonForAWhile() {
    PlaceObject place;
    place.object.name = "bob";
    place.object.type = ObjectType::kPerson;
    place.object.s_m = 420.0;
    return {{200'000'000, place}, {400'000'000, RemoveObject{"bob"}}};
  }

 private:
  TemporaryDirectory folder_;

 protected:
  fs::path scenario_ = MakeProject(folder_.path() / "project");
};

TEST_F(Replay, OfAnEmptyLogIsTheScenariosOwnSequence) {
  EXPECT_EQ(Sequence("plain", "").status, 0);
  EXPECT_THAT(Sequence("replay", "--commands " + WriteLog("empty.jsonl", {}).string()),
              ExitsWith(0));
  EXPECT_EQ(Contents(Out("replay")), Contents(Out("plain")));
}

TEST_F(Replay, DescribesAPlacedObjectWhileItIsThere) {
  const fs::path log = WriteLog("log.jsonl", PersonForAWhile());
  ASSERT_THAT(Sequence("out", "--commands " + log.string()), ExitsWith(0));
  const auto contents = Contents(Out("out"));
  std::istringstream lines(contents.at("objects.jsonl"));
  std::string line;
  for (int frame = 0; std::getline(lines, line); ++frame) {
    const bool is_there = frame == 2 || frame == 3;
    EXPECT_EQ(line.find("\"bob\"") != std::string::npos, is_there) << line;
    EXPECT_NE(line.find("\"rock\""), std::string::npos);
  }
  EXPECT_EQ(contents.at("commands.jsonl"), ReadFileWhole(log));
  EXPECT_NE(contents.at("manifest.json").find("commands.jsonl"), std::string::npos);
}

TEST_F(Replay, ContinuesWhereItWasInterrupted) {
  const std::string log = "--commands " + WriteLog("log.jsonl", PersonForAWhile()).string();
  ASSERT_EQ(Sequence("whole", log).status, 0);
  ASSERT_EQ(Sequence("torn", log).status, 0);
  fs::remove(Out("torn") / "manifest.json");
  fs::remove(Out("torn") / "frames/000003.pcd");
  EXPECT_EQ(Sequence("torn", log).status, 0);
  EXPECT_EQ(Contents(Out("torn")), Contents(Out("whole")));
}

TEST_F(Replay, BelongsToItsCommands) {
  const std::string log = "--commands " + WriteLog("log.jsonl", PersonForAWhile()).string();
  const std::string other = "--commands " + WriteLog("other.jsonl", {{0, Stop{}}}).string();
  const std::string place = Out("out").string() + ": ";
  ASSERT_EQ(Sequence("out", log).status, 0);
  EXPECT_EQ(Sequence("out", other).said,
            place + "holds a run with other commands; choose another --out\n");
  EXPECT_EQ(Sequence("out", "").said, place + "holds a run with commands; choose another --out\n");
  ASSERT_EQ(Sequence("plain", "").status, 0);
  EXPECT_EQ(Sequence("plain", log).said,
            Out("plain").string() + ": holds a run with other commands; choose another --out\n");
}

TEST_F(Replay, RefusesTheLogOfAnotherScenario) {
  const fs::path log = WriteLog("log.jsonl", PersonForAWhile());
  EXPECT_THAT(
      Sequence("out", "--seed 9 --commands " + log.string()),
      ExitsWith(1, testing::StartsWith(
                       log.string() +
                       ": must be the log of this scenario with this --seed and --fidelity, ")));
  EXPECT_FALSE(fs::exists(Out("out")));
}

TEST_F(Replay, SaysWhichCommandOfALogDoesNotFit) {
  const fs::path log = WriteLog("log.jsonl", {{1'500'000'000, RemoveObject{"bob"}}});
  EXPECT_EQ(Sequence("out", "--commands " + log.string()).said,
            log.string() +
                ": at 1.5 s: command: /name: must be the name of an object that is there (got "
                "\"bob\")\n");
  const fs::path fast = WriteLog("fast.jsonl", {{0, SetSpeed{200.0, 10.0}}});
  EXPECT_EQ(Generate("sequence " + scenario_.string() + " --frames 200 --out " +
                     Out("out").string() + " --commands " + fast.string())
                .said,
            "command: the vehicle leaves track \"main\", from 0 to 1000 m, at frame 110 (11 s)\n");
}

}  // namespace
}  // namespace railcast
