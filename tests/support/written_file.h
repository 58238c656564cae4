#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {

/// A file in a folder of its own, which is deleted with it.
class WrittenFile {
 public:
  explicit WrittenFile(const std::string& name, std::string_view bytes = {})
      : path_(folder_.path() / name) {
    Write(bytes);
  }
  void Write(std::string_view bytes) const { WriteFileWhole(path_, bytes); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryDirectory folder_;
  std::filesystem::path path_;
};

}  // namespace railcast
