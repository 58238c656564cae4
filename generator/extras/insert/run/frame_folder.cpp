#include "generator/extras/insert/run/frame_folder.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallelism.h"
#include "core/extras/insert/convert_record.h"
#include "core/extras/insert/insertion_verification.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/run/folder_identity.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What a line of the ledger says; nothing if it is not that of the frame.
std::optional<LedgerItem> ReadItem(const FrameFolderSpec& spec,
                                   std::string_view line,
                                   std::uint32_t frame) {
  const auto record = ReadWholeLine(
      line, [&](std::string_view whole) { return ReadLedgerLine(spec.ledger, whole, ""); });
  if (!record || record->frame != frame) return std::nullopt;
  return LedgerItem{record->files, record->records_hash, std::vector(spec.line_files.size(), 1U)};
}

// What another value of a key of run.json means.
std::string FolderDifference(const std::string& key, const Json& found, const Json& ours) {
  return "holds another run: " + ValuesText(key, MemberOf(found, key), MemberOf(ours, key));
}

std::vector<LineFileName> WithLedger(const FrameFolderSpec& spec) {
  std::vector<LineFileName> files = spec.line_files;
  files.push_back({spec.ledger, ""});
  return files;
}

}  // namespace

void MakeMissing(const MissingFrames& missing,
                 const std::function<void(std::size_t num_slots)>& resize,
                 const std::function<bool(std::size_t slot, std::uint32_t number)>& take,
                 std::vector<FramePipe::Stage> stages,
                 std::function<void(std::size_t slot)> write) {
  const auto allowed = AllowThreads(missing.num_threads);
  tbb::task_arena arena(missing.num_threads == 0 ? tbb::task_arena::automatic
                                                 : missing.num_threads);
  FramePipe pipe;
  pipe.num_at_once = static_cast<std::size_t>(arena.max_concurrency()) + 1;
  // Whole frames of captures wait for the thread that edits their packets.
  pipe.num_waiting = 2;
  pipe.execute = [&](const std::function<void()>& run) { arena.execute(run); };
  const auto& [range, num_before, num_threads, hooks] = missing;
  resize(pipe.num_slots());
  std::uint32_t next = 0;
  pipe.begin = [&](std::size_t slot) {
    const std::uint32_t first = range.first + num_before;
    if (first == range.first + range.num) return false;
    while (next < first) {
      if (!take(slot, next++)) return false;
    }
    if (next == range.first + range.num || hooks.is_stopped()) return false;
    return take(slot, next++);
  };
  pipe.stages = std::move(stages);
  pipe.write = std::move(write);
  std::uint32_t num_done = num_before;
  pipe.on_written = [&] { hooks.on_progress(++num_done, range.num); };
  hooks.on_progress(num_done, range.num);
  RunPipe(pipe);
}

FrameFolder::FrameFolder(FrameFolderSpec spec)
    : spec_(std::move(spec)), lock_(spec_.directory), lines_(spec_.directory, WithLedger(spec_)) {
  const FolderIdentity identity{.file = spec_.directory / kRunFile,
                                .text = spec_.run,
                                .is_complete = fs::exists(spec_.directory / kManifestFile)};
  if (!spec_.is_known) was_empty_ = TakeFolder(identity, spec_.made, FolderDifference);
  is_complete_ = identity.is_complete;
  if (is_complete_) {
    changed_ = FaultsToMend(spec_.directory, VerifyInsertion(spec_.directory, [](double) {}));
    is_complete_ = changed_.empty();
  }
  if (!is_complete_) {
    fs::remove(spec_.directory / kManifestFile);
    WriteFileWhole(identity.file, identity.text);
  }
  CountFrames(spec_.num_frames);
}

void FrameFolder::CountFrames(std::uint32_t most) {
  num_done_ = lines_.Count(most, [&](std::uint32_t i, std::string_view line) {
    return ReadItem(spec_, line, spec_.first_frame + i);
  });
}

void FrameFolder::Open(std::uint32_t num_kept) {
  if (num_kept < num_done_) CountFrames(num_kept);
  Check(num_kept == num_done_, "only frames that are there are kept");
  lines_.Open();
}

void FrameFolder::WriteFixed(const FixedFile& file) {
  fixed_.push_back(file.name);
  WriteFixedFile(spec_.directory, file);
}

void FrameFolder::WriteFiles(const std::vector<FrameFile>& files) const {
  for (const FrameFile& file : files) {
    MakeFolders((spec_.directory / file.name).parent_path());
    WriteFileWhole(spec_.directory / file.name, file.bytes);
  }
}

void FrameFolder::Abandon() noexcept {
  if (!was_empty_ || num_done_ > 0) return;
  std::error_code error;
  fs::remove_all(spec_.directory, error);
}

// What a run that was killed has left beside the file that it wrote, unless the recording has a
// file of this name.
void FrameFolder::RemoveUnfinished(const std::vector<std::string>& own) const {
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

NamedValues<std::string> FrameFolder::HashesOfWhole(const std::vector<std::string>& others) {
  lines_.Sync();
  std::vector<std::string> names = {std::string(kRunFile)};
  names.insert(names.end(), fixed_.begin(), fixed_.end());
  names.insert(names.end(), others.begin(), others.end());
  for (const LineFileName& file : lines_.files()) names.push_back(file.name);
  RemoveUnfinished(names);
  NamedValues<std::string> hashes;
  for (const std::string& name : names) {
    hashes.emplace_back(name, HashFile(spec_.directory / name).hash);
  }
  return hashes;
}

}  // namespace railcast
