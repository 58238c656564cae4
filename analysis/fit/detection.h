#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace railcast {

/// A trial as detection sees it. Its power over the least detectable one is
///
///   power = (e^theta gain + lobe) e^(-ways extinction R),
///
/// theta that of its group: the logarithm of what the group's trials have in common, a reflectance,
/// a threshold's inverse, or the two as a product.
struct DetectionTrial {
  double gain{};  ///< > 0
  double lobe{};
  double range_m{};
  std::uint32_t group{};
  bool is_returned{};
};

/// Losses that have nothing to do with power: P(lost) = 1 - (1 - probability) e^(-rate R).
struct RandomLoss {
  double probability{};
  double rate_per_m{};

  [[nodiscard]] double Survival(double range_m) const {
    return (1.0 - probability) * std::exp(-rate_per_m * range_m);
  }
};

/// What is asked of a fit of detection.
struct DetectionProblem {
  std::vector<DetectionTrial> trials;
  std::uint32_t num_groups = 1;
  bool is_smooth{};       ///< Whether the threshold is that of physics, not the published one.
  double air_ways = 2.0;  ///< 1: as published; 2: physics.
  std::optional<double> extinction_per_m;  ///< Given; else it is fitted.
  RandomLoss loss;
};

/// What the trials of a group say of its theta.
enum class GroupState : std::uint8_t {
  kFew,            ///< Too few trials.
  kNeverLost,      ///< No beam is lost to the threshold: theta is at least ...
  kNeverReturned,  ///< No beam comes back: theta is at most ...
  kSeen,           ///< Some are lost to it, some are not.
};

struct GroupOutlook {
  GroupState state = GroupState::kFew;
  double bound = std::numeric_limits<double>::quiet_NaN();  ///< ... this, at 95 %.
  double start = std::numeric_limits<double>::quiet_NaN();  ///< Of kSeen: about where theta is.
  double evidence{};  ///< Of kSeen: log likelihood over that of no threshold.
  std::uint64_t num{};
};

/// All groups at one extinction: the given one, or else the best of a few.
struct Outlook {
  std::vector<GroupOutlook> groups;
  double extinction_per_m{};
};

/// Looks at each group by itself: is there a power above which a share returns that is the same for
/// all (free), and below which nothing does, or of a smooth threshold less than half of that share?
/// The best such place against none, by likelihood.
[[nodiscard]] Outlook LookAtGroups(const DetectionProblem& problem);

/// Fitted parameters: thetas of the groups in kSeen (others: NaN), extinction, and for the smooth
/// threshold the logarithm of the SNR at the threshold, with the covariance of their errors.
struct DetectionFit {
  Eigen::VectorXd theta;       ///< By group.
  Eigen::MatrixXd covariance;  ///< Of (theta by group, extinction, log snr); 0 where given or NaN.
  double extinction_per_m{};
  double log_snr = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] Eigen::Index extinction_place() const { return theta.size(); }
  [[nodiscard]] Eigen::Index snr_place() const { return theta.size() + 1; }
};

/// Share of beams that come back, or do not, against all that the model says: labels that are
/// wrong, points of something else. So much evidence against it a single trial can be: log(1e-3).
inline constexpr double kWrongShare = 1e-3;

/// The hard threshold of the published model: detected where power >= 1.
///
/// Where a step lies is a question of place, and its likelihood is no parabola: the interval
/// shrinks as 1 / n. So mean and covariance are those of the posterior under a flat prior in the
/// range at which beams are lost and in the extinction (>= 0), which for a place has the coverage
/// it states (Pitman 1939). Exact but for a grid over the extinction.
[[nodiscard]] DetectionFit FitHardThreshold(const DetectionProblem& problem,
                                            const Outlook& outlook);

/// The smooth threshold of physics: P(detected) = Phi(SNR_t (power - 1)), by maximum likelihood:
/// Fisher's scoring, which is iterated least squares with the weights 1 / (P (1 - P)), damped as
/// Levenberg and Marquardt do. Covariance: the inverse of Fisher's information.
[[nodiscard]] DetectionFit FitSmoothThreshold(const DetectionProblem& problem,
                                              const Outlook& outlook);

}  // namespace railcast
