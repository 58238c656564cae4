#include "generator/extras/import/fit/plan_window.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <unsupported/Eigen/NumericalDiff>

#include "core/rail/line/alignment_course.h"

namespace railcast {
namespace {

constexpr double kCantSlope_mPerMmKmph = 0.01;  // 10 v mm of length for each mm of cant.
constexpr double kShareOfBalancingCant = 0.6;
constexpr double kHighestCant_mm = 150.0;
constexpr double kHighestDeficiency_mm = 130.0;
constexpr double kShortestUsualClothoid_m = 15.0;
constexpr double kShortestUsualClothoid_mPerKmph = 0.2;  // 0.7 s of running.
constexpr double kShortestUsualPlateau_m = 20.0;
/// The transition curves of faster lines are hardly shorter than this share of the usual length.
constexpr double kFastLine_kmph = 160.0;
constexpr double kLeastShareOfUsual = 0.5;

constexpr double kHeadingUnit_rad = 1e-3;
constexpr double kCurvatureUnit_per_m = 1e-4;
constexpr double kEndTolerance_m = 2e-3;
constexpr double kEndTolerance_rad = 2e-6;
constexpr double kLineEndTolerance_m = 0.1;

/// The residual whose square is the pseudo-Huber loss of `z`.
double Robust(double z) {
  constexpr double kDelta = 2.0;
  const double ratio = z / kDelta;
  const double loss = 2.0 * kDelta * kDelta * (std::sqrt(1.0 + ratio * ratio) - 1.0);
  return std::copysign(std::sqrt(loss), z);
}

// Limits of what the solver may try. It must begin between them: on one it would see no slope.
constexpr double kShortestTried_m = 0.4;
constexpr double kSharpestTried = 1.0 / kSmallestRadius_m / kCurvatureUnit_per_m;

/// Twice as long as all that the window has.
double LongestOf_m(const PlanWindow& window) {
  double along_m = 0.0;
  for (std::size_t i = 1; i < window.points_m.size(); ++i) {
    along_m += (window.points_m[i] - window.points_m[i - 1]).norm();
  }
  double longest_m = std::max(along_m, window.plan.length_m());
  for (const double clothoid_m : window.plan.clothoids_m) {
    longest_m = std::max(longest_m, clothoid_m);
  }
  return 2.0 * longest_m;
}

/// Distances between a window's plan and what it is fitted to, as a function of its parameters: the
/// logarithms of all lengths, which keeps these positive, the free curvatures, and the pose of its
/// beginning if that is free.
class Residuals {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  using QRSolver = Eigen::ColPivHouseholderQR<JacobianType>;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  explicit Residuals(const PlanWindow& window)
      : window_(&window),
        longest_m_(LongestOf_m(window)),
        num_inputs_(Parameters().size()),
        feet_m_(window.feet_m) {}

  [[nodiscard]] Eigen::VectorXd Parameters() const {
    const PlanModel& plan = window_->plan;
    std::vector<double> values;
    if (window_->begins_line) values.insert(values.end(), 3, 0.0);
    for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
      values.push_back(std::log(std::max(0.5, plan.ConstantLength_m(i))));
      if (!window_->has_fixed_curvature[i]) {
        values.push_back(std::clamp(plan.plateaus[i].curvature_per_m / kCurvatureUnit_per_m,
                                    -0.9 * kSharpestTried, 0.9 * kSharpestTried));
      }
    }
    for (const double length_m : plan.clothoids_m) {
      values.push_back(std::log(std::max(0.5, length_m)));
    }
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  [[nodiscard]] PlanModel PlanOf(const Eigen::VectorXd& parameters) const {
    const auto length_m = [&](double logarithm) {
      return std::exp(std::clamp(logarithm, std::log(kShortestTried_m), std::log(longest_m_)));
    };
    PlanModel plan = window_->plan;
    Eigen::Index next = 0;
    if (window_->begins_line) {
      plan.start.x_m += parameters[0];
      plan.start.y_m += parameters[1];
      plan.start.heading_rad += kHeadingUnit_rad * parameters[2];
      next = 3;
    }
    for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
      Plateau& plateau = plan.plateaus[i];
      plateau.length_m = length_m(parameters[next++]);
      if (window_->has_fixed_curvature[i]) continue;
      plateau.curvature_per_m =
          kCurvatureUnit_per_m * std::clamp(parameters[next++], -kSharpestTried, kSharpestTried);
    }
    for (std::size_t i = 0; i < plan.clothoids_m.size(); ++i) {
      const double clothoid_m = length_m(parameters[next++]);
      plan.clothoids_m[i] = clothoid_m;
      plan.plateaus[i].length_m += 0.5 * clothoid_m;
      plan.plateaus[i + 1].length_m += 0.5 * clothoid_m;
    }
    return plan;
  }

  [[nodiscard]] const std::vector<double>& feet_m() const { return feet_m_; }
  [[nodiscard]] std::size_t num_feet() const { return num_feet_; }

