#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

// What the turns of a recording show of the noise of its sensor and of the texture of the surfaces
// before it. Intensities count by their logarithm, from 0.05, below which steps of a percent
// decide, to 1, beyond which retroreflectors begin, and on *smooth* surfaces: of firings that lie
// with the four on either side in their ring on a line over their columns (standard deviation of
// the ranges up to 3 cm).

/// The turns of a recording that are whole: those of at least 0.9 of the most columns. Their axes
/// are those about whose z the sensor spins.
/// @param most_frames Frames that are read at most.
/// @throws InputError as NeedRanges().
[[nodiscard]] std::vector<RecordedFrame> WholeTurns(
    Recording& recording, std::size_t most_frames = std::numeric_limits<std::size_t>::max());

/// Parts of a turn for the jackknife, by azimuth: turns and rings see the same surfaces again.
inline constexpr std::size_t kNumSectors = 36;
[[nodiscard]] std::size_t SectorOf(const ScanTable& scan, std::size_t row, std::size_t column);

/// A figure of what falls into parts.
struct JackknifedFigure {
  /// Parts with samples below which there is no figure.
  static constexpr std::uint64_t kLeastParts = 10;

  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  ///< Standard error.
  std::uint64_t num_parts{};                                ///< With samples.
  std::uint64_t num{};                                      ///< Samples.
};

/// The figure with the jackknife's standard error (Efron and Tibshirani 1993, An Introduction to
/// the Bootstrap, 11).
/// @param without Value without the part of this number; of all if there is no such part.
/// @param sizes Of the parts. Empty ones are not left out.
[[nodiscard]] JackknifedFigure Jackknife(const std::function<double(std::size_t)>& without,
                                         const std::vector<std::uint64_t>& sizes);

/// The turns of a recording that are grids of as many rows.
struct GridTurns {
  std::vector<const RecordedFrame*> frames;
  std::vector<ScanTable> scans;
};
/// @param turns Must outlive the result.
[[nodiscard]] GridTurns GridsOf(const std::vector<RecordedFrame>& turns);

/// The first returns of a turn, by row x columns + column.
struct SmoothTurn {
  const ScanTable& scan;
  std::vector<Vector3> position_m{};
  std::vector<double> range_m{};        ///< NaN where there is no return of a surface.
  std::vector<double> log_intensity{};  ///< NaN also where the surface is not smooth.

  [[nodiscard]] std::size_t At(std::size_t row, std::size_t column) const {
    return row * scan.columns + column;
  }
};
/// @param turns Must outlive the result.
[[nodiscard]] std::vector<SmoothTurn> SmoothTurnsOf(const GridTurns& turns);

/// Distances along a ring at which the texture is measured, to a fifth.
inline constexpr std::array<double, 3> kTextureLags_m = {0.02, 0.1, 0.4};

/// The relative standard deviation of what is log-normal, as keys of scenarios have it, for that of
/// its logarithm.
[[nodiscard]] inline double RelativeDeviation(double of_logarithm) {
  return std::sqrt(std::expm1(of_logarithm * of_logarithm));
}

struct TurnNoise {
  /// A standard deviation from the smaller nine tenths of the magnitudes, as if they were normal,
  /// and from all, to which markings and edges add. Where readings come in steps no smaller than
  /// it, the robust one of noise is that before rounding (core/base/rounded_scale.h).
  struct Deviations {
    JackknifedFigure robust, rms;
  };

  /// Whether ranges say that the sensor moved: turns then do not tell noise, and the texture has it
  /// included.
  bool has_moved{};
  /// How a return deviates from what the turn before shows there, between two columns; log
  /// intensity only for means of 0.12 to 0.25. Texture finer than the columns adds to it.
  Deviations intensity, range_m;
  /// Semideviation of log intensity at kTextureLags_m, less that from turn to turn.
  std::array<Deviations, kTextureLags_m.size()> texture;
  std::array<double, kTextureLags_m.size()> texture_range_m{};  ///< Mean range of its samples.
};

/// @param turns In their order.
[[nodiscard]] TurnNoise FindTurnNoise(const std::vector<SmoothTurn>& turns);

}  // namespace railcast
