#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {

/// A scenario that is built and makes frames of all of its sensors, with images if it has a camera,
/// which is with the first sensor.
class FrameMaker {
 public:
  /// @param num_threads 0 = all cores.
  FrameMaker(const ScenarioSpec& scenario, int num_threads);

  void Make(std::uint32_t index);
  /// Makes the raw trace of frame 0 for all sensors.
  [[nodiscard]] std::function<void()> MakeRawTrace();

  [[nodiscard]] const World& world() const { return simulators_.front()->world(); }
  [[nodiscard]] std::size_t num_firings() const;
  /// In the frames that were made last.
  [[nodiscard]] std::size_t num_points() const;

 private:
  std::vector<std::unique_ptr<Simulator>> simulators_;
  std::optional<Camera> camera_;
  std::vector<Frame> frames_;
  CameraImage image_;
};

/// What a process that builds nothing but one scenario tells of it.
struct BuildCost {
  double build_s{};  ///< Until frame 0 is complete.
  std::size_t num_points{};
  double memory_mb{};  ///< The most that the process held.
};

/// Builds a scenario and makes its frame 0 in a process of its own. Must be called before this
/// process has threads or much memory, both of which a child would inherit.
[[nodiscard]] BuildCost BuildInAProcess(const ScenarioSpec& scenario, int num_threads);

/// What the window of frame 0 and all objects hold.
struct SceneSize {
  std::size_t num_triangles{};  ///< Every instance counts with all of its triangles.
  std::size_t num_instances{};  ///< Placed models and objects.
};
[[nodiscard]] SceneSize SizeOf(const ScenarioSpec& scenario, const World& world);

/// Waits until the windows are built that simulators prepare in the background.
void WaitUntilIdle();

[[nodiscard]] double TimeOf_ms(const std::function<void()>& work);
/// What the processor has spent on this process so far, summed over its threads. For work of one
/// thread, the difference leaves out what other programs took.
[[nodiscard]] double CpuTime_ms();
[[nodiscard]] double CpuTimeOf_ms(const std::function<void()>& work);
[[nodiscard]] double Median(std::vector<double> values);

}  // namespace railcast
