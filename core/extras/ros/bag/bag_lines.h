#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/extras/ros/bag/bag.h"

namespace railcast {

class Archive;

// bag.jsonl stands beside a run's bag and says what the bag holds: a line for each of its commits,
// and, once it is complete, a last one with the hashes of its files. A line is written before its
// commit, so that an interrupted bag never holds one that no line tells of.

/// The file of these lines of a bag, complete or not.
[[nodiscard]] std::filesystem::path BagLinesFile(const std::filesystem::path& bag);

/// Hash of all that a bag says of a topic.
[[nodiscard]] std::uint64_t TopicHash(const bag::BagTopic& topic);
/// Hash of a message: of its topic, time and data.
[[nodiscard]] std::uint64_t MessageHash(std::uint64_t topic_hash,
                                        std::int64_t time_ns,
                                        std::span<const std::byte> data);
/// The line of a commit, with its end.
[[nodiscard]] std::string CommitLine(std::span<const std::uint64_t> messages);
/// The last line: the hashes of a complete bag's files. That of a database is not among them, since
/// its bytes change when it is opened; the hashes of its messages and of its tables stand for it.
[[nodiscard]] std::string BagFilesLine(const std::filesystem::path& bag);

/// Whether a file of a rosbag2 directory is its database, or what SQLite may leave beside that.
[[nodiscard]] bool IsOfDatabase(const std::filesystem::path& file);

/// A line: of a commit, or the last one.
struct BagLineRecord {
  std::optional<std::size_t> num_messages{};
  std::string hash{};  ///< Hash of these messages.
  std::map<std::string, std::string> files{};
  std::string tables{};  ///< Hash of what a database holds beside its messages.
};
void Describe(Archive& a, BagLineRecord& s);

/// What the lines say that are no commit's.
struct BagLines {
  std::size_t num_commits{};                   ///< Lines of commits.
  std::map<std::string, std::string> files{};  ///< Hashes by name; none while it is unfinished.
  std::string tables{};  ///< Hash for a database; empty in bags of earlier releases.
};

/// Reads the lines up to the first that is incomplete or was changed; none without a file.
/// @throws InputError if the file cannot be read.
[[nodiscard]] BagLines ReadBagLines(const std::filesystem::path& file);
/// Where the line of the last of these commits ends in the file.
/// @pre There are as many.
[[nodiscard]] std::uint64_t EndOfCommits(const std::filesystem::path& file, std::size_t num);

/// How many of the first commits have the messages that the lines say.
struct WholeCommits {
  std::size_t num{};
  std::size_t num_messages{};
  bool has_others{};          ///< Whether others stand in place of the next commit's.
  std::size_t num_in_next{};  ///< Messages that the next commit's line says; 0 if there is none.
  std::size_t num_in_bag{};   ///< All messages of the bag.
};
/// Neither lines nor messages are kept, but those of an MCAP file, whose index is, too.
/// @throws InputError as ReadBagLines() and BagReader do.
[[nodiscard]] WholeCommits FindWholeCommits(const std::filesystem::path& lines,
                                            bag::BagReader& reader);

/// Compares a bag with its lines.
/// @param is_finished Whether the bag must be complete.
/// @param faults Gets a line for each file that differs, and one for the first messages that do.
/// @throws InputError if the bag or the lines cannot be read.
void CompareWithBagLines(const std::filesystem::path& bag, bool is_finished, ErrorList& faults);

}  // namespace railcast
