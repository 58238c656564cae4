#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/run_record.h"
#include "core/scenario/json_text.h"
#include "core/scenario/value_type.h"

namespace railcast {

// The files of a data set (docs/dataset.md), besides those of core/io/run/dataset_files.h.

inline constexpr std::string_view kRecipeFile = "recipe.json";
inline constexpr std::string_view kScenariosFile = "scenarios.jsonl";
inline constexpr std::string_view kIndexFile = "index.jsonl";
inline constexpr std::string_view kIndexDatabaseFile = "index.sqlite";  ///< Examples make it.
inline constexpr std::string_view kReportFile = "report.json";
inline constexpr std::string_view kDatasetManifestFile = "manifest.json";

/// The content of dataset.json: everything that the bytes of a data set depend on.
struct DatasetRecord {
  std::string version;
  std::string embree;
  std::string isa;
  std::string recipe_hash;
  std::vector<std::string> base_hashes{};
  std::uint32_t num_scenarios{};
  std::string format;
  std::string fields;
  bool is_merged{};
  std::string files_hash{};  ///< Hash of the files that the recipe names; empty if it names none.
  std::string shard{};       ///< "2/7"; empty for a whole data set.
  std::optional<double> certify{};  ///< As RunRecord::certify.
  bool is_converted{};  ///< Whether insertions have become sequences, which `dataset` cannot make.
};
void Describe(Archive& a, DatasetRecord& s);

/// A sequence, or an insertion, of a scenario.
struct SequenceRecord {
  std::string sensor;
  std::string folder;  ///< Relative to the data set.
  std::uint32_t num_frames{};
  std::uint64_t points{};
  std::string scenario_hash;
  std::string data_hash;
  std::string manifest_hash;
  std::vector<double> vehicle_s_m{};  ///< For each frame, as the next.
  std::vector<double> vehicle_speed_mps{};
  /// If something was put into a recording: the hashes of all files of the scenario.
  std::map<std::string, std::string> files{};
  std::optional<BagRecord> bag{};
  std::string trace{};
};
void Describe(Archive& a, SequenceRecord& s);

/// A line of scenarios.jsonl.
struct ScenarioRecord {
  std::uint32_t scenario{};
  std::string base;   ///< Name of its file.
  std::string split;  ///< "train", "val" or "test".
  std::string line;   ///< Hash of the railway line.
  std::array<double, 2> seen_s_m{};
  std::uint64_t seed{};
  std::uint64_t world_seed{};
  double start_s_m{};
  NamedValues<Json> drawn{};
  Json placed = Json::array();
  Json weather = Json::object();
  std::optional<std::uint32_t> first_frame{};  ///< Where a plan begins in its recording.
  std::string sensors_hash{};                  ///< If there are several sensors: of sensors.json.
  std::vector<SequenceRecord> sequences{};
};
void Describe(Archive& a, ScenarioRecord& s);

/// An object in a frame of the index.
struct IndexObjectRecord {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  double distance_m{};  ///< To its box's centre.
  std::uint32_t points{};
  std::uint32_t firings_visible{};
  std::uint32_t firings_alone{};
  std::optional<double> occlusion{};
};
void Describe(Archive& a, IndexObjectRecord& s);

/// A line of index.jsonl.
struct IndexRecord {
  std::uint32_t scenario{};
  std::string sensor;
  std::uint32_t frame{};
  std::string split;
  std::string folder;
  std::vector<std::string> files{};
  std::int64_t stamp_ns{};
  std::string base;
  std::string line;
  double vehicle_s_m{};
  double vehicle_speed_mps{};
  std::optional<BagRecord> bag{};
  std::string trace{};
  FrameCounts counts{};
  std::vector<IndexObjectRecord> objects{};
  NamedValues<Json> drawn{};
  Json weather = Json::object();
};
void Describe(Archive& a, IndexRecord& s);

/// The content of manifest.json of a data set or a shard.
struct DatasetManifestRecord {
  std::string version;
  std::string shard{};  ///< "2/7"; a shard has none of the next three.
  std::uint32_t num_scenarios{};
  std::optional<std::uint64_t> num_frames{};
  std::optional<std::uint64_t> points{};
  std::string format{};
  NamedValues<std::string> files{};
  std::string data_hash{};
};
void Describe(Archive& a, DatasetManifestRecord& s);

}  // namespace railcast
