#include "analysis/extras/preset/preset_comparison.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace railcast {
namespace {

using CellKey = std::tuple<std::uint32_t, std::size_t, std::size_t, std::size_t>;

CellKey CellKeyOf(const IntensityCell& cell, std::size_t more_strips, std::size_t more_steps) {
  const PlaneCell& place = cell.place;
  return {cell.turn, place.plane, place.strip + more_strips, place.step + more_steps};
}

/// Sets of cells that are put together one by one (union-find).
class CellSets {
 public:
  explicit CellSets(std::size_t num) : above_(num) { std::iota(above_.begin(), above_.end(), 0); }

  std::size_t Find(std::size_t cell) {
    while (above_[cell] != cell) {
      above_[cell] = above_[above_[cell]];
      cell = above_[cell];
    }
    return cell;
  }
  void Join(std::size_t one, std::size_t other) { above_[Find(other)] = Find(one); }

 private:
  std::vector<std::size_t> above_;
};

CellSets JoinLikeCells(const std::vector<IntensityCell>& cells, double like) {
  std::map<CellKey, std::size_t> places;
  for (std::size_t i = 0; i < cells.size(); ++i) places[CellKeyOf(cells[i], 0, 0)] = i;
  CellSets sets(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // On walls strips of the two sides alternate.
    const std::size_t beside = cells[i].is_ground ? 1 : 2;
    auto along = places.find(CellKeyOf(cells[i], 0, 1));
    // The rings of a sensor with few of them leave bins of range empty.
    if (along == places.end()) along = places.find(CellKeyOf(cells[i], 0, 2));
    for (const auto next : {places.find(CellKeyOf(cells[i], beside, 0)), along}) {
      if (next == places.end()) continue;
      const double change = std::log(cells[next->second].recorded / cells[i].recorded);
      if (std::abs(change) < std::log(like)) sets.Join(i, next->second);
    }
  }
  return sets;
}

}  // namespace

double CellPoints::MiddleIntensity() const {
  if (intensities.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<float> sorted = intensities;
  std::ranges::sort(sorted);
  const std::size_t cut = sorted.size() / 5;
  double sum = 0.0;
  for (std::size_t i = cut; i < sorted.size() - cut; ++i) sum += static_cast<double>(sorted[i]);
  return sum / static_cast<double>(sorted.size() - 2 * cut);
}

std::vector<IntensityCell> ComparableCells(const std::map<PlaneCell, CellPoints>& recorded,
                                           const std::map<PlaneCell, CellPoints>& simulated,
                                           const SeenPlanes& seen,
                                           std::uint32_t turn) {
  constexpr std::size_t kLeastPoints = 15;
  constexpr double kLeastIntensity = 0.02;
  std::vector<IntensityCell> cells;
  for (const auto& [place, points] : recorded) {
    const auto other = simulated.find(place);
    if (other == simulated.end()) continue;
    const std::size_t num = std::min(points.intensities.size(), other->second.intensities.size());
    const double intensity = points.MiddleIntensity();
    if (num < kLeastPoints || intensity < kLeastIntensity) continue;
    cells.push_back({.turn = turn,
                     .place = place,
                     .is_ground = seen.planes[place.plane].is_ground(),
                     .range_m = points.range_m.PlainMean(),
                     .incidence_deg = points.incidence_deg.PlainMean(),
                     .recorded = intensity,
                     .simulated = other->second.MiddleIntensity()});
  }
  return cells;
}

std::vector<IntensityCell> LikePieces(const std::vector<IntensityCell>& cells, double like) {
  constexpr std::size_t kLeastSteps = 3;
  CellSets sets = JoinLikeCells(cells, like);
  std::map<std::size_t, std::vector<std::size_t>> pieces;
  for (std::size_t i = 0; i < cells.size(); ++i) pieces[sets.Find(i)].push_back(i);
  std::vector<IntensityCell> compared;
  std::size_t num_pieces = 0;
  for (const auto& [root, members] : pieces) {
    std::set<std::size_t> steps;
    double sum = 0.0;
    for (const std::size_t i : members) {
      steps.insert(cells[i].place.step);
      sum += std::log(cells[i].recorded / cells[i].simulated);
    }
    if (steps.size() < kLeastSteps) continue;
    const double factor = std::exp(sum / static_cast<double>(members.size()));
    for (const std::size_t i : members) {
      compared.push_back(cells[i]);
      compared.back().simulated *= factor;
      compared.back().piece = num_pieces;
    }
    ++num_pieces;
  }
  return compared;
}

std::vector<IntensityCell> MeansOfSteps(const std::vector<IntensityCell>& pieces) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<IntensityCell>> steps;
  for (const IntensityCell& cell : pieces) steps[{cell.piece, cell.place.step}].push_back(cell);
  std::vector<IntensityCell> means;
  for (const auto& [step, cells] : steps) {
    IntensityCell mean = cells.front();
    mean.recorded = mean.simulated = 0.0;
    for (const IntensityCell& cell : cells) {
      mean.recorded += cell.recorded / static_cast<double>(cells.size());
      mean.simulated += cell.simulated / static_cast<double>(cells.size());
    }
    means.push_back(mean);
  }
  return means;
}

Estimate RangeExponentLeft(const std::vector<IntensityCell>& cells) {
  std::map<CellKey, const IntensityCell*> places;
  std::set<std::uint32_t> turns;
  for (const IntensityCell& cell : cells) places[CellKeyOf(cell, 0, 0)] = &cell;
  std::vector<double> exponents;
  for (const IntensityCell& cell : cells) {
    const auto next = places.find(CellKeyOf(cell, 0, 1));
    if (!cell.is_ground || next == places.end()) continue;
    const IntensityCell& other = *next->second;
    const double left = other.recorded / cell.recorded * cell.simulated / other.simulated;
    if (!(left > 0.0 && std::isfinite(left))) continue;  // A cell of which nothing returns.
    exponents.push_back(std::log(left) / std::log(other.range_m / cell.range_m));
    turns.insert(cell.turn);
  }
  const std::uint64_t num = exponents.empty() ? 0 : exponents.size() / turns.size();
  if (num < kMinSamples) return NotEnough(num);
  const double value = Median(exponents).value;
  std::ranges::sort(exponents);
  const RankInterval ranks = QuantileRanks(num, 0.5);
  return {value, exponents[(ranks.low - 1) * turns.size()],
          exponents[ranks.high * turns.size() - 1], num};
}

}  // namespace railcast
