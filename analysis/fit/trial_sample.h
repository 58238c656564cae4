#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/fit/trial.h"

namespace railcast {

/// A bounded sample of any number of trials: of each cell of (surface, range, incidence) at most as
/// many as keep the whole below kMaxTrials, chosen by a hash of their ids. So it does not depend on
/// the order in which they come, and every surface is there at every range and incidence at which
/// it was seen.
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

  static constexpr std::size_t kMaxTrials = 300'000;

 private:
  struct Kept {
    std::uint64_t hash{};
    Trial trial;
  };
  [[nodiscard]] static bool IsLess(const Kept& a, const Kept& b) { return a.hash < b.hash; }
  /// Sorted as a heap, the greatest hash in front.
  using Cell = std::vector<Kept>;

  void HalveCells();

  std::uint64_t num_seen_{};
  std::size_t num_kept_{};
  std::size_t max_per_cell_ = 65'536;        ///< Halved whenever there are too many in all.
  std::vector<std::vector<Cell>> surfaces_;  ///< [surface][cell]
};

}  // namespace railcast
