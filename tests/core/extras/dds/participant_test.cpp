#include "core/extras/dds/participant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/discovery_messages.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "railcast/error.h"
#include "tests/core/extras/dds/fast_dds.h"
#include "tests/core/extras/dds/free_domain.h"
#include "tests/core/io/message_of.h"

// Fast DDS reads and writes here what Cyclone DDS writes and reads.

namespace railcast {
namespace {

constexpr const char* kCloudType = "sensor_msgs::msg::dds_::PointCloud2_";
constexpr const char* kHash =
    "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5";

dds::TopicSpec Points() {
  return {.name = "/front/points", .type = kCloudType, .hash = kHash};
}

dds::TopicSpec Static() {
  return {.name = "/tf_static",
          .type = "tf2_msgs::msg::dds_::TFMessage_",
          .hash = kHash,
          .is_latched = true};
}

/// Bytes that differ from message to message and from place to place, behind CDR's header.
MessageBytes Message(std::size_t number, std::size_t size) {
  MessageBytes bytes = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  std::uint32_t state = static_cast<std::uint32_t>(number) * 2654435761U + 1U;
  while (bytes.size() < size) {
    state = state * 1664525U + 1013904223U;
    bytes.push_back(static_cast<std::byte>(state >> 24U));
  }
  return bytes;
}

/// A participant on loopback in a domain of its own.
struct Joined {
  std::uint32_t domain = FreeDomain();
  std::unique_ptr<dds::Participant> participant = dds::Join({.domain = domain, .node = "railcast"});
};

TEST(DdsParticipant, BringsMessagesOfAnyLengthUnchanged) {
  const Joined joined;
  const std::size_t writer = joined.participant->AddWriter(Points());
  FastParticipant other(joined.domain);
  FastReader& reader = other.Read("rt/front/points", kCloudType);
  ASSERT_TRUE(reader.WaitForWriter());
  ASSERT_TRUE(WaitUntilTrue([&] { return joined.participant->NumReaders(writer) == 1; }));
  const std::vector<std::size_t> sizes = {4, 5, 6, 7, 8, 1343, 1344, 1345, 65'535, 1'000'003};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_TRUE(joined.participant->Write(writer, Message(i, sizes[i])));
  }
  const auto messages = reader.WaitFor(sizes.size());
  ASSERT_EQ(messages.size(), sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_EQ(messages[i].size() % 4, 0U);
    EXPECT_EQ(WithoutPadding(messages[i], sizes[i]), Message(i, sizes[i])) << i;
  }
}

TEST(DdsParticipant, SpeaksIpv6WhereItsAddressIsOne) {
  const std::uint32_t domain = FreeDomain();
  std::unique_ptr<dds::Participant> participant;
  try {
    participant = dds::Join({.domain = domain, .interface = "::1", .node = "railcast"});
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
  const std::size_t writer = participant->AddWriter(Points());
  FastParticipant of_ipv4(domain);
  FastReader& deaf = of_ipv4.Read("rt/front/points", kCloudType);
  FastParticipant other(domain, 0, true);
  FastReader& reader = other.Read("rt/front/points", kCloudType);
  ASSERT_TRUE(reader.WaitForWriter());
  ASSERT_TRUE(WaitUntilTrue([&] { return participant->NumReaders(writer) == 1; }));
  EXPECT_TRUE(participant->Write(writer, Message(1, 300'000)));
  const auto messages = reader.WaitFor(1);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0], Message(1, 300'000));
  EXPECT_TRUE(deaf.WaitFor(1, 100).empty());
}

// 30 frames of 0.9 MB at 10 Hz to a reader with Linux's default buffer: without bursts that it has
// room for, more than half of them would be lost.
TEST(DdsParticipant, LosesNoFrameToReadersWithUsualBuffers) {
  const Joined joined;
  const std::size_t writer = joined.participant->AddWriter(Points());
  FastParticipant other(joined.domain);
  FastReader& reader = other.Read("rt/front/points", kCloudType);
  ASSERT_TRUE(WaitUntilTrue([&] { return joined.participant->NumReaders(writer) == 1; }));
  ASSERT_TRUE(reader.WaitForWriter());
  constexpr std::size_t kNum = 30;
  constexpr std::size_t kSize = 921'816;
  for (std::size_t i = 0; i < kNum; ++i) {
    EXPECT_TRUE(joined.participant->Write(writer, Message(i, kSize)));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  const auto messages = reader.WaitFor(kNum);
  ASSERT_EQ(messages.size(), kNum);
  for (std::size_t i = 0; i < kNum; ++i) EXPECT_EQ(messages[i], Message(i, kSize)) << i;
}

TEST(DdsParticipant, TellsTypesHashesAndReliabilityAsRos2Does) {
  const Joined joined;
  static_cast<void>(joined.participant->AddWriter(Points()));
  static_cast<void>(joined.participant->AddWriter(Static()));
  FastParticipant other(joined.domain);
  const SeenWriter points = other.WaitForWriter("rt/front/points");
  EXPECT_EQ(points.type, kCloudType);
  EXPECT_EQ(points.user_data, std::string("typehash=") + kHash + ";");
  EXPECT_TRUE(points.is_reliable);
  EXPECT_FALSE(points.is_latched);
  EXPECT_TRUE(other.WaitForWriter("rt/tf_static").is_latched);
  EXPECT_EQ(other.WaitForParticipant(), "enclave=/;");
}

TEST(DdsParticipant, TellsTheNameOfItsNode) {
  const Joined joined;
  static_cast<void>(joined.participant->AddWriter(Points()));
  static_cast<void>(joined.participant->AddWriter(Static()));
  static_cast<void>(joined.participant->AddReader(Points()));
  joined.participant->Announce();
  FastParticipant other(joined.domain);
  FastReader& reader =
      other.Read("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", true);
  const auto messages = reader.WaitFor(1);
  ASSERT_EQ(messages.size(), 1U);
  const auto info = ros::FromCdr<ros::ParticipantEntitiesInfo<>>(messages.front());
  ASSERT_EQ(info.node_entities_info_seq.size(), 1U);
  const auto& node = info.node_entities_info_seq.front();
  EXPECT_EQ(node.node_namespace.text, "/");
  EXPECT_EQ(node.node_name.text, "railcast");
  EXPECT_EQ(node.writer_gid_seq.size(), 2U);
  EXPECT_EQ(node.reader_gid_seq.size(), 1U);
  EXPECT_NE(node.writer_gid_seq[0], node.writer_gid_seq[1]);
  // Ids of one participant begin alike.
  EXPECT_TRUE(std::equal(info.gid.data.begin(), info.gid.data.begin() + 12,
                         node.writer_gid_seq[0].data.begin()));
}

TEST(DdsParticipant, GivesReadersThatComeLateTheLastLatchedMessage) {
  const Joined joined;
  const std::size_t latched = joined.participant->AddWriter(Static());
  const std::size_t passing = joined.participant->AddWriter(Points());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(joined.participant->Write(latched, Message(i, 100)));
    EXPECT_TRUE(joined.participant->Write(passing, Message(i, 100)));
  }
  FastParticipant other(joined.domain);
  FastReader& transforms = other.Read("rt/tf_static", Static().type, true);
  FastReader& points = other.Read("rt/front/points", kCloudType);
  ASSERT_TRUE(points.WaitForWriter());
  const auto messages = transforms.WaitFor(1);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages.front(), Message(2, 100));
  EXPECT_EQ(points.WaitFor(1, /*timeout_ms=*/300).size(), 0U);
}

TEST(DdsParticipant, KeepsDomainsApart) {
  const Joined here;
  const Joined there;
  const std::size_t writer_here = here.participant->AddWriter(Points());
  const std::size_t writer_there = there.participant->AddWriter(Points());
  FastParticipant other_here(here.domain);
  FastParticipant other_there(there.domain);
  FastReader& reader_here = other_here.Read("rt/front/points", kCloudType);
  FastReader& reader_there = other_there.Read("rt/front/points", kCloudType);
  ASSERT_TRUE(reader_here.WaitForWriter());
  ASSERT_TRUE(reader_there.WaitForWriter());
  ASSERT_TRUE(WaitUntilTrue([&] {
    return here.participant->NumReaders(writer_here) == 1 &&
           there.participant->NumReaders(writer_there) == 1;
  }));
  EXPECT_TRUE(here.participant->Write(writer_here, Message(1, 100)));
  EXPECT_TRUE(there.participant->Write(writer_there, Message(2, 100)));
  EXPECT_EQ(reader_here.WaitFor(1).at(0), Message(1, 100));
  EXPECT_EQ(reader_there.WaitFor(1).at(0), Message(2, 100));
  EXPECT_EQ(reader_here.WaitFor(2, /*timeout_ms=*/200).size(), 1U);
}

/// Writes a message until one arrives, since what is written before the two sides have found each
/// other is lost. Returns what arrived.
MessageBytes WriteUntilTaken(MessageBytes message,
                             eprosima::fastdds::dds::DataWriter& writer,
                             dds::Participant& participant,
                             std::size_t reader) {
  std::optional<MessageBytes> taken;
  EXPECT_TRUE(WaitUntilTrue([&] {
    EXPECT_TRUE(writer.write(&message));
    return WaitUntilTrue([&] { return (taken = participant.Take(reader)).has_value(); }, 100);
  }));
  return taken.value_or(MessageBytes());
}

TEST(DdsParticipant, TakesWhatOthersWrite) {
  const Joined joined;
  const std::size_t reader = joined.participant->AddReader(Points());
  EXPECT_EQ(joined.participant->Take(reader), std::nullopt);
  FastParticipant other(joined.domain);
  auto& writer = other.Write("rt/front/points", kCloudType);
  const MessageBytes knock = Message(9, 8);
  EXPECT_EQ(WriteUntilTaken(knock, writer, *joined.participant, reader), knock);
  std::vector<MessageBytes> sent = {Message(0, 40), Message(1, 3000)};
  for (MessageBytes& message : sent) EXPECT_TRUE(writer.write(&message));
  std::vector<MessageBytes> taken;
  ASSERT_TRUE(WaitUntilTrue([&] {
    while (auto message = joined.participant->Take(reader)) {
      if (*message != knock) taken.push_back(std::move(*message));
    }
    return taken.size() == sent.size();
  }));
  EXPECT_EQ(taken, sent);
}

TEST(DdsParticipant, TakesOnlyTheBeginningOfWhatIsTooLong) {
  const Joined joined;
  const std::size_t reader = joined.participant->AddReader(Points());
  FastParticipant other(joined.domain);
  auto& writer = other.Write("rt/front/points", kCloudType);
  MessageBytes begin = Message(0, 200'000);
  const MessageBytes taken = WriteUntilTaken(begin, writer, *joined.participant, reader);
  begin.resize(dds::kMaxTaken_bytes);
  EXPECT_EQ(taken, begin);
}

TEST(DdsParticipant, SaysWhatIsWrong) {
  EXPECT_THAT(
      MessageOf([] { static_cast<void>(dds::Join({.domain = 1, .interface = "no_such_one"})); }),
      testing::MatchesRegex("interface: must be the name or an address of a network "
                            "interface that is up, one of .*lo \\(127.0.0.1\\).* \\(got "
                            "\"no_such_one\"\\)"));
  const Joined joined;
  static_cast<void>(joined.participant->AddWriter(Points()));
  EXPECT_THAT(MessageOf([&] { static_cast<void>(dds::Join({.domain = joined.domain})); }),
              testing::StartsWith("DDS: joining domain " + std::to_string(joined.domain) + ": "));
}

}  // namespace
}  // namespace railcast
