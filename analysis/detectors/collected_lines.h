#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace railcast {

/// What a detector reports live (docs/evaluate.md, "Live"): one line for each frame, in datagrams
/// that may come in any order and more than once.
class CollectedLines {
 public:
  /// Takes a datagram: a line as ReadDetectionLine() reads it, with or without its end. The same
  /// line again, which a network may deliver, changes nothing.
  /// @param from Names the sender in messages.
  /// @return The line with its end; empty if it is there already.
  /// @throws InputError "127.0.0.1:4711: /pointer: rule (got value)" for every fault of the line,
  ///   and for another line of a frame that has one. Nothing has been taken then.
  std::string Take(std::string_view datagram, const std::string& from);

  [[nodiscard]] std::size_t num_frames() const { return lines_.size(); }

  /// The lines by rising frame, as a file of detections has them.
  [[nodiscard]] std::string Text() const;

  /// Which frames, how many are missing between them, and how many datagrams, as a line of text.
  [[nodiscard]] std::string Summary() const;

 private:
  std::map<std::uint32_t, std::string> lines_;  ///< By frame.
  std::uint64_t num_repeated_ = 0;
};

}  // namespace railcast
