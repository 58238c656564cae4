#include "analysis/study/study_directory.h"

#include <map>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/write_file.h"
#include "core/recipe/scenario_lines.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// study.json of a shard.
StudyRecord WithShard(StudyRecord identity, const Shard& shard) {
  if (!shard.is_whole()) identity.shard = ShardText(shard);
  return identity;
}

// What another value of a key means.
std::string StudyDifference(const std::string& key, const Json& found, const Json& ours) {
  if (key == "study_xxh3") return "holds another study";
  if (key == "recipe_xxh3" || key == "bases_xxh3" || key == "files_xxh3" || key == "frames") {
    return "holds the same study of another recipe, of other bases or of other files";
  }
  return "holds a study whose " + key + " is " + ShownText(found.dump()) + " (got " +
         ShownText(ours.dump()) + ")";
}

// @param other What to do about it.
void CheckSameStudy(const fs::path& directory, const StudyRecord& ours, const std::string& other) {
  const Json found = Json::parse(RecordText(ReadStudyRecord(directory)));
  Json all = Json::parse(RecordText(ours));
  for (const auto& [key, value] : found.items()) all.emplace(key, nullptr);
  for (const auto& [key, value] : all.items()) {
    const Json theirs = found.value(key, Json());
    if (theirs == value) continue;
    throw InputError(ShownPath(directory) + ": " + StudyDifference(key, theirs, value) + other);
  }
}

}  // namespace

StudyDirectory::StudyDirectory(fs::path directory, StudyRecord identity, const Shard& shard)
    : directory_(std::move(directory)), shard_(shard) {
  lock_.emplace(directory_);
  const StudyRecord ours = WithShard(std::move(identity), shard);
  if (fs::exists(directory_ / kStudyFile)) {
    CheckSameStudy(directory_, ours, "; choose another --out");
  } else {
    if (!fs::is_empty(directory_)) {
      throw InputError(
          "--out: must be a new or an empty folder, or that of a study to continue (got " +
          ShownPath(directory_) + ")");
    }
    WriteFileWhole(directory_ / kStudyFile, RecordFile(ours));
  }
  ScenarioLines lines(directory_ / kApproachesFile, shard_);
  num_done_ = lines.Skip(shard.NumOf(ours.num_scenarios));
  lines_.emplace(directory_ / kApproachesFile, lines.size());
}

void StudyDirectory::Append(const std::string& record) {
  lines_->Append(WithLineHash(record) + "\n");
  ++num_done_;
}

std::vector<ApproachRecord> StudyDirectory::Read() const {
  ScenarioLines lines(directory_ / kApproachesFile, shard_);
  std::vector<ApproachRecord> records;
  for (std::uint32_t i = 0; i < num_done_; ++i) {
    const PlacedLine line = lines.Need();
    records.push_back(ReadRecordLine<ApproachRecord>(line.text, line.place));
  }
  return records;
}

std::vector<ApproachRecord> ReadApproaches(const fs::path& directory) {
  ScenarioLines lines(directory / kApproachesFile, {});
  std::vector<ApproachRecord> records;
  while (const auto line = lines.Next()) {
    records.push_back(ReadRecordLine<ApproachRecord>(line->text, line->place));
  }
  return records;
}

void MergeStudies(const std::vector<fs::path>& shards,
                  const StudyRecord& identity,
                  StudyDirectory& into) {
  std::map<std::uint32_t, ScenarioLines> by_number;
  std::uint32_t num_shards = 0;
  for (const fs::path& folder : shards) {
    const auto shard = ParseShard(ReadStudyRecord(folder).shard);
    if (!shard) throw InputError(ShownPath(folder) + ": must be a shard of the study");
    CheckSameStudy(folder, WithShard(identity, *shard), "");
    if (num_shards == 0) num_shards = shard->of;
    ScenarioLines lines(folder / kApproachesFile, *shard);
    lines.Pause();
    if (shard->of != num_shards || !by_number.emplace(shard->number, std::move(lines)).second) {
      throw InputError(ShownPath(folder) + ": must be another of " + std::to_string(num_shards) +
                       " shards (got " + ShardText(*shard) + ")");
    }
  }
  if (by_number.size() != num_shards) {
    throw InputError("--shards: must be all " + std::to_string(num_shards) + " shards (got " +
                     std::to_string(by_number.size()) + ")");
  }
  for (std::uint32_t i = into.num_done(); i < identity.num_scenarios; ++i) {
    into.Append(WithoutLineHash(by_number.at(i % num_shards + 1).Need().text));
  }
}

}  // namespace railcast
