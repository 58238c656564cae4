#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "core/base/input_file.h"

namespace railcast {

/// Runs a program that a report needs and returns its standard output.
/// @param command A shell's command line that begins with the program's name.
/// @param package Debian's package that has the program.
/// @throws InputError if the program is not found or fails; it says that the numbers are written.
[[nodiscard]] std::string ProgramOutput(const std::string& command, const std::string& package);

/// A folder for files that exist while a report is made, removed with all of them.
class ReportScratch {
 public:
  /// @throws InputError if the system refuses.
  ReportScratch() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "railcast-XXXXXX").string();
    if (error) throw InputError("TMPDIR: must be a folder, in which charts are drawn");
    if (::mkdtemp(name.data()) == nullptr) throw FileError(name, errno);
    path_ = name;
  }
  ReportScratch(const ReportScratch&) = delete;
  ReportScratch& operator=(const ReportScratch&) = delete;
  ~ReportScratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace railcast
