#include "generator/run/run_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/base/error.h"
#include "core/io/write_file.h"

namespace railcast {

LineFile::LineFile(std::filesystem::path file, std::uint64_t keep_bytes)
    : file_(std::move(file)), size_(keep_bytes) {
  constexpr int kAccess = 0644;
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kAccess);
  if (descriptor_ < 0) throw FileError(file_, errno);
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0) return;
  const int error_number = errno;
  ::close(descriptor_);
  throw FileError(file_, error_number);
}

LineFile::LineFile(LineFile&& other) noexcept
    : file_(std::move(other.file_)),
      size_(other.size_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

LineFile::~LineFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void LineFile::Append(std::string_view lines) {
  const std::uint64_t whole = size_;
  while (!lines.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, lines.data(), lines.size(), static_cast<off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error_number = errno;
      // If this fails, too, resuming the run drops the incomplete line.
      size_ = ::ftruncate(descriptor_, static_cast<off_t>(whole)) == 0 ? whole : size_;
      throw FileError(file_, error_number);
    }
    lines.remove_prefix(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
}

void LineFile::Sync() {
  if (::fsync(descriptor_) != 0) throw FileError(file_, errno);
}

}  // namespace railcast
