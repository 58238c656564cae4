#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

/// A message of a trace.
struct TraceMessage {
  std::string hash;     ///< ContentHash() of its bytes.
  std::uint64_t end{};  ///< Where it ends in an .osi file.
};

struct TraceContent {
  std::vector<TraceMessage> messages;  ///< In the order of their times.
  std::string fault;                   ///< Why there are no more; empty at the end of the trace.
};

/// Reads the messages of an .osi or an MCAP file, also of an interrupted one.
/// @throws InputError "file: rule" if it cannot be opened.
[[nodiscard]] TraceContent ReadTrace(const std::filesystem::path& file);

}  // namespace railcast::osi
