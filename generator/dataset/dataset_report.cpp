#include "generator/dataset/dataset_report.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/io/content_hash.h"
#include "core/io/run/dataset_files.h"

namespace railcast {
namespace {

// Counts by the names of their bins.
Json ByDistance(const std::array<std::uint64_t, kNumDistanceBins>& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) json[DistanceBinName(i)] = counts[i];
  return json;
}

Json ByOcclusion(const std::array<std::uint64_t, kNumOcclusionBins>& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    json[std::string(kOcclusionBinNames[i])] = counts[i];
  }
  return json;
}

double ShareOf(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void DatasetReport::Add(const IndexedScenario& scenario) {
  const Json& record = scenario.record;
  PerSplit& split = splits_[record.at("split").get<std::string>()];
  ++split.scenarios;
  scenarios_.Add(record);
  std::set<std::pair<std::string, std::string>> objects;  // By type and name.
  for (const IndexedSequence& sequence : scenario.sequences) {
    const std::size_t num_frames = sequence.frames.size();
    frames_by_base_[record.at("base").get<std::string>()] += num_frames;
    frames_by_sensor_[sequence.record.at("sensor").get<std::string>()] += num_frames;
    for (const IndexedFrame& frame : sequence.frames) {
      AddFrame(frame, split);
      for (const IndexedObject& object : frame.objects) objects.emplace(object.type, object.name);
    }
  }
  for (const auto& [type, name] : objects) ++types_.at(type).objects;
}

void DatasetReport::AddFrame(const IndexedFrame& frame, PerSplit& split) {
  ++num_frames_;
  ++split.frames;
  const FrameCounts& counts = frame.record.counts;
  split.points += counts.points;
  counts_.Add(counts);
  for (const auto& [label, points] : counts.points_per_label) ++frames_with_label_[label];
  std::string hashes;
  for (const WrittenFile& file : frame.record.files) hashes += file.hash;
  // Frames of objects alone have no files that could be compared.
  if (!hashes.empty()) frame_hashes_.push_back(ContentHashNumber(hashes));
  if (counts.points == 0) ++frames_without_points_;
  bool has_object = false;
  for (const IndexedObject& object : frame.objects) {
    AddObject(object);
    has_object = has_object || object.points > 0;
  }
  if (!has_object) ++frames_without_objects_;
}

void DatasetReport::AddObject(const IndexedObject& object) {
  PerType& type = types_[object.type];
  ++type.in_frames;
  if (object.points > 0) ++type.with_points;
  type.points += object.points;
  const std::size_t distance = BinOf(kBinDistances_m, object.distance_m);
  ++type.by_distance[distance];
  type.points_by_distance[distance] += object.points;
  const std::size_t occlusion =
      object.occlusion ? BinOf(kBinOcclusions, *object.occlusion) : kNumOcclusionBins - 1;
  ++type.by_occlusion[occlusion];
}

// Of frames with the same bytes, all but one.
std::uint64_t DatasetReport::NumDuplicates() {
  std::ranges::sort(frame_hashes_);
  std::uint64_t num_duplicates = 0;
  for (std::size_t i = 1; i < frame_hashes_.size(); ++i) {
    if (frame_hashes_[i] == frame_hashes_[i - 1]) ++num_duplicates;
  }
  return num_duplicates;
}

Json DatasetReport::Write() {
  Json splits = Json::object();
  for (const auto& [name, split] : splits_) {
    splits[name] = {
        {"scenarios", split.scenarios}, {"frames", split.frames}, {"points", split.points}};
  }
  Json labels = Json::object();
  for (const auto& [label, points] : counts_.points_per_label) {
    labels[label] = {{"points", points},
                     {"share", ShareOf(points, counts_.points)},
                     {"frames", frames_with_label_.at(label)}};
  }
  Json types = Json::object();
  for (const auto& [name, type] : types_) {
    types[name] = {{"objects", type.objects},
                   {"in_frames", type.in_frames},
                   {"with_points", type.with_points},
                   {"points", type.points},
                   {"by_distance", ByDistance(type.by_distance)},
                   {"points_by_distance", ByDistance(type.points_by_distance)},
                   {"by_occlusion", ByOcclusion(type.by_occlusion)}};
  }
  Json report = {{"num_frames", num_frames_}, {"splits", std::move(splits)}};
  report["frames_without_points"] = frames_without_points_;
  report["frames_without_objects"] = frames_without_objects_;
  report["duplicate_frames"] = NumDuplicates();
  PutCounts(counts_, report);
  report["labels"] = std::move(labels);
  report["objects"] = std::move(types);
  report["weathers"] = scenarios_.Weathers();
  report["drawn"] = scenarios_.Drawn();
  report["frames_by_base"] = frames_by_base_;
  report["frames_by_sensor"] = frames_by_sensor_;
  return report;
}

}  // namespace railcast
