#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/report/report.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

// What a recording alone shows of its sensor's receiver and of the surfaces before it. Intensities
// count by their logarithm, from 0.05, below which steps of a percent decide, to 1, beyond which
// retroreflectors begin, and on *smooth* surfaces: of firings that lie with the four on either side
// in their ring on a line over their columns (standard deviation of the ranges up to 3 cm).
//
// Intervals are those of the jackknife over sectors of azimuth, since turns and rings see the same
// surfaces again. Figures from fewer than kMinSamples sectors are "not enough".

/// Distances along a ring at which the texture is measured, to a fifth.
inline constexpr std::array<double, 3> kTextureLags_m = {0.02, 0.1, 0.4};

/// A standard deviation from the smaller nine tenths of the magnitudes, as if they were normal, and
/// from all, to which markings and edges add.
struct TwoDeviations {
  Estimate robust, rms;
};

/// Losses at depth jumps in rings.
struct JumpLosses {
  /// Of the jumps of 3 to 10 m with at most one firing without a return between both sides: those
  /// with one.
  Estimate share;
  /// Firings without a return at a jump of 1 m or more with the near side beyond 1 m, up to four,
  ///   base + b (1 / near - 1 / far) / step of azimuth,
  /// by least squares, with b = `common`, and `aside` more where the ring meets the near side last,
  /// in the order of columns. A receiver at |aside| beside its emitter does not see so much of the
  /// far side past one end of each near one; what both ends have in common comes from the scene.
  Estimate base, common_m, aside_m;
};

struct ReceiverFigures {
  /// Whether ranges say that the sensor moved: turns then do not tell noise, and the texture has it
  /// included.
  bool has_moved{};
  /// Of a return, from a firing and what the turn before shows there, between two columns; that of
  /// log intensity for means of 0.12 to 0.25. Texture finer than the columns adds to it.
  TwoDeviations intensity_noise, range_noise_m;
  /// Standard deviation over channels: root of the covariance between even and odd sectors of
  /// 30 deg of the medians of log intensity less the neighbouring channels' on the same surface,
  /// less what these' own gains add. Jackknife over channels.
  Estimate channel_gain;
  /// Semideviation of log intensity at kTextureLags_m, less that from turn to turn.
  std::array<TwoDeviations, kTextureLags_m.size()> texture;
  JumpLosses jumps;
  Estimate holes;  ///< Holes::Share().
};

/// Parts of a turn for the jackknife, by azimuth.
inline constexpr std::size_t kNumSectors = 36;
[[nodiscard]] std::size_t SectorOf(const ScanTable& scan, std::size_t row, std::size_t column);

/// A figure of what falls into parts, with the jackknife's interval (Efron and Tibshirani 1993, An
/// Introduction to the Bootstrap, 11), by Student.
/// @param without Value without the part of this number; of all if there is no such part.
/// @param sizes Of the parts. Empty ones are not left out.
[[nodiscard]] Estimate Jackknife(const std::function<double(std::size_t)>& without,
                                 const std::vector<std::uint64_t>& sizes);

/// @param scans Of the turns, which are grids.
[[nodiscard]] JumpLosses FindJumpLosses(const std::vector<const RecordedFrame*>& turns,
                                        const std::vector<ScanTable>& scans);

/// @param turns Whole turns in their order; those that are no grids are skipped.
[[nodiscard]] ReceiverFigures FindReceiverFigures(const std::vector<RecordedFrame>& turns);

[[nodiscard]] Section MakeReceiverSection(const ReceiverFigures& figures);

}  // namespace railcast
