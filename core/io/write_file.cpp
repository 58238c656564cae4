#include "core/io/write_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/base/file_descriptor.h"
#include "core/base/inputs.h"

namespace railcast {
namespace {

bool WriteAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool HasLength(int descriptor, std::size_t length) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return false;
  if (static_cast<std::size_t>(status.st_size) == length) return true;
  errno = EIO;
  return false;
}

std::filesystem::path UnfinishedOf(const std::filesystem::path& target) {
  return target.string() + std::string(kUnfinishedSuffix);
}

// @param file Named in the error if opening fails.
FileDescriptor OpenUnfinished(const std::filesystem::path& file,
                              const std::filesystem::path& unfinished) {
  constexpr int kAccess = 0644;
  FileDescriptor output(
      ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, kAccess));
  if (!output.is_open()) throw FileError(file, errno);
  return output;
}

// Throws if the entry of this name is anything but a file; a link is itself.
void CheckEntryIsRegular(const std::filesystem::path& file) {
  std::error_code error;
  CheckIsRegular(file, std::filesystem::symlink_status(file, error));
}

// @param file Named in errors.
void Replace(const std::filesystem::path& file,
             const std::filesystem::path& target,
             std::string_view bytes) {
  const std::filesystem::path unfinished = UnfinishedOf(target);
  FileDescriptor output = OpenUnfinished(file, unfinished);
  const bool is_written = WriteAll(output.number(), bytes) &&
                          HasLength(output.number(), bytes.size()) &&
                          ::fsync(output.number()) == 0 && output.Close() &&
                          ::rename(unfinished.c_str(), target.c_str()) == 0;
  if (is_written) return;
  const int error_number = errno;
  ::unlink(unfinished.c_str());
  throw FileError(file, error_number);
}

}  // namespace

void CheckIsNoInput(const std::filesystem::path& file) {
  std::error_code error;
  for (const std::filesystem::path& input : InputFiles()) {
    if (!std::filesystem::equivalent(file, input, error)) continue;
    throw InputError(ShownPath(file) + ": must not be written over, since this command reads it");
  }
}

std::filesystem::path FileToReplace(const std::filesystem::path& file) {
  std::error_code error;
  // Checked before links are followed by name, since what /dev/stdout leads to need not have a
  // name.
  CheckIsRegular(file, std::filesystem::status(file, error));
  std::filesystem::path target = file;
  constexpr int kMaxLinks = 40;  // Linux's limit.
  for (int i = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(target, error));
       ++i) {
    if (i == kMaxLinks) throw FileError(file, ELOOP);
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
    if (error) throw FileError(file, error.value());
  }
  CheckEntryIsRegular(UnfinishedOf(target));
  CheckIsNoInput(target);
  return target;
}

void CheckIsOwnFile(const std::filesystem::path& file) {
  CheckEntryIsRegular(file);
  CheckEntryIsRegular(UnfinishedOf(file));
}

void CheckCanWrite(const std::filesystem::path& file) {
  const std::filesystem::path unfinished = UnfinishedOf(FileToReplace(file));
  static_cast<void>(OpenUnfinished(file, unfinished));
  ::unlink(unfinished.c_str());
}

void WriteFileWhole(const std::filesystem::path& file, std::string_view bytes) {
  CheckIsOwnFile(file);
  Replace(file, file, bytes);
}

void WriteNamedFile(const std::filesystem::path& file, std::string_view bytes) {
  Replace(file, FileToReplace(file), bytes);
}

}  // namespace railcast
