#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/cloud/text_cloud.h"
#include "core/io/recording/cloud_stem.h"
#include "core/io/recording/recording_kinds.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Compares names naturally: numbers by value, all other characters one by one.
bool ComesBefore(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view a_digits = WithoutZeros(TakeAllDigits(a));
      const std::string_view b_digits = WithoutZeros(TakeAllDigits(b));
      if (a_digits.size() != b_digits.size()) return a_digits.size() < b_digits.size();
      if (a_digits != b_digits) return a_digits < b_digits;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() < b.size();
}

/// Throws if two files differ in their endings alone: they are one frame in two formats.
void CheckStemsDiffer(const std::vector<fs::path>& files) {
  std::map<std::string, const fs::path*> by_stem;
  for (const fs::path& file : files) {
    const auto [known, is_new] = by_stem.emplace(file.stem().string(), &file);
    if (is_new) continue;
    throw InputError(ShownPath(file.parent_path()) + ": must have each frame in one format (got " +
                     ShownPath(known->second->filename()) + " and " + ShownPath(file.filename()) +
                     ")");
  }
}

}  // namespace

void SortNaturally(std::vector<fs::path>& paths) {
  std::ranges::sort(paths, [](const fs::path& a, const fs::path& b) {
    const std::string a_name = a.filename().string();
    const std::string b_name = b.filename().string();
    if (ComesBefore(a_name, b_name)) return true;
    return !ComesBefore(b_name, a_name) && a_name < b_name;
  });
}

bool IsCloudFile(const fs::path& file) {
  return FindReader(file) != nullptr || IsLasFile(file) || IsTextCloud(file);
}

bool IsKittiFile(const fs::path& file) {
  const FrameFormat* const format = FindReader(file);
  return format != nullptr && format->dataset;
}

CloudSeries CloudFilesIn(const fs::path& directory) {
  std::vector<fs::path> files;
  std::error_code error;
  const std::string label = directory.filename().string();
  const bool is_part = label.find('#') != std::string::npos && !fs::exists(directory, error);
  for (const auto& entry :
       fs::directory_iterator(is_part ? "." / directory.parent_path() : directory, error)) {
    const bool is_hidden = entry.path().filename().native().starts_with('.');
    const bool is_frame = IsCloudFile(entry.path()) && !IsTextTable(entry.path());
    if (!is_hidden && is_frame) files.push_back(entry.path());
  }
  SortNaturally(files);
  CheckStemsDiffer(files);
  return SeriesOfClouds(std::move(files), is_part ? label : "");
}

std::vector<fs::path> KittiSequencesIn(const fs::path& directory) {
  std::vector<fs::path> sequences;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory / "sequences", error)) {
    if (!CloudFilesIn(entry.path() / "velodyne").files.empty()) sequences.push_back(entry.path());
  }
  SortNaturally(sequences);
  return sequences;
}

CloudSeries CloudsOfDirectory(const fs::path& directory) {
  for (const auto& place : {directory, directory / "frames", directory / "velodyne"}) {
    CloudSeries clouds = CloudFilesIn(place);
    if (!clouds.files.empty()) return clouds;
  }
  CloudSeries all;
  for (const fs::path& sequence : KittiSequencesIn(directory)) {
    const CloudSeries more = CloudFilesIn(sequence / "velodyne");
    all.files.insert(all.files.end(), more.files.begin(), more.files.end());
    all.others.insert(all.others.end(), more.others.begin(), more.others.end());
  }
  return all;
}

std::string ColumnsBehind(const fs::path& source) {
  const std::string& text = source.native();
  const std::size_t mark = text.rfind(':');
  if (mark == std::string::npos) return {};
  const std::string columns = text.substr(mark + 1);
  return IsKittiColumns(columns) || IsTextColumns(columns) ? columns : std::string();
}

KittiSource KittiSourceOf(const fs::path& source) {
  std::error_code error;
  const std::string columns = ColumnsBehind(source);
  if (columns.empty() || fs::exists(source, error)) return {source, {}};
  const std::string& text = source.native();
  return {text.substr(0, text.size() - columns.size() - 1), columns};
}

}  // namespace railcast
