#include "core/extras/ros/mcap/mcap_copy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/extras/ros/mcap/compression.h"
#include "core/extras/ros/mcap/mcap_reader.h"
#include "core/extras/ros/mcap/mcap_writer.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::mcap {
namespace {

namespace fs = std::filesystem;

/// What becomes of the data of a message; nothing if they stay.
using Replace = std::function<std::optional<Bytes>(const McapMessage&)>;

/// Returns the bytes of a copy in which messages of these channels are replaced.
std::string CopyOf(const fs::path& file,
                   const std::set<std::uint16_t>& channels,
                   const Replace& replace) {
  std::string bytes;
  McapCopy copy(
      file, file.string(),
      [&](ByteSpan block) {
        bytes.append(reinterpret_cast<const char*>(block.data()), block.size());
      },
      channels);
  McapReader reader(file, file.string());
  reader.Select(channels);
  while (const auto message = reader.Next()) copy.Put(reader.place(), replace(*message));
  copy.Finish();
  return bytes;
}

std::set<std::uint16_t> ChannelsIn(const fs::path& file) {
  const McapReader reader(file, file.string());
  std::set<std::uint16_t> channels;
  for (const auto& [id, channel] : reader.index().channels) channels.insert(id);
  return channels;
}

std::optional<Bytes> Longer(const McapMessage& message) {
  Bytes data(message.data.begin(), message.data.end());
  data.insert(data.end(), 1000, std::byte{7});
  return data;
}
std::optional<Bytes> Shorter(const McapMessage& message) {
  return Bytes(message.data.begin(), message.data.end() - 1000);
}
std::optional<Bytes> Kept(const McapMessage&) {
  return std::nullopt;
}

struct Held {
  std::uint16_t channel{};
  std::uint32_t sequence{};
  std::uint64_t log_time{};
  std::uint64_t publish_time{};
  Bytes data;

  bool operator==(const Held&) const = default;
};

std::vector<Held> MessagesIn(const fs::path& file) {
  McapReader reader(file, file.string());
  std::vector<Held> messages;
  while (const auto message = reader.Next()) {
    messages.push_back({message->channel_id,
                        message->sequence,
                        message->log_time,
                        message->publish_time,
                        {message->data.begin(), message->data.end()}});
  }
  return messages;
}

class McapCopies : public testing::Test {
 protected:
  [[nodiscard]] fs::path Put(const std::string& name, const std::string& bytes) const {
    WriteFileWhole(folder_.path() / name, bytes);
    return folder_.path() / name;
  }

  /// A file with two channels, in chunks that overlap in time.
  [[nodiscard]] fs::path Made(McapCompression compression, bool has_chunks = true) const {
    std::string bytes;
    McapWriter writer(
        [&](ByteSpan block) {
          bytes.append(reinterpret_cast<const char*>(block.data()), block.size());
        },
        {"", "test"}, compression, {.has_chunks = has_chunks});
    writer.Write(McapSchema{1, "Thing", "ros2msg", "string data"});
    for (const std::uint16_t channel : {std::uint16_t{1}, std::uint16_t{2}}) {
      writer.Write(McapChannel{channel, 1, "/t" + std::to_string(channel), "cdr", {}});
    }
    writer.Write(McapMetadata{"note", {{"a", "b"}}});
    for (std::uint32_t i = 0; i < 12; ++i) {
      const Bytes data(100 + i, static_cast<std::byte>(i));
      const std::uint64_t time = i % 4 == 0 ? i + 5 : i;
      writer.Write(McapMessage{static_cast<std::uint16_t>(1 + i % 2), i, time, time + 1, data});
      if (i % 3 == 2) writer.EndChunk();
    }
    writer.Finish();
    return Put("made.mcap", bytes);
  }

