#include "core/io/verify/verification.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/content_hash.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/folder_kind.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/sequence_files.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/findings.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Files by which the folders of extras' commands are known, each with the extra.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kFilesOfExtras = {
    {{kDatasetFile, "recipe"}, {kInsertFile, "insert"}, {"convert.jsonl", "insert"}}};

/// Files that a manifest always names.
std::vector<std::string> NeededFiles(const RunRecord& run) {
  std::vector<std::string> names = RecordFiles(run.format);
  for (const std::string_view name :
       {kFramesFile, kRunFile, kScenarioFile, kLabelsFile, kMaterialsFile}) {
    names.emplace_back(name);
  }
  for (const KnownFile& file : run.Files()) names.push_back(file.name);
  for (const std::string& sensor : run.motion_sensors) names.push_back(MotionFileName(sensor));
  return names;
}

class Verifier : private Findings {
 public:
  Verifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : on_progress_(on_progress) {
    summary_.directory = directory;
    summary_.run = ReadRun(ReadFileWhole(directory / kRunFile), PathOf(kRunFile));
    known_ = {std::string(kRunFile), std::string(kManifestFile)};
  }

  Verification Run() {
    ReadTheManifest();
    if (summary_.manifest) CompareManifest();
    CheckKnownFiles();
    ReadLabels();
    are_frames_known_ = Try([&] { CheckFrames(); });
    if (summary_.run.bag) Try([&] { CheckBag(); });
    if (!summary_.run.trace.empty()) Try([&] { CheckTrace(); });
    Try([&] { FindOthers(); });
    return Take();
  }

 private:
  // The path as shown in messages.
  [[nodiscard]] std::string PathOf(std::string_view name) const {
    return ShownPath(summary_.directory / name);
  }
  void Fault(std::string_view name, const std::string& rule) {
    faults_.Add({PathOf(name), rule, ""});
  }

  void ReadTheManifest();
  void CompareManifest();
  void CheckKnownFiles();
  void ReadLabels();
  void CheckFile(const KnownFile& file, std::string_view said_in);
  void CheckCloud(const KnownFile& file,
                  const FrameRecord& line,
                  const FrameLines& lines,
                  const FrameFormat& format);
  void CompareCloud(const KnownFile& file,
                    const std::string& bytes,
                    const FrameRecord& line,
                    const FrameLines& lines,
                    const FrameFormat& format);
  void CheckFrames();
  [[nodiscard]] NextClouds CloudsOfFrames() const;
  void CheckBag();
  void CheckTrace();
  bool HasAllLines(std::string_view name);
  void CheckFrame(const FrameRecord& line, const FrameLines& lines, bool has_all_records);
  void CheckNames(const FrameRecord& line, const std::string& place);
  void FindOthers();

  const std::function<void(double)>& on_progress_;
  SequenceSummary summary_;
  std::optional<LabelTable> labels_;
  FrameCounts totals_;
  bool are_frames_known_ = false;
};

void Verifier::ReadTheManifest() {
  if (!IsThere(summary_.directory / kManifestFile)) {
    return Fault(kManifestFile, "missing: the run is unfinished");
  }
  Try([&] {
    const std::string text = ReadFileWhole(summary_.directory / kManifestFile);
    summary_.manifest = ReadManifest(text, PathOf(kManifestFile));
    CheckManifestHash(text, PathOf(kManifestFile));
  });
}

// The manifest's own hash shows that it is unchanged; only its contents show that it belongs to
// this run.
void Verifier::CompareManifest() {
  const RunRecord& run = summary_.run;
  const ManifestRecord& manifest = *summary_.manifest;
  const auto compare = [&](const char* key, const std::string& got, const std::string& expected) {
    if (got == expected) return;
    Fault(kManifestFile, std::string("/") + key + ": must be " + expected +
                             ", as run.json says (got " + ShownText(got) + ")");
  };
  compare("version", manifest.version, run.version);
  compare("seed", NumberText(manifest.seed), NumberText(run.seed));
  compare("format", manifest.format, run.format);
  compare("start_frame", NumberText(manifest.start_frame), NumberText(run.start_frame));
  compare("num_frames", NumberText(manifest.num_frames), NumberText(run.num_frames));
  for (const std::string& name : NeededFiles(run)) {
    Try([&] { (void)HashOf(name, manifest.files, summary_.directory / kManifestFile); });
  }
  const std::string data_hash = DataHash(manifest.files);
  if (manifest.data_hash == data_hash) return;
  Fault(kManifestFile, "/data_xxh3: must be " + data_hash + ", that of the files (got " +
                           ShownText(manifest.data_hash) + ")");
}

