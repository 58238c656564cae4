#include "viewer/label_file.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace railcast {

std::optional<std::filesystem::path> FindLabelFile(const std::filesystem::path& cloud_file) {
  const std::filesystem::path folder = std::filesystem::absolute(cloud_file).parent_path();
  for (const std::filesystem::path& candidate : {folder, folder.parent_path()}) {
    if (std::filesystem::is_regular_file(candidate / "labels.json"))
      return candidate / "labels.json";
  }
  return std::nullopt;
}

LabelTable ReadLabelFile(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string() + ": cannot be read");
  try {
    const nlohmann::json table = nlohmann::json::parse(stream);
    std::vector<Label> labels;
    for (const nlohmann::json& entry : table.at("labels")) {
      Label& label = labels.emplace_back();
      entry.at("id").get_to(label.id);
      entry.at("name").get_to(label.name);
      entry.at("rgb").get_to(label.rgb);
    }
    return LabelTable(std::move(labels));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": is no label table: " + error.what());
  }
}

}  // namespace railcast
