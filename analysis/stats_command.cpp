#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/commands.h"
#include "analysis/distinct_sources.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "analysis/stats/statistics.h"
#include "analysis/thread_limit.h"
#include "analysis/verify/dataset_verification.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/dataset_files.h"
#include "core/io/scenario_identity.h"
#include "core/io/sensor_folders.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

struct StatsOptions {
  std::vector<std::filesystem::path> sources;
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

// The sequences of a data set or of several sensors, in their order; any other source by itself.
std::vector<std::filesystem::path> SequencesIn(const std::filesystem::path& source) {
  std::vector<std::filesystem::path> folders = SensorFoldersIn(source);
  if (!folders.empty()) return folders;
  if (!IsDataset(source)) return {source};
  for (const auto& thousand :
       std::filesystem::directory_iterator(source / std::string(kSequencesFolder))) {
    for (const auto& sequence : std::filesystem::directory_iterator(thousand)) {
      folders.push_back(sequence.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

int RunStats(const StatsOptions& options, const std::string& command_line) {
  const tbb::global_control limit = LimitThreads(options.num_threads);
  CheckDistinct(options.sources);
  std::vector<std::filesystem::path> sequences;
  for (const std::filesystem::path& source : options.sources) {
    const std::vector<std::filesystem::path> within = SequencesIn(source);
    sequences.insert(sequences.end(), within.begin(), within.end());
  }
  // Opened twice: a data set has more sequences than a program may have files open.
  std::vector<RecordingInfo> infos;
  bool has_one_scan = true;
  for (const std::filesystem::path& sequence : sequences) {
    infos.push_back(OpenRecording(sequence)->info());
    CheckSameKind(infos.front(), infos.back());
    has_one_scan = has_one_scan && HaveSameScan(infos.front(), infos.back());
  }
  std::size_t num_frames = 0;  // 0 if not known.
  for (const RecordingInfo& info : infos) num_frames += info.num_frames.value_or(0);

  Statistics all;
  const ProgressLine progress;
  for (const std::filesystem::path& sequence : sequences) {
    const std::uint64_t before = all.coverage.num_frames();
    const auto recording = OpenRecording(sequence);
    all.Add(MeasureStatistics(*recording, [&](std::size_t num) {
      const std::size_t done = before + num;
      if (num_frames > 0) {
        progress.Show("frames", static_cast<double>(done) / static_cast<double>(num_frames));
      } else {
        progress.Show(std::to_string(done) + " frames");
      }
    }));
  }
  if (!has_one_scan) all.ForgetRings();
  progress.End();
  if (all.coverage.num_frames() == 0) {
    throw InputError(ShownPath(options.sources.front()) + ": must hold a frame");
  }
  Report report = MakeStatisticsReport(all, infos, command_line);
  AddProvenance(infos, ProgramVersion(), report);
  EmitReport(report, options.output, "stats");
  return kExitSuccess;
}

}  // namespace

void AddStats(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<StatsOptions>();
  CLI::App* stats = app.add_subcommand(
      "stats", "Dropout, density against range, noise, intensity and coverage of point clouds");
  stats
      ->add_option(
          "SOURCE", options->sources,
          "Sequence directory, .pcd or .ply file, directory of such files, or .pcap "
          "capture of VLP-16, HDL-32E, VLP-32C, VLS-128, Pandar64, XT32 or QT128, or a data set; "
          "several are summed up")
      ->required();
  stats->add_option("--threads", options->num_threads, "Number of threads; 0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  AddReportOptions(*stats, options->output);
  stats->callback([&command, options] {
    command = [options](const std::string& line) { return RunStats(*options, line); };
  });
}

}  // namespace railcast
