#include "generator/dataset/dataset_report.h"

#include <utility>
#include <vector>

#include "core/io/dataset_bins.h"

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

// The weather in words: "dry", "rain", "rain, fog", ...
std::string WeatherInWords(const Json& weather) {
  const auto is_positive = [&](const char* key) {
    const Json value = weather.value(key, Json());
    return value.is_number() && value.get<double>() > 0.0;
  };
  std::string words;
  const auto add = [&](bool applies, const char* word) {
    if (applies) words += (words.empty() ? "" : ", ") + std::string(word);
  };
  constexpr double kFoggy_m = 1000.0;  // International definition of fog.
  const Json visibility_m = weather.value("visibility_m", Json());
  const Json density = weather.value("fog_density_per_m", Json());
  constexpr double kFoggy_per_m = 3.0 / kFoggy_m;
  add(is_positive("rain_rate_mmph"), "rain");
  add(is_positive("snow_rate_mmph"), "snow");
  add((visibility_m.is_number() && visibility_m.get<double>() <= kFoggy_m) ||
          (density.is_number() && density.get<double>() >= kFoggy_per_m),
      "fog");
  return words.empty() ? "dry" : words;
}

}  // namespace

void DatasetReport::Add(const IndexedScenario& scenario) {
  const Json& record = scenario.record;
  const auto number = record.at("scenario").get<std::uint64_t>();
  PerSplit& split = splits_[record.at("split").get<std::string>()];
  ++split.scenarios;
  frames_by_base_[record.at("base").get<std::string>()] += scenario.frames.size();
  frames_by_sensor_[record.at("sensor").get<std::string>()] += scenario.frames.size();
  for (const auto& [name, value] : record.at("drawn").items()) {
    if (value.is_string() || value.is_boolean()) {
      ++drawn_[name][value.is_string() ? value.get<std::string>() : value.dump()];
    }
  }
  ++weathers_[WeatherInWords(record.at("weather"))];
  for (const IndexedFrame& frame : scenario.frames) AddFrame(frame, number, split);
}

void DatasetReport::AddFrame(const IndexedFrame& frame, std::uint64_t scenario, PerSplit& split) {
  ++num_frames_;
  ++split.frames;
  const FrameCounts& counts = frame.record.counts;
  split.points += counts.points;
  counts_.Add(counts);
  for (const auto& [label, points] : counts.points_per_label) ++frames_with_label_[label];
  std::string hashes;
  for (const WrittenFile& file : frame.record.files) hashes += file.hash;
  // Frames of objects alone have no files that could be compared.
  if (!hashes.empty() && !hashes_.insert(std::move(hashes)).second) ++duplicate_frames_;
  if (counts.points == 0) ++frames_without_points_;
  bool has_object = false;
  for (const IndexedObject& object : frame.objects) {
    AddObject(object, scenario);
    has_object = has_object || object.points > 0;
  }
  if (!has_object) ++frames_without_objects_;
}

void DatasetReport::AddObject(const IndexedObject& object, std::uint64_t scenario) {
  PerType& type = types_[object.type];
  ++type.in_frames;
  if (object.points > 0) ++type.with_points;
  type.points += object.points;
  type.distinct.emplace(scenario, object.name);
  const std::size_t distance = BinOf(kBinDistances_m, object.distance_m);
  ++type.by_distance[distance];
  type.points_by_distance[distance] += object.points;
  const std::size_t occlusion =
      object.occlusion ? BinOf(kBinOcclusions, *object.occlusion) : kNumOcclusionBins - 1;
  ++type.by_occlusion[occlusion];
}

Json DatasetReport::Write() const {
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
    types[name] = {{"objects", type.distinct.size()},
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
  report["duplicate_frames"] = duplicate_frames_;
  PutCounts(counts_, report);
  report["labels"] = std::move(labels);
  report["objects"] = std::move(types);
  report["weathers"] = weathers_;
  report["drawn"] = drawn_;
  report["frames_by_base"] = frames_by_base_;
  report["frames_by_sensor"] = frames_by_sensor_;
  return report;
}

}  // namespace railcast
