#include "railcast/remark.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace railcast {
namespace {

using enum RemarkKind;

TEST(Remark, SaysHowManyThingsAndWhereTheFirstIs) {
  EXPECT_EQ((Remark{.kind = kPacketsDamaged, .place = "a.pcap: turn 3"}.Text()),
            "1 packet with a wrong checksum (in a.pcap: turn 3)");
  EXPECT_EQ((Remark{.kind = kPacketsDamaged, .place = "a.pcap: turn 3", .number = 7}.Text()),
            "7 packets with a wrong checksum (the first in a.pcap: turn 3)");
  EXPECT_EQ((Remark{.kind = kFieldsLeftOut, .place = {}, .detail = "rgb"}.Text()),
            "1 field of a cloud left out: rgb");
}

TEST(RemarkTypes, StandInTheOrderOfTheirKindsWithNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < RemarkTypes().size(); ++i) {
    EXPECT_EQ(RemarkTypes()[i].kind, static_cast<RemarkKind>(i));
    EXPECT_TRUE(names.insert(RemarkTypes()[i].name).second) << RemarkTypes()[i].name;
  }
}

// Not those of further clouds, of which each may have its own.
TEST(AddRemark, NamesAllFieldsOfACloudThatAreLeftOutUpToALength) {
  std::vector<Remark> remarks;
  for (const char* const detail : {"ring", "", "label", "ring", "label"}) {
    AddRemark({.kind = kFieldsLeftOut, .place = "a.pcd", .detail = detail}, remarks);
  }
  for (const char* const place : {"a.pcd: point 3", "a.pcd: point 12"}) {
    AddRemark({.kind = kFieldsLeftOut, .place = place, .detail = place + 7}, remarks);
  }
  AddRemark({.kind = kFieldsLeftOut, .place = "b.pcd", .detail = "time"}, remarks);
  const Remark expected = {kFieldsLeftOut, "a.pcd", 8, "ring; label; point 3; point 12"};
  EXPECT_THAT(remarks, testing::ElementsAre(expected));
  for (int i = 1000; i < 1200; ++i) {
    AddRemark({.kind = kFieldsLeftOut, .place = "a.pcd", .detail = std::to_string(i)}, remarks);
  }
  EXPECT_EQ(remarks[0].number, 208U);
  EXPECT_LE(remarks[0].detail.size(), 401U);
  EXPECT_GE(remarks[0].detail.size(), 396U);
  for (const char* const detail : {"steps", "others"}) {
    AddRemark({.kind = kFarReturns, .place = "a.pcd", .detail = detail}, remarks);
  }
  EXPECT_EQ(remarks[1].detail, "steps");
}

TEST(RemarkLog, AddsUpAKindAndKeepsTheFirstPlaceWhateverCameFirst) {
  RemarkLog log;
  log.Add({.kind = kFarReturns, .place = "turn 5", .number = 2}, 5);
  log.Add({.kind = kPacketsLost, .place = "turn 9"}, 9);
  log.Add({.kind = kFarReturns, .place = "turn 3", .number = 1}, 3);
  EXPECT_THAT(log.List(),
              testing::ElementsAre(Remark{.kind = kPacketsLost, .place = "turn 9"},
                                   Remark{.kind = kFarReturns, .place = "turn 3", .number = 3}));
}

TEST(RemarkLog, CountsAFrameOnceHoweverOftenItIsRead) {
  RemarkLog log;
  RemarkLog second_pass;
  for (RemarkLog* of : {&log, &log, &second_pass}) {
    of->Add({.kind = kFarReturns, .place = "turn 5", .number = 2}, 5);
  }
  log.AddAll(second_pass);
  EXPECT_EQ(log.List().front().number, 2U);
}

TEST(RemarkLog, HandsItsRemarksToTheReceiverAtItsEnd) {
  std::vector<Remark> received;
  SetRemarkReceiver([&](const Remark& remark) { received.push_back(remark); });
  {
    RemarkLog log;
    log.Add({.kind = kPacketsLost, .place = {}, .number = 0});
    log.Add({.kind = kPacketsLate, .place = "a.pcap"});
    EXPECT_THAT(received, testing::IsEmpty());
  }
  SetRemarkReceiver(nullptr);
  EXPECT_THAT(received, testing::ElementsAre(Remark{.kind = kPacketsLate, .place = "a.pcap"}));
}

// The table of docs/remarks.md is made from that of the code:
//   RAILCAST_WRITE_REMARKS=1 build/ci/tests/core/core_tests --gtest_filter='RemarkReference.*'
TEST(RemarkReference, HasEveryKind) {
  const std::string file = std::string(RAILCAST_SOURCE_DIR) + "/docs/remarks.md";
  std::ostringstream read;
  read << std::ifstream(file).rdbuf();
  const std::string head = read.str().substr(0, read.str().find("| name |"));
  std::string text = head + "| name | what is counted | left out |\n|---|---|---|\n";
  for (const RemarkType& type : RemarkTypes()) {
    text += "| `" + std::string(type.name) + "` | " + std::string(type.several) + " | " +
            (type.is_loss ? "yes" : "") + " |\n";
  }
  if (std::getenv("RAILCAST_WRITE_REMARKS") != nullptr) std::ofstream(file) << text;
  EXPECT_EQ(read.str(), text);
}

}  // namespace
}  // namespace railcast
