#include "generator/extras/dataset/run_dataset.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/extras/recipe/scenario_lines.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/folder_kind.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "generator/extras/dataset/dataset_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A shard that is to be merged.
struct GivenShard {
  DatasetSpec spec;
  std::optional<ScenarioLines> lines;
};

// Checks the files about a shard's scenarios.
void CheckIsWhole(const fs::path& directory, const DatasetSpec& spec) {
  const std::uint32_t num_scenarios = spec.shard.NumOf(spec.record.num_scenarios);
  if (!fs::exists(directory / kDatasetManifestFile)) {
    ScenarioLines lines(directory / kScenariosFile, spec.shard);
    const std::uint32_t num_done = lines.Skip();
    if (!lines.fault().empty()) throw InputError(lines.fault());
    throw InputError(ShownPath(directory) + ": is unfinished, with " + std::to_string(num_done) +
                     " of " + std::to_string(num_scenarios) +
                     " scenarios; the command that began it continues");
  }
  ErrorList errors;
  for (const std::string& fault : VerifyDatasetFiles(directory).faults) errors.AddLine(fault);
  static_cast<void>(Attempt("", errors, [&] {
    ScenarioLines lines(directory / kScenariosFile, spec.shard);
    for (std::uint32_t i = 0; i < num_scenarios; ++i) static_cast<void>(lines.Need());
    return true;
  }));
  errors.ThrowIfAny();
}

GivenShard ReadShard(const fs::path& directory) {
  CheckFolderKind(directory, kDatasetFile);
  RefuseLinks(directory, {"."});
  const fs::path file = directory / kDatasetFile;
  const std::string text = ReadFileWhole(file);
  const auto record = ReadRecord<DatasetRecord>(text, ShownPath(file));
  // A whole data set is the only shard of itself.
  GivenShard given{.spec = {.directory = directory,
                            .recipe = ReadFileWhole(directory / kRecipeFile),
                            .record = record,
                            .shard = ParseShard(record.shard).value_or(Shard{})},
                   .lines = {}};
  given.spec.record.shard.clear();
  if (ContentHash(given.spec.recipe) != record.recipe_hash || RecordFile(record) != text) {
    throw InputError(ShownPath(file) + ": is damaged: does not suit recipe.json");
  }
  CheckIsWhole(directory, given.spec);
  given.lines.emplace(directory / kScenariosFile, given.spec.shard);
  given.lines->Pause();
  return given;
}

// Returns the shards by their numbers.
std::vector<GivenShard> ReadShards(const std::vector<fs::path>& directories) {
  ErrorList errors;
  std::vector<GivenShard> shards;
  for (const fs::path& directory : directories) {
    if (auto shard = Attempt("", errors, [&] { return ReadShard(directory); })) {
      shards.push_back(std::move(*shard));
    }
  }
  errors.ThrowIfAny();
  std::ranges::stable_sort(shards, {},
                           [](const GivenShard& shard) { return shard.spec.shard.number; });
  const DatasetSpec& first = shards.front().spec;
  std::uint32_t expected = 1;
  for (const auto& [spec, lines] : shards) {
    const std::string place = ShownPath(spec.directory);
    if (RecordText(spec.record) != RecordText(first.record) || spec.shard.of != first.shard.of) {
      errors.Add({place, "is a shard of another data set than " + ShownPath(first.directory), ""});
    } else if (spec.shard.number < expected) {
      errors.Add({place, "is a second shard " + std::to_string(spec.shard.number), ""});
    }
    for (; expected < spec.shard.number; ++expected) {
      errors.AddLine("shard " + std::to_string(expected) + " of " + std::to_string(first.shard.of) +
                     " is missing");
    }
    expected = std::max(expected, spec.shard.number + 1);
  }
  for (; expected <= first.shard.of; ++expected) {
    errors.AddLine("shard " + std::to_string(expected) + " of " + std::to_string(first.shard.of) +
                   " is missing");
  }
  errors.ThrowIfAny();
  return shards;
}

// Links or copies a file. One that is there already must have the same bytes.
void PutFile(const fs::path& from, const fs::path& to) {
  std::error_code error;
  // What a merge that was killed has left; a shard that is whole has no such file.
  fs::remove(to.string() + std::string(kUnfinishedSuffix), error);
  fs::create_hard_link(from, to, error);
  if (!error) return;
  if (fs::exists(to)) {
    if (fs::equivalent(from, to)) return;
    const std::string bytes = ReadFileWhole(from);
    if (ReadFileWhole(to) != bytes) WriteFileWhole(to, bytes);
    return;
  }
  WriteFileWhole(to, ReadFileWhole(from));
}

// Checks a scenario of a shard, with all files of its sequences.
void CheckScenario(const fs::path& directory, std::uint32_t scenario, const PlacedLine& line) {
  ErrorList errors;
  for (const std::string& fault : VerifyScenario(directory, scenario, line).faults) {
    errors.AddLine(fault);
  }
  errors.ThrowIfAny();
}

void PutScenario(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  std::error_code error;
  fs::recursive_directory_iterator entry(from, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    const fs::path target = to / entry->path().lexically_relative(from);
    if (entry->is_directory()) {
      fs::create_directories(target);
    } else {
      PutFile(entry->path(), target);
    }
  }
  if (error) throw FileError(from, error.value());
}

}  // namespace

std::uint32_t MergeShards(
    const std::vector<fs::path>& directories,
    const fs::path& out,
    const std::function<void(std::uint32_t num_done, std::uint32_t num_scenarios)>& on_progress) {
  std::vector<GivenShard> shards = ReadShards(directories);
  DatasetSpec spec = shards.front().spec;
  spec.directory = out;
  spec.shard = {};
  const auto num_shards = static_cast<std::uint32_t>(shards.size());
  DatasetDirectory merged(spec);
  static_cast<void>(merged.Check([](double) { return true; }));
  if (merged.is_complete()) return spec.record.num_scenarios;
  for (auto& [shard, lines] : shards) {
    static_cast<void>(lines->Skip(shard.shard.NumOf(merged.num_done())));
    lines->Pause();
  }
  while (merged.num_done() < spec.record.num_scenarios) {
    const std::uint32_t number = merged.num_done();
    on_progress(number, spec.record.num_scenarios);
    auto& [shard, lines] = shards[number % num_shards];
    const PlacedLine line = lines->Need();
    // The system allows a thousand open files; there may be more shards.
    lines->Pause();
    CheckScenario(shard.directory, number, line);
    const std::string folder = SequenceFolderOf(number);
    PutScenario(shard.directory / folder, out / folder);
    // Files of others are not removed.
    if (merged.WasDone(number)) CheckScenario(out, number, line);
    merged.Append(WithoutLineHash(line.text));
  }
  merged.Sync();
  WriteDatasetFiles(merged.spec());
  return spec.record.num_scenarios;
}

}  // namespace railcast
