#include "generator/run/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

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

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw FileError(folder, errno);
  if (LockFolder(descriptor_)) return;
  ::close(descriptor_);
  throw InputError(ShownPath(folder) + ": another run is writing here");
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

}  // namespace railcast
