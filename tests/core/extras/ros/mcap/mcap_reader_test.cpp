#include "core/extras/ros/mcap/mcap_reader.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/mcap_writer.h"
#include "core/io/write_file.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::mcap {
namespace {

struct TimedText {
  std::uint64_t time{};
  std::string text;

  bool operator==(const TimedText&) const = default;
};

/// Returns a file with these chunks of messages on one channel.
std::string MadeFile(const std::vector<std::vector<TimedText>>& chunks,
                     McapCompression compression,
                     const McapFeatures& features = {}) {
  std::string bytes;
  const auto sink = [&](ByteSpan more) {
    bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
  };
  McapWriter writer(sink, {"", "test"}, compression, features);
  writer.Write(McapSchema{1, "text", "", ""});
  writer.Write(McapChannel{1, 1, "/a", "text", {}});
  for (const auto& chunk : chunks) {
    for (const TimedText& message : chunk) {
      writer.Write(McapMessage{.channel_id = 1,
                               .log_time = message.time,
                               .publish_time = message.time,
                               .data = std::as_bytes(std::span(message.text))});
    }
    writer.EndChunk();
  }
  writer.Finish();
  return bytes;
}

class McapFile : public testing::Test {
 protected:
  std::vector<TimedText> Read(const std::string& bytes, std::size_t held_bytes = 1U << 28U) {
    std::ofstream(file_, std::ios::binary) << bytes;
    McapReader reader(file_, "file", held_bytes);
    std::vector<TimedText> messages;
    while (const auto message = reader.Next()) {
      messages.push_back(
          {message->log_time,
           {reinterpret_cast<const char*>(message->data.data()), message->data.size()}});
    }
    return messages;
  }

  /// Returns a file with another summary.
  std::string WithIndex(const std::string& bytes, const std::function<void(McapIndex&)>& change) {
    std::ofstream(file_, std::ios::binary) << bytes;
    McapIndex index = ReadIndex(ByteFile(file_, "file"));
    change(index);
    // The footer's first field, at which the summary begins.
    std::uint64_t begin = 0;
    std::memcpy(&begin, bytes.data() + bytes.size() - kMagic.size() - 20, sizeof begin);
    Bytes summary;
    for (const auto& [id, schema] : index.schemas) AppendRecord(schema, summary);
    for (const auto& [id, channel] : index.channels) AppendRecord(channel, summary);
    for (const McapChunkIndex& chunk : index.chunks) AppendRecord(chunk, summary);
    AppendRecord(index.statistics, summary);
    AppendRecord(McapFooter{.summary_start = begin, .summary_offset_start = 0, .summary_crc = 0},
                 summary);
    summary.insert(summary.end(), kMagic.begin(), kMagic.end());
    return bytes.substr(0, begin) +
           std::string(reinterpret_cast<const char*>(summary.data()), summary.size());
  }

  TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "file.mcap";
};

const std::vector<std::vector<TimedText>> kOverlapping = {
    {{5, "a"}, {20, "b"}, {6, "c"}}, {{7, "d"}, {30, "e"}}, {{1, "f"}, {7, "g"}}, {{40, "h"}}};
const std::vector<TimedText> kInOrder = {{1, "f"}, {5, "a"},  {6, "c"},  {7, "d"},
                                         {7, "g"}, {20, "b"}, {30, "e"}, {40, "h"}};

TEST_F(McapFile, GivesMessagesInOrderOfTimeAcrossOverlappingChunks) {
  for (const auto compression :
       {McapCompression::kNone, McapCompression::kLz4, McapCompression::kZstd}) {
    EXPECT_EQ(Read(MadeFile(kOverlapping, compression)), kInOrder);
  }
}

TEST_F(McapFile, GivesTheSameWithoutSummaryAndWithoutChunks) {
  EXPECT_EQ(Read(MadeFile(kOverlapping, McapCompression::kZstd, {.has_statistics = false})),
            kInOrder);
  EXPECT_EQ(Read(MadeFile(kOverlapping, McapCompression::kNone, {.has_chunks = false})), kInOrder);
  EXPECT_EQ(Read(MadeFile(kOverlapping, McapCompression::kLz4, {.has_message_indexes = false})),
            kInOrder);
}

// As some writers leave it out that were interrupted.
TEST_F(McapFile, GivesMessagesOfChunksThatItsSummaryLeavesOut) {
  const std::string bytes = MadeFile(kOverlapping, McapCompression::kZstd);
  for (std::size_t lost = 0; lost < kOverlapping.size(); ++lost) {
    const std::string without = WithIndex(bytes, [&](McapIndex& index) {
      index.chunks.erase(index.chunks.begin() + static_cast<std::ptrdiff_t>(lost));
      --index.statistics.chunk_count;
      index.statistics.message_count -= kOverlapping[lost].size();
      index.statistics.channel_message_counts.at(1) -= kOverlapping[lost].size();
    });
    EXPECT_EQ(Read(without), kInOrder) << lost;
    // Also where the statistics know better.
    EXPECT_EQ(Read(WithIndex(bytes,
                             [](McapIndex& index) {
                               index.chunks.resize(2);
                               index.statistics.chunk_count = 2;
                             })),
              kInOrder);
  }
}

// More than the reader holds: chunks are read again.
TEST_F(McapFile, ReadsChunksAgainThatItCouldNotHold) {
  constexpr std::size_t kHeld_bytes = 4096;
  const std::string zeros(kHeld_bytes / 2, '\0');
  const auto messages = Read(
      MadeFile(
          {{{1, zeros}, {10, "last"}}, {{2, zeros}, {9, "third"}}, {{3, zeros}}, {{4, "small"}}},
          McapCompression::kZstd),
      kHeld_bytes);
  ASSERT_EQ(messages.size(), 6U);
  EXPECT_TRUE(messages[2] == (TimedText{3, zeros}));
  EXPECT_EQ(messages[3], (TimedText{4, "small"}));
  EXPECT_EQ(messages[4], (TimedText{9, "third"}));
  EXPECT_EQ(messages[5], (TimedText{10, "last"}));
}

TEST_F(McapFile, IsReadUpToTheLastWholeChunkWhereverItWasCutOff) {
  const std::vector<std::vector<TimedText>> chunks = {{{1, "a"}}, {{2, "b"}}, {{3, "c"}}};
  const std::string whole = MadeFile(chunks, McapCompression::kLz4);
  std::size_t most = 0;
  for (std::size_t size = kMagic.size(); size < whole.size(); ++size) {
    const auto messages = Read(whole.substr(0, size));
    EXPECT_GE(messages.size(), most) << size;
    most = messages.size();
    for (std::size_t i = 0; i < most; ++i) EXPECT_EQ(messages[i], chunks[i].front());
  }
  EXPECT_EQ(most, 3U);
}

// A length that is too large for a file which has its end is none of a recorder that was killed.
TEST_F(McapFile, IsRefusedIfARecordDoesNotFitIntoIt) {
  std::string whole = MadeFile({{{1, "a"}}, {{2, "b"}}}, McapCompression::kNone);
  const std::string name = (folder_.path() / "whole.mcap").string();
  WriteFileWhole(name, whole);
  const auto last = ReadIndex(ByteFile(name, "file")).chunks.at(1).chunk_start_offset;
  constexpr std::uint64_t kMany = std::uint64_t{1} << 60U;
  std::memcpy(&whole[last + 1], &kMany, sizeof kMany);
  // Without what leads to the summary, the file is gone through.
  const std::size_t footer = whole.size() - kMagic.size() - 20;
  std::fill_n(whole.begin() + static_cast<std::ptrdiff_t>(footer), 20, '\0');
  EXPECT_EQ(MessageOf([&] { (void)Read(whole); }),
            "file: record at " + std::to_string(last) +
                ": length: must end within the file, which is complete (got 1152921504606846976)");
}

TEST_F(McapFile, IsReadOrRefusedWithALineWhateverByteIsDamaged) {
  for (const bool has_summary : {true, false}) {
    const std::string whole =
        MadeFile(kOverlapping, McapCompression::kNone, {.has_statistics = has_summary});
    std::size_t num_refused = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const std::string message = MessageOf([&] { (void)Read(Flipped(whole, i)); });
      EXPECT_TRUE(message == "no error" || message.starts_with("file: ")) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      if (message != "no error") ++num_refused;
    }
    EXPECT_GT(num_refused, whole.size() / 4);
  }
}

