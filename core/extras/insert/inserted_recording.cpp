#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/insert/insert_record.h"
#include "core/extras/insert/insertion_verification.h"
#include "core/io/cloud/kitti.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_record.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What all frames of an insertion share.
struct InsertedContext {
  fs::path directory;
  LabelTable labels;  ///< The labels that objects.jsonl names.
  LabelTable kitti;   ///< SemanticKITTI's if the clouds have these, else empty.
};

/// Gives the points of a cloud without labels or instances those of its rows in points/NNNNNN.npy.
void TakeRows(const std::string& rows, const std::string& place, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  std::vector<std::uint32_t> slots = recorded.slot_of_entry;
  if (slots.empty()) {  // Captures have none.
    for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (!std::isnan(frame.x[slot])) slots.push_back(slot);
    }
  }
  const std::string header = NpyHeader(kInsertPointType, "(" + NumberText(slots.size()) + ",)");
  if (!rows.starts_with(header) ||
      rows.size() != header.size() + kInsertPointBytes * slots.size()) {
    throw InputError(place + ": must have a row for each of the " + NumberText(slots.size()) +
                     " points of its cloud");
  }
  const bool has_label = !recorded.fields.emplace("label").second;
  const bool has_instance = !recorded.fields.emplace("instance").second;
  const char* row = rows.data() + header.size();
  for (const std::uint32_t slot : slots) {
    if (slot != kNoSlot && !has_label) std::memcpy(&frame.label[slot], row, 4);
    if (slot != kNoSlot && !has_instance) std::memcpy(&frame.instance[slot], row + 4, 4);
    row += kInsertPointBytes;
  }
}

RecordedFrame ReadInsertedFrame(const InsertedContext& context,
                                const FrameLines& lines,
                                const Recording::FrameReader& read) {
  const FrameRecord line = ReadInsertLine(lines.frame.text, lines.frame.place).frame;
  RecordedFrame recorded = read();
  for (const KnownFile& file : line.files) {
    const std::string bytes = ReadHashedFile(context.directory, file, kInsertFile);
    if (!file.name.starts_with(kInsertPointsFolder)) continue;
    TakeRows(bytes, ShownPath(context.directory / file.name), recorded);
  }
  recorded.frame.index = line.frame;
  TakeRecords(line, lines, recorded);
  if (context.kitti.labels().empty()) return recorded;
  recorded.axes = PointAxes::kSensorAtStamp;
  for (RecordedObject& object : recorded.objects) {
    object.label = KittiClassOf(object, context.labels, context.kitti);
  }
  return recorded;
}

/// The copy of an insertion's recording, with what it was opened with behind its name: a topic,
/// metadata or a sensor.
fs::path CopyIn(const fs::path& folder, const std::string& opened) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& copy = entry.path();
    const auto& kinds = RecordingExtras::Get().kinds;
    const auto kind =
        std::ranges::find_if(kinds, [&](const RecordingKind& one) { return one.is_of(copy); });
    if (kind == kinds.end()) continue;
    const std::string begin = copy.filename().string() + ":";
    const std::size_t mark = opened.rfind(begin);
    if (mark == std::string::npos) return copy;
    const std::string rest = opened.substr(mark + begin.size());
    return copy.string() +
           (kind->behind_copy == nullptr ? ":" + rest : kind->behind_copy(folder, rest));
  }
  throw InputError(ShownPath(folder) + ": must hold the recording that something was put into");
}

/// Checks what is read of all frames together, once the run is complete.
void CheckOwnFiles(const fs::path& directory) {
  const fs::path file = directory / kManifestFile;
  if (!IsThere(file)) return;
  const auto manifest = ReadRecord<InsertManifestRecord>(ReadManifestText(file), ShownPath(file));
  for (const std::string_view name : {kRunFile, kInsertWorldFile, kLabelsFile}) {
    const KnownFile known{std::string(name), HashOf(name, manifest.files, file), {}};
    (void)ReadHashedFile(directory, known, kManifestFile);
  }
}

