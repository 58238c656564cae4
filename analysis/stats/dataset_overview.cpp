#include "analysis/stats/dataset_overview.h"

#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/dataset_record.h"
#include "core/io/run/dataset_report_record.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using Counts = DatasetOverview::Counts;

// What the manifest says, too, must agree with it.
void CheckAgrees(const std::string& place,
                 const std::string& key,
                 std::uint64_t got,
                 std::uint64_t expected) {
  if (got == expected) return;
  throw InputError(place + ": /" + key + ": must be " + NumberText(expected) + ", as " +
                   std::string(kDatasetManifestFile) + " says" + Got(got));
}

Counts CountsListOf(const CountsByName& counts) {
  return {counts.begin(), counts.end()};
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
  DatasetOverview overview{.source = directory,
                           .data_hash = manifest.data_hash,
                           .num_scenarios = manifest.num_scenarios,
                           .num_frames = report.num_frames,
                           .num_points = report.counts.points,
                           .frames_without_points = report.frames_without_points,
                           .frames_without_objects = report.frames_without_objects,
                           .duplicate_frames = report.duplicate_frames,
                           .parts = {},
                           .classes = {},
                           .types = {},
                           .weathers = CountsListOf(report.weathers),
                           .drawn = {},
                           .frames_by_base = CountsListOf(report.frames_by_base),
                           .frames_by_sensor = CountsListOf(report.frames_by_sensor)};
  std::uint64_t num_scenarios = 0;
  for (const auto& [name, split] : report.splits) {
    overview.parts.push_back({name, split.scenarios, split.frames, split.points});
    num_scenarios += split.scenarios;
  }
  CheckAgrees(place, "splits", num_scenarios, manifest.num_scenarios);
  for (const auto& [name, label] : report.labels) {
    overview.classes.push_back({name, label.points, label.frames});
  }
  for (const auto& [name, type] : report.objects) {
    overview.types.push_back({.name = name,
                              .objects = type.objects,
                              .in_frames = type.in_frames,
                              .with_points = type.with_points,
                              .points = type.points,
                              .by_distance = type.by_distance,
                              .points_by_distance = type.points_by_distance,
                              .by_occlusion = type.by_occlusion});
  }
  for (const auto& [name, counts] : report.drawn)
    overview.drawn.emplace_back(name, CountsListOf(counts));
  return overview;
}

}  // namespace railcast
