#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include "core/extras/recipe/shard.h"
#include "core/io/recording/line_reader.h"

namespace railcast {

/// Reads lines that each are about one of many scenarios, such as scenarios.jsonl, one after the
/// other: millions need not fit into memory.
class ScenarioLines {
 public:
  /// @param file Of a data set, a study or a shard of them; it need not be there yet.
  /// @throws InputError if the file cannot be read.
  ScenarioLines(std::filesystem::path file, const Shard& shard);

  /// Returns the line of the shard's next scenario; nothing from the first line on that is another,
  /// incomplete or not as it was written, as an interrupted run may leave it.
  /// @throws InputError if the file cannot be read.
  [[nodiscard]] std::optional<PlacedLine> Next();
  /// What is wrong with the whole line before which Next() ended: "file:3: rule"; empty if there is
  /// none, as where a run was interrupted.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// As Next(), for the lines of finished scenarios.
  /// @throws InputError "file:3: rule" also where Next() returns nothing.
  [[nodiscard]] PlacedLine Need();
  /// Skips all further lines, or `most` of them.
  /// @return How many there were.
  std::uint32_t Skip(std::uint32_t most = std::numeric_limits<std::uint32_t>::max());
  /// Closes the file until the next line is asked for.
  void Pause() { stream_.reset(); }

  /// Size of the lines that have been read, in bytes.
  [[nodiscard]] std::uint64_t size() const { return size_; }

 private:
  [[nodiscard]] std::optional<PlacedLine> Read();
  // Returns what is wrong with a line; empty if nothing is: then it is read.
  std::string Take(const PlacedLine& line);

  std::filesystem::path file_;
  Shard shard_;
  std::optional<std::ifstream> stream_;
  std::uint32_t num_read_ = 0;
  std::uint64_t size_ = 0;
  bool is_over_ = false;
  std::string fault_;
};

}  // namespace railcast
