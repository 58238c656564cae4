#pragma once

#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// A point of a curve: y at x, with the relative standard error of y (1 / sqrt(count)
/// for a count).
struct CurvePoint {
  double x{};
  double y{};
  double relative_error{};
};

/// y = factor x^exponent.
struct PowerLaw {
  Estimate exponent;  ///< Its num is the number of points that took part.
  double factor{};

  /// y at x on the fitted line; not enough where the exponent is not.
  [[nodiscard]] Estimate At(double x) const;

  // The quantities from which At() computes its interval.
  double middle{};  ///< Weighted mean of log x.
  double
      /// Half the interval of log y there, which is independent of that of the exponent.
      middle_error{};
};

/// Fits a straight line through (log x, log y), weighted by 1 / relative_error^2.
/// The interval is Student's, from the points' scatter about the line or from
/// their own errors, whichever is wider. Points whose x or y is not > 0 are ignored; fewer than
/// kMinCurvePoints are not enough.
[[nodiscard]] PowerLaw FitPowerLaw(const std::vector<CurvePoint>& points);

inline constexpr std::size_t kMinCurvePoints = 4;

}  // namespace railcast
