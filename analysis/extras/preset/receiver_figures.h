#pragma once

#include <array>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/report/report.h"
#include "core/io/recording/turn_noise.h"
#include "railcast/io/recording.h"

namespace railcast {

// What a recording alone shows of its sensor's receiver and of the surfaces before it: what its
// turns say of noise and texture (core/io/recording/turn_noise.h), gains, and losses. Intervals are
// those of the jackknife over sectors of azimuth, by Student. Figures from fewer than kMinSamples
// sectors are "not enough".

/// As TurnNoise::Deviations.
struct TwoDeviations {
  Estimate robust, rms;
};

/// Losses at depth jumps in rings.
struct JumpLosses {
  /// Among the jumps of 3 to 10 m with at most one firing without a return between both sides,
  /// those with one.
  Estimate share;
  /// Firings without a return at a jump of 1 m or more with the near side beyond 1 m, up to four,
  ///   base + b (1 / near - 1 / far) / step of azimuth,
  /// by least squares, with b = `common`, and `aside` more where the ring meets the near side last,
  /// in the order of columns. A receiver at |aside| beside its emitter does not see so much of the
  /// far side past one end of each near one; what both ends have in common comes from the scene.
  Estimate base, common_m, aside_m;
};

struct ReceiverFigures {
  bool has_moved{};  ///< As TurnNoise has it; likewise below.
  TwoDeviations intensity_noise, range_noise_m;
  /// Standard deviation over channels: root of the covariance between even and odd sectors of
  /// 30 deg of the medians of log intensity less the neighbouring channels' on the same surface,
  /// less what these' own gains add. Jackknife over channels.
  Estimate channel_gain;
  /// The same in parts: what a channel has at all ranges, and what it has by range
  /// (kGainLogRange). By least squares in c^2 + h^2 exp(-x^2 / 2), from the products of a channel's
  /// medians in two sectors of 10 deg with one or more between, x apart in ln(range), on surfaces
  /// that the channel and its neighbours see at one range.
  Estimate gain_at_all_ranges, gain_by_range;
  std::array<TwoDeviations, kTextureLags_m.size()> texture;
  JumpLosses jumps;
  Estimate holes;  ///< Holes::Share().
};

/// With its interval.
[[nodiscard]] Estimate EstimateOf(const JackknifedFigure& figure);

/// The three figures of gains.
void FindChannelGains(const std::vector<SmoothTurn>& turns, ReceiverFigures& figures);

[[nodiscard]] JumpLosses FindJumpLosses(const GridTurns& turns);

/// @param turns Whole turns in their order; those that are no grids are skipped.
[[nodiscard]] ReceiverFigures FindReceiverFigures(const std::vector<RecordedFrame>& turns);

[[nodiscard]] Section MakeReceiverSection(const ReceiverFigures& figures);

}  // namespace railcast
