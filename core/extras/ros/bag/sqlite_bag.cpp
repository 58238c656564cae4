#include "core/extras/ros/bag/bag.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/bag_metadata.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/extras/ros/bag/temporary_copy.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

void CopyFileTo(const std::filesystem::path& file, const std::filesystem::path& copy) {
  CheckIsOwnFile(copy);
  std::error_code error;
  std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw FileError(copy, error.value());
}

/// A database is opened when its first message is replaced: until then the copy is the file.
class SqliteCopy : public BagCopy {
 public:
  SqliteCopy(const std::filesystem::path& file, const std::filesystem::path& copy)
      : copy_(copy), unfinished_(copy_.string() + std::string(kUnfinishedSuffix)) {
    CheckIsReadable(file);
    CheckIsOwnFile(copy_);
    CopyFileTo(file, unfinished_);
    for (const std::filesystem::path& beside : ChangesBeside(file)) {
      const std::string suffix = beside.string().substr(file.string().size());
      CopyFileTo(beside, unfinished_.string() + suffix);
      suffixes_.push_back(suffix);
    }
  }

  void Put(const BagPlace& place, std::optional<std::span<const std::byte>> data) override {
    if (!data) return;
    if (!database_) {
      database_.emplace(unfinished_, SqliteAccess::kChange, ShownPath(copy_));
      // A copy that was interrupted is made anew.
      database_->Run("PRAGMA synchronous = OFF; BEGIN");
      replace_.emplace(*database_, "UPDATE messages SET data = ? WHERE id = ?");
    }
    replace_->With(*data, static_cast<std::int64_t>(place.in_part.record)).Step();
  }

  void Finish() override {
    if (database_) {
      replace_.reset();
      database_->Run("COMMIT; PRAGMA synchronous = FULL");
      database_.reset();
    }
    Rename(unfinished_, copy_);
    // What stood beside the database was taken in if it was opened.
    for (const std::string& suffix : suffixes_) {
      if (std::filesystem::exists(unfinished_.string() + suffix)) {
        Rename(unfinished_.string() + suffix, copy_.string() + suffix);
      }
    }
  }

 private:
  static void Rename(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (error) throw FileError(to, error.value());
  }

  std::filesystem::path copy_;
  std::filesystem::path unfinished_;
  std::vector<std::string> suffixes_;  ///< Suffixes of the files beside it.
  std::optional<SqliteDatabase> database_;
  std::optional<SqliteStatement> replace_;
};

/// Throws unless the database has a table of this name: a view or a virtual table could run code.
void NeedTable(SqliteDatabase& database, const std::string& name) {
  SqliteStatement find(database, "SELECT sql FROM sqlite_master WHERE type = 'table' AND name = ?");
  if (find.With(std::string_view(name)).Step() && !find.Text(0).starts_with("CREATE VIRTUAL")) {
    return;
  }
  throw InputError(database.name() + ": must have the table " + name + ", as rosbag2 makes it");
}

/// Throws if two rows have one id: what belongs to which would not be known.
void NeedOwnIds(SqliteDatabase& database, const std::string& table) {
  SqliteStatement key(database, "SELECT pk FROM pragma_table_info(?) WHERE name = 'id'");
  if (key.With(std::string_view(table)).Step() && key.Integer(0) == 1) return;
  SqliteStatement find(database,
                       "SELECT id FROM " + table + " GROUP BY id HAVING count(*) > 1 LIMIT 1");
  if (!find.Step()) return;
  throw InputError(database.name() + ": " + table + ": id: must be that of one row" +
                   Got(find.Integer(0)));
}

std::set<std::string> ColumnsOf(SqliteDatabase& database, const std::string& table) {
  std::set<std::string> columns;
  SqliteStatement list(database, "SELECT name FROM pragma_table_info(?)");
  list.With(std::string_view(table));
  while (list.Step()) columns.insert(list.Text(0));
  return columns;
}

