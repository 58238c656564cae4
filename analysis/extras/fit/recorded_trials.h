#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// A point on a flat piece of surface (analysis/stats/plane_patches.h).
struct NoiseTrial {
  float range_m{};          ///< Range of the piece's plane, along the beam.
  float slant_m_per_rad{};  ///< Derivative of that range by the beam's angle: R tan(incidence).
  /// Measured minus expected range. Since the plane was fitted to the n points of the piece, their
  /// residuals are too small; they are multiplied by sqrt(n / (n - 3)),
  /// so that their mean square is that of the noise.
  float residual_m{};
  /// By how much the distance from the plane differs in the next frame, divided by sqrt(2), so that
  /// its mean square is that of the noise, without the surface's roughness. NaN where there is no
  /// such point, or the sensor is known to have moved.
  float change_m = std::numeric_limits<float>::quiet_NaN();
  /// The second difference of the ranges along the ring (SecondDifference_m()), whose mean square
  /// is at most that of the noise and of what roughness bends between neighbours. NaN where there
  /// is none.
  float bend_m = std::numeric_limits<float>::quiet_NaN();
  float intensity{};      ///< As recorded.
  std::uint32_t piece{};  ///< Points of one piece share its number.
  std::uint16_t channel{};
};

/// Firings at similar ranges that should have met a surface, since both neighbours in their ring
/// did (RangeBetweenNeighbours_m in analysis/stats/holes.h).
struct LossBin {
  std::uint64_t num{};
  std::uint64_t num_lost{};  ///< Firings without a point.
  double range_sum_m{};

  [[nodiscard]] double range_m() const { return range_sum_m / static_cast<double>(num); }
};

/// The samples of noise and losses in recordings.
struct RecordedTrials {
  std::vector<NoiseTrial> noise;
  /// By whole metres. Empty where the slots of a frame are not firings.
  std::map<int, LossBin> losses;
  std::uint64_t num_frames{};
  std::uint32_t num_pieces{};
  double step_m{};  ///< RangeStep_m() of the frames, the largest.

  /// Adds the trials of one more frame.
  void Add(const RecordedTrials& frame);
};

/// Sums the trials of frames in their order, in bounded memory: once there are more than
/// `max_points`, only every second, fourth, ... frame contributes noise trials.
class TrialSum {
 public:
  explicit TrialSum(std::size_t max_points) : max_points_(max_points) {}

  void Add(RecordedTrials frame);
  [[nodiscard]] const RecordedTrials& sum() const { return sum_; }

 private:
  void DropEverySecondFrame();

  std::size_t max_points_;
  RecordedTrials sum_;
  std::uint64_t stride_ = 1;  ///< Frames whose index is a multiple of this contribute noise trials.
  /// Index of each frame and of its first trial.
  std::vector<std::pair<std::uint64_t, std::size_t>> begins_;
};

/// The trials of one frame.
/// @param next The frame after it; null if there is none.
[[nodiscard]] RecordedTrials TakeTrials(const RecordedFrame& recorded,
                                        const RecordedFrame* next = nullptr);

/// Reads recordings to their ends, in parallel, and keeps noise trials of at most a million points.
/// @throws InputError as the recordings do.
[[nodiscard]] RecordedTrials ReadTrials(
    const std::vector<std::filesystem::path>& sources,
    const std::function<void(std::uint64_t num_frames)>& on_progress);

}  // namespace railcast
