#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/base/file_descriptor.h"
#include "core/extras/ros/mcap/mcap_records.h"

namespace railcast::mcap {

/// A file whose bytes are read at any place. It is only read, never locked or changed.
class ByteFile {
 public:
  /// @param name Names it in messages.
  /// @throws InputError "file: rule" if it cannot be opened or is no regular file.
  ByteFile(const std::filesystem::path& file, std::string name);

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// As messages show it.
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Returns bytes of the file.
  /// @pre They lie within size().
  /// @throws InputError "file: rule" if the system refuses or the file has become shorter.
  [[nodiscard]] Bytes Read(std::uint64_t offset, std::size_t size) const;

 private:
  std::string name_;
  FileDescriptor descriptor_;
  std::uint64_t size_{};
};

}  // namespace railcast::mcap
