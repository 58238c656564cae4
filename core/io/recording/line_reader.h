#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace railcast {

/// A line of a file and where it is from.
struct PlacedLine {
  std::string text;
  std::string place;  ///< "out/poses.csv:3"
};

/// Reads a file line by line. A last line without an end is being written, or was when its writer
/// was stopped: it is none.
class LineReader {
 public:
  /// @throws InputError if the file cannot be read.
  explicit LineReader(const std::filesystem::path& file);

  [[nodiscard]] std::optional<PlacedLine> Next();
  /// @throws InputError "file:3: missing" at the end.
  [[nodiscard]] PlacedLine Need();

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::size_t num_lines_{};
};

/// How many whole lines a file has. @throws InputError if it cannot be read.
[[nodiscard]] std::size_t CountLines(const std::filesystem::path& file);

}  // namespace railcast
