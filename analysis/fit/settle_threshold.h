#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/fit/detection.h"
#include "analysis/fit/fit.h"
#include "analysis/fit/random_loss.h"

namespace railcast {

/// What fixes the scale of reflectances against the threshold: detection knows their ratio only.
enum class ScaleSource { kIntensity, kDataSheet, kKnownSurface, kNothing };

/// How surfaces share thetas. Group 0 of kIntensity and kKnownSurface is the threshold's: its theta
/// is log(1 / P_min).
struct ThresholdGroups {
  ScaleSource source{};
  std::vector<std::uint32_t> of_surface;  ///< By place in the result's surfaces; or kNoGroup.
  std::vector<double> reflectance;        ///< Of those in the threshold's group; others: NaN.
  std::uint32_t num{};

  static constexpr std::uint32_t kNoGroup = 0xFFFFFFFFU;
};

/// What detection comes to, before it is put in words.
struct SettledThreshold {
  ThresholdGroups groups;
  Outlook outlook;
  RandomLossFit loss;
  DetectionFit detection;  ///< If `is_seen`.
  bool is_seen{};          ///< Whether any group loses beams to the threshold, but not all.
  double log_inverse_power = std::numeric_limits<double>::quiet_NaN();  ///< log(1 / P_min), or ...
  /// ... its standard error; NaN = not known, and log_inverse_power a guess for the lobes' sake.
  double log_inverse_power_error = std::numeric_limits<double>::quiet_NaN();
};

/// Of the data sheet's range; P_min = 0.1 / range^2.
inline constexpr double kDataSheetReflectance = 0.1;

/// Random losses and threshold, each with the other's last values, in a few rounds.
[[nodiscard]] SettledThreshold SettleThreshold(const std::vector<Trial>& trials,
                                               const std::vector<FitSurface>& surfaces,
                                               const FitSettings& settings,
                                               const FitResult& result);

}  // namespace railcast
