#include "analysis/preset/preset_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/stats/bins.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/detect/beam_optics.h"

namespace railcast {
namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kLeastInBin = 500;

// The points of the planes alone.
RecordedFrame Masked(const RecordedFrame& recorded, const SeenPlanes& seen) {
  RecordedFrame masked = recorded;
  Frame& frame = masked.frame;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::size_t row = slot / frame.width();
    const std::size_t column = slot % frame.width() / frame.returns;
    if (seen.PlaneOf(row, column) != SeenPlanes::kNone) continue;
    frame.x[slot] = frame.y[slot] = frame.z[slot] = frame.range_m[slot] = kNone;
  }
  return masked;
}

// The frame as a sensor would report it: real intensities follow from the echo's peak, which is
// lower where the surface stretches the pulse, ours from the surface alone.
RecordedFrame AsRecorded(Frame frame, double least_power_m2, std::uint32_t index) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const auto true_range_m = static_cast<double>(frame.true_range_m[slot]);
    frame.intensity[slot] = static_cast<float>(static_cast<double>(frame.power_ratio[slot]) *
                                               least_power_m2 * true_range_m * true_range_m);
  }
  RecordedFrame recorded;
  recorded.is_grid = true;
  recorded.fields = {"x", "y", "z", "intensity", "range_m", "ring", "column"};
  recorded.frame = std::move(frame);
  recorded.frame.index = index;
  return recorded;
}

// The planes of a replayed frame's firings; its scan differs from the recording's.
SeenPlanes PlanesOfReplay(const Frame& frame, const SeenPlanes& seen, const ScanTable& scan) {
  SeenPlanes replayed{.scan = scan, .planes = seen.planes, .plane = {}};
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 0; column < frame.columns; ++column) {
      const std::size_t slot = row * frame.width() + column * frame.returns;
      const std::uint32_t instance = frame.instance[slot];
      replayed.plane.push_back(instance == 0 ? SeenPlanes::kNone
                                             : static_cast<std::uint8_t>(instance - 1));
    }
  }
  return replayed;
}

