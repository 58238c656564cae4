#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/io/run/frame_record.h"

namespace railcast {

/// A file of a directory that gets one line per frame; those of motion sensors, one per sample.
struct LineFileName {
  std::string name;
  std::string header;
};

/// Iterates over the whole lines of a line file.
class LineWalk {
 public:
  /// @throws InputError if the file is there, but cannot be read.
  LineWalk(const std::filesystem::path& file, std::string_view header);

  /// Returns the next lines with their ends; empty if there are fewer or the last is incomplete.
  [[nodiscard]] std::string_view Next(std::size_t num_lines = 1) const;
  void Advance(std::size_t num_lines = 1) { position_ += Next(num_lines).size(); }
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  std::string text_;
  bool has_header_ = false;
  std::size_t position_ = 0;
};

/// Whether a file is there and has the content that was written.
/// @throws InputError if it cannot be read.
[[nodiscard]] bool HasContent(const std::filesystem::path& directory, const KnownFile& file);

}  // namespace railcast
