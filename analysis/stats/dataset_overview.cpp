#include "analysis/stats/dataset_overview.h"

#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/dataset_record.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// What the manifest says, too, must agree with it.
void CheckAgrees(const std::string& place,
                 const std::string& key,
                 std::uint64_t got,
                 std::uint64_t expected) {
  if (got == expected) return;
  throw InputError(place + ": /" + key + ": must be " + NumberText(expected) + ", as " +
                   std::string(kDatasetManifestFile) + " says" + Got(got));
}

DatasetManifestRecord ReadDatasetManifest(const fs::path& directory) {
  const fs::path file = directory / kDatasetManifestFile;
  const std::string manifest = ReadFileWhole(file);
  CheckManifestHash(manifest, ShownPath(file));
  return ReadRecord<DatasetManifestRecord>(WithoutManifestHash(manifest), ShownPath(file));
}

std::string ReadNamedFile(const fs::path& directory,
                          const DatasetManifestRecord& manifest,
                          std::string_view name) {
  for (const auto& [known, hash] : manifest.files) {
    if (known == name) return ReadHashedFile(directory, {known, hash, {}}, kDatasetManifestFile);
  }
  throw InputError(ShownPath(directory / kDatasetManifestFile) + ": /files_xxh3: must name " +
                   std::string(name));
}

}  // namespace

std::string ReadDatasetFile(const fs::path& directory, std::string_view name) {
  return ReadNamedFile(directory, ReadDatasetManifest(directory), name);
}

DatasetOverview ReadDatasetOverview(const fs::path& directory) {
  const DatasetManifestRecord manifest = ReadDatasetManifest(directory);
  const std::string place = ShownPath(directory / kReportFile);
  const auto report =
      ReadRecord<DatasetReportRecord>(ReadNamedFile(directory, manifest, kReportFile), place);
  CheckAgrees(place, "num_frames", report.num_frames, manifest.num_frames.value_or(0));
  CheckAgrees(place, "points", report.counts.points, manifest.points.value_or(0));
  std::uint64_t num_scenarios = 0;
  for (const auto& [name, split] : report.splits) num_scenarios += split.scenarios;
  CheckAgrees(place, "splits", num_scenarios, manifest.num_scenarios);
  return {directory, manifest.data_hash, manifest.num_scenarios, report};
}

}  // namespace railcast