/// Returns the texts of the types that the database defines.
std::map<std::string, std::string> ReadDefinitions(SqliteDatabase& database) {
  std::map<std::string, std::string> definitions;
  if (ColumnsOf(database, "message_definitions").empty()) return definitions;
  NeedTable(database, "message_definitions");
  SqliteStatement list(database,
                       "SELECT topic_type, encoded_message_definition FROM message_definitions "
                       "WHERE encoding = 'ros2msg'");
  while (list.Step()) definitions.emplace(list.Text(0), list.Text(1));
  return definitions;
}

class SqliteBagReader : public BagReader {
 public:
  SqliteBagReader(std::unique_ptr<SqliteDatabase> database, std::vector<Remark> remarks)
      : database_(std::move(database)), remarks_(std::move(remarks)) {
    NeedTable(*database_, "topics");
    NeedTable(*database_, "messages");
    NeedOwnIds(*database_, "topics");
    NeedOwnIds(*database_, "messages");
    ReadTopics();
    Query();
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_.topics(); }

  [[nodiscard]] std::optional<std::int64_t> FindStart_ns() override {
    SqliteStatement first(*database_, "SELECT timestamp FROM messages ORDER BY timestamp LIMIT 1");
    return first.Step() ? std::optional(first.Integer(0)) : std::nullopt;
  }

  void Select(const std::vector<std::size_t>& wanted) override {
    wanted_.emplace(wanted.begin(), wanted.end());
    Query();
  }

  [[nodiscard]] std::optional<BagMessage> Next() override {
    while (!is_at_end_ && list_->Step()) {
      const auto topic = topic_by_id_.find(list_->Integer(1));
      // Also where other topics are wanted: it may be a message of one of these.
      if (topic == topic_by_id_.end()) {
        Refuse("topic_id: must be that of a topic" + Got(list_->Integer(1)));
      }
      if (!wanted_ || wanted_->contains(topic->second)) return ReadMessage(topic->second);
    }
    is_at_end_ = true;
    return std::nullopt;
  }

  [[nodiscard]] std::vector<BagAttachment> ReadAttachments() override { return {}; }
  [[nodiscard]] std::vector<Remark> remarks() const override { return remarks_; }

 private:
  [[noreturn]] void Refuse(const std::string& rule) const {
    throw InputError(database_->name() + ": message " + NumberText(list_->Integer(0)) + ": " +
                     rule);
  }

  // Reads the message of the list's row.
  [[nodiscard]] BagMessage ReadMessage(std::size_t topic) {
    const std::int64_t id = list_->Integer(0);
    if (list_->Integer(3) == 0 || list_->Integer(2) < 0) {
      Refuse("timestamp: must be a whole number from 0 on (got " + ShownText(list_->Text(2)) + ")");
    }
    // Looked up one by one, so that sorting by time need not hold the data.
    if (!data_->With(id).Step() || !data_->IsBlob(0)) Refuse("data: must be a blob");
    return {topic,
            list_->Integer(2),
            data_->Blob(0),
            {.in_part = {.record = static_cast<std::uint64_t>(id)}},
            static_cast<std::uint64_t>(list_->Integer(1))};
  }

  void ReadTopics() {
    const auto definitions = ReadDefinitions(*database_);
    const auto columns = ColumnsOf(*database_, "topics");
    const auto or_empty = [&](const std::string& column) {
      return columns.contains(column) ? column : "''";
    };
    SqliteStatement list(*database_, "SELECT id, name, type, " + or_empty("serialization_format") +
                                         ", " + or_empty("offered_qos_profiles") + ", " +
                                         or_empty("type_description_hash") +
                                         " FROM topics ORDER BY id");
    while (list.Step()) {
      BagTopic topic{.name = list.Text(1),
                     .type = {},
                     .definition = {},
                     .hash = list.Text(5),
                     .is_latched = IsLatchedQos(list.Text(4))};
      if (const std::string encoding = list.Text(3); !encoding.empty()) topic.encoding = encoding;
      topic.type = FullTypeName(list.Text(2), topic.encoding);
      const auto definition = definitions.find(list.Text(2));
      if (definition != definitions.end()) topic.definition = definition->second;
      topic_by_id_.emplace(list.Integer(0), topics_.Add(topic));
    }
  }

