#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "analysis/stats/statistics.h"
#include "core/base/join.h"
#include "core/base/parallelism.h"
#include "core/io/cloud/track_fields.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// Looks what a path leads to: the sequences of a data set, of several sensors or of KITTI's
// layout, or a single recording.
// @throws InputError with one line if it is an unfinished or damaged data set.
MeasuredSource LookAtSource(const std::filesystem::path& source) {
  MeasuredSource whole{.source = source, .recordings = SensorFoldersIn(source)};
  if (!whole.recordings.empty()) return whole;
  if (IsThere(source / kDatasetFile))
    return NeedExtra(AnalysisExtras::Get().open_dataset, source, "card")(source);
  // A run of our own is checked against its hashes as a whole.
  if (!IsThere(source / kRunFile)) whole.recordings = KittiSequencesIn(source);
  if (whole.recordings.empty()) {
    whole.recordings = {source};
  } else {
    const std::size_t num = whole.recordings.size();
    whole.kind = "KITTI data set of " + NumberText(num) + (num == 1 ? " sequence" : " sequences");
  }
  return whole;
}

// The description of a whole source, for reports that do not list its recordings one by one.
// @param first The description of the first recording of the source.
RecordingInfo InfoOfWhole(const MeasuredSource& whole, const RecordingInfo& first) {
  RecordingInfo info;
  info.source = whole.source;
  info.kind = whole.kind;
  info.labels = first.labels;
  info.materials = first.materials;
  info.has_kitti_labels = first.has_kitti_labels;
  info.origin = first.origin;
  if (info.origin) {
    info.origin->data_hash = whole.data_hash;
    info.origin->scenario_hash.clear();
  }
  return info;
}

struct StatsOptions {
  std::vector<std::filesystem::path> sources;
  SourceChoice choice;
  std::string sensor;                          // Empty = all.
  std::optional<std::filesystem::path> track;  // Scenario with the track of the vehicle.
  int num_threads = 0;
  ReportOutput output;
};

// Firing tables are equal if their contents are, in whichever directory they lie.
bool HaveSameScan(const RecordingInfo& first, const RecordingInfo& other) {
  if (!first.scenario || !other.scenario) return !first.scenario && !other.scenario;
  return WithFilesByContent(*first.scenario).lidar.scan ==
         WithFilesByContent(*other.scenario).lidar.scan;
}

// Labels and materials are counted by their numbers, which must mean the same in all recordings.
void CheckSameKind(const RecordingInfo& first, const RecordingInfo& other) {
  if (other.labels.labels() != first.labels.labels() || other.materials != first.materials) {
    throw InputError(ShownPath(other.source) + ": must have the same labels and materials as " +
                     ShownPath(first.source));
  }
  if (first.kind != other.kind) {
    throw InputError(ShownPath(other.source) + ": must be a " + first.kind + " like " +
                     ShownPath(first.source) + " (got a " + other.kind + ")");
  }
}

/// What is known of the sources before their frames are read.
struct SourcesAtFirstSight {
  /// One for each source whose recordings the report does not list, else one for each recording.
  std::vector<RecordingInfo> infos;
  std::set<std::string> sensors;  ///< The names that there are.
  bool has_one_scan = true;
  std::size_t num_frames = 0;  ///< 0 if not known.
};

std::string SensorOf(const RecordingInfo& info) {
  return info.scenario ? info.scenario->lidar.name : "";
}

// Recordings are opened here and again when they are measured: a data set has more of them than a
// program may have files open.
// @param wanted The only sensor whose recordings the sources keep; empty = all.
// @throws InputError if a source has none of that sensor.
SourcesAtFirstSight LookAtRecordings(const std::string& wanted,
                                     std::vector<MeasuredSource>& sources) {
  SourcesAtFirstSight seen;
  std::optional<RecordingInfo> first;
  for (MeasuredSource& source : sources) {
    std::set<std::string> others;
    std::vector<std::filesystem::path> kept;
    for (const std::filesystem::path& path : source.recordings) {
      const RecordingInfo info = OpenRecording(path)->info();
      const std::string sensor = SensorOf(info);
      const bool is_wanted = wanted.empty() || sensor == wanted;
      if (!sensor.empty()) (is_wanted ? seen.sensors : others).insert(sensor);
      if (!is_wanted) continue;
      if (!first) first = info;
      CheckSameKind(*first, info);
      seen.has_one_scan = seen.has_one_scan && HaveSameScan(*first, info);
      seen.num_frames += info.num_frames.value_or(0);
      if (source.kind.empty()) {
        seen.infos.push_back(info);
      } else if (kept.empty()) {
        seen.infos.push_back(InfoOfWhole(source, info));
      }
      kept.push_back(path);
    }
    if (!wanted.empty() && kept.empty()) {
      throw InputError(
          "--sensor: must be a sensor of " + ShownPath(source.source) + ", " +
          (others.empty() ? "which names none" : "of " + Join(others, ", ", ShownText)) + " (got " +
          ShownText(wanted) + ")");
    }
    source.recordings = std::move(kept);
  }
  return seen;
}

std::vector<MeasuredSource> LookAtSources(const std::vector<std::filesystem::path>& paths) {
  CheckDistinct(paths);
  std::vector<MeasuredSource> sources;
  std::vector<std::filesystem::path> recordings;
  for (const std::filesystem::path& path : paths) {
    sources.push_back(LookAtSource(path));
    const auto& within = sources.back().recordings;
    recordings.insert(recordings.end(), within.begin(), within.end());
  }
  CheckDistinct(recordings);
  return sources;
}

