#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/certify/certifier.h"
#include "generator/extras/insert/screen_echoes.h"
#include "generator/extras/insert/screens.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"

namespace railcast {

/// A frame's firings as they were recorded.
struct RecordedScan {
  std::uint32_t index{};       ///< Index of the frame; part of every random key.
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

  /// Tells the ways in which a Certify makes firings once more.
  void UseVariants(const std::vector<FiringVariant>& variants);

  /// Makes some firings of a frame in each variant, in the same scene and with the same random
  /// draws; returns what each has changed, by variant and in the order of the firings.
  using MakeAnew =
      std::function<std::vector<std::vector<ChangedFiring>>(const std::vector<std::uint32_t>&)>;
  /// Is called with a frame that is made.
  /// @param near The firings whose beams may meet an object, in any of the variants.
  using Certify = std::function<void(
      const ScreenedFrame& made, std::span<const std::uint32_t> near, const MakeAnew& make)>;

  /// One caller at a time.
  /// @param returns Slots for each firing.
  /// @param certify May be empty.
  [[nodiscard]] ScreenedFrame Scan(const RecordedScan& recorded,
                                   std::uint32_t returns,
                                   const Certify& certify = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Certifies frames of a ScreenedScan: of the firings that may meet an object, some are made anew
/// on rung `reference` and on those beside the plan's own. Counted are the echoes of firings that
/// return something else than was recorded on one of these rungs; recorded returns have label 0.
class ScreenedCertifier {
 public:
  /// @param cost_share What the certificates may take, as a share of the frames' own time.
  /// @param own With the plan's effects.
  /// @throws InputError as Certifier's constructor does.
  ScreenedCertifier(const ScenarioSpec& scenario,
                    double cost_share,
                    const DetectorSpec& own,
                    const World& world);

  [[nodiscard]] const Certifier& certifier() const { return certifier_; }
  /// For ScreenedScan::Certify. Depends on the frame alone.
  [[nodiscard]] FrameCertificate Certify(const RecordedScan& recorded,
                                         const ScreenedFrame& made,
                                         std::span<const std::uint32_t> near,
                                         const ScreenedScan::MakeAnew& make);

 private:
  void FillGrid(const RecordedScan& recorded,
                const ScreenedFrame& made,
                std::span<const std::uint32_t> near);

  Certifier certifier_;  ///< Certifies frames of one firing.
  double
      cost_of_others_{};  ///< What a firing takes that is not traced; in multiples of one that is.
  Frame grid_;            ///< What the firings that are certified meet first.
  std::vector<std::uint32_t> filled_;  ///< Cells of the grid that may not be empty.
};

}  // namespace railcast
