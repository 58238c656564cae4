#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"

namespace railcast {

/// @throws InputError if the file cannot be read or is no JSON.
[[nodiscard]] inline StrictJson ReadMapJson(const std::filesystem::path& file) {
  const std::string text = ReadFileWhole(file);
  try {
    return StrictJson::parse(text);
  } catch (const StrictJson::exception& error) {
    throw InputError(ShownPath(file) + ": must be JSON: " + ShownLines(error.what()));
  }
}

}  // namespace railcast
