#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "railcast/io/stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"

namespace railcast {
namespace {

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

}  // namespace
}  // namespace railcast
