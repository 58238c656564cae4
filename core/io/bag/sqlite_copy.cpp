#include <optional>
#include <string>
#include <system_error>

#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/bag/sqlite_bag.h"
#include "core/io/bag/sqlite_database.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

void CopyFileTo(const std::filesystem::path& file, const std::filesystem::path& copy) {
  std::error_code error;
  std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw FileError(copy, error.value());
}

/// A database is opened when its first message is replaced: until then the copy is the file.
class SqliteCopy : public BagCopy {
 public:
  SqliteCopy(const std::filesystem::path& file, const std::filesystem::path& copy)
      : copy_(FileToReplace(copy)), unfinished_(copy_.string() + std::string(kUnfinishedSuffix)) {
    CheckIsReadable(file);
    CopyFileTo(file, unfinished_);
    for (const std::filesystem::path& beside : ChangesBeside(file)) {
      const std::string suffix = beside.string().substr(file.string().size());
      CopyFileTo(beside, unfinished_.string() + suffix);
      suffixes_.push_back(suffix);
    }
  }

  void Put(const BagPlace& place, std::optional<std::span<const std::byte>> data) override {
    if (!data) return;
    if (!database_) {
      database_.emplace(unfinished_, SqliteAccess::kChange, ShownPath(copy_));
      // A copy that was interrupted is made anew.
      database_->Run("PRAGMA synchronous = OFF; BEGIN");
      replace_.emplace(*database_, "UPDATE messages SET data = ? WHERE id = ?");
    }
    replace_->With(*data, static_cast<std::int64_t>(place.in_part.record)).Step();
  }

  void Finish() override {
    if (database_) {
      replace_.reset();
      database_->Run("COMMIT; PRAGMA synchronous = FULL");
      database_.reset();
    }
    Rename(unfinished_, copy_);
    // What stood beside the database was taken in if it was opened.
    for (const std::string& suffix : suffixes_) {
      if (std::filesystem::exists(unfinished_.string() + suffix)) {
        Rename(unfinished_.string() + suffix, copy_.string() + suffix);
      }
    }
  }

 private:
  static void Rename(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (error) throw FileError(to, error.value());
  }

  std::filesystem::path copy_;
  std::filesystem::path unfinished_;
  std::vector<std::string> suffixes_;  ///< Of the files beside it.
  std::optional<SqliteDatabase> database_;
  std::optional<SqliteStatement> replace_;
};

}  // namespace

std::unique_ptr<BagCopy> CopySqliteBag(const std::filesystem::path& file,
                                       const std::filesystem::path& copy) {
  return std::make_unique<SqliteCopy>(file, copy);
}

}  // namespace railcast::bag
