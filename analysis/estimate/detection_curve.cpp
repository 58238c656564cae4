#include "analysis/estimate/detection_curve.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <functional>
#include <nlopt.hpp>

#include "core/base/error.h"

namespace railcast {
namespace {

constexpr double kProbability = 0.9;
constexpr double kNoRange_m = std::numeric_limits<double>::quiet_NaN();
// Slopes of curves that are as good as flat, and as good as steps.
constexpr double kLeastSlope = 0.01;
constexpr double kGreatestSlope = 1e4;
// How far beyond the targets' ranges a curve's middle may lie, as a factor.
constexpr double kBeyond = 1e3;
// Accuracy of the parameters, which are logarithms and shares.
constexpr double kAccuracy = 1e-9;

/// The half of a chi-squared quantile of one degree of freedom by which a log-likelihood falls at
/// the ends of an interval.
double FallAt(double confidence) {
  return 0.5 * boost::math::quantile(boost::math::chi_squared(1.0), confidence);
}

/// log(1 + exp(z)).
double SoftPlus(double z) {
  return z > 0.0 ? z + std::log1p(std::exp(-z)) : std::log1p(std::exp(z));
}

/// log(rest + exp(z)) of a rest of the asymptote in 0..1.
double LogRestPlus(double rest, double z) {
  return z > 0.0 ? z + std::log1p(rest * std::exp(-z)) : std::log(rest + std::exp(z));
}

/// `count` times a logarithm, where nothing counts nothing.
double Times(std::uint64_t count, double logarithm) {
  return count == 0 ? 0.0 : static_cast<double>(count) * logarithm;
}

/// A curve as it is searched for.
struct Parameters {
  double log_middle{};
  double log_slope{};
  double upper = 1.0;
};

/// An inspection with the logarithm of its range, which a search asks for thousands of times.
struct LogInspection : Inspection {
  double log_range{};
};
using LogInspections = std::vector<LogInspection>;

LogInspections LogInspectionsOf(const std::vector<Inspection>& inspections) {
  LogInspections logged;
  for (const Inspection& each : inspections) logged.push_back({each, std::log(each.range_m)});
  return logged;
}

double LogLikelihood(const LogInspections& inspections, const Parameters& at) {
  const double slope = std::exp(at.log_slope);
  const double log_upper = std::log(at.upper);
  double sum = 0.0;
  for (const LogInspection& each : inspections) {
    const std::uint64_t num_missed = each.num_targets - each.num_detected;
    if (each.range_m <= 0.0) {  // Only the asymptote counts.
      sum += Times(each.num_detected, log_upper) + Times(num_missed, std::log1p(-at.upper));
      continue;
    }
    const double z = slope * (each.log_range - at.log_middle);
    const double soft_plus = SoftPlus(z);
    const double log_missed = num_missed == 0 ? 0.0 : LogRestPlus(1.0 - at.upper, z);
    sum +=
        Times(each.num_detected, log_upper - soft_plus) + Times(num_missed, log_missed - soft_plus);
  }
  return sum;
}

/// Half the logarithm of the determinant of Fisher's information of the line in the logarithm of
/// range and, with an asymptote, of that: the penalty that takes most of the bias of small samples
/// away (Firth 1993, Biometrika 80; Heinze and Schemper 2002, Statistics in Medicine 21).
double Penalty(const LogInspections& inspections, const Parameters& at, bool has_asymptote) {
  const double slope = std::exp(at.log_slope);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  if (!has_asymptote) information(2, 2) = 1.0;
  for (const LogInspection& each : inspections) {
    if (each.range_m <= 0.0) continue;
    const double beyond = each.log_range - at.log_middle;
    const double near = 1.0 / (1.0 + std::exp(slope * beyond));
    const double probability = at.upper * near;
    const double variance = probability * (1.0 - probability);
    if (!(variance > 0.0)) continue;
    const double change = at.upper * near * (1.0 - near);
    const Eigen::Vector3d gradient(change, beyond * change, has_asymptote ? near : 0.0);
    information +=
        static_cast<double>(each.num_targets) / variance * gradient * gradient.transpose();
  }
  return 0.5 * std::log(std::max(information.determinant(), 1e-300));
}

double Penalized(const LogInspections& inspections, const Parameters& at, bool has_asymptote) {
  return LogLikelihood(inspections, at) + Penalty(inspections, at, has_asymptote);
}

/// Where a function is searched for its maximum, in one dimension.
struct Interval {
  double low, high, start;
};

struct Maximum {
  double value{};
  std::vector<double> at;
};

// Finds the maximum of a smooth function within bounds: by the simplexes of Sbplx (Rowan 1990), in
// turns, each of which starts at the best place of the one before.
Maximum Maximize(const std::vector<Interval>& bounds,
                 const std::function<double(const std::vector<double>&)>& value) {
  Maximum best;
  std::vector<double> low, high, step;
  for (const Interval& bound : bounds) {
    low.push_back(bound.low);
    high.push_back(bound.high);
    best.at.push_back(bound.start);
    step.push_back(0.1 * (bound.high - bound.low));
  }
  nlopt::opt search(nlopt::LN_SBPLX, static_cast<unsigned>(bounds.size()));
  search.set_lower_bounds(low);
  search.set_upper_bounds(high);
  search.set_xtol_abs(kAccuracy);
  search.set_max_objective(
      [](const std::vector<double>& at, std::vector<double>& /*gradient*/, void* data) {
        const auto& function =
            *static_cast<const std::function<double(const std::vector<double>&)>*>(data);
        // Likelihoods of 0 are the worst that there is; the search needs a number.
        return std::max(function(at), -1e300);
      },
      const_cast<void*>(static_cast<const void*>(&value)));
  constexpr int kNumTurns = 3;
  for (int turn = 0; turn < kNumTurns; ++turn) {
    search.set_initial_step(step);
    search.optimize(best.at, best.value);
    for (double& each : step) each *= 0.1;
  }
  return best;
}

Interval SlopeBounds() {
  constexpr double kUsual = 5.0;
  return {std::log(kLeastSlope), std::log(kGreatestSlope), std::log(kUsual)};
}

// The share of the targets that were detected, which an asymptote exceeds.
double SharedDetected(const std::vector<Inspection>& inspections) {
  std::uint64_t num = 0;
  std::uint64_t num_detected = 0;
  for (const Inspection& each : inspections) {
    num += each.num_targets;
    num_detected += each.num_detected;
  }
  return static_cast<double>(num_detected) / static_cast<double>(num);
}

Interval MiddleBounds(const std::vector<Inspection>& inspections) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  double sum = 0.0;
  double num = 0.0;
  for (const Inspection& each : inspections) {
    if (each.range_m <= 0.0) continue;
    least = std::min(least, each.range_m);
    most = std::max(most, each.range_m);
    sum += static_cast<double>(each.num_targets) * std::log(each.range_m);
    num += static_cast<double>(each.num_targets);
  }
  return {std::log(least / kBeyond), std::log(most * kBeyond), sum / num};
}

// The greatest likelihood of curves that fall to kProbability at a range, near a known curve.
double LikelihoodOfD90(const LogInspections& inspections,
                       double log_d90,
                       const DetectionCurve& known,
                       bool has_asymptote) {
  Interval slope = SlopeBounds();
  slope.start = std::clamp(std::log(known.slope), slope.low, slope.high);
  std::vector<Interval> bounds{slope};
  if (has_asymptote) bounds.push_back({kProbability + 1e-9, 1.0, known.upper});
  return Maximize(bounds,
                  [&](const std::vector<double>& at) {
                    const double upper = has_asymptote ? at[1] : 1.0;
                    const double log_middle =
                        log_d90 - std::log(upper / kProbability - 1.0) / std::exp(at[0]);
                    return Penalized(inspections, {log_middle, at[0], upper}, has_asymptote);
                  })
      .value;
}

/// Where a function that is negative at `from` first has the value 0 towards `to`, in steps that
/// double; NaN if it has not.
double FirstRoot(double from, double to, const std::function<double(double)>& function) {
  constexpr double kFirstStep = 0.01;
  double near = from;
  for (double step = kFirstStep; near != to; step *= 2.0) {
    const double far = to > from ? std::min(from + step, to) : std::max(from - step, to);
    if (function(far) >= 0.0) {
      constexpr int kBits = 20;
      const auto [a, b] =
          boost::math::tools::bisect(function, std::min(near, far), std::max(near, far),
                                     boost::math::tools::eps_tolerance<double>(kBits));
      return 0.5 * (a + b);
    }
    near = far;
  }
  return kNoRange_m;
}

// The range at which so many of the farthest targets, all of which are detected, show that the
// probability is kProbability with 95 % confidence: were it less there, it would be less for all
// that are farther, and all of them would be detected in fewer than 5 % of all cases.
double FarthestOfAllDetected(std::vector<Inspection> inspections) {
  const auto num_needed =
      static_cast<std::uint64_t>(std::ceil(std::log(0.05) / std::log(kProbability)));
  std::ranges::sort(inspections, std::ranges::greater{}, &Inspection::range_m);
  std::uint64_t num = 0;
  for (const Inspection& each : inspections) {
    num += each.num_targets;
    if (num >= num_needed) return each.range_m;
  }
  return kNoRange_m;
}

DetectionCurve FoundCurve(const Parameters& parameters, double log_likelihood) {
  return {parameters.upper, std::exp(parameters.log_middle), std::exp(parameters.log_slope),
          log_likelihood};
}

/// @param upper Is estimated if it is NaN.
DetectionCurve FitCurve(const std::vector<Inspection>& inspections,
                        double upper,
                        bool is_penalized) {
  const bool is_free = std::isnan(upper);
  const LogInspections logged = LogInspectionsOf(inspections);
  std::vector<Interval> bounds{MiddleBounds(inspections), SlopeBounds()};
  const double share = SharedDetected(inspections);
  if (is_free) bounds.push_back({share, 1.0, 0.5 * (1.0 + share)});
  const auto parameters = [&](const std::vector<double>& at) {
    return Parameters{at[0], at[1], is_free ? at[2] : upper};
  };
  const Maximum best = Maximize(bounds, [&](const std::vector<double>& at) {
    return is_penalized ? Penalized(logged, parameters(at), is_free)
                        : LogLikelihood(logged, parameters(at));
  });
  return FoundCurve(parameters(best.at), best.value);
}

}  // namespace

