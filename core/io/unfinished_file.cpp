#include "core/io/unfinished_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "core/base/input_file.h"
#include "core/io/write_file.h"

namespace railcast {

UnfinishedFile::UnfinishedFile(std::filesystem::path file, std::uint64_t size)
    : file_(std::move(file)) {
  CheckIsOwnFile(file_);
  constexpr int kAccess = 0644;
  descriptor_ = FileDescriptor(
      ::open(unfinished().c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kAccess));
  const auto kept = static_cast<off_t>(size);
  if (!descriptor_.is_open() || ::ftruncate(descriptor_.number(), kept) != 0 ||
      ::lseek(descriptor_.number(), kept, SEEK_SET) != kept) {
    throw FileError(file_, errno);
  }
}

std::filesystem::path UnfinishedFile::unfinished() const {
  return file_.string() + std::string(kUnfinishedSuffix);
}

void UnfinishedFile::Append(std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_.number(), bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) throw FileError(file_, errno);
    if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void UnfinishedFile::AppendFile(const std::filesystem::path& source) const {
  std::ifstream input = OpenInput(source);
  std::vector<char> block(std::size_t{1} << 20U);
  while (input) {
    input.read(block.data(), static_cast<std::streamsize>(block.size()));
    Append(std::as_bytes(std::span(block).first(static_cast<std::size_t>(input.gcount()))));
  }
  if (input.bad()) throw FileError(source, EIO);
}

std::string UnfinishedFile::Read(std::uint64_t place, std::size_t size) const {
  std::string bytes(size, '\0');
  const ssize_t got = ::pread(descriptor_.number(), bytes.data(), size, static_cast<off_t>(place));
  if (got < 0 || static_cast<std::size_t>(got) != size) throw FileError(file_, errno);
  return bytes;
}

void UnfinishedFile::Overwrite(std::uint64_t place, std::span<const char> bytes) const {
  const ssize_t written =
      ::pwrite(descriptor_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
  if (written < 0 || static_cast<std::size_t>(written) != bytes.size()) {
    throw FileError(file_, errno);
  }
}

void UnfinishedFile::Sync() const {
  if (::fdatasync(descriptor_.number()) != 0) throw FileError(file_, errno);
}

void UnfinishedFile::Finish() const {
  if (::fsync(descriptor_.number()) != 0 || ::rename(unfinished().c_str(), file_.c_str()) != 0) {
    throw FileError(file_, errno);
  }
}

}  // namespace railcast
