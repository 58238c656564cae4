#include "core/io/run/sensor_folders.h"

#include <string>

#include "core/base/text.h"
#include "core/io/recorded_json.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// What `read` makes of a directory's sensors.json; nothing without the file.
template <typename Read>
auto ReadSensorsFile(const fs::path& directory, const Read& read)
    -> decltype(read(StrictOrderedJson{})) {
  const fs::path file = directory / kSensorsFile;
  if (!fs::exists(file)) return {};
  return ReadRecordedJson<StrictOrderedJson>(ReadFileWhole(file), ShownPath(file), read);
}

}  // namespace

std::vector<fs::path> SensorFoldersIn(const fs::path& directory) {
  return ReadSensorsFile(directory, [&](const StrictOrderedJson& json) {
    std::vector<fs::path> folders;
    for (const auto& sensor : json.at("sensors")) {
      folders.push_back(directory / sensor.at("folder").get<std::string>());
    }
    return folders;
  });
}

std::optional<MergedFolder> MergedFolderIn(const fs::path& directory) {
  return ReadSensorsFile(directory, [&](const StrictOrderedJson& json) {
    std::optional<MergedFolder> merged;
    if (!json.contains("merged")) return merged;
    const StrictOrderedJson& found = json.at("merged");
    merged.emplace().folder = directory / found.at("folder").get<std::string>();
    for (const std::string_view name : {kMergedFile, kPosesFile}) {
      const std::string key(name);
      merged->files.push_back(
          {key, found.at("files_xxh3").at(key).get<std::string>(), std::nullopt});
    }
    return merged;
  });
}

}  // namespace railcast
