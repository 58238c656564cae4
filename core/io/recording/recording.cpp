#include "railcast/io/recording.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/unread_formats.h"
#include "core/io/cloud/text_cloud.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/folder_kind.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

/// Opens a source as the first kind of the extras' that it is of; null if it is of none.
std::unique_ptr<Recording> OpenAsKind(RecordingKind::Open RecordingKind::*open,
                                      const std::filesystem::path& source) {
  for (const RecordingKind& kind : RecordingExtras::Get().kinds) {
    if (kind.*open == nullptr) continue;
    if (auto recording = (kind.*open)(source)) return recording;
  }
  return nullptr;
}

/// Throws an error that names what to open instead if the directory is of a run of several sensors.
void CheckIsOfOneSensor(const std::filesystem::path& directory) {
  const auto folders = SensorFoldersIn(directory);
  if (folders.empty()) return;
  std::string all;
  for (const std::filesystem::path& folder : folders) all += ShownPath(folder) + ", ";
  const auto merged = MergedFolderIn(directory);
  throw InputError(ShownPath(directory) + ": holds several sensors; must be one of " +
                   (merged ? all + ShownPath(merged->folder) : all.substr(0, all.size() - 2)));
}

/// The extensions of clouds that are read, but not written.
std::vector<std::string> ReadOnlyExtensions(bool with_tables) {
  std::vector<std::string> extensions = TextCloudEndings(with_tables);
  extensions.insert(extensions.begin(), ".las");
  return extensions;
}

/// Throws an error about the first file of a directory that is of a known format which is not read.
void RefuseUnread(const std::filesystem::path& directory) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) files.insert(entry);
  for (const std::filesystem::path& file : files) {
    const std::string advice = AdviceOnFile(file, false);
    if (!advice.empty()) throw InputError(ShownPath(file) + ": " + advice);
  }
}

/// Files of recordings that an extra reads, by their endings.
struct RecordingOfExtra {
  std::string_view extension;
  std::string_view extra;
};
constexpr auto kRecordingsOfExtras = std::to_array<RecordingOfExtra>(
    {{".pcap", "packets"}, {".pcapng", "packets"}, {".mcap", "ros"}, {".db3", "ros"}});

/// Whether this build reads files of an ending.
bool IsRead(std::string_view extension) {
  return std::ranges::any_of(RecordingExtras::Get().kinds, [&](const RecordingKind& kind) {
    return std::ranges::count(kind.extensions, extension) > 0;
  });
}

/// A file, or what stands before one of the colons of its name if that is one, has the ending; or
/// one of the files of a directory.
bool HasExtension(const std::filesystem::path& source, std::string_view extension) {
  const auto has = [&](const std::filesystem::path& file) {
    std::error_code error;
    return is_regular_file(file, error) && LowerCase(file.extension().string()) == extension;
  };
  if (is_directory(source)) {
    return std::ranges::any_of(std::filesystem::directory_iterator(source), has);
  }
  const std::string text = source.string();
  for (std::size_t end = text.size(); end != std::string::npos && end > 0;
       end = text.rfind(':', end - 1)) {
    if (has(text.substr(0, end))) return true;
  }
  return false;
}

/// Opens a directory that was written by railcast-generate insert, or its folder of clouds; null if
/// it is neither.
std::unique_ptr<Recording> OpenIfInserted(const std::filesystem::path& directory) {
  const RecordingExtras& extras = RecordingExtras::Get();
  if (extras.open_inserted != nullptr) return extras.open_inserted(directory);
  for (const std::filesystem::path& file :
       {directory / kInsertFile, directory / ".." / kInsertFile}) {
    if (exists(file)) throw LacksExtra(ShownPath(directory), "insert");
  }
  return nullptr;
}

/// Opens a directory of clouds: side by side, or in the layout of a sequence, of an insertion, of
/// merged clouds, of a received stream or of KITTI.
std::unique_ptr<Recording> OpenDirectory(const std::filesystem::path& directory) {
  // A run without frames.jsonl is opened as a sequence, too, so that its loss is reported: the
  // clouds alone cannot be checked.
  const bool is_of_run = exists(directory / kRunFile) && exists(directory / kScenarioFile);
  if (is_of_run || exists(directory / kFramesFile)) return OpenSequence(directory);
  if (auto inserted = OpenIfInserted(directory)) return inserted;
  if (exists(directory / kMergedFile)) return OpenMerged(directory);
  CheckIsOfOneSensor(directory);
  if (exists(directory / kDatasetFile)) {
    throw InputError(ShownPath(directory) +
                     ": is a data set; must be one of its sequences, such as " +
                     ShownPath(directory / SequenceFolderOf(0)));
  }
  if (auto clouds = OpenCloudsIn(directory)) return clouds;
  if (auto found = OpenAsKind(&RecordingKind::open, directory)) return found;
  CheckExtraIsThere(directory);
  RefuseUnread(directory);
  const FolderKind* const kind = FindFolderKind(directory);
  throw InputError(ShownPath(directory) + ": must be a sequence or hold " +
                   ReadableExtensions(true, ReadOnlyExtensions(false)) + " files (got " +
                   std::string(kind == nullptr ? "neither" : kind->what) + ")");
}

