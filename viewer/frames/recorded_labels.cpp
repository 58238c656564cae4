#include "viewer/frames/recorded_labels.h"

#include <filesystem>

#include "core/io/cloud/kitti.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// Looks for labels.json in the source's folder, then in `num_above` folders above it.
LabelTable FindLabels(const std::filesystem::path& source, int num_above) {
  std::filesystem::path folder = std::filesystem::absolute(source).lexically_normal();
  // A path that ends in a slash has an empty last component.
  if (!is_directory(folder) || !folder.has_filename()) folder = folder.parent_path();
  for (int i = 0; i <= num_above; ++i, folder = folder.parent_path()) {
    const std::filesystem::path candidate = folder / "labels.json";
    if (is_regular_file(candidate)) return ReadLabelTable(candidate);
  }
  return {};
}

}  // namespace

LabelTable LabelsOf(const RecordingInfo& info) {
  if (!info.labels.labels().empty()) return info.labels;
  if (!info.has_kitti_labels) return FindLabels(info.source, 1);
  return SemanticKittiLabels(FindLabels(info.source, 3));
}

}  // namespace railcast
