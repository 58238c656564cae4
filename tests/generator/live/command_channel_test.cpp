#include "generator/live/command_channel.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/loopback.h"

namespace railcast {
namespace {

constexpr Endpoint kLoopbackPeer = kAnyLoopbackPort;
constexpr int kPatience_ms = 10'000;
/// Long enough for a datagram to arrive over loopback.
constexpr int kSilence_ms = 100;

/// A peer that sends commands.
class ChannelController {
 public:
  explicit ChannelController(const CommandChannel& channel) : channel_(channel.at()) {}

  void Say(const std::string& text) { port_.Answer(text, channel_); }
  /// Returns the next answer; empty if none comes.
  [[nodiscard]] std::string Hear(int timeout_ms = kPatience_ms) {
    const auto received = port_.Receive(timeout_ms);
    return received ? std::string(received->bytes.begin(), received->bytes.end()) : "";
  }

 private:
  UdpReceiver port_{kAnyLoopbackPort};
  Endpoint channel_;
};

TEST(CommandChannel, AnswersACommandWhenItTookEffect) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say(
      "{\"session\": \"a\", \"id\": 7, \"command\": \"set_speed\", \"speed_mps\": 10}\n");
  const auto request = channel.Next(kPatience_ms);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->command, Command(SetSpeed{.speed_mps = 10}));
  EXPECT_EQ(controller.Hear(kSilence_ms), "");
  channel.Acknowledge(*request, 300'000'000);
  EXPECT_EQ(
      controller.Hear(),
      "{\"ok\":true,\"session\":\"a\",\"id\":7,\"command\":\"set_speed\",\"time_ns\":300000000}\n");
}

TEST(CommandChannel, TakesSeveralCommandsInOneDatagram) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say("{\"command\": \"stop\"}\n\n{\"command\": \"step\"}\n{\"command\": \"reset\"}");
  EXPECT_EQ(channel.Next(kPatience_ms)->command, Command(Stop{}));
  EXPECT_EQ(channel.Next(kPatience_ms)->command, Command(Step{}));
  EXPECT_EQ(channel.Next(kPatience_ms)->command, Command(Reset{}));
  EXPECT_FALSE(channel.Next(0).has_value());
}

TEST(CommandChannel, DoesARepeatedCommandOnceAndAnswersItEachTime) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  const std::string step = "{\"session\": \"a\", \"id\": 1, \"command\": \"step\"}";
  controller.Say(step);
  controller.Say(step);
  const auto request = channel.Next(kPatience_ms);
  ASSERT_TRUE(request.has_value());
  EXPECT_FALSE(channel.Next(kSilence_ms).has_value());
  channel.Acknowledge(*request, 0);
  const std::string answer = controller.Hear();
  EXPECT_EQ(answer,
            "{\"ok\":true,\"session\":\"a\",\"id\":1,\"command\":\"step\",\"time_ns\":0}\n");
  controller.Say(step);
  EXPECT_EQ(controller.Hear(), answer);
  EXPECT_FALSE(channel.Next(0).has_value());
}

TEST(CommandChannel, DoesTheCommandsOfAClientThatBeganAnewOnItsPort) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say(R"({"session": "before", "id": 1, "command": "stop"})");
  const auto before = channel.Next(kPatience_ms);
  ASSERT_TRUE(before.has_value());
  channel.Acknowledge(*before, 1);
  EXPECT_NE(controller.Hear(), "");
  controller.Say(R"({"session": "after", "id": 1, "command": "stop"})");
  const auto after = channel.Next(kPatience_ms);
  ASSERT_TRUE(after.has_value());
  channel.Acknowledge(*after, 2);
  EXPECT_EQ(controller.Hear(),
            "{\"ok\":true,\"session\":\"after\",\"id\":1,\"command\":\"stop\",\"time_ns\":2}\n");
}