double MeanOf(const std::vector<double>& values) {
  if (values.empty()) return kNoFigure;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double MedianOfRatios(std::vector<double> values) {
  if (values.empty()) return kNoFigure;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A replay of planes that are equally bright everywhere, for the intensities.
constexpr double kEvenReflectivity = 0.5;

std::map<PlaneCell, double> EvenReflectivities(const PlaneFigures& recorded) {
  std::map<PlaneCell, double> reflectivities;
  for (const auto& [cell, means] : recorded.intensities) reflectivities[cell] = kEvenReflectivity;
  return reflectivities;
}

// Reflectivities with which each cell answers as strongly as it did.
std::map<PlaneCell, double> LocalReflectivities(const PlaneFigures& recorded,
                                                const PlaneFigures& even) {
  constexpr double kLeast = 0.002;
  constexpr double kMost = 1.0;
  std::map<PlaneCell, double> reflectivities;
  for (const auto& [cell, means] : recorded.intensities) {
    const auto replayed = even.intensities.find(cell);
    if (replayed == even.intensities.end()) continue;
    const double fitted =
        kEvenReflectivity * means.intensity.PlainMean() / replayed->second.intensity.PlainMean();
    reflectivities[cell] = std::clamp(fitted, kLeast, kMost);
  }
  return reflectivities;
}

void AddGaps(const Frame& frame, double dead_length_m, EchoGaps& gaps) {
  if (frame.returns < 2) return;
  for (std::size_t slot = 0; slot + 1 < frame.num_slots(); slot += frame.returns) {
    const double gap_m =
        std::abs(static_cast<double>(frame.range_m[slot] - frame.range_m[slot + 1]));
    if (std::isnan(gap_m)) continue;
    ++gaps.num_pairs;
    gaps.num_in_dead += gap_m < dead_length_m ? 1 : 0;
    gaps.least_m = gaps.num_pairs == 1 ? gap_m : std::min(gaps.least_m, gap_m);
  }
}

// The cells of each strip of a plane that both have.
std::vector<std::vector<IntensityCell>> StripsOf(const PlaneFigures& recorded,
                                                 const PlaneFigures& even,
                                                 const SeenPlanes& seen,
                                                 std::uint32_t turn) {
  constexpr std::uint64_t kLeastPoints = 40;
  constexpr double kLeastIntensity = 0.02;
  std::vector<std::vector<IntensityCell>> strips;
  const PlaneCell* last = nullptr;
  for (const auto& [cell, means] : recorded.intensities) {
    const auto replayed = even.intensities.find(cell);
    if (replayed == even.intensities.end()) continue;
    const Moments& simulated = replayed->second.intensity;
    if (means.intensity.num() < kLeastPoints || simulated.num() < kLeastPoints) continue;
    // Of intensities in whole percent, less says little.
    if (means.intensity.PlainMean() < kLeastIntensity) continue;
    const bool is_same = last != nullptr && last->plane == cell.plane && last->strip == cell.strip;
    if (!is_same) strips.emplace_back();
    strips.back().push_back({.turn = turn,
                             .plane = cell.plane,
                             .is_ground = seen.planes[cell.plane].is_ground(),
                             .range_m = means.range_m.PlainMean(),
                             .incidence_deg = means.incidence_deg.PlainMean(),
                             .recorded = means.intensity.PlainMean(),
                             .simulated = simulated.PlainMean()});
    last = &cell;
  }
  return strips;
}

// Adds a run of cells after one factor for all of them.
void AddRun(std::vector<IntensityCell> run, std::vector<IntensityCell>& cells) {
  constexpr std::size_t kLeastCells = 4;
  if (run.size() < kLeastCells) return;
  double sum = 0.0;
  for (const IntensityCell& cell : run) sum += std::log(cell.recorded / cell.simulated);
  const double factor = std::exp(sum / static_cast<double>(run.size()));
  for (IntensityCell& cell : run) {
    cell.simulated *= factor;
    cells.push_back(cell);
  }
}

// A strip is cut where the recorded intensity jumps, since there another material begins.
void AddIntensityCells(const std::vector<std::vector<IntensityCell>>& strips,
                       std::vector<IntensityCell>& cells) {
  constexpr double kJump = 1.5;
  for (const auto& strip : strips) {
    std::vector<IntensityCell> run;
    for (const IntensityCell& cell : strip) {
      const double ratio = run.empty() ? 1.0 : cell.recorded / run.back().recorded;
      if (ratio > kJump || ratio < 1.0 / kJump) {
        AddRun(std::move(run), cells);
        run.clear();
      }
      run.push_back(cell);
    }
    AddRun(std::move(run), cells);
  }
}

std::vector<RecordedFrame> WholeTurns(Recording& recording) {
  constexpr double kWhole = 0.9;
  std::vector<RecordedFrame> turns;
  std::uint32_t most = 0;
  while (const auto read = recording.Next()) {
    turns.push_back((*read)());
    most = std::max(most, turns.back().frame.columns);
  }
  std::erase_if(turns, [&](const RecordedFrame& turn) {
    return !turn.is_grid || turn.frame.columns < kWhole * most;
  });
  return turns;
}

/// A turn, and the one after it if there is one.
struct RecordedTurn {
  const RecordedFrame& turn;
  const RecordedFrame* next{};
  std::uint32_t index{};
};

void CompareTurn(const RecordedTurn& recorded,
                 const Replay& replay,
                 Sectors sectors,
                 PresetComparison& comparison) {
  const auto& [turn, next, index] = recorded;
  const auto scan = MakeScanTable(turn.frame);
  if (!scan) return;
  const SeenPlanes seen = FindSeenPlanes(turn.frame, *scan, sectors);
  if (seen.planes.empty()) return;
  const RecordedFrame masked = Masked(turn, seen);
  comparison.recorded.Add(masked, seen, index);
  if (comparison.recorded.intensities.empty()) return;
  const ScanTable& replay_scan = replay.scan();
  // Frames of their own, so that no two replays draw the same numbers.
  const auto replayed = [&](const std::map<PlaneCell, double>& reflectivities,
                            std::uint32_t which) {
    return AsRecorded(replay.Scan(seen, reflectivities, 3 * recorded.index + which),
                      replay.least_power_m2(), recorded.index);
  };
  PlaneFigures even;
  const RecordedFrame bright = replayed(EvenReflectivities(comparison.recorded), 0);
  even.Add(bright, PlanesOfReplay(bright.frame, seen, replay_scan), index);
  AddIntensityCells(StripsOf(comparison.recorded, even, seen, index), comparison.intensity);
  const auto local = LocalReflectivities(comparison.recorded, even);
  if (local.empty()) return;
  ++comparison.num_turns;
  comparison.num_planes += seen.planes.size();
  const RecordedFrame first = replayed(local, 1);
  comparison.simulated.Add(first, PlanesOfReplay(first.frame, seen, replay_scan), index);
  comparison.simulated.temporal.Add(first, replayed(local, 2), &replay_scan, &replay_scan);
  if (next == nullptr) return;
  if (const auto next_scan = MakeScanTable(next->frame)) {
    comparison.recorded.temporal.Add(masked, *next, &*scan, &*next_scan);
  }
}

}  // namespace

void PlaneFigures::Add(const RecordedFrame& masked, const SeenPlanes& seen, std::uint32_t turn) {
  const Frame& frame = masked.frame;
  firings.resize(RangeBins().size());
  intensities.clear();
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 0; column < frame.columns; ++column) {
      const std::size_t slot = row * frame.width() + column * frame.returns;
      const std::uint8_t plane = seen.PlaneOf(row, column);
      if (plane == SeenPlanes::kNone) continue;
      const auto [x, y, z] = seen.scan.Direction(row, column);
      const Vector3 direction(x, y, z);
      const double range_m = seen.planes[plane].RangeAlong_m(direction);
      const bool is_missing = !std::isfinite(frame.range_m[slot]);
      if (const auto bin = RangeBins().Find(range_m)) {
        firings[*bin].Add({1, is_missing ? 1U : 0U});
      }
      if (is_missing) continue;
      const auto intensity = static_cast<double>(frame.intensity[slot]);
      // Beyond 1 it is a retroreflector's, on a scale of its own.
      if (!(intensity <= 1.0)) continue;
      const double cosine = std::min(1.0, std::abs(seen.planes[plane].normal.dot(direction)));
      IntensityMeans& means = intensities[CellOf(seen, plane, direction)];
      means.intensity.Add(intensity);
      means.range_m.Add(range_m);
      means.incidence_deg.Add(DegFromRad(std::acos(cosine)));
    }
  }
  // The places where flat pieces are looked for follow from the index; one would give too few.
  constexpr std::uint32_t kLooks = 6;
  RecordedFrame looked = masked;
  for (std::uint32_t look = 0; look < kLooks; ++look) {
    looked.frame.index = kLooks * turn + look;
    noise.Add(looked, FindPlanePatches(looked, &seen.scan));
  }
}

