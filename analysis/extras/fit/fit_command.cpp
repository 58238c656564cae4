#include <memory>
#include <optional>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/fit/fit.h"
#include "analysis/extras/fit/fit_report.h"
#include "analysis/extras/fit/proof.h"
#include "analysis/extras/fit/recorded_trials.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/parallelism.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/source_choice.h"
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
  SourceChoice choice;
  std::optional<std::filesystem::path> scenario;
  std::string rung;  // Empty: the rung of the scenario.
  std::string intensity = "auto";
  std::optional<double> range_at_10_percent_m;
  std::optional<double> rain_rate_mmph;
  int num_threads = 0;
  ReportOutput output;
};

bool IsPhysicalRung(const FitOptions& options, const std::optional<ScenarioSpec>& scenario) {
  if (!options.rung.empty()) return options.rung == "surface";
  return !(scenario && scenario->fidelity == Fidelity::kPlausibility);
}

// Intensities of railcast frames and of captures are reflectances; those of foreign clouds are
// unknown.
bool HasReflectances(const FitOptions& options, const RecordingInfo& info) {
  if (options.intensity != "auto") return options.intensity == "reflectance";
  return IsSimulated(info) || info.kind.starts_with("capture");
}

// The scenario that is fitted: a sequence's own, or the one that is given for another recording.
std::optional<ScenarioSpec> ScenarioOf(const FitOptions& options, const RecordingInfo& info) {
  if (!options.scenario) return IsSimulated(info) ? info.scenario : std::nullopt;
  if (IsSimulated(info)) {
    throw InputError("--scenario: must be left out for sequences, which have their own (got " +
                     ShownPath(*options.scenario) + ")");
  }
  return PickSensor(ReadScenario(*options.scenario), std::nullopt);
}

FitSettings SettingsOf(const FitOptions& options,
                       const RecordingInfo& info,
                       const std::optional<ScenarioSpec>& scenario) {
  FitSettings settings;
  settings.is_physical = IsPhysicalRung(options, scenario);
  settings.has_reflectances = HasReflectances(options, info);
  settings.rain_rate_mmph = options.rain_rate_mmph;
  settings.range_at_10_percent_m = options.range_at_10_percent_m;
  if (scenario && !settings.range_at_10_percent_m) {
    settings.range_at_10_percent_m = scenario->lidar.receiver.range_at_10_percent_m;
  }
  settings.snr_at_threshold =
      scenario ? scenario->lidar.receiver.snr_at_threshold : ReceiverSpec{}.snr_at_threshold;
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

/// Judges what was fitted by the rung that was. A sequence's own scenario need not be one that can
/// be replayed.
void Judge(const FitProof& proof,
           ScenarioSpec scenario,
           const FitOptions& options,
           FitResult& result) {
  if (!proof.has_planes()) return;
  if (!options.rung.empty()) {
    scenario.fidelity = options.rung == "surface" ? Fidelity::kSurface : Fidelity::kPlausibility;
  }
  try {
    proof.Judge(std::move(scenario), result);
  } catch (const InputError&) {
    if (options.scenario) throw;
  }
}

int RunFit(const FitOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"fit.json", "fitted.json", "fitted_scenario.json"});
  const auto limit = LimitThreads(options.num_threads);
  const auto sources = WithChoice(options.sources, options.choice);
  CheckDistinct(sources);
  std::vector<RecordingInfo> infos;
  for (const std::filesystem::path& source : sources) {
    infos.push_back(OpenRecording(source)->info());
  }
  const RecordingInfo& info = infos.front();
  const std::optional<ScenarioSpec> scenario = ScenarioOf(options, info);
  const FitSettings settings = SettingsOf(options, info, scenario);
  const ProgressLine progress;
  RecordedTrials trials = ReadTrials(sources, [&](std::uint64_t num_frames) {
    if (!info.num_frames) return;
    const auto num = static_cast<double>(*info.num_frames * sources.size());
    progress.Show("frames", static_cast<double>(num_frames) / num);
  });
  const bool has_intensities = settings.is_physical && settings.has_reflectances;
  std::optional<FitProof> proof;
  std::optional<ReceiverFigures> figures;
  if (scenario || has_intensities) {
    const std::vector<RecordedFrame> turns =
        WholeTurns(*OpenRecording(sources.front()), FitProof::kMostTurns);
    if (scenario) proof.emplace(turns, ShownPath(sources.front()));
    if (has_intensities) figures = FindReceiverFigures(turns);
  }
  if (options.scenario && proof->has_planes()) trials.losses = proof->Losses();
  FitResult result = FitModel(trials, settings);
  if (figures) AddIntensities(*figures, result);
  if (proof) Judge(*proof, *scenario, options, result);
  progress.End();

  FitReportInput input{{}, info.kind, command_line, scenario};
  for (const std::filesystem::path& source : sources) {
    input.sources.push_back(source.string());
  }
  Report report = MakeFitReport(input, trials, settings, result);
  AddProvenance(infos, ProgramVersion(), report);
  if (!options.output.out.empty() && scenario) {
    MakeFolders(options.output.out);
    const ScenarioSpec fitted = FittedScenario(*scenario, result);
    WriteFileWhole(options.output.out / "fitted.json", FittedJson(fitted, result));
    WriteFileWhole(options.output.out / "fitted_scenario.json", ResolvedScenarioJson(fitted));
  }
  EmitReport(report, options.output, "fit");
  return kExitSuccess;
}

void AddKnowledgeOptions(ProgramOptions& fit, FitOptions& options) {
  fit.AddOption("--scenario", options.scenario,
                "Scenario with the sensor to fit, for a recording that is no sequence: each "
                "fitted value is replayed as by preset, and not written if it is worse");
  fit.AddOption("--rung", options.rung,
                "Rung whose parameters to fit; default: the scenario's, else surface")
      .Check(Named({"plausibility", "surface"}));
  fit.AddOption("--intensity", options.intensity,
                "What the intensities are: reflectance, or nothing known (none); auto: "
                "reflectance in sequences and captures, else none")
      .Check(Named({"auto", "reflectance", "none"}))
      .ShowDefault();
  fit.AddOption("--range-at-10-percent-m", options.range_at_10_percent_m,
                "Range in m at 10 % reflectance, from the data sheet: with intensities that are "
                "reflectances it gives the signal, on which the noise of rung surface depends; "
                "default: the scenario's")
      .Check(Number({0.1, 10'000.0}));
  fit.AddOption("--rain-rate-mmph", options.rain_rate_mmph,
                "Rain rate in the recording, which separates dropout by rain from the sensor's "
                "own, for rung plausibility")
      .Check(Number({1e-3, 5000.0}));
}

void AddFit(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<FitOptions>();
  ProgramOptions fit =
      app.AddCommand("fit", "Estimate noise and losses of the sensor models from recordings");
  fit.AddOption("SOURCE", options->sources,
                "Sequence directory, .pcd or .ply file, directory of such files, .pcap capture "
                "or bag of ROS 2; several are taken together")
      .Required()
      .Check(NonEmpty());
  AddSourceChoice(fit, options->choice);
  AddCaptureSensor(fit, options->choice.sensor);
  AddKnowledgeOptions(fit, *options);
  AddThreads(fit, options->num_threads);
  AddReportOptions(fit, options->output);
  fit.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunFit(*options, line); };
  });
}

}  // namespace

void AddFit(AnalysisExtras& extras) {
  extras.commands["fit"] = AddFit;
}

}  // namespace railcast
