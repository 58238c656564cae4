#include "generator/sequence_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/shown_text.h"
#include "core/base/units.h"
#include "core/io/content_hash.h"
#include "core/io/kitti.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"
#include "generator/counts_json.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

void CreateDirectories(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw FileError(directory, error.value());
}

// A run that was killed a moment ago may still hold the lock while the system clears it away.
bool Lock(int directory) {
  constexpr int kTries = 20;
  constexpr std::chrono::milliseconds kPause(50);
  for (int i = 0; i < kTries; ++i) {
    if (::flock(directory, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(kPause);
  }
  return false;
}

bool HasBytes(const fs::path& file, std::string_view bytes) {
  return fs::exists(file) && ReadFileWhole(file) == bytes;
}

std::set<std::uint32_t> MovingInstances(const std::vector<ObjectInFrame>& objects) {
  constexpr double kRounding_mps = 1e-6;
  std::set<std::uint32_t> moving;
  for (const ObjectInFrame& object : objects) {
    if (object.velocity_world_mps.norm() > kRounding_mps) moving.insert(object.instance);
  }
  return moving;
}

// The files below a directory, relative to it. A link is a file, whatever it leads to.
std::vector<std::string> FilesBelow(const fs::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  fs::recursive_directory_iterator entry(directory, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    if (fs::is_directory(entry->symlink_status(error)) || error) continue;
    names.push_back(entry->path().lexically_relative(directory).generic_string());
  }
  if (error) throw FileError(directory, error.value());
  std::ranges::sort(names);
  return names;
}

// "frames/000012.pcd" of "frames/000012.pcd.part", else nothing.
std::optional<std::string_view> FinishedName(std::string_view name) {
  if (!name.ends_with(kUnfinishedSuffix)) return std::nullopt;
  return name.substr(0, name.size() - kUnfinishedSuffix.size());
}

// The number in the name of a frame's file: 12 in "frames/000012.pcd".
std::optional<std::uint32_t> FrameNumber(std::string_view name) {
  name.remove_prefix(name.rfind('/') + 1);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end == name.data()) return std::nullopt;
  return number;
}

/// What the files of a run are called.
class OwnNames {
 public:
  /// @param fixed Those that are known before the first frame.
  OwnNames(const SequenceSpec& spec, const std::vector<FrameFile>& fixed) : spec_(spec) {
    names_ = {std::string(kRunFile), std::string(kManifestFile)};
    for (const FrameFile& file : fixed) names_.insert(file.name);
    for (const LineFileName& file : LineFileNames(spec.files.format)) names_.insert(file.name);
  }

  [[nodiscard]] bool Have(std::string_view name) const {
    if (names_.contains(name)) return true;
    const std::optional<std::uint32_t> number = FrameNumber(name);
    const std::uint32_t first = spec_.files.format == FrameFormat::kKitti ? 0 : spec_.start_frame;
    if (!number || *number < first || *number - first >= spec_.num_frames) return false;
    const std::vector<std::string> names = FrameFileNames(spec_.files.format, *number);
    return std::ranges::find(names, name) != names.end();
  }

 private:
  const SequenceSpec& spec_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace

SequenceDirectory::SequenceDirectory(SequenceSpec spec) : spec_(std::move(spec)) {
  CreateDirectories(spec_.directory);
  lock_ = ::open(spec_.directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) throw FileError(spec_.directory, errno);
  try {
    Open();
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

SequenceDirectory::~SequenceDirectory() {
  ::close(lock_);
}

void SequenceDirectory::Open() {
  if (!Lock(lock_)) {
    throw InputError(ShownPath(spec_.directory) + ": another run is writing here");
  }
  const fs::path run_file = spec_.directory / kRunFile;
  const bool is_run = fs::exists(run_file);
  is_complete_ = is_run && fs::exists(spec_.directory / kManifestFile);
  if (is_run) CheckSameRun(spec_, ReadFileWhole(run_file), is_complete_);
  RefuseStrangers(is_run);
  if (!is_run) WriteFileWhole(run_file, RunJson(spec_));
  Resume();
}

// A stranger's file could be taken for the run's, or be lost with what the run clears away.
void SequenceDirectory::RefuseStrangers(bool is_run) const {
  const OwnNames own(spec_, FixedFiles());
  for (const std::string& name : FilesBelow(spec_.directory)) {
    const std::optional<std::string_view> finished = FinishedName(name);
    // A run that was stopped before its first file was whole leaves that file unfinished.
    const bool is_own = is_run ? own.Have(name) || (finished && own.Have(*finished))
                               : finished == std::string_view(kRunFile);
    if (is_own) continue;
    throw InputError(ShownPath(spec_.directory) +
                     ": holds a file that does not belong to this run (" + ShownPath(name) +
                     "); move it away or choose another --out");
  }
}

void SequenceDirectory::RemoveUnfinished() const {
  const OwnNames own(spec_, FixedFiles());
  for (const std::string& name : FilesBelow(spec_.directory)) {
    // A mesh may be called so, too.
    if (FinishedName(name) && !own.Have(name)) fs::remove(spec_.directory / name);
  }
}

void SequenceDirectory::Resume() {
  if (!is_complete_) {
    WriteFixedFiles();
    RemoveUnfinished();
  }
  const SequenceProgress progress = FindProgress(spec_);
  num_done_ = progress.num_done;
  counts_ = progress.counts;
  if (num_done_ > 0) first_pose_ = ParsePoseLine(progress.first_pose_line);
  if (is_complete_) return CheckUnchanged(progress);
  const std::vector<LineFileName> names = LineFileNames(spec_.files.format);
  for (std::size_t i = 0; i < names.size(); ++i) {
    line_files_.emplace_back(spec_.directory / names[i].name, progress.keep_bytes[i]);
    if (progress.keep_bytes[i] == 0) line_files_.back().Append(names[i].header);
  }
}

void SequenceDirectory::CheckUnchanged(const SequenceProgress& progress) const {
  const fs::path& directory = spec_.directory;
  const auto check = [&](bool is_unchanged, const std::string& what) {
    if (is_unchanged) return;
    throw InputError(ShownPath(directory) + ": is complete, but " + what +
                     " was changed or removed; delete manifest.json to make it anew");
  };
  check(num_done_ == spec_.num_frames, "frame " + std::to_string(spec_.start_frame + num_done_));
  const std::vector<LineFileName> names = LineFileNames(spec_.files.format);
  for (std::size_t i = 0; i < names.size(); ++i) {
    check(fs::file_size(directory / names[i].name) == progress.keep_bytes[i], names[i].name);
  }
  check(HasBytes(directory / kRunFile, RunJson(spec_)), std::string(kRunFile));
  for (const auto& [name, bytes] : FixedFiles()) check(HasBytes(directory / name, bytes), name);
  check(HasBytes(directory / kManifestFile, ManifestJson()), std::string(kManifestFile));
}

std::vector<FrameFile> SequenceDirectory::FixedFiles() const {
  std::vector<FrameFile> files;
  const auto add = [&files](std::string_view name, std::string bytes) {
    files.push_back({std::string(name), std::move(bytes)});
  };
  add(kScenarioFile, spec_.identity.scenario_json);
  for (const InputFile& input : spec_.identity.inputs) add(input.CopyName(), input.bytes);
  add(kLabelsFile, LabelsJson(spec_.files.labels));
  add(kMaterialsFile, MaterialsJson(spec_.materials));
  if (!spec_.commands_jsonl.empty()) add(kCommandsFile, spec_.commands_jsonl);
  if (spec_.files.format == FrameFormat::kKitti) {
    add(kKittiCalibrationFile, KittiCalibration());
    add(kKittiLabelsFile, SemanticKittiYaml(spec_.files.labels));
  }
  return files;
}

void SequenceDirectory::WriteFixedFiles() {
  const fs::path& directory = spec_.directory;
  if (spec_.files.format == FrameFormat::kKitti) {
    CreateDirectories(directory / "sequences/00/velodyne");
    CreateDirectories(directory / "sequences/00/labels");
  } else {
    CreateDirectories(directory / "frames");
  }
  // It may say the same in other bytes.
  if (!HasBytes(directory / kRunFile, RunJson(spec_))) {
    WriteFileWhole(directory / kRunFile, RunJson(spec_));
  }
  for (const auto& [name, bytes] : FixedFiles()) {
    CreateDirectories((directory / name).parent_path());
    WriteFileWhole(directory / name, bytes);
  }
}

std::vector<std::string> SequenceDirectory::RecordLines(const Frame& frame,
                                                        const std::vector<ObjectInFrame>& objects) {
  const PoseRecord pose(frame.stamp_ns, frame.world_from_sensor);
  if (!first_pose_) first_pose_ = pose;
  std::vector<std::string> lines = {PoseLine(pose), ObjectsLine(frame, objects)};
  if (spec_.files.format == FrameFormat::kKitti) {
    // Both from what poses.csv says, so that a resumed run computes with the same numbers.
    lines.push_back(
        KittiPoseLine(first_pose_->WorldFromSensor().inverse() * pose.WorldFromSensor()));
    lines.push_back(NumberText(SecondsFromNs(pose.stamp_ns - first_pose_->stamp_ns)) + "\n");
  }
  return lines;
}

void SequenceDirectory::Write(const Frame& frame, const std::vector<ObjectInFrame>& objects) {
  Check(frame.index == spec_.start_frame + num_done_, "frames are written in their order");
  const bool is_kitti = spec_.files.format == FrameFormat::kKitti;
  EncodeFrameFiles(frame, spec_.files, is_kitti ? num_done_ : frame.index, frame_files_,
                   is_kitti ? MovingInstances(objects) : std::set<std::uint32_t>{});

  FrameRecord record;
  record.frame = frame.index;
  record.stamp_ns = frame.stamp_ns;
  record.scan_end = ScanEndOf(frame);
  record.counts = CountFrame(frame, spec_.files.labels);
  for (const FrameFile& file : frame_files_) {
    record.files.push_back({file.name, file.bytes.size(), ContentHash(file.bytes)});
    WriteFileWhole(spec_.directory / file.name, file.bytes);
  }
  const std::vector<std::string> lines = RecordLines(frame, objects);
  std::string all_lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    line_files_[i].Append(lines[i]);
    all_lines += lines[i];
  }
  record.records_hash = ContentHash(all_lines);
  line_files_.back().Append(FrameLine(record));
  counts_.Add(record.counts);
  ++num_done_;
}

void SequenceDirectory::Finish() {
  Check(num_done_ == spec_.num_frames, "only a complete run has a manifest");
  for (LineFile& file : line_files_) file.Sync();
  WriteFileWhole(spec_.directory / kManifestFile, ManifestJson());
  is_complete_ = true;
}

std::string SequenceDirectory::ManifestJson() const {
  nlohmann::ordered_json manifest = {{"version", spec_.version},
                                     {"seed", spec_.seed},
                                     {"format", FrameFormatName(spec_.files.format)},
                                     {"start_frame", spec_.start_frame},
                                     {"num_frames", spec_.num_frames}};
  if (!spec_.fidelity_choice_json.empty()) {
    manifest["fidelity_choice"] = nlohmann::ordered_json::parse(spec_.fidelity_choice_json);
  }
  PutCounts(counts_, manifest);
  // frames.jsonl names the hash of every frame's files: these hashes are over all there is. That of
  // the data leaves out which program made them.
  std::vector<KnownFile> known;
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  std::vector<std::string> names = {std::string(kRunFile)};
  for (const FrameFile& file : FixedFiles()) names.push_back(file.name);
  for (const LineFileName& file : LineFileNames(spec_.files.format)) names.push_back(file.name);
  for (const std::string& name : names) {
    const std::string hash = ContentHash(ReadFileWhole(spec_.directory / name));
    files[name] = hash;
    known.push_back({name, hash, {}});
  }
  manifest["files_xxh3"] = files;
  manifest["data_xxh3"] = DataHash(known);
  return WithManifestHash(manifest.dump(2) + "\n");
}

}  // namespace railcast
