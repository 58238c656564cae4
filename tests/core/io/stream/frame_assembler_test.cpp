#include "core/io/stream/frame_assembler.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "tests/core/io/stream/numbered_frames.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

using Ranges = std::vector<IndexRange>;

TEST(FrameAssembler, GivesEachFrameWithItsLastDatagram) {
  FrameAssembler assembler;
  const auto datagrams = DatagramsOf(StreamFrame(0));
  std::vector<ReceivedFrame> frames;
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    EXPECT_TRUE(frames.empty()) << i;
    assembler.Take(datagrams[i], frames);
  }
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].is_complete());
  EXPECT_EQ(frames[0].num_packets, datagrams.size());
  EXPECT_EQ(frames[0].num_points(), frames[0].header.num_points);
  EXPECT_EQ(assembler.counts().complete_frames, 1U);
  EXPECT_EQ(assembler.counts().received_packets, datagrams.size());
}

TEST(FrameAssembler, PutsReorderedAndDoubledDatagramsInOrder) {
  const ReceivedFrame expected = ReceiveWhole(StreamFrame(6));
  auto datagrams = DatagramsOf(StreamFrame(6));
  std::ranges::reverse(datagrams);
  const std::string again = datagrams[2];
  datagrams.insert(datagrams.begin() + 5, again);
  FrameAssembler assembler;
  const auto frames = Feed(assembler, datagrams);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].is_complete());
  EXPECT_EQ(frames[0].points, expected.points);
  EXPECT_EQ(assembler.counts().duplicate_packets, 1U);
  // All but the datagram that was sent last, which arrives first.
  EXPECT_EQ(assembler.counts().reordered_packets, datagrams.size() - 2);
}

TEST(FrameAssembler, ReportsEveryPacketAndPointThatWasLost) {
  const ReceivedFrame whole = ReceiveWhole(StreamFrame(0));
  auto datagrams = DatagramsOf(StreamFrame(0));
  const std::size_t count = datagrams.size();
  ASSERT_GE(count, 8U);
  datagrams.erase(datagrams.end() - 1);
  datagrams.erase(datagrams.begin() + 2, datagrams.begin() + 4);
  FrameAssembler assembler;
  auto frames = Feed(assembler, datagrams);
  EXPECT_TRUE(frames.empty());
  assembler.Flush(frames);
  ASSERT_EQ(frames.size(), 1U);
  const auto last = static_cast<std::uint32_t>(count - 1);
  EXPECT_EQ(frames[0].lost_packets, (Ranges{{2, 2}, {last, 1}}));
  const std::uint32_t each = 39;  // (1400 - 222 - 4) / 30 points fit into a datagram.
  const std::uint32_t num_points = whole.header.num_points;
  EXPECT_EQ(frames[0].lost_points,
            (Ranges{{2 * each, 2 * each}, {last * each, num_points - last * each}}));
  std::vector<char> kept(whole.points.begin(), whole.points.begin() + 2 * each * 30);
  kept.insert(kept.end(), whole.points.begin() + 4 * each * 30,
              whole.points.begin() + last * each * 30);
  EXPECT_EQ(frames[0].points, kept);
  EXPECT_EQ(assembler.counts().incomplete_frames, 1U);
  EXPECT_EQ(assembler.counts().lost_packets, 3U);
}

TEST(FrameAssembler, KnowsWhatIsLostFromTheLastDatagramAlone) {
  const auto datagrams = DatagramsOf(StreamFrame(0));
  FrameAssembler assembler;
  auto frames = Feed(assembler, {datagrams.back()});
  assembler.Flush(frames);
  ASSERT_EQ(frames.size(), 1U);
  const auto num_full = static_cast<std::uint32_t>(datagrams.size() - 1);
  EXPECT_EQ(frames[0].lost_packets, (Ranges{{0, num_full}}));
  EXPECT_EQ(frames[0].lost_points, (Ranges{{0, num_full * 39}}));
}

TEST(FrameAssembler, GivesAnIncompleteFrameOnceALaterOneIsComplete) {
  auto datagrams = DatagramsOf(StreamFrame(0));
  datagrams.pop_back();
  FrameAssembler assembler;
  EXPECT_TRUE(Feed(assembler, datagrams).empty());
  auto next = DatagramsOf(StreamFrame(1));
  const std::string last = next.back();
  next.pop_back();
  EXPECT_TRUE(Feed(assembler, next).empty());
  const auto frames = Feed(assembler, {last});
  EXPECT_EQ(NumbersOf(frames), (Numbers{0, 1}));
  EXPECT_FALSE(frames[0].is_complete());
  EXPECT_TRUE(frames[1].is_complete());
}

TEST(FrameAssembler, GivesAnIncompleteFrameOnceTwoLaterOnesHaveBegun) {
  FrameAssembler assembler;
  EXPECT_TRUE(Feed(assembler, {DatagramsOf(StreamFrame(0)).front()}).empty());
  EXPECT_TRUE(Feed(assembler, {DatagramsOf(StreamFrame(1)).front()}).empty());
  EXPECT_EQ(NumbersOf(Feed(assembler, {DatagramsOf(StreamFrame(2)).front()})), (Numbers{0}));
}