void Verifier::CheckKnownFiles() {
  const std::vector<KnownFile> of_run = summary_.run.Files();
  for (const KnownFile& file : of_run) CheckFile(file, kRunFile);
  if (!summary_.manifest) return;
  for (const KnownFile& file : summary_.manifest->Files()) {
    const auto same = [&](const KnownFile& other) {
      return other.name == file.name && other.hash == file.hash;
    };
    if (std::ranges::none_of(of_run, same)) CheckFile(file, kManifestFile);
  }
}

// What is wrong with the file has been said if a manifest names it.
void Verifier::ReadLabels() {
  ErrorList known;
  labels_ = Attempt("", summary_.manifest ? known : faults_,
                    [&] { return ReadLabelTable(summary_.directory / kLabelsFile); });
}

void Verifier::CheckFile(const KnownFile& file, std::string_view said_in) {
  known_.insert(file.name);
  Try([&] {
    result_.num_bytes += CheckKnownFile(summary_.directory, file, said_in);
    ++result_.num_files;
  });
}

void Verifier::CheckCloud(const KnownFile& file,
                          const FrameRecord& line,
                          const FrameLines& lines,
                          const FrameFormat& format) {
  known_.insert(file.name);
  std::string bytes;
  const bool is_whole = Try([&] {
    bytes = ReadKnownFile(summary_.directory, file, kFramesFile);
    result_.num_bytes += bytes.size();
    ++result_.num_files;
  });
  if (is_whole) Try([&] { CompareCloud(file, bytes, line, lines, format); });
}

// The line's hash shows that it is as it was written; only the cloud shows what it holds.
void Verifier::CompareCloud(const KnownFile& file,
                            const std::string& bytes,
                            const FrameRecord& line,
                            const FrameLines& lines,
                            const FrameFormat& format) {
  if (!labels_) return;
  const std::string path = PathOf(file.name);
  const Cloud cloud = format.parse(path, bytes, std::nullopt).cloud;
  CompareWithCloud({cloud, format, *labels_, file.name}, line.counts, lines.frame.place, faults_);
}

bool Verifier::HasAllLines(std::string_view name) {
  const bool is_finished = summary_.manifest.has_value();
  const std::size_t expected = is_finished ? summary_.run.num_frames : result_.num_frames;
  return Try([&] { CheckNumLines(summary_.directory / name, expected, !is_finished); });
}

void Verifier::CheckFrames() {
  result_.num_frames = CountLines(summary_.directory / kFramesFile);
  LineReader frames(summary_.directory / kFramesFile);
  bool has_all_frames = HasAllLines(kFramesFile);
  bool has_all_records = true;
  std::vector<LineReader> records;
  for (const std::string& name : RecordFiles(summary_.run.format)) {
    if (!HasAllLines(name)) has_all_records = false;
    // A missing file has been reported already.
    if (!IsThere(summary_.directory / name)) continue;
    const bool is_there = Try([&] {
      records.emplace_back(summary_.directory / name);
      for (std::size_t i = 0; i < NumHeaders(name); ++i) (void)records.back().Next();
    });
    has_all_records = has_all_records && is_there;
  }
  std::vector<LineReader> motion;
  if (!Try([&] { motion = OpenMotionFiles(summary_); })) has_all_records = false;
  const std::uint32_t stride = summary_.run.stride();
  FrameLines lines{summary_.run.start_frame, {}, {}, {}};
  for (std::size_t i = 0; auto frame = frames.Next(); ++i, lines.expected_frame += stride) {
    on_progress_(static_cast<double>(i) / static_cast<double>(result_.num_frames));
    lines.frame = std::move(*frame);
    const auto line =
        Attempt("", faults_, [&] { return ReadFrameLine(lines.frame.text, lines.frame.place); });
    has_all_frames = has_all_frames && line;
    // If a line is missing, the other files' lines of that frame are skipped.
    std::uint32_t num_missing = 0;
    if (line && !Try([&] { (void)ReadNextFrameLine(lines); })) {
      has_all_frames = false;
      num_missing = (line->frame - std::min(line->frame, lines.expected_frame)) / stride;
      lines.expected_frame = line->frame;
    }
    lines.records.clear();
    for (LineReader& reader : records) {
      auto record = reader.Next();
      for (std::uint32_t k = 0; k < num_missing && record; ++k) record = reader.Next();
      if (record) lines.records.push_back(std::move(*record));
    }
    // Behind a frame that is missing, it is not known where a frame's samples begin.
    if (num_missing > 0) has_all_records = has_all_records && motion.empty();
    if (has_all_records && line) {
      has_all_records = Try([&] { lines.motion = ReadMotionLines(lines.frame, motion); });
    }
    if (line) CheckFrame(*line, lines, has_all_records);
  }
  if (summary_.manifest && has_all_frames) {
    CompareCounts(totals_, summary_.manifest->counts,
                  {PathOf(kManifestFile), "the sum over frames.jsonl", "is in no frame"}, faults_);
  }
}

