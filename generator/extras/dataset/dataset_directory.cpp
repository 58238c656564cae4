#include "generator/extras/dataset/dataset_directory.h"

#include <utility>

#include "core/extras/recipe/dataset_verification.h"
#include "core/extras/recipe/scenario_lines.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/folder_identity.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// What another value of a key of dataset.json means.
std::string DatasetDifference(const std::string& key, const Json& found, const Json& ours) {
  if (key == "recipe_xxh3") return "holds a data set of another recipe";
  if (key == "bases_xxh3") return "holds a data set of the same recipe with other bases";
  if (key == "files_xxh3") {
    return "holds a data set of the same recipe with other contents of the files that it names";
  }
  return "holds another data set: " + ValuesText(key, MemberOf(found, key), MemberOf(ours, key));
}

}  // namespace

DatasetRecord RecordOf(const DatasetSpec& spec) {
  DatasetRecord record = spec.record;
  if (!spec.shard.is_whole()) record.shard = ShardText(spec.shard);
  return record;
}

DatasetDirectory::DatasetDirectory(DatasetSpec spec) : spec_(std::move(spec)) {
  const fs::path& directory = spec_.directory;
  lock_.emplace(directory);
  is_complete_ = fs::exists(directory / kDatasetManifestFile);
  static_cast<void>(TakeFolder({.file = directory / kDatasetFile,
                                .text = RecordFile(RecordOf(spec_)),
                                .is_complete = is_complete_},
                               "a data set", DatasetDifference));
  num_done_ = ScenarioLines(directory / kScenariosFile, spec_.shard)
                  .Skip(spec_.shard.NumOf(spec_.record.num_scenarios));
  num_found_ = num_done_;
}

bool DatasetDirectory::Check(const std::function<bool(double share)>& goes_on) {
  const fs::path& directory = spec_.directory;
  if (is_complete_) {
    const auto show = [&](double share) { static_cast<void>(goes_on(share)); };
    changed_ = FaultsToMend(directory, VerifyDataset(directory, show));
    if (changed_.empty()) return true;
    fs::remove(directory / kDatasetManifestFile);
    is_complete_ = false;
  }
  WriteFileWhole(directory / kRecipeFile, spec_.recipe);
  ScenarioLines lines(directory / kScenariosFile, spec_.shard);
  std::optional<std::uint32_t> first_hole;
  std::uint64_t size = 0;
  for (std::uint32_t i = 0; i < num_found_; ++i) {
    if (!goes_on(static_cast<double>(i) / num_found_)) {
      kept_.clear();
      return false;
    }
    const PlacedLine line = lines.Need();
    const std::uint32_t scenario = spec_.shard.ScenarioAt(i);
    const bool is_whole = VerifyScenario(directory, scenario, line).faults.empty();
    if (is_whole && first_hole) kept_.emplace(i, WithoutLineHash(line.text));
    if (!is_whole && !first_hole) first_hole = i;
    if (!first_hole) size = lines.size();
  }
  num_done_ = first_hole.value_or(num_found_);
  lines_.emplace(directory / kScenariosFile, size);
  return true;
}

const std::string* DatasetDirectory::Kept(std::uint32_t i) const {
  const auto found = kept_.find(i);
  return found == kept_.end() ? nullptr : &found->second;
}

void DatasetDirectory::Append(const std::string& record) {
  lines_->Append(WithLineHash(record) + "\n");
  ++num_done_;
}

void DatasetDirectory::Sync() {
  if (lines_) lines_->Sync();
}

}  // namespace railcast
