#include "analysis/verify/verification.h"

#include <algorithm>
#include <optional>
#include <set>

#include "analysis/verify/count_totals.h"
#include "core/base/attempt.h"
#include "core/base/number_text.h"
#include "core/base/shown_text.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What a manifest always names.
std::vector<std::string> NeededFiles(const RunSummary& run) {
  std::vector<std::string> names = RecordFiles(run.format);
  for (const std::string_view name :
       {kFramesFile, kRunFile, kScenarioFile, kLabelsFile, kMaterialsFile}) {
    names.emplace_back(name);
  }
  for (const KnownFile& file : run.files) names.push_back(file.name);
  return names;
}

// Harmless to a terminal.
std::string ShownName(const fs::path& relative) {
  fs::path shown;
  for (const fs::path& part : relative) shown /= ShownText(part.string());
  return shown.string();
}

class Verifier {
 public:
  Verifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : on_progress_(on_progress) {
    summary_.directory = directory;
    summary_.run = ReadRunSummary(ReadFileWhole(PathOf(kRunFile)), PathOf(kRunFile));
    known_ = {std::string(kRunFile), std::string(kManifestFile)};
  }

  Verification Run() {
    ReadTheManifest();
    if (summary_.manifest) CompareManifest();
    CheckKnownFiles();
    are_frames_known_ = Try([&] { CheckFrames(); });
    Try([&] { FindOthers(); });
    result_.faults = faults_.lines();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::string PathOf(std::string_view name) const {
    return (summary_.directory / name).string();
  }
  template <typename Work>
  bool Try(const Work& work) {
    return Attempt("", faults_, [&] { return work(), true; }).has_value();
  }
  void Fault(std::string_view name, const std::string& rule) {
    faults_.Add(PathOf(name) + ": " + rule);
  }

  void ReadTheManifest();
  void CompareManifest();
  void CheckKnownFiles();
  void CheckFile(const KnownFile& file, std::string_view said_in);
  void CheckFrames();
  bool CheckNumLines(std::string_view name, std::size_t num_headers);
  void CheckFrame(const FrameLine& line, const FrameLines& lines, bool has_all_records);
  void CheckNames(const FrameLine& line, const std::string& place);
  void FindOthers();

  const std::function<void(double)>& on_progress_;
  SequenceSummary summary_;
  StrictJson manifest_json_;
  CountTotals totals_;
  std::set<std::string, std::less<>> known_;
  bool are_frames_known_ = false;
  ErrorList faults_;
  Verification result_;
};

void Verifier::ReadTheManifest() {
  if (summary_.run.isa.empty()) {
    Fault(kRunFile,
          "is of an older railcast, which named neither the instruction set nor Embree, and whose "
          "scenario names files elsewhere");
  }
  if (!fs::exists(PathOf(kManifestFile))) {
    return Fault(kManifestFile, "missing: the run is unfinished");
  }
  Try([&] {
    const std::string text = ReadFileWhole(PathOf(kManifestFile));
    summary_.manifest = ReadManifest(text, PathOf(kManifestFile));
    manifest_json_ = StrictJson::parse(text);
  });
}

// The manifest itself has no hash: what it says must agree with what the other files say.
void Verifier::CompareManifest() {
  const RunSummary& run = summary_.run;
  const Manifest& manifest = *summary_.manifest;
  const auto compare = [&](const char* key, const std::string& got, const std::string& expected) {
    if (got == expected) return;
    Fault(kManifestFile, std::string("/") + key + ": must be " + expected +
                             ", as run.json says (got " + ShownText(got) + ")");
  };
  compare("version", manifest.version, run.version);
  compare("format", manifest.format, run.format);
  compare("start_frame", NumberText(manifest.start_frame), NumberText(run.start_frame));
  compare("num_frames", NumberText(manifest.num_frames), NumberText(run.num_frames));
  for (const std::string& name : NeededFiles(run)) {
    if (std::ranges::find(manifest.files, name, &KnownFile::name) == manifest.files.end()) {
      Fault(kManifestFile, "/files_xxh3: must name " + ShownText(name));
    }
  }
  const std::string data_hash = DataHash(manifest.files);
  if (manifest.data_hash == data_hash || run.isa.empty()) return;
  Fault(kManifestFile, "/data_xxh3: must be " + data_hash + ", that of the files (got " +
                           ShownText(manifest.data_hash) + ")");
}

void Verifier::CheckKnownFiles() {
  for (const KnownFile& file : summary_.run.files) CheckFile(file, kRunFile);
  if (!summary_.manifest) return;
  for (const KnownFile& file : summary_.manifest->files) {
    const auto same = [&](const KnownFile& other) {
      return other.name == file.name && other.hash == file.hash;
    };
    if (std::ranges::none_of(summary_.run.files, same)) CheckFile(file, kManifestFile);
  }
}

void Verifier::CheckFile(const KnownFile& file, std::string_view said_in) {
  known_.insert(file.name);
  Try([&] {
    result_.num_bytes += ReadKnownFile(summary_.directory, file, said_in).size();
    ++result_.num_files;
  });
}

// Of an unfinished run the line of a frame's that is being written may be there.
bool Verifier::CheckNumLines(std::string_view name, std::size_t num_headers) {
  const std::size_t num_lines = CountLines(summary_.directory / name);
  const std::size_t got = num_lines - std::min(num_lines, num_headers);
  const std::size_t expected = summary_.manifest ? summary_.run.num_frames : result_.num_frames;
  if (summary_.manifest ? got == expected : got >= expected) return true;
  Fault(name, "must have a line for each of " + NumberText(expected) + " frames (got " +
                  NumberText(got) + ")");
  return false;
}

void Verifier::CheckFrames() {
  result_.num_frames = CountLines(summary_.directory / kFramesFile);
  LineReader frames(summary_.directory / kFramesFile);
  bool has_all_frames = CheckNumLines(kFramesFile, 0);
  bool has_all_records = true;
  std::vector<LineReader> records;
  for (const std::string& name : RecordFiles(summary_.run.format)) {
    const std::size_t num_headers = name == kPosesFile ? 1 : 0;
    const bool is_there = Try([&] {
      has_all_records = CheckNumLines(name, num_headers) && has_all_records;
      records.emplace_back(summary_.directory / name);
      if (num_headers > 0) (void)records.back().Next();
    });
    has_all_records = has_all_records && is_there;
  }
  FrameLines lines{summary_.run.start_frame, {}, {}};
  for (std::size_t i = 0; auto frame = frames.Next(); ++i, ++lines.expected_frame) {
    on_progress_(static_cast<double>(i) / static_cast<double>(result_.num_frames));
    lines.frame = std::move(*frame);
    const auto line =
        Attempt("", faults_, [&] { return ReadFrameLine(lines.frame.text, lines.frame.place); });
    has_all_frames = has_all_frames && line;
    // Where a line is missing, the other files' lines of that frame are passed over.
    std::uint32_t num_missing = 0;
    if (line && !Try([&] { (void)ReadNextFrameLine(lines); })) {
      has_all_frames = false;
      num_missing = line->frame - std::min(line->frame, lines.expected_frame);
      lines.expected_frame = line->frame;
    }
    lines.records.clear();
    for (LineReader& reader : records) {
      auto record = reader.Next();
      for (std::uint32_t k = 0; k < num_missing && record; ++k) record = reader.Next();
      if (record) lines.records.push_back(std::move(*record));
    }
    if (line) CheckFrame(*line, lines, has_all_records);
  }
  if (summary_.manifest && has_all_frames) {
    totals_.Compare(manifest_json_, PathOf(kManifestFile), faults_);
  }
}

void Verifier::CheckFrame(const FrameLine& line, const FrameLines& lines, bool has_all_records) {
  CheckNames(line, lines.frame.place);
  if (has_all_records) Try([&] { CheckRecords(line, lines); });
  for (const KnownFile& file : line.files) CheckFile(file, kFramesFile);
  Try([&] {
    try {
      totals_.Add(StrictJson::parse(lines.frame.text));
    } catch (const StrictJson::exception& error) {
      throw InputError(lines.frame.place + ": is damaged: " + error.what());
    }
  });
}

// Files are called by the number of their frame; KITTI's count from 0.
void Verifier::CheckNames(const FrameLine& line, const std::string& place) {
  const bool is_kitti = summary_.run.format == "kitti";
  const std::uint32_t number = is_kitti ? line.frame - summary_.run.start_frame : line.frame;
  std::string digits = NumberText(number);
  constexpr std::size_t kMinDigits = 6;
  if (digits.size() < kMinDigits) digits.insert(0, kMinDigits - digits.size(), '0');
  if (line.files.size() != (is_kitti ? 2U : 1U)) {
    faults_.Add(place + ": /files: must be " + (is_kitti ? "2" : "1") + " (got " +
                NumberText(line.files.size()) + ")");
  }
  for (const KnownFile& file : line.files) {
    if (fs::path(file.name).stem() == digits) continue;
    faults_.Add(place + ": /files: must be called by the frame's number, " + digits + " (got " +
                ShownText(file.name) + ")");
  }
}

void Verifier::FindOthers() {
  std::error_code error;
  fs::recursive_directory_iterator entry(summary_.directory, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    if (entry->is_directory()) continue;
    const fs::path relative = entry->path().lexically_relative(summary_.directory);
    std::string name = relative.generic_string();
    if (known_.contains(name)) continue;
    if (summary_.manifest && are_frames_known_) {
      Fault(ShownName(relative), "is named neither in manifest.json nor in frames.jsonl");
      continue;
    }
    // A run that is interrupted, or goes on, has files whose hashes nothing knows yet.
    if (name.ends_with(kUnfinishedSuffix)) name.resize(name.size() - kUnfinishedSuffix.size());
    if (!IsSequenceFile(name)) Fault(ShownName(relative), "is no file of a sequence");
  }
  if (error) throw FileError(summary_.directory, error.value());
}

}  // namespace

Verification VerifySequence(const fs::path& directory,
                            const std::function<void(double)>& on_progress) {
  return Verifier(directory, on_progress).Run();
}

}  // namespace railcast
