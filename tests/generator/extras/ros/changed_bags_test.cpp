// Bags of runs, of which something was changed since they were written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/io/write_file.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/generator/sequence/sequence_runs.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class ChangedBags : public SequenceRuns {
 protected:
  ChangedBags() : SequenceRuns(4) {}

  // Does something to the first message of a topic, which :id names.
  static void ChangeDatabase(const fs::path& bag, const std::string& topic, std::string sql) {
    const std::string id =
        "(SELECT min(messages.id) FROM messages JOIN topics ON topics.id = topic_id WHERE name = "
        "'" +
        topic + "')";
    sql.replace(sql.find(":id"), 3, id);
    bag::SqliteDatabase(bag / "rosbag2_0.db3", bag::SqliteAccess::kChange, "bag").Run(sql);
  }
  // Writes an MCAP file anew without the first message of a topic.
  static void LeaveOut(const fs::path& file, const fs::path& copy, const std::string& topic) {
    const auto reader = bag::OpenBag(file);
    const auto writer = bag::CreateMcap(copy);
    for (const bag::BagTopic& each : reader->topics()) writer->Add(each);
    for (const bag::BagAttachment& each : reader->ReadAttachments()) {
      writer->Attach(each.name, each.media_type, each.bytes);
    }
    bool is_left_out = false;
    while (const auto message = reader->Next()) {
      if (!is_left_out && reader->topics()[message->topic].name == topic) {
        is_left_out = true;
      } else {
        writer->Write(*message);
      }
    }
    writer->Close();
  }
  void Restore(const fs::path& out, const fs::path& whole) const {
    fs::copy(whole, out, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }

  const std::vector<std::string> topics_ = {"/beams/points", "/clock",     "/objects", "/odometry",
                                            "/tf",           "/tf_static", "/track"};
};

TEST_F(ChangedBags, OfRosbag2AreFaultsWhicheverMessageWasChanged) {
  const fs::path whole = Make("whole", "--format rosbag2 " + frames_);
  for (const std::string& topic : topics_) {
    for (const char* sql :
         {"DELETE FROM messages WHERE id = :id",
          "UPDATE messages SET timestamp = timestamp + 1 WHERE id = :id",
          "UPDATE messages SET data = CAST(data || x'00' AS BLOB) WHERE id = :id",
          "INSERT INTO messages (topic_id, timestamp, data) SELECT topic_id, timestamp, data "
          "FROM messages WHERE id = :id"}) {
      Restore(Out("bag"), whole);
      ChangeDatabase(Out("bag") / "rosbag2", topic, sql);
      EXPECT_THAT(FaultsOf(Out("bag")), testing::Not(testing::IsEmpty())) << topic << sql;
    }
  }
}

TEST_F(ChangedBags, OfRosbag2AreFaultsWhicheverFileBesideTheDatabaseWasChanged) {
  const fs::path out = Make("bag", "--format rosbag2 " + frames_);
  for (const std::string name :
       {"metadata.yaml", "scenario.resolved.json", "labels.json", "manifest.json"}) {
    const fs::path file = out / "rosbag2" / name;
    const std::string text = ReadFileWhole(file);
    WriteFileWhole(file, text + " ");
    EXPECT_THAT(FaultsOf(out), ElementsAre(HasSubstr(file.string() + ": must have the hash ")));
    WriteFileWhole(file, text);
  }
  WriteFileWhole(out / "rosbag2/notes", "");
  EXPECT_THAT(FaultsOf(out),
              ElementsAre((out / "rosbag2/notes").string() + ": is not named in bag.jsonl"));
}

