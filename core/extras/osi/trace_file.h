#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/mcap/byte_file.h"

namespace railcast::osi {

/// The extension of a trace with a single channel: each message stands behind its length, a uint32
/// (OSI 3.8, trace file formats).
inline constexpr const char* kSingleChannel = ".osi";

/// What an MCAP file says of itself that is an OSI trace.
/// @param protobuf_version Of its messages: "3.21.12".
[[nodiscard]] bag::McapTrace McapTraceOf(const std::string& protobuf_version);

/// Reads the messages of an .osi file, one after another; only one is in memory.
class SingleChannelReader {
 public:
  /// @throws InputError "file: rule" if it cannot be opened.
  explicit SingleChannelReader(const std::filesystem::path& file);

  /// Returns the next message, or nothing at the end.
  /// @throws InputError "file: message 3: rule (got value)" if the file ends within it or it is
  ///   larger than a message can be.
  [[nodiscard]] std::optional<mcap::Bytes> Next();
  /// Where the last message ends that was returned.
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  mcap::ByteFile file_;
  std::uint64_t position_{};
  std::size_t num_read_{};
};

/// Reads the hashes of the messages of an .osi or an MCAP file, also of an interrupted one, in the
/// order of their times. Only one message is in memory.
class TraceReader {
 public:
  /// @throws InputError "file: rule" if it cannot be opened.
  explicit TraceReader(const std::filesystem::path& file);

  /// Returns the ContentHash() of the next message, or nothing if there are no more.
  [[nodiscard]] std::optional<std::string> NextHash();
  /// Why there are no more; empty at the end of the trace.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  std::optional<SingleChannelReader> single_channel_;
  std::unique_ptr<bag::BagReader> mcap_;
  std::string fault_;
};

}  // namespace railcast::osi
