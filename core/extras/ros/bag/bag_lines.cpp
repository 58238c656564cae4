#include "core/extras/ros/bag/bag_lines.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/findings.h"
#include "core/io/write_file.h"
#include "core/scenario/archive.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::string CommitHash(std::span<const std::uint64_t> messages) {
  return ContentHash({reinterpret_cast<const char*>(messages.data()), messages.size_bytes()});
}

fs::path DatabaseOf(const fs::path& bag) {
  return bag / (bag.filename().string() + "_0.db3");
}

/// All that a database says beside its messages, and that the ids of these count them.
constexpr std::array<const char*, 8> kTables = {
    "PRAGMA integrity_check(1)",
    "PRAGMA user_version",
    "SELECT quote(type) || quote(name) || quote(tbl_name) || quote(sql) FROM sqlite_master "
    "ORDER BY type, name",
    "SELECT quote(schema_version) || quote(ros_distro) FROM schema ORDER BY schema_version",
    "SELECT quote(id) || quote(metadata_version) || quote(metadata) FROM metadata ORDER BY id",
    "SELECT quote(id) || quote(name) || quote(type) || quote(serialization_format) || "
    "quote(offered_qos_profiles) || quote(type_description_hash) FROM topics ORDER BY id",
    "SELECT quote(id) || quote(topic_type) || quote(encoding) || "
    "quote(encoded_message_definition) || quote(type_description_hash) "
    "FROM message_definitions ORDER BY id",
    "SELECT quote(min(id)) || quote(max(id)) || quote(count(*)) FROM messages"};

std::string HashOfTables(const fs::path& file) {
  bag::SqliteDatabase database(file, bag::SqliteAccess::kRead, ShownPath(file));
  std::string all;
  for (const char* sql : kTables) {
    bag::SqliteStatement rows(database, sql);
    while (rows.Step()) all += rows.Text(0) + '\0';
  }
  return ContentHash(all);
}

void CompareTables(const fs::path& database, const std::string& hash, ErrorList& faults) {
  for (const fs::path& beside : bag::ChangesBeside(database)) {
    faults.Add({ShownPath(beside), "must be empty: the bag is complete without it", ""});
  }
  const std::string got = HashOfTables(database);
  if (got == hash) return;
  faults.Add({ShownPath(database),
              "must have tables of the hash " + ShownText(hash) + ", as " +
                  std::string(kBagLinesFile) + " says",
              got});
}

// The files of a bag that keep their bytes, by their names beside the file of lines.
std::vector<std::string> FixedFilesOf(const fs::path& bag) {
  if (!fs::is_directory(bag)) return {bag.filename().string()};
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(bag)) {
    if (IsOfDatabase(entry.path())) continue;
    names.push_back(entry.path().lexically_relative(bag.parent_path()).generic_string());
  }
  std::ranges::sort(names);
  return names;
}

void CompareFiles(const fs::path& bag, const BagLines& lines, ErrorList& faults) {
  for (const auto& [name, hash] : lines.files) {
    (void)CompareHash(bag.parent_path() / name, hash, std::string(kBagLinesFile), faults);
  }
  for (const std::string& name : FixedFilesOf(bag)) {
    if (lines.files.contains(name)) continue;
    faults.Add(
        {ShownPath(bag.parent_path() / name), "is not named in " + std::string(kBagLinesFile), ""});
  }
  if (!lines.tables.empty()) CompareTables(DatabaseOf(bag), lines.tables, faults);
}

/// Reads the lines of commits, one after another, up to the first that is incomplete or was
/// changed.
class CommitLines {
 public:
  struct Commit {
    std::size_t num_messages{};
    std::string hash;  ///< Hash of its messages.
  };

  explicit CommitLines(const fs::path& file) : file_(file) {
    if (fs::exists(file)) stream_ = OpenInput(file);
  }

  [[nodiscard]] std::optional<Commit> Next() {
    std::string line;
    const bool is_whole = read_.files.empty() && std::getline(stream_, line) && !stream_.eof() &&
                          LineHashFault(line).empty();
    if (!is_whole) return End();
    position_ += line.size() + 1;
    auto record = ReadRecordLine<BagLineRecord>(
        line, ShownPath(file_) + ":" + NumberText(read_.num_commits + 1));
    if (record.files.empty()) {
      ++read_.num_commits;
      return Commit{record.num_messages.value_or(0), std::move(record.hash)};
    }
    read_.files = std::move(record.files);
    read_.tables = std::move(record.tables);
    return End();
  }
  /// Where the last line ends in the file that was read.
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// What was read so far.
  [[nodiscard]] const BagLines& read() const { return read_; }

 private:
  std::optional<Commit> End() {
    stream_.close();
    return std::nullopt;
  }

  fs::path file_;
  std::ifstream stream_;
  std::uint64_t position_{};
  BagLines read_;
};

/// Compares messages, in the order in which they were written, with the lines of their commits.
class CommitCheck {
 public:
  explicit CommitCheck(const fs::path& lines) : lines_(lines) { NextCommit(); }

  void Take(std::uint64_t hash) {
    ++whole_.num_in_bag;
    if (!commit_ || whole_.has_others) return;
    messages_.push_back(hash);
    if (messages_.size() < commit_->num_messages) return;
    whole_.has_others = CommitHash(messages_) != commit_->hash;
    if (whole_.has_others) return;
    ++whole_.num;
    whole_.num_messages += commit_->num_messages;
    NextCommit();
  }
  [[nodiscard]] const WholeCommits& whole() const { return whole_; }

