#include "viewer/label_file.h"

namespace railcast {

std::optional<std::filesystem::path> FindLabelFile(const std::filesystem::path& cloud_file) {
  const std::filesystem::path folder = std::filesystem::absolute(cloud_file).parent_path();
  for (const std::filesystem::path& candidate : {folder, folder.parent_path()}) {
    if (std::filesystem::is_regular_file(candidate / "labels.json"))
      return candidate / "labels.json";
  }
  return std::nullopt;
}

}  // namespace railcast
