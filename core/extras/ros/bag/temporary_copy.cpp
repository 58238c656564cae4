#include "core/extras/ros/bag/temporary_copy.h"

#include <fcntl.h>
#include <stdlib.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file_descriptor.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/ros/mcap/compression.h"

namespace railcast::bag {
namespace {

// Bags become a tenth of their size at the smallest; those of still pictures less.
constexpr std::uint64_t kMaxRatio = 1000;

}  // namespace

TemporaryCopy::TemporaryCopy() {
  std::string name = (std::filesystem::temp_directory_path() / "railcast-bag-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw FileError(name, errno);
  folder_ = name;
}

TemporaryCopy::~TemporaryCopy() {
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
}

void TemporaryCopy::Add(const std::filesystem::path& file) const {
  std::error_code error;
  std::filesystem::copy_file(file, folder_ / file.filename(), error);
  if (error) throw FileError(file, error.value());
}

std::filesystem::path TemporaryCopy::AddUncompressed(const std::filesystem::path& file) const {
  std::filesystem::path copy = folder_ / file.stem();
  constexpr int kAccess = 0600;
  const FileDescriptor opened(
      ::open(copy.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAccess));
  if (!opened.is_open()) throw FileError(copy, errno);
  mcap::UncompressFile(file, opened.number(), kMaxRatio);
  return copy;
}

}  // namespace railcast::bag
