#include "generator/extras/insert/clouds/source_files.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/cloud/text_cloud.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::string NameIn(const fs::path& directory, const fs::path& file) {
  return file.lexically_relative(directory).generic_string();
}

/// Adds a frame's cloud and its labels.
/// @throws InputError if it is of a format that is read, but not written.
void AddSourceFrame(const fs::path& cloud, SourceFiles& source) {
  if (IsLasFile(cloud) || IsTextCloud(cloud)) {
    throw InputError(ShownPath(cloud) + ": must be a " + ReadableExtensions(true) +
                     " file to be inserted into (got " + ShownPath(cloud.extension()) +
                     ", which is read, but not written)");
  }
  std::vector<std::string> names = {NameIn(source.directory, cloud)};
  if (const auto labels = SecondFileOf(cloud)) names.push_back(NameIn(source.directory, *labels));
  source.frames.push_back(std::move(names));
}

SourceFiles SingleCloud(const fs::path& cloud) {
  const fs::path whole = fs::absolute(cloud).lexically_normal();
  // KITTI's labels are in a folder beside that of the cloud.
  const bool has_labels = SecondFileOf(whole).has_value();
  SourceFiles source;
  source.directory = has_labels ? whole.parent_path().parent_path() : whole.parent_path();
  AddSourceFrame(whole, source);
  return source;
}

/// The frames of frames.csv.
void ReadReceived(SourceFiles& source) {
  LineReader lines(source.directory / kReceivedFile);
  while (const auto line = lines.Next()) {
    source.lines.push_back(line->text);
    if (source.lines.size() == 1) continue;
    AddSourceFrame(source.directory / line->text.substr(0, line->text.find(',')), source);
  }
}

void FindOthers(SourceFiles& source) {
  std::set<std::string> of_frames;
  for (const auto& names : source.frames) of_frames.insert(names.begin(), names.end());
  if (!source.lines.empty()) of_frames.emplace(kReceivedFile);
  std::error_code none;
  for (const auto& entry : fs::recursive_directory_iterator(source.directory, none)) {
    if (!entry.is_regular_file(none) || entry.is_symlink(none)) continue;
    std::string name = NameIn(source.directory, entry.path());
    if (!of_frames.contains(name)) source.others.push_back(std::move(name));
  }
  std::ranges::sort(source.others);
}

}  // namespace

std::optional<SourceFiles> FindSourceFiles(const fs::path& opened) {
  const auto [recording, columns] = KittiSourceOf(opened);
  std::error_code none;
  if (fs::is_regular_file(recording, none)) {
    if (!IsCloudFile(recording)) return std::nullopt;
    SourceFiles source = SingleCloud(recording);
    source.kitti_columns = columns;
    return source;
  }
  if (!fs::is_directory(recording, none)) return std::nullopt;
  for (const auto name : {kFramesFile, kMergedFile}) {
    if (fs::exists(recording / name)) return std::nullopt;
  }
  SourceFiles source;
  source.directory = recording.lexically_normal();
  source.kitti_columns = columns;
  if (fs::exists(recording / kReceivedFile)) {
    ReadReceived(source);
  } else {
    for (const fs::path& cloud : CloudsOfDirectory(source.directory).files) {
      AddSourceFrame(cloud, source);
    }
  }
  if (source.frames.empty()) return std::nullopt;
  FindOthers(source);
  return source;
}

}  // namespace railcast
