#include "generator/dataset/dataset_directory.h"

#include <iterator>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/verify/dataset_verification.h"
#include "core/io/verify/scenario_verification.h"
#include "core/io/write_file.h"
#include "core/recipe/scenario_lines.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// What another value of a key means.
std::string DatasetDifference(const std::string& key, const Json& found, const Json& ours) {
  if (key == "recipe_xxh3") return "holds a data set of another recipe;";
  if (key == "bases_xxh3") return "holds a data set of the same recipe with other bases;";
  if (key == "files_xxh3") {
    return "holds a data set of the same recipe with other contents of the files that it names;";
  }
  if (key == "version") {
    return "must be continued by the railcast that began it, " + ShownText(found.dump()) +
           " (got " + ShownText(ours.dump()) + "); use that one, or";
  }
  if (key == "embree") {
    return "must be continued with the Embree that it was begun with, " + ShownText(found.dump()) +
           " (got " + ShownText(ours.dump()) + ");";
  }
  if (key == "isa") {
    return "must be continued with the instruction set that it was begun with, " +
           ShownText(found.dump()) + " (got " + ShownText(ours.dump()) + "); add --isa, or";
  }
  return "holds another data set: its " + key + " is " + ShownText(found.dump()) + " (got " +
         ShownText(ours.dump()) + ");";
}

// Whether a folder holds no more than the beginning of its first file, which a run that was killed
// leaves.
bool HoldsOnlyBeginningOf(const fs::path& unfinished, const std::string& text) {
  const fs::directory_iterator entry(unfinished.parent_path());
  if (entry == fs::directory_iterator()) return false;
  if (entry->path() != unfinished || !entry->is_regular_file() || entry->is_symlink()) return false;
  return std::next(entry) == fs::directory_iterator() &&
         text.starts_with(ReadFileWhole(unfinished));
}

}  // namespace

DatasetRecord RecordOf(const DatasetSpec& spec) {
  return {.version = spec.version,
          .embree = spec.embree_version,
          .isa = spec.isa,
          .recipe_hash = ContentHash(spec.recipe),
          .base_hashes = spec.base_hashes,
          .num_scenarios = spec.num_scenarios,
          .format = spec.format,
          .fields = spec.fields,
          .is_merged = spec.is_merged,
          .files_hash = spec.files_hash,
          .shard = spec.shard.is_whole() ? "" : ShardText(spec.shard)};
}

DatasetDirectory::DatasetDirectory(DatasetSpec spec) : spec_(std::move(spec)) {
  const fs::path& directory = spec_.directory;
  lock_.emplace(directory);
  const fs::path unfinished =
      directory / (std::string(kDatasetFile) + std::string(kUnfinishedSuffix));
  if (fs::exists(directory / kDatasetFile)) {
    CheckSameDataset();
  } else {
    const std::string text = RecordFile(RecordOf(spec_));
    if (!fs::is_empty(directory) && !HoldsOnlyBeginningOf(unfinished, text)) {
      throw InputError(
          "--out: must be a new or an empty folder, or that of a data set to continue "
          "(got " +
          ShownPath(directory) + ")");
    }
    WriteFileWhole(directory / kDatasetFile, text);
  }
  is_complete_ = fs::exists(directory / kDatasetManifestFile);
  if (!is_complete_) WriteFileWhole(directory / kRecipeFile, spec_.recipe);
  ScenarioLines lines(directory / kScenariosFile, spec_.shard);
  if (is_complete_) {
    const std::uint32_t num_scenarios = spec_.shard.NumOf(spec_.num_scenarios);
    for (; num_done_ < num_scenarios; ++num_done_) static_cast<void>(lines.Need());
  } else {
    num_done_ = lines.Skip();
    lines_.emplace(directory / kScenariosFile, lines.size());
  }
  num_found_ = num_done_;
}

bool DatasetDirectory::Check(const std::function<bool(double share)>& goes_on) {
  const fs::path& directory = spec_.directory;
  if (is_complete_) {
    const auto show = [&](double share) { static_cast<void>(goes_on(share)); };
    RefuseChanged(directory, VerifyDataset(directory, show));
    return true;
  }
  ScenarioLines lines(directory / kScenariosFile, spec_.shard);
  std::optional<std::uint32_t> first_hole;
  std::uint64_t size = 0;
  for (std::uint32_t i = 0; i < num_found_; ++i) {
    if (!goes_on(static_cast<double>(i) / num_found_)) {
      kept_.clear();
      return false;
    }
    const std::uint64_t before = lines.size();
    const PlacedLine line = lines.Need();
    const std::uint32_t scenario = spec_.shard.ScenarioAt(i);
    const bool is_whole = VerifyScenario(directory, scenario, line).faults.empty();
    if (is_whole && first_hole) kept_.emplace(i, WithoutLineHash(line.text));
    if (is_whole || first_hole) continue;
    first_hole = i;
    size = before;
  }
  if (!first_hole) return true;
  num_done_ = *first_hole;
  lines_.emplace(directory / kScenariosFile, size);
  return true;
}

const std::string* DatasetDirectory::Kept(std::uint32_t i) const {
  const auto found = kept_.find(i);
  return found == kept_.end() ? nullptr : &found->second;
}

void DatasetDirectory::CheckSameDataset() const {
  const fs::path file = spec_.directory / kDatasetFile;
  const Json found = Json::parse(ReadFileWhole(file), nullptr, false);
  if (!found.is_object()) throw InputError(ShownPath(file) + ": is damaged: is no JSON object");
  Json ours = Json::parse(RecordText(RecordOf(spec_)));
  if (found.contains("shard") && !ours.contains("shard")) ours["shard"] = nullptr;
  for (const auto& [key, value] : ours.items()) {
    const Json other = found.value(key, Json());
    if (other == value) continue;
    throw InputError(ShownPath(spec_.directory) + ": " + DatasetDifference(key, other, value) +
                     " choose another --out");
  }
}

void DatasetDirectory::Append(const std::string& record) {
  lines_->Append(WithLineHash(record) + "\n");
  ++num_done_;
}

void DatasetDirectory::Sync() {
  if (lines_) lines_->Sync();
}

}  // namespace railcast