  // The interface of Eigen's solver.
  [[nodiscard]] Eigen::Index inputs() const { return num_inputs_; }
  [[nodiscard]] Eigen::Index values() const {
    const PlanModel& plan = window_->plan;
    return static_cast<Eigen::Index>(window_->points_m.size() + 2 * plan.clothoids_m.size() +
                                     2 * plan.plateaus.size() + kNumEndResiduals);
  }
  int operator()(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals) const {
    const PlanModel plan = PlanOf(parameters);
    const PlanCourse course = plan.Course();
    const double length_m = plan.length_m();
    residuals.setZero(values());
    Eigen::Index next = 0;
    Foot first;
    Foot last;
    num_feet_ += feet_m_.size();
    for (std::size_t i = 0; i < feet_m_.size(); ++i) {
      last = FootOn(course, length_m, window_->points_m[i], feet_m_[i]);
      feet_m_[i] = last.s_m;
      if (i == 0) first = last;
      residuals[next++] = Robust(last.offset_m / window_->sigma_m);
    }
    for (std::size_t i = 0; i < plan.clothoids_m.size(); ++i) {
      const double usual_m = UsualClothoid_m(window_->speed_kmph, plan.plateaus[i].curvature_per_m,
                                             plan.plateaus[i + 1].curvature_per_m);
      residuals[next++] = 2.0 * std::log(plan.clothoids_m[i] / usual_m);
      if (window_->speed_kmph > kFastLine_kmph) {
        residuals[next] =
            std::max(0.0, 5.0 * std::log(kLeastShareOfUsual * usual_m / plan.clothoids_m[i]));
      }
      ++next;
    }
    const double sharpest_per_m = SharpestCurvature_per_m(window_->speed_kmph);
    for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
      const double curvature_per_m = std::max(1e-9, std::abs(plan.plateaus[i].curvature_per_m));
      residuals[next++] =
          std::max(0.0, std::log(kShortestUsualPlateau_m / plan.ConstantLength_m(i)));
      residuals[next++] = std::max(0.0, 5.0 * std::log(curvature_per_m / sharpest_per_m));
    }
    if (window_->begins_line) residuals[next] = (first.s_m + first.beyond_m) / kLineEndTolerance_m;
    ++next;
    if (window_->ends_line) {
      residuals[next] = (last.s_m + last.beyond_m - length_m) / kLineEndTolerance_m;
    } else {
      const PlanPoint end = course.At(length_m);
      residuals[next + 1] = (end.x_m - window_->end.x_m) / kEndTolerance_m;
      residuals[next + 2] = (end.y_m - window_->end.y_m) / kEndTolerance_m;
      residuals[next + 3] = (end.heading_rad - window_->end.heading_rad) / kEndTolerance_rad;
    }
    return 0;
  }

 private:
  static constexpr std::size_t kNumEndResiduals = 5;

  const PlanWindow* window_;
  double longest_m_;  ///< That the solver may try for an element.
  Eigen::Index num_inputs_;
  mutable std::vector<double> feet_m_;  ///< Of the last evaluation: guesses for the next one.
  mutable std::size_t num_feet_ = 0;    ///< Sought so far.
};

}  // namespace

Foot FootOn(const PlanCourse& course,
            double length_m,
            const Eigen::Vector2d& point_m,
            double guess_m) {
  constexpr int kMostSteps = 8;
  // The offset changes with the square of what is left: 1e-6 m of it at a radius of 50 m.
  constexpr double kTolerance_m = 0.01;
  Foot foot{std::clamp(guess_m, 0.0, length_m), 0.0, 0.0};
  for (int step = 0; step < kMostSteps; ++step) {
    const PlanPoint at = course.At(foot.s_m);
    const Eigen::Vector2d ahead(std::cos(at.heading_rad), std::sin(at.heading_rad));
    const Eigen::Vector2d to_point_m = point_m - Eigen::Vector2d(at.x_m, at.y_m);
    foot.beyond_m = to_point_m.dot(ahead);
    foot.offset_m = ahead.x() * to_point_m.y() - ahead.y() * to_point_m.x();
    const double stretch = std::max(0.3, 1.0 - at.curvature_per_m * foot.offset_m);
    const double next_m = std::clamp(foot.s_m + foot.beyond_m / stretch, 0.0, length_m);
    if (std::abs(next_m - foot.s_m) < kTolerance_m) break;
    foot.s_m = next_m;
  }
  return foot;
}

double UsualClothoid_m(double speed_kmph, double from_per_m, double to_per_m) {
  const double cant_mm = std::min(kShareOfBalancingCant * kBalancingCant * speed_kmph * speed_kmph *
                                      std::abs(to_per_m - from_per_m),
                                  kHighestCant_mm);
  return std::max({kShortestUsualClothoid_m, kShortestUsualClothoid_mPerKmph * speed_kmph,
                   kCantSlope_mPerMmKmph * speed_kmph * cant_mm});
}

double SharpestCurvature_per_m(double speed_kmph) {
  return (kHighestCant_mm + kHighestDeficiency_mm) / (kBalancingCant * speed_kmph * speed_kmph);
}

double PlanWindow::Fit() {
  Eigen::NumericalDiff<Residuals> residuals{Residuals(*this)};
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals>> solver(residuals);
  solver.setMaxfev(60 * static_cast<int>(residuals.inputs()));
  solver.setXtol(1e-5);
  solver.setFtol(1e-4);
  Eigen::VectorXd parameters = residuals.Parameters();
  solver.minimize(parameters);
  Eigen::VectorXd rest;
  residuals(parameters, rest);
  plan = residuals.PlanOf(parameters);
  feet_m = residuals.feet_m();
  num_feet += residuals.num_feet();
  return rest.squaredNorm();
}

}  // namespace railcast
