#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace railcast {

/// Independent targets at one range, and how many of them were detected.
struct Inspection {
  double range_m{};
  std::uint64_t num_detected{};
  std::uint64_t num_targets{};
};

/// The probability of detection against range, a log-logistic curve with an upper asymptote:
///
///   POD(d) = upper / (1 + (d / middle)^slope)
///
/// This is the generalised linear model of hit and miss against log size of MIL-HDBK-1823A (2009),
/// mirrored, since ranges make detection harder; `upper` is below 1 where even near targets may be
/// missed, as in fog or behind other things (C. Annis, statistical-engineering.com/mh1823, on
/// floors and ceilings of POD).
struct DetectionCurve {
  double upper = 1.0;
  double middle_m{};        ///< Where half of `upper` is detected.
  double slope{};           ///< > 0.
  double log_likelihood{};  ///< With the penalty if it has one; without what is the same for all.

  [[nodiscard]] double At(double range_m) const;
  /// The range within which at least this probability holds; NaN if `upper` does not exceed it.
  [[nodiscard]] double RangeOf(double probability) const;
};

/// The range at which the probability of detection is 0.9, and what is known of it.
struct DetectionFit {
  DetectionCurve curve;
  /// Whether an asymptote below 1 is part of the curve: if the likelihood ratio rejects 1 at 5 %.
  bool has_asymptote{};
  /// 95 % interval of the asymptote by its profile likelihood; both 1 without one.
  double upper_low = 1.0;
  double upper_high = 1.0;
  double d90_m = std::numeric_limits<double>::quiet_NaN();
  /// With 95 % confidence, the probability is 0.9 at least up to this range: the lower bound of
  /// `d90_m` by the profile likelihood. NaN if no range has that confidence.
  double d90_95_m = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t num_targets{};
  std::uint64_t num_detected{};

  /// MIL-HDBK-1823A asks for so many targets of hit and miss; with fewer, the figures are too
  /// uncertain to be used.
  static constexpr std::uint64_t kMinTargets = 60;
};

/// Fits the curve by penalised maximum likelihood (Firth 1993), and bounds it by the profile of
/// that: of 60 targets, the bound then holds in 95 % of all experiments, that of the plain
/// likelihood in 91 %.
///
///   const DetectionFit fit = FitDetection({{50.0, 30, 30}, {100.0, 22, 30}, {150.0, 4, 30}});
///   std::cout << fit.d90_95_m;
///
/// If all targets were detected, or none, there is no curve: `curve.middle_m`, `d90_m` and
/// `d90_95_m` are NaN, but for the greatest range at which the targets that were all detected
/// suffice for 0.9 with 95 % confidence (29 of 29, binomial), which is `d90_95_m`.
/// @pre All ranges are > 0, or 0 for what counts for the asymptote alone.
[[nodiscard]] DetectionFit FitDetection(const std::vector<Inspection>& inspections);

/// The curve of the plain maximum likelihood with a given asymptote, or with one that is estimated
/// whatever its significance (NaN).
[[nodiscard]] DetectionCurve FitDetectionCurve(const std::vector<Inspection>& inspections,
                                               double upper);

}  // namespace railcast
