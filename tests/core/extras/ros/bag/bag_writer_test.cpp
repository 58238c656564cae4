#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/io/write_file.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::bag {
namespace {

constexpr std::size_t kNumFrames = 4;
constexpr std::size_t kAllCommits = 1000;

/// Makes a commit before the first frame, then those of frames up to `end`.
void WriteFrames(BagWriter& bag, std::size_t end) {
  const std::size_t fixed = bag.Add(TopicNamed("/tf_static", true));
  const std::size_t points = bag.Add(TopicNamed("/lidar/points"));
  if (bag.num_commits() == 0) {
    const std::string text = "{}";
    bag.Attach("scenario.json", "application/json", std::as_bytes(std::span(text)));
    WriteText(bag, fixed, 0, "fixed");
    bag.Commit();
  }
  for (std::size_t frame = bag.num_commits() - 1; frame < end; ++frame) {
    const auto time_ns = static_cast<std::int64_t>(100 * frame);
    WriteText(bag, points, time_ns + 50, std::string(1000, static_cast<char>('a' + frame)));
    WriteText(bag, points, time_ns, "first of " + std::to_string(frame));
    bag.Commit();
  }
}

class BagWriting : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path In(const std::string& name) const {
    return folder_.path() / name;
  }
  [[nodiscard]] std::string WholeMcap() const {
    const auto bag = CreateMcap(In("whole.mcap"));
    WriteFrames(*bag, kNumFrames);
    bag->Close();
    return ReadFileWhole(In("whole.mcap"));
  }

  TemporaryDirectory folder_;
};

TEST_F(BagWriting, GivesBackWhatWasWrittenInOrderOfTime) {
  (void)WholeMcap();
  const auto rosbag2 = CreateRosbag2(In("whole"));
  WriteFrames(*rosbag2, kNumFrames);
  rosbag2->Close();
  for (const char* name : {"whole.mcap", "whole", "whole/whole_0.db3"}) {
    SCOPED_TRACE(name);
    const auto bag = OpenBag(In(name));
    EXPECT_EQ(bag->topics(),
              (std::vector{TopicNamed("/tf_static", true), TopicNamed("/lidar/points")}));
    const auto messages = MessagesOf(*bag);
    ASSERT_EQ(messages.size(), 1 + 2 * kNumFrames);
    EXPECT_EQ(messages[0], (HeldMessage{"/tf_static", 0, "fixed"}));
    EXPECT_EQ(messages[1], (HeldMessage{"/lidar/points", 0, "first of 0"}));
    EXPECT_EQ(messages[2], (HeldMessage{"/lidar/points", 50, std::string(1000, 'a')}));
    bag->Select({0});
    EXPECT_EQ(MessagesOf(*bag).size(), 1U);
    bag->Select({1});
    EXPECT_EQ(MessagesOf(*bag).size(), 2 * kNumFrames);
  }
}

TEST_F(BagWriting, KeepsFilesInOrBesideTheMessages) {
  (void)WholeMcap();
  const auto attachments = OpenBag(In("whole.mcap"))->ReadAttachments();
  ASSERT_EQ(attachments.size(), 1U);
  EXPECT_EQ(attachments[0].name, "scenario.json");
  EXPECT_EQ(attachments[0].media_type, "application/json");
  EXPECT_EQ(attachments[0].bytes, (std::vector{std::byte{'{'}, std::byte{'}'}}));
  const auto rosbag2 = CreateRosbag2(In("whole"));
  WriteFrames(*rosbag2, 1);
  EXPECT_EQ(ReadFileWhole(In("whole/scenario.json")), "{}");
}

TEST_F(BagWriting, GivesTheSameBytesAgain) {
  const std::string once = WholeMcap();
  EXPECT_TRUE(WholeMcap() == once);
  for (const char* name : {"a/bag", "b/bag"}) {
    const auto bag = CreateRosbag2(In(name));
    WriteFrames(*bag, kNumFrames);
    bag->Close();
  }
  EXPECT_TRUE(ReadFileWhole(In("a/bag/bag_0.db3")) == ReadFileWhole(In("b/bag/bag_0.db3")));
  EXPECT_EQ(ReadFileWhole(In("a/bag/metadata.yaml")), ReadFileWhole(In("b/bag/metadata.yaml")));
}

// Whatever part of it had reached the disk.
TEST_F(BagWriting, GoesOnWithAnInterruptedMcapFileToTheSameBytes) {
  const std::string whole = WholeMcap();
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    SCOPED_TRACE(size);
    std::ofstream(In("cut.mcap.part"), std::ios::binary) << whole.substr(0, size);
    const auto bag = ContinueMcap(In("cut.mcap"), McapCompression::kZstd, kAllCommits);
    EXPECT_LE(bag->num_commits(), kNumFrames + 1);
    WriteFrames(*bag, kNumFrames);
    bag->Close();
    // The names of the files are in them.
    std::filesystem::rename(In("cut.mcap"), In("renamed"));
    const auto renamed = MessagesIn(In("renamed"));
    EXPECT_EQ(renamed, MessagesIn(In("whole.mcap")));
  }
  std::ofstream(In("whole.mcap.part"), std::ios::binary) << whole.substr(0, whole.size() / 2);
  const auto bag = ContinueMcap(In("whole.mcap"), McapCompression::kZstd, kAllCommits);
  EXPECT_GT(bag->num_commits(), 0U);
  WriteFrames(*bag, kNumFrames);
  bag->Close();
  EXPECT_TRUE(ReadFileWhole(In("whole.mcap")) == whole);
}

