#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/bag/bag.h"
#include "core/io/bag/bag_metadata.h"
#include "core/io/bag/bag_reader.h"
#include "core/io/bag/mcap_bag.h"
#include "core/io/bag/sqlite_bag.h"
#include "core/io/bag/temporary_copy.h"
#include "core/io/mcap/byte_file.h"
#include "core/io/mcap/record_scan.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

/// Whether rosbag2 compressed the file as a whole.
bool IsZstd(const std::filesystem::path& file) {
  constexpr std::array<char, 4> kBegin = {'\x28', '\xB5', '\x2F', '\xFD'};
  std::array<char, kBegin.size()> begin{};
  std::ifstream(file, std::ios::binary).read(begin.data(), begin.size());
  return begin == kBegin;
}

bool IsMcap(const std::filesystem::path& file) {
  return mcap::BeginsAsMcap(mcap::ByteFile(file, ShownPath(file)));
}

/// Whether the name is that of a bag's file, compressed or unfinished or not.
bool HasNameOfBag(std::filesystem::path file) {
  for (const std::string_view suffix : {std::string_view(".zstd"), kUnfinishedSuffix}) {
    if (file.extension() == suffix) file.replace_extension();
  }
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

std::unique_ptr<BagReader> OpenBagFile(const std::filesystem::path& file, const std::string& name) {
  CheckIsReadable(file);
  if (IsMcap(file)) return OpenMcapBag(file, name);
  if (IsSqlite(file)) return OpenSqliteBag(file, name);
  if (IsZstd(file)) {
    const TemporaryCopy copy;
    const std::filesystem::path plain = copy.AddUncompressed(file);
    if (IsMcap(plain)) return OpenMcapBag(plain, name);
    if (IsSqlite(plain)) return OpenSqliteBag(plain, name);
  }
  throw InputError(name + ": must be an MCAP file or a database of rosbag2 (got neither)");
}

/// Returns the bag's files in a directory without metadata.yaml, by their names' numbers.
std::vector<std::filesystem::path> BagFilesIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (HasNameOfBag(entry.path()) && entry.is_regular_file(error)) files.push_back(entry.path());
  }
  // Times say the order of the messages; this one decides between equal ones.
  std::ranges::sort(files, {}, [](const std::filesystem::path& file) {
    return std::pair(file.native().size(), file.native());
  });
  return files;
}

BagParts PartsIn(const std::filesystem::path& directory) {
  if (exists(directory / kMetadataFile)) return ReadBagParts(directory);
  return {.files = BagFilesIn(directory)};
}

}  // namespace

std::unique_ptr<BagReader> OpenBag(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!exists(status)) throw FileError(path, error ? error.value() : ENOENT);
  if (!is_directory(status)) return OpenBagFile(path, ShownPath(path));
  const BagParts parts = PartsIn(path);
  std::vector<std::unique_ptr<BagReader>> readers;
  for (const std::filesystem::path& file : parts.files) {
    readers.push_back(OpenBagFile(file, ShownPath(file)));
  }
  if (readers.empty()) {
    throw InputError(ShownPath(path) + ": must hold .mcap or .db3 files (got none)");
  }
  auto bag = Merged(std::move(readers));
  if (!parts.are_messages_compressed) return bag;
  return WithUncompressedMessages(std::move(bag), ShownPath(path));
}

bool IsBag(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (is_directory(status)) {
    return exists(path / kMetadataFile) || !BagFilesIn(path).empty();
  }
  return is_regular_file(status) && (HasNameOfBag(path) || IsMcap(path) || IsSqlite(path));
}

}  // namespace railcast::bag
