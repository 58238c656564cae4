#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/bag_metadata.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

constexpr const char* kStorage = "sqlite3";

// The tables of ROS 2 Jazzy, in the order in which it makes them.
constexpr std::array<const char*, 7> kBagTables = {
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL)",
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,"
    "metadata TEXT NOT NULL)",
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
    "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL,"
    "type_description_hash TEXT NOT NULL)",
    "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY,topic_type TEXT NOT NULL,"
    "encoding TEXT NOT NULL,encoded_message_definition TEXT NOT NULL,"
    "type_description_hash TEXT NOT NULL)",
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
    "timestamp INTEGER NOT NULL, data BLOB NOT NULL)",
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC)",
    "INSERT INTO schema (schema_version, ros_distro) VALUES (4, 'jazzy')"};

std::filesystem::path DatabaseIn(const std::filesystem::path& directory) {
  const auto plain = std::filesystem::absolute(directory / ".").lexically_normal().parent_path();
  return directory / (plain.filename().string() + "_0.db3");
}

class Rosbag2Writer : public BagWriter {
 public:
  explicit Rosbag2Writer(const std::filesystem::path& directory)
      : Rosbag2Writer(directory, SqliteAccess::kCreate) {
    InsertMetadata();
    CommitToFile();
  }

  Rosbag2Writer(const std::filesystem::path& directory, std::size_t max_commits)
      : Rosbag2Writer(directory, SqliteAccess::kChange) {
    SqliteStatement version(database_, "PRAGMA user_version");
    version.With().Step();
    const auto found = static_cast<std::size_t>(version.Integer(0));
    num_commits_ = std::min(found, max_commits);
    num_to_skip_ = found - num_commits_;
    ReadTopics();
  }

  std::size_t Add(const BagTopic& topic) override {
    const auto known = std::ranges::find(topics_, topic.name, &BagTopic::name);
    if (known != topics_.end()) return static_cast<std::size_t>(known - topics_.begin());
    SqliteStatement(database_,
                    "INSERT INTO topics (name, type, serialization_format, offered_qos_profiles, "
                    "type_description_hash) VALUES (?, ?, ?, ?, ?)")
        .With(std::string_view(topic.name), std::string_view(topic.type),
              std::string_view(topic.encoding),
              std::string_view(QosText(topic.is_latched, MetadataVersion::kJazzy)),
              std::string_view(topic.hash))
        .Step();
    const bool is_defined =
        std::ranges::find(topics_, topic.type, &BagTopic::type) != topics_.end();
    if (!is_defined) {
      SqliteStatement(database_,
                      "INSERT INTO message_definitions (topic_type, encoding, "
                      "encoded_message_definition, type_description_hash) VALUES (?, ?, ?, ?)")
          .With(std::string_view(topic.type), std::string_view("ros2msg"),
                std::string_view(topic.definition), std::string_view(topic.hash))
          .Step();
    }
    topics_.push_back(topic);
    return topics_.size() - 1;
  }

  void Write(const BagMessage& message) override {
    Check(message.topic < topics_.size(), "the topic of a message was added to its bag");
    has_messages_ = true;
    if (num_to_skip_ > 0) return;
    insert_.With(message.time_ns, static_cast<std::int64_t>(message.topic + 1), message.data)
        .Step();
  }

