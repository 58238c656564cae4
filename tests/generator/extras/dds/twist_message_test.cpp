#include "generator/extras/dds/twist_message.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <vector>

#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::vector<std::byte> Twist(double speed_mps) {
  ros::TwistStamped message;
  message.header.frame_id = "base_link";
  message.twist.linear.x = speed_mps;
  return ros::ToCdr(message);
}

std::string FaultOf(const std::vector<std::byte>& cdr) {
  return MessageOf([&] { static_cast<void>(CommandOfTwist(cdr, 1.0)); });
}

TEST(TwistMessage, OfNoSpeedBrakesToAStandstill) {
  EXPECT_EQ(CommandOfTwist(Twist(0.0), 0.75), Command(Brake{0.75}));
  EXPECT_EQ(CommandOfTwist(Twist(-0.0), 0.75), Command(Brake{0.75}));
}

TEST(TwistMessage, OfASpeedBringsTheVehicleToIt) {
  EXPECT_EQ(CommandOfTwist(Twist(12.5), 0.3), Command(SetSpeed{12.5, 0.3}));
}

TEST(TwistMessage, OfNoSpeedThatACommandMayNameIsRefused) {
  EXPECT_EQ(FaultOf(Twist(-1.0)), "command: /speed_mps: must be >= 0 and <= 200 (got -1.0)");
  EXPECT_EQ(FaultOf(Twist(201.0)), "command: /speed_mps: must be >= 0 and <= 200 (got 201.0)");
  EXPECT_EQ(FaultOf(Twist(std::numeric_limits<double>::quiet_NaN())),
            "command: /speed_mps: must be a number (got null)");
}

TEST(TwistMessage, OfAnyOtherLengthIsRefused) {
  const std::vector<std::byte> whole = Twist(0.0);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::byte> cut(whole.begin(),
                                     whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(FaultOf(cut), "no error") << size;
  }
  std::vector<std::byte> longer = whole;
  longer.resize(whole.size() + 3);  // Padding to whole words.
  EXPECT_EQ(FaultOf(longer), "no error");
  longer.resize(whole.size() + 4);
  EXPECT_NE(FaultOf(longer), "no error");
}

}  // namespace
}  // namespace railcast
