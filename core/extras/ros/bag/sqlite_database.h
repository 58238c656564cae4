#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace railcast::bag {

enum class SqliteAccess : std::uint8_t {
  kCreate,
  kChange,
  /// Nothing is written, neither to the file nor beside it; what a journal or a write-ahead log
  /// beside it holds is left out. Work in it is limited by its size.
  kRead
};

/// An SQLite database.
class SqliteDatabase {
 public:
  /// @param name Names it in messages.
  /// @throws InputError "name: reason" if it cannot be opened; as CheckIsOwnFile() if it is to be
  ///   written.
  SqliteDatabase(const std::filesystem::path& file, SqliteAccess access, std::string name);
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  /// Runs commands that return no rows.
  /// @throws InputError "file: reason" if the system or SQLite refuses.
  void Run(const std::string& sql);
  /// @throws InputError "file: reason" with what SQLite said last.
  [[noreturn]] void Throw() const;

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  /// As messages show it.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };

  std::string name_;
  std::unique_ptr<sqlite3, Close> handle_;
  std::uint64_t work_left_{};  ///< In hundreds of SQLite's instructions.
};

/// A prepared statement of a database, which it must not outlive.
class SqliteStatement {
 public:
  /// @throws InputError "file: reason" if the database lacks what it names.
  SqliteStatement(SqliteDatabase& database, const std::string& sql);

  /// Begins anew with these parameters.
  template <typename... Values>
  SqliteStatement& With(const Values&... values) {
    Reset();
    int number = 0;
    (Bind(++number, values), ...);
    return *this;
  }

  /// Goes on to the next row; returns whether there is one.
  /// @throws InputError as SqliteDatabase::Run() does.
  bool Step();

  [[nodiscard]] std::int64_t Integer(int column) const;
  [[nodiscard]] std::string Text(int column) const;
  /// Whether the column has bytes, instead of a number, text or nothing.
  [[nodiscard]] bool IsBlob(int column) const;
  /// The column's bytes, valid until the next step.
  [[nodiscard]] std::span<const std::byte> Blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };

  void Reset();
  void Bind(int number, std::int64_t value);
  void Bind(int number, std::string_view value);
  void Bind(int number, std::span<const std::byte> value);

  SqliteDatabase* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

}  // namespace railcast::bag
