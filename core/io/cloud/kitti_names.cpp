#include "core/io/cloud/kitti_names.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Collects the faults of a configuration. Pointers are those of JSON.
class NamesReader {
 public:
  explicit NamesReader(std::string place) : place_(std::move(place)) {}

  LabelTable Read(const YAML::Node& root) {
    if (!root.IsMap()) {
      Fault("", "must be a map with the key labels");
    } else {
      const YAML::Node labels = Only(root, "labels");
      const YAML::Node colors = Only(root, "color_map");
      if (labels) {
        ReadNames(labels);
      } else {
        Fault("/labels", "missing");
      }
      if (colors) ReadColors(colors);
    }
    faults_.ThrowIfAny();
    std::vector<Label> labels;
    for (auto& [id, label] : labels_) labels.push_back(std::move(label));
    return LabelTable(std::move(labels));
  }

 private:
  void Fault(const std::string& pointer, const std::string& rule, const std::string& value = {}) {
    faults_.Add({pointer.empty() ? place_ : place_ + ": " + pointer, rule, value});
  }

  // The value of a key of the root. The library gives the first of several.
  YAML::Node Only(const YAML::Node& root, const std::string& key) {
    YAML::Node found(YAML::NodeType::Undefined);
    int num = 0;
    for (const auto& entry : root) {
      if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
      if (++num > 1) Fault("/" + key, "duplicate key");
      found.reset(entry.second);
    }
    return found;
  }

  std::string TextOf(const YAML::Node& node) {
    return node.IsScalar() ? ShownText(node.Scalar()) : "no scalar";
  }

  // Calls `read(id, pointer, value)` for each entry of a map by label numbers.
  template <typename Read>
  void ForEachNumber(const YAML::Node& map, const std::string& pointer, const Read& read) {
    if (!map.IsMap()) return Fault(pointer, "must be a map by label numbers");
    std::map<std::uint16_t, bool> seen;
    for (const auto& entry : map) {
      const YAML::Node& key = entry.first;
      const auto id = key.IsScalar() ? ParseNumber<std::uint16_t>(key.Scalar()) : std::nullopt;
      if (!id) {
        Fault(pointer, "a key must be a whole number from 0 to 65535", TextOf(key));
        continue;
      }
      const std::string place = pointer + "/" + std::to_string(*id);
      if (!seen.emplace(*id, true).second) {
        Fault(place, "duplicate key");
        continue;
      }
      read(*id, place, entry.second);
    }
  }

  void ReadNames(const YAML::Node& labels) {
    constexpr std::uint8_t kGrey = 128;
    std::map<std::string, std::uint16_t> id_of;
    ForEachNumber(
        labels, "/labels", [&](std::uint16_t id, const std::string& place, const auto& name) {
          if (!name.IsScalar() || name.Scalar().empty()) {
            return Fault(place, "must be a name", TextOf(name));
          }
          const auto [first, is_first] = id_of.emplace(name.Scalar(), id);
          if (!is_first) {
            return Fault(
                place, "must have a name of its own, not that of " + std::to_string(first->second),
                ShownText(name.Scalar()));
          }
          Label label;
          label.id = id;
          label.name = name.Scalar();
          label.rgb = {kGrey, kGrey, kGrey};
          label.semantic_kitti = id;
          labels_.emplace(id, std::move(label));
        });
  }

  // Colours of numbers without a name occur in published files.
  void ReadColors(const YAML::Node& colors) {
    ForEachNumber(
        colors, "/color_map", [&](std::uint16_t id, const std::string& place, const auto& bgr) {
          std::array<std::uint8_t, 3> rgb{};
          bool is_color = bgr.IsSequence() && bgr.size() == rgb.size();
          for (std::size_t i = 0; is_color && i < rgb.size(); ++i) {
            const auto part =
                bgr[i].IsScalar() ? ParseNumber<std::uint8_t>(bgr[i].Scalar()) : std::nullopt;
            is_color = part.has_value();
            rgb[rgb.size() - 1 - i] = part.value_or(0);
          }
          if (!is_color) return Fault(place, "must be three whole numbers from 0 to 255: b, g, r");
          const auto label = labels_.find(id);
          if (label != labels_.end()) label->second.rgb = rgb;
        });
  }

  std::string place_;
  ErrorList faults_;
  std::map<std::uint16_t, Label> labels_;
};

bool IsConfiguration(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("semantic-kitti") && name.ends_with(".yaml");
}

}  // namespace

LabelTable ParseSemanticKittiNames(const std::string& yaml, const std::string& place) {
  // Files in use have 5 kB. The library needs much more memory than the text.
  constexpr std::size_t kMostBytes = 1'000'000;
  if (yaml.size() > kMostBytes) {
    throw InputError(place + ": must have at most " + NumberText(kMostBytes) + " bytes" +
                     Got(yaml.size()));
  }
  try {
    return NamesReader(place).Read(YAML::Load(yaml));
  } catch (const YAML::Exception& error) {
    throw InputError(place + ": is no YAML: line " + std::to_string(error.mark.line + 1) +
                     ", column " + std::to_string(error.mark.column + 1) + ": " + error.msg);
  }
}

std::optional<fs::path> FindSemanticKittiYaml(const fs::path& clouds) {
  // The folder of files that are named alone is "", of which nothing absolute is known.
  fs::path folder = (fs::current_path() / clouds).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  constexpr int kMostAbove = 3;  // ROOT/sequences/00/velodyne.
  const int num_above = folder.filename() == "velodyne" ? kMostAbove : 0;
  for (int i = 0; i <= num_above; ++i, folder = folder.parent_path()) {
    std::vector<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (IsConfiguration(entry.path())) found.push_back(entry.path());
    }
    if (found.size() == 1) return found.front();
    if (found.empty()) continue;
    std::ranges::sort(found);
    const auto name_of = [](const fs::path& file) { return ShownPath(file.filename()); };
    throw InputError(ShownPath(folder) + ": must hold one semantic-kitti*.yaml (got " +
                     Join(found, ", ", name_of) + ")");
  }
  return std::nullopt;
}

LabelTable SemanticKittiNamesOf(const fs::path& clouds) {
  const std::optional<fs::path> file = FindSemanticKittiYaml(clouds);
  if (!file) return {};
  return ParseSemanticKittiNames(ReadFileWhole(*file), ShownPath(*file));
}

}  // namespace railcast