// What the hashes of messages do not tell.
TEST_F(ChangedBags, OfRosbag2AreFaultsWhateverWasChangedBesideTheMessages) {
  const fs::path whole = Make("whole", "--format rosbag2 " + frames_);
  const fs::path out = Out("bag");
  const fs::path database = out / "rosbag2/rosbag2_0.db3";
  for (const char* sql :
       {"UPDATE topics SET offered_qos_profiles = replace(offered_qos_profiles, 'reliable', "
        "'best_effort') WHERE id = 1",
        "UPDATE topics SET offered_qos_profiles = '' WHERE id = 2",
        "INSERT INTO topics (name, type, serialization_format, offered_qos_profiles, "
        "type_description_hash) VALUES ('/a', 'b', 'cdr', '', '')",
        "UPDATE message_definitions SET type_description_hash = '' WHERE id = 1",
        "UPDATE message_definitions SET encoding = 'ros2idl' WHERE id = 3",
        "UPDATE metadata SET metadata = metadata || ' '", "DELETE FROM metadata",
        "UPDATE schema SET ros_distro = 'iron'", "UPDATE schema SET schema_version = 3",
        "CREATE TABLE more(id INTEGER)", "DROP INDEX timestamp_idx", "PRAGMA user_version = 3",
        "UPDATE messages SET id = id + 1000"}) {
    Restore(out, whole);
    bag::SqliteDatabase(database, bag::SqliteAccess::kChange, "bag").Run(sql);
    EXPECT_THAT(FaultsOf(out),
                testing::Contains(HasSubstr(database.string() + ": must have tables of the hash ")))
        << sql;
  }
  Restore(out, whole);
  WriteFileWhole(database.string() + "-wal", "x");
  EXPECT_THAT(
      FaultsOf(out),
      testing::Contains(database.string() + "-wal: must be empty: the bag is complete without it"));
  fs::remove(database.string() + "-wal");
  WriteFileWhole(database.string() + ".bak", "x");
  EXPECT_THAT(FaultsOf(out), ElementsAre(database.string() + ".bak: is not named in bag.jsonl"));
}

TEST_F(ChangedBags, OfRosbag2GetTheirBytesBackWhicheverFileWasRemoved) {
  const std::string options = "--format rosbag2 " + frames_;
  const fs::path out = Make("bag", options);
  const std::vector<std::string> names = {
      "rosbag2/rosbag2_0.db3", "rosbag2/metadata.yaml", "rosbag2/scenario.resolved.json",
      "rosbag2/labels.json",   "rosbag2/manifest.json", "bag.jsonl",
      "manifest.json"};
  std::vector<std::string> whole;
  for (const std::string& name : names) whole.push_back(ReadFileWhole(out / name));
  for (const std::string& removed : names) {
    fs::remove(out / removed);
    (void)Make("bag", options);
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_TRUE(ReadFileWhole(out / names[i]) == whole[i]) << removed << ": " << names[i];
    }
  }
}

TEST_F(ChangedBags, OfMcapAreFaultsWhicheverMessageIsMissing) {
  const fs::path out = Make("bag", "--format mcap " + frames_);
  const fs::path bag = out / "frames.mcap";
  const fs::path whole = Out("whole.mcap");
  fs::copy_file(bag, whole);
  for (const std::string& topic : topics_) {
    LeaveOut(whole, bag, topic);
    EXPECT_THAT(FaultsOf(out), testing::Contains(HasSubstr(bag.string() + ": must have the hash ")))
        << topic;
  }
}

TEST_F(ChangedBags, ThatAreCutAreFaultsOfOldAndNewRuns) {
  const fs::path out = Make("bag", "--format mcap " + frames_);
  const fs::path old = Out("old");
  fs::copy(fs::path(RAILCAST_SOURCE_DIR) / "tests/releases/0.2.0/mcap", old,
           fs::copy_options::recursive);
  EXPECT_THAT(FaultsOf(old), ElementsAre());
  for (const fs::path& run : {out, old}) {
    const fs::path bag = run / "frames.mcap";
    fs::resize_file(bag, fs::file_size(bag) - 8);
    EXPECT_THAT(FaultsOf(run),
                testing::Contains(bag.string() +
                                  ": must have the end of an MCAP file: it is unfinished or cut"));
  }
}

