#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/io/temporary_directory.h"

namespace railcast {

inline std::filesystem::path ScenariosDir() {
  return std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios";
}

inline std::string TextOf(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The files of a folder that end in `.json`, in alphabetical order.
inline std::vector<std::filesystem::path> JsonFilesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The scenarios shipped with the project, those from maps included.
inline std::vector<std::filesystem::path> ShippedScenarios() {
  std::vector<std::filesystem::path> files = JsonFilesIn(ScenariosDir());
  std::erase_if(files, [](const auto& file) { return file.filename() == "labels.json"; });
  for (const auto& file : JsonFilesIn(ScenariosDir() / "osm_sankt_poelten")) {
    // Beside them lie their sections: NAME.world.json, NAME.alignment.json.
    if (!file.stem().has_extension()) files.push_back(file);
  }
  return files;
}

/// A temporary folder for one test, into which files can be written; removed at the end.
class TemporaryFolder {
 public:
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_.path() / name) << text;
    return directory_.path() / name;
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace railcast
