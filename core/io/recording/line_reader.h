#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace railcast {

/// A line of a file and its place in that file.
struct PlacedLine {
  std::string text;
  std::string place;  ///< For error messages: "out/poses.csv:3".
};

/// Reads a file line by line. A last line without a line end is not returned: it is still being
/// written, or its writer was stopped in the middle of it.
class LineReader {
 public:
  /// @throws InputError if the file cannot be read.
  explicit LineReader(const std::filesystem::path& file);

  [[nodiscard]] std::optional<PlacedLine> Next();
  /// Returns the next line.
  /// @throws InputError "file:3: missing" at the end of the file.
  [[nodiscard]] PlacedLine Need();

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::size_t num_lines_{};
};

/// Returns the number of whole lines of a file.
/// @throws InputError if it cannot be read.
[[nodiscard]] std::size_t CountLines(const std::filesystem::path& file);

}  // namespace railcast
