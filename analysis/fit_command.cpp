#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/commands.h"
#include "analysis/fit/fit.h"
#include "analysis/fit/fit_report.h"
#include "analysis/fit/recorded_trials.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/error.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct FitOptions {
  std::vector<std::filesystem::path> sources;
  std::string topic;
  std::string rung;  // Empty: the rung of the scenario.
  std::string intensity = "auto";
  std::optional<double> range_at_10_percent_m;
  std::optional<double> rain_rate_mmph;
  int num_threads = 0;
  ReportOutput output;
};

bool IsPhysicalRung(const FitOptions& options, const RecordingInfo& info) {
  if (!options.rung.empty()) return options.rung == "surface";
  return !(info.scenario && info.scenario->fidelity == Fidelity::kPlausibility);
}

// Intensities of railcast frames and of captures are reflectances; those of foreign clouds are
// unknown.
bool HasReflectances(const FitOptions& options, const RecordingInfo& info) {
  if (options.intensity != "auto") return options.intensity == "reflectance";
  return IsSimulated(info) || info.kind.starts_with("capture");
}

FitSettings SettingsOf(const FitOptions& options, const RecordingInfo& info) {
  FitSettings settings;
  settings.is_physical = IsPhysicalRung(options, info);
  settings.has_reflectances = HasReflectances(options, info);
  settings.rain_rate_mmph = options.rain_rate_mmph;
  settings.range_at_10_percent_m = options.range_at_10_percent_m;
  if (info.scenario && !settings.range_at_10_percent_m) {
    settings.range_at_10_percent_m = info.scenario->lidar.receiver.range_at_10_percent_m;
  }
  settings.snr_at_threshold = info.scenario ? info.scenario->lidar.receiver.snr_at_threshold
                                            : ReceiverSpec{}.snr_at_threshold;
  if (options.range_at_10_percent_m && !settings.is_physical) {
    throw InputError(
        "--range-at-10-percent-m: must come with rung surface: noise of rung plausibility does not "
        "depend on the signal");
  }
  if (options.range_at_10_percent_m && !settings.has_reflectances) {
    throw InputError(
        "--range-at-10-percent-m: must come with --intensity reflectance: without reflectances it "
        "does not give the signal");
  }
  if (settings.is_physical && options.rain_rate_mmph) {
    throw InputError(
        "--rain-rate-mmph: must come with rung plausibility: rung surface has no dropout by rain");
  }
  return settings;
}

int RunFit(const FitOptions& options, const std::string& command_line) {
  const tbb::global_control limit = LimitThreads(options.num_threads);
  const auto sources = WithTopic(options.sources, options.topic);
  CheckDistinct(sources);
  std::vector<RecordingInfo> infos;
  for (const std::filesystem::path& source : sources) {
    infos.push_back(OpenRecording(source)->info());
  }
  const RecordingInfo& info = infos.front();
  const FitSettings settings = SettingsOf(options, info);
  const ProgressLine progress;
  RecordedTrials trials = ReadTrials(sources, [&](std::uint64_t num_frames) {
    if (!info.num_frames) return;
    const auto num = static_cast<double>(*info.num_frames * sources.size());
    progress.Show("frames", static_cast<double>(num_frames) / num);
  });
  progress.End();
  const FitResult result = FitModel(trials, settings);

  FitReportInput input{{}, info.kind, command_line, info.scenario};
  for (const std::filesystem::path& source : sources) {
    input.sources.push_back(source.string());
  }
  Report report = MakeFitReport(input, trials, settings, result);
  AddProvenance(infos, ProgramVersion(), report);
  if (!options.output.out.empty()) {
    MakeFolders(options.output.out);
    WriteFileWhole(options.output.out / "fitted.json", FittedJson(result));
    if (info.scenario) {
      WriteFileWhole(options.output.out / "fitted_scenario.json",
                     ResolvedScenarioJson(FittedScenario(*info.scenario, result)));
    }
  }
  EmitReport(report, options.output, "fit");
  return kExitSuccess;
}

void AddKnowledgeOptions(CLI::App& fit, FitOptions& options) {
  fit.add_option("--rung", options.rung,
                 "Rung whose parameters to fit; default: the scenario's, else surface")
      ->check(Named({"plausibility", "surface"}));
  fit.add_option("--intensity", options.intensity,
                 "What the intensities are: reflectance, or nothing known (none); auto: "
                 "reflectance in sequences and captures, else none")
      ->check(Named({"auto", "reflectance", "none"}))
      ->capture_default_str();
  fit.add_option("--range-at-10-percent-m", options.range_at_10_percent_m,
                 "Range in m at 10 % reflectance, from the data sheet: with intensities that are "
                 "reflectances it gives the signal, on which the noise of rung surface depends; "
                 "default: the scenario's")
      ->check(Number({0.1, 10'000.0}));
  fit.add_option("--rain-rate-mmph", options.rain_rate_mmph,
                 "Rate of the rain in the recording: tells the dropout by rain from the sensor's "
                 "own, for rung plausibility")
      ->check(Number({1e-3, 5000.0}));
}

}  // namespace

void AddFit(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<FitOptions>();
  CLI::App* fit =
      app.add_subcommand("fit", "Estimate noise and losses of the sensor models from recordings");
  fit->add_option("SOURCE", options->sources,
                  "Sequence directory, .pcd or .ply file, directory of such files, .pcap capture "
                  "or bag of ROS 2; several are taken together")
      ->required();
  AddTopic(*fit, options->topic);
  AddKnowledgeOptions(*fit, *options);
  fit->add_option("--threads", options->num_threads, "Number of threads; 0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  AddReportOptions(*fit, options->output);
  fit->callback([&command, options] {
    command = [options](const std::string& line) { return RunFit(*options, line); };
  });
}

}  // namespace railcast
