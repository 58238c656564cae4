#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/file_descriptor.h"
#include "core/io/write_file.h"

namespace railcast {

/// Returns the name that an unfinished file gets, "a.pcd" for "a.pcd.part"; nothing for a name that
/// does not end so.
[[nodiscard]] inline std::optional<std::string_view> FinishedName(std::string_view name) {
  if (!name.ends_with(kUnfinishedSuffix)) return std::nullopt;
  return name.substr(0, name.size() - kUnfinishedSuffix.size());
}

/// A file in a folder of railcast's that has the suffix kUnfinishedSuffix until it is finished. All
/// functions throw InputError if the system refuses.
class UnfinishedFile {
 public:
  /// @param size What is kept of the unfinished file.
  /// @throws InputError as CheckIsOwnFile() does.
  UnfinishedFile(std::filesystem::path file, std::uint64_t size);

  void Append(std::span<const std::byte> bytes) const;
  /// Appends the content of another file.
  void AppendFile(const std::filesystem::path& source) const;
  /// Returns bytes that were written.
  [[nodiscard]] std::string Read(std::uint64_t place, std::size_t size) const;
  /// Writes over bytes that were written.
  void Overwrite(std::uint64_t place, std::span<const char> bytes) const;

  void Sync() const;
  /// Gives the file its name.
  void Finish() const;

  /// The name that it gets.
  [[nodiscard]] std::string final_name() const { return file_.filename().string(); }

 private:
  [[nodiscard]] std::filesystem::path unfinished() const;

  std::filesystem::path file_;
  FileDescriptor descriptor_;
};

}  // namespace railcast
