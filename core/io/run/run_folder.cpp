#include "core/io/run/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/survey_record.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

// Retries, since a run that was just killed may hold the lock until the system has released it.
bool LockFolder(int folder) {
  constexpr int kTries = 20;
  constexpr std::chrono::milliseconds kPause(50);
  for (int i = 0; i < kTries; ++i) {
    if (::flock(folder, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(kPause);
  }
  return false;
}

/// Files that together only folders of railcast's have: what run.json or study.json is called alone
/// may be a user's own scenario or study.
struct OwnFiles {
  std::string_view name;
  std::string_view beside{};  ///< Empty: none.
};
constexpr std::array<OwnFiles, 6> kOwnFiles = {{{kFramesFile, kRunFile},
                                                {kInsertFile},
                                                {"convert.jsonl"},
                                                {"scenarios.jsonl", kDatasetFile},
                                                {"approaches.jsonl", "study.json"},
                                                {kSurveyFile}}};

/// The file by which a folder is known as railcast's; empty if it is not.
std::string_view OwnFileIn(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& [name, beside] : kOwnFiles) {
    // Without a second file, the folder itself is the second.
    if (exists(folder / name, error) && exists(folder / beside, error)) return name;
  }
  if (!std::filesystem::exists(folder / kSensorsFile, error)) return "";
  ErrorList others;  // Other files are called sensors.json, too.
  const auto sensors = Attempt("", others, [&] { return SensorFoldersIn(folder); });
  return sensors && !sensors->empty() ? kSensorsFile : "";
}

/// Whether writing a file would replace another one, or one in another folder.
bool WouldReplace(const std::filesystem::path& output, const std::filesystem::path& other) {
  std::error_code error;
  // Whatever is written to /dev/null or a pipe replaces nothing.
  if (std::filesystem::is_other(std::filesystem::status(output, error))) return false;
  return IsInFolder(output, other) || std::filesystem::equivalent(output, other, error);
}

}  // namespace

std::filesystem::path FollowedPath(const std::filesystem::path& path) {
  std::error_code error;
  const auto whole = std::filesystem::absolute(path, error);
  auto followed = std::filesystem::weakly_canonical(whole, error);
  if (!error) return followed;
  const int error_number = error.value();
  if (std::filesystem::exists(whole, error)) return whole;
  throw FileError(path, error_number);
}

bool IsInFolder(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto outer = FollowedPath(folder);
  const auto inner = FollowedPath(path);
  return std::ranges::mismatch(outer, inner).in1 == outer.end();
}

void CheckIsOutside(const std::string& option, const std::filesystem::path& path, bool may_be_own) {
  std::filesystem::path folder = FollowedPath(path);
  if (may_be_own) folder = folder.parent_path();
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    const std::string_view name = OwnFileIn(folder);
    if (name.empty()) continue;
    throw InputError(option + ": must be outside " + ShownPath(folder) +
                     ", which holds nothing but what belongs to its " + std::string(name) +
                     " (got " + ShownPath(path) + ")");
  }
}

void CheckOutputFiles(std::vector<GivenPath> inputs, const std::vector<GivenPath>& outputs) {
  for (const GivenPath& output : outputs) {
    if (output.path.empty()) continue;
    CheckIsOutside(output.option, output.path);
    for (const GivenPath& other : inputs) {
      if (other.path.empty() || !WouldReplace(output.path, other.path)) continue;
      throw InputError(output.option + ": must not be " + other.option + " or in it (got " +
                       ShownPath(output.path) + ")");
    }
    CheckCanWrite(output.path);
    inputs.push_back(output);
  }
}

void MakeFolders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, error.value());
}

std::optional<std::string> FindLink(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::recursive_directory_iterator entry(folder, error);
  for (const std::filesystem::recursive_directory_iterator end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->is_symlink(error)) continue;
    return entry->path().lexically_relative(folder).generic_string();
  }
  if (error) throw FileError(folder, error.value());
  return std::nullopt;
}

void RefuseLinks(const std::filesystem::path& folder, const std::vector<std::string>& own) {
  std::error_code error;
  for (const std::string& name : own) {
    std::filesystem::path path = (folder / name).lexically_normal();
    const auto status = std::filesystem::symlink_status(path, error);
    const auto link = is_directory(status) ? FindLink(path) : std::nullopt;
    if (link) path /= *link;
    if (link || is_symlink(status)) {
      throw InputError(ShownPath(path) + ": must not be a symbolic link");
    }
  }
}

void RefuseStranger(const std::filesystem::path& folder, const std::string& name) {
  throw InputError(ShownPath(folder) + ": holds a file that does not belong to this run (" +
                   ShownPath(name) + "); move it away or choose another --out");
}

std::string MendedText(const std::vector<std::string>& faults) {
  constexpr std::size_t kMostShown = 10;
  if (faults.empty()) return "";
  std::string text = "was complete, but not as it was written; made anew:\n";
  for (std::size_t i = 0; i < std::min(faults.size(), kMostShown); ++i) text += faults[i] + "\n";
  if (faults.size() <= kMostShown) return text;
  return text + "... and " + NumberText(faults.size() - kMostShown) + " more\n";
}

FolderLock::FolderLock(const std::filesystem::path& folder) {
  MakeFolders(folder);
  descriptor_ = FileDescriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor_.is_open()) throw FileError(folder, errno);
  if (!LockFolder(descriptor_.number())) {
    throw InputError(ShownPath(folder) + ": another run is writing here");
  }
  if (const auto link = FindLink(folder)) {
    throw InputError(ShownPath(folder) + ": holds a symbolic link, which no run makes (" +
                     ShownPath(*link) + "); move it away or choose another --out");
  }
}

LineFile::LineFile(std::filesystem::path file, std::uint64_t keep_bytes)
    : file_(std::move(file)), size_(keep_bytes) {
  CheckIsOwnFile(file_);
  std::error_code error;
  if (std::filesystem::hard_link_count(file_, error) > 1 && !error) {
    // The other name, such as that in a shard of a merged data set, keeps its content.
    const std::filesystem::path copy = file_.string() + std::string(kUnfinishedSuffix);
    std::filesystem::copy_file(file_, copy, std::filesystem::copy_options::overwrite_existing,
                               error);
    if (!error) std::filesystem::rename(copy, file_, error);
    if (error) throw FileError(file_, error.value());
  }
  constexpr int kAccess = 0644;
  descriptor_ =
      FileDescriptor(::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kAccess));
  if (!descriptor_.is_open() || ::ftruncate(descriptor_.number(), static_cast<off_t>(size_)) != 0) {
    throw FileError(file_, errno);
  }
}

void LineFile::Append(std::string_view lines) {
  const std::uint64_t whole = size_;
  while (!lines.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_.number(), lines.data(), lines.size(), static_cast<off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error_number = errno;
      // If this fails, too, resuming the run drops the incomplete line.
      size_ = ::ftruncate(descriptor_.number(), static_cast<off_t>(whole)) == 0 ? whole : size_;
      throw FileError(file_, error_number);
    }
    lines.remove_prefix(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
}

void LineFile::Sync() {
  if (::fsync(descriptor_.number()) != 0) throw FileError(file_, errno);
}

}  // namespace railcast
