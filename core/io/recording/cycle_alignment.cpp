#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/base/median.h"
#include "core/io/recording/ring_table.h"

namespace railcast {
namespace {

using Phase = std::complex<double>;

constexpr double kUnknownPlace = std::numeric_limits<double>::quiet_NaN();
/// Lasers look at most so far beside each other.
constexpr double kMostAside_turns = 16.0 / 360.0;
/// Points of a row nearer to each other, in steps, are of one firing, as in AssignColumns().
constexpr double kSameFiring_steps = 0.02;

/// The points of a row, which fires once in each cycle, with azimuths in steps.
struct CycleRow {
  std::span<TablePoint> points;
  std::vector<double> steps;
  std::vector<std::int64_t> columns;  ///< Counted from neighbour to neighbour.
  std::int64_t shift = 0;             ///< From columns to cycles.
};

CycleRow MakeCycleRow(std::span<TablePoint> points, double step) {
  CycleRow row{points, {}, {}};
  for (const TablePoint& point : points) {
    const double steps = point.turns / step;
    const double way = row.steps.empty() ? 0.0 : steps - row.steps.back();
    const std::int64_t last = row.columns.empty() ? point.column : row.columns.back();
    const std::int64_t num = way < kSameFiring_steps ? 0 : std::max(1LL, std::llround(way));
    row.columns.push_back(last + num);
    row.steps.push_back(steps);
  }
  return row;
}

/// Where in its step the rotor is in each cycle, as the rows that were added show it.
class CyclePhases {
 public:
  /// Counts cycles as the columns of this row.
  explicit CyclePhases(const CycleRow& row)
      : first_(row.columns.front()),
        sums_(static_cast<std::size_t>(row.columns.back() - first_ + 1)),
        places_(sums_.size(), kUnknownPlace) {
    for (std::size_t i = 0; i < row.columns.size(); ++i) {
      places_[static_cast<std::size_t>(row.columns[i] - first_)] =
          row.steps[i] - static_cast<double>(row.columns[i]);
    }
  }

  /// The sum of the row's phases less those of the cycles: of length 1 if they are alike.
  [[nodiscard]] Phase Likeness(const CycleRow& row, std::int64_t shift) const {
    constexpr std::size_t kMostPoints = 500;
    Phase sum;
    double most = 0.0;
    for (std::size_t i = 0; i < row.steps.size(); i += 1 + row.steps.size() / kMostPoints) {
      const std::int64_t cycle = row.columns[i] + shift;
      if (!Has(cycle)) continue;
      const Phase& of_cycle = sums_[static_cast<std::size_t>(cycle - first_)];
      sum += PhaseOf(row.steps[i]) * std::conj(of_cycle);
      most += std::abs(of_cycle);
    }
    return most > 0.0 ? sum / most : Phase();
  }

  void Add(const CycleRow& row) {
    const Phase aside = Likeness(row, row.shift);
    const Phase turn = std::abs(aside) > 0.0 ? std::conj(aside) / std::abs(aside) : Phase(1.0);
    for (std::size_t i = 0; i < row.steps.size(); ++i) {
      const std::int64_t cycle = row.columns[i] + row.shift;
      if (Has(cycle))
        sums_[static_cast<std::size_t>(cycle - first_)] += turn * PhaseOf(row.steps[i]);
    }
  }

  /// Azimuths of the rotor in steps less the numbers of the cycles; where none is known, that of
  /// the cycle before. A turn that ends beyond its begin has a leap there.
  [[nodiscard]] std::vector<double> Places() const {
    std::vector<double> places = places_;
    double last = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double near = std::isnan(places[i]) ? last : places[i];
      const double part = std::arg(sums_[i]) / (2.0 * std::numbers::pi);
      places[i] = std::abs(sums_[i]) > 0.0 ? part + std::round(near - part) : near;
      last = places[i];
    }
    return places;
  }

  [[nodiscard]] std::int64_t first() const { return first_; }

 private:
  [[nodiscard]] static Phase PhaseOf(double steps) {
    return std::polar(1.0, 2.0 * std::numbers::pi * steps);
  }
  [[nodiscard]] bool Has(std::int64_t cycle) const {
    return cycle >= first_ && cycle < first_ + static_cast<std::int64_t>(sums_.size());
  }