// The sections of data sets come before all others with figures.
void AddDatasetSections(const std::vector<MeasuredSource>& sources, Report& report) {
  std::vector<Section> sections;
  for (const MeasuredSource& source : sources) {
    if (!source.section) continue;
    const std::string suffix = sections.empty() ? "" : "_" + std::to_string(sections.size() + 1);
    sections.push_back(source.section(suffix));
  }
  report.sections.insert(report.sections.begin(), sections.begin(), sections.end());
}

std::optional<FrameTrack> TrackOf(const std::optional<std::filesystem::path>& file) {
  if (!file) return std::nullopt;
  const ScenarioSpec scenario = ReadScenario(*file);
  // Recordings have their points in the sensor's axes, whatever the scenario's output.
  return FrameTrack{OwnTrack(*MakeWorld(scenario), scenario.world.catenary), {}};
}

Statistics MeasureAll(const std::vector<MeasuredSource>& sources,
                      std::size_t num_frames,
                      const std::optional<FrameTrack>& track,
                      std::vector<RecordingInfo>& infos) {
  Statistics all;
  const ProgressLine progress;
  for (const MeasuredSource& source : sources) {
    for (const std::filesystem::path& path : source.recordings) {
      const std::uint64_t before = all.coverage.num_frames();
      const auto recording = OpenRecording(path);
      const auto show = [&](std::size_t num) {
        const std::size_t done = before + num;
        if (num_frames > 0) {
          progress.Show("frames", static_cast<double>(done) / static_cast<double>(num_frames));
        } else {
          progress.Show(std::to_string(done) + " frames");
        }
      };
      AddTo(all, MeasureStatistics(*recording, show, track ? &*track : nullptr));
      // What the reader has to say is known only now.
      const auto info = std::ranges::find(infos, recording->info().source, &RecordingInfo::source);
      if (info != infos.end()) info->remarks = recording->info().remarks;
    }
  }
  progress.End();
  return all;
}

Section SheetSection(const std::vector<MeasuredSource>& sources) {
  std::vector<std::filesystem::path> recordings;
  for (const MeasuredSource& source : sources) {
    recordings.insert(recordings.end(), source.recordings.begin(), source.recordings.end());
  }
  return {.key = "sheet", .title = "What is seen", .pictures = {MakeSheet(recordings)}};
}

int RunStats(const StatsOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"stats.json"});
  const auto limit = LimitThreads(options.num_threads);
  // A sensor is chosen by its address in captures, and by its name in sequences.
  SourceChoice choice = options.choice;
  if (ParseSender(options.sensor)) choice.sensor = options.sensor;
  const auto chosen = WithChoice(options.sources, choice);
  std::vector<MeasuredSource> sources = LookAtSources(chosen);
  SourcesAtFirstSight seen = LookAtRecordings(choice.sensor.empty() ? options.sensor : "", sources);
  Statistics all = MeasureAll(sources, seen.num_frames, TrackOf(options.track), seen.infos);
  if (!seen.has_one_scan) all.ForgetRings();
  if (all.coverage.num_frames() == 0) {
    throw InputError(ShownPath(options.sources.front()) + ": must hold a frame");
  }
  Report report = MakeStatisticsReport(all, seen.infos, command_line);
  if (!options.sensor.empty()) {
    report.facts.emplace_back("Sensors", ShownText(options.sensor) + ", chosen by --sensor");
  } else if (seen.sensors.size() > 1) {
    report.facts.emplace_back("Sensors", Join(seen.sensors, ", ", ShownText) +
                                             ", taken together; --sensor takes one of them");
  }
  AddDatasetSections(sources, report);
  if (auto section = CaptureSection(chosen)) report.sections.push_back(*section);
  if (!options.output.out.empty()) {
    report.sections.insert(report.sections.begin(), SheetSection(sources));
  }
  AddProvenance(seen.infos, ProgramVersion(), report);
  EmitReport(report, options.output, "stats");
  return kExitSuccess;
}

}  // namespace

void AddStats(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<StatsOptions>();
  std::string kinds;
  for (const RecordingKind& kind : RecordingExtras::Get().kinds) kinds += kind.help() + ", ";
  ProgramOptions stats = app.AddCommand(
      "stats", "Dropout, density against range, noise, intensity and coverage of point clouds");
  stats
      .AddOption("SOURCE", options->sources,
                 "Sequence directory, .pcd or .ply file, directory of such files, " + kinds +
                     "or a folder of KITTI's layout or a data set; several are summed up")
      .Required()
      .Check(NonEmpty());
  AddSourceChoice(stats, options->choice);
  stats
      .AddOption(
          "--sensor", options->sensor,
          "Name of the only sensor to measure, where there are several; default: all, taken "
          "together. Of a capture, the ADDRESS or ADDRESS:PORT of the sensor, which is needed "
          "where it holds several")
      .Check(NonEmpty());
  stats.AddOption("--track", options->track,
                  "Scenario with the recording's track, in the world of the recording's poses: "
                  "count the points in its vehicle's outline along this track");
  AddThreads(stats, options->num_threads);
  AddReportOptions(stats, options->output);
  stats.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunStats(*options, line); };
  });
}

}  // namespace railcast
