#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/estimate/log_histogram.h"
#include "railcast/frame.h"

namespace railcast {

/// What an effect does to individual beams: sums over frames of the same scan, made with the same
/// random draws, without the effect and with it.
struct BeamChanges {
  static constexpr std::size_t kNumOutcomes = kOutcomeNames.size();
  struct RangeBin {
    std::uint64_t num_beams{};
    std::uint64_t num_changed{};  ///< Beams that are not identical.
    std::uint64_t num_outcome_changed{};
  };

  BeamChanges();
  /// @pre Both frames have the same pattern and the same number of returns.
  void Add(const Frame& without, const Frame& with);

  std::uint64_t num_beams{};
  /// Bit-identical in position, range, outcome and, where both have one, intensity.
  std::uint64_t num_identical{};
  std::uint64_t num_outcome_changed{};

  // The counts below are of returns: points of any slot.
  std::uint64_t num_removed{};  ///< Points that only the frame without the effect has.
  std::uint64_t num_added{};    ///< Points that only the frame with the effect has.
  std::uint64_t num_both{};
  std::uint64_t num_moved{};              ///< Points that both have, but at different positions.
  LogHistogram moved_m;                   ///< Displacement of the points that moved.
  std::uint64_t num_intensity_changed{};  ///< Points of both with different intensities.
  LogHistogram intensity_change;          ///< Absolute change of the intensities that changed.

  /// Number of beams by outcome without the effect, then with it.
  std::array<std::array<std::uint64_t, kNumOutcomes>, kNumOutcomes> transitions{};
  /// By bin of RangeBins(), at the range where the beam meets a surface.
  std::vector<RangeBin> range_bins;
};

}  // namespace railcast
