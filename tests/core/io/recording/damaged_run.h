#pragma once

#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>

#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {

/// A finished run whose files can be damaged.
struct DamagedRun {
  TemporaryDirectory directory;
  std::filesystem::path path = directory.path() / "run";

  explicit DamagedRun(const char* format, std::uint32_t num_frames = 2) {
    MadeSequenceSpec spec;
    spec.format = format;
    spec.num_frames = num_frames;
    (void)MakeSequence(path, spec);
  }
  void Flip(const std::string& file) const {
    const std::string bytes = ReadFileWhole(path / file);
    WriteFileWhole(path / file, Flipped(bytes, bytes.size() / 2));
  }
  /// Removes a line, counted from 0.
  void Cut(const std::string& file, std::size_t line) const {
    std::istringstream lines(ReadFileWhole(path / file));
    std::string kept;
    std::size_t number = 0;
    for (std::string text; std::getline(lines, text);) {
      if (number++ != line) kept += text + "\n";
    }
    WriteFileWhole(path / file, kept);
  }
  [[nodiscard]] std::string HashOf(const std::string& file) const {
    return ContentHash(ReadFileWhole(path / file));
  }
};

}  // namespace railcast
