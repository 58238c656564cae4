#pragma once

#include <cstddef>

#include "core/detect/detect_spec.h"
#include "core/frame/frame.h"
#include "core/io/recording/scan_table.h"

namespace railcast {

/// What pulse stretch leaves of the power of a firing, from the truth of a frame: s / hypot(s,
/// spread), spread the standard deviation of the range over the beam (core/detect/incidence.h).
///
/// The truth says how steep the surface is; which way it slants, horizontally or upright, is that
/// of the true ranges of the firings beside and above, if they meet the same surface and agree with
/// the steepness to a fifth: on a plane 1 / R is linear in the beam's direction. Where they do not,
/// the middle of what is possible if that is within 2 % of the power; else NaN.
class TruthStretch {
 public:
  /// @param scan Of the frames; null if they are no grid. Must outlive this.
  TruthStretch(const BeamSpec& beam, const ScanTable* scan);

  /// @pre The slot's firing has a true range and an incidence.
  [[nodiscard]] double At(const Frame& frame, std::size_t slot) const;

 private:
  double sigma_h_rad_;
  double sigma_v_rad_;
  double pulse_sigma_m_;
  const ScanTable* scan_;
};

}  // namespace railcast