  std::int64_t first_;
  std::vector<Phase> sums_;
  std::vector<double> places_;  ///< As the first row shows them.
};

/// Finds by how many cycles a row is ahead of those already added: the rotor is never quite even,
/// and all lasers show the same unevenness.
std::int64_t ShiftOf(const CyclePhases& phases, const CycleRow& row, double step) {
  const auto unlike = [&](std::int64_t shift) {
    return 1.0 - std::abs(phases.Likeness(row, shift));
  };
  constexpr double kEven = 1e-3;
  constexpr double kMuchLess = 0.6;
  const double unshifted = unlike(0);
  if (unshifted < kEven) return 0;
  const auto most = static_cast<std::int64_t>(kMostAside_turns / step);
  std::int64_t best = 0;
  double least = unshifted;
  for (std::int64_t shift = -most; shift <= most; ++shift) {
    const double now = unlike(shift);
    if (now >= least) continue;
    least = now;
    best = shift;
  }
  return least < kMuchLess * unshifted ? best : 0;
}

/// A point's cycle and how far it is beside that, in steps.
struct CycleOfPoint {
  std::int64_t cycle{};
  double steps{};
  double off_steps{};
};

/// The cycles of a turn, of which the first is `first`.
struct TurnCycles {
  std::vector<double> places;
  std::int64_t first{};
  double step{};
  bool is_full_turn{};

  [[nodiscard]] std::int64_t last() const {
    return first + static_cast<std::int64_t>(places.size()) - 1;
  }
  [[nodiscard]] double PlaceOf(std::int64_t cycle) const {
    return places[static_cast<std::size_t>(std::clamp(cycle, first, last()) - first)];
  }

  [[nodiscard]] std::vector<CycleOfPoint> Of(const CycleRow& row) const {
    std::vector<double> aside;
    for (std::size_t i = 0; i < row.steps.size(); ++i) {
      const std::int64_t cycle = row.columns[i] + row.shift;
      aside.push_back(row.steps[i] - static_cast<double>(cycle) - PlaceOf(cycle));
    }
    const double middle = MedianOf(aside);
    std::vector<CycleOfPoint> cycles;
    for (std::size_t i = 0; i < row.steps.size(); ++i) {
      cycles.push_back(Nearest(row.steps[i] - middle, row.columns[i] + row.shift));
    }
    return cycles;
  }

 private:
  [[nodiscard]] CycleOfPoint Nearest(double steps, std::int64_t cycle) const {
    // What a laser that looks ahead sees first, it sees at the end of the rotor's turn.
    if (is_full_turn && (cycle < first || cycle > last())) {
      steps += (cycle < first ? 1.0 : -1.0) / step;
      cycle = std::llround(steps - PlaceOf(cycle < first ? last() : first));
    }
    constexpr std::int64_t kMostBeside = 3;
    CycleOfPoint nearest{cycle, steps, std::numeric_limits<double>::infinity()};
    for (std::int64_t tried = cycle - kMostBeside; tried <= cycle + kMostBeside; ++tried) {
      const double off = std::abs(steps - static_cast<double>(tried) - PlaceOf(tried));
      if (off < nearest.off_steps) nearest = {tried, steps, off};
    }
    return nearest;
  }
};

/// Whether two firings share a cycle.
bool ShareCycles(std::vector<CycleOfPoint> points) {
  const auto order = [](const CycleOfPoint& point) { return std::pair(point.cycle, point.steps); };
  std::ranges::sort(points, {}, order);
  const auto share = [](const CycleOfPoint& a, const CycleOfPoint& b) {
    return a.cycle == b.cycle && b.steps - a.steps > kSameFiring_steps;
  };
  return std::ranges::adjacent_find(points, share) != points.end();
}

}  // namespace

void AlignCycles(std::vector<TablePoint>& points, double step, bool is_full_turn) {
  std::vector<CycleRow> rows;
  ForEachRow(points, [&](std::span<TablePoint> row) { rows.push_back(MakeCycleRow(row, step)); });
  std::ranges::stable_sort(rows, std::greater(),
                           [](const CycleRow& row) { return row.steps.size(); });
  CyclePhases phases(rows.front());
  for (CycleRow& row : rows) {
    row.shift = ShiftOf(phases, row, step);
    phases.Add(row);
  }
  const TurnCycles turn{phases.Places(), phases.first(), step, is_full_turn};
  std::vector<std::vector<CycleOfPoint>> cycles;
  double squares = 0.0;
  for (const CycleRow& row : rows) {
    cycles.push_back(turn.Of(row));
    if (ShareCycles(cycles.back())) return;
    for (const CycleOfPoint& point : cycles.back()) squares += point.off_steps * point.off_steps;
  }
  constexpr double kMostOff_steps = 0.1;
  if (squares > kMostOff_steps * kMostOff_steps * static_cast<double>(points.size())) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < cycles[i].size(); ++k) {
      rows[i].points[k].column = cycles[i][k].cycle;
    }
  }
}

}  // namespace railcast
