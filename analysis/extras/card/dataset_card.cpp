#include "analysis/extras/card/dataset_card.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "analysis/extras/card/dataset_overview.h"
#include "analysis/limits/limit_sections.h"
#include "analysis/report/words.h"
#include "analysis/stats/statistics.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/io/recording/recording_kinds.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What the sequences of a data set say of their scenarios.
struct SeenScenarios {
  std::vector<ScenarioSpec> sample;    ///< One for each rung and sensor.
  std::set<std::string> attributions;  ///< Attributions of lines.
  LabelTable labels;
  bool has_recordings = false;  ///< Into which objects were put.
};

// Mounts are left out: recipes draw them, and no section is about them.
bool HaveSameSensor(const ScenarioSpec& first, const ScenarioSpec& other) {
  LidarSpec lidar = other.lidar;
  lidar.mount = first.lidar.mount;
  return first.fidelity == other.fidelity && first.lidar == lidar;
}

SeenScenarios LookAtScenarios(const std::vector<fs::path>& sequences) {
  SeenScenarios seen;
  for (const fs::path& path : sequences) {
    const RecordingInfo info = OpenRecording(path)->info();
    if (seen.labels.labels().empty()) seen.labels = info.labels;
    seen.has_recordings = seen.has_recordings || !IsSimulated(info);
    if (!info.scenario) continue;
    const std::string& attribution = info.scenario->world.alignment.attribution;
    if (!attribution.empty()) seen.attributions.insert(attribution);
    if (std::ranges::none_of(seen.sample, [&](const ScenarioSpec& scenario) {
          return HaveSameSensor(scenario, *info.scenario);
        })) {
      seen.sample.push_back(*info.scenario);
    }
  }
  return seen;
}

Section LicenceSection(const std::string& licence, const SeenScenarios& seen) {
  Section section = SectionOf(kCardWords, "licence",
                              {{"licence", licence}, {"has_recordings", seen.has_recordings}});
  if (seen.attributions.empty()) return section;
  Table table = TableOf(kCardWords, "attributions");
  for (const std::string& attribution : seen.attributions) table.rows.push_back({attribution});
  section.tables.push_back(std::move(table));
  return section;
}

Table LabelsTable(const LabelTable& labels) {
  Table table = TableOf(kCardWords, "labels");
  for (const Label& label : labels.labels()) {
    table.rows.push_back({std::uint64_t{label.id}, label.name, label.osdar23, label.whu_railway3d});
  }
  return table;
}

// Balance is what a card is read for: the tables of parts, classes and objects are unfolded.
Section BalanceSection(const DatasetOverview& overview, const LabelTable& labels) {
  Section section = MakeDatasetSection(overview, "");
  section.title = "Parts, classes and objects";
  for (Table& table : section.tables) {
    table.is_open = table.is_open || table.key == "dataset_classes" ||
                    table.key == "dataset_weathers" || table.key == "dataset_objects_by_distance";
  }
  section.tables.push_back(LabelsTable(labels));
  return section;
}

std::uint64_t SizeOf(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

std::vector<Headline> HeadlinesOf(const DatasetOverview& overview) {
  constexpr double kMega = 1e6;
  return {{"Scenarios", "", overview.num_scenarios},
          {"Frames", "", overview.report.num_frames},
          {"Points", "", overview.report.counts.points},
          {"Classes with points", "", std::uint64_t{overview.report.labels.size()}},
          {"Size", "MB", static_cast<double>(SizeOf(overview.source)) / kMega}};
}

}  // namespace

Report MakeDatasetCard(const fs::path& dataset,
                       const std::string& licence,
                       const std::string& command) {
  if (!IsDataset(dataset)) {
    throw InputError(ShownPath(dataset) +
                     ": must be a data set that railcast-generate dataset made, with frames");
  }
  const DatasetContent content = ReadDatasetContent(dataset);
  if (!content.shard.is_whole()) {
    throw InputError(ShownPath(dataset) + ": must be a whole data set (got shard " +
                     ShardText(content.shard) + "); railcast-generate merge makes one of shards");
  }
  const std::vector<fs::path> sequences = FinishedSequences(dataset, content);
  const DatasetOverview overview = ReadDatasetOverview(dataset);
  const SeenScenarios seen = LookAtScenarios(sequences);
  Report report;
  // A path that ends in a slash has an empty last component.
  report.title = "Data set " + ShownText(fs::weakly_canonical(dataset).filename().string());
  report.command = command;
  report.facts = {{"Licence", licence.empty() ? "not stated" : ShownText(licence)},
                  {"Data hash", overview.data_hash}};
  report.headlines = HeadlinesOf(overview);
  report.sections = {{.key = "sheet", .title = "What is seen", .pictures = {MakeSheet(sequences)}},
                     BalanceSection(overview, seen.labels),
                     MadeOfSection(dataset),
                     LicenceSection(licence, seen)};
  if (!seen.sample.empty()) {
    report.sections.push_back(SensorSection(seen.sample));
    Section limits = LimitsSection(seen.sample, true);
    limits.paragraphs = {SentencesOf(kCardWords, "limits")};
    report.sections.push_back(std::move(limits));
  }
  return report;
}

}  // namespace railcast
