#include "generator/extras/dataset/dataset_report.h"

#include <algorithm>
#include <iomanip>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

#include "core/io/content_hash.h"
#include "core/io/run/dataset_files.h"

namespace railcast {
namespace {

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

// "  weather: dry 14, rain 6\n".
template <class Counts>
std::string CountsLine(const std::string& name, const Counts& counts) {
  std::string line = "  " + name + ":";
  const char* separator = " ";
  for (const auto& [word, count] : counts) {
    line += separator + word + " " + std::to_string(count);
    separator = ", ";
  }
  return line + "\n";
}

double ShareOf(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void ScenarioReport::Add(const ScenarioRecord& record) {
  ++parts_.at(static_cast<std::size_t>(ValueNamed<Split>(record.split).value()));
  ++bases_[record.base];
  ++weathers_[WeatherInWords(record.weather)];
  for (const auto& [name, value] : record.drawn) {
    if (value.is_string() || value.is_boolean()) {
      ++drawn_[name][value.is_string() ? value.get<std::string>() : value.dump()];
    }
  }
  for (const Json& object : record.placed) {
    const std::string name = object.value("name", "");
    ++placed_[name.substr(0, name.rfind('/'))];
  }
}

Json ScenarioReport::Write(const SplitSpec& split) const {
  const std::uint32_t num = std::accumulate(parts_.begin(), parts_.end(), std::uint32_t{0});
  const PerPart<double> shares = SharesOf(split);
  Json splits = Json::object();
  for (const auto& [value, name] : kEnumNames<Split>) {
    const auto part = static_cast<std::size_t>(value);
    const double share = num == 0 ? 0.0 : static_cast<double>(parts_[part]) / num;
    splits[std::string(name)] = {
        {"scenarios", parts_[part]}, {"share", share}, {"asked", shares[part]}};
  }
  return {{"num_scenarios", num}, {"splits", std::move(splits)},
          {"bases", bases_},      {"weathers", weathers_},
          {"drawn", drawn_},      {"placed", placed_}};
}

std::string ScenarioReport::Text(const SplitSpec& split) const {
  std::string text = PartsText(parts_, split);
  text += CountsLine("bases", bases_) + CountsLine("weathers", weathers_);
  for (const auto& [name, words] : drawn_) text += CountsLine(name, words);
  if (!placed_.empty()) text += CountsLine("placed", placed_);
  return text;
}

std::string PartsText(const PerPart<std::uint32_t>& parts, const SplitSpec& split) {
  const double num = std::accumulate(parts.begin(), parts.end(), 0.0);
  const PerPart<double> shares = SharesOf(split);
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  for (const auto& [value, name] : kEnumNames<Split>) {
    const auto part = static_cast<std::size_t>(value);
    text << "  " << std::left << std::setw(6) << name << std::right << std::setw(9) << parts[part]
         << (parts[part] == 1 ? " scenario, " : " scenarios, ") << 100.0 * parts[part] / num
         << " % (asked for: " << 100.0 * shares[part] << " %)\n";
  }
  return text.str();
}

void DatasetReport::Add(const IndexedScenario& scenario) {
  const ScenarioRecord& record = scenario.record;
  SplitCountsRecord& split = record_.splits[record.split];
  ++split.scenarios;
  scenarios_.Add(record);
  std::set<std::pair<std::string, std::string>> objects;  // By type and name.
  for (std::size_t i = 0; i < record.sequences.size(); ++i) {
    const std::vector<IndexedFrame>& frames = scenario.frames[i];
    record_.frames_by_base[record.base] += frames.size();
    record_.frames_by_sensor[record.sequences[i].sensor] += frames.size();
    for (const IndexedFrame& frame : frames) {
      AddFrame(frame, split);
      for (const IndexObjectRecord& object : frame.objects) {
        objects.emplace(object.type, object.name);
      }
    }
  }
  for (const auto& [type, name] : objects) ++record_.objects.at(type).objects;
}

void DatasetReport::AddFrame(const IndexedFrame& frame, SplitCountsRecord& split) {
  ++record_.num_frames;
  ++split.frames;
  const FrameCounts& counts = frame.record.counts;
  split.points += counts.points;
  record_.counts.Add(counts);
  for (const auto& [label, points] : counts.points_per_label) ++record_.labels[label].frames;
  std::string hashes = frame.record.clouds_hash;
  for (const KnownFile& file : frame.record.files) hashes += file.hash;
  // Frames of objects alone have no files that could be compared.
  if (!hashes.empty()) frame_hashes_.push_back(ContentHashNumber(hashes));
  if (counts.points == 0) ++record_.frames_without_points;
  bool has_object = false;
  for (const IndexObjectRecord& object : frame.objects) {
    AddObject(object);
    has_object = has_object || object.points > 0;
  }
  if (!has_object) ++record_.frames_without_objects;
}

void DatasetReport::AddObject(const IndexObjectRecord& object) {
  TypeCountsRecord& type = record_.objects[object.type];
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

// Counts all but one of the frames with the same bytes.
std::uint64_t DatasetReport::NumDuplicates() {
  std::ranges::sort(frame_hashes_);
  std::uint64_t num_duplicates = 0;
  for (std::size_t i = 1; i < frame_hashes_.size(); ++i) {
    if (frame_hashes_[i] == frame_hashes_[i - 1]) ++num_duplicates;
  }
  return num_duplicates;
}

DatasetReportRecord DatasetReport::Record() {
  DatasetReportRecord record = record_;
  record.duplicate_frames = NumDuplicates();
  for (const auto& [label, points] : record.counts.points_per_label) {
    LabelCountsRecord& counts = record.labels.at(label);
    counts.points = points;
    counts.share = ShareOf(points, record.counts.points);
  }
  record.weathers = scenarios_.weathers();
  record.drawn = scenarios_.drawn();
  return record;
}

}  // namespace railcast
