#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/commands.h"
#include "analysis/distinct_sources.h"
#include "analysis/fit/fit.h"
#include "analysis/fit/fit_report.h"
#include "analysis/fit/fitted_scenario.h"
#include "analysis/fit/recorded_trials.h"
#include "analysis/report/joined.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "analysis/thread_limit.h"
#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/shown_text.h"
#include "core/io/progress_line.h"
#include "core/io/recording/recording.h"
#include "core/io/version.h"
#include "core/io/write_file.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

struct FitOptions {
  std::vector<std::filesystem::path> sources;
  std::filesystem::path planes;  // Empty: none.
  std::string rung;              // Empty: that of the scenario.
  std::string intensity = "auto";
  std::optional<double> range_at_10_percent_m;
  std::vector<std::string> known;
  std::optional<double> extinction_per_m;
  std::optional<double> rain_rate_mmph;
  int num_threads = 0;
  ReportOutput output;
};

// NAME=RHO
std::pair<std::string, double> ParseKnown(const std::string& text) {
  const std::size_t equals = text.find('=');
  char* end = nullptr;
  const double reflectance =
      equals == std::string::npos ? 0.0 : std::strtod(text.c_str() + equals + 1, &end);
  if (equals == 0 || !(reflectance > 0.0 && std::isfinite(reflectance)) || *end != '\0') {
    throw InputError("--known: must be NAME=REFLECTANCE, the reflectance > 0 (got " +
                     ShownText(text) + ")");
  }
  return {text.substr(0, equals), reflectance};
}

bool IsPhysicalRung(const FitOptions& options, const RecordingInfo& info) {
  if (!options.rung.empty()) return options.rung == "surface";
  return !(info.scenario && info.scenario->fidelity == "plausibility");
}

// Of our frames and of captures intensities are reflectances; what foreign clouds hold is not
// known.
bool HasReflectances(const FitOptions& options, const RecordingInfo& info) {
  if (options.intensity != "auto") return options.intensity == "reflectance";
  return info.scenario.has_value() || info.kind.starts_with("capture");
}

FitSettings SettingsOf(const FitOptions& options,
                       const RecordingInfo& info,
                       const RecordedTrials& trials) {
  FitSettings settings;
  settings.is_physical = IsPhysicalRung(options, info);
  settings.has_reflectances = HasReflectances(options, info);
  settings.knows_losses = trials.knows_losses;
  settings.range_at_10_percent_m = options.range_at_10_percent_m;
  settings.extinction_per_m = options.extinction_per_m;
  settings.rain_rate_mmph = options.rain_rate_mmph;
  const bool fixes_scale = options.range_at_10_percent_m || !options.known.empty();
  if (settings.has_reflectances && fixes_scale) {
    throw InputError(
        "--range-at-10-percent-m, --known: must come with --intensity none: reflectances from "
        "intensities fix the threshold already");
  }
  if (options.range_at_10_percent_m && !options.known.empty()) {
    throw InputError(
        "--known: must not come with --range-at-10-percent-m: one fixes the threshold");
  }
  if (settings.is_physical && options.rain_rate_mmph) {
    throw InputError(
        "--rain-rate-mmph: must come with rung plausibility: rung surface has no dropout by rain");
  }
  for (const std::string& text : options.known) {
    const auto [name, reflectance] = ParseKnown(text);
    bool is_there = false;
    for (const Trial& trial : trials.trials)
      is_there |= trials.surfaces[trial.surface].name == name;
    if (!is_there)
      throw InputError("--known: no trial meets such a surface (got " + ShownText(name) + ")");
    settings.known[name] = reflectance;
  }
  return settings;
}

int RunFit(const FitOptions& options, const std::string& command_line) {
  const tbb::global_control limit = LimitThreads(options.num_threads);
  CheckDistinct(options.sources);
  std::vector<RecordingInfo> infos;
  for (const std::filesystem::path& source : options.sources) {
    infos.push_back(OpenRecording(source)->info());
  }
  const RecordingInfo& info = infos.front();
  std::vector<KnownPlane> planes;
  if (!options.planes.empty()) planes = ReadKnownPlanes(options.planes);
  const ProgressLine progress;
  RecordedTrials trials =
      ReadTrials(options.sources, std::move(planes), [&](std::uint64_t num_frames) {
        if (!info.num_frames) return;
        const auto num = static_cast<double>(*info.num_frames * options.sources.size());
        progress.Show("frames", static_cast<double>(num_frames) / num);
      });
  progress.End();
  const FitSettings settings = SettingsOf(options, info, trials);
  const FitResult result = FitModel(trials.trials, trials.surfaces, settings);

  FitReportInput input{{}, info.kind, command_line, info.scenario};
  for (const std::filesystem::path& source : options.sources) {
    input.sources.push_back(source.string());
  }
  Report report = MakeFitReport(input, trials, settings, result);
  AddProvenance(infos, ProgramVersion(), report);
  if (!options.output.out.empty()) {
    MakeFolder(options.output.out);
    WriteFileWhole(options.output.out / "fitted.json", FittedJson(settings, trials, result));
    if (info.scenario) {
      WriteFileWhole(
          options.output.out / "fitted_scenario.json",
          ResolvedScenarioJson(FittedScenario(*info.scenario, settings, trials, result)));
    }
  }
  EmitReport(report, options.output, "fit");
  return kExitSuccess;
}

void AddKnowledgeOptions(CLI::App& fit, FitOptions& options) {
  fit.add_option("--planes", options.planes,
                 "For recordings without truth: JSON file of the planes that a standing sensor "
                 "looks at, in its axes")
      ->check(NonEmpty());
  fit.add_option("--rung", options.rung,
                 "Rung whose parameters to fit; default: the scenario's, else surface")
      ->check(CLI::IsMember({"plausibility", "surface"}));
  fit.add_option("--intensity", options.intensity,
                 "What the intensities are: reflectance, or nothing known (none); auto: "
                 "reflectance in sequences and captures, else none")
      ->check(CLI::IsMember({"auto", "reflectance", "none"}))
      ->capture_default_str();
  fit.add_option("--range-at-10-percent-m", options.range_at_10_percent_m,
                 "Range in m at 10 % reflectance, from the data sheet: fixes the threshold where "
                 "intensities do not")
      ->check(Number({0.1, 10'000.0}));
  fit.add_option("--known", options.known,
                 "A surface whose reflectance is known, NAME=REFLECTANCE: fixes the threshold "
                 "where intensities do not; repeat it for several")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  fit.add_option("--extinction-per-m", options.extinction_per_m,
                 "Extinction of the air, instead of fitting it; 0 = clear air")
      ->check(Number({0.0, 10.0}));
  fit.add_option("--rain-rate-mmph", options.rain_rate_mmph,
                 "Rate of the rain in the recording: tells the dropout by rain from the sensor's "
                 "own, for rung plausibility")
      ->check(Number({1e-3, 5000.0}));
}

}  // namespace

void AddFit(CLI::App& app, Command& command) {
  const auto options = std::make_shared<FitOptions>();
  CLI::App* fit = app.add_subcommand(
      "fit", "Noise, threshold, reflectance and dropout of the sensor models, from a recording");
  fit->add_option("SOURCE", options->sources,
                  "Sequence directory, .pcd or .ply file, directory of such files, or .pcap "
                  "capture; several are taken together")
      ->required();
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