  TemporaryDirectory folder_;
};

TEST_F(McapCopies, AreTheFileIfNothingIsReplaced) {
  for (const auto compression :
       {McapCompression::kNone, McapCompression::kLz4, McapCompression::kZstd}) {
    const fs::path file = Made(compression);
    EXPECT_EQ(CopyOf(file, {1}, Kept), ReadFileWhole(file));
    EXPECT_EQ(CopyOf(file, {}, Kept), ReadFileWhole(file));
  }
}

TEST_F(McapCopies, DifferInTheReplacedMessagesAlone) {
  for (const auto compression :
       {McapCompression::kNone, McapCompression::kLz4, McapCompression::kZstd}) {
    const fs::path file = Made(compression);
    const fs::path copy = Put("copy.mcap", CopyOf(file, {1}, Longer));
    auto expected = MessagesIn(file);
    for (Held& message : expected) {
      if (message.channel == 1) message.data.insert(message.data.end(), 1000, std::byte{7});
    }
    EXPECT_EQ(MessagesIn(copy), expected);
    const McapIndex before = McapReader(file, "").index();
    const McapIndex after = McapReader(copy, "").index();
    EXPECT_EQ(after.chunks.size(), before.chunks.size());
    EXPECT_EQ(after.chunks.front().compression, before.chunks.front().compression);
    EXPECT_EQ(after.channels, before.channels);
    EXPECT_EQ(after.statistics.message_count, before.statistics.message_count);
  }
}

// What a summary says of places and sizes is what is found without it.
TEST_F(McapCopies, HaveSummariesThatAreRight) {
  const fs::path file = Made(McapCompression::kZstd);
  const fs::path copy = Put("copy.mcap", CopyOf(file, {2}, Longer));
  const ByteFile bytes(copy, "copy");
  const McapIndex stated = ReadIndex(bytes);
  const McapIndex found = ScanWhole(bytes, bytes.size()).index;
  ASSERT_EQ(stated.chunks.size(), found.chunks.size());
  for (std::size_t i = 0; i < stated.chunks.size(); ++i) {
    EXPECT_EQ(stated.chunks[i].chunk_start_offset, found.chunks[i].chunk_start_offset);
    EXPECT_EQ(stated.chunks[i].chunk_length, found.chunks[i].chunk_length);
    EXPECT_EQ(stated.chunks[i].message_index_offsets, found.chunks[i].message_index_offsets);
    EXPECT_EQ(stated.chunks[i].message_index_length, found.chunks[i].message_index_length);
    EXPECT_EQ(stated.chunks[i].compressed_size, found.chunks[i].compressed_size);
    EXPECT_EQ(stated.chunks[i].uncompressed_size, found.chunks[i].uncompressed_size);
  }
  ASSERT_EQ(stated.metadata.size(), 1U);
  EXPECT_EQ(stated.metadata[0].offset, found.metadata[0].offset);
}

TEST_F(McapCopies, OfAFileThatWasCutOffEndAsItDoes) {
  std::string bytes = ReadFileWhole(Made(McapCompression::kNone));
  const fs::path cut = Put("cut.mcap", bytes.substr(0, bytes.size() / 2));
  EXPECT_EQ(CopyOf(cut, {1}, Kept), ReadFileWhole(cut));
  const fs::path copy = Put("copy.mcap", CopyOf(cut, {1}, Longer));
  EXPECT_EQ(CopyOf(copy, {1}, Shorter), ReadFileWhole(cut));
}

TEST_F(McapCopies, OfDamagedFilesSayWhere) {
  const fs::path file = Made(McapCompression::kNone);
  std::string bytes = ReadFileWhole(file);
  bytes[200] = static_cast<char>(bytes[200] ^ 1);
  const fs::path damaged = Put("damaged.mcap", bytes);
  EXPECT_TRUE(MessageOf([&] {
                (void)CopyOf(damaged, {1}, Kept);
              }).starts_with(damaged.string() + ": record at "));
}

TEST_F(McapCopies, AreMadeOrRefusedWithALineWhateverByteIsDamaged) {
  const std::string whole = ReadFileWhole(Made(McapCompression::kNone));
  std::size_t num_copied = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << i % 8));
    const fs::path damaged = Put("damaged.mcap", bytes);
    try {
      num_copied += CopyOf(damaged, {1}, Longer).empty() ? 0 : 1;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_LT(num_copied, whole.size());
}

// The official conformance suite: all combinations of features. What is made longer and shorter
// again is the file, byte for byte, with all its places and checksums.
TEST_F(McapCopies, AreTheFileAgainOnceWhatWasReplacedIsPutBack) {
  const fs::path suite = RAILCAST_SHARED_DATA_DIR "/mcap/conformance";
  if (!exists(suite)) GTEST_SKIP() << suite << " is not there";
  std::size_t num_changed = 0;
  for (const auto& entry : fs::recursive_directory_iterator(suite)) {
    if (entry.path().extension() != ".mcap") continue;
    SCOPED_TRACE(entry.path());
    const auto channels = ChannelsIn(entry.path());
    const std::string original = ReadFileWhole(entry.path());
    EXPECT_EQ(CopyOf(entry.path(), channels, Kept), original);
    const std::string longer = CopyOf(entry.path(), channels, Longer);
    num_changed += longer == original ? 0 : 1;
    EXPECT_EQ(CopyOf(Put("longer.mcap", longer), channels, Shorter), original);
  }
  EXPECT_GT(num_changed, 100U);
}

}  // namespace
}  // namespace railcast::mcap
