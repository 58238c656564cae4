#include "core/extras/ros/bag/sqlite_database.h"

#include <sqlite3.h>

#include <cctype>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

constexpr int kInstructionsPerStep = 100;

/// Returns the file as an SQLite URI that is neither locked nor changed nor searched for journals.
std::string ReadOnlyUri(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char letter : std::filesystem::absolute(file).string()) {
    const auto code = static_cast<unsigned char>(letter);
    const bool is_plain = std::isalnum(code) != 0 || letter == '/' || letter == '.';
    if (is_plain) {
      uri += letter;
      continue;
    }
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    uri += {'%', kDigits[code / 16], kDigits[code % 16]};
  }
  return uri + "?immutable=1";
}

// Pages of a damaged file may refer to each other in circles.
int StopAtEndOfWork(void* work_left) {
  auto& left = *static_cast<std::uint64_t*>(work_left);
  return left-- == 0 ? 1 : 0;
}

}  // namespace

void SqliteDatabase::Close::operator()(sqlite3* handle) const {
  sqlite3_close_v2(handle);
}

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file,
                               SqliteAccess access,
                               std::string name)
    : name_(std::move(name)) {
  int flags = SQLITE_OPEN_READWRITE;
  if (access == SqliteAccess::kCreate) flags |= SQLITE_OPEN_CREATE;
  if (access == SqliteAccess::kRead) flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
  if (access != SqliteAccess::kCreate) CheckIsReadable(file);
  const bool is_read = access == SqliteAccess::kRead;
  if (!is_read) CheckIsOwnFile(file);
  sqlite3* handle = nullptr;
  const int status =
      sqlite3_open_v2(is_read ? ReadOnlyUri(file).c_str() : file.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (status != SQLITE_OK) Throw();
  // Bags of others may hold code.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  if (!is_read) return;
  // What a hostile file may do is limited; every row takes some bytes of it and few instructions.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  work_left_ = std::filesystem::file_size(file) + 10000;
  sqlite3_progress_handler(handle, kInstructionsPerStep, StopAtEndOfWork, &work_left_);
}

void SqliteDatabase::Throw() const {
  if (sqlite3_errcode(handle_.get()) == SQLITE_INTERRUPT) {
    throw InputError(name_ + ": must be whole (got more rows than its bytes can hold)");
  }
  throw InputError(name_ + ": " + ShownText(sqlite3_errmsg(handle_.get())));
}

void SqliteDatabase::Run(const std::string& sql) {
  if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) Throw();
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteStatement::SqliteStatement(SqliteDatabase& database, const std::string& sql)
    : database_(&database) {
  sqlite3_stmt* statement = nullptr;
  const int status = sqlite3_prepare_v2(database.handle(), sql.c_str(),
                                        static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
  if (status != SQLITE_OK) database.Throw();
}

bool SqliteStatement::Step() {
  const int status = sqlite3_step(statement_.get());
  if (status != SQLITE_ROW && status != SQLITE_DONE) database_->Throw();
  return status == SQLITE_ROW;
}

std::int64_t SqliteStatement::Integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string SqliteStatement::Text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return text == nullptr ? std::string() : std::string(text, static_cast<std::size_t>(size));
}

bool SqliteStatement::IsBlob(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_BLOB;
}

std::span<const std::byte> SqliteStatement::Blob(int column) const {
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {bytes, static_cast<std::size_t>(size)};
}

void SqliteStatement::Reset() {
  sqlite3_reset(statement_.get());
}

void SqliteStatement::Bind(int number, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), number, value);
}

void SqliteStatement::Bind(int number, std::string_view value) {
  sqlite3_bind_text64(statement_.get(), number, value.data(), value.size(), SQLITE_TRANSIENT,
                      SQLITE_UTF8);
}

void SqliteStatement::Bind(int number, std::span<const std::byte> value) {
  // Not null, as an empty span may be.
  const void* const bytes = value.empty() ? static_cast<const void*>("") : value.data();
  const int status =
      sqlite3_bind_blob64(statement_.get(), number, bytes, value.size(), SQLITE_TRANSIENT);
  if (status != SQLITE_OK) database_->Throw();
}

}  // namespace railcast::bag
