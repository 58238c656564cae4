#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "generator/extras/insert/screen_echoes.h"
#include "generator/extras/insert/screens.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"

namespace railcast {

/// A frame's firings as they were recorded.
struct RecordedScan {
  std::uint32_t index{};       ///< Of the frame; part of every random key.
  std::int64_t stamp_ns{};     ///< On the world's clock.
  const ScanPattern& pattern;  ///< Not every cell need have a firing.
  /// What each firing has returned, in the order of its slots. `surface` is not used.
  std::vector<std::uint32_t> first;  ///< By firing, the index of its first return, and the end.
  std::vector<Screen> returns;
};

/// What has changed in a recorded frame.
struct ScreenedFrame {
  std::vector<ChangedFiring> firings;  ///< By firing.
  /// By recorded return, its power over the recorded one, the air's part included.
  std::vector<float> power_kept;
  std::vector<ObjectView> views;  ///< One for each of the world's objects.
};

/// Simulates recorded firings in a world that holds what was not there when they were recorded. All
/// else are the recorded returns, which stand as screens where they were met (Screens).
///
/// Only firings that may meet an object are traced. All others return what they returned, unless
/// there is weather: then each recorded return is weakened, and what the air sends is added.
///
/// A recorded return was above the threshold of the receiver, however weak the model takes it to
/// be, and noise had its say: with the probability of detection P before and P' now it is lost with
/// the probability 1 - P' / P, and where it is not its range stays as it is.
class ScreenedScan {
 public:
  /// @param num_threads 0 = all cores.
  /// @throws InputError as Simulator's constructor does.
  ScreenedScan(std::shared_ptr<const World> world,
               const std::vector<Material>& materials,
               const SimulatorSpec& spec,
               int num_threads);
  ~ScreenedScan();

  /// One caller at a time.
  /// @param returns Slots for each firing.
  [[nodiscard]] ScreenedFrame Scan(RecordedScan recorded, std::uint32_t returns);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
