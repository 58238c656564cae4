#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/io/net/udp.h"
#include "core/io/stream/stream_clouds.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

std::string Receive() {
  return RAILCAST_ANALYZE " receive " + EndpointText(OwnEndpoint()) + " ";
}

TEST(ReceiveCommand, CountsFramesAndPackets) {
  ListeningProgram program(Receive() + "--frames 4");
  LiveStream stream(program.at());
  stream.Send(0);
  stream.SendWithout(1, 3);
  stream.Send(2);
  stream.Send(4);
  EXPECT_THAT(program.Rest(),
              MatchesRegex("frames: 3 complete, 1 incomplete, 1 missing, 0 dropped here; .* Hz\n"
                           "packets: 99 received, 1 lost, 0 duplicate, 0 reordered, 0 late, "
                           "0 stray, 0 refused\n"
                           "points: 3801, 950 a frame\n"
                           "from frame to frame: p50 [0-9.]+ ms, p99 [0-9.]+ ms, most [0-9.]+ ms\n"
                           "latency: unknown, .*\n"));
  EXPECT_EQ(program.ExitStatus(), 0);
}

/// What is received of a stream with these options: its text, and its summary.
std::pair<std::string, nlohmann::json> ReceivedOf(const std::string& options) {
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "summary.json";
  ListeningProgram program(Receive() + "--frames 2 --summary " + file.string());
  const Ended sent = RunCommand(RAILCAST_GENERATE " stream " RAILCAST_SOURCE_DIR
                                                  "/scenarios/minimal.json --duration 0.3 --to " +
                                EndpointText(program.at()) + options);
  EXPECT_EQ(sent.status, 0) << sent.said;
  const std::string text = program.Rest();
  return {text, nlohmann::json::parse(ReadFileWhole(file))};
}

// Datagrams leave a period after their last firing, and a busy machine may send or take them late.
TEST(ReceiveCommand, KnowsTheLatencyOfAStreamThatStatesTheTimeOfDay) {
  const auto begin = std::chrono::steady_clock::now();
  const auto [text, summary] = ReceivedOf(" --clock utc");
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin;
  EXPECT_THAT(text, HasSubstr("\nlatency since the last firing: p50 "));
  EXPECT_EQ(summary.at("frames_ahead"), 0);
  const nlohmann::json& latency_ms = summary.at("latency_ms");
  EXPECT_GT(latency_ms.at("p50"), 0.0);
  EXPECT_GE(latency_ms.at("p99"), latency_ms.at("p50"));
  EXPECT_GE(latency_ms.at("max"), latency_ms.at("p99"));
  EXPECT_LT(latency_ms.at("max"), elapsed.count());
  const auto [unknown, other] = ReceivedOf("");
  EXPECT_THAT(unknown, HasSubstr("\nlatency: unknown, stamps are not of this machine's clock"));
  EXPECT_TRUE(other.at("latency_ms").is_null());
}

TEST(ReceiveCommand, WritesItsSummaryAsJson) {
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "summary.json";
  ListeningProgram program(Receive() + "--frames 1 --summary " + file.string());
  LiveStream(program.at()).Send(0);
  (void)program.Rest();
  EXPECT_EQ(program.ExitStatus(), 0);
  EXPECT_THAT(ReadFileWhole(file), HasSubstr(R"("frames":{"complete":1,)"));
  // What cannot be written is known before the first datagram.
  EXPECT_EQ(RunCommand(RAILCAST_ANALYZE " receive --summary " + folder.path().string()).said,
            folder.path().string() + ": must be a regular file (got a directory)\n");
}

TEST(ReceiveCommand, TakesNobodyButWhoItIsTold) {
  ListeningProgram program(Receive() + "--from 127.9.9.9 --duration 1");
  LiveStream(program.at()).Send(0);
  EXPECT_THAT(program.Rest(),
              MatchesRegex("frames: 0 complete, .*\npoints: 0, 0 a frame\n"
                           "packets of other senders: 25, dropped; the last from .*:[0-9]+\n"));
  EXPECT_EQ(RunCommand(RAILCAST_ANALYZE " receive --from 127.1").said,
            "--from: a numeric address must be four numbers from 0 to 255 with dots between, none "
            "with a leading 0 (got 127.1)\n");
}

