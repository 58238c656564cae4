#include "generator/dataset/index_database.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
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

bag::SqliteStatement InsertInto(bag::SqliteDatabase& database,
                                const std::string& table,
                                int num_columns) {
  std::string sql = "INSERT INTO " + table + " VALUES (?";
  for (int i = 1; i < num_columns; ++i) sql += ",?";
  return {database, sql + ")"};
}

Json JsonOf(const NamedValues<Json>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

}  // namespace

IndexDatabase::Inserts::Inserts(bag::SqliteDatabase& database)
    : scenarios(InsertInto(database, "scenarios", 8)),
      sequences(InsertInto(database, "sequences", 6)),
      frames(InsertInto(database, "frames", 7)),
      files(InsertInto(database, "files", 4)),
      objects(InsertInto(database, "objects", 10)),
      labels(InsertInto(database, "labels", 3)) {}

IndexDatabase::IndexDatabase(std::filesystem::path file)
    : file_(std::move(file)), unfinished_(file_.string() + std::string(kUnfinishedSuffix)) {
  std::filesystem::remove(unfinished_);
  database_.emplace(unfinished_, bag::SqliteAccess::kCreate, ShownPath(unfinished_));
  // The file is dropped if the run is interrupted, so that it needs no journal.
  database_->Run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
  database_->Run("BEGIN;");
  database_->Run(kTables);
  inserts_.emplace(*database_);
}

void IndexDatabase::Add(const IndexedScenario& scenario) {
  const ScenarioRecord& record = scenario.record;
  inserts_->scenarios
      .With(std::int64_t{record.scenario}, record.base, record.split, record.line, record.start_s_m,
            JsonOf(record.drawn).dump(), record.placed.dump(), record.weather.dump())
      .Step();
  for (std::size_t i = 0; i < record.sequences.size(); ++i) {
    AddSequence(record.scenario, record.sequences[i], scenario.frames[i]);
  }
}

void IndexDatabase::AddSequence(std::int64_t scenario,
                                const SequenceRecord& sequence,
                                const std::vector<IndexedFrame>& frames) {
  const std::int64_t id = num_sequences_++;
  inserts_->sequences
      .With(id, scenario, sequence.sensor, sequence.folder, std::int64_t{sequence.num_frames},
            static_cast<std::int64_t>(sequence.points))
      .Step();
  for (const IndexedFrame& frame : frames) AddFrame(id, frame);
}

void IndexDatabase::AddFrame(std::int64_t sequence, const IndexedFrame& frame) {
  const auto whole = [](auto number) { return static_cast<std::int64_t>(number); };
  const std::int64_t id = num_frames_++;
  const FrameRecord& record = frame.record;
  inserts_->frames
      .With(id, sequence, whole(record.frame), record.stamp_ns, frame.vehicle_s_m,
            frame.vehicle_speed_mps, whole(record.counts.points))
      .Step();
  for (const KnownFile& file : record.files) {
    inserts_->files.With(id, file.name, whole(file.bytes.value_or(0)), file.hash).Step();
  }
  for (const IndexObjectRecord& object : frame.objects) {
    inserts_->objects
        .With(id, object.name, object.type, object.label, whole(object.instance), object.distance_m,
              whole(object.points), whole(object.firings_visible), whole(object.firings_alone),
              object.occlusion)
        .Step();
  }
  for (const auto& [label, points] : record.counts.points_per_label) {
    inserts_->labels.With(id, label, whole(points)).Step();
  }
}

void IndexDatabase::Finish() {
  // A statement that has not run to its end would keep the tables from being changed.
  inserts_.reset();
  database_->Run(kIndices);
  database_->Run("COMMIT;");
  database_.reset();
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
