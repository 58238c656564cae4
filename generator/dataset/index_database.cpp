#include "generator/dataset/index_database.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr const char* kTables = R"(
CREATE TABLE scenarios (
  scenario INTEGER PRIMARY KEY, base TEXT, split TEXT, line TEXT, start_s_m REAL, drawn TEXT,
  placed TEXT, weather TEXT);
CREATE TABLE sequences (
  id INTEGER PRIMARY KEY, scenario INTEGER REFERENCES scenarios, sensor TEXT, folder TEXT,
  num_frames INTEGER, points INTEGER);
CREATE TABLE frames (
  id INTEGER PRIMARY KEY, sequence_id INTEGER REFERENCES sequences, frame INTEGER,
  stamp_ns INTEGER, vehicle_s_m REAL, vehicle_speed_mps REAL, points INTEGER);
CREATE TABLE files (frame_id INTEGER REFERENCES frames, name TEXT, bytes INTEGER, xxh3 TEXT);
CREATE TABLE objects (
  frame_id INTEGER REFERENCES frames, name TEXT, type TEXT, label TEXT, instance INTEGER,
  distance_m REAL, points INTEGER, firings_visible INTEGER, firings_alone INTEGER, occlusion REAL);
CREATE TABLE labels (frame_id INTEGER REFERENCES frames, label TEXT, points INTEGER);
)";

constexpr const char* kIndices = R"(
CREATE INDEX sequences_by_scenario ON sequences (scenario);
CREATE INDEX frames_by_sequence ON frames (sequence_id);
CREATE INDEX files_by_frame ON files (frame_id);
CREATE INDEX objects_by_frame ON objects (frame_id);
CREATE INDEX objects_by_type ON objects (type);
CREATE INDEX labels_by_frame ON labels (frame_id);
)";

}  // namespace

/// A prepared INSERT.
class IndexDatabase::Insert {
 public:
  Insert(sqlite3* database, const std::string& table, int num_columns) : database_(database) {
    std::string sql = "INSERT INTO " + table + " VALUES (?";
    for (int i = 1; i < num_columns; ++i) sql += ",?";
    sql += ")";
    const int status = sqlite3_prepare_v2(database, sql.c_str(), static_cast<int>(sql.size()),
                                          &statement_, nullptr);
    Check(status == SQLITE_OK, "the tables of the index have these columns");
  }
  ~Insert() { sqlite3_finalize(statement_); }
  Insert(const Insert&) = delete;
  Insert& operator=(const Insert&) = delete;

  /// Adds a row.
  template <class... Values>
  void operator()(const Values&... values) {
    int column = 0;
    (Bind(++column, values), ...);
    const int status = sqlite3_step(statement_);
    sqlite3_reset(statement_);
    if (status != SQLITE_DONE) throw InputError(sqlite3_errmsg(database_));
  }

 private:
  void Bind(int column, std::int64_t value) { sqlite3_bind_int64(statement_, column, value); }
  void Bind(int column, double value) { sqlite3_bind_double(statement_, column, value); }
  void Bind(int column, const std::optional<double>& value) {
    if (value) {
      Bind(column, *value);
    } else {
      sqlite3_bind_null(statement_, column);
    }
  }
  void Bind(int column, const std::string& value) {
    sqlite3_bind_text(statement_, column, value.data(), static_cast<int>(value.size()),
                      SQLITE_TRANSIENT);
  }

  sqlite3* database_;
  sqlite3_stmt* statement_ = nullptr;
};

IndexDatabase::IndexDatabase(std::filesystem::path file)
    : file_(std::move(file)), unfinished_(file_.string() + std::string(kUnfinishedSuffix)) {
  std::filesystem::remove(unfinished_);
  if (sqlite3_open(unfinished_.c_str(), &database_) != SQLITE_OK) {
    const std::string reason = sqlite3_errmsg(database_);
    sqlite3_close(database_);
    throw InputError(ShownPath(unfinished_) + ": " + reason);
  }
  // The file is dropped if the run is interrupted, so that it needs no journal.
  Run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
  Run("BEGIN;");
  Run(kTables);
  scenarios_ = std::make_unique<Insert>(database_, "scenarios", 8);
  sequences_ = std::make_unique<Insert>(database_, "sequences", 6);
  frames_ = std::make_unique<Insert>(database_, "frames", 7);
  files_ = std::make_unique<Insert>(database_, "files", 4);
  objects_ = std::make_unique<Insert>(database_, "objects", 10);
  labels_ = std::make_unique<Insert>(database_, "labels", 3);
}

void IndexDatabase::ForgetInserts() {
  for (auto* const insert : {&scenarios_, &sequences_, &frames_, &files_, &objects_, &labels_}) {
    insert->reset();
  }
}

IndexDatabase::~IndexDatabase() {
  ForgetInserts();
  sqlite3_close(database_);
}

void IndexDatabase::Run(const std::string& sql) {
  if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) return;
  throw InputError(ShownPath(unfinished_) + ": " + sqlite3_errmsg(database_));
}

void IndexDatabase::Add(const IndexedScenario& scenario) {
  const Json& record = scenario.record;
  const auto text = [&](const char* key) { return record.at(key).get<std::string>(); };
  const auto number = record.at("scenario").get<std::int64_t>();
  (*scenarios_)(number, text("base"), text("split"), text("line"),
                record.at("start_s_m").get<double>(), record.at("drawn").dump(),
                record.at("placed").dump(), record.at("weather").dump());
  for (const IndexedSequence& sequence : scenario.sequences) AddSequence(number, sequence);
}

void IndexDatabase::AddSequence(std::int64_t scenario, const IndexedSequence& sequence) {
  const std::int64_t id = num_sequences_++;
  const Json& record = sequence.record;
  (*sequences_)(id, scenario, record.at("sensor").get<std::string>(),
                record.at("folder").get<std::string>(), record.at("num_frames").get<std::int64_t>(),
                record.at("points").get<std::int64_t>());
  for (const IndexedFrame& frame : sequence.frames) AddFrame(id, frame);
}

void IndexDatabase::AddFrame(std::int64_t sequence, const IndexedFrame& frame) {
  const auto whole = [](auto number) { return static_cast<std::int64_t>(number); };
  const std::int64_t id = num_frames_++;
  const FrameRecord& record = frame.record;
  (*frames_)(id, sequence, whole(record.frame), record.stamp_ns, frame.vehicle_s_m,
             frame.vehicle_speed_mps, whole(record.counts.points));
  for (const WrittenFile& file : record.files)
    (*files_)(id, file.name, whole(file.size), file.hash);
  for (const IndexedObject& object : frame.objects) {
    (*objects_)(id, object.name, object.type, object.label, whole(object.instance),
                object.distance_m, whole(object.points), whole(object.firings_visible),
                whole(object.firings_alone), object.occlusion);
  }
  for (const auto& [label, points] : record.counts.points_per_label) {
    (*labels_)(id, label, whole(points));
  }
}

void IndexDatabase::Finish() {
  Run(kIndices);
  Run("COMMIT;");
  ForgetInserts();
  const int status = sqlite3_close(std::exchange(database_, nullptr));
  Check(status == SQLITE_OK, "nothing of the index is in use any more");
  const int descriptor = ::open(unfinished_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw FileError(unfinished_, errno);
  const bool is_synced = ::fsync(descriptor) == 0;
  const int reason = errno;
  ::close(descriptor);
  if (!is_synced) throw FileError(unfinished_, reason);
  std::error_code error;
  std::filesystem::rename(unfinished_, file_, error);
  if (error) throw FileError(file_, error.value());
}

}  // namespace railcast