TEST(CommandChannel, TakesAnIdForOneCommandOfItsSession) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say(R"({"session": "a", "id": 1, "command": "step"})");
  const auto request = channel.Next(kPatience_ms);
  ASSERT_TRUE(request.has_value());
  const std::string stop = R"({"session": "a", "id": 1, "command": "stop"})";
  const std::string fault =
      "{\"ok\":false,\"session\":\"a\",\"id\":1,\"faults\":[\"command: /id: must be another than "
      "that "
      "of another command of the session (got 1)\"]}\n";
  controller.Say(stop);
  EXPECT_EQ(controller.Hear(), fault) << "while the other waits";
  channel.Acknowledge(*request, 0);
  EXPECT_EQ(controller.Hear().find("{\"ok\":true,"), 0U);
  controller.Say(stop);
  EXPECT_EQ(controller.Hear(), fault) << "after it was done";
  EXPECT_FALSE(channel.Next(0).has_value());
}

TEST(CommandChannel, DoesTheSameIdOfAnotherPort) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController first(channel);
  ChannelController second(channel);
  first.Say("{\"session\": \"a\", \"id\": 1, \"command\": \"stop\"}");
  second.Say("{\"session\": \"a\", \"id\": 1, \"command\": \"stop\"}");
  EXPECT_TRUE(channel.Next(kPatience_ms).has_value());
  EXPECT_TRUE(channel.Next(kPatience_ms).has_value());
}

TEST(CommandChannel, SaysWhatIsWrongWithACommand) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say("{\"session\": \"a\", \"id\": 3, \"command\": \"set_speed\", \"speed_mps\": -1}");
  const std::string answer = controller.Hear();
  EXPECT_EQ(answer.find("{\"ok\":false,\"session\":\"a\",\"id\":3,\"faults\":["), 0U) << answer;
  EXPECT_NE(answer.find("/speed_mps: must be"), std::string::npos) << answer;
  EXPECT_FALSE(channel.Next(0).has_value());
}

TEST(CommandChannel, SaysWhyACommandHadNoEffect) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say(
      "{\"session\": \"a\", \"id\": 4, \"command\": \"remove_object\", \"name\": \"ghost\"}");
  const auto request = channel.Next(kPatience_ms);
  ASSERT_TRUE(request.has_value());
  channel.Refuse(*request, {"/name: there is no such object (got \"ghost\")"});
  EXPECT_EQ(
      controller.Hear(),
      "{\"ok\":false,\"session\":\"a\",\"id\":4,\"faults\":[\"/name: there is no such object (got "
      "\\\"ghost\\\")\"]}\n");
}

TEST(CommandChannel, HearsNobodyButItsPeer) {
  constexpr Endpoint kElsewhere{0x7F000002, 0};
  CommandChannel channel(kAnyLoopbackPort, kElsewhere);
  ChannelController stranger(channel);
  stranger.Say("{\"session\": \"a\", \"id\": 1, \"command\": \"stop\"}");
  EXPECT_EQ(stranger.Hear(kSilence_ms), "");
  EXPECT_FALSE(channel.Next(0).has_value());
  for (int i = 0; i < kPatience_ms && channel.num_strangers() == 0; ++i) {
    static_cast<void>(stranger.Hear(1));
  }
  EXPECT_EQ(channel.num_strangers(), 1U);
}

TEST(CommandChannel, HearsOnlyThePortItWasTold) {
  UdpReceiver peer(kAnyLoopbackPort);
  CommandChannel channel(kAnyLoopbackPort, peer.at());
  ChannelController stranger(channel);
  stranger.Say("{\"command\": \"stop\"}");
  EXPECT_FALSE(channel.Next(kSilence_ms).has_value());
  const std::string stop = "{\"command\": \"stop\"}";
  peer.Answer(stop, channel.at());
  EXPECT_TRUE(channel.Next(kPatience_ms).has_value());
}

