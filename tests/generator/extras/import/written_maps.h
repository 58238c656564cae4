#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/map/read_map.h"
#include "railcast/error.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {

/// Maps of a text.
class WrittenMaps {
 public:
  [[nodiscard]] std::filesystem::path Write(const std::string& name,
                                            const std::string& text) const {
    WriteFileWhole(directory_.path() / name, text);
    return directory_.path() / name;
  }
  [[nodiscard]] RailMap Read(const std::string& name, const std::string& text) const {
    return ReadMap(Write(name, text));
  }
  /// The message of a map that cannot be read, without the folder.
  [[nodiscard]] std::string Fault(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = Write(name, text);
    try {
      static_cast<void>(ReadMap(file));
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string folder = directory_.path().string() + "/";
      for (std::size_t at = 0; (at = message.find(folder)) != std::string::npos;) {
        message.erase(at, folder.size());
      }
      return message;
    }
    return "no error";
  }

 private:
  TemporaryDirectory directory_;
};

/// The first remark of a kind.
inline std::optional<Remark> RemarkOf(const RailMap& map, RemarkKind kind) {
  for (const Remark& remark : map.remarks) {
    if (remark.kind == kind) return remark;
  }
  return std::nullopt;
}

}  // namespace railcast
