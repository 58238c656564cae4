#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/estimate/streams.h"
#include "analysis/preset/seen_planes.h"

namespace railcast {

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

}  // namespace railcast
