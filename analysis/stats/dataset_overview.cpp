#include "analysis/stats/dataset_overview.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/run/dataset_files.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using Counts = DatasetOverview::Counts;

/// A value of report.json and where it stands.
struct PlacedJson {
  const StrictOrderedJson& json;
  std::string file;
  std::string pointer{};

  [[nodiscard]] PlacedJson At(const std::string& key) const {
    return {json.at(key), file, pointer + PointerStep(key)};
  }
  [[noreturn]] void Refuse(const std::string& rule) const {
    throw InputError(file + ": is damaged: " + (pointer.empty() ? "" : pointer + ": ") + rule);
  }

  /// The number of a key.
  [[nodiscard]] std::uint64_t CountOf(const std::string& key,
                                      std::uint64_t most = UINT64_MAX) const {
    const std::uint64_t count = json.at(key);
    if (count > most) At(key).Refuse("must be <= " + NumberText(most) + Got(count));
    return count;
  }

  void CheckKeys(std::initializer_list<std::string_view> known) const {
    for (const auto& [key, value] : json.items()) {
      if (std::ranges::find(known, key) == known.end()) Refuse("unknown key " + ShownText(key));
    }
  }

  void CheckAgrees(const std::string& key, std::uint64_t expected) const {
    const std::uint64_t count = CountOf(key);
    if (count == expected) return;
    At(key).Refuse("must be " + NumberText(expected) + ", as " + std::string(kDatasetManifestFile) +
                   " says" + Got(count));
  }

  void CheckSum(std::uint64_t sum, std::uint64_t expected) const {
    if (sum != expected) Refuse("must sum up to " + NumberText(expected) + Got(sum));
  }

  /// Numbers by name that sum up to a total.
  [[nodiscard]] Counts CountsOf(const std::string& key, std::uint64_t total) const {
    const PlacedJson all = At(key);
    Counts counts;
    std::uint64_t sum = 0;
    for (const auto& [name, count] : all.json.items()) {
      counts.emplace_back(name, count.get<std::uint64_t>());
      sum += counts.back().second;
    }
    all.CheckSum(sum, total);
    return counts;
  }

  /// Numbers of bins whose names are known, in their order.
  template <std::size_t kCount, typename NameOfBin>
  [[nodiscard]] std::array<std::uint64_t, kCount> BinsOf(const std::string& key,
                                                         std::uint64_t total,
                                                         const NameOfBin& name_of) const {
    const Counts counts = CountsOf(key, total);
    std::array<std::uint64_t, kCount> bins{};
    if (counts.size() != kCount) At(key).Refuse("must have " + NumberText(kCount) + " bins");
    for (std::size_t i = 0; i < kCount; ++i) {
      bins[i] = At(key).json.at(std::string(name_of(i)));
    }
    return bins;
  }
};

std::vector<DatasetOverview::Part> PartsOf(const PlacedJson& report,
                                           const DatasetOverview& overview) {
  std::vector<DatasetOverview::Part> parts;
  std::uint64_t scenarios = 0, frames = 0, points = 0;
  const PlacedJson all = report.At("splits");
  for (const auto& [name, part] : all.json.items()) {
    const PlacedJson placed = all.At(name);
    placed.CheckKeys({"scenarios", "frames", "points"});
    parts.push_back({name, part.at("scenarios"), part.at("frames"), part.at("points")});
    scenarios += parts.back().scenarios;
    frames += parts.back().frames;
    points += parts.back().points;
  }
  all.CheckSum(scenarios, overview.num_scenarios);
  all.CheckSum(frames, overview.num_frames);
  all.CheckSum(points, overview.num_points);
  return parts;
}

std::vector<DatasetOverview::Class> ClassesOf(const PlacedJson& report,
                                              const DatasetOverview& overview) {
  std::vector<DatasetOverview::Class> classes;
  std::uint64_t points = 0;
  const PlacedJson all = report.At("labels");
  for (const auto& [name, label] : all.json.items()) {
    const PlacedJson placed = all.At(name);
    placed.CheckKeys({"points", "share", "frames"});
    classes.push_back({name, label.at("points"), placed.CountOf("frames", overview.num_frames)});
    points += classes.back().points;
  }
  // Recordings may be without labels.
  if (!classes.empty()) all.CheckSum(points, overview.num_points);
  return classes;
}

