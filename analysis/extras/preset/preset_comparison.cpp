#include "analysis/extras/preset/preset_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/stats/bins.h"
#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/io/recording/plausibility.h"

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

RecordedFrame AsRecorded(Frame frame, std::uint32_t index) {
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

// Mean absolute relative error of the intensities.
double ErrorOf(const std::vector<IntensityCell>& cells) {
  std::vector<double> errors;
  for (const IntensityCell& cell : cells) {
    errors.push_back(std::abs(cell.simulated / cell.recorded - 1.0));
  }
  return MeanOf(errors);
}

// A replay of planes that are equally bright everywhere, for the intensities.
constexpr double kEvenReflectivity = 0.5;

std::map<PlaneCell, double> EvenReflectivities(const std::map<PlaneCell, CellPoints>& recorded) {
  std::map<PlaneCell, double> reflectivities;
  for (const auto& [cell, points] : recorded) reflectivities[cell] = kEvenReflectivity;
  return reflectivities;
}

// Reflectivities with which each cell answers as strongly as it did.
std::map<PlaneCell, double> LocalReflectivities(const std::map<PlaneCell, CellPoints>& recorded,
                                                const PlaneFigures& even) {
  constexpr double kLeast = 0.002;
  constexpr double kMost = 1.0;
  std::map<PlaneCell, double> reflectivities;
  for (const auto& [cell, points] : recorded) {
    const auto replayed = even.intensities.find(cell);
    if (replayed == even.intensities.end()) continue;
    const double fitted =
        kEvenReflectivity * points.MiddleIntensity() / replayed->second.MiddleIntensity();
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

void CompareTurn(const SeenTurns::Turn& turn, const Replay& replay, PresetComparison& comparison) {
  const ScanTable& replay_scan = replay.scan();
  // Frames of their own, so that no two replays draw the same numbers.
  const std::uint32_t index = 3 * turn.index;
  const auto planes_of = [&](const RecordedFrame& frame) {
    return PlanesOfReplay(frame.frame, turn.seen, replay_scan);
  };
  PlaneFigures even;
  const RecordedFrame bright = AsRecorded(
      replay.Scan(turn.seen, EvenReflectivities(turn.intensities), {index}).front(), turn.index);
  even.Add(bright, planes_of(bright));
  const auto cells = ComparableCells(turn.intensities, even.intensities, turn.seen, turn.index);
  comparison.intensity.insert(comparison.intensity.end(), cells.begin(), cells.end());
  const auto local = LocalReflectivities(turn.intensities, even);
  if (local.empty()) return;
  ++comparison.num_turns;
  comparison.num_planes += turn.seen.planes.size();
  std::vector<Frame> replayed = replay.Scan(turn.seen, local, {index + 1, index + 2});
  const RecordedFrame first = AsRecorded(std::move(replayed[0]), turn.index);
  const RecordedFrame second = AsRecorded(std::move(replayed[1]), turn.index);
  const SeenPlanes first_planes = planes_of(first);
  comparison.simulated.Add(first, first_planes);
  comparison.simulated.AddNoise(first, first_planes, turn.index);
  comparison.simulated.temporal.Add(first, second, &replay_scan, &replay_scan);
}

}  // namespace

void PlaneFigures::Add(const RecordedFrame& masked, const SeenPlanes& seen) {
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
      CellPoints& points = intensities[CellOf(seen, plane, direction)];
      points.intensities.push_back(static_cast<float>(intensity));
      points.range_m.Add(range_m);
      points.incidence_deg.Add(DegFromRad(std::acos(cosine)));
    }
  }
}

