#include "analysis/extras/study/study_directory.h"

#include <map>
#include <regex>
#include <string>
#include <utility>

#include "analysis/extras/study/kept_files.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/recipe/scenario_lines.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/folder_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/findings.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, StudyFramesRecord& s) {
  a.Required("first", s.first, "Number of the first frame.");
  a.Required("stride", s.stride, "Step from one frame's number to the next.");
  a.Required("num", s.num, "Number of frames.");
}

void Describe(Archive& a, StudyRecord& s) {
  a.Required("version", s.version, "Version of railcast.");
  a.Required("embree", s.embree, "Version of Embree.");
  a.Required("isa", s.isa, "Instruction set of the tracing.");
  a.Required("study_xxh3", s.study_hash, "Hash of the study's file.");
  a.Required("recipe_xxh3", s.recipe_hash, "Hash of the study's recipe.");
  a.Required("bases_xxh3", s.base_hashes, "Hashes of the resolved bases.");
  a.Required("files_xxh3", s.files_hash, "Hash of the files that the recipe names.");
  a.Required("num_scenarios", s.num_scenarios, "Number of scenarios in all shards together.");
  a.Required("frames", s.frames, "Which frames of each approach are made.");
  a.Optional("certify", s.certify, "Share of the time that certificates may take.");
  a.Optional("shard", s.shard, "Number and count of the shard, as in 2/7.");
  a.Optional("rare", s.rare, "How rare failures are sought.");
  a.Ensure({"shard"}, s.shard.empty() || ParseShard(s.shard), "must be a shard");
}

StudyRecord ReadStudyRecord(const std::filesystem::path& directory) {
  CheckFolderKind(directory, kStudyFile);
  const std::filesystem::path file = directory / kStudyFile;
  return ReadRecord<StudyRecord>(ReadFileWhole(file), ShownPath(file));
}

void Describe(Archive& a, StudyManifestRecord& s) {
  a.Required("files_xxh3", s.files, "Hashes of all files.");
}

namespace {

namespace fs = std::filesystem;

// study.json of a shard.
StudyRecord WithShard(StudyRecord identity, const Shard& shard) {
  if (!shard.is_whole()) identity.shard = ShardText(shard);
  return identity;
}

// What another value of a key of study.json means.
std::string StudyDifference(const std::string& key, const Json& found, const Json& ours) {
  if (key == "study_xxh3") return "holds another study";
  if (key == "recipe_xxh3" || key == "bases_xxh3" || key == "files_xxh3" || key == "frames") {
    return "holds the same study of another recipe, of other bases or of other files";
  }
  return "holds another study: " + ValuesText(key, MemberOf(found, key), MemberOf(ours, key));
}

// Refuses what a study and its report have not written, and removes what they have left unfinished.
void RefuseStrangers(const fs::path& directory) {
  const std::regex own(R"((study|manifest)\.json|approaches\.jsonl|inputs/(study|recipe)\.json|)"
                       R"((worst|sample)/\d+/(scenario\.resolved\.json|inputs/.+)|)" +
                       std::string(kFilesOfReport));
  std::vector<fs::path> unfinished;
  ForEachFileBelow(directory, directory, {}, [&](const std::string& name) {
    if (std::regex_match(name, own)) return;
    const auto finished = FinishedName(name);
    if (!finished || !std::regex_match(finished->begin(), finished->end(), own)) {
      RefuseStranger(directory, name);
    }
    unfinished.push_back(directory / name);
  });
  for (const fs::path& file : unfinished) fs::remove(file);
}

}  // namespace

StudyDirectory::StudyDirectory(fs::path directory, StudyRecord identity, const Shard& shard)
    : directory_(std::move(directory)), shard_(shard) {
  lock_.emplace(directory_);
  const StudyRecord ours = WithShard(std::move(identity), shard);
  const bool is_new = TakeFolder({.file = directory_ / kStudyFile, .text = RecordFile(ours)},
                                 "a study", StudyDifference);
  if (!is_new) RefuseStrangers(directory_);
  ScenarioLines lines(directory_ / kApproachesFile, shard_);
  // How many approaches rare failures take, only their run tells.
  const std::uint32_t num_own = shard.NumOf(ours.num_scenarios);
  num_done_ = ours.rare.empty() ? lines.Skip(num_own) : lines.Skip();
  // A study whose lines are to be made anew is unfinished.
  if (ours.rare.empty() && num_done_ < num_own) fs::remove(directory_ / kManifestFile);
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
  if (!lines.fault().empty()) throw InputError(lines.fault());
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
    CheckIsSame({.file = folder / kStudyFile,
                 .text = RecordFile(WithShard(identity, *shard)),
                 .advice = "choose another shard"},
                StudyDifference);
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