 private:
  void NextCommit() {
    messages_.clear();
    commit_ = lines_.Next();
    for (; commit_ && commit_->num_messages == 0; commit_ = lines_.Next()) ++whole_.num;
    whole_.num_in_next = commit_ ? commit_->num_messages : 0;
  }

  CommitLines lines_;
  std::optional<CommitLines::Commit> commit_;
  std::vector<std::uint64_t> messages_;  ///< Hashes of the commit so far.
  WholeCommits whole_;
};

}  // namespace

void Describe(Archive& a, BagLineRecord& s) {
  a.Optional("messages", s.num_messages, "Number of messages that the line commits.");
  a.Optional("xxh3", s.hash, "Hash of these messages.");
  a.Optional("files_xxh3", s.files, "Hashes of the bag's files; in the last line alone.");
  a.Optional("tables_xxh3", s.tables,
             "Hash of what a database holds beside its messages; in the last line alone.");
}

fs::path BagLinesFile(const fs::path& bag) {
  return bag.parent_path() / kBagLinesFile;
}

std::uint64_t TopicHash(const bag::BagTopic& topic) {
  std::string all;
  for (const std::string& part :
       {topic.name, topic.type, topic.definition, topic.hash, topic.encoding}) {
    all += part + '\0';
  }
  return ContentHashNumber(all + (topic.is_latched ? '1' : '0'));
}

std::uint64_t MessageHash(std::uint64_t topic_hash,
                          std::int64_t time_ns,
                          std::span<const std::byte> data) {
  const std::array<std::uint64_t, 3> parts = {
      topic_hash, static_cast<std::uint64_t>(time_ns),
      ContentHashNumber({reinterpret_cast<const char*>(data.data()), data.size()})};
  return ContentHashNumber({reinterpret_cast<const char*>(parts.data()), sizeof parts});
}

std::string CommitLine(std::span<const std::uint64_t> messages) {
  return HashedRecordLine(
      BagLineRecord{.num_messages = messages.size(), .hash = CommitHash(messages)});
}

std::string BagFilesLine(const fs::path& bag) {
  BagLineRecord line;
  for (const std::string& name : FixedFilesOf(bag)) {
    line.files[name] = HashFile(bag.parent_path() / name).hash;
  }
  if (fs::is_directory(bag)) line.tables = HashOfTables(DatabaseOf(bag));
  return HashedRecordLine(line);
}

bool IsOfDatabase(const fs::path& file) {
  const std::string database = DatabaseOf(file.parent_path()).filename().string();
  const std::string name = file.filename().string();
  return std::ranges::any_of(std::array{"", "-wal", "-shm", "-journal"},
                             [&](const char* suffix) { return name == database + suffix; });
}

BagLines ReadBagLines(const fs::path& file) {
  CommitLines lines(file);
  while (lines.Next()) {
  }
  return lines.read();
}

std::uint64_t EndOfCommits(const fs::path& file, std::size_t num) {
  CommitLines lines(file);
  for (std::size_t i = 0; i < num; ++i) Check(lines.Next().has_value(), "the commit has its line");
  return lines.position();
}

WholeCommits FindWholeCommits(const fs::path& lines, bag::BagReader& reader) {
  std::vector<std::uint64_t> topics;
  for (const bag::BagTopic& topic : reader.topics()) topics.push_back(TopicHash(topic));
  CommitCheck commits(lines);
  // They come in the order of their times, but were written in that of their places. The ids of a
  // database count its messages, so that the next is known.
  std::map<bag::BagPlace, std::uint64_t> waiting;
  bag::BagPlace next{.in_part = {.record = 1}};
  while (const auto message = reader.Next()) {
    waiting.emplace(message->place,
                    MessageHash(topics[message->topic], message->time_ns, message->data));
    for (; !waiting.empty() && waiting.begin()->first == next; ++next.in_part.record) {
      commits.Take(waiting.begin()->second);
      waiting.erase(waiting.begin());
    }
  }
  for (const auto& [place, hash] : waiting) commits.Take(hash);
  return commits.whole();
}

void CompareWithBagLines(const fs::path& bag, bool is_finished, ErrorList& faults) {
  const fs::path file = BagLinesFile(bag);
  if (!fs::exists(file)) return faults.Add({ShownPath(file), "missing", ""});
  const BagLines lines = ReadBagLines(file);
  if (is_finished && lines.files.empty()) {
    faults.Add({ShownPath(file),
                "must end with the hashes of the bag's files: the bag is unfinished or a line was "
                "changed",
                ""});
  }
  if (!lines.files.empty()) CompareFiles(bag, lines, faults);
  // The hash of a file stands for all that is in it.
  if (lines.files.contains(bag.filename().string())) return;
  const auto reader = bag::OpenBag(bag);
  const WholeCommits whole = FindWholeCommits(file, *reader);
  const std::string first = NumberText(whole.num_messages + 1);
  // What an interrupted bag lacks at its end is made anew.
  if (is_finished ? whole.num < lines.num_commits : whole.has_others) {
    faults.Add({ShownPath(bag),
                "must hold the messages " + first + " to " +
                    NumberText(whole.num_messages + whole.num_in_next) + " as " + ShownPath(file) +
                    ":" + NumberText(whole.num + 1) + " says",
                ""});
  } else if (is_finished && whole.num_messages < whole.num_in_bag) {
    faults.Add({ShownPath(bag),
                "must hold " + NumberText(whole.num_messages) + " messages, as " +
                    std::string(kBagLinesFile) + " says",
                NumberText(whole.num_in_bag)});
  }
}

}  // namespace railcast
