#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/program/version.h"
#include "generator/live/live_control.h"
#include "railcast/io/stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;

TEST(VehicleInTheLoop, MakesInLockstepWhatSequenceMakesOfItsLog) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string log = (folder.path() / "log.jsonl").string();
  const std::string commands_port = FreePort();
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --lockstep --duration 0.4 --to " + EndpointText(receiver.at()) +
                " --commands-port " + commands_port + " --commands-log " + log);
  Controller controller(commands_port);
  std::vector<ReceivedFrame> frames;
  const auto step = [&] {
    EXPECT_NE(controller.Say("{\"command\":\"step\"}").find("\"ok\":true"), std::string::npos);
    auto frame = receiver.Next(kPatience_ms);
    ASSERT_TRUE(frame.has_value());
    frames.push_back(std::move(*frame));
  };
  const auto change = [&](const std::string& command) {
    const std::string answer = controller.Say(command);
    EXPECT_NE(answer.find("\"ok\":true"), std::string::npos) << answer;
  };
  step();
  change(R"({"command":"brake","deceleration_mps2":2})");
  step();
  step();
  change(R"({"command":"place_object","object":{"name":"p","type":"person","s_m":220,"d_m":1}})");
  step();
  change(R"({"command":"set_weather","weather":{"rain_rate_mmph":20}})");
  step();
  change(R"({"command":"remove_object","name":"wagon"})");
  EXPECT_NE(controller.Say(R"({"command":"remove_object","name":"wagon"})").find("\"ok\":false"),
            std::string::npos);
  step();
  change(R"({"command":"set_speed","speed_mps":12})");
  step();
  step();
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  ASSERT_EQ(frames.size(), 8U);
  const auto out = folder.path() / "out";
  const Ended replay =
      Generate("sequence " + scenario + " --frames 8 --commands " + log + " --out " + out.string());
  ASSERT_EQ(replay.status, 0) << replay.said;
  for (std::size_t i = 0; i < 8; ++i) {
    ExpectSamePoints(frames[i], out / ("frames/00000" + std::to_string(i) + ".pcd"));
  }
}

TEST(VehicleInTheLoop, BeginsAnewOnReset) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string commands_port = FreePort();
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --lockstep --duration 0.15 --to " + EndpointText(receiver.at()) +
                " --commands-port " + commands_port);
  Controller controller(commands_port);
  const auto step = [&] {
    EXPECT_NE(controller.Say("{\"command\":\"step\"}"), "");
    return receiver.Next(kPatience_ms).value();
  };
  const ReceivedFrame first = step();
  EXPECT_NE(controller.Say(R"({"command":"stop"})").find("\"ok\":true"), std::string::npos);
  const ReceivedFrame second = step();
  EXPECT_NE(controller.Say(R"({"command":"reset"})").find("\"ok\":true"), std::string::npos);
  const ReceivedFrame again = step();
  EXPECT_EQ(second.header.frame, 1U);
  EXPECT_EQ(again.header.frame, 0U);
  EXPECT_EQ(again.header.run, first.header.run + 1);
  EXPECT_EQ(again.points, first.points);
  step();
  step();
  EXPECT_EQ(stream.Wait().status, 0);
}

TEST(VehicleInTheLoop, IsDrivenByTheClientThatBrakes) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string commands_port = FreePort();
  const std::string stream_port = FreePort();
  Stream stream(
      scenario + " --lockstep --duration 20 --fields x,y,z --pacing burst --to :" + stream_port +
      " --commands-port " + commands_port + " & pid=$!; " +
      RAILCAST_SOURCE_DIR "/examples/brake_client.py --lockstep --front 0 --resolution 0.5 " +
      "--deceleration 2 --stream 127.0.0.1:" + stream_port + " --commands 127.0.0.1:" +
      commands_port + "; status=$?; kill -INT $pid; wait $pid; exit $status");
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  // Braking from 10 m/s at 2 m/s^2 takes 25 m; the brake is applied one frame, 0.5 m, after the
  // last frame received.
  EXPECT_NE(ended.said.find("with 10.00 m/s, braking distance 25.5 m, gap left "),
            std::string::npos)
      << ended.said;
}

/// A run of two sensors, and a clock that is set by hand.
class LiveHealthTest : public testing::Test {
 protected:
  std::string Health() {
    return health_.Answer({.method = "GET", .target = "/health", .body = {}}).body;
  }
  unsigned Status() {
    return health_.Answer({.method = "GET", .target = "/health", .body = {}}).status;
  }
  void Update() {
    records_[0].compute.Add(20'000'000);
    records_[0].compute.Add(40'000'000);
    health_.Update(
        {.stamp_ns = 500'000'000, .now_ns = 0, .behind_ns = 250'000'000, .records = records_});
  }

