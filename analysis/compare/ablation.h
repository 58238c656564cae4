#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/comparison.h"
#include "analysis/estimate/streams.h"
#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

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

/// What an effect changes in one frame, as shares of its beams.
struct FrameChanges {
  double outcome{};  ///< Beams with another outcome.
  double points{};   ///< Points that only one of the frames has, of any slot.
};

/// What one effect changes in a scenario while all other effects stay as they are.
struct EffectStudy {
  std::string effect;
  bool is_in_scenario{};  ///< Otherwise the effect was switched on for the study.
  /// The rung on which it was studied, if it does not go together with the scenario's effects.
  std::optional<Fidelity> rung{};
  BeamChanges beams;
  std::vector<FrameChanges> frames;  ///< One for each frame.
  Comparison clouds;                 ///< A: without the effect, B: with it.
};

/// Which effects an ablation studies: those that are compatible with the scenario's once they are
/// switched, or all, where the others are switched among the effects of the first rung that has
/// them.
enum class StudyScope { kCompatible, kAll };

using AblationProgress = std::function<void(const std::string& what, double done)>;

/// Simulates frames with the scenario's effects and then with each studied effect switched.
/// All runs use the same random draws, so a beam that an effect leaves alone is bit-identical.
/// @param simulator Made from the scenario; its spec is restored afterwards.
[[nodiscard]] std::vector<EffectStudy> Ablate(Simulator& simulator,
                                              const std::vector<std::uint32_t>& frames,
                                              const std::vector<double>& distances_m,
                                              const AblationProgress& on_progress,
                                              StudyScope scope = StudyScope::kCompatible);

}  // namespace railcast
