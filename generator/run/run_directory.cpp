#include "generator/run/run_directory.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/kitti.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/fixed_file.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/table_records.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/findings.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::set<std::uint32_t> MovingInstances(const std::vector<ObjectInFrame>& objects) {
  std::set<std::uint32_t> moving;
  for (const ObjectInFrame& object : objects) {
    if (IsMoving(object.velocity_world_mps)) moving.insert(object.instance);
  }
  return moving;
}

// Returns the number in the name of a frame's file: 12 for "frames/000012.pcd".
std::optional<std::uint32_t> FrameNumber(std::string_view name) {
  name.remove_prefix(name.rfind('/') + 1);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end == name.data()) return std::nullopt;
  return number;
}

// The line files of a run in the order in which they are written; frames.jsonl is the last, and
// those of motion sensors are before it.
std::vector<LineFileName> LineFileNames(const SequenceSpec& spec) {
  const FrameFormat& format = *spec.files.format;
  std::vector<LineFileName> names = {{std::string(kPosesFile), std::string(kPosesHeader)},
                                     {std::string(kObjectsFile), ""}};
  if (format.dataset) {
    for (const std::string_view name : format.dataset->record_files) {
      names.push_back({std::string(name), ""});
    }
  }
  if (spec.motion_sensors) {
    for (const MotionFile& file : MotionFilesOf(*spec.motion_sensors)) {
      names.push_back({MotionFileName(file.sensor), file.header});
    }
  }
  names.push_back({std::string(kFramesFile), ""});
  return names;
}

// How many lines a frame has in each line file but frames.jsonl: one, and those that it names of
// motion sensors.
std::vector<std::uint32_t> NumLinesOf(const SequenceSpec& spec, const FrameRecord& record) {
  const std::size_t num_motion =
      spec.motion_sensors ? MotionFilesOf(*spec.motion_sensors).size() : 0;
  std::vector<std::uint32_t> num_lines(LineFileNames(spec).size() - 1 - num_motion, 1);
  num_lines.insert(num_lines.end(), record.motion_lines.begin(), record.motion_lines.end());
  return num_lines;
}

/// The names of a run's files.
class OwnNames {
 public:
  /// @param fixed The files that are known before the first frame.
  OwnNames(const SequenceSpec& spec, const std::vector<FixedFile>& fixed) : spec_(spec) {
    names_ = {std::string(kManifestFile)};
    for (const FixedFile& file : fixed) names_.insert(file.name);
    for (const LineFileName& file : LineFileNames(spec)) names_.insert(file.name);
  }

  [[nodiscard]] bool Have(std::string_view name) const {
    if (names_.contains(name) || (!spec_.bag.empty() && IsOfBag(name))) return true;
    if (!spec_.trace.empty() && name == spec_.trace) return true;
    const std::optional<std::uint32_t> number = FrameNumber(name);
    const bool is_counted = spec_.files.format->dataset.has_value();
    const std::uint32_t first = is_counted ? 0 : spec_.start_frame;
    const std::uint32_t step = is_counted ? 1 : spec_.stride;
    if (!number || *number < first || (*number - first) % step != 0) return false;
    if ((*number - first) / step >= spec_.num_frames) return false;
    std::vector<std::string> names = FrameFileNames(*spec_.files.format, *number);
    if (!spec_.camera.empty()) {
      for (std::string& image : CameraFileNames(spec_.camera, *number)) {
        names.push_back(std::move(image));
      }
    }
    return std::ranges::find(names, name) != names.end();
  }