double PresetComparison::PointsError() const {
  std::vector<double> errors;
  for (std::size_t i = 0; i < recorded.firings.size(); ++i) {
    if (recorded.num_points(i) < kLeastInBin) continue;
    const auto points = static_cast<double>(recorded.num_points(i));
    errors.push_back(std::abs(static_cast<double>(simulated.num_points(i)) / points - 1.0));
  }
  return MeanOf(errors);
}

double PresetComparison::IntensityError() const {
  std::vector<double> errors;
  for (const IntensityCell& cell : intensity) {
    errors.push_back(std::abs(cell.simulated / cell.recorded - 1.0));
  }
  return MeanOf(errors);
}

double PresetComparison::PlaneSigmaRatio() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < recorded.noise.planes().size(); ++i) {
    const double ratio = simulated.noise.planes()[i].RobustRangeSigma_m().value /
                         recorded.noise.planes()[i].RobustRangeSigma_m().value;
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return MedianOfRatios(ratios);
}

double PresetComparison::TemporalSigmaRatio() const {
  std::vector<double> ratios;
  const auto& theirs = recorded.temporal.bins();
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    if (theirs[i].differences_m.num() < kLeastInBin) continue;
    const double ratio =
        simulated.temporal.bins()[i].RobustSigma_m().value / theirs[i].RobustSigma_m().value;
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return MedianOfRatios(ratios);
}

double PresetComparison::HoleRatio() const {
  const auto share = [](const PlaneFigures& figures) {
    Holes::Count all;
    for (const Holes::Count& count : figures.firings) all.Add(count);
    return static_cast<double>(all.num_missing) / static_cast<double>(all.num_expected);
  };
  return share(simulated) / share(recorded);
}

PresetComparison ComparePreset(Recording& recording,
                               const ScenarioSpec& scenario,
                               Sectors sectors) {
  const std::vector<RecordedFrame> turns = WholeTurns(recording);
  const Replay replay(scenario);
  const std::string source = ShownPath(recording.info().source);
  PresetComparison comparison;
  comparison.gaps.least_m = kNoFigure;
  const double dead_length_m = DeadLength_m(scenario.lidar.receiver);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Frame& frame = turns[i].frame;
    if (frame.rows != replay.scan().rows) {
      throw InputError(source + ": must have the " + NumberText(replay.scan().rows) +
                       " rings of the scenario's sensor (got " + NumberText(frame.rows) + ")");
    }
    AddGaps(frame, dead_length_m, comparison.gaps);
    const RecordedFrame* const next = i + 1 < turns.size() ? &turns[i + 1] : nullptr;
    CompareTurn({turns[i], next, static_cast<std::uint32_t>(i)}, replay, sectors, comparison);
  }
  if (comparison.num_turns == 0) {
    throw InputError(source + ": must hold a turn with planes and intensities up to 1");
  }
  return comparison;
}

}  // namespace railcast
