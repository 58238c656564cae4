#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/preset/intensity_cells.h"
#include "analysis/preset/replay.h"
#include "analysis/preset/seen_planes.h"
#include "analysis/report/report.h"
#include "analysis/stats/holes.h"
#include "analysis/stats/noise.h"
#include "analysis/stats/temporal_noise.h"
#include "railcast/io/recording.h"

namespace railcast {

/// What was measured on planes: of the recording, or of its replay.
struct PlaneFigures {
  /// By bin of RangeBins(), of the range of the plane: firings that must have met it, and those of
  /// them without a point.
  std::vector<Holes::Count> firings;

  [[nodiscard]] std::uint64_t num_points(std::size_t bin) const {
    return firings[bin].num_expected - firings[bin].num_missing;
  }
  /// Of all bins together.
  [[nodiscard]] double HoleShare() const;
  Noise noise;
  TemporalNoise temporal;
  std::map<PlaneCell, CellPoints> intensities;

  /// Adds a turn; points of other firings than the planes' are left out. Intensities are those of
  /// this turn alone.
  void Add(const RecordedFrame& masked, const SeenPlanes& seen, std::uint32_t turn);
};

/// Ranges between the two returns of a firing.
struct EchoGaps {
  std::uint64_t num_pairs{};
  double least_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN without pairs.
  std::uint64_t num_in_dead{};  ///< Nearer to each other than the preset's dead time allows.
};

/// A real sensor's turns compared with their replay by a preset.
struct PresetComparison {
  std::size_t num_turns{};
  std::size_t num_planes{};
  PlaneFigures recorded, simulated;
  std::vector<IntensityCell> intensity;  ///< Of all turns, with one reflectivity everywhere.
  EchoGaps gaps;

  // The figures of docs/validation.md; each bin counts alike. Those without any bin are NaN.
  /// Mean absolute relative error of the number of points, over the bins of range with at least 500
  /// recorded ones.
  [[nodiscard]] double PointsError() const;
  /// Mean absolute relative error of the intensity over the cells of pieces of one material, after
  /// one factor for each piece (see LikePieces()).
  [[nodiscard]] double IntensityError(double like = kLikeFactor) const;
  /// The same of the means of each piece at each range or incidence (see MeansOfSteps()), as Haider
  /// and others 2022 compare mean intensities on targets.
  [[nodiscard]] double MeanIntensityError(double like = kLikeFactor) const;
  /// Median over the bins of the simulated over the recorded robust sigma: about flat pieces, and
  /// from turn to turn (bins of at least 500 recorded differences).
  [[nodiscard]] double PlaneSigmaRatio() const;
  [[nodiscard]] double TemporalSigmaRatio() const;
  /// Holes simulated over holes recorded, in all bins together.
  [[nodiscard]] double HoleRatio() const;
};

/// The turns of a recording that are whole: those of at least 0.9 of the most columns.
/// @param most_frames Frames that are read at most.
[[nodiscard]] std::vector<RecordedFrame> WholeTurns(
    Recording& recording, std::size_t most_frames = std::numeric_limits<std::size_t>::max());

/// What the turns of a recording show on their planes, to be compared with several scenarios.
struct SeenTurns {
  struct Turn {
    std::uint32_t index{};
    std::uint32_t num_rings{};
    SeenPlanes seen;
    std::map<PlaneCell, CellPoints> intensities;
  };
  std::vector<Turn> turns;  ///< Those with planes and intensities up to 1.
  PlaneFigures recorded;
};

[[nodiscard]] SeenTurns SeePlanesOf(const std::vector<RecordedFrame>& turns,
                                    Sectors sectors = Sectors::kAll);

/// Compares turns with what the scenario's sensor would have measured on their planes. Pairs of
/// returns are left out.
/// @param source Names the recording in messages.
/// @throws InputError if the sensor has another number of rings than the turns, or none of them
///   shows a plane.
[[nodiscard]] PresetComparison CompareTurns(const SeenTurns& turns,
                                            const ScenarioSpec& scenario,
                                            const std::string& source);

/// Compares the whole turns of a recording.
/// @throws InputError as CompareTurns().
[[nodiscard]] PresetComparison ComparePreset(Recording& recording,
                                             const ScenarioSpec& scenario,
                                             Sectors sectors = Sectors::kAll);

/// Defined in preset_report.cpp.
/// @param command Command line, for a reader to repeat.
[[nodiscard]] Report MakePresetReport(const PresetComparison& comparison,
                                      const RecordingInfo& recording,
                                      const ScenarioSpec& scenario,
                                      const std::string& command);

}  // namespace railcast