DatasetOverview::TypeCounts TypeOf(const std::string& name, const PlacedJson& json) {
  json.CheckKeys({"objects", "in_frames", "with_points", "points", "by_distance",
                  "points_by_distance", "by_occlusion"});
  DatasetOverview::TypeCounts type{.name = name};
  type.in_frames = json.CountOf("in_frames");
  type.objects = json.CountOf("objects", type.in_frames);
  type.with_points = json.CountOf("with_points", type.in_frames);
  type.points = json.CountOf("points");
  type.by_distance = json.BinsOf<kNumDistanceBins>("by_distance", type.in_frames, DistanceBinName);
  type.points_by_distance =
      json.BinsOf<kNumDistanceBins>("points_by_distance", type.points, DistanceBinName);
  type.by_occlusion = json.BinsOf<kNumOcclusionBins>(
      "by_occlusion", type.in_frames, [](std::size_t i) { return kOcclusionBinNames.at(i); });
  return type;
}

void ReadReport(const PlacedJson& report, DatasetOverview& overview) {
  report.CheckKeys({"num_frames", "splits", "frames_without_points", "frames_without_objects",
                    "duplicate_frames", "points", "outcomes", "points_per_label", "labels",
                    "objects", "weathers", "drawn", "frames_by_base", "frames_by_sensor"});
  const std::uint64_t num_frames = overview.num_frames;
  report.CheckAgrees("num_frames", num_frames);
  report.CheckAgrees("points", overview.num_points);
  overview.frames_without_points = report.CountOf("frames_without_points", num_frames);
  overview.frames_without_objects = report.CountOf("frames_without_objects", num_frames);
  overview.duplicate_frames = report.CountOf("duplicate_frames", num_frames);
  overview.parts = PartsOf(report, overview);
  overview.classes = ClassesOf(report, overview);
  const PlacedJson objects = report.At("objects");
  for (const auto& [name, type] : objects.json.items()) {
    overview.types.push_back(TypeOf(name, objects.At(name)));
  }
  overview.weathers = report.CountsOf("weathers", overview.num_scenarios);
  for (const auto& [name, words] : report.json.at("drawn").items()) {
    Counts counts;
    for (const auto& [word, count] : words.items()) counts.emplace_back(word, count);
    overview.drawn.emplace_back(name, std::move(counts));
  }
  overview.frames_by_base = report.CountsOf("frames_by_base", num_frames);
  overview.frames_by_sensor = report.CountsOf("frames_by_sensor", num_frames);
}

// Calls a function with the content of manifest.json and returns its result.
template <typename Use>
auto ReadDatasetManifest(const fs::path& directory, const Use& use) {
  const fs::path file = directory / kDatasetManifestFile;
  const std::string manifest = ReadFileWhole(file);
  CheckManifestHash(manifest, ShownPath(file));
  return ReadRecordedJson<StrictJson>(manifest, ShownPath(file), use);
}

}  // namespace

std::string ReadDatasetFile(const fs::path& directory, std::string_view name) {
  const std::string file(name);
  const auto hash = ReadDatasetManifest(directory, [&](const StrictJson& json) -> std::string {
    return json.at("files_xxh3").at(file);
  });
  return ReadHashedFile(directory, {file, hash, {}}, kDatasetManifestFile);
}

DatasetOverview ReadDatasetOverview(const fs::path& directory) {
  auto overview = ReadDatasetManifest(directory, [&](const StrictJson& json) {
    DatasetOverview counted;
    counted.source = directory;
    counted.data_hash = json.at("data_xxh3");
    counted.num_scenarios = json.at("num_scenarios");
    counted.num_frames = json.at("num_frames");
    counted.num_points = json.at("points");
    return counted;
  });
  const std::string report = ReadDatasetFile(directory, kReportFile);
  const std::string place = ShownPath(directory / kReportFile);
  return ReadRecordedJson<StrictOrderedJson>(report, place, [&](const StrictOrderedJson& json) {
    ReadReport({json, place}, overview);
    return overview;
  });
}

}  // namespace railcast
