#include <memory>
#include <optional>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/track/track_report.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/error.h"
#include "core/base/parallelism.h"
#include "core/base/text.h"
#include "core/io/recording/source_choice.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"

namespace railcast {
namespace {

constexpr const char* kMountFile = "mount.json";
constexpr const char* kTwinFile = "twin.json";
constexpr const char* kPointsFolder = "points";

struct TrackOptions {
  std::filesystem::path source;
  SourceChoice choice;
  std::optional<double> gauge_mm;
  std::size_t num_frames = 100;
  bool has_points = false;
  int num_threads = 0;
  ReportOutput output;
};

int RunTrack(const TrackOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"track.json", kMountFile, kTwinFile, kPointsFolder});
  if (options.has_points && options.output.out.empty())
    throw InputError("--points: needs --out, the folder to which it writes");
  const auto limit = LimitThreads(options.num_threads);
  const std::filesystem::path source = WithChoice({options.source}, options.choice).front();
  const auto recording = OpenRecording(source);
  TrackSurveySpec spec{.gauge_m = {}, .num_frames = options.num_frames};
  if (options.gauge_mm) spec.gauge_m = 1e-3 * *options.gauge_mm;
  const ProgressLine progress;
  const TrackSurvey survey = SurveyTracks(*recording, spec, [&](std::size_t num) {
    progress.Show("frames looked at: " + NumberText(num));
  });
  progress.End();
  Report report = MakeTrackReport(survey, command_line);
  AddProvenance({recording->info()}, ProgramVersion(), report);
  const std::filesystem::path& out = options.output.out;
  std::string twin;
  try {
    if (!out.empty()) twin = TwinText(survey, source);
  } catch (const InputError& error) {
    report.facts.emplace_back("No twin.json", error.what());
  }
  if (!out.empty()) {
    // An earlier run may have been given another recording.
    RemovePlacedPoints(out / kPointsFolder, options.has_points ? survey.frames.size() : 0);
  }
  if (options.has_points) {
    const auto again = OpenRecording(source);
    report.sections.push_back(
        PlaceRecordedPoints(survey, *again, out / kPointsFolder, [&](std::size_t num) {
          progress.Show("frames placed: " + NumberText(num) + " of " +
                        NumberText(survey.frames.size()));
        }));
    progress.End();
  }
  if (!out.empty()) {
    create_directories(out);
    WriteFileWhole(out / kMountFile, MountText(survey));
    remove(out / kTwinFile);  // An earlier run may have left one.
    if (!twin.empty()) WriteFileWhole(out / kTwinFile, twin);
  }
  EmitReport(report, options.output, "track");
  return kExitSuccess;
}

void AddTrackCommand(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<TrackOptions>();
  ProgramOptions track = app.AddCommand(
      "track",
      "Find the track in a recording, and where its sensor is on it: height, place and angles with "
      "intervals, gauge, curvature and further tracks");
  track.AddOption("SOURCE", options->source, "Recording of any kind").Required().Check(NonEmpty());
  AddSourceChoice(track, options->choice);
  AddCaptureSensor(track, options->choice.sensor);
  track
      .AddOption("--gauge", options->gauge_mm,
                 "Gauge in mm of the tracks to find; otherwise common gauges, then any")
      .Check(Number({600.0, 1700.0}));
  track.AddOption("--frames", options->num_frames, "Frames to look at, from the first on")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  track.AddFlag("--points", options->has_points,
                "Write where each point is on the track, and whether it is in the clear space");
  AddThreads(track, options->num_threads);
  AddReportOptions(track, options->output);
  track.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunTrack(*options, line); };
  });
}

}  // namespace

void AddTrack(AnalysisExtras& extras) {
  extras.commands["track"] = AddTrackCommand;
}

}  // namespace railcast