TEST_F(McapFile, SaysWhichChunkIsDamaged) {
  const std::string whole = MadeFile({{{1, "abcdef"}}}, McapCompression::kNone);
  const std::size_t text = whole.find("abcdef");
  EXPECT_EQ(MessageOf([&] { (void)Read(Flipped(whole, text)); }).substr(0, 60),
            "file: record at 29: uncompressed_crc: must be that of the re");
}

TEST_F(McapFile, RefusesStatisticsOfOtherNumbersOfMessages) {
  const std::string whole = MadeFile(kOverlapping, McapCompression::kZstd);
  EXPECT_EQ(Read(WithIndex(whole, [](McapIndex&) {})), kInOrder);
  const std::string other =
      WithIndex(whole, [](McapIndex& index) { index.statistics.channel_message_counts.at(1) = 9; });
  EXPECT_EQ(MessageOf([&] { (void)Read(other); }),
            "file: must have as many messages of channel 1 as its statistics say, 9 (got 8)");
}

// However many entries name one chunk, it is not read at all.
TEST_F(McapFile, RefusesAnIndexThatNamesAChunkTwice) {
  const std::string whole = MadeFile(kOverlapping, McapCompression::kZstd);
  std::string offset;
  const std::string twice = WithIndex(whole, [&](McapIndex& index) {
    index.chunks.push_back(index.chunks[1]);
    index.statistics.chunk_count = 5;
    offset = std::to_string(index.chunks[1].chunk_start_offset);
  });
  EXPECT_TRUE(
      MessageOf([&] { (void)Read(twice); })
          .ends_with(": summary: offset: must be that of a record of its own in the data (got " +
                     offset + ")"));
  // Of two that overlap, one states a length that is not its record's.
  const std::string shorter =
      WithIndex(whole, [](McapIndex& index) { index.chunks[1].chunk_length = 9; });
  EXPECT_EQ(MessageOf([&] { (void)Read(shorter); }).substr(0, 16), "file: record at ");
}

TEST_F(McapFile, RefusesWhatIsNone) {
  EXPECT_EQ(MessageOf([&] { (void)Read("no MCAP file at all"); }),
            "file: must begin as an MCAP file");
  EXPECT_EQ(MessageOf([&] { (void)Read(""); }), "file: must begin as an MCAP file");
}

TEST(McapCompression, RefusesWhatBecomesLargerThanStated) {
  const Bytes zeros(std::size_t{1} << 20U);
  for (const auto compression : {McapCompression::kLz4, McapCompression::kZstd}) {
    const Bytes bomb = Compressed(zeros, compression);
    EXPECT_EQ(Uncompressed(bomb, compression, zeros.size()), zeros);
    EXPECT_EQ(MessageOf([&] { (void)Uncompressed(bomb, compression, 1000); }),
              "must become at most 1000 bytes (got more)");
    const ByteSpan cut(bomb.data(), bomb.size() - 1);
    EXPECT_NE(MessageOf([&] {
                (void)Uncompressed(cut, compression, zeros.size());
              }).find("it ends early"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace railcast::mcap
