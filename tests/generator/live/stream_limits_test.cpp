#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/join.h"
#include "core/io/write_file.h"
#include "core/scenario/command_log.h"
#include "railcast/io/stream.h"
#include "tests/core/io/small_disk.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/exits_with.h"

// Tests how a live run ends at a limit: of the track, of the disk and of the machine's speed.

namespace railcast {
namespace {

/// Returns the coarse scenario with another starting position of its vehicle.
std::string ScenarioFrom(const std::filesystem::path& folder, const std::string& start_s_m) {
  std::string text = ReadFileWhole(CoarseScenario(folder));
  const std::string start = "\"start_s_m\": 200";
  text.replace(text.find(start), start.size(), "\"start_s_m\": " + start_s_m);
  const std::filesystem::path file = folder / "from.json";
  WriteFileWhole(file, text);
  return file.string();
}

/// Returns the coarse scenario with more frames per second than any machine can make.
std::string FastScenario(const std::filesystem::path& folder) {
  std::string text = ReadFileWhole(CoarseScenario(folder));
  const std::string rate = "\"rate_hz\": 20";
  text.replace(text.find(rate), rate.size(), "\"rate_hz\": 20000");
  const std::filesystem::path file = folder / "fast.json";
  WriteFileWhole(file, text);
  return file.string();
}

TEST(Stream, SaysWhyItEndsWhereTheTrackDoes) {
  const TemporaryDirectory folder;
  // 5 m remain at 10 m/s and 20 Hz, so frame 10 begins at the end of the track.
  EXPECT_THAT(Generate("stream " + ScenarioFrom(folder.path(), "595")),
              ExitsWith(1, testing::AllOf(testing::HasSubstr("coarse: 10 frames"),
                                          testing::HasSubstr("leaves track \"main\""))));
}

TEST(Stream, RefusesADurationBeyondTheTrackAsSequenceDoes) {
  const TemporaryDirectory folder;
  const std::string scenario = ScenarioFrom(folder.path(), "595");
  const auto capture = folder.path() / "a.pcap";
  const std::string begin = "stream " + scenario + " --pcap " + capture.string();
  const std::string fault = scenario +
                            ": /vehicle/motion: leaves track \"main\", from 0 to 600 m, at frame "
                            "10 (0.5 s)\n";
  EXPECT_THAT(Generate(begin + " --duration 0.55"), ExitsWith(1, fault));
  EXPECT_THAT(
      Generate("sequence " + scenario + " --frames 11 --out " + folder.path().string() + "/o"),
      ExitsWith(1, fault));
  EXPECT_FALSE(std::filesystem::exists(capture));
  EXPECT_FALSE(std::filesystem::exists(capture.string() + ".part"));
  EXPECT_THAT(Generate(begin + " --duration 0.5"), ExitsWith(0));
  EXPECT_TRUE(std::filesystem::exists(capture));
  // With commands the journey is not known in advance, so the run is not refused.
  const Ended commanded =
      Generate("stream " + scenario + " --duration 0.55 --commands-port " + FreePort());
  EXPECT_NE(commanded.said.find("coarse: 10 frames"), std::string::npos) << commanded.said;
}

TEST(Stream, GoesOnWithoutItsCaptureOnAFullDisk) {
  const TemporaryDirectory folder;
  const TemporaryDirectory disk_folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto run = [&](const std::string& options) {
    return RunOnSmallDisk(disk_folder.path(), [&](const std::filesystem::path& disk) {
      const Ended ended = Generate("stream " + scenario + " --duration 2 --all-slots --pcap " +
                                   (disk / "a.pcap").string() + options);
      return std::to_string(ended.status) + " " + ended.said;
    });
  };
  const std::string fault = (disk_folder.path() / "a.pcap").string() +
                            ": no space left on device; the capture ends after ";
  const std::string rest = " datagrams, in " + (disk_folder.path() / "a.pcap.part").string() + "\n";
  const SmallDiskResult sending = run(" --to :" + FreePort());
  if (!sending.refused.empty()) GTEST_SKIP() << sending.refused;
  const std::string& sent = sending.said;
  EXPECT_EQ(sent.find("1 "), 0U) << sent;
  EXPECT_NE(sent.find("coarse: 40 frames"), std::string::npos) << sent;
  EXPECT_NE(sent.find("\ncapture: " + fault), std::string::npos) << sent;
  EXPECT_NE(sent.find(rest), std::string::npos) << sent;
  // A run without receivers ends with its capture.
  const std::string alone = run("").said;
  EXPECT_EQ(alone.find("1 "), 0U) << alone;
  EXPECT_EQ(alone.find("coarse: 40 frames"), std::string::npos) << alone;
  EXPECT_NE(alone.find("\ncapture: " + fault), std::string::npos) << alone;
}

TEST(Stream, GoesOnWithoutItsLogWhereThatMayNotGrow) {
  const TemporaryDirectory folder;
  const std::string log = (folder.path() / "log.jsonl").string();
  const std::string port = FreePort();
  const std::string command = "ulimit -f 1; timeout --kill-after=10 120 " RAILCAST_GENERATE
                              " stream " +
                              CoarseScenario(folder.path()) + " --lockstep --duration 0.1" +
                              " --commands-port " + port + " --commands-log " + log;
  auto run = std::async(std::launch::async, [&] { return RunCommand(command); });
  Controller controller(port);
  const std::string rain = R"({"command":"set_weather","weather":{"rain_rate_mmph":20}})";
  const std::string step = R"({"command":"step"})";
  for (const std::string& each : {std::string(R"({"command":"brake","deceleration_mps2":1})"), rain,
                                  rain, rain, step, step}) {
    EXPECT_THAT(controller.Say(each), testing::HasSubstr("\"ok\":true"));
  }
  const Ended ended = run.get();
  const std::string text = ReadFileWhole(log);
  const auto num = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
  EXPECT_THAT(ended, ExitsWith(1, testing::HasSubstr("coarse: 2 frames")));
  EXPECT_THAT(ended.said,
              testing::HasSubstr("\nlog: " + log + ": file too large; the log ends after " +
                                 Amount(num, "commands") + "\n"));
  // By hand, as of a run that was killed.
  WriteFileWhole(log, text + CommandLogEnd(num));
  EXPECT_EQ(ReadCommandLog(log).commands.size(), num);
}

TEST(Stream, SaysThatItCannotKeepUpAndDropsFramesIfAskedTo) {
  const TemporaryDirectory folder;
  const std::string scenario = FastScenario(folder.path());
  // Runs until the text has been printed, and returns all output.
  const auto run_until = [&](const std::string& said, const std::string& option) {
    const std::string log = (folder.path() / "log").string();
    return RunCommand(RAILCAST_GENERATE " stream " + scenario + option + " --to :" + FreePort() +
                      " > " + log + " 2>&1 & i=0; until grep -q '" + said + "' " + log +
                      " || [ $i = 600 ]; do i=$((i+1)); sleep 0.1; done; " +
                      "kill -INT $!; wait $!; status=$?; cat " + log + "; exit $status");
  };
  EXPECT_THAT(
      run_until("cannot keep up: .* s behind after ", ""),
      ExitsWith(
          0, testing::AllOf(testing::HasSubstr(" s behind after "),
                            testing::HasSubstr("frames late; --drop-late drops frames instead\n"),
                            testing::Not(testing::HasSubstr(" dropped; ")))));
  EXPECT_THAT(run_until("cannot keep up: .* frames dropped after ", " --drop-late"),
              ExitsWith(0, testing::AllOf(testing::HasSubstr(" frames dropped after "),
                                          testing::HasSubstr(" dropped; "),
                                          testing::Not(testing::HasSubstr(" s behind")))));
}

TEST(Stream, FailsForLateFramesIfAskedToAndSumsUpAsJson) {
  const TemporaryDirectory folder;
  const std::string scenario = FastScenario(folder.path());
  const std::filesystem::path summary = folder.path() / "summary.json";
  const auto run = [&](const std::string& options) {
    return Generate("stream " + scenario + " --duration 0.01 --to :" + FreePort() + " --summary " +
                    summary.string() + options);
  };
  EXPECT_EQ(run("").status, 0);
  const Ended late = run(" --fail-late");
  EXPECT_EQ(late.status, 1) << late.said;
  const auto front = nlohmann::json::parse(ReadFileWhole(summary)).at("sensors").at(0);
  EXPECT_EQ(front.at("frames"), 200);
  EXPECT_GT(front.at("late_frames"), 100);
  EXPECT_NE(
      late.said.find("--fail-late: " + front.at("late_frames").dump() + " of 200 frames late\n"),
      std::string::npos)
      << late.said;
}

TEST(Stream, SendsInTimeWhatItDoesNotDropAsItIs) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --duration 0.2 --drop-late --no-offload --to " +
                EndpointText(receiver.at()));
  const auto out = folder.path() / "out";
  ASSERT_EQ(Generate("sequence " + scenario + " --frames 4 --out " + out.string()).status, 0);
  EXPECT_THAT(stream.Wait(), ExitsWith(0));
  const auto first = receiver.Next(kPatience_ms);
  ASSERT_TRUE(first.has_value());
  for (auto frame = first; frame; frame = receiver.Next(0)) {
    const std::string number = std::to_string(frame->header.frame);
    ExpectSamePoints(*frame, out / ("frames/00000" + number + ".pcd"));
  }
}

}  // namespace
}  // namespace railcast
