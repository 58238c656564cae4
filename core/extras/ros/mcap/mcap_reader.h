#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/mcap_records.h"

namespace railcast::mcap {

/// Reads the messages of an MCAP file in the order of their log times; those of equal time in the
/// order of the file. Chunks may overlap in time: of those that are needed at once, at most
/// `held_bytes` are held, and chunks beyond that are read again.
class McapReader {
 public:
  /// @param name Names the file in messages.
  /// @throws InputError "name: place: rule (got value)" as ReadIndex().
  McapReader(const std::filesystem::path& file,
             std::string name,
             std::size_t held_bytes = std::size_t{1} << 28U);

  [[nodiscard]] const McapIndex& index() const { return index_; }

  /// Restricts Next() to these channels, and begins anew.
  void Select(std::set<std::uint16_t> channels);

  /// Returns the next message, whose data are valid until the next call; nothing at the end.
  /// @throws InputError "file: record at N: rule (got value)" where the file is damaged, and at the
  ///   end "file: rule (got value)" if there were other numbers of messages than its statistics
  ///   say.
  [[nodiscard]] std::optional<McapMessage> Next();
  /// Where the message stands that Next() returned last.
  [[nodiscard]] const MessagePlace& place() const { return place_; }

  /// Returns the content of an attachment's record.
  /// @throws InputError as Next() does.
  [[nodiscard]] Bytes ReadAttachment(const McapAttachmentIndex& attachment) const;

 private:
  static constexpr std::size_t kNoChunk = static_cast<std::size_t>(-1);

  /// A message that is still to be returned.
  struct Waiting {
    std::uint64_t log_time{};
    std::uint64_t file_offset{};  ///< Offset of its chunk's record, or its own.
    std::uint64_t chunk_offset{};
    std::size_t chunk{};  ///< Number of its chunk; kNoChunk if it is loose.

    /// Whether it comes after another, so that the first of a heap is the next.
    bool operator<(const Waiting& other) const;
  };
  struct HeldChunk {
    std::size_t number{};
    Bytes content;
    Bytes storage;  ///< Holds what was compressed.
    ByteSpan records;

    [[nodiscard]] std::size_t size() const { return content.size() + storage.size(); }
  };

  [[nodiscard]] bool IsWanted(const McapChunkIndex& chunk) const;
  void Enter(std::size_t number);
  const HeldChunk& Hold(std::size_t number);
  void LetGo(std::size_t number);
  void CheckCounts() const;

  ByteFile file_;
  McapIndex index_;
  std::vector<std::size_t> by_time_;  ///< The chunks' numbers in the order of their start times.
  std::optional<std::set<std::uint16_t>> wanted_;

  MessagePlace place_;
  std::map<std::uint16_t, std::uint64_t> num_read_;  ///< Messages by channel.
  std::size_t num_entered_{};                        ///< How many of by_time_.
  std::priority_queue<Waiting> waiting_;
  std::unordered_map<std::size_t, std::size_t> num_waiting_;  ///< Messages by chunk.
  std::list<HeldChunk> held_;                                 ///< The last used is first.
  std::size_t max_held_bytes_;
  std::size_t held_bytes_{};
  std::optional<std::size_t> finished_;  ///< A chunk of which the last message was returned.
  Bytes loose_;                          ///< The last returned loose message.
};

}  // namespace railcast::mcap
