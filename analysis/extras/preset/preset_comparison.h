#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "analysis/stats/holes.h"
#include "analysis/stats/neighbour_noise.h"
#include "analysis/stats/range_noise.h"
#include "core/io/recording/scan_table.h"
#include "core/io/recording/turn_noise.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// A large plane in a recorded turn, in the sensor's axes.
struct SeenPlane {
  Vector3 middle_m = Vector3::Zero();  ///< Mean of its points; lies in the plane.
  Vector3 normal = Vector3::UnitZ();   ///< Unit vector of either sign.
  std::size_t num_points{};

  /// Range at which a ray from the sensor, or from a place in it, meets the plane; infinite or
  /// negative if it does not.
  [[nodiscard]] double RangeAlong_m(const Vector3& direction,
                                    const Vector3& origin_m = Vector3::Zero()) const {
    return normal.dot(middle_m - origin_m) / normal.dot(direction);
  }
  /// Whether it is level within 20 deg and below the sensor.
  [[nodiscard]] bool is_ground() const;
};

/// The planes of a recorded turn, and which of its firings must have met which of them.
struct SeenPlanes {
  /// SeenPlanes::plane of a firing that met no plane, or something else.
  static constexpr std::uint8_t kNone = 0xFF;

  ScanTable scan;
  std::vector<SeenPlane> planes;
  std::vector<std::uint8_t> plane;  ///< By row x scan.columns + column: index into `planes`.

  [[nodiscard]] std::uint8_t PlaneOf(std::size_t row, std::size_t column) const {
    return plane[row * scan.columns + column];
  }
};

/// A piece of a plane in which one kind of surface is met in one way: on level ground 5 deg of
/// azimuth and a bin of FineRangeBins(), on others 6 deg of elevation, a side of the foot of the
/// perpendicular, and 5 deg of incidence.
struct PlaneCell {
  std::size_t plane{};
  std::size_t strip{};
  std::size_t step{};  ///< Rises along the strip.

  auto operator<=>(const PlaneCell&) const = default;
};

/// The cell in which a ray from the sensor meets a plane.
/// @param direction Unit vector.
[[nodiscard]] PlaneCell CellOf(const SeenPlanes& seen, std::size_t plane, const Vector3& direction);

/// The firings of a turn that take part: all, or every second sector of 30 deg, so that what was
/// fitted to one half can be asked of the other.
enum class Sectors { kAll, kEven, kOdd };

/// Finds the planes of a turn, at most 24, each of at least 0.4 % of its points: the best of many
/// planes along the surface about a point (Fischler and Bolles 1981, with LocalNormal()), then
/// least squares. Only points about which the surface lies as the plane does, to 26 deg, count.
///
/// A point belongs to a plane if it lies within 4 cm + 1.5 mm a metre of it, within 10 % of the
/// range at which its ray meets the plane, and in a run of at least 8 such points of its ring,
/// about half of which or more the surface lies as the plane does. Firings without a point belong
/// to the plane of the points on either side if these are at most 5 firings away.
[[nodiscard]] SeenPlanes FindSeenPlanes(const Frame& frame,
                                        const ScanTable& scan,
                                        Sectors sectors = Sectors::kAll);

/// The points of a cell.
struct CellPoints {
  std::vector<float> intensities;
  Moments range_m;
  Moments incidence_deg;

  /// Mean of the middle three fifths of the intensities: neither markings nor the steps of whole
  /// percent decide it. NaN without points.
  [[nodiscard]] double MiddleIntensity() const;
};

/// A cell of a plane as it was recorded and as it was simulated with one reflectivity everywhere.
struct IntensityCell {
  std::uint32_t turn{};
  PlaneCell place;
  bool is_ground{};
  double range_m{};
  double incidence_deg{};
  double recorded{};
  double simulated{};
  std::size_t piece{};  ///< See LikePieces().
};

/// The cells of a turn that have at least 15 points on both sides and a recorded intensity of at
/// least 0.02, below which a step of whole percent is half of it or more.
[[nodiscard]] std::vector<IntensityCell> ComparableCells(
    const std::map<PlaneCell, CellPoints>& recorded,
    const std::map<PlaneCell, CellPoints>& simulated,
    const SeenPlanes& seen,
    std::uint32_t turn);