TEST_F(ChangedBags, AreNotGoneOnWithButBegunAnew) {
  for (const std::string format : {"mcap", "rosbag2"}) {
    const std::string options = "--format " + format + " " + frames_;
    const std::string lines = ReadFileWhole(Make("whole_" + format, options) / "bag.jsonl");
    MakeFirst(format, format, 3);
    const fs::path bag = Out(format) / (format == "mcap" ? "frames.mcap" : "rosbag2");
    if (format == "mcap") {
      const fs::path unfinished = bag.string() + ".part";
      LeaveOut(unfinished, Out("changed.mcap"), "/odometry");
      fs::rename(Out("changed.mcap"), unfinished);
    } else {
      ChangeDatabase(bag, "/odometry", "DELETE FROM messages WHERE id = :id");
    }
    (void)Make(format, options);
    EXPECT_THAT(FaultsOf(Out(format)), ElementsAre());
    EXPECT_EQ(ReadFileWhole(Out(format) / "bag.jsonl"), lines);
  }
}

// What was deleted last is not made anew by a database, which cannot be cut.
TEST_F(ChangedBags, AreBegunAnewWithoutTheirLastMessage) {
  MakeFirst("bag", "rosbag2", 3);
  bag::SqliteDatabase(Out("bag") / "rosbag2/rosbag2_0.db3", bag::SqliteAccess::kChange, "bag")
      .Run("DELETE FROM messages WHERE id = (SELECT max(id) FROM messages)");
  EXPECT_THAT(FaultsOf(Make("bag", "--format rosbag2 " + frames_)), ElementsAre());
}

TEST_F(ChangedBags, ThatWereCompleteAreMadeAnew) {
  for (const std::string format : {"mcap", "rosbag2"}) {
    const std::string options = "--format " + format + " " + frames_;
    const fs::path out = Make(format, options);
    const std::string lines = ReadFileWhole(out / "bag.jsonl");
    if (format == "mcap") {
      fs::copy_file(out / "frames.mcap", Out("whole.mcap"));
      LeaveOut(Out("whole.mcap"), out / "frames.mcap", "/track");
    } else {
      ChangeDatabase(out / "rosbag2", "/track", "DELETE FROM messages WHERE id = :id");
    }
    EXPECT_THAT(Run(options + " --out " + out.string()),
                HasSubstr("was complete, but not as it was written; made anew:\n"));
    EXPECT_THAT(FaultsOf(out), ElementsAre());
    EXPECT_EQ(ReadFileWhole(out / "bag.jsonl"), lines);
  }
}

TEST_F(ChangedBags, KeepWhatOthersHavePutBesideThem) {
  const std::string options = "--format rosbag2 " + frames_;
  const fs::path out = Make("bag", options);
  WriteFileWhole(out / "rosbag2/notes.txt", "mine");
  const auto before = ReadFileWhole(out / "manifest.json");
  EXPECT_THAT(Run(options + " --out " + out.string(), 1),
              HasSubstr(": holds a file that does not belong to this run (rosbag2/notes.txt)"));
  EXPECT_EQ(ReadFileWhole(out / "rosbag2/notes.txt"), "mine");
  EXPECT_EQ(ReadFileWhole(out / "manifest.json"), before);
}

// A run may end between the end of its bag and the hashes of that. Then nothing says that its files
// are as they were written.
TEST_F(ChangedBags, AreMadeAgainWithoutTheHashesOfTheirFiles) {
  for (const std::string format : {"mcap", "rosbag2"}) {
    const std::string options = "--format " + format + " " + frames_;
    const fs::path out = Make(format, options);
    const std::string lines = ReadFileWhole(out / "bag.jsonl");
    // Once, for each frame, for the end of the last one, and the hashes.
    EXPECT_EQ(std::ranges::count(lines, '\n'), 1 + 4 + 1 + 1);
    WriteFileWhole(out / "bag.jsonl", lines.substr(0, lines.rfind("{\"files_xxh3") + 20));
    EXPECT_THAT(FaultsOf(out),
                ElementsAre((out / "bag.jsonl").string() +
                            ": must end with the hashes of the bag's files: the bag is unfinished "
                            "or a line was changed"));
    EXPECT_THAT(Run(options + " --out " + out.string()), HasSubstr(" was changed"));
    EXPECT_EQ(ReadFileWhole(out / "bag.jsonl"), lines);
    EXPECT_THAT(FaultsOf(out), ElementsAre());
    fs::remove(out / "bag.jsonl");
    EXPECT_THAT(FaultsOf(out), ElementsAre((out / "bag.jsonl").string() + ": missing"));
  }
}

}  // namespace
}  // namespace railcast
