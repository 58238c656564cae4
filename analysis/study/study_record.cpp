#include "analysis/study/study_record.h"

#include "analysis/study/study_directory.h"
#include "core/base/text.h"
#include "core/io/record/read_record.h"
#include "core/io/write_file.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, StudyFramesRecord& s) {
  a.Required("first", s.first, "");
  a.Required("stride", s.stride, "");
  a.Required("num", s.num, "");
}

void Describe(Archive& a, StudyRecord& s) {
  a.Required("version", s.version, "Of railcast.");
  a.Required("embree", s.embree, "Its version.");
  a.Required("isa", s.isa, "Instruction set of the tracing.");
  a.Required("study_xxh3", s.study_hash, "Hash of the study's file.");
  a.Required("recipe_xxh3", s.recipe_hash, "Hash of its recipe.");
  a.Required("bases_xxh3", s.base_hashes, "Hashes of the resolved bases.");
  a.Required("files_xxh3", s.files_hash, "Hash of the files that the recipe names.");
  a.Required("num_scenarios", s.num_scenarios, "Of all shards.");
  a.Required("frames", s.frames, "Of each approach.");
  a.Optional("shard", s.shard, "Number and count: 2/7.");
  a.Ensure({"shard"}, s.shard.empty() || ParseShard(s.shard), "must be a shard");
}

StudyRecord ReadStudyRecord(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / kStudyFile;
  return ReadRecord<StudyRecord>(ReadFileWhole(file), ShownPath(file));
}

void Describe(Archive& a, StudyManifestRecord& s) {
  a.Required("files_xxh3", s.files, "Hashes of all files.");
}

}  // namespace railcast
