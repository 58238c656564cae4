#include "analysis/extras/preset/receiver_figures.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/streams.h"
#include "analysis/stats/holes.h"

namespace railcast {
namespace {

TwoDeviations TwoOf(const TurnNoise::Deviations& of) {
  return {EstimateOf(of.robust), EstimateOf(of.rms)};
}

}  // namespace

Estimate EstimateOf(const JackknifedFigure& figure) {
  if (std::isnan(figure.value)) return NotEnough(figure.num);
  const double half = StudentQuantile(static_cast<double>(figure.num_parts) - 1.0) * figure.error;
  return {figure.value, figure.value - half, figure.value + half, figure.num};
}

ReceiverFigures FindReceiverFigures(const std::vector<RecordedFrame>& turns) {
  Holes holes;
  for (const RecordedFrame& turn : turns) holes.Add(turn);
  ReceiverFigures figures;
  figures.holes = holes.Share();
  const GridTurns grids = GridsOf(turns);
  if (grids.frames.empty()) return figures;
  const std::vector<SmoothTurn> seen = SmoothTurnsOf(grids);
  const TurnNoise noise = FindTurnNoise(seen);
  figures.has_moved = noise.has_moved;
  figures.intensity_noise = TwoOf(noise.intensity);
  figures.range_noise_m = TwoOf(noise.range_m);
  for (std::size_t lag = 0; lag < noise.texture.size(); ++lag) {
    figures.texture.at(lag) = TwoOf(noise.texture.at(lag));
  }
  FindChannelGains(seen, figures);
  figures.jumps = FindJumpLosses(grids);
  return figures;
}

}  // namespace railcast