/// The frames of a recording that something was put into, with what is known of them beside it.
class InsertionRecording : public Recording {
 public:
  explicit InsertionRecording(const fs::path& directory) : lines_(directory / kInsertFile) {
    CheckOwnFiles(directory);
    const auto run = ReadRecord<InsertRunRecord>(ReadFileWhole(directory / kRunFile),
                                                 ShownPath(directory / kRunFile));
    const fs::path folder = directory / kRecordingFolder;
    // Files that stay as they were have the columns that were chosen.
    const std::string columns = run.format == "same" ? ColumnsBehind(run.recording) : "";
    clouds_ = OpenCloudsIn(columns.empty() ? folder : fs::path(folder.string() + ":" + columns));
    is_copy_ = clouds_ == nullptr;
    if (is_copy_) clouds_ = OpenRecording(CopyIn(folder, run.recording));
    info_ = clouds_->info();
    info_.source = folder;
    info_.num_frames = CountLines(directory / kInsertFile);
    info_.scenario = ReadScenario(directory / kInsertWorldFile);
    info_.has_kitti_labels = info_.has_kitti_labels || run.has_kitti_labels;
    InsertedContext context{directory, ReadLabelTable(directory / kLabelsFile), {}};
    if (info_.labels.labels().empty()) {
      info_.labels = info_.has_kitti_labels ? SemanticKittiLabels(context.labels) : context.labels;
    }
    if (info_.has_kitti_labels) context.kitti = info_.labels;
    context_ = std::make_shared<const InsertedContext>(std::move(context));
    const std::vector<std::string> of_format = RecordFiles(run.format);
    for (std::size_t i = 0; i < of_format.size(); ++i) {
      // Behind poses and objects are those of the clouds.
      OpenLines((i < 2 ? directory : folder) / of_format[i], NumHeaders(of_format[i]));
    }
    if (exists(folder / kReceivedFile)) OpenLines(folder / kReceivedFile, 1);
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto frame = lines_.Next();
    if (!frame) return std::nullopt;
    FrameLines lines{0, std::move(*frame), {}};
    for (LineReader& records : records_) lines.records.push_back(records.Need());
    std::optional<FrameReader> read = clouds_->Next();
    if (is_copy_) {  // Which holds the frames before, too.
      is_copy_ = false;
      const std::uint32_t first = ReadInsertLine(lines.frame.text, lines.frame.place).frame.frame;
      for (std::uint32_t i = 0; read && i < first; ++i) read = clouds_->Next();
    }
    if (!read) {
      throw InputError(lines.frame.place + ": must be of a frame of " +
                       ShownPath(clouds_->info().source));
    }
    return [context = context_, lines = std::move(lines), read = std::move(*read)] {
      return ReadInsertedFrame(*context, lines, read);
    };
  }

 private:
  void OpenLines(const fs::path& file, std::size_t num_headers) {
    records_.emplace_back(file);
    for (std::size_t i = 0; i < num_headers; ++i) (void)records_.back().Need();
  }

  RecordingInfo info_;
  std::shared_ptr<const InsertedContext> context_;
  LineReader lines_;
  std::vector<LineReader> records_;
  std::unique_ptr<Recording> clouds_;
  bool is_copy_ = false;  ///< Whether frames must be skipped.
};

/// Opens what `railcast-generate insert` wrote: the frames that insert.jsonl names, checked against
/// its hashes, with the boxes of what was put in, the poses, and the labels and instances of
/// points/NNNNNN.npy where the clouds have none. The scenario is the plan on the recording's line.
/// A sequence into which something was put is opened as a sequence.
/// @param directory The one that was written, or its folder `recording`.
/// @return Null if it is neither, or was written by a program before 1.0.0.
/// @throws InputError as OpenSequence() does.
std::unique_ptr<Recording> OpenInserted(const fs::path& directory) {
  fs::path insertion = directory;
  if (!exists(insertion / kInsertFile)) {
    // A path may end in a slash.
    fs::path recording = directory.has_filename() ? directory : directory.parent_path();
    if (recording == ".") recording = fs::current_path();
    if (recording.filename() != kRecordingFolder) return nullptr;
    insertion = recording.parent_path();
  }
  const fs::path sequence = insertion / kRecordingFolder;
  if (insertion == directory && exists(sequence / kFramesFile)) return OpenSequence(sequence);
  if (!exists(insertion / kInsertFile) || !exists(insertion / kInsertWorldFile)) return nullptr;
  return std::make_unique<InsertionRecording>(insertion);
}

}  // namespace

void AddInsert(RecordingExtras& extras) {
  extras.open_inserted = OpenInserted;
  extras.verify["insert"] = VerifyInsertion;
}

}  // namespace railcast
