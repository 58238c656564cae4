#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/extras/ros/mcap/compression.h"
#include "core/extras/ros/mcap/mcap_records.h"
#include "railcast/remark.h"

namespace railcast::bag {

/// A topic of a bag: a name under which messages of one type are recorded.
struct BagTopic {
  std::string name;        ///< "/lidar/points"
  std::string type;        ///< "sensor_msgs/msg/PointCloud2"; as read, by FullTypeName().
  std::string definition;  ///< The type's ros2msg text; empty where the bag has none.
  std::string hash;        ///< "RIHS01_..." (REP 2016); empty where the bag has none.
  /// Whether late subscribers get the last message, too (transient local, as /tf_static).
  bool is_latched = false;
  std::string encoding = "cdr";  ///< How its messages are serialized.

  bool operator==(const BagTopic&) const = default;
};

/// The topics of a bag: those of one name, type and encoding are one, whatever their publishers'
/// hashes and promises.
class TopicList {
 public:
  /// Returns the index of a topic. It is appended if there is none like it.
  std::size_t Add(const BagTopic& topic);
  [[nodiscard]] const std::vector<BagTopic>& topics() const { return topics_; }

 private:
  std::vector<BagTopic> topics_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> indices_;
};

/// Where a message stands in a bag.
struct BagPlace {
  std::size_t part{};            ///< Index of its file among the bag's files.
  mcap::MessagePlace in_part{};  ///< In a database: the message's id in place of the record.

  auto operator<=>(const BagPlace&) const = default;
};

/// A serialized message, with the header of its encoding.
struct BagMessage {
  std::size_t topic{};  ///< Index of its topic.
  std::int64_t time_ns{};
  std::span<const std::byte> data;
  BagPlace place{};  ///< For messages that were read.
  /// For messages that were read: the id that the file has for the topic; several publishers may
  /// have one each.
  std::uint64_t channel{};
};

/// A file inside a bag.
struct BagAttachment {
  std::string name;
  std::string media_type;
  std::vector<std::byte> bytes;
};

/// The name of a type of ROS 2: some recorders write "sensor_msgs/PointCloud2", as ROS 1 does, for
/// "sensor_msgs/msg/PointCloud2".
/// @param encoding Of its messages: names stay as they are unless it is "cdr".
[[nodiscard]] std::string FullTypeName(std::string type, std::string_view encoding);

/// Writes a bag. The same calls give the same bytes.
///
/// What is written counts once it is committed. An interrupted program leaves a bag that holds
/// exactly the commits that were complete, and that ContinueMcap() and ContinueRosbag2() go on
/// with.
///
/// All functions throw InputError if the system refuses, as on a full disk. The bag can be
/// continued nevertheless, by another writer.
class BagWriter {
 public:
  virtual ~BagWriter() = default;

  /// Adds a topic and returns its index, counted from 0. A topic that the bag has already, of the
  /// same name, is not added again: a continued bag is given the topics of the first run.
  virtual std::size_t Add(const BagTopic& topic) = 0;
  /// Adds a message to the commit that is being made.
  /// @pre Its topic was added.
  virtual void Write(const BagMessage& message) = 0;
  /// Adds a file, at once. MCAP holds it inside, rosbag2 in its directory.
  /// @param name The name of a file, without a folder.
  virtual void Attach(const std::string& name,
                      const std::string& media_type,
                      std::span<const std::byte> bytes) = 0;
  /// Makes safe what was written since the last commit; nothing if that is no message.
  virtual void Commit() = 0;
  /// Commits the rest and completes the bag. Without it the bag stays unfinished.
  virtual void Close() = 0;
  /// Number of commits that the bag holds.
  [[nodiscard]] virtual std::size_t num_commits() const = 0;
};

using mcap::McapCompression;

/// What an MCAP file says of itself that is no bag of ROS 2 but a trace: its messages are
/// serialized by protobuf, and the definition of a topic is a FileDescriptorSet.
struct McapTrace {
  std::string name;  ///< Name of its record of metadata.
  std::map<std::string, std::string> metadata;
  std::map<std::string, std::string> channel_metadata;  ///< Metadata of each channel.
};

/// Creates an MCAP file, with a chunk for each commit. It is named `file` + kUnfinishedSuffix until
/// it is closed.
/// @param trace Absent: the file has the profile ros2.
/// @throws InputError if the file cannot be created, or as CheckIsOwnFile() does.
[[nodiscard]] std::unique_ptr<BagWriter> CreateMcap(
    const std::filesystem::path& file,
    McapCompression compression = McapCompression::kZstd,
    const std::optional<McapTrace>& trace = std::nullopt);

/// Goes on with a file that CreateMcap() began and nobody closed, after its last complete commit.
/// What follows that is dropped, so that the bytes become those of an uninterrupted run.
/// Attachments made before that commit are kept. Without a complete commit the file begins anew.
/// @param max_commits Commits beyond these are dropped, too.
/// @throws InputError "file: rule" if the file is no unfinished MCAP file of ours.
[[nodiscard]] std::unique_ptr<BagWriter> ContinueMcap(
    const std::filesystem::path& file,
    McapCompression compression,
    std::size_t max_commits,
    const std::optional<McapTrace>& trace = std::nullopt);

/// Creates a rosbag2 directory `directory`, as ROS 2 Jazzy makes it: NAME_0.db3 (SQLite) and, once
/// closed, metadata.yaml. NAME is the directory's.
/// @throws InputError if the directory exists and is not empty, or cannot be created.
[[nodiscard]] std::unique_ptr<BagWriter> CreateRosbag2(const std::filesystem::path& directory);

/// As ContinueMcap(), for a directory that CreateRosbag2() began. The writer skips the messages of
/// commits that the database has already beyond `max_commits`; hence they must be those of the
/// interrupted run.
[[nodiscard]] std::unique_ptr<BagWriter> ContinueRosbag2(const std::filesystem::path& directory,
                                                         std::size_t max_commits);

/// Reads the messages of a bag in the order of their times; those of equal time in the order of
/// the file. It takes as much memory as the chunks that overlap at one time.
class BagReader {
 public:
  virtual ~BagReader() = default;