 private:
  const SequenceSpec& spec_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace

RunDirectory::RunDirectory(SequenceSpec spec, std::uint32_t most_done)
    : spec_(std::move(spec)),
      most_done_(std::min(most_done, spec_.num_frames)),
      lines_(spec_.directory, LineFileNames(spec_)),
      trace_(spec_.make_trace ? spec_.make_trace() : nullptr) {
  const fs::path run_file = spec_.directory / kRunFile;
  const fs::path manifest = spec_.directory / kManifestFile;
  const bool is_run = fs::exists(run_file);
  is_complete_ = is_run && fs::exists(manifest);
  if (is_run) CheckIsSameRun(spec_, is_complete_);
  CheckNames(is_run);
  if (!is_run) WriteFileWhole(run_file, RunJson(spec_));
  if (is_complete_) {
    CountFrames();
    const std::string changed = WhatChanged();
    if (changed.empty()) return;
    changed_ = {ShownPath(spec_.directory) + ": " + changed + " was changed or removed"};
    // The messages of an MCAP trace are known to be whole, but not what is around them.
    if (fs::path(spec_.trace).extension() == ".mcap") fs::remove(spec_.directory / spec_.trace);
    fs::remove(manifest);
    is_complete_ = false;
  }
  WriteFixedFiles();
  CountFrames();
  if (trace_) OpenTrace();
  lines_.Open();
}

void RunDirectory::CheckNames(bool is_run) const {
  const OwnNames own(spec_, FixedFiles());
  std::string stranger;
  std::vector<fs::path> unfinished;
  ForEachFileBelow(spec_.directory, spec_.directory, {}, [&](const std::string& name) {
    const std::optional<std::string_view> finished = FinishedName(name);
    // A run that was stopped before its first file was complete leaves an unfinished run.json.
    const bool is_own = is_run ? own.Have(name) || (finished && own.Have(*finished))
                               : finished == std::string_view(kRunFile);
    // If there are several, the first by its name is told, whatever order the system has.
    if (!is_own && (stranger.empty() || name < stranger)) stranger = name;
    // A mesh may have a name that ends so, too.
    if (!finished || own.Have(name)) return;
    // An unfinished bag or trace is continued.
    const bool is_kept = IsOfBag(*finished) || *finished == spec_.trace;
    if (is_kept && !fs::exists(spec_.directory / *finished)) return;
    unfinished.push_back(spec_.directory / name);
  });
  if (!stranger.empty()) RefuseStranger(spec_.directory, stranger);
  for (const fs::path& file : unfinished) fs::remove(file);
}

void RunDirectory::CountFrames() {
  if (trace_) trace_->Find();
  counts_ = {};
  if (spec_.certify) certificates_.emplace(*spec_.certify);
  std::optional<FrameRecord> record;
  const auto read = [&](std::uint32_t i, std::string_view line) -> std::optional<LedgerItem> {
    record = ParseFrameLine(line);
    if (!record || record->frame != spec_.FrameAt(i)) return std::nullopt;
    if (trace_ && trace_->NextHash() != record->clouds_hash) return std::nullopt;
    return LedgerItem{record->files, record->records_hash, NumLinesOf(spec_, *record)};
  };
  num_done_ = lines_.Count(most_done_, read, [&](std::string_view records) {
    AddRecord(*record);
    if (first_pose_) return;
    first_pose_ = ReadPoseRecord(records.substr(0, records.find('\n') + 1),
                                 ShownPath(spec_.directory / kPosesFile));
  });
}

void RunDirectory::AddRecord(const FrameRecord& record) {
  counts_.Add(record.counts);
  if (certificates_ && record.certificate) certificates_->Add(*record.certificate);
}

std::optional<RunCertificate> RunDirectory::certificate() const {
  if (!certificates_) return std::nullopt;
  return certificates_->Result(spec_.files.labels);
}

void RunDirectory::OpenTrace() {
  const auto num_messages = static_cast<std::uint32_t>(trace_->Open(num_done_));
  if (num_messages == num_done_) return;
  // The end of the last message is missing: its frame is made anew.
  most_done_ = num_messages;
  CountFrames();
}

std::string RunDirectory::WhatChanged() const {
  const fs::path& directory = spec_.directory;
  if (num_done_ < spec_.num_frames) return "frame " + std::to_string(spec_.FrameAt(num_done_));
  std::string lines = lines_.FileWithOthers();
  if (!lines.empty()) return lines;
  for (const FixedFile& file : FixedFiles()) {
    if (!HasFixedFile(directory, file)) return file.name;
  }
  const FixedFile manifest = FixedText(std::string(kManifestFile), ManifestJson());
  return HasFixedFile(directory, manifest) ? "" : manifest.name;
}

std::vector<FixedFile> RunDirectory::FixedFiles() const {
  std::vector<FixedFile> files;
  const auto add = [&files](std::string_view name, std::string text) {
    files.push_back(FixedText(std::string(name), std::move(text)));
  };
  add(kRunFile, RunJson(spec_));  // It may have the same content in other bytes.
  add(kScenarioFile, spec_.identity.scenario_json);
  for (const InputFile& input : spec_.identity.inputs) files.push_back(input.Copy());
  add(kLabelsFile, LabelsJson(spec_.files.labels));
  add(kMaterialsFile, MaterialsJson(spec_.materials));
  if (!spec_.commands_jsonl.empty()) add(kCommandsFile, spec_.commands_jsonl);
  if (!spec_.camera.empty()) add(CalibrationFileName(spec_.camera), spec_.calibration_json);
  if (const auto& dataset = spec_.files.format->dataset) {
    for (FrameFile& file : dataset->fixed_files(spec_.files.labels)) {
      add(file.name, std::move(file.bytes));
    }
  }
  return files;
}

void RunDirectory::WriteFixedFiles() {
  const fs::path& directory = spec_.directory;
  for (const FrameFileKind& file : spec_.files.format->files) {
    MakeFolders((directory / file.folder).parent_path());
  }
  if (spec_.motion_sensors) MakeFolders(directory / kMotionFolder);
  if (!spec_.camera.empty()) {
    for (const std::string& name : CameraFileNames(spec_.camera, 0)) {
      MakeFolders((directory / name).parent_path());
    }
  }
  for (const FixedFile& file : FixedFiles()) {
    const bool is_input = file.name.starts_with(kInputsFolder);
    WriteFixedFile(directory, file, is_input ? spec_.twin : fs::path());
  }
}

std::vector<std::string> RunDirectory::RecordLines(const EncodedFrame& frame) {
  const PoseRecord& pose = frame.pose;
  if (!first_pose_) first_pose_ = pose;
  std::vector<std::string> lines = {PoseLine(pose), frame.objects_line};
  if (const auto& dataset = spec_.files.format->dataset) {
    // Computed from the values of poses.csv, so that a resumed run uses the same numbers.
    for (std::string& line :
         dataset->record_lines(first_pose_->WorldFromSensor().inverse() * pose.WorldFromSensor(),
                               SecondsFromNs(pose.stamp_ns - first_pose_->stamp_ns))) {
      lines.push_back(std::move(line));
    }
  }
  lines.insert(lines.end(), frame.motion_lines.begin(), frame.motion_lines.end());
  return lines;
}

void RunDirectory::Encode(const MadeFrame& made, EncodedFrame& encoded) const {
  const Frame& frame = made.frame;
  const std::uint32_t number =
      spec_.files.format->dataset ? (frame.index - spec_.start_frame) / spec_.stride : frame.index;
  EncodeFrameFiles(frame, spec_.files, number, encoded.files, MovingInstances(made.objects));
  if (made.has_image) {
    for (FrameFile& file : EncodeCameraFiles(made.image, spec_.camera, number)) {
      encoded.files.push_back(std::move(file));
    }
  }
  encoded.record = {.frame = frame.index,
                    .stamp_ns = frame.stamp_ns,
                    .scan_poses = ScanPosesOf(frame),
                    .files = {},
                    .records_hash = {},
                    .motion_lines = {},
                    .counts = CountFrame(frame, spec_.files.labels),
                    .certificate = made.certificate};
  if (trace_) {
    encoded.trace_message = trace_->Encode(made);
    encoded.record.clouds_hash = ContentHash(encoded.trace_message);
  }
  encoded.record.files = KnownFilesOf(encoded.files);
  encoded.pose = PoseRecord(frame.stamp_ns, frame.world_from_sensor);
  encoded.objects_line = ObjectsLine(frame, made.objects);
  encoded.motion_lines = MotionLinesOf(made.motion);
  for (const std::string& lines : encoded.motion_lines) {
    encoded.record.motion_lines.push_back(
        static_cast<std::uint32_t>(std::ranges::count(lines, '\n')));
  }
}

void RunDirectory::Write(const EncodedFrame& frame) {
  FrameRecord record = frame.record;
  Check(record.frame == spec_.FrameAt(num_done_), "frames are written in their order");
  for (const FrameFile& file : frame.files) {
    WriteFileWhole(spec_.directory / file.name, file.bytes);
  }
  if (trace_) trace_->Append(record.stamp_ns, frame.trace_message);
  lines_.Append(RecordLines(frame), [&](std::string records_hash) {
    record.records_hash = std::move(records_hash);
    return HashedRecordLine(record);
  });
  AddRecord(record);
  ++num_done_;
}

void RunDirectory::Finish() {
  Check(num_done_ == spec_.num_frames, "only a complete run has a manifest");
  lines_.Sync();
  if (trace_) trace_->Close();
  WriteFileWhole(spec_.directory / kManifestFile, ManifestJson());
  is_complete_ = true;
}

std::string RunDirectory::ManifestJson() const {
  ManifestRecord manifest{.version = spec_.version,
                          .seed = spec_.seed,
                          .format = std::string(spec_.files.format->name),
                          .start_frame = spec_.start_frame,
                          .num_frames = spec_.num_frames,
                          .counts = counts_,
                          .certificate = certificate()};
  if (!spec_.fidelity_choice_json.empty()) {
    manifest.fidelity_choice = Json::parse(spec_.fidelity_choice_json);
  }
  // frames.jsonl holds the hash of every frame's files, so these hashes cover the whole content.
  std::vector<std::string> names;
  for (const FixedFile& file : FixedFiles()) names.push_back(file.name);
  for (const LineFileName& file : LineFileNames(spec_)) names.push_back(file.name);
  if (!spec_.trace.empty()) names.push_back(spec_.trace);
  for (const std::string& name : names) {
    // With thousands of objects, their file is larger than the memory may be.
    manifest.files.emplace_back(name, HashFile(spec_.directory / name).hash);
  }
  manifest.data_hash = DataHash(manifest.files);
  return WithManifestHash(RecordFile(manifest));
}

}  // namespace railcast
