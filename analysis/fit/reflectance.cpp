#include "analysis/fit/reflectance.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/intervals.h"
#include "analysis/estimate/robust.h"

namespace railcast {

Estimate FitReflectance(const std::vector<IntensitySample>& samples) {
  constexpr double kTukey = 4.685;
  constexpr double kFloat32 = 1e-5;
  constexpr int kRounds = 30;
  std::vector<double> ratios;
  for (const IntensitySample& sample : samples) {
    ratios.push_back((sample.intensity - sample.lobe) / sample.diffuse);
  }
  const Estimate start = Median(ratios);
  if (!start.is_enough()) return start;
  double rho = start.value;
  double bread = 0.0, meat = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> residuals;
    for (const IntensitySample& s : samples) {
      residuals.push_back(s.intensity - s.lobe - rho * s.diffuse);
    }
    std::vector<double> scratch = residuals;
    const double scale = RobustScale(scratch).value + kFloat32 * std::abs(rho);
    double top = 0.0, bottom = 0.0;
    bread = meat = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double pull = residuals[i] / (kTukey * scale);
      if (std::abs(pull) >= 1.0) continue;
      const double part = 1.0 - pull * pull;
      const double weight = part * part;
      const double x = samples[i].diffuse;
      top += weight * x * residuals[i];
      bottom += weight * x * x;
      // The derivative of weight x residual.
      bread += part * (1.0 - 5.0 * pull * pull) * x * x;
      meat += weight * weight * residuals[i] * residuals[i] * x * x;
    }
    if (!(bottom > 0.0)) return NotEnough(samples.size());
    rho += top / bottom;
    if (std::abs(top / bottom) < 1e-9 * std::abs(rho)) break;
  }
  if (!(bread > 0.0)) return NotEnough(samples.size());
  const double z = NormalQuantile();
  const double half = z * std::sqrt(meat) / bread + kFloat32 * std::abs(rho);
  return {rho, rho - half, rho + half, samples.size()};
}

}  // namespace railcast
