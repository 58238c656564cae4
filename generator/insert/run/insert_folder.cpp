#include "generator/insert/run/insert_folder.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/insertion_verification.h"
#include "core/io/write_file.h"
#include "generator/empty_folder.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Whether a line of insert.jsonl is that of the frame, and all that it names is there.
bool IsWhole(const fs::path& directory,
             std::string_view line,
             std::uint32_t frame,
             const std::string& records) {
  if (line.empty()) return false;
  line.remove_suffix(1);
  if (!LineHashFault(line).empty()) return false;
  try {
    const FrameRecord record = ReadInsertLine(line, "").frame;
    return record.frame == frame && record.records_hash == ContentHash(records) &&
           std::ranges::all_of(record.files,
                               [&](const KnownFile& file) { return HasContent(directory, file); });
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

InsertFolder::InsertFolder(InsertFolderSpec spec) : spec_(std::move(spec)), lock_(spec_.directory) {
  const fs::path run_file = spec_.directory / kRunFile;
  std::error_code none;
  if (spec_.is_mended) {
    WriteFileWhole(run_file, RecordFile(spec_.run));
    fs::remove(spec_.directory / kManifestFile, none);
  } else if (fs::exists(run_file)) {
    CheckSameRun(ReadFileWhole(run_file));
  } else {
    MakeEmptyFolder(spec_.directory);
    was_empty_ = true;
    WriteFileWhole(run_file, RecordFile(spec_.run));
  }
  is_complete_ = fs::exists(spec_.directory / kManifestFile);
  if (is_complete_) {
    RefuseChanged(spec_.directory, VerifyInsertion(spec_.directory, [](double) {}));
  }
  CountFrames();
}

void InsertFolder::CheckSameRun(const std::string& found) const {
  const Json theirs = Json::parse(found, nullptr, false);
  const std::string place = ShownPath(spec_.directory) + ": ";
  if (!theirs.is_object()) throw InputError(place + "holds a run.json that is not railcast's");
  const Json ours = Json::parse(RecordText(spec_.run));
  for (const auto& [key, value] : ours.items()) {
    const auto other = theirs.find(key);
    if (other != theirs.end() && *other == value) continue;
    const bool is_shown = other != theirs.end() && other->is_primitive();
    throw InputError(place + "holds another run: its " + key + " is " +
                     (is_shown ? ShownText(other->dump()) : "missing") + " (got " +
                     ShownText(value.dump()) + "); choose another --out");
  }
}

std::vector<LineFileName> InsertFolder::LineFiles() const {
  std::vector<LineFileName> files = spec_.line_files;
  files.push_back({std::string(kInsertFile), ""});
  return files;
}

void InsertFolder::CountFrames() {
  std::vector<LineWalk> walks;
  for (const LineFileName& file : LineFiles()) {
    walks.emplace_back(spec_.directory / file.name, file.header);
  }
  const auto note = [&] {
    std::vector<std::uint64_t> sizes;
    for (const LineWalk& walk : walks) sizes.push_back(walk.position());
    sizes_.push_back(std::move(sizes));
  };
  note();
  for (; num_done_ < spec_.run.num_frames; ++num_done_) {
    std::string records;
    for (std::size_t i = 0; i + 1 < walks.size(); ++i) records += walks[i].Next();
    const std::uint32_t frame = spec_.run.first_frame + num_done_;
    if (!IsWhole(spec_.directory, walks.back().Next(), frame, records)) break;
    for (LineWalk& walk : walks) walk.Advance();
    note();
  }
}

void InsertFolder::Open(std::uint32_t num_kept) {
  Check(num_kept <= num_done_, "only frames that are there are kept");
  num_done_ = num_kept;
  const std::vector<LineFileName> files = LineFiles();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const fs::path file = spec_.directory / files[i].name;
    MakeFolders(file.parent_path());
    lines_.emplace_back(file, sizes_[num_kept][i]);
    if (sizes_[num_kept][i] == 0) lines_.back().Append(files[i].header);
  }
}

void InsertFolder::WriteFixed(const FixedFile& file) {
  const fs::path path = spec_.directory / file.name;
  fixed_.push_back(file.name);
  if (fs::exists(path)) {  // Else what it is to hold need not be read twice.
    const FileHash wanted = file.copy_of.empty()
                                ? FileHash{ContentHash(file.bytes), file.bytes.size()}
                                : HashFile(file.copy_of);
    if (HasContent(spec_.directory, {file.name, wanted.hash, wanted.num_bytes})) return;
  }
  MakeFolders(path.parent_path());
  if (file.copy_of.empty()) {
    WriteFileWhole(path, file.bytes);
    return;
  }
  // Beside clouds may stand images and maps of any size.
  const UnfinishedFile copy(path, 0);
  copy.AppendFile(file.copy_of);
  copy.Finish();
}

void InsertFolder::Write(const std::vector<FrameFile>& files,
                         const std::vector<std::string>& lines,
                         InsertRecord entry) {
  Check(lines.size() + 1 == lines_.size(), "each file gets a line");
  for (const FrameFile& file : files) {
    MakeFolders((spec_.directory / file.name).parent_path());
    WriteFileWhole(spec_.directory / file.name, file.bytes);
    entry.frame.files.push_back({file.name, ContentHash(file.bytes), file.bytes.size()});
  }
  std::string records;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines_[i].Append(lines[i]);
    records += lines[i];
  }
  entry.frame.records_hash = ContentHash(records);
  lines_.back().Append(HashedRecordLine(entry));
  ++num_done_;
}

void InsertFolder::Abandon() noexcept {
  if (!was_empty_ || num_done_ > 0) return;
  lines_.clear();
  std::error_code error;
  fs::remove_all(spec_.directory, error);
}

// What a run that was killed has left beside the file that it wrote, unless the recording has a
// file of this name.
void InsertFolder::RemoveUnfinished(const std::vector<std::string>& own) const {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(spec_.directory)) {
    const fs::path& file = entry.path();
    if (file.extension() != kUnfinishedSuffix || !entry.is_regular_file()) continue;
    const std::string name = file.lexically_relative(spec_.directory).generic_string();
    const bool is_own = std::ranges::find(own, name) != own.end();
    if (!is_own && fs::exists(file.parent_path() / file.stem())) files.push_back(file);
  }
  for (const fs::path& file : files) fs::remove(file);
}

void InsertFolder::Finish(const std::vector<std::string>& remarks,
                          const std::vector<std::string>& others) {
  for (LineFile& file : lines_) file.Sync();
  InsertManifestRecord manifest{.run = spec_.run, .remarks = remarks};
  std::vector<std::string> names = {std::string(kRunFile)};
  names.insert(names.end(), fixed_.begin(), fixed_.end());
  names.insert(names.end(), others.begin(), others.end());
  for (const LineFileName& file : LineFiles()) names.push_back(file.name);
  RemoveUnfinished(names);
  for (const std::string& name : names) {
    manifest.files.emplace_back(name, HashFile(spec_.directory / name).hash);
  }
  WriteFileWhole(spec_.directory / kManifestFile, WithManifestHash(RecordFile(manifest)));
  is_complete_ = true;
}

}  // namespace railcast
