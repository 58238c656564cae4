#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

void ExpectUsageError(const std::string& arguments, const std::string& line) {
  const Ended run = Generate(arguments);
  EXPECT_EQ(run.status, 2) << arguments;
  EXPECT_EQ(run.said, line + "\nRun with --help for more information.\n") << arguments;
}

TEST(CommandLine, TakesTheNumberOfAFrameAsItsFileHasIt) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path()).string();
  const auto out = directory.path() / "out";
  EXPECT_THAT(Generate("sequence " + scenario + " --frames 01 --start-frame 000018 --out " +
                       out.string() + " --seed 0010 --threads 01 --format pcd"),
              ExitsWith(0));
  EXPECT_TRUE(std::filesystem::exists(out / "frames/000018.pcd"));
  EXPECT_NE(ReadFileWhole(out / "manifest.json").find("\"seed\": 10,"), std::string::npos);
  const Ended traced = Generate("trace " + scenario + " --frame 000018 --firing 0000");
  EXPECT_EQ(traced.said.find("frame 18 firing 0 at 0 ns"), 0U) << traced.said;
}

TEST(CommandLine, TakesDecimalDigitsAloneForNumbers) {
  const std::string sequence = "sequence a.json --out b ";
  const std::string any = "must be a whole number from 0 to 18446744073709551615 (got ";
  for (const std::string seed :
       {"-1", "0x10", "18446744073709551616", "1e3", "99999999999999999999999"}) {
    ExpectUsageError(sequence + "--seed " + seed, "--seed: " + any + seed + ")");
    ExpectUsageError("stream a.json --seed " + seed, "--seed: " + any + seed + ")");
  }
  ExpectUsageError(sequence + "--frames 0",
                   "--frames: must be a whole number from 1 to 1000000000 (got 0)");
  ExpectUsageError(sequence + "--frames 0x10",
                   "--frames: must be a whole number from 1 to 1000000000 (got 0x10)");
  ExpectUsageError(sequence + "--start-frame -1",
                   "--start-frame: must be a whole number from 0 to 1000000000 (got -1)");
  ExpectUsageError(sequence + "--threads 1.0",
                   "--threads: must be a whole number from 0 to 1024 (got 1.0)");
  ExpectUsageError("trace a.json --firing 0b1",
                   "--firing: must be a whole number from 0 to 1000000000 (got 0b1)");
  ExpectUsageError("trace a.json --firing 1 --frame 4294967296",
                   "--frame: must be a whole number from 0 to 1000000000 (got 4294967296)");
  ExpectUsageError("stream a.json --commands-port 0x6b08",
                   "--commands-port: must be a whole number from 1 to 65535 (got 0x6b08)");
}

TEST(CommandLine, RefusesGroupsWithoutHopsWhichLeaveTheMachine) {
  ExpectUsageError("stream a.json --multicast-hops 0",
                   "--multicast-hops: must be a whole number from 1 to 255 (got 0)");
}

TEST(CommandLine, TakesNoNumberThatIsNone) {
  ExpectUsageError("stream a.json --duration nan",
                   "--duration: must be a number from 0.001 to 1e+09 (got nan)");
  ExpectUsageError("stream a.json --duration 0x10",
                   "--duration: must be a number from 0.001 to 1e+09 (got 0x10)");
  ExpectUsageError("world a.json --out a.ply --from-s inf --to-s 5",
                   "--from-s: must be a number from -1e+07 to 1e+07 (got inf)");
}

