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
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/scenario_identity.h"
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

// Rings, labels and materials are counted by their numbers, which must mean the same in all
// recordings.
void CheckSameKind(const RecordingInfo& first, const RecordingInfo& other) {
  if (other.labels.labels() != first.labels.labels() || other.materials != first.materials) {
    throw InputError(ShownPath(other.source) + ": must have the same labels and materials as " +
                     ShownPath(first.source));
  }
  if (first.kind != other.kind || !HaveSameScan(first, other)) {
    throw InputError(ShownPath(other.source) + ": must be of the same sensor as " +
                     ShownPath(first.source));
  }
}

int RunStats(const StatsOptions& options, const std::string& command_line) {
  const tbb::global_control limit = LimitThreads(options.num_threads);
  CheckDistinct(options.sources);
  std::vector<std::unique_ptr<Recording>> recordings;
  std::vector<RecordingInfo> infos;
  for (const std::filesystem::path& source : options.sources) {
    recordings.push_back(OpenRecording(source));
    infos.push_back(recordings.back()->info());
    CheckSameKind(infos.front(), infos.back());
  }
  std::size_t num_frames = 0;  // 0 if not known.
  for (const RecordingInfo& info : infos) num_frames += info.num_frames.value_or(0);

  Statistics all;
  const ProgressLine progress;
  for (const auto& recording : recordings) {
    const std::uint64_t before = all.coverage.num_frames();
    all.Add(MeasureStatistics(*recording, [&](std::size_t num) {
      const std::size_t done = before + num;
      if (num_frames > 0) {
        progress.Show("frames", static_cast<double>(done) / static_cast<double>(num_frames));
      } else {
        progress.Show(std::to_string(done) + " frames");
      }
    }));
  }
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
          "capture of VLP-16, HDL-32E, VLP-32C, VLS-128, Pandar64, XT32 or QT128; several are "
          "summed up")
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