TEST(FrameAssembler, CompletesAFrameFromDatagramsThatTheNextOneOvertook) {
  auto datagrams = DatagramsOfFrames(0, 1);
  const std::size_t half = datagrams.size() / 2;
  std::rotate(datagrams.begin() + static_cast<std::ptrdiff_t>(half) - 3,
              datagrams.begin() + static_cast<std::ptrdiff_t>(half),
              datagrams.begin() + static_cast<std::ptrdiff_t>(half) + 4);
  FrameAssembler assembler;
  const auto frames = Feed(assembler, datagrams);
  EXPECT_EQ(NumbersOf(frames), (Numbers{0, 1}));
  EXPECT_EQ(assembler.counts().complete_frames, 2U);
  EXPECT_EQ(assembler.counts().reordered_packets, 3U);
}

TEST(FrameAssembler, CountsFramesThatNeverCame) {
  FrameAssembler assembler;
  std::vector<std::string> datagrams = DatagramsOfFrames(3, 4);
  for (std::string& datagram : DatagramsOfFrames(8, 8)) datagrams.push_back(datagram);
  EXPECT_EQ(NumbersOf(Feed(assembler, datagrams)), (Numbers{3, 4, 8}));
  EXPECT_EQ(assembler.counts().missing_frames, 3U);
}

TEST(FrameAssembler, CountsWhatComesAfterItsFrameWasGiven) {
  auto datagrams = DatagramsOf(StreamFrame(0));
  const std::string delayed = datagrams[1];
  const std::string copied = datagrams[2];
  datagrams.erase(datagrams.begin() + 1);
  for (std::string& datagram : DatagramsOfFrames(1, 1)) datagrams.push_back(datagram);
  datagrams.push_back(delayed);
  datagrams.push_back(copied);
  FrameAssembler assembler;
  EXPECT_EQ(Feed(assembler, datagrams).size(), 2U);
  EXPECT_EQ(assembler.counts().late_packets, 1U);
  EXPECT_EQ(assembler.counts().duplicate_packets, 1U);
  EXPECT_EQ(assembler.counts().lost_packets, 1U);
}

TEST(FrameAssembler, FollowsALaterRunAtOnce) {
  FrameAssembler assembler;
  auto datagrams = DatagramsOfFrames(50, 50, OfRun(0xFFFFFFFF));
  for (std::string& datagram : DatagramsOfFrames(0, 1, OfRun(2))) datagrams.push_back(datagram);
  const auto frames = Feed(assembler, datagrams);
  EXPECT_EQ(NumbersOf(frames), (Numbers{50, 0, 1}));
  EXPECT_EQ(assembler.counts().complete_frames, 3U);
  EXPECT_EQ(assembler.counts().missing_frames, 0U);
  EXPECT_EQ(assembler.counts().restarts, 1U);
}

TEST(FrameAssembler, IsNotMisledByDatagramsOfTheRunBefore) {
  FrameAssembler assembler;
  auto datagrams = DatagramsOfFrames(0, 1, OfRun(2));
  const auto before = DatagramsOfFrames(50, 50, OfRun(1));
  for (std::size_t i = 0; i < 15; ++i) datagrams.insert(datagrams.begin() + 3, before[i]);
  EXPECT_EQ(NumbersOf(Feed(assembler, datagrams)), (Numbers{0, 1}));
  EXPECT_EQ(assembler.counts().complete_frames, 2U);
  EXPECT_EQ(assembler.counts().stray_packets, 15U);
}

// A sender may be restarted with the same run number or a smaller one, or be replaced by another
// sensor.
TEST(FrameAssembler, FollowsAnyRestartAfter16Datagrams) {
  for (const StreamSpec& spec : {OfRun(7), OfRun(6), OfRun(7, 1), OfRun(8, 1)}) {
    FrameAssembler assembler;
    ASSERT_EQ(Feed(assembler, DatagramsOfFrames(500, 500, OfRun(7))).size(), 1U);
    const auto frames = Feed(assembler, DatagramsOfFrames(0, 1, spec));
    EXPECT_EQ(NumbersOf(frames), (Numbers{0, 1}));
    EXPECT_EQ(frames[0].lost_packets.size() + frames[0].num_lost_packets(), 16U)
        << "one range of 15";
    EXPECT_TRUE(frames[1].is_complete());
  }
}