void Verifier::CheckFrame(const FrameRecord& line, const FrameLines& lines, bool has_all_records) {
  CheckNames(line, lines.frame.place);
  if (has_all_records && Try([&] { CheckRecords(line, lines); })) {
    const PlacedLine& objects = lines.records.at(1);
    Try([&] { (void)ReadObjectsLine(objects.text, line.frame, objects.place); });
  }
  const std::string hash_fault = LineHashFault(lines.frame.text);
  if (!hash_fault.empty()) faults_.Add({lines.frame.place, hash_fault, ""});
  const FrameFormat* const format = FindFrameFormat(summary_.run.format);
  for (const KnownFile& file : line.files) {
    if (format != nullptr && format->parse != nullptr &&
        file.name.starts_with(format->files.front().folder)) {
      CheckCloud(file, line, lines, *format);
    } else {
      CheckFile(file, kFramesFile);
    }
  }
  totals_.Add(line.counts);
}

// What is wrong with a line has been said: its frame is left out.
NextClouds Verifier::CloudsOfFrames() const {
  const auto frames = std::make_shared<LineReader>(summary_.directory / kFramesFile);
  return [frames]() -> std::optional<CloudsOfFrame> {
    while (const auto frame = frames->Next()) {
      ErrorList known;
      const auto line =
          Attempt("", known, [&] { return ReadFrameLine(frame->text, frame->place); });
      if (line) return CloudsOfFrame{line->stamp_ns, line->clouds_hash, frame->place};
    }
    return std::nullopt;
  };
}

void Verifier::CheckBag() {
  const bool is_finished = summary_.manifest.has_value();
  fs::path bag = (summary_.directory / summary_.run.bag->path).lexically_normal();
  const fs::path unfinished = bag.string() + std::string(kUnfinishedSuffix);
  if (!fs::exists(bag) && fs::exists(unfinished)) bag = unfinished;
  const auto verify = NeedExtra(RecordingExtras::Get().verify_bag, bag, "ros");
  verify(bag, *summary_.run.bag, CloudsOfFrames(), is_finished, faults_);
  ++result_.num_files;
  if (fs::is_regular_file(bag)) result_.num_bytes += fs::file_size(bag);
}

void Verifier::CheckTrace() {
  known_.insert(summary_.run.trace);
  fs::path trace = summary_.directory / summary_.run.trace;
  if (!fs::exists(trace) && !summary_.manifest) trace += kUnfinishedSuffix;
  const auto verify = NeedExtra(RecordingExtras::Get().verify_trace, trace, "osi");
  verify(trace, CloudsOfFrames(), summary_.manifest.has_value(), faults_);
  ++result_.num_files;
  result_.num_bytes += fs::file_size(trace);
}