TEST(CommandChannel, KeepsHearingAfterWhatIsNoCommand) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say(std::string(60'000, '['));
  controller.Say(std::string("\0\xff\xfe{\"id\":", 9));
  controller.Say(std::string(30'000, '\n'));
  controller.Say("");
  controller.Say("{\"command\": \"stop\"}");
  EXPECT_EQ(channel.Next(kPatience_ms)->command, Command(Stop{}));
}

TEST(CommandChannel, AnswersNoAnswer) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  const std::vector<std::string> lines = {
      "{}", "dance", std::string(9000, '['), std::string(100, '\n') + std::string(200, 'x'),
      R"({"session": "a", "id": 1, "command": "set_weather", "weather": {"zz": 1}})"};
  for (const std::string& line : lines) {
    controller.Say(line);
    const std::string answer = controller.Hear();
    ASSERT_NE(answer, "") << line;
    // Sent back as if the channel's own port had sent the command, so that its answer returns to
    // it.
    controller.Say(answer);
    EXPECT_EQ(controller.Hear(kSilence_ms), "") << line;
  }
  EXPECT_EQ(channel.num_answers(), lines.size());
  controller.Say(R"({"session": "a", "id": 2, "command": "stop"})");
  const auto stop = channel.Next(kPatience_ms);
  ASSERT_TRUE(stop.has_value());
  channel.Acknowledge(*stop, 0);
  controller.Say(controller.Hear());
  EXPECT_EQ(controller.Hear(kSilence_ms), "");
  EXPECT_EQ(channel.num_answers(), lines.size() + 1);
}

TEST(CommandChannel, AnswersADatagramOfTooManyLinesOnce) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  std::string many;
  for (int i = 0; i < 30'000; ++i) many += "x\n";
  controller.Say(many);
  EXPECT_EQ(controller.Hear(),
            "{\"ok\":false,\"faults\":[\"a datagram must have at most 64 lines (got 30000)\"]}\n");
  EXPECT_EQ(controller.Hear(kSilence_ms), "");
}

TEST(CommandChannel, KnowsACommandThatWaitsWhateverComesMeanwhile) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  controller.Say("{\"session\": \"a\", \"id\": 1, \"command\": \"stop\"}");
  for (std::size_t id = 2; id < CommandChannel::kMaxAnswers + 10; ++id) {
    controller.Say("{\"session\": \"a\", \"id\": " + std::to_string(id) +
                   ", \"command\": \"dance\"}");
    ASSERT_NE(controller.Hear(), "");
  }
  controller.Say("{\"session\": \"a\", \"id\": 1, \"command\": \"stop\"}");
  EXPECT_TRUE(channel.Next(kPatience_ms).has_value());
  EXPECT_FALSE(channel.Next(kSilence_ms).has_value());
}

TEST(CommandChannel, RefusesMoreThanItCanHold) {
  CommandChannel channel(kAnyLoopbackPort, kLoopbackPeer);
  ChannelController controller(channel);
  std::string many;
  for (std::size_t i = 0; i < CommandChannel::kMaxLines; ++i) many += "{\"command\":\"stop\"}\n";
  for (std::size_t i = 0; i < CommandChannel::kMaxRequests; i += CommandChannel::kMaxLines) {
    controller.Say(many);
  }
  controller.Say("{\"session\": \"a\", \"id\": 9, \"command\": \"stop\"}");
  const std::string answer = controller.Hear();
  EXPECT_EQ(
      answer.find(
          "{\"ok\":false,\"session\":\"a\",\"id\":9,\"faults\":[\"too many commands are waiting"),
      0U)
      << answer;
  for (std::size_t i = 0; i < CommandChannel::kMaxRequests; ++i) {
    ASSERT_TRUE(channel.Next(0).has_value());
  }
  // The same line is sent again and accepted, since there is room now.
  controller.Say("{\"session\": \"a\", \"id\": 9, \"command\": \"stop\"}");
  EXPECT_TRUE(channel.Next(kPatience_ms).has_value());
}

}  // namespace
}  // namespace railcast
