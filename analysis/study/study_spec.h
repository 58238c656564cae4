#pragma once

#include <filesystem>
#include <string>

#include "analysis/detectability/object_detection.h"

namespace railcast {

/// A study: what is asked of the scenarios of a recipe (docs/study.md).
struct StudySpec {
  std::filesystem::path file;
  std::string question;  ///< In the words of whoever asks; may be empty.
  std::string recipe;    ///< Absolute name of the recipe's file.
  DetectSpec detect;
};

/// Reads a study as strictly as a scenario.
/// @throws InputError with a line for every fault: "file: /pointer: rule (got value)".
[[nodiscard]] StudySpec ReadStudy(const std::filesystem::path& file);

}  // namespace railcast