TEST(FrameAssembler, ForgetsAJokeAboutTheFuture) {
  FrameAssembler assembler;
  auto datagrams = DatagramsOfFrames(0, 0);
  for (std::string& joke : DatagramsOfFrames(4'000'000'000, 4'000'000'000)) {
    datagrams.push_back(joke);
  }
  for (std::string& datagram : DatagramsOfFrames(1, 2)) datagrams.push_back(datagram);
  const auto frames = Feed(assembler, datagrams);
  EXPECT_EQ(NumbersOf(frames), (Numbers{0, 4'000'000'000, 1, 2}));
  EXPECT_TRUE(frames[3].is_complete());
}

TEST(FrameAssembler, RefusesDatagramsThatDisagreeWithTheFirst) {
  const auto datagrams = DatagramsOf(StreamFrame(0));
  FrameAssembler assembler;
  Feed(assembler, {datagrams[0]});
  Feed(assembler, {With<std::int64_t>(datagrams[1], 24, 77),     // Stamp.
                   With<std::uint32_t>(datagrams[1], 48, 9999),  // Columns.
                   With<double>(datagrams[1], 56, 1.0),          // Position.
                   With<char>(datagrams[1], 172, 'q')});         // Name of the field x.
  EXPECT_EQ(assembler.counts().refused[static_cast<std::size_t>(StreamFault::kDisagrees)], 4U);
  EXPECT_EQ(Feed(assembler, {datagrams.begin() + 1, datagrams.end()}).size(), 1U);
  EXPECT_EQ(assembler.counts().complete_frames, 1U);
}

TEST(FrameAssembler, CountsWhatItRefusesByReason) {
  FrameAssembler assembler;
  const std::string sound = DatagramsOf(StreamFrame(0)).front();
  std::string damaged = sound;
  damaged[300] = static_cast<char>(damaged[300] + 1);
  Feed(assembler, {"", "hello", damaged, std::string(1000, 'x')});
  const StreamCounts& counts = assembler.counts();
  EXPECT_EQ(counts.refused[static_cast<std::size_t>(StreamFault::kSize)], 2U);
  EXPECT_EQ(counts.refused[static_cast<std::size_t>(StreamFault::kChecksum)], 1U);
  EXPECT_EQ(counts.refused[static_cast<std::size_t>(StreamFault::kMagic)], 1U);
  EXPECT_EQ(counts.num_refused(), 4U);
  EXPECT_EQ(counts.received_packets, 0U);
}

// Under random loss, duplication and delay every frame that is given is right both in what it has
// and in what it reports as lost, and the counts add up.
TEST(FrameAssembler, NeverGivesAWrongPointAndCountsEverything) {
  constexpr std::uint32_t kNumFrames = 40;
  struct Sent {
    double at;
    std::string bytes;
  };
  std::vector<Sent> arriving;
  std::size_t num_sent = 0;
  std::uint32_t item = 0;
  for (const std::string& datagram : DatagramsOfFrames(0, kNumFrames - 1)) {
    const auto words = RandomWords(5, RandomUse::kNoise, 0, item++);
    const auto share = [&](int i) {
      return static_cast<double>(UnitFloat(words[static_cast<std::size_t>(i)]));
    };
    const double delay = share(1) < 0.05 ? 40.0 * share(2) : 0.0;
    if (share(0) < 0.01) continue;
    arriving.push_back({static_cast<double>(item) + delay, datagram});
    if (share(3) < 0.02) arriving.push_back({static_cast<double>(item) + 25.0, datagram});
  }
  std::ranges::stable_sort(arriving, {}, &Sent::at);
  FrameAssembler assembler;
  std::vector<ReceivedFrame> frames;
  for (const Sent& sent : arriving) assembler.Take(sent.bytes, frames);
  num_sent = arriving.size();
  assembler.Flush(frames);
  std::uint64_t num_points_right = 0;
  std::uint64_t num_packets_given = 0;
  for (const ReceivedFrame& frame : frames) {
    std::vector<char> expected = ReceiveWhole(StreamFrame(frame.header.frame)).points;
    for (auto lost = frame.lost_points.rbegin(); lost != frame.lost_points.rend(); ++lost) {
      const auto begin = expected.begin() + static_cast<std::ptrdiff_t>(lost->first) * 30;
      expected.erase(begin, begin + static_cast<std::ptrdiff_t>(lost->count) * 30);
    }
    EXPECT_EQ(frame.points, expected) << frame.header.frame;
    num_points_right += frame.num_points();
    num_packets_given += frame.num_packets - frame.num_lost_packets();
  }
  const Numbers numbers = NumbersOf(frames);
  EXPECT_TRUE(std::ranges::is_sorted(numbers));
  EXPECT_EQ(std::ranges::adjacent_find(numbers), numbers.end());
  const StreamCounts& counts = assembler.counts();
  EXPECT_GT(num_points_right, 0U);
  EXPECT_GT(counts.complete_frames, 0U);
  EXPECT_GT(counts.incomplete_frames, 0U);
  EXPECT_GT(counts.duplicate_packets, 0U);
  EXPECT_GT(counts.reordered_packets, 0U);
  EXPECT_EQ(counts.complete_frames + counts.incomplete_frames, frames.size());
  EXPECT_EQ(counts.received_packets, num_sent);
  EXPECT_EQ(num_packets_given + counts.duplicate_packets + counts.late_packets, num_sent);
}

}  // namespace
}  // namespace railcast