double DetectionCurve::At(double range_m) const {
  if (range_m <= 0.0) return upper;
  return upper / (1.0 + std::pow(range_m / middle_m, slope));
}

double DetectionCurve::RangeOf(double probability) const {
  if (!(upper > probability)) return kNoRange_m;
  return middle_m * std::pow(upper / probability - 1.0, 1.0 / slope);
}

DetectionCurve FitDetectionCurve(const std::vector<Inspection>& inspections, double upper) {
  return FitCurve(inspections, upper, false);
}

DetectionFit FitDetection(const std::vector<Inspection>& inspections) {
  DetectionFit fit;
  for (const Inspection& each : inspections) {
    Check(each.num_detected <= each.num_targets, "no more targets are detected than there are");
    fit.num_targets += each.num_targets;
    fit.num_detected += each.num_detected;
  }
  if (fit.num_detected == 0 || fit.num_detected == fit.num_targets) {
    fit.curve.middle_m = kNoRange_m;
    fit.curve.slope = kNoRange_m;
    if (fit.num_detected > 0) fit.d90_95_m = FarthestOfAllDetected(inspections);
    return fit;
  }
  const DetectionCurve without = FitDetectionCurve(inspections, 1.0);
  const DetectionCurve with = FitDetectionCurve(inspections, kNoRange_m);
  // The asymptote lies at the end of what it may be, so that half of all ratios are 0 (Self and
  // Liang 1987): 5 % of them exceed the quantile of 90 %.
  const double one_sided = FallAt(0.9);
  fit.has_asymptote = with.log_likelihood - without.log_likelihood > one_sided;
  fit.curve = FitCurve(inspections, fit.has_asymptote ? kNoRange_m : 1.0, true);
  fit.d90_m = fit.curve.RangeOf(kProbability);
  if (fit.has_asymptote) {
    const auto fall = [&](double upper) {
      return with.log_likelihood - FitDetectionCurve(inspections, upper).log_likelihood -
             FallAt(0.95);
    };
    fit.upper_low = FirstRoot(with.upper, 0.0, fall);
    const double high = FirstRoot(with.upper, 1.0, fall);
    fit.upper_high = std::isnan(high) ? 1.0 : high;
  }
  if (std::isnan(fit.d90_m)) return fit;
  const LogInspections logged = LogInspectionsOf(inspections);
  const double log_d90_95 =
      FirstRoot(std::log(fit.d90_m), std::log(fit.d90_m / kBeyond), [&](double log_d90) {
        return fit.curve.log_likelihood -
               LikelihoodOfD90(logged, log_d90, fit.curve, fit.has_asymptote) - one_sided;
      });
  fit.d90_95_m = std::exp(log_d90_95);
  return fit;
}

}  // namespace railcast