  void Attach(const std::string& name,
              const std::string& /*media_type*/,
              std::span<const std::byte> bytes) override {
    WriteFileWhole(directory_ / name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

  void Commit() override {
    if (!std::exchange(has_messages_, false)) return;
    ++num_commits_;
    if (num_to_skip_ > 0) {
      --num_to_skip_;
      return;
    }
    database_.Run("PRAGMA user_version = " + NumberText(num_commits_));
    CommitToFile();
  }

  void Close() override {
    Commit();
    InsertMetadata();
    database_.Run("COMMIT");
    WriteFileWhole(directory_ / kMetadataFile,
                   MetadataFileText(ReadMetadata(), MetadataVersion::kJazzy));
  }

  [[nodiscard]] std::size_t num_commits() const override { return num_commits_; }

 private:
  Rosbag2Writer(const std::filesystem::path& directory, SqliteAccess access)
      : directory_(directory),
        file_(DatabaseIn(directory)),
        database_(file_, access, ShownPath(file_)),
        insert_(BeginWriting(database_, access),
                "INSERT INTO messages (timestamp, topic_id, data) VALUES (?, ?, ?)") {}

  /// Begins a transaction, in a new database after making its tables.
  static SqliteDatabase& BeginWriting(SqliteDatabase& database, SqliteAccess access) {
    database.Run("PRAGMA synchronous = NORMAL");
    database.Run("BEGIN");
    if (access == SqliteAccess::kCreate) {
      for (const char* sql : kBagTables) database.Run(sql);
    }
    return database;
  }

  void CommitToFile() {
    database_.Run("COMMIT");
    database_.Run("BEGIN");
  }

  void ReadTopics() {
    SqliteStatement list(database_,
                         "SELECT name, type, serialization_format, offered_qos_profiles, "
                         "type_description_hash FROM topics ORDER BY id");
    while (list.Step()) {
      topics_.push_back({.name = list.Text(0),
                         .type = list.Text(1),
                         .definition = {},
                         .hash = list.Text(4),
                         .is_latched = IsLatchedQos(list.Text(3)),
                         .encoding = list.Text(2)});
    }
  }

  [[nodiscard]] BagMetadata ReadMetadata() {
    BagMetadata metadata{.storage = kStorage, .file = file_.filename().string(), .topics = {}};
    for (const BagTopic& topic : topics_) metadata.topics.push_back({topic, 0});
    SqliteStatement counts(database_, "SELECT topic_id, count(*) FROM messages GROUP BY topic_id");
    while (counts.Step()) {
      metadata.topics.at(static_cast<std::size_t>(counts.Integer(0)) - 1).num_messages =
          static_cast<std::uint64_t>(counts.Integer(1));
    }
    SqliteStatement times(database_,
                          "SELECT count(*), min(timestamp), max(timestamp) FROM messages");
    if (times.Step() && times.Integer(0) > 0) {
      metadata.start_ns = times.Integer(1);
      metadata.duration_ns = times.Integer(2) - times.Integer(1);
    }
    return metadata;
  }

  void InsertMetadata() {
    constexpr auto kVersion = MetadataVersion::kJazzy;
    const std::string text = MetadataText(ReadMetadata(), kVersion);
    // A database that was closed keeps its bytes if only files beside it are written anew.
    if (HasMetadata(text)) return;
    database_.Run("DELETE FROM metadata");
    SqliteStatement(database_, "INSERT INTO metadata (metadata_version, metadata) VALUES (?, ?)")
        .With(static_cast<std::int64_t>(kVersion), std::string_view(text))
        .Step();
  }

  [[nodiscard]] bool HasMetadata(const std::string& text) {
    SqliteStatement found(database_, "SELECT metadata FROM metadata");
    return found.Step() && found.Text(0) == text;
  }

  std::filesystem::path directory_;
  std::filesystem::path file_;
  SqliteDatabase database_;
  SqliteStatement insert_;
  std::vector<BagTopic> topics_;
  std::size_t num_commits_{};
  std::size_t num_to_skip_{};  ///< Commits that the database has already.
  bool has_messages_ = false;
};

}  // namespace

std::unique_ptr<BagWriter> CreateRosbag2(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw FileError(directory, error.value());
  if (!std::filesystem::is_empty(directory, error) || error) {
    throw InputError(ShownPath(directory) + ": must be empty or not exist");
  }
  return std::make_unique<Rosbag2Writer>(directory);
}

std::unique_ptr<BagWriter> ContinueRosbag2(const std::filesystem::path& directory,
                                           std::size_t max_commits) {
  if (exists(directory / kMetadataFile)) {
    throw InputError(ShownPath(directory) + ": must be unfinished (got " +
                     std::string(kMetadataFile) + ")");
  }
  return std::make_unique<Rosbag2Writer>(directory, max_commits);
}

}  // namespace railcast::bag
