#include <iostream>
#include <memory>
#include <string>

#include "analysis/commands.h"
#include "analysis/inspect/inspection.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "analysis/stats/statistics.h"
#include "core/io/recording/found_sensor.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

struct InspectOptions {
  std::filesystem::path source;
  SourceChoice choice;
  std::string job;  // Empty = none.
  std::size_t num_frames = 100;
  std::filesystem::path sensor_file;  // Empty = none.
  ReportOutput output;
};

int RunInspect(const InspectOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"inspect.json"});
  CheckOutputFiles({{"SOURCE", options.source}}, {{"--sensor-file", options.sensor_file}});
  const std::filesystem::path source = WithChoice({options.source}, options.choice).front();
  const auto recording = OpenRecording(source);
  const RecordingLook inspection = Inspect(*recording, options.num_frames);
  const RecordingInfo& info = recording->info();
  if (inspection.num_frames == 0) {
    throw InputError(ShownPath(options.source) + ": must hold a frame");
  }
  if (!options.sensor_file.empty()) {
    const SensorSearch& sensor = inspection.sensor;
    const auto text = [&] {
      if (!sensor.found) throw InputError("no spinning sensor is found: " + sensor.why_not);
      return sensor.found->FileText();
    };
    WriteNamedFile(options.sensor_file, AtPlace(ShownPath(options.source) + ": ", text));
  }
  Report report = MakeInspectionReport(inspection, info, command_line);
  if (auto section = CaptureSection({source})) report.sections.push_back(*section);
  AddProvenance({info}, ProgramVersion(), report);
  EmitReport(report, options.output, "inspect");
  for (const JobFitness& job : JobsOf(inspection, info)) {
    if (job.job != options.job || job.fitness != Fitness::kNo) continue;
    std::cerr << ShownPath(options.source) << ": is not fit for " << job.job << ": " << job.why
              << "\n";
    return kExitFailure;
  }
  return kExitSuccess;
}

}  // namespace

void AddInspect(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<InspectOptions>();
  ProgramOptions inspect = app.AddCommand(
      "inspect", "Say what a recording is, what is wrong with it, and what it is fit for");
  inspect.AddOption("SOURCE", options->source, "Recording of any kind")
      .Required()
      .Check(NonEmpty());
  AddSourceChoice(inspect, options->choice);
  AddCaptureSensor(inspect, options->choice.sensor);
  inspect
      .AddOption("--for", options->job,
                 "Exit with status 1 if the recording is not fit for this job: " +
                     std::string("view, stats, insert, weather, survey, evaluate or fit"))
      .Check(Named({kJobs.begin(), kJobs.end()}));
  inspect.AddOption("--frames", options->num_frames, "Frames to look at, from the first on")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  inspect.AddOption("--sensor-file", options->sensor_file,
                    "Write the sensor that the points of the first ten frames show, as a file that "
                    "scenarios and plans take as lidar");
  AddReportOptions(inspect, options->output);
  inspect.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunInspect(*options, line); };
  });
}

}  // namespace railcast
