#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "tests/core/scenario/scenario_files.h"

namespace railcast {

/// A faulty scenario in `scenarios/malformed/` and the messages that reading it must give, which
/// are in the file beside it.
struct MalformedCase {
  std::filesystem::path file;  ///< Relative to scenarios/, as a user would name it.
  std::string expected;
};

inline void PrintTo(const MalformedCase& malformed, std::ostream* out) {
  *out << malformed.file.string();
}

inline std::vector<MalformedCase> MalformedCases(const std::string& folder) {
  std::vector<MalformedCase> cases;
  for (const auto& file : JsonFilesIn(ScenariosDir() / "malformed" / folder)) {
    std::filesystem::path expected = file;
    expected.replace_extension(".expected");
    cases.push_back({std::filesystem::relative(file, ScenariosDir()), TextOf(expected)});
  }
  return cases;
}

inline std::string NameOf(const MalformedCase& malformed) {
  return malformed.file.stem().string();
}

}  // namespace railcast
