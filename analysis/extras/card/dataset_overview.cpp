#include "analysis/extras/card/dataset_overview.h"

#include "core/base/text.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/sequence_check.h"

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

std::string ReadNamedFile(const fs::path& directory,
                          const DatasetManifestRecord& manifest,
                          std::string_view name) {
  const std::string hash = HashOf(name, manifest.files, directory / kDatasetManifestFile);
  return ReadHashedFile(directory, {std::string(name), hash, {}}, kDatasetManifestFile);
}

}  // namespace

std::string ReadDatasetFile(const fs::path& directory, std::string_view name) {
  return ReadNamedFile(
      directory,
      ReadRecord<DatasetManifestRecord>(ReadManifestText(directory / kDatasetManifestFile),
                                        ShownPath(directory / kDatasetManifestFile)),
      name);
}

DatasetOverview ReadDatasetOverview(const fs::path& directory) {
  const DatasetManifestRecord manifest =
      ReadRecord<DatasetManifestRecord>(ReadManifestText(directory / kDatasetManifestFile),
                                        ShownPath(directory / kDatasetManifestFile));
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