// Files are named by the number of their frame; those of a dataset count from 0.
void Verifier::CheckNames(const FrameRecord& line, const std::string& place) {
  const FrameFormat* const format = FindFrameFormat(summary_.run.format);
  const bool is_of_dataset = format != nullptr && format->dataset;
  const std::size_t num_files = format == nullptr ? 1 : format->files.size();
  const std::uint32_t number =
      is_of_dataset ? (line.frame - summary_.run.start_frame) / summary_.run.stride() : line.frame;
  const std::string digits = FrameDigits(number);
  // A camera's files are beside those of the format, all of them or none.
  const auto num_of_camera = static_cast<std::size_t>(std::ranges::count_if(
      line.files, [](const KnownFile& file) { return IsCameraFile(file.name); }));
  const std::size_t num_of_format = line.files.size() - num_of_camera;
  if (num_of_format != num_files) {
    faults_.Add(
        {place + ": /files", "must be " + NumberText(num_files), NumberText(num_of_format)});
  }
  const std::size_t num_of_image = CameraFileKinds().size();
  if (num_of_camera != 0 && num_of_camera != num_of_image) {
    faults_.Add({place + ": /files", "must be " + NumberText(num_of_image) + " of a camera",
                 NumberText(num_of_camera)});
  }
  for (const KnownFile& file : line.files) {
    if (fs::path(file.name).stem() == digits) continue;
    faults_.Add({place + ": /files", "must be called by the frame's number, " + digits,
                 ShownText(file.name)});
  }
}

void Verifier::FindOthers() {
  if (summary_.run.bag) known_.insert({std::string(kBagLinesFile), summary_.run.bag->path});
  ForEachFileBelow(summary_.directory, summary_.directory, {}, [&](const std::string& name) {
    if (known_.contains(name) || (summary_.run.bag && IsOfBag(name))) return;
    if (summary_.manifest && are_frames_known_) {
      return AddOther(summary_.directory, name,
                      "is named neither in manifest.json nor in frames.jsonl");
    }
    // A run that was interrupted or is in progress has files whose hashes are not recorded yet.
    const auto finished = FinishedName(name);
    if (!IsSequenceFile(finished.value_or(name))) Fault(name, "is no file of a sequence");
  });
}

}  // namespace

Verification VerifySequence(const fs::path& directory,
                            const std::function<void(double)>& on_progress) {
  return Verifier(directory, on_progress).Run();
}

Verification VerifyFolder(const fs::path& directory,
                          const std::function<void(double)>& on_progress) {
  const RecordingExtras& extras = RecordingExtras::Get();
  for (const auto& [file, extra] : kFilesOfExtras) {
    if (!IsThere(directory / file)) continue;
    const auto verify = extras.verify.find(extra);
    if (verify == extras.verify.end()) {
      throw LacksExtra(ShownPath(directory / file), std::string(extra));
    }
    return verify->second(directory, on_progress);
  }
  if (IsOfSensors(directory)) return VerifySensors(directory, on_progress);
  if (IsSurvey(directory)) return VerifySurvey(directory);
  const FolderKind* const kind = FindFolderKind(directory);
  if (kind != nullptr && !kind->why_not.empty()) {
    throw InputError(ShownPath(directory) + ": is " + std::string(kind->what) + ", which " +
                     std::string(kind->why_not));
  }
  std::error_code error;
  if (kind == nullptr && fs::exists(directory, error) && !IsThere(directory / kRunFile)) {
    throw InputError(ShownPath(directory) + ": must be a folder that railcast wrote (got " +
                     (fs::is_directory(directory, error) ? "another" : "a file") + ")");
  }
  return VerifySequence(directory, on_progress);
}

std::vector<std::string> FaultsToMend(const fs::path& directory, const Verification& found) {
  std::set<std::string> of_others;
  for (const Verification::OtherFile& other : found.others) of_others.insert(other.fault);
  std::vector<std::string> faults = found.faults;
  std::erase_if(faults, [&](const std::string& fault) { return of_others.contains(fault); });
  for (const auto& [file, fault, is_unfinished] : found.others) {
    if (is_unfinished) {
      fs::remove(file);
    } else if (faults.empty()) {  // Else it may be a file that a damaged one names.
      RefuseStranger(directory, file.lexically_relative(directory).generic_string());
    }
  }
  return faults;
}

}  // namespace railcast
