// Measures the scene settings of the published evaluation (Vir2Rail, Table 2; scene_settings.h) and
// prints a table in Markdown.
//
//   railcast-settings [SCENARIO] [--turns N] [--threads N]
//
// Build time, memory and points come from a process of their own for each setting. Then all
// settings take turns in one process: each makes one frame to warm the caches and three that count.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/program/command_line.h"
#include "core/program/run_program.h"
#include "core/trace/trace_program.h"
#include "generator/check/scene_audit.h"
#include "railcast/outcome.h"
#include "railcast/scenario.h"
#include "tests/bench/scene_settings.h"

namespace railcast {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint32_t kNumFrames = 8;
constexpr int kFramesOfATurn = 3;

struct SettingsOptions {
  std::string scenario = RAILCAST_SCENARIOS_DIR "/st_gallen_approach.json";
  int num_turns = 100;
  int num_threads = 0;
};

double Since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double Median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// A setting that is built and makes frames, with images if it has a camera.
struct BuiltSetting {
  BuiltSetting(const ScenarioSpec& scenario, int num_threads)
      : simulator(MakeSimulator(scenario, num_threads)), camera(MakeCamera(scenario)) {}

  void Make(std::uint32_t index) {
    simulator->Scan(index, frame);
    if (camera) camera->Render(*simulator, index, image);
  }

  std::unique_ptr<Simulator> simulator;
  std::optional<Camera> camera;
  Frame frame;
  CameraImage image;
  std::vector<double> times_ms{};  ///< One for each turn.
};

/// What a process that builds nothing but one setting tells of it.
struct Built {
  double build_s{};  ///< Until the first frame is complete.
  std::size_t num_points{};
  double memory_mb{};  ///< The most that the process held.
};

Built BuildHere(const ScenarioSpec& scenario, int num_threads) {
  const auto begin = Clock::now();
  BuiltSetting setting(scenario, num_threads);
  setting.Make(0);
  Built built{.build_s = Since_s(begin)};
  built.num_points = static_cast<std::size_t>(std::ranges::count_if(
      setting.frame.outcome, [](Outcome outcome) { return HasPoint(outcome); }));
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  built.memory_mb = static_cast<double>(usage.ru_maxrss) * 1024e-6;
  return built;
}

// Must be called before this process has threads or much memory, both of which a child inherits.
Built BuildInAProcess(const ScenarioSpec& scenario, int num_threads) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw InputError("pipe: must be available");
  const pid_t child = ::fork();
  if (child == 0) {
    const Built built = BuildHere(scenario, num_threads);
    const bool is_told = ::write(ends[1], &built, sizeof(built)) == sizeof(built);
    ::_exit(is_told ? kExitSuccess : kExitFailure);
  }
  ::close(ends[1]);
  Built built;
  const bool is_told = ::read(ends[0], &built, sizeof(built)) == sizeof(built);
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (!is_told) throw InputError("a setting's process: must end with its figures");
  return built;
}

// Waits until the windows are built that simulators prepare in the background.
void WaitUntilIdle() {
  constexpr auto kPause = std::chrono::milliseconds(500);
  constexpr double kBusyShare = 0.02;
  std::clock_t used = std::clock();
  while (true) {
    std::this_thread::sleep_for(kPause);
    const std::clock_t now = std::clock();
    const double busy_s = static_cast<double>(now - used) / CLOCKS_PER_SEC;
    if (busy_s < kBusyShare * std::chrono::duration<double>(kPause).count()) return;
    used = now;
  }
}

std::vector<std::unique_ptr<BuiltSetting>> Measure(const std::vector<SceneSetting>& settings,
                                                   const SettingsOptions& options) {
  std::vector<std::unique_ptr<BuiltSetting>> built;
  for (const SceneSetting& setting : settings) {
    built.push_back(std::make_unique<BuiltSetting>(setting.scenario, options.num_threads));
    for (std::uint32_t index = 0; index < kNumFrames; ++index) built.back()->Make(index);
  }
  WaitUntilIdle();
  for (int turn = 0; turn < options.num_turns; ++turn) {
    const std::uint32_t index = static_cast<std::uint32_t>(turn) % kNumFrames;
    for (const auto& setting : built) {
      setting->Make(index);
      const auto begin = Clock::now();
      for (int i = 0; i < kFramesOfATurn; ++i) setting->Make(index);
      setting->times_ms.push_back(1e3 * Since_s(begin) / kFramesOfATurn);
    }
  }
  return built;
}

double MedianRatio(const std::vector<double>& times, const std::vector<double>& base) {
  std::vector<double> ratios(times.size());
  std::ranges::transform(times, base, ratios.begin(), std::divides());
  return Median(ratios);
}

int RunSettings(SettingsOptions options) {
  const int num_cores = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  if (options.num_threads == 0) options.num_threads = num_cores;
  const std::vector<SceneSetting> settings = SceneSettings(ReadScenario(options.scenario));
  std::vector<Built> built;
  for (const SceneSetting& setting : settings) {
    built.push_back(BuildInAProcess(setting.scenario, options.num_threads));
  }
  const auto measured = Measure(settings, options);
  std::printf("%d cores, %d threads; Embree %s, %s; %d turns\n\n", num_cores, options.num_threads,
              EmbreeVersion().c_str(), IsaInUse("").c_str(), options.num_turns);
  std::printf(
      "| | triangles | instances | build s | memory MB | points | ms a frame | x base | "
      "published |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const ScenarioSpec& scenario = settings[i].scenario;
    const World& world = measured[i]->simulator->world();
    const SceneAudit audit =
        AuditScene(world, MaterialLibrary(scenario.materials), 0, scenario.lidar.range_max_m);
    std::printf("| %s | %zu | %zu | %.2f | %.0f | %zu | %.2f | %.2f | no figure |\n",
                settings[i].name.c_str(),
                audit.ground_triangles + audit.placed_triangles + audit.object_triangles,
                audit.num_placements + world.objects().size(), built[i].build_s, built[i].memory_mb,
                built[i].num_points, Median(measured[i]->times_ms),
                MedianRatio(measured[i]->times_ms, measured.front()->times_ms));
  }
  return kExitSuccess;
}

int Main(int argc, char** argv) {
  SettingsOptions options;
  CLI::App app("Measures the scene settings of the published evaluation.");
  app.add_option("SCENARIO", options.scenario, "Scenario file; default: the demo")
      ->check(NonEmpty());
  app.add_option("--turns", options.num_turns, "Turns that each setting takes")
      ->transform(Whole({1, 1'000'000}))
      ->capture_default_str();
  app.add_option("--threads", options.num_threads, "0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return RunSettings(options);
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-settings", [&] { return railcast::Main(argc, argv); }, std::cerr);
}
