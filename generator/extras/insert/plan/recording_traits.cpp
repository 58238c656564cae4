#include <filesystem>
#include <map>
#include <string>

#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/content_hash.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/sequence_files.h"
#include "generator/extras/insert/plan/recorded_run.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Hashes of files by what they are called.
class FileTraits {
 public:
  void Add(const std::string& name, const fs::path& file) {
    if (fs::is_regular_file(file)) traits_[name] = HashFile(file).hash;
  }
  void AddText(const std::string& name, const std::string& text) { traits_[name] = text; }
  void AddAllIn(const std::string& begin, const fs::path& folder) {
    if (!fs::is_directory(folder)) return;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      Add(begin + entry.path().lexically_relative(folder).generic_string(), entry.path());
    }
  }
  /// Adds what is read of KITTI's layout beside its folder `velodyne`.
  void AddBesideVelodyne(const fs::path& sequence) {
    for (const char* const name : {"calib.txt", "poses.txt", "times.txt"}) {
      Add(std::string("../") + name, sequence / name);
    }
    AddAllIn("../labels/", sequence / "labels");
  }

  [[nodiscard]] std::string Text() const {
    std::string text;
    for (const auto& [name, hash] : traits_) text += name + '\n' + hash + '\n';
    return text;
  }

 private:
  std::map<std::string, std::string> traits_;
};

}  // namespace

std::string RecordingTraits(const fs::path& source) {
  FileTraits traits;
  if (const auto capture = FindCapture(source)) {
    traits.Add("capture", capture->file);
    if (capture->sensor) traits.AddText("sensor", EndpointText(*capture->sensor));
    traits.Add("metadata", capture->beside.file);
    traits.Add("correction", fs::path(capture->file).replace_extension(".dat"));
    return traits.Text();
  }
  const auto bag = FindBag(source);
  const fs::path recording = bag ? bag->bag : KittiSourceOf(source).clouds;
  if (fs::exists(recording / kFramesFile) && fs::exists(recording / kManifestFile)) {
    traits.Add(std::string(kManifestFile), recording / kManifestFile);
    return traits.Text();
  }
  if (fs::is_directory(recording)) {
    traits.AddAllIn("", recording);
    if (recording.filename() == "velodyne") traits.AddBesideVelodyne(recording.parent_path());
    return traits.Text();
  }
  traits.Add("file", recording);
  if (const auto labels = SecondFileOf(recording)) traits.Add("labels", *labels);
  return traits.Text();
}

}  // namespace railcast
