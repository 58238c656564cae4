#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "tests/core/io/temporary_directory.h"

namespace railcast {

/// Splits one input into several files in a folder of this process, which remain until the next
/// input.
///
/// The text up to the first line `//// NAME` is the main file, which names the others; the text
/// after such a line is the file NAME. The folder has a link, `shipped`, to the project's
/// scenarios.
class InputFiles {
 public:
  explicit InputFiles(std::string_view input) {
    Empty();
    std::string name = "input.json";
    while (true) {
      const std::size_t end = input.find("\n//// ");
      Write(name, input.substr(0, end));
      if (end == std::string_view::npos) return;
      input.remove_prefix(end + std::string_view("\n//// ").size());
      const std::size_t line_end = std::min(input.find('\n'), input.size());
      name = NameFrom(input.substr(0, line_end));
      input.remove_prefix(std::min(line_end + 1, input.size()));
    }
  }

  [[nodiscard]] static std::filesystem::path first() { return folder() / "input.json"; }

  /// Writes one more file.
  /// @return Its path.
  static std::filesystem::path Write(const std::string& name, std::string_view text) {
    std::ofstream(folder() / name, std::ios::binary) << text;
    return folder() / name;
  }

 private:
  static const std::filesystem::path& folder() {
    static const TemporaryDirectory directory;
    return directory.path();
  }

  /// Replaces whatever could lead out of the folder.
  static std::string NameFrom(std::string_view line) {
    constexpr std::size_t kMaxLength = 40;
    constexpr std::string_view kAllowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.";
    std::string name(line.substr(0, std::min(line.find_first_not_of(kAllowed), kMaxLength)));
    return name.find_first_not_of('.') == std::string::npos ? "unnamed" : name;
  }

  static void Empty() {
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
      if (!entry.is_symlink()) std::filesystem::remove(entry.path());
    }
    std::error_code exists;
    std::filesystem::create_directory_symlink(RAILCAST_SOURCE_DIR "/scenarios",
                                              folder() / "shipped", exists);
  }
};

}  // namespace railcast
