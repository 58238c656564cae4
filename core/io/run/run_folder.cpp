#include "core/io/run/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
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

}  // namespace

bool IsInFolder(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto followed = [](const std::filesystem::path& given) {
    std::error_code error;
    const auto whole = std::filesystem::weakly_canonical(given, error);
    if (error) throw FileError(given, error.value());
    return whole;
  };
  const auto outer = followed(folder);
  const auto inner = followed(path);
  return std::ranges::mismatch(outer, inner).in1 == outer.end();
}

void MakeFolders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, error.value());
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
  if (LockFolder(descriptor_.number())) return;
  throw InputError(ShownPath(folder) + ": another run is writing here");
}

LineFile::LineFile(std::filesystem::path file, std::uint64_t keep_bytes)
    : file_(std::move(file)), size_(keep_bytes) {
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
  descriptor_ = FileDescriptor(::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kAccess));
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
