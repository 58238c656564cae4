#include "core/io/sensor_folders.h"

#include "core/base/text.h"
#include "core/io/recording/recorded_json.h"
#include "core/io/write_file.h"

namespace railcast {

std::vector<std::filesystem::path> SensorFoldersIn(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / kSensorsFile;
  if (!std::filesystem::exists(file)) return {};
  return ReadRecordedJson<StrictOrderedJson>(
      ReadFileWhole(file), ShownPath(file), [&](const StrictOrderedJson& json) {
        std::vector<std::filesystem::path> folders;
        for (const auto& sensor : json.at("sensors")) {
          folders.push_back(directory / sensor.at("folder").get<std::string>());
        }
        return folders;
      });
}

}  // namespace railcast