/// Changes from one cell to the next beyond this factor are another material's. No law between a
/// level one and Lambert's changes by more than 1.19 over a quarter of an octave.
inline constexpr double kLikeFactor = 1.3;

/// Puts cells together into pieces of one material: neighbours, along a strip (the next step, or
/// the one after it if that is empty) or across, whose recorded intensities differ by less than
/// `like`, belong to one piece. Returns the cells of the pieces that have at least three steps of
/// range (or incidence), with simulated intensities that are multiplied by one factor for each
/// piece.
[[nodiscard]] std::vector<IntensityCell> LikePieces(const std::vector<IntensityCell>& cells,
                                                    double like = kLikeFactor);

/// Puts the cells of each piece together that are at the same range (or incidence): one cell for
/// each step of the piece, with the mean recorded and the mean simulated intensity. Spots and lanes
/// of a material even out, incidence does not.
/// @param pieces From LikePieces().
[[nodiscard]] std::vector<IntensityCell> MeansOfSteps(const std::vector<IntensityCell>& pieces);

/// What is left of the ground's intensity as a power of range: the exponent of R in recorded over
/// simulated, the median over neighbouring cells of a strip. No cut decides it, and other materials
/// do not as long as more than half of the neighbours are of one. The interval is that of a
/// median of independent pairs; turns repeat each other and count as one.
[[nodiscard]] Estimate RangeExponentLeft(const std::vector<IntensityCell>& cells);

/// Simulates a scenario's sensor before the planes that a real sensor has seen: the beams of its
/// own pattern, with the effects of its own rung and weather, meet a plane where the recorded
/// firings of that direction did, and nothing elsewhere. Planes below the sensor that are level are
/// made of `asphalt`, all others of `concrete`, with the reflectivities given for their cells.
class Replay {
 public:
  /// @param scenario One sensor whose channels have the recording's elevations; materials `asphalt`
  ///   and `concrete`.
  /// @throws InputError if it lacks these materials.
  explicit Replay(const ScenarioSpec& scenario);

  /// @param reflectivities Of cells; those not named have that of the nearest cell before them.
  /// @pre There is at least one.
  /// @returns The frames with these indices; `instance` is the index of the plane + 1.
  [[nodiscard]] std::vector<Frame> Scan(const SeenPlanes& seen,
                                        const std::map<PlaneCell, double>& reflectivities,
                                        const std::vector<std::uint32_t>& frame_indices) const;

  /// The directions of the firings.
  [[nodiscard]] const ScanTable& scan() const { return scan_; }

 private:
  const ScenarioSpec scenario_;
  const ScanPattern pattern_;
  ScanTable scan_;
};

/// What was measured on planes: of the recording, or of its replay.
struct PlaneFigures {
  /// By bin of RangeBins(), of the range of the plane: firings that must have met it, and those of
  /// them without a point.
  std::vector<Holes::Count> firings;

  [[nodiscard]] std::uint64_t num_points(std::size_t bin) const {
    return firings[bin].num_expected - firings[bin].num_missing;
  }
  /// The share of holes over all bins together.
  [[nodiscard]] double HoleShare() const;
  Noise noise;
  NeighbourNoise neighbours;
  TemporalNoise temporal;
  std::map<PlaneCell, CellPoints> intensities;

  /// Adds the firings and intensities of a turn; points of other firings than the planes' are left
  /// out. Intensities are those of this turn alone.
  void Add(const RecordedFrame& masked, const SeenPlanes& seen);
  /// Adds the noise about flat pieces of a turn's points, and that along its rings.
  void AddNoise(const RecordedFrame& masked, const SeenPlanes& seen, std::uint32_t turn);
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
  std::vector<IntensityCell> intensity;  ///< From all turns, with one reflectivity everywhere.
  EchoGaps gaps;

  // The figures of docs/results/validation.md; each bin counts alike. NaN without bins.
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

/// What the turns of a recording show on their planes, to be compared with several scenarios.
struct SeenTurns {
  struct Turn {
    std::uint32_t index{};
    std::uint32_t num_rings{};
    SeenPlanes seen;
    std::map<PlaneCell, CellPoints> intensities;
  };
  std::vector<Turn> turns;  ///< The turns with planes and intensities up to 1.
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
