#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/base/input_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::bag {
namespace {

class DamagedBag : public testing::Test {
 protected:
  /// Makes a database of a few messages and lets `change` run in it.
  std::filesystem::path Database(const std::string& sql) {
    std::filesystem::remove_all(folder_.path() / "bag");
    const auto bag = CreateRosbag2(folder_.path() / "bag");
    const std::size_t topic = bag->Add(TopicNamed("/a"));
    for (int i = 0; i < 20; ++i) WriteText(*bag, topic, i, std::string(300, 'x'));
    bag->Close();
    std::filesystem::path file = folder_.path() / "bag/bag_0.db3";
    SqliteDatabase(file, SqliteAccess::kChange, "bag").Run(sql);
    return file;
  }
  std::string MessageAbout(const std::filesystem::path& file) {
    return MessageOf([&] { (void)MessagesIn(file); });
  }

  TemporaryDirectory folder_;
};

TEST_F(DamagedBag, IsRefusedIfItsTablesAreOthers) {
  const auto file = Database("DROP TABLE topics");
  EXPECT_EQ(MessageAbout(file),
            file.string() + ": must have the table topics, as rosbag2 makes it");
  (void)Database(
      "ALTER TABLE messages RENAME TO hidden; CREATE VIEW messages AS SELECT * FROM hidden");
  EXPECT_EQ(MessageAbout(file),
            file.string() + ": must have the table messages, as rosbag2 makes it");
}

TEST_F(DamagedBag, IsRefusedIfMessagesAreNone) {
  const auto file = Database("UPDATE messages SET data = 'text' WHERE id = 3");
  EXPECT_EQ(MessageAbout(file), file.string() + ": message 3: data: must be a blob");
  (void)Database("UPDATE messages SET topic_id = 7 WHERE id = 3");
  EXPECT_EQ(MessageAbout(file),
            file.string() + ": message 3: topic_id: must be that of a topic (got 7)");
}

TEST_F(DamagedBag, IsRefusedIfItsEndIsMissing) {
  const auto file = Database("VACUUM");
  const auto size = std::filesystem::file_size(file);
  std::filesystem::resize_file(file, size - 5000);
  EXPECT_EQ(MessageAbout(file),
            file.string() + ": must have its end, " + std::to_string(size) + " bytes (got " +
                std::to_string(size - 5000) +
                "): sqlite3 bag_0.db3 .recover makes a database of what is there");
}

// Also where other topics are asked for: a message of one of these may be among them.
TEST_F(DamagedBag, IsRefusedIfAMessageThatNobodyAskedForIsOfNoTopic) {
  const auto file = Database("UPDATE messages SET topic_id = 7 WHERE id = 3");
  const auto reader = OpenBag(file);
  reader->Select({});
  EXPECT_EQ(MessageOf([&] { (void)reader->Next(); }),
            file.string() + ": message 3: topic_id: must be that of a topic (got 7)");
}

TEST_F(DamagedBag, IsRefusedIfTwoRowsHaveOneId) {
  for (const std::string table : {"topics", "messages"}) {
    const auto file = Database("CREATE TABLE copy AS SELECT * FROM " + table + "; DROP TABLE " +
                               table + "; ALTER TABLE copy RENAME TO " + table);
    EXPECT_EQ(MessageAbout(file), "no error");
    SqliteDatabase(file, SqliteAccess::kChange, "bag")
        .Run("INSERT INTO " + table + " SELECT * FROM " + table + " WHERE id = 1");
    EXPECT_EQ(MessageAbout(file),
              file.string() + ": " + table + ": id: must be that of one row (got 1)");
  }
}

TEST_F(DamagedBag, IsReadOrRefusedWithALineWhateverByteIsDamaged) {
  const auto file = Database("SELECT 1");
  const std::string whole = ReadFileWhole(file);
  for (std::size_t i = 0; i < whole.size(); i += 61) {
    std::ofstream(file, std::ios::binary) << Flipped(whole, i);
    const std::string message = MessageAbout(file);
    EXPECT_TRUE(message == "no error" || message.starts_with(file.string() + ": ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  for (std::size_t size = 0; size < whole.size(); size += 997) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, size);
    const std::string message = MessageAbout(file);
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << size << message;
  }
}

TEST_F(DamagedBag, IsRefusedIfItsMetadataAreNone) {
  const auto folder = Database("SELECT 1").parent_path();
  const std::string place = (folder / "metadata.yaml").string() + ": ";
  std::ofstream(folder / "metadata.yaml") << "other: 1\n";
  EXPECT_EQ(MessageAbout(folder), place + "must hold rosbag2_bagfile_information");
  std::ofstream(folder / "metadata.yaml")
      << "rosbag2_bagfile_information:\n  relative_file_paths:\n    - ../../gone.db3\n";
  EXPECT_EQ(MessageAbout(folder),
            place + "relative_file_paths: must name files of the folder (got \"../../gone.db3\")");
  std::ofstream(folder / "metadata.yaml") << "rosbag2_bagfile_information: [\n";
  EXPECT_TRUE(MessageAbout(folder).starts_with(place + "must be YAML as rosbag2 writes it"));
}

TEST_F(DamagedBag, IsRefusedIfAFileIsNeitherFormat) {
  const auto file = folder_.path() / "file.mcap";
  std::ofstream(file) << "text";
  EXPECT_EQ(MessageAbout(file),
            file.string() + ": must be an MCAP file or a database of rosbag2 (got neither)");
}

}  // namespace
}  // namespace railcast::bag
