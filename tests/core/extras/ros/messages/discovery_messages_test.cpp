#include "core/extras/ros/messages/discovery_messages.h"

#include <gtest/gtest.h>

#include <string>

#include "core/extras/ros/messages/cdr.h"
#include "tests/core/io/message_of.h"

namespace railcast::ros {
namespace {

struct Unbounded {
  static constexpr std::string_view kName = "made_up/msg/Unbounded";
  std::string text;
  static void VisitFields(auto& self, auto&& visit) { visit("text", self.text); }
};

struct Bounded {
  static constexpr std::string_view kName = "made_up/msg/Bounded";
  BoundedString<256> text;
  static void VisitFields(auto& self, auto&& visit) { visit("text", self.text); }
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
