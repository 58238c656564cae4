#include "generator/insert/run/recording_split.h"

#include <string_view>

#include "core/base/text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Whether a recording is, or is in, one of the folders that a file lists.
bool IsListed(const std::string& recording, const fs::path& file) {
  const std::string text = ReadFileWhole(file);
  std::string_view rest = text;
  while (const auto folder = TakeLine(rest)) {
    if (recording == *folder || recording.starts_with(std::string(*folder) + "/")) return true;
  }
  return false;
}

}  // namespace

std::optional<std::string> SplitOfRecording(const fs::path& recording) {
  fs::path whole = fs::weakly_canonical(recording);
  if (!whole.has_filename()) whole = whole.parent_path();
  for (fs::path parent = whole.parent_path(); parent != parent.parent_path();
       parent = parent.parent_path()) {
    if (!fs::exists(parent / kDatasetFile)) continue;
    for (const std::string_view name : kSplitFiles) {
      const fs::path file = parent / name;
      if (!fs::exists(file)) continue;
      if (IsListed(whole.lexically_relative(parent).generic_string(), file)) {
        return file.stem().string();
      }
    }
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace railcast
