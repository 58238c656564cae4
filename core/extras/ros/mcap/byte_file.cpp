#include "core/extras/ros/mcap/byte_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast::mcap {

ByteFile::ByteFile(const std::filesystem::path& file, std::string name) : name_(std::move(name)) {
  CheckIsReadable(file);
  descriptor_ = FileDescriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor_.is_open()) throw FileError(file, errno);
  const off_t end = ::lseek(descriptor_.number(), 0, SEEK_END);
  size_ = end < 0 ? 0 : static_cast<std::uint64_t>(end);
}

Bytes ByteFile::Read(std::uint64_t offset, std::size_t size) const {
  Check(offset <= size_ && size <= size_ - offset, "what is read of a file lies within it");
  Bytes bytes(size);
  std::size_t num_read = 0;
  while (num_read < size) {
    const ssize_t got = ::pread(descriptor_.number(), bytes.data() + num_read, size - num_read,
                                static_cast<off_t>(offset + num_read));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw FileError(name_, errno);
    if (got == 0) throw InputError(name_ + ": must not become shorter while it is read");
    num_read += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace railcast::mcap