TEST(CommandLine, RefusesFramesWhoseStampsDoNotFitInto64Bits) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path()).string();
  std::string text = ReadFileWhole(scenario);
  text.replace(text.find("\"rate_hz\": 10"), 13, "\"rate_hz\": 0.01");
  WriteFileWhole(scenario, text);
  const std::string rule =
      ": must not lead beyond frame 92233720, since the next begins after 292 years at 0.01 Hz "
      "(got frame ";
  EXPECT_THAT(Generate("trace " + scenario + " --frame 100000000 --firing 0"),
              ExitsWith(1, "--frame" + rule + "100000000)\n"));
  const auto out = directory.path() / "out";
  EXPECT_THAT(
      Generate("sequence " + scenario + " --start-frame 92233720 --frames 2 --out " + out.string()),
      ExitsWith(1, "--start-frame, --frames" + rule + "92233721)\n"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(CommandLine, NamesAMisspeltCommand) {
  ExpectUsageError("chek a.json", "unknown command, the nearest is \"check\" (got chek)");
  ExpectUsageError(
      "dance",
      "unknown command, must be \"sequence\", \"insert\", \"convert\", \"stream\", \"replay\", "
      "\"check\", \"world\", "
      "\"trace\", \"dataset\", \"merge\", \"survey\" or \"import\" (got dance)");
  ExpectUsageError(
      "",
      "command: must be \"sequence\", \"insert\", \"convert\", \"stream\", \"replay\", \"check\", "
      "\"world\", \"trace\", \"dataset\", \"merge\", \"survey\" or \"import\" (got none)");
}

TEST(CommandLine, PrintsNoArgumentRaw) {
  ExpectUsageError(
      "\"$(printf 'a\\033[2Jb')\"",
      "unknown command, must be \"sequence\", \"insert\", \"convert\", \"stream\", \"replay\", "
      "\"check\", "
      "\"world\", "
      "\"trace\", \"dataset\", \"merge\", \"survey\" or \"import\" (got a\\u001b[2Jb)");
  ExpectUsageError("sequence a.json --out b \"--$(printf '\\033[2J')\"",
                   "unknown option (got --\\u001b[2J)");
  EXPECT_THAT(Generate("check a.json \"$(printf 'b\\033[2J')\""),
              ExitsWith(2, testing::Not(testing::HasSubstr("\033"))));
}

TEST(CommandLine, SaysInOneFormWhatIsMissingOrTooMuch) {
  ExpectUsageError("check", "SCENARIO: is required (got none)");
  ExpectUsageError("check a.json b.json", "too many arguments (got b.json)");
  ExpectUsageError("check a.json -x", "unknown option (got -x)");
  ExpectUsageError("sequence a.json --out", "--out: must have a value (got none)");
  ExpectUsageError("sequence a.json --out b --out c", "--out: must be given once (got 2 times)");
  ExpectUsageError(
      "sequence a.json --out b --fidelity publish",
      "--fidelity: must be \"geometry\", \"plausibility\", \"surface\", \"footprint\", "
      "\"reference\" or \"auto\" (got publish)");
  ExpectUsageError("insert a b.json --check --threads 1", "--threads: must not come with --check");
  ExpectUsageError("stream a.json --lockstep=foo", "--lockstep: must have no value (got foo)");
}

TEST(CommandLine, NamesTheOptionThatAMisspeltOneMayMean) {
  ExpectUsageError("sequence a.json --out b --fromat kitti",
                   "unknown option, the nearest is --format (got --fromat)");
  ExpectUsageError("sequence a.json --ot=b", "unknown option, the nearest is --out (got --ot)");
  ExpectUsageError("stream a.json --comands-port 1 --verbos",
                   "unknown option, the nearest is --commands-port (got --comands-port)");
  ExpectUsageError("check a.json --verbos",
                   "unknown option, the nearest is --verbose (got --verbos)");
  ExpectUsageError("check a.json --quickly", "unknown option (got --quickly)");
}

TEST(CommandLine, OffersDetailsOnlyWhereThereAreAny) {
  for (const std::string command : {"sequence", "check", "world"}) {
    EXPECT_THAT(Generate(command + " --help"), ExitsWith(0, testing::HasSubstr("--verbose")));
  }
  for (const std::string command : {"stream", "trace", "insert", "dataset", "survey", "import"}) {
    EXPECT_THAT(Generate(command + " --help").said, testing::Not(testing::HasSubstr("--verbose")))
        << command;
  }
}

TEST(CommandLine, NamesTheOptionWhoseFileHasNoName) {
  for (const char* option : {"--out", "--commands"}) {
    ExpectUsageError(std::string("sequence a.json --out b ") + option + " ''",
                     std::string(option) + ": must not be empty");
  }
  for (const char* option : {"--pcap", "--calibration", "--commands-log"}) {
    ExpectUsageError(std::string("stream a.json ") + option + " ''",
                     std::string(option) + ": must not be empty");
  }
  ExpectUsageError("world a.json --out ''", "--out: must not be empty");
  ExpectUsageError("check a.json --resolved ''", "--resolved: must not be empty");
  ExpectUsageError("check ''", "SCENARIO: must not be empty");
}

TEST(CommandLine, TakesAnUnknownFieldForWrongUsage) {
  for (const std::string command : {"sequence a.json --out b", "stream a.json"}) {
    EXPECT_THAT(
        Generate(command + " --fields labl"),
        ExitsWith(2, testing::StartsWith(
                         "--fields: unknown field, the nearest is \"label\" (got \"labl\")")));
  }
}

}  // namespace
}  // namespace railcast
