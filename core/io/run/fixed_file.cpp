#include "core/io/run/fixed_file.h"

#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/run/run_folder.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::string HashOf(const FixedFile& file) {
  if (!file.hash.empty()) return file.hash;
  return file.bytes ? ContentHash(*file.bytes) : HashFile(file.copy_of).hash;
}

bool BecomesLink(const fs::path& path, const fs::path& other) {
  std::error_code error;
  fs::remove(path, error);
  if (!error) fs::create_hard_link(other, path, error);
  return !error;
}

}  // namespace

FixedFile FixedText(std::string name, std::string text) {
  return {.name = std::move(name), .bytes = std::make_shared<const std::string>(std::move(text))};
}

bool HasFixedFile(const fs::path& folder, const FixedFile& file) {
  const fs::path path = folder / file.name;
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path, error))) return false;
  const std::uintmax_t size = file.bytes ? file.bytes->size() : fs::file_size(file.copy_of, error);
  return !error && fs::file_size(path, error) == size && !error &&
         HashFile(path).hash == HashOf(file);
}

void WriteFixedFile(const fs::path& folder, const FixedFile& file, const fs::path& twin) {
  if (HasFixedFile(folder, file)) return;
  const fs::path path = folder / file.name;
  MakeFolders(path.parent_path());
  CheckIsOwnFile(path);
  if (!twin.empty() && BecomesLink(path, twin / file.name)) return;
  if (file.bytes) {
    WriteFileWhole(path, *file.bytes);
    return;
  }
  const UnfinishedFile copy(path, 0);
  copy.AppendFile(file.copy_of);
  copy.Finish();
  if (file.hash.empty() || HashFile(path).hash == file.hash) return;
  fs::remove(path);
  throw InputError(ShownPath(file.copy_of) +
                   ": was changed while the scenario was read; run it again");
}

}  // namespace railcast