/// Gathers the remarks of the frames of another recording.
class RemarkingRecording : public Recording {
 public:
  explicit RemarkingRecording(std::unique_ptr<Recording> recording)
      : recording_(std::move(recording)) {}

  [[nodiscard]] const RecordingInfo& info() const override { return recording_->info(); }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto read = recording_->Next();
    if (!read) return std::nullopt;
    return [read = std::move(*read), remarks = info().remarks] {
      RecordedFrame recorded = read();
      if (!recorded.why_no_ranges.empty()) {
        AddRemark({.kind = RemarkKind::kRangesUnknown,
                   .place = recorded.name,
                   .detail = recorded.why_no_ranges},
                  recorded.remarks);
      }
      // Remarks on the recording as a whole come first.
      for (const Remark& remark : recorded.remarks) remarks->Add(remark, recorded.frame.index + 1U);
      recorded.remarks.clear();
      return recorded;
    };
  }

 private:
  std::unique_ptr<Recording> recording_;
};

/// Opens clouds of KITTI's layout with other numbers a point, or in text with named columns.
std::unique_ptr<Recording> OpenColumns(const std::filesystem::path& source,
                                       const std::filesystem::path& clouds,
                                       const std::string& columns) {
  if (auto recording = OpenCloudsIn(source)) return recording;
  if (!is_directory(clouds)) return OpenClouds(source, "point cloud file", {clouds});
  throw InputError(ShownPath(clouds) + ": must hold " +
                   (IsTextColumns(columns) ? "clouds in text" : ".bin files") +
                   " for their columns to be chosen");
}

std::unique_ptr<Recording> OpenAny(const std::filesystem::path& source) {
  if (auto found = OpenAsKind(&RecordingKind::open_more, source)) return found;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(source, error);
  if (!exists(status)) {
    const auto [clouds, columns] = KittiSourceOf(source);
    if (!columns.empty()) return OpenColumns(source, clouds, columns);
    if (auto series = OpenCloudsIn(source)) return series;
    if (auto found = OpenAsKind(&RecordingKind::open_part, source)) return found;
    CheckExtraIsThere(source);
    throw FileError(source, error ? error.value() : ENOENT);
  }
  if (is_directory(status)) return OpenDirectory(source);
  // Packed files and pointers may have the names of what they stand for.
  if (const std::string advice = AdviceOnFile(source); !advice.empty()) {
    throw InputError(ShownPath(source) + ": " + advice);
  }
  if (IsCloudFile(source)) return OpenClouds(source, "point cloud file", {source});
  if (auto found = OpenAsKind(&RecordingKind::open, source)) return found;
  CheckExtraIsThere(source);
  std::vector<std::string> extensions = ReadOnlyExtensions(true);
  for (const RecordingKind& kind : RecordingExtras::Get().kinds) {
    extensions.insert(extensions.end(), kind.extensions.begin(), kind.extensions.end());
  }
  throw InputError(ShownPath(source) + ": must be a directory or a " +
                   ReadableExtensions(true, extensions) + " file");
}

}  // namespace

std::filesystem::path TopicOfBag(const std::filesystem::path& bag, const std::string& topic) {
  const std::string mark(kTopicMark, 0, kTopicMark.size() - (topic.starts_with('/') ? 1 : 0));
  return bag.native() + mark + topic;
}

void CheckExtraIsThere(const std::filesystem::path& source) {
  for (const auto& [extension, extra] : kRecordingsOfExtras) {
    if (IsRead(extension) || !HasExtension(source, extension)) continue;
    throw LacksExtra(ShownPath(source), std::string(extra));
  }
}

bool IsBagOfTopics(const std::filesystem::path& source) {
  return RecordingExtras::Get().IsOf("--topic", source);
}

std::unique_ptr<Recording> OpenRecording(const std::filesystem::path& source) {
  return std::make_unique<RemarkingRecording>(OpenAny(source));
}

}  // namespace railcast
