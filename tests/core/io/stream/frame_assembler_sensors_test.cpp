#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "core/base/units.h"
#include "core/io/stream/frame_assembler.h"
#include "tests/core/io/stream/numbered_frames.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

TEST(FrameAssembler, FollowsOneSensorOnlyIfItIsBoundToIt) {
  const auto front = DatagramsOfFrames(0, 4, OfRun(1, 0));
  const auto roof = DatagramsOfFrames(0, 4, OfRun(2, 1));
  ASSERT_GT(front.size() / 5, 16U) << "more than the strays that begin anew";
  std::vector<std::string> both;  // One frame of each sensor in turn.
  const std::size_t each = front.size() / 5;
  for (std::size_t i = 0; i < front.size(); i += each) {
    for (const auto* sender : {&front, &roof}) {
      for (std::size_t k = i; k < i + each; ++k) both.push_back((*sender)[k]);
    }
  }
  for (const std::uint16_t sensor : {std::uint16_t{0}, std::uint16_t{1}}) {
    FrameAssembler assembler({.sensor = sensor});
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

constexpr Endpoint kSender{0x0A000001, 4000};
constexpr Endpoint kForger{0x0A000001, 4001};

/// Returns datagrams with which a forger may try to disturb: of a later run, of the far future, of
/// another sensor, and empty or meaningless ones.
std::vector<std::string> ForgedDatagrams() {
  std::vector<std::string> forged = {"", "hello"};
  for (const auto& [index, spec] : {std::pair(0U, OfRun(9)), std::pair(4'000'000'000U, OfRun(1)),
                                    std::pair(0U, OfRun(9, 7)), std::pair(3U, OfRun(1))}) {
    for (std::string& datagram : DatagramsOf(StreamFrame(index), spec)) {
      forged.push_back(std::move(datagram));
    }
  }
  return forged;
}

TEST(FrameAssembler, FollowsTheFirstSenderWhateverOthersSend) {
  FrameAssembler assembler;
  std::vector<ReceivedFrame> frames;
  std::uint64_t num_forged = 0;
  for (const std::string& datagram : DatagramsOfFrames(0, 4, OfRun(1))) {
    assembler.Take(datagram, frames, {kSender, 0});
    for (const std::string& forged : ForgedDatagrams()) {
      assembler.Take(forged, frames, {kForger, FollowedSender::kHold_ns - 1});
      ++num_forged;
    }
  }
  EXPECT_EQ(NumbersOf(frames), (Numbers{0, 1, 2, 3, 4}));
  const StreamCounts& counts = assembler.counts();
  EXPECT_EQ(counts.complete_frames, 5U);
  EXPECT_EQ(counts.restarts, 0U);
  EXPECT_EQ(counts.stray_packets, 0U);
  EXPECT_EQ(counts.num_refused(), 0U);
  EXPECT_EQ(counts.other_sender_packets, num_forged);
  EXPECT_EQ(counts.other_sender, kForger);
  EXPECT_EQ(counts.other_sensor, 7);
}

TEST(FrameAssembler, FollowsNobodyForWhatIsNoDatagram) {
  FrameAssembler assembler;
  std::vector<ReceivedFrame> frames;
  assembler.Take("hello", frames, {kForger, 0});
  for (const std::string& datagram : DatagramsOfFrames(0, 0)) {
    assembler.Take(datagram, frames, {kSender, 0});
  }
  EXPECT_EQ(NumbersOf(frames), (Numbers{0}));
  EXPECT_EQ(assembler.counts().num_refused(), 1U);
  EXPECT_EQ(assembler.counts().other_sender, std::nullopt);
}

TEST(FrameAssembler, FollowsTheNextSenderOnceTheFirstIsSilent) {
  FrameAssembler assembler;
  std::vector<ReceivedFrame> frames;
  const auto take = [&](const std::vector<std::string>& datagrams, const DatagramOrigin& origin) {
    for (const std::string& datagram : datagrams) assembler.Take(datagram, frames, origin);
  };
  const auto of_sender = DatagramsOfFrames(500, 500, OfRun(7));
  take({of_sender.begin(), of_sender.end() - 1}, {kSender, 5 * kNsPerS});
  // An earlier run from another port, first one second before the hold time is over.
  const auto again = DatagramsOfFrames(0, 1, OfRun(6));
  take(again, {kForger, 7 * kNsPerS});
  EXPECT_TRUE(frames.empty());
  take(again, {kForger, 5 * kNsPerS + FollowedSender::kHold_ns});
  EXPECT_EQ(NumbersOf(frames), (Numbers{500, 0, 1})) << "from its first datagram on";
  EXPECT_FALSE(frames[0].is_complete());
  EXPECT_TRUE(frames[1].is_complete());
  EXPECT_EQ(assembler.counts().restarts, 1U);
  // Now the first sender counts as another sender.
  take({of_sender.back()}, {kSender, 9 * kNsPerS});
  EXPECT_EQ(assembler.counts().other_sender, kSender);
}

TEST(FrameAssembler, TakesNobodyButWhoIsWanted) {
  FrameAssembler assembler({.from = Endpoint{0x0A000002, 0}});
  std::vector<ReceivedFrame> frames;
  const auto datagrams = DatagramsOfFrames(0, 0);
  for (const std::string& datagram : datagrams) assembler.Take(datagram, frames, {kSender, 0});
  EXPECT_TRUE(frames.empty());
  EXPECT_EQ(assembler.counts().other_sender_packets, datagrams.size());
  const Endpoint wanted{0x0A000002, 4000};
  for (const std::string& datagram : datagrams) assembler.Take(datagram, frames, {wanted, 0});
  EXPECT_EQ(NumbersOf(frames), (Numbers{0}));
}

}  // namespace
}  // namespace railcast