  [[nodiscard]] virtual const std::vector<BagTopic>& topics() const = 0;
  /// Returns the time of the first message of all topics; nothing if there is none.
  [[nodiscard]] virtual std::optional<std::int64_t> FindStart_ns() = 0;
  /// Restricts Next() to some topics, given by their indices, and begins anew.
  virtual void Select(const std::vector<std::size_t>& wanted) = 0;
  /// Returns the next message, valid until the next call, or nothing at the end.
  /// @throws InputError "file: place: reason" where the bag is damaged.
  [[nodiscard]] virtual std::optional<BagMessage> Next() = 0;
  /// The files inside the bag; none unless it is MCAP.
  /// @throws InputError as Next() does.
  [[nodiscard]] virtual std::vector<BagAttachment> ReadAttachments() = 0;
  /// What is missing of the bag as a whole.
  [[nodiscard]] virtual std::vector<Remark> remarks() const { return {}; }
};

/// Opens a bag: an MCAP file, a database of rosbag2 (.db3), either of them compressed by zstd, or
/// a rosbag2 directory, with or without metadata.yaml. Files are known by their content. An
/// interrupted MCAP file is read up to its last complete chunk or record, with a remark. Nothing is
/// written beside the bag.
/// @throws InputError "file: rule (got value)" if it is none or is damaged.
[[nodiscard]] std::unique_ptr<BagReader> OpenBag(const std::filesystem::path& path);

/// A copy of a bag in which messages of one topic are replaced and all else stays byte for byte as
/// it was. Files have the suffix kUnfinishedSuffix until they are finished.
class BagCopy {
 public:
  virtual ~BagCopy() = default;

  /// Says what becomes of a message of the topic. Memory grows with messages that are said before
  /// others that stand before them in the bag.
  /// @param data With the header of its encoding; absent: it stays as it is.
  virtual void Put(const BagPlace& place, std::optional<std::span<const std::byte>> data) = 0;
  /// Completes the copy. Messages that nothing was said of stay as they are.
  virtual void Finish() = 0;
};

/// Copies a bag, as OpenBag() takes it.
/// @param copy A file, or a directory if the bag is one.
/// @param topic Of the bag.
/// @throws InputError as OpenBag(), or if the system refuses.
[[nodiscard]] std::unique_ptr<BagCopy> CopyBag(const std::filesystem::path& bag,
                                               const std::filesystem::path& copy,
                                               const BagTopic& topic);

/// Whether OpenBag() would take the path for a bag, by its name and its first bytes.
[[nodiscard]] bool IsBag(const std::filesystem::path& path);

/// Opens an MCAP file, also one that was cut off.
/// @param name Names it in messages.
/// @throws InputError as OpenBag() does.
[[nodiscard]] std::unique_ptr<BagReader> OpenMcapBag(const std::filesystem::path& file,
                                                     const std::string& name);

/// Makes a copy of an MCAP file, of which messages of a topic are replaced.
/// @param copy Its file; unfinished until Finish().
[[nodiscard]] std::unique_ptr<BagCopy> CopyMcapBag(const std::filesystem::path& file,
                                                   const std::string& name,
                                                   const std::filesystem::path& copy,
                                                   const BagTopic& topic);

/// Opens a database of rosbag2, of any version of its tables. If its recorder was interrupted, so
/// that a journal or a write-ahead log stands beside it, both are copied to the temporary folder
/// and read there.
/// @param name Names it in messages.
/// @throws InputError as OpenBag() does.
[[nodiscard]] std::unique_ptr<BagReader> OpenSqliteBag(const std::filesystem::path& file,
                                                       const std::string& name);

/// Makes a copy of such a database, of which messages are replaced by their ids.
/// @param copy Its file; unfinished until Finish().
[[nodiscard]] std::unique_ptr<BagCopy> CopySqliteBag(const std::filesystem::path& file,
                                                     const std::filesystem::path& copy);

/// The files beside a database in which an interrupted recorder left changes.
[[nodiscard]] std::vector<std::filesystem::path> ChangesBeside(const std::filesystem::path& file);

}  // namespace railcast::bag
