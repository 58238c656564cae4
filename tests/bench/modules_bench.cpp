// Measures the four modules of the published evaluation (Vir2Rail, Table 1) on railcast's tracer
// (scan_modules.h), interleaved in one process, and prints a table in Markdown.
//
//   railcast-measure modules [SCENARIO] [--scans N] [--threads N]
//
// Fails if modules 1, 2 and 3 do not give the same points, bit for bit.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "core/trace/trace_program.h"
#include "railcast/error.h"
#include "railcast/scenario.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scan_modules.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

constexpr std::size_t kPublishedScans = 20;  // Two runs of ten.
constexpr std::array kPublishedMean_ms = {168.38, 135.33, 42.68, 42.56};

struct ModulesOptions {
  std::string scenario = RAILCAST_SCENARIOS_DIR "/st_gallen_approach.json";
  std::size_t num_scans = 1000;
  int num_threads = 0;
};

/// A row of the table: what is measured, and how long each scan took.
struct Row {
  std::string name;
  std::string published;
  std::function<void()> scan;
  std::vector<double> times_ms{};
};

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Deviation(const std::vector<double>& values) {
  const double mean = Mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double Quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

// The points in the order of their firings.
std::vector<ScanModules::Point> PointsOf(std::span<const std::uint8_t> bytes) {
  std::vector<ScanModules::Point> points(bytes.size() / sizeof(ScanModules::Point));
  std::memcpy(points.data(), bytes.data(), bytes.size());
  std::ranges::sort(points, {}, &ScanModules::Point::firing);
  return points;
}

void CheckThatModulesAgree(ScanModules& modules) {
  const std::vector<ScanModules::Point> points = PointsOf(modules.Scan(1));
  for (const int module : {2, 3}) {
    if (PointsOf(modules.Scan(module)) == points) continue;
    throw InputError("module " + std::to_string(module) + ": must give the points of module 1");
  }
}

std::string PublishedText(int module) {
  char text[32];
  const double mean_ms = kPublishedMean_ms[static_cast<std::size_t>(module - 1)];
  std::snprintf(text, sizeof(text), "%.2f | %.2f", mean_ms, kPublishedMean_ms[0] / mean_ms);
  return text;
}

std::vector<Row> RowsOf(ScanModules& modules) {
  std::vector<Row> rows;
  for (int module = 1; module <= ScanModules::kNumModules; ++module) {
    rows.push_back({"module " + std::to_string(module), PublishedText(module),
                    [&modules, module] { static_cast<void>(modules.Scan(module)); }});
  }
  rows.push_back({"trace alone, 1 thread", " | ", [&modules] { modules.TraceOnly(true); }});
  rows.push_back({"trace alone", " | ", [&modules] { modules.TraceOnly(false); }});
  return rows;
}

void Print(const std::vector<Row>& rows) {
  std::printf(
      "| module | mean ms | sd | min | max | p50 of all | p99 of all | speed-up | "
      "published mean ms | published speed-up |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const double first_ms = Quantile(rows.front().times_ms, 0.5);
  for (const Row& row : rows) {
    const std::size_t num_first = std::min(kPublishedScans, row.times_ms.size());
    const std::vector<double> first(row.times_ms.begin(),
                                    row.times_ms.begin() + static_cast<std::ptrdiff_t>(num_first));
    const auto [least, most] = std::ranges::minmax(first);
    const double median_ms = Quantile(row.times_ms, 0.5);
    std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %s |\n", row.name.c_str(),
                Mean(first), Deviation(first), least, most, median_ms, Quantile(row.times_ms, 0.99),
                first_ms / median_ms, row.published.c_str());
  }
}

int RunModules(const ModulesOptions& options) {
  const ScenarioSpec scenario = ReadScenario(options.scenario);
  const int num_threads = options.num_threads > 0
                              ? options.num_threads
                              : static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  ScanModules modules(scenario, num_threads);
  CheckThatModulesAgree(modules);
  std::printf("%zu firings, %zu points; modules 2 to 4 on %d threads; Embree %s, %s; %zu scans\n\n",
              BuildScanPattern(scenario.lidar.scan).num_firings(),
              modules.Scan(1).size() / sizeof(ScanModules::Point), num_threads,
              EmbreeVersion().c_str(), IsaInUse("").c_str(), options.num_scans);
  std::vector<Row> rows = RowsOf(modules);
  for (std::size_t i = 0; i < options.num_scans; ++i) {
    for (Row& row : rows) row.times_ms.push_back(TimeOf_ms(row.scan));
  }
  Print(rows);
  return kExitSuccess;
}

}  // namespace

void AddModules(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions modules =
      app.AddCommand("modules", "Measure the four modules of the published evaluation");
  const auto options = std::make_shared<ModulesOptions>();
  modules.AddOption("SCENARIO", options->scenario, "Scenario file; default: the demo")
      .Check(NonEmpty());
  modules
      .AddOption("--scans", options->num_scans,
                 "Scans of each module; mean, deviation, minimum and maximum are of the first 20")
      .Check(Whole({2, 1'000'000}))
      .ShowDefault();
  modules.AddOption("--threads", options->num_threads, "Threads of modules 2 to 4; 0 = all cores")
      .Check(Whole({0, 1024}))
      .ShowDefault();
  modules.WhenParsed([options, &command] {
    command = [options](const std::string&) { return RunModules(*options); };
  });
}

}  // namespace railcast
