#include <map>

#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/sequence_files.h"
#include "generator/insert/plan/recorded_run.h"

namespace railcast {

std::string RecordingTraits(const std::filesystem::path& source) {
  namespace fs = std::filesystem;
  const auto capture = FindCapture(source);
  const auto bag = FindBag(source);
  const fs::path recording = capture ? capture->file : bag ? bag->bag : source;
  if (!fs::is_directory(recording)) return NumberText(fs::file_size(recording));
  std::map<std::string, std::string> traits;
  for (const auto& entry : fs::recursive_directory_iterator(recording)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().lexically_relative(recording).generic_string();
    traits[name] = NumberText(entry.file_size());
    if (entry.path().filename() == kManifestFile) traits[name] = HashFile(entry.path()).hash;
  }
  std::string text;
  for (const auto& [name, trait] : traits) text += name + '\n' + trait + '\n';
  return text;
}

}  // namespace railcast
