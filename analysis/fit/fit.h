#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/noise.h"
#include "analysis/fit/trial.h"

namespace railcast {

/// Which rung's parameters are looked for, and what is known beforehand.
struct FitSettings {
  bool is_physical{};            ///< Rung surface; else plausibility.
  bool has_reflectances = true;  ///< Whether recorded intensities are effective reflectances.
  bool knows_losses = true;      ///< Whether trials tell what is lost; else they are points only.
  std::optional<double> range_at_10_percent_m;  ///< Of a data sheet: fixes the threshold.
  std::map<std::string, double> known;          ///< Reflectance by surface: likewise.
  std::optional<double> extinction_per_m;       ///< Of the air, instead of fitting it.
  std::optional<double> rain_rate_mmph;         ///< Parts rain's dropout from its rate.
};

/// What a fit says of one parameter of a scenario.
struct FittedParameter {
  std::string place;  ///< In a scenario: "lidar/receiver/range_noise_floor_m".
  std::string title;
  std::string unit;
  Estimate estimate;   ///< Without a value where the data do not identify it.
  std::string remark;  ///< Why not, a bound, or what the value rests on; may be empty.
};

/// What a fit says of a surface.
struct SurfaceFit {
  std::string name;
  std::uint64_t num_trials{};
  std::uint64_t num_returned{};
  Estimate reflectance;  ///< Dry, diffuse.
  std::string remark;
  /// Up to where it is detected if it faces the beam, in clear air: what detection alone
  /// identifies, sqrt(reflectance / threshold at 1 m).
  Estimate facing_range_m;
  double power_at_1m = std::numeric_limits<double>::quiet_NaN();  ///< e^theta: of its diffuse part.
  double lobe_scale = std::numeric_limits<double>::quiet_NaN();   ///< Of its lobe.
};

/// All that is found.
struct FitResult {
  std::vector<FittedParameter> parameters;
  std::vector<SurfaceFit> surfaces;  ///< Those with trials; by index where `surface_ids` says.
  std::vector<std::uint16_t> surface_ids;
  Residuals residuals;
  std::vector<NoiseBin> noise_by_range;
  std::vector<NoiseBin> noise_by_power;  ///< Rung surface only.
  double extinction_per_m{};             ///< As fitted or given.
  double snr_at_threshold = std::numeric_limits<double>::quiet_NaN();
  /// Standard error of the logarithm of the signal-to-noise ratios that follow from the above.
  double log_snr_error = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t num_trials{};
  std::uint64_t num_lost{};
  std::uint64_t num_elsewhere{};
};

/// Power over threshold of a trial, by what was fitted of its surface; NaN if that is not known.
[[nodiscard]] double PowerOf(const Trial& trial,
                             const FitSurface& surface,
                             const SurfaceFit& fit,
                             const FitSettings& settings,
                             double extinction_per_m);

/// Estimates all that the trials identify: reflectances from intensities, random losses from
/// beams far above the threshold, the threshold from where beams are lost, noise from residuals.
/// @param trials Points far off are marked as from elsewhere, and the channels' biases are taken
///   from the residuals, in place.
[[nodiscard]] FitResult FitModel(std::vector<Trial>& trials,
                                 const std::vector<FitSurface>& surfaces,
                                 const FitSettings& settings);

}  // namespace railcast
