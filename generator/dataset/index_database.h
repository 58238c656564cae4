#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "generator/dataset/indexed_scenario.h"

struct sqlite3;

namespace railcast {

/// index.sqlite: the index as tables, for queries. The same scenarios give the same bytes with the
/// same version of SQLite.
class IndexDatabase {
 public:
  /// Begins a new database beside `file`, whose name it gets in Finish().
  /// @throws InputError if the system refuses.
  explicit IndexDatabase(std::filesystem::path file);
  ~IndexDatabase();
  IndexDatabase(const IndexDatabase&) = delete;
  IndexDatabase& operator=(const IndexDatabase&) = delete;

  void Add(const IndexedScenario& scenario);
  /// Writes the database to the disk under its name.
  void Finish();

 private:
  class Insert;
  void Run(const std::string& sql);
  void ForgetInserts();
  void AddSequence(std::int64_t scenario, const IndexedSequence& sequence);
  void AddFrame(std::int64_t sequence, const IndexedFrame& frame);

  std::filesystem::path file_;
  std::filesystem::path unfinished_;
  sqlite3* database_ = nullptr;
  std::int64_t num_sequences_ = 0;
  std::int64_t num_frames_ = 0;
  std::unique_ptr<Insert> scenarios_;
  std::unique_ptr<Insert> sequences_;
  std::unique_ptr<Insert> frames_;
  std::unique_ptr<Insert> files_;
  std::unique_ptr<Insert> objects_;
  std::unique_ptr<Insert> labels_;
};

}  // namespace railcast
