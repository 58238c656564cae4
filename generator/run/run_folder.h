#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace railcast {

/// A text file that grows line by line.
class LineFile {
 public:
  /// Opens or creates the file and truncates it to its first `keep_bytes`.
  /// @throws InputError if the system refuses.
  LineFile(std::filesystem::path file, std::uint64_t keep_bytes);
  ~LineFile();
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&&) = delete;
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  /// Appends whole lines, or nothing on failure.
  /// @throws InputError if the system refuses, for example on a full disk.
  void Append(std::string_view lines);

  /// Waits until all lines are on the disk.
  /// @throws InputError if they cannot be written.
  void Sync();

 private:
  std::filesystem::path file_;
  std::uint64_t size_;
  int descriptor_;
};

}  // namespace railcast
