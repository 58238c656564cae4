#include "core/extras/ros/messages/cdr.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/extras/ros/messages/discovery_messages.h"
#include "core/extras/ros/messages/scene_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "tests/core/io/message_of.h"

namespace railcast::ros {
namespace {

using Bytes = std::vector<std::byte>;

Bytes BytesOf(const std::vector<int>& values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

PointCloud2 SmallCloud() {
  PointCloud2 cloud;
  cloud.header = {{7, 500'000'000}, "lidar"};
  cloud.height = 1;
  cloud.width = 2;
  cloud.fields = {{"x", 0, PointField::kFloat32, 1}, {"label", 4, PointField::kUint8, 1}};
  cloud.point_step = 5;
  cloud.row_step = 10;
  cloud.data = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  cloud.is_dense = true;
  return cloud;
}

SceneUpdate SmallScene() {
  SceneEntity entity;
  entity.id = "wagon";
  entity.metadata = {{"label", "wagon"}, {"", ""}};
  entity.cubes = {
      {{{1.0, -2.0, 3.5}, {0.0, 0.0, 0.6, 0.8}}, {4.0, 5.0, 6.0}, {0.1, 0.2, 0.3, 1.0}}};
  LinePrimitive line;
  line.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  line.indices = {0, 1, 1};
  entity.lines = {line};
  return {{{{1, 2}, SceneEntityDeletion::kAll, "old"}}, {entity, {}}};
}

TEST(Cdr, AlignsNumbersToTheirSizeAfterTheHeader) {
  // Written by hand after CORBA 3.0, 15.3.
  NavSatFix fix;
  fix.header.frame_id = "a";
  fix.status = {-1, 3};
  fix.latitude = 1.0;
  const Bytes bytes = ToCdr(fix);
  const Bytes begin = BytesOf({0,   1, 0, 0,                   // header
                               0,   0, 0, 0, 0,   0, 0,    0,  // stamp
                               2,   0, 0, 0, 'a', 0,           // frame_id
                               255, 0, 3, 0,                   // status, a byte to align, service
                               0,   0, 0, 0, 0,   0,           // up to a multiple of 8
                               0,   0, 0, 0, 0,   0, 0xF0, 0x3F});
  ASSERT_GE(bytes.size(), begin.size());
  EXPECT_TRUE(std::equal(begin.begin(), begin.end(), bytes.begin()));
  // Two more numbers, nine of covariance, and its type.
  EXPECT_EQ(bytes.size(), begin.size() + 8 * 2 + 8 * 9 + 1);
}

TEST(Cdr, DoesNotAlignWhatAnEmptySequenceDoesNotHold) {
  CameraInfo info;
  info.distortion_model = "a";
  const Bytes bytes = ToCdr(info);
  // The header, stamp 8, empty frame_id 5 + 3, height and width 8, model 6 + 2, the length of d 4.
  const std::size_t end_of_d = 4 + 8 + 8 + 8 + 8 + 4;
  // k is aligned to 8 by 4 bytes; 9 + 9 + 12 numbers, binning 8, region of interest 17.
  EXPECT_EQ(bytes.size(), end_of_d + 4 + 30 * 8 + 8 + 17);
}

TEST(Cdr, ReadsWhatItWrites) {
  EXPECT_EQ(FromCdr<PointCloud2>(ToCdr(SmallCloud())), SmallCloud());
  EXPECT_EQ(FromCdr<SceneUpdate>(ToCdr(SmallScene())), SmallScene());
  Odometry odometry;
  odometry.header.stamp = {-1, 999'999'999};
  odometry.pose.covariance[35] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(FromCdr<Odometry>(ToCdr(odometry)), odometry);
}

TEST(Cdr, ReadsBigEndian) {
  const Bytes bytes = BytesOf({0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 3});
  EXPECT_EQ(FromCdr<Clock>(bytes), (Clock{{258, 3}}));
}

TEST(Cdr, ReadsTheSameFromEitherByteOrder) {
  // A TwistStamped of which every number is turned around by hand.
  TwistStamped message;
  message.header = {{1, 2}, "base_link"};
  message.twist = {{1.5, 0.0, 0.0}, {0.0, 0.0, -0.25}};
  Bytes bytes = ToCdr(message);
  bytes[1] = std::byte{0};
  const auto turn = [&](std::size_t at, std::size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  };
  for (const std::size_t at : {4U, 8U, 12U}) turn(at, 4);
  const std::size_t first_number = bytes.size() - 6 * 8;
  for (std::size_t i = 0; i < 6; ++i) turn(first_number + 8 * i, 8);
  EXPECT_EQ(FromCdr<TwistStamped>(bytes), message);
}

TEST(Cdr, ReadsMessagesThatWerePaddedToWholeWords) {
  Bytes bytes = ToCdr(SmallCloud());
  bytes.resize(bytes.size() + 3);
  EXPECT_EQ(FromCdr<PointCloud2>(bytes), SmallCloud());
}

TEST(Cdr, ReadsAnEmptyStringWithoutItsNul) {
  const Bytes bytes = BytesOf({0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(FromCdr<Header>(bytes), Header{});
}

TEST(Cdr, RefusesOtherEncodings) {
  EXPECT_EQ(MessageOf([] {
              (void)FromCdr<Clock>(BytesOf({0, 1}));
            }),
            "rosgraph_msgs/msg/Clock: must begin with CDR's header of 4 bytes (got 2)");
  // XCDR2, and plain CDR with a parameter list.
  EXPECT_EQ(MessageOf([] {
              (void)FromCdr<Clock>(BytesOf({0, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
            }),
            "rosgraph_msgs/msg/Clock: must be plain CDR, whose header begins with 0 0 or 0 1 (got "
            "0 7)");
  EXPECT_EQ(MessageOf([] {
              (void)FromCdr<Clock>(BytesOf({1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
            }),
            "rosgraph_msgs/msg/Clock: must be plain CDR, whose header begins with 0 0 or 0 1 (got "
            "1 1)");
}

TEST(Cdr, RefusesTooFewAndTooManyBytes) {
  EXPECT_EQ(MessageOf([] {
              (void)FromCdr<Clock>(BytesOf({0, 1, 0, 0, 1, 0, 0, 0, 2, 0}));
            }),
            "rosgraph_msgs/msg/Clock: must have 4 bytes from byte 8 on (got 10)");
  Bytes bytes = ToCdr(Clock{});
  bytes.resize(bytes.size() + 4);
  EXPECT_EQ(MessageOf([&] { (void)FromCdr<Clock>(bytes); }),
            "rosgraph_msgs/msg/Clock: must have at most 15 bytes (got 16)");
}

TEST(Cdr, RefusesSequencesThatCannotBeInTheMessage) {
  Bytes bytes = ToCdr(TfMessage{});
  for (std::size_t i = 4; i < 8; ++i) bytes[i] = std::byte{0xFF};
  EXPECT_EQ(MessageOf([&] { (void)FromCdr<TfMessage>(bytes); }),
            "tf2_msgs/msg/TFMessage: a sequence at byte 4 must have at most 0 elements (got "
            "4294967295)");
}

TEST(Cdr, RefusesAStringWithoutItsEnd) {
  Bytes bytes = ToCdr(Header{{}, "ab"});
  bytes.back() = std::byte{'c'};
  EXPECT_EQ(MessageOf([&] { (void)FromCdr<Header>(bytes); }),
            "std_msgs/msg/Header: a string must end in NUL before byte 19");
}

template <typename Message>
void ExpectEveryTruncationRefused(const Message& message) {
  const Bytes whole = ToCdr(message);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(MessageOf([&] { (void)FromCdr<Message>(part); }), "no error") << size;
  }
}

TEST(Cdr, RefusesEveryTruncation) {
  ExpectEveryTruncationRefused(SmallCloud());
  ExpectEveryTruncationRefused(SmallScene());
}

struct Unbounded {
  static constexpr std::string_view kName = "made_up/msg/Unbounded";
  static constexpr std::array kFields = {"text"};
  std::string text;
};

struct Bounded {
  static constexpr std::string_view kName = "made_up/msg/Bounded";
  static constexpr std::array kFields = {"text"};
  BoundedString<256> text;
};

TEST(ParticipantEntitiesInfo, HasTheHashOfIronAndLater) {
  const MessageType& type = TypeOf<ParticipantEntitiesInfo<>>();
  EXPECT_EQ(type.hash, "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e");
  EXPECT_EQ(type.dds_name, "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_");
}

TEST(ParticipantEntitiesInfo, HasLongerGidsInHumble) {
  const auto bytes = ToCdr(ParticipantEntitiesInfo<>{});
  EXPECT_EQ(bytes.size(), 4U + 16U + 4U);
  EXPECT_EQ(ToCdr(ParticipantEntitiesInfo<kHumbleGidSize>{}).size(), 4U + 24U + 4U);
}

TEST(ParticipantEntitiesInfo, KeepsNodesAndTheirWriters) {
  ParticipantEntitiesInfo<> info;
  info.gid.data[15] = 0xC1;
  NodeEntitiesInfo<kGidSize> node{{"/"}, {"railcast"}, {}, {Gid<kGidSize>{}}};
  node.writer_gid_seq[0].data[0] = 7;
  info.node_entities_info_seq = {node};
  EXPECT_EQ(FromCdr<ParticipantEntitiesInfo<>>(ToCdr(info)), info);
}

TEST(ParticipantEntitiesInfo, HasNamesOfAtMost256Characters) {
  const auto bytes = ToCdr(Unbounded{std::string(257, 'a')});
  EXPECT_EQ(MessageOf([&] { (void)FromCdr<Bounded>(bytes); }),
            "made_up/msg/Bounded: a string must have at most 256 characters (got 257)");
}

}  // namespace
}  // namespace railcast::ros