  void Query() {
    list_.emplace(*database_,
                  "SELECT id, topic_id, timestamp, typeof(timestamp) = 'integer' FROM messages "
                  "ORDER BY timestamp, id");
    data_.emplace(*database_, "SELECT data FROM messages WHERE id = ?");
    is_at_end_ = false;
  }

  std::unique_ptr<SqliteDatabase> database_;
  std::vector<Remark> remarks_;
  TopicList topics_;
  std::map<std::int64_t, std::size_t> topic_by_id_;
  std::optional<std::set<std::size_t>> wanted_;  ///< Topics; absent = all.
  std::optional<SqliteStatement> list_;
  std::optional<SqliteStatement> data_;
  bool is_at_end_ = false;
};

/// Throws if the end of a database is missing, by the number of pages that its header states
/// (https://www.sqlite.org/fileformat2.html, 1.3). SQLite would only call it malformed.
void CheckIsWhole(const std::filesystem::path& file, const std::string& name) {
  std::array<unsigned char, 100> header{};
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(header.data()), header.size());
  const auto number_at = [&](std::size_t place) {
    std::uint64_t number = 0;
    for (std::size_t i = place; i < place + 4; ++i) number = number << 8U | header.at(i);
    return number;
  };
  if (number_at(24) != number_at(92)) return;  // The number was not kept.
  const std::uint64_t stated = number_at(16) >> 16U;
  const std::uint64_t size = number_at(28) * (stated == 1 ? 65536 : stated);
  const std::uint64_t got = std::filesystem::file_size(file);
  if (got >= size) return;
  throw InputError(name + ": must have its end, " + NumberText(size) + " bytes" + Got(got) +
                   ": sqlite3 " + ShownPath(file.filename()) +
                   " .recover makes a database of what is there");
}

/// Opens a copy of the files, in which SQLite finishes what the recorder had begun.
std::unique_ptr<SqliteDatabase> OpenCopy(const std::filesystem::path& file,
                                         const std::string& name,
                                         const std::vector<std::filesystem::path>& changes) {
  const TemporaryCopy copy;
  copy.Add(file);
  for (const std::filesystem::path& beside : changes) copy.Add(beside);
  const std::filesystem::path copied = copy.folder() / file.filename();
  SqliteDatabase(copied, SqliteAccess::kChange, name).Run("PRAGMA journal_mode = DELETE");
  return std::make_unique<SqliteDatabase>(copied, SqliteAccess::kRead, name);
}

}  // namespace

std::vector<std::filesystem::path> ChangesBeside(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> changes;
  for (const char* suffix : {"-wal", "-journal"}) {
    const std::filesystem::path beside = file.string() + suffix;
    std::error_code error;
    if (std::filesystem::file_size(beside, error) > 0 && !error) changes.push_back(beside);
  }
  return changes;
}

std::unique_ptr<BagReader> OpenSqliteBag(const std::filesystem::path& file,
                                         const std::string& name) {
  CheckIsReadable(file);
  const auto changes = ChangesBeside(file);
  std::vector<Remark> remarks;
  for (const std::filesystem::path& beside : changes) {
    if (!beside.native().ends_with("-journal")) continue;
    remarks.push_back({.kind = RemarkKind::kRecordingCut,
                       .place = name,
                       .detail = "what its recorder had not committed is undone by " +
                                 ShownPath(beside.filename())});
  }
  if (changes.empty()) CheckIsWhole(file, name);
  auto database = changes.empty()
                      ? std::make_unique<SqliteDatabase>(file, SqliteAccess::kRead, name)
                      : OpenCopy(file, name, changes);
  return std::make_unique<SqliteBagReader>(std::move(database), std::move(remarks));
}

std::unique_ptr<BagCopy> CopySqliteBag(const std::filesystem::path& file,
                                       const std::filesystem::path& copy) {
  return std::make_unique<SqliteCopy>(file, copy);
}

}  // namespace railcast::bag
