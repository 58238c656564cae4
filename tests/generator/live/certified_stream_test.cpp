#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "core/base/units.h"
#include "core/io/write_file.h"
#include "core/scenario/json_text.h"
#include "generator/live/live_run.h"
#include "railcast/io/stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;

TEST(CertifiedStream, TellsInLockstepWhatTheSequenceOfItsLogDoes) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  const std::string commands_port = FreePort();
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --certify 50% --lockstep --duration 0.3 --to " +
                EndpointText(receiver.at()) + " --summary " + path("summary.json") +
                " --commands-port " + commands_port + " --commands-log " + path("log.jsonl"));
  Controller controller(commands_port);
  std::vector<ReceivedFrame> frames;
  const auto say = [&](const std::string& command) {
    EXPECT_THAT(controller.Say(command), HasSubstr("\"ok\":true"));
  };
  const auto step = [&] {
    say(R"({"command":"step"})");
    auto frame = receiver.Next(kPatience_ms);
    ASSERT_TRUE(frame.has_value());
    frames.push_back(std::move(*frame));
  };
  step();
  say(R"({"command":"reset"})");  // What was found before counts no more.
  frames.clear();
  step();
  say(R"({"command":"place_object","object":{"name":"p","type":"person","s_m":220,"d_m":1}})");
  step();
  say(R"({"command":"set_weather","weather":{"rain_rate_mmph":20}})");
  for (int i = 0; i < 4; ++i) step();
  const Ended ended = stream.Wait();
  ASSERT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, HasSubstr("\ncertificate: "));
  EXPECT_THAT(ended.said, HasSubstr("  0 of 7 frames were not certified for want of time\n"));

  const Ended replay = Generate("sequence " + scenario + " --certify 50% --frames 6 --commands " +
                                path("log.jsonl") + " --out " + path("out"));
  ASSERT_EQ(replay.status, 0) << replay.said;
  const Json summary = Json::parse(ReadFileWhole(path("summary.json")));
  const Json& coarse = summary.at("sensors").at(0);
  EXPECT_EQ(coarse.at("uncertified_frames"), 0);
  EXPECT_GT(coarse.at("certificate").at("drawn"), 20);
  EXPECT_EQ(coarse.at("certificate"),
            Json::parse(ReadFileWhole(path("out/manifest.json"))).at("certificate"));
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ExpectSamePoints(frames[i], path("out/frames/00000" + std::to_string(i) + ".pcd"));
  }
}

TEST(CertifiedStream, SaysThatItHadNoTime) {
  const TemporaryDirectory folder;
  std::string text = ReadFileWhole(CoarseScenario(folder.path()));
  const std::string rate = "\"rate_hz\": 20";
  text.replace(text.find(rate), rate.size(), "\"rate_hz\": 20000");  // More than can be made.
  const std::string scenario = (folder.path() / "fast.json").string();
  WriteFileWhole(scenario, text);
  const Ended ended =
      Generate("stream " + scenario + " --certify 1% --duration 0.001 --to :" + FreePort());
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, HasSubstr("certificate: too few echoes were drawn to tell; 0 of 0"));
  EXPECT_THAT(ended.said, HasSubstr("  20 of 20 frames were not certified for want of time\n"));
}

TEST(CertifiedStream, RefusesTheReferenceAndSharesThatAreNoneAsSequenceDoes) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  for (const std::string options : {"--fidelity reference --certify 1%", "--certify 1"}) {
    const Ended ended =
        Generate("stream " + scenario + " --duration 0.1 --to :" + FreePort() + " " + options);
    EXPECT_EQ(ended.status, 1) << options;
    std::string arguments = scenario + " " + options + " --frames 1 --out ";
    arguments += (folder.path() / "out").string();
    EXPECT_EQ(ended.said, Generate("sequence " + arguments).said);
  }
}

/// A sensor at 50 Hz whose frames are nothing.
struct CertifiedSensor {
  [[nodiscard]] LiveSensor Live(std::int64_t certify_ns) {
    return {.name = "a",
            .period_ns = kPeriod_ns,
            .stamp_ns = [](std::uint32_t frame) { return frame * kPeriod_ns; },
            .make = [this](std::uint32_t, Datagrams&) { std::this_thread::sleep_for(work); },
            .send = [](const Datagrams&, std::span<const Datagrams::Item>) {},
            .certify = [this] { ++num_certified; },
            .certify_ns = certify_ns};
  }
  /// Returns how many of five frames had no time for their certificates.
  [[nodiscard]] std::uint64_t Run(LiveRunSpec spec, LiveClock& clock, std::int64_t certify_ns) {
    spec.duration_ns = 5 * kPeriod_ns;
    const LiveResult result = RunLive(spec, {Live(certify_ns)}, {}, clock);
    EXPECT_EQ(result.records.front().frames, 5U);
    EXPECT_EQ(result.records.front().certify.count(), num_certified);
    return result.records.front().uncertified_frames.value();
  }

  static constexpr std::int64_t kPeriod_ns = kNsPerS / 50;
  std::chrono::milliseconds work{};
  std::uint64_t num_certified = 0;
};

TEST(CertifiedLiveRun, CertifiesNoFrameAfterWhichTheNextIsDue) {
  MonotonicClock clock;
  CertifiedSensor sensor;
  sensor.work = std::chrono::milliseconds(25);
  EXPECT_EQ(sensor.Run({}, clock, 0), 5U);
  EXPECT_EQ(sensor.num_certified, 0U);
}

TEST(CertifiedLiveRun, CertifiesNoFrameIfThatMayTakeUntilAfterTheNextIsDue) {
  MonotonicClock clock;
  CertifiedSensor sensor;
  EXPECT_EQ(sensor.Run({}, clock, CertifiedSensor::kPeriod_ns / 2), 5U);
  EXPECT_EQ(sensor.num_certified, 0U);
}

TEST(CertifiedLiveRun, CertifiesEveryFrameWhereNoneIsDue) {
  JumpingClock jumping;
  MonotonicClock monotonic;
  LiveRunSpec lockstep;
  lockstep.lockstep = true;
  for (const bool waits : {false, true}) {
    CertifiedSensor sensor;
    LiveClock& clock = waits ? static_cast<LiveClock&>(monotonic) : jumping;
    EXPECT_EQ(sensor.Run(waits ? lockstep : LiveRunSpec{}, clock, kNsPerS), 0U);
    EXPECT_EQ(sensor.num_certified, 5U);
  }
}

}  // namespace
}  // namespace railcast
