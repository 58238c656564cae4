#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/io/bag/sqlite_database.h"
#include "generator/dataset/indexed_scenario.h"

namespace railcast {

/// index.sqlite: the index as tables, for queries. The same scenarios give the same bytes with the
/// same version of SQLite.
class IndexDatabase {
 public:
  /// Begins a new database beside `file`, whose name it gets in Finish().
  /// @throws InputError if the system refuses.
  explicit IndexDatabase(std::filesystem::path file);
  void Add(const IndexedScenario& scenario);
  /// Writes the database to the disk under its name.
  void Finish();

 private:
  /// The rows of its tables.
  struct Inserts {
    explicit Inserts(bag::SqliteDatabase& database);

    bag::SqliteStatement scenarios;
    bag::SqliteStatement sequences;
    bag::SqliteStatement frames;
    bag::SqliteStatement files;
    bag::SqliteStatement objects;
    bag::SqliteStatement labels;
  };
  void AddSequence(std::int64_t scenario,
                   const SequenceRecord& sequence,
                   const std::vector<IndexedFrame>& frames);
  void AddFrame(std::int64_t sequence, const IndexedFrame& frame);

  std::filesystem::path file_;
  std::filesystem::path unfinished_;
  std::optional<bag::SqliteDatabase> database_;
  std::optional<Inserts> inserts_;
  std::int64_t num_sequences_ = 0;
  std::int64_t num_frames_ = 0;
};

}  // namespace railcast