void PlaneFigures::AddNoise(const RecordedFrame& masked,
                            const SeenPlanes& seen,
                            std::uint32_t turn) {
  // The places where flat pieces are looked for follow from the index; one would give too few.
  constexpr std::uint32_t kLooks = 6;
  neighbours.Add(masked);
  RecordedFrame looked = masked;
  for (std::uint32_t look = 0; look < kLooks; ++look) {
    looked.frame.index = kLooks * turn + look;
    std::vector<PlanePatch> patches;
    for (const FlatPiece& piece : FindFlatPieces(looked, &seen.scan)) {
      patches.push_back(piece.patch);
    }
    noise.Add(looked, patches);
  }
}

double PlaneFigures::HoleShare() const {
  Holes::Count all;
  for (const Holes::Count& count : firings) all.Add(count);
  return static_cast<double>(all.num_missing) / static_cast<double>(all.num_expected);
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

double PresetComparison::IntensityError(double like) const {
  return ErrorOf(LikePieces(intensity, like));
}

double PresetComparison::MeanIntensityError(double like) const {
  return ErrorOf(MeansOfSteps(LikePieces(intensity, like)));
}

double PresetComparison::PlaneSigmaRatio() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < recorded.noise.planes().size(); ++i) {
    const double ratio = simulated.noise.planes()[i].RobustRangeSigma_m().value /
                         recorded.noise.planes()[i].RobustRangeSigma_m().value;
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return MedianOf(ratios);
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
  return MedianOf(ratios);
}

double PresetComparison::HoleRatio() const {
  return simulated.HoleShare() / recorded.HoleShare();
}

SeenTurns SeePlanesOf(const std::vector<RecordedFrame>& turns, Sectors sectors) {
  SeenTurns result;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const auto scan = MakeScanTable(turns[i].frame);
    if (!scan) continue;
    SeenPlanes seen = FindSeenPlanes(turns[i].frame, *scan, sectors);
    if (seen.planes.empty()) continue;
    const RecordedFrame masked = Masked(turns[i], seen);
    result.recorded.Add(masked, seen);
    result.recorded.AddNoise(masked, seen, index);
    if (result.recorded.intensities.empty()) continue;
    result.turns.push_back(
        {index, turns[i].frame.rows, std::move(seen), result.recorded.intensities});
    if (i + 1 == turns.size()) continue;
    if (const auto next_scan = MakeScanTable(turns[i + 1].frame)) {
      result.recorded.temporal.Add(masked, turns[i + 1], &*scan, &*next_scan);
    }
  }
  return result;
}

PresetComparison CompareTurns(const SeenTurns& turns,
                              const ScenarioSpec& scenario,
                              const std::string& source) {
  const Replay replay(scenario);
  PresetComparison comparison;
  comparison.recorded = turns.recorded;
  for (const SeenTurns::Turn& turn : turns.turns) {
    if (turn.num_rings != replay.scan().rows) {
      throw InputError(source + ": must have the " + NumberText(replay.scan().rows) +
                       " rings of the scenario's sensor (got " + NumberText(turn.num_rings) + ")");
    }
    CompareTurn(turn, replay, comparison);
  }
  if (comparison.num_turns == 0) {
    throw InputError(source +
                     (turns.recorded.firings.empty()
                          ? ": must hold a whole turn in which planes are seen (got none)"
                          : ": must have intensities from 0 to 1 on its planes (got none)"));
  }
  return comparison;
}

PresetComparison ComparePreset(Recording& recording,
                               const ScenarioSpec& scenario,
                               Sectors sectors) {
  const std::vector<RecordedFrame> turns = WholeTurns(recording);
  for (const RecordedFrame& turn : turns) {
    const auto far = CheckRanges(turn, recording.info(), scenario.lidar.range_max_m);
    if (far) recording.info().remarks->Add(*far, turn.frame.index + 1U);
  }
  PresetComparison comparison =
      CompareTurns(SeePlanesOf(turns, sectors), scenario, ShownPath(recording.info().source));
  const double dead_length_m = DeadLength_m(scenario.lidar.receiver);
  for (const RecordedFrame& turn : turns) AddGaps(turn.frame, dead_length_m, comparison.gaps);
  return comparison;
}

}  // namespace railcast
