#include <gtest/gtest.h>

#include <optional>

#include "core/io/stream/frame_assembler.h"
#include "tests/core/io/stream/numbered_frames.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

TEST(FrameAssembler, FollowsOneSensorOnlyIfItIsBoundToIt) {
  const auto front = DatagramsOfFrames(0, 4, OfRun(1, 0));
  const auto roof = DatagramsOfFrames(0, 4, OfRun(2, 1));
  ASSERT_GT(front.size() / 5, 16U) << "more than the strays that begin anew";
  std::vector<std::string> both;  // A frame of each in turn.
  const std::size_t each = front.size() / 5;
  for (std::size_t i = 0; i < front.size(); i += each) {
    for (const auto* sender : {&front, &roof}) {
      for (std::size_t k = i; k < i + each; ++k) both.push_back((*sender)[k]);
    }
  }
  for (const std::uint16_t sensor : {std::uint16_t{0}, std::uint16_t{1}}) {
    FrameAssembler assembler(sensor);
    std::vector<ReceivedFrame> frames;
    for (const std::string& datagram : both) assembler.Take(datagram, frames);
    EXPECT_EQ(NumbersOf(frames), (Numbers{0, 1, 2, 3, 4}));
    for (const ReceivedFrame& frame : frames) {
      EXPECT_TRUE(frame.is_complete());
      EXPECT_EQ(frame.header.sensor, sensor);
    }
    EXPECT_EQ(assembler.counts().restarts, 0U);
    EXPECT_EQ(assembler.counts().lost_packets, 0U);
    EXPECT_EQ(assembler.counts().stray_packets, front.size());
    EXPECT_EQ(assembler.counts().other_sensor, 1 - sensor);
  }
}

TEST(FrameAssembler, SaysWhoElseIsHeard) {
  FrameAssembler assembler;
  std::vector<ReceivedFrame> frames;
  assembler.Take(DatagramsOf(StreamFrame(0), OfRun(1, 3)).front(), frames);
  EXPECT_EQ(assembler.counts().other_sensor, std::nullopt);
  const std::string other = DatagramsOf(StreamFrame(0), OfRun(1, 7)).front();
  assembler.Take(other, frames);
  EXPECT_EQ(assembler.counts().other_sensor, 7);
  for (int i = 0; i < 15; ++i) assembler.Take(other, frames);
  ASSERT_EQ(assembler.counts().restarts, 1U);
  EXPECT_EQ(assembler.counts().other_sensor, 3) << "now that 7 is followed";
}

}  // namespace
}  // namespace railcast