  std::int64_t now_ns_ = 0;
  LiveHealth health_{[this] { return now_ns_; }};
  std::vector<LiveRecord> records_{
      {.name = "front", .period_ns = 100'000'000, .frames = 2, .late_frames = 1},
      {.name = R"(a "\ b)", .period_ns = 100'000'000, .frames = 3, .dropped_frames = 4}};
};

TEST_F(LiveHealthTest, SaysWhenFramesAreMade) {
  EXPECT_EQ(Status(), 503U);
  EXPECT_THAT(Health(), HasSubstr(R"("status":"starting")"));
  health_.Begin();
  Update();
  EXPECT_EQ(Status(), 200U);
  EXPECT_EQ(Health(),
            "{\"status\":\"running\",\"frames\":5,\"late_frames\":1,\"dropped_frames\":4,\"behind_"
            "s\":0.25}\n");
  health_.End();
  EXPECT_EQ(Status(), 503U);
  EXPECT_THAT(Health(), HasSubstr(R"("status":"ending")"));
}

TEST_F(LiveHealthTest, NoticesThatARunHasStalled) {
  health_.Begin();
  now_ns_ = LiveHealth::kStalled_ns;
  EXPECT_EQ(Status(), 200U);
  ++now_ns_;
  EXPECT_EQ(Status(), 503U);
  EXPECT_THAT(Health(), HasSubstr(R"("status":"stalled")"));
  health_.Beat();  // As a run that waits for commands.
  EXPECT_EQ(Status(), 200U);
}

TEST_F(LiveHealthTest, CountsInTheFormatOfPrometheus) {
  health_.Begin();
  Update();
  const HttpAnswer answer = health_.Answer({.method = "GET", .target = "/metrics?now", .body = {}});
  EXPECT_EQ(answer.status, 200U);
  EXPECT_THAT(answer.content_type, HasSubstr("text/plain; version=0.0.4"));
  EXPECT_EQ(answer.body,
            "# HELP railcast_info The program's version.\n# TYPE railcast_info gauge\n"
            "railcast_info{version=\"" +
                ProgramVersion() + R"("} 1
# HELP railcast_running 1 while frames are made.
# TYPE railcast_running gauge
railcast_running 1
# HELP railcast_simulated_seconds Simulation time of the last frame.
# TYPE railcast_simulated_seconds gauge
railcast_simulated_seconds 0.5
# HELP railcast_behind_seconds Delay with which frames begin.
# TYPE railcast_behind_seconds gauge
railcast_behind_seconds 0.25
# HELP railcast_frames_total Frames that were made.
# TYPE railcast_frames_total counter
railcast_frames_total{sensor="front"} 2
railcast_frames_total{sensor="a \"\\ b"} 3
# HELP railcast_late_frames_total Frames that were not made in time.
# TYPE railcast_late_frames_total counter
railcast_late_frames_total{sensor="front"} 1
railcast_late_frames_total{sensor="a \"\\ b"} 0
# HELP railcast_dropped_frames_total Frames that were left out because they were late.
# TYPE railcast_dropped_frames_total counter
railcast_dropped_frames_total{sensor="front"} 0
railcast_dropped_frames_total{sensor="a \"\\ b"} 4
# HELP railcast_compute_seconds_total Time in which frames were made.
# TYPE railcast_compute_seconds_total counter
railcast_compute_seconds_total{sensor="front"} 0.06
railcast_compute_seconds_total{sensor="a \"\\ b"} 0.0
# HELP railcast_compute_seconds_max Longest time in which a frame was made.
# TYPE railcast_compute_seconds_max gauge
railcast_compute_seconds_max{sensor="front"} 0.04
railcast_compute_seconds_max{sensor="a \"\\ b"} 0.0
)");
}

TEST_F(LiveHealthTest, CountsFramesThatWereNotCertifiedIfSomeAreToBe) {
  records_[0].uncertified_frames = 2;
  Update();
  EXPECT_THAT(Health(), HasSubstr(R"("behind_s":0.25,"uncertified_frames":2})"));
  EXPECT_THAT(health_.Answer({.method = "GET", .target = "/metrics", .body = {}}).body,
              HasSubstr("railcast_uncertified_frames_total{sensor=\"front\"} 2\n"));
}

TEST_F(LiveHealthTest, AnswersNothingElse) {
  EXPECT_EQ(health_.Answer({.method = "GET", .target = "/", .body = {}}).status, 404U);
  EXPECT_EQ(health_.Answer({.method = "POST", .target = "/health", .body = {}}).status, 405U);
  EXPECT_EQ(health_.Answer({.method = "HEAD", .target = "/metrics", .body = {}}).status, 200U);
}

}  // namespace
}  // namespace railcast