TEST(ReceiveCommand, EndsAtASignalWithItsSummary) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    ListeningProgram program(Receive());
    LiveStream(program.at()).Send(0);
    program.Interrupt(signal);
    EXPECT_THAT(program.Rest(), HasSubstr("missing, 0 dropped here; no rate yet\n"));
    EXPECT_EQ(program.ExitStatus(), 0);
  }
}

TEST(ReceiveCommand, EndsAfterItsDurationWithoutAnySender) {
  ListeningProgram program(Receive() + "--duration 0.1");
  EXPECT_THAT(program.Rest(), HasSubstr("frames: 0 complete, 0 incomplete, 0 missing"));
  EXPECT_EQ(program.ExitStatus(), 0);
}

TEST(ReceiveCommand, KeepsFramesWithTheirPoses) {
  const TemporaryDirectory directory;
  const std::filesystem::path out = directory.path() / "kept";
  const std::string command = Receive() + "--frames 2 --out " + out.string();
  {
    ListeningProgram program(command);
    LiveStream stream(program.at());
    stream.Send(7);
    stream.SendWithout(8, 0);
    stream.Send(9);
    EXPECT_THAT(program.Rest(), HasSubstr("1 incomplete"));
  }
  const pcl::PCLPointCloud2 kept = ReadPcd(out / "frames/000000.pcd");
  const pcl::PCLPointCloud2 sent = MakePclCloud(ReceiveWhole(StreamFrame(7)));
  EXPECT_EQ(kept.data, sent.data);
  ASSERT_EQ(kept.fields.size(), sent.fields.size());
  for (std::size_t i = 0; i < kept.fields.size(); ++i) {
    EXPECT_EQ(kept.fields[i].name, sent.fields[i].name);
  }
  EXPECT_EQ(ReadPcd(out / "frames/000001.pcd").width, 921U);
  std::istringstream lines(ReadFileWhole(out / "frames.csv"));
  std::string head;
  std::string first;
  std::string second;
  std::getline(lines, head);
  std::getline(lines, first);
  std::getline(lines, second);
  // The position of frame 7 is (5.3e6 + 0.7, 6e5, 412.25) m; 17 digits represent any double.
  EXPECT_THAT(first, MatchesRegex("frames/000000.pcd,0,7,700000000,5300000.7[0-9]*,600000,412.25,"
                                  ".*,960,0(,[-0-9.e]+){8},[0-9]+,[0-9]+,"));
  EXPECT_THAT(
      second,
      MatchesRegex("frames/000001.pcd,0,8,800000000,.*,921,39(,[-0-9.e]+){8},[0-9]+,[0-9]+,"));
  const Ended again = RunCommand(command);
  EXPECT_EQ(again.status, 1);
  EXPECT_EQ(again.said,
            (out / "frames.csv").string() + ": must not exist: a recording is there already\n");
}

TEST(ReceiveCommand, ReplacesNoFramesOfOtherRecordings) {
  const TemporaryDirectory directory;
  const std::filesystem::path out = std::filesystem::canonical(directory.path());
  std::filesystem::create_directory(out / "frames");
  WriteFileWhole(out / "frames/000000.pcd", "mine");
  const std::string command = Receive() + "--frames 1 --out " + out.string();
  EXPECT_EQ(RunCommand(command).said,
            (out / "frames").string() + ": must be empty: frames are there already\n");
  for (const char* const name : {"frames.jsonl", "run.json"}) WriteFileWhole(out / name, "");
  EXPECT_EQ(RunCommand(command).said,
            "--out: must be outside " + out.string() +
                ", which holds nothing but what belongs to its frames.jsonl (got " + out.string() +
                ")\n");
  EXPECT_EQ(RunCommand(command).status, 1);
}

TEST(ReceiveCommand, NamesWhatItCannotListenToOrWrite) {
  const std::string analyze = RAILCAST_ANALYZE;
  EXPECT_EQ(RunCommand(analyze + " receive 127.0.0.1:99999").status, 1);
  EXPECT_EQ(RunCommand(analyze + " receive --frames 0").status, 2);
  EXPECT_EQ(RunCommand(analyze + " receive --duration -1").status, 2);
  const Ended nowhere = RunCommand(analyze + " receive --out /proc/no");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_THAT(nowhere.said, HasSubstr("/proc/no"));
  UdpReceiver taken(kAnyLoopbackPort);
  const std::string at = EndpointText(taken.at());
  EXPECT_EQ(RunCommand(analyze + " receive " + at).said,
            "cannot listen: Address already in use (got " + at + ")\n");
}

}  // namespace
}  // namespace railcast
