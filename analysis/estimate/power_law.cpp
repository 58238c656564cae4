#include "analysis/estimate/power_law.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/estimate.h"

namespace railcast {

PowerLaw FitPowerLaw(const std::vector<CurvePoint>& points) {
  std::vector<CurvePoint> logs;
  for (const CurvePoint& point : points) {
    if (!(point.x > 0.0 && point.y > 0.0 && point.relative_error > 0.0)) continue;
    logs.push_back({std::log(point.x), std::log(point.y), point.relative_error});
  }
  PowerLaw law;
  law.exponent = NotEnough(logs.size());
  if (logs.size() < kMinCurvePoints) return law;

  double sum = 0.0, mean_x = 0.0, mean_y = 0.0;
  const auto weight = [](const CurvePoint& p) {
    return 1.0 / (p.relative_error * p.relative_error);
  };
  for (const CurvePoint& p : logs) {
    sum += weight(p);
    mean_x += weight(p) * p.x;
    mean_y += weight(p) * p.y;
  }
  mean_x /= sum;
  mean_y /= sum;
  double xx = 0.0, xy = 0.0;
  for (const CurvePoint& p : logs) {
    xx += weight(p) * (p.x - mean_x) * (p.x - mean_x);
    xy += weight(p) * (p.x - mean_x) * (p.y - mean_y);
  }
  if (!(xx > 0.0)) return law;
  const double slope = xy / xx;
  double scatter = 0.0;  // Chi-squared.
  for (const CurvePoint& p : logs) {
    const double residual = p.y - mean_y - slope * (p.x - mean_x);
    scatter += weight(p) * residual * residual;
  }
  const double degrees = static_cast<double>(logs.size()) - 2.0;
  const double times = StudentQuantile(degrees) * std::sqrt(std::max(1.0, scatter / degrees));
  const double half = times / std::sqrt(xx);
  law.exponent = {slope, slope - half, slope + half, logs.size()};
  law.factor = std::exp(mean_y - slope * mean_x);
  law.middle = mean_x;
  law.middle_error = times / std::sqrt(sum);
  return law;
}

Estimate PowerLaw::At(double x) const {
  if (!exponent.is_enough()) return exponent;
  const double y = factor * std::pow(x, exponent.value);
  const double by_slope = (std::log(x) - middle) * 0.5 * (exponent.high - exponent.low);
  const double grow = std::exp(std::hypot(middle_error, by_slope));
  return {y, y / grow, y * grow, exponent.num};
}

}  // namespace railcast
