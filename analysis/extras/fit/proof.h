#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/extras/fit/fit.h"
#include "analysis/extras/preset/preset_comparison.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {

/// Judges fitted parameters by replays of the planes that a recording shows, as `preset` makes
/// them.
class FitProof {
 public:
  /// Turns of a recording that are replayed at most.
  static constexpr std::size_t kMostTurns = 12;

  /// @param turns Whole ones (WholeTurns()).
  /// @param source Names the recording in messages.
  FitProof(const std::vector<RecordedFrame>& turns, std::string source);

  [[nodiscard]] bool has_planes() const { return !halves_.empty(); }

  /// The firings that must have met a plane, by whole metres; those of them without a point are
  /// lost.
  [[nodiscard]] std::map<int, LossBin> Losses() const;

  /// Puts the fitted parameters into a scenario one after the other, replays it, and gives each its
  /// proof. Noise is judged by that from turn to turn, without which roughness would count, or
  /// where there is none by that about planes; losses are judged by holes. Better is
  /// what is nearer to the recording in each half of the sectors, by more than a standard error;
  /// worse is what is farther in their mean, and is taken out again.
  /// @pre has_planes().
  /// @throws InputError as CompareTurns().
  void Judge(ScenarioSpec scenario, FitResult& result) const;

 private:
  std::vector<SeenTurns> halves_;  ///< The sectors that show a plane.
  std::string source_;
};

}  // namespace railcast
