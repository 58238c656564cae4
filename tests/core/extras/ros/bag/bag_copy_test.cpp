#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/extras/ros/mcap/compression.h"
#include "core/io/write_file.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::bag {
namespace {

namespace fs = std::filesystem;

/// Copies a bag; the first topic's messages get `text` behind them unless it is empty.
void CopyWith(const fs::path& bag, const fs::path& copy, const std::string& text) {
  const auto reader = OpenBag(bag);
  const BagTopic topic = reader->topics().at(0);
  const auto copying = CopyBag(bag, copy, topic);
  reader->Select({0});
  while (const auto message = reader->Next()) {
    std::vector<std::byte> data(message->data.begin(), message->data.end());
    const auto more = std::as_bytes(std::span(text));
    data.insert(data.end(), more.begin(), more.end());
    copying->Put(message->place,
                 text.empty() ? std::nullopt : std::optional(std::span<const std::byte>(data)));
  }
  copying->Finish();
}

std::map<std::string, std::string> FilesIn(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(folder)] = ReadFileWhole(entry.path());
    }
  }
  return files;
}

void ExpectCopy(const fs::path& bag, const fs::path& copy) {
  const auto before = OpenBag(bag);
  const auto after = OpenBag(copy);
  ASSERT_EQ(before->topics(), after->topics());
  auto expected = MessagesOf(*before);
  for (HeldMessage& message : expected) {
    if (message.topic == before->topics().at(0).name) message.data += "more";
  }
  EXPECT_EQ(MessagesOf(*after), expected);
}

class BagCopies : public testing::Test {
 protected:
  void WriteMessages(BagWriter& writer) const {
    writer.Add(TopicNamed("/first"));
    writer.Add(TopicNamed("/second", true));
    for (std::int64_t i = 0; i < 20; ++i) {
      WriteText(writer, static_cast<std::size_t>(i % 2), i,
                std::string(200, static_cast<char>('a' + i)));
      if (i % 6 == 5) writer.Commit();
    }
    writer.Close();
  }
  [[nodiscard]] fs::path MadeMcap() const {
    WriteMessages(*CreateMcap(folder_.path() / "made.mcap"));
    return folder_.path() / "made.mcap";
  }
  [[nodiscard]] fs::path MadeRosbag2() const {
    WriteMessages(*CreateRosbag2(folder_.path() / "made"));
    return folder_.path() / "made";
  }

  TemporaryDirectory folder_;
};

TEST_F(BagCopies, AreTheirFilesIfNothingIsReplaced) {
  CopyWith(MadeMcap(), folder_.path() / "copy.mcap", "");
  EXPECT_EQ(ReadFileWhole(folder_.path() / "copy.mcap"),
            ReadFileWhole(folder_.path() / "made.mcap"));
  CopyWith(MadeRosbag2(), folder_.path() / "copy", "");
  EXPECT_EQ(FilesIn(folder_.path() / "copy"), FilesIn(folder_.path() / "made"));
}

TEST_F(BagCopies, DifferInTheReplacedMessagesAlone) {
  CopyWith(MadeMcap(), folder_.path() / "copy.mcap", "more");
  ExpectCopy(folder_.path() / "made.mcap", folder_.path() / "copy.mcap");
  CopyWith(MadeRosbag2(), folder_.path() / "copy", "more");
  ExpectCopy(folder_.path() / "made", folder_.path() / "copy");
  EXPECT_TRUE(exists(folder_.path() / "copy/metadata.yaml"));
}

// Whatever SQLite says of a bag's tables: names, ids, times, types.
TEST_F(BagCopies, OfDatabasesKeepAllOtherColumns) {
  CopyWith(MadeRosbag2(), folder_.path() / "copy", "more");
  const auto rows = [&](const std::string& file) {
    SqliteDatabase database(folder_.path() / file, SqliteAccess::kRead, file);
    SqliteStatement list(database, "SELECT id, topic_id, timestamp, length(data) FROM messages");
    std::vector<std::array<std::int64_t, 4>> all;
    while (list.Step())
      all.push_back({list.Integer(0), list.Integer(1), list.Integer(2), list.Integer(3)});
    return all;
  };
  auto expected = rows("made/made_0.db3");
  for (auto& row : expected) row[3] += row[1] == 1 ? 4 : 0;
  EXPECT_EQ(rows("copy/made_0.db3"), expected);
}

// As `ros2 bag record --compression-mode file` makes them.
TEST_F(BagCopies, OfCompressedFilesAreCompressed) {
  for (const fs::path& plain : {MadeMcap(), MadeRosbag2() / "made_0.db3"}) {
    std::string bytes;
    mcap::CompressFile(plain, [&](mcap::ByteSpan block) {
      bytes.append(reinterpret_cast<const char*>(block.data()), block.size());
    });
    const fs::path file = folder_.path() / (plain.filename().string() + ".zstd");
    const fs::path copy = folder_.path() / ("copy_of_" + file.filename().string());
    WriteFileWhole(file, bytes);
    CopyWith(file, copy, "");
    EXPECT_EQ(ReadFileWhole(copy), bytes);
    CopyWith(file, copy, "more");
    EXPECT_EQ(ReadFileWhole(copy).substr(0, 4), bytes.substr(0, 4));
    ExpectCopy(file, copy);
    EXPECT_FALSE(exists(fs::path(copy.string() + ".plain")));
  }
}

// Bags that ROS 2 itself wrote, in all versions of its formats.
TEST_F(BagCopies, OfRealBagsDifferInTheReplacedMessagesAlone) {
  const fs::path root = RAILCAST_SHARED_DATA_DIR "/rosbag2";
  if (!exists(root)) GTEST_SKIP() << root << " is not there";
  std::size_t num_bags = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().filename() != "metadata.yaml") continue;
    const fs::path bag = entry.path().parent_path();
    if (OpenBag(bag)->topics().empty()) continue;
    SCOPED_TRACE(bag);
    const std::string name = "bag" + std::to_string(num_bags++);
    CopyWith(bag, folder_.path() / name, "");
    EXPECT_EQ(FilesIn(folder_.path() / name), FilesIn(bag));
    CopyWith(bag, folder_.path() / (name + "_edited"), "more");
    ExpectCopy(bag, folder_.path() / (name + "_edited"));
  }
  EXPECT_GT(num_bags, 10U);
}

}  // namespace
}  // namespace railcast::bag
