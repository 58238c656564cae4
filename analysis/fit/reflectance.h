#pragma once

#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// An intensity, and what shape the surface's answer has there (analysis/fit/trial.h).
struct IntensitySample {
  double diffuse{};
  double lobe{};
  double intensity{};
};

/// The reflectance rho of intensity = rho x diffuse + lobe: least squares with Tukey's bisquare
/// weights (tuning 4.685: 95 % as efficient on normal errors), from the median of the samples' own
/// answers. The interval has the sandwich covariance (Huber 1964), and never less than the 1e-5
/// that the float32 fields of a frame carry.
[[nodiscard]] Estimate FitReflectance(const std::vector<IntensitySample>& samples);

}  // namespace railcast
