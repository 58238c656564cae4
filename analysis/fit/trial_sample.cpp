#include "analysis/fit/trial_sample.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

// Ranges by tenths of their logarithm from 0.5 m to 500 m, cosines by quarters of theirs to 0.018.
constexpr int kNumRangeCells = 70;
constexpr int kNumCosCells = 16;

std::size_t CellOf(const Trial& trial) {
  const auto range = static_cast<int>(10.0 * std::log(2.0 * static_cast<double>(trial.expected_m)));
  const auto cosine = static_cast<int>(-4.0 * std::log(static_cast<double>(trial.cos_incidence)));
  return static_cast<std::size_t>(std::clamp(range, 0, kNumRangeCells - 1) * kNumCosCells +
                                  std::clamp(cosine, 0, kNumCosCells - 1));
}

// The finalizer of SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number
// generators"): one to one, so that unequal ids never tie.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

}  // namespace

void TrialSample::Add(const Trial& trial, std::uint64_t id) {
  ++num_seen_;
  if (surfaces_.size() <= trial.surface) surfaces_.resize(std::size_t{trial.surface} + 1);
  std::vector<Cell>& cells = surfaces_[trial.surface];
  if (cells.empty()) cells.resize(std::size_t{kNumRangeCells} * kNumCosCells);
  Cell& cell = cells[CellOf(trial)];
  const std::uint64_t hash = Mix(id);
  if (cell.size() == max_per_cell_) {
    if (hash >= cell.front().hash) return;
    std::pop_heap(cell.begin(), cell.end(), IsLess);
    cell.back() = {hash, trial};
  } else {
    cell.push_back({hash, trial});
    ++num_kept_;
  }
  std::push_heap(cell.begin(), cell.end(), IsLess);
  while (num_kept_ > kMaxTrials && max_per_cell_ > 1) HalveCells();
}

// What is left does not depend on when this happens: the number in all only ever grows with the
// trials seen, and of each cell those with the least hashes stay.
void TrialSample::HalveCells() {
  max_per_cell_ /= 2;
  num_kept_ = 0;
  for (std::vector<Cell>& cells : surfaces_) {
    for (Cell& cell : cells) {
      if (cell.size() > max_per_cell_) {
        const auto end = cell.begin() + static_cast<std::ptrdiff_t>(max_per_cell_);
        std::nth_element(cell.begin(), end, cell.end(), IsLess);
        cell.resize(max_per_cell_);
        std::make_heap(cell.begin(), cell.end(), IsLess);
      }
      num_kept_ += cell.size();
    }
  }
}

std::vector<Trial> TrialSample::trials() const {
  std::vector<Trial> trials;
  for (const std::vector<Cell>& cells : surfaces_) {
    for (Cell cell : cells) {
      std::sort(cell.begin(), cell.end(), IsLess);
      for (const Kept& kept : cell) trials.push_back(kept.trial);
    }
  }
  return trials;
}

}  // namespace railcast
