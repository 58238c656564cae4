#include "tests/bench/scene_cost.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <thread>

#include "core/program/program.h"
#include "generator/check/scene_audit.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

BuildCost BuildHere(const ScenarioSpec& scenario, int num_threads) {
  constexpr double kMillisecond_s = 1e-3;
  constexpr double kKibibyte_mb = 1024e-6;
  std::unique_ptr<FrameMaker> maker;
  BuildCost cost;
  cost.build_s = kMillisecond_s * TimeOf_ms([&] {
                   maker = std::make_unique<FrameMaker>(scenario, num_threads);
                   maker->Make(0);
                 });
  cost.num_points = maker->num_points();
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  cost.memory_mb = kKibibyte_mb * static_cast<double>(usage.ru_maxrss);
  return cost;
}

}  // namespace

FrameMaker::FrameMaker(const ScenarioSpec& scenario, int num_threads)
    : simulators_(MakeSimulators(scenario, num_threads)), frames_(simulators_.size()) {
  if (!scenario.camera) return;
  camera_ = MakeCamera(PickSensor(scenario, SensorNames(scenario).front()));
}

void FrameMaker::Make(std::uint32_t index) {
  for (std::size_t i = 0; i < simulators_.size(); ++i) simulators_[i]->Scan(index, frames_[i]);
  if (camera_) camera_->Render(*simulators_.front(), index, image_);
}

std::function<void()> FrameMaker::MakeRawTrace() {
  std::vector<std::function<void()>> traces;
  for (const auto& simulator : simulators_) traces.push_back(simulator->MakeRawTrace(0));
  return [traces = std::move(traces)] {
    for (const std::function<void()>& trace : traces) trace();
  };
}

std::size_t FrameMaker::num_firings() const {
  std::size_t count = 0;
  for (const auto& simulator : simulators_) count += simulator->pattern().num_firings();
  return count;
}

std::size_t FrameMaker::num_points() const {
  std::ptrdiff_t count = 0;
  for (const Frame& frame : frames_) {
    count +=
        std::ranges::count_if(frame.outcome, [](Outcome outcome) { return HasPoint(outcome); });
  }
  return static_cast<std::size_t>(count);
}

BuildCost BuildInAProcess(const ScenarioSpec& scenario, int num_threads) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw InputError("pipe: must be available");
  const pid_t child = ::fork();
  if (child < 0) throw InputError("fork: must be possible");
  if (child == 0) {
    const BuildCost cost = BuildHere(scenario, num_threads);
    const bool is_told = ::write(ends[1], &cost, sizeof(cost)) == sizeof(cost);
    ::_exit(is_told ? kExitSuccess : kExitFailure);
  }
  ::close(ends[1]);
  BuildCost cost;
  const bool is_told = ::read(ends[0], &cost, sizeof(cost)) == sizeof(cost);
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (!is_told) throw InputError("the process of a scenario: must end with its figures");
  return cost;
}

SceneSize SizeOf(const ScenarioSpec& scenario, const World& world) {
  double range_max_m = 0.0;
  for (const std::string& sensor : SensorNames(scenario)) {
    range_max_m = std::max(range_max_m, PickSensor(scenario, sensor).lidar.range_max_m);
  }
  const SceneAudit audit = AuditScene(world, MaterialLibrary(scenario.materials), 0,
                                      BuildChunksInReach(world, 0, range_max_m));
  return {audit.ground_triangles + audit.placed_triangles + audit.object_triangles,
          audit.num_placements + world.objects().size()};
}

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

double TimeOf_ms(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

double CpuTime_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double CpuTimeOf_ms(const std::function<void()>& work) {
  const double begin_ms = CpuTime_ms();
  work();
  return CpuTime_ms() - begin_ms;
}

double Median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace railcast
