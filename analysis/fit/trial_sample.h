#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/fit/trial.h"

namespace railcast {

/// A bounded sample of any number of trials: of each cell of (surface, range, incidence) at most
/// kMaxPerCell, chosen by a hash of their ids. So it does not depend on the order in which they
/// come, and every surface is there at every range and incidence at which it was seen.
///
/// Which trials are kept depends on what was expected of them, never on what came back; so shares,
/// scatter and reflectance *given* range and incidence are those of all trials.
class TrialSample {
 public:
  /// @param id Of the trial, unique: frame number and slot.
  void Add(const Trial& trial, std::uint64_t id);

  [[nodiscard]] std::uint64_t num_seen() const { return num_seen_; }
  /// Those kept, in the order of their surfaces and cells.
  [[nodiscard]] std::vector<Trial> trials() const;

  static constexpr std::size_t kMaxPerCell = 256;

 private:
  struct Kept {
    std::uint64_t hash{};
    Trial trial;
  };
  /// Sorted as a heap, the greatest hash in front.
  using Cell = std::vector<Kept>;

  std::uint64_t num_seen_{};
  std::vector<std::vector<Cell>> surfaces_;  ///< [surface][cell]
};

}  // namespace railcast
