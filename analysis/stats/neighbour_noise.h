#pragma once

#include <cstddef>
#include <optional>
#include <tuple>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/sums.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The second difference of the ranges of three neighbouring firings of a row, divided by sqrt(6),
/// in m: with independent errors of one standard deviation, that is its own. Nothing where one of
/// the three has no point on a surface, or where the surface ends: the range changes by 0.3 m or
/// more from column to column, or bends by as much.
/// @pre The slots of the frame are firings.
[[nodiscard]] std::optional<double> SecondDifference_m(const RecordedFrame& recorded,
                                                       std::size_t row,
                                                       std::size_t column);

/// Range noise from single turns, without a plane and whether the sensor moves or stands: the
/// robust standard deviation of SecondDifference_m().
///
/// Slopes and constant errors of a channel are not in it, but what bends between three firings is:
/// on rough ground it bounds the noise from above, and several times more tightly than the scatter
/// about planes does. A sensor that averages or interpolates neighbouring readings has less than
/// its noise there (by half with pairs averaged: 0.58); then the changes from turn to turn of a
/// standing sensor (TemporalNoise) are greater. Steps of the ranges are not taken out.
///
///     NeighbourNoise noise;
///     noise.Add(recorded);
///     const Estimate sigma_m = noise.Sigma_m(RangeBins().Find(5.0).value());
class NeighbourNoise {
 public:
  /// Adds a frame; one whose slots are not firings adds nothing.
  void Add(const RecordedFrame& recorded);
  static auto Sums(auto& of) { return std::tie(of.bins_); }

  /// Second differences by bin of RangeBins(); empty without any.
  [[nodiscard]] const std::vector<Scatter>& bins() const { return bins_; }
  /// The standard deviation in one of them. Neighbouring differences share two of their ranges, so
  /// that the interval is that of half as many.
  [[nodiscard]] Estimate Sigma_m(std::size_t bin) const;
  [[nodiscard]] Table MakeTable() const;

 private:
  std::vector<Scatter> bins_;
};

}  // namespace railcast
