// Measures the scene settings of the published evaluation (Vir2Rail, Table 2; scene_settings.h) and
// prints a table in Markdown.
//
//   railcast-measure settings [SCENARIO] [--turns N] [--threads N]
//
// Build time, memory and points come from a process of their own for each setting. Then all
// settings take turns in one process: each makes one frame to warm the caches and three that count.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "core/trace/trace_program.h"
#include "railcast/scenario.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scene_cost.h"
#include "tests/bench/scene_settings.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumFrames = 8;
constexpr int kFramesOfATurn = 3;

struct SettingsOptions {
  std::string scenario = RAILCAST_SCENARIOS_DIR "/st_gallen_approach.json";
  int num_turns = 100;
  int num_threads = 0;
};

/// A setting with what was measured of it.
struct MeasuredSetting {
  const SceneSetting& setting;
  BuildCost cost;
  std::unique_ptr<FrameMaker> maker{};
  std::vector<double> times_ms{};  ///< One for each turn.
};

void MeasureTimes(std::vector<MeasuredSetting>& settings, const SettingsOptions& options) {
  for (MeasuredSetting& measured : settings) {
    measured.maker = std::make_unique<FrameMaker>(measured.setting.scenario, options.num_threads);
    for (std::uint32_t index = 0; index < kNumFrames; ++index) measured.maker->Make(index);
  }
  WaitUntilIdle();
  for (int turn = 0; turn < options.num_turns; ++turn) {
    const std::uint32_t index = static_cast<std::uint32_t>(turn) % kNumFrames;
    for (MeasuredSetting& measured : settings) {
      measured.maker->Make(index);
      const double time_ms = TimeOf_ms([&] {
        for (int i = 0; i < kFramesOfATurn; ++i) measured.maker->Make(index);
      });
      measured.times_ms.push_back(time_ms / kFramesOfATurn);
    }
  }
}

double MedianRatio(const std::vector<double>& times, const std::vector<double>& base) {
  std::vector<double> ratios(times.size());
  std::ranges::transform(times, base, ratios.begin(), std::divides());
  return Median(ratios);
}

/// The published CPU time of the engine's game thread, without active sensors, of the settings that
/// the publication has, too (its Table 2).
std::string PublishedText(const std::string& setting) {
  constexpr double kBase_ms = 7.26;
  const std::map<std::string, double> times_ms = {
      {"base", kBase_ms}, {"no foliage", 5.71}, {"grass as geometry", 6.96}, {"camera on", 19.80}};
  const auto found = times_ms.find(setting);
  if (found == times_ms.end()) return "- | -";
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f | %.2f", found->second, found->second / kBase_ms);
  return text;
}

void Print(const std::vector<MeasuredSetting>& settings) {
  std::printf(
      "| setting | triangles | instances | build s | memory MB | points | ms a frame | x base | "
      "published game ms | published x base |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const MeasuredSetting& measured : settings) {
    const SceneSize size = SizeOf(measured.setting.scenario, measured.maker->world());
    std::printf("| %s | %zu | %zu | %.2f | %.0f | %zu | %.2f | %.2f | %s |\n",
                measured.setting.name.c_str(), size.num_triangles, size.num_instances,
                measured.cost.build_s, measured.cost.memory_mb, measured.cost.num_points,
                Median(measured.times_ms),
                MedianRatio(measured.times_ms, settings.front().times_ms),
                PublishedText(measured.setting.name).c_str());
  }
}

int RunSettings(SettingsOptions options) {
  const int num_cores = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  if (options.num_threads == 0) options.num_threads = num_cores;
  const std::vector<SceneSetting> settings =
      SceneSettings(PickSensor(ReadScenario(options.scenario), std::nullopt));
  std::vector<MeasuredSetting> measured;
  for (const SceneSetting& setting : settings) {
    measured.push_back({setting, BuildInAProcess(setting.scenario, options.num_threads)});
  }
  MeasureTimes(measured, options);
  std::printf("%d cores, %d threads; Embree %s, %s; %d turns\n\n", num_cores, options.num_threads,
              EmbreeVersion().c_str(), IsaInUse("").c_str(), options.num_turns);
  Print(measured);
  return kExitSuccess;
}

}  // namespace

void AddSettings(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions settings =
      app.AddCommand("settings", "Measure the scene settings of the published evaluation");
  const auto options = std::make_shared<SettingsOptions>();
  settings.AddOption("SCENARIO", options->scenario, "Scenario file; default: the demo")
      .Check(NonEmpty());
  settings.AddOption("--turns", options->num_turns, "Turns that each setting takes")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  settings.AddOption("--threads", options->num_threads, "0 = all cores")
      .Check(Whole({0, 1024}))
      .ShowDefault();
  settings.WhenParsed([options, &command] {
    command = [options](const std::string&) { return RunSettings(*options); };
  });
}

}  // namespace railcast