TEST_F(BagWriting, DropsWhatAPowerCutDamaged) {
  const std::string whole = WholeMcap();
  std::string cut = whole.substr(0, whole.size() / 2);
  std::fill(cut.end() - 60, cut.end(), '\0');
  std::ofstream(In("whole.mcap.part"), std::ios::binary) << cut << std::string(5000, '\0');
  const auto bag = ContinueMcap(In("whole.mcap"), McapCompression::kZstd, kAllCommits);
  EXPECT_GT(bag->num_commits(), 0U);
  WriteFrames(*bag, kNumFrames);
  bag->Close();
  EXPECT_TRUE(ReadFileWhole(In("whole.mcap")) == whole);
}

TEST_F(BagWriting, DropsCommitsThatTheRunDoesNotCount) {
  const std::string whole = WholeMcap();
  std::ofstream(In("whole.mcap.part"), std::ios::binary) << whole;
  const auto bag = ContinueMcap(In("whole.mcap"), McapCompression::kZstd, 2);
  EXPECT_EQ(bag->num_commits(), 2U);
  WriteFrames(*bag, kNumFrames);
  bag->Close();
  EXPECT_TRUE(ReadFileWhole(In("whole.mcap")) == whole);
}

TEST_F(BagWriting, RefusesToGoOnWithWhatOthersWrote) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/mcap/pointcloud2/vls128_pointcloud2_zstd.mcap";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  copy_file(file, In("other.mcap.part"));
  std::filesystem::permissions(In("other.mcap.part"), std::filesystem::perms::owner_all);
  EXPECT_EQ(
      MessageOf([&] { (void)ContinueMcap(In("other.mcap"), McapCompression::kZstd, kAllCommits); }),
      In("other.mcap.part").string() +
          ": must be an MCAP file that railcast began (got \"@mcap/core\")");
}

TEST_F(BagWriting, LeavesAnInterruptedDatabaseReadableUpToTheLastFrameAndGoesOnWithIt) {
  {
    const auto bag = CreateRosbag2(In("bag"));
    WriteFrames(*bag, 2);
    WriteText(*bag, 1, 500, "of a frame that is never finished");
  }
  EXPECT_FALSE(exists(In("bag/metadata.yaml")));
  EXPECT_EQ(MessagesIn(In("bag")).size(), 5U);
  for (const std::size_t max_commits : {kAllCommits, std::size_t{2}}) {
    std::filesystem::remove_all(In("copy"));
    std::filesystem::copy(In("bag"), In("copy"));
    std::filesystem::rename(In("copy/bag_0.db3"), In("copy/copy_0.db3"));
    const auto bag = ContinueRosbag2(In("copy"), max_commits);
    EXPECT_EQ(bag->num_commits(), std::min<std::size_t>(3, max_commits));
    WriteFrames(*bag, kNumFrames);
    bag->Close();
    EXPECT_EQ(MessagesIn(In("copy")).size(), 1 + 2 * kNumFrames);
    EXPECT_EQ(MessagesIn(In("copy"))[1].data, "first of 0");
    EXPECT_EQ(MessageOf([&] { (void)ContinueRosbag2(In("copy"), 1); }),
              In("copy").string() + ": must be unfinished (got metadata.yaml)");
  }
}

TEST_F(BagWriting, RefusesADirectoryThatHoldsSomething) {
  std::filesystem::create_directory(In("full"));
  std::ofstream(In("full/file")) << "mine";
  EXPECT_EQ(MessageOf([&] { (void)CreateRosbag2(In("full")); }),
            In("full").string() + ": must be empty or not exist");
}

TEST_F(BagWriting, ReportsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(MessageOf([] { (void)CreateMcap("/dev/full"); }),
            "/dev/full: must be a regular file (got a character device)");
}

TEST_F(BagWriting, FollowsNoLinksToDatabases) {
  {
    const auto bag = CreateRosbag2(In("mine"));
    WriteFrames(*bag, 1);
  }
  const std::string before = ReadFileWhole(In("mine/mine_0.db3"));
  std::filesystem::create_directory(In("bag"));
  std::filesystem::create_symlink(In("mine/mine_0.db3"), In("bag/bag_0.db3"));
  const std::string refusal =
      In("bag/bag_0.db3").string() + ": must be a regular file (got a symbolic link)";
  EXPECT_EQ(MessageOf([&] { (void)ContinueRosbag2(In("bag"), kAllCommits); }), refusal);
  EXPECT_EQ(MessageOf([&] { (void)CopySqliteBag(In("mine/mine_0.db3"), In("bag/bag_0.db3")); }),
            refusal);
  EXPECT_EQ(ReadFileWhole(In("mine/mine_0.db3")), before);
}

// What a recorder that was killed leaves beside its database.
TEST_F(BagWriting, IsReadFromTheWriteAheadLogOfAnInterruptedRecorder) {
  {
    const auto bag = CreateRosbag2(In("bag"));
    WriteFrames(*bag, 1);
  }
  SqliteDatabase open(In("bag/bag_0.db3"), SqliteAccess::kChange, "bag");
  open.Run("PRAGMA journal_mode = WAL");
  open.Run("INSERT INTO messages (timestamp, topic_id, data) VALUES (900, 2, x'6c617374')");
  std::filesystem::create_directory(In("left"));
  for (const char* name : {"bag_0.db3", "bag_0.db3-wal"}) {
    copy_file(In("bag") / name, In("left") / name);
  }
  const auto messages = MessagesIn(In("left"));
  ASSERT_EQ(messages.size(), 4U);
  EXPECT_EQ(messages.back(), (HeldMessage{"/lidar/points", 900, "last"}));
  // And nothing is written beside it.
  std::size_t num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(In("left"))) {
    EXPECT_NE(entry.path().extension(), ".db3-shm");
    ++num_files;
  }
  EXPECT_EQ(num_files, 2U);
}

}  // namespace
}  // namespace railcast::bag
