#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/mcap_records.h"
#include "core/extras/ros/mcap/record_scan.h"

namespace railcast::mcap {

/// Copies an MCAP file, record by record, with other data in some of its messages.
///
/// Chunks keep their messages and their kind of compression; those without other data keep their
/// bytes. What states sizes, places and checksums follows. Without other data the copy is the file.
/// Of a file that was cut off, what follows its last whole record is copied, too.
class McapCopy {
 public:
  /// Takes the copy's bytes from its begin to its end.
  using Sink = std::function<void(ByteSpan bytes)>;

  /// @param name Names the file in messages.
  /// @param channels Those whose messages Put() is told of.
  /// @throws InputError as McapReader does.
  McapCopy(const std::filesystem::path& file,
           std::string name,
           Sink sink,
           std::set<std::uint16_t> channels);

  /// Says what becomes of a message, and writes what can be written now.
  /// @param data Absent: it stays as it is.
  /// @throws InputError as McapReader::Next().
  void Put(const MessagePlace& place, std::optional<Bytes> data);
  /// Writes the rest.
  void Finish();

 private:
  void Advance();
  void Enter(const RecordPlace& record);
  [[nodiscard]] bool IsDecided() const;
  void WriteNext();
  void WriteChunk();
  void WriteMessage();
  void WriteMessageIndex();
  void WriteChunkIndex();
  void WriteFooter();
  /// Writes the next record with some of its fields changed.
  template <typename Record, typename Change>
  void Rewrite(const Change& change);
  /// Copies bytes of the file.
  void CopyBytes(std::uint64_t begin, std::uint64_t end);
  void PutBytes(ByteSpan bytes);
  /// Where in the copy a record is that is at a place of the file, or what follows it.
  [[nodiscard]] std::uint64_t Moved(std::uint64_t place) const;
  /// What was put in place of a message's data; null if nothing.
  [[nodiscard]] const Bytes* DataAt(std::uint64_t in_chunk) const;

  ByteFile file_;
  Sink sink_;
  std::set<std::uint16_t> channels_;
  std::set<std::uint64_t> other_chunks_;  ///< Places of those without such messages.
  RecordScan scan_;
  std::map<MessagePlace, std::optional<Bytes>> decided_;  ///< Not written yet.
  bool is_finishing_ = false;

  // The record that comes next.
  std::optional<RecordPlace> next_;
  Bytes content_;
  std::vector<std::uint64_t> messages_;  ///< Places in the chunk of those that are waited for.

  // The copy.
  bool has_changed_ = false;
  std::uint64_t size_{};
  std::uint64_t copied_{};                 ///< Bytes of the file.
  std::uint32_t crc_{};                    ///< CRC of the section that is being written.
  std::optional<std::uint64_t> data_end_;  ///< Where the file's data end.
  std::vector<std::pair<std::uint64_t, std::int64_t>> shifts_;  ///< From a place of the file on.
  std::map<std::uint64_t, McapChunkIndex> changed_;             ///< By place in the file.
  std::map<std::uint64_t, std::uint64_t> moved_;  ///< Messages of the last chunk, if it changed.
};

}  // namespace railcast::mcap
