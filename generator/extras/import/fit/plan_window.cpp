#include "generator/extras/import/fit/plan_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "core/rail/line/alignment_course.h"
#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

constexpr double kShortestUsualPlateau_m = 20.0;
/// The transition curves of faster lines are hardly shorter than this share of the usual length.
constexpr double kFastLine_kmph = 160.0;
constexpr double kLeastShareOfUsual = 0.5;

constexpr double kHeadingUnit_rad = 1e-3;
constexpr double kCurvatureUnit_per_m = 1e-4;
constexpr double kEndTolerance_m = 2e-3;
constexpr double kEndTolerance_rad = 2e-6;
constexpr double kLineEndTolerance_m = 0.1;
constexpr Eigen::Index kNumEndResiduals = 5;

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

/// The residual whose square is the pseudo-Huber loss 2 d^2 (sqrt(1 + (z / d)^2) - 1), and its
/// derivative by z.
struct Robust {
  explicit Robust(double z) {
    constexpr double kDelta = 2.0;
    const double root = std::sqrt(1.0 + z * z / (kDelta * kDelta));
    residual = z * std::sqrt(2.0 / (1.0 + root));
    slope = std::sqrt(0.5 * (1.0 + root)) / root;
  }
  double residual{};
  double slope{};
};

Eigen::Vector2d LeftOf(const Eigen::Vector2d& direction) {
  return {-direction.y(), direction.x()};
}
Eigen::Vector2d DirectionAt(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

/// A parameter's bend of an element: its curvature changes by at_begin + growth * (length inside).
struct Bend {
  Eigen::Index parameter = -1;  ///< -1: no parameter.
  double at_begin{};
  double growth{};
};

/// A straight, arc or clothoid of a plan. Places are relative to the plan's beginning.
struct Element {
  double begin_m{};
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< Where it begins.
  double heading_rad{};
  double curvature_per_m{};
  double slope_per_m2{};
  /// How its beginning, and all that is fixed to it, moves with each parameter: what stands at 0
  /// moves by the first two rows, and all turns about 0 by the third.
  Eigen::Matrix3Xd motions;
  std::array<Bend, 3> bends;
};

/// A point of an element with what its derivatives need.
struct ElementPoint {
  Eigen::Vector2d place_m;
  double heading_rad{};
  double curvature_per_m{};
  std::array<double, 3> turns{};  ///< By each bend of the element, about its beginning.
  std::array<Eigen::Vector2d, 3> shifts_m;
};

/// With the turn t of a bend, which is a polynomial of the length v inside, the place moves by the
/// integral of t left(v) dv. It needs the moments of the direction, taken by the quadrature of
/// PlanCourse in steps that turn so little that they are exact to 1e-10 of their length.
ElementPoint PointOf(const Element& element, double inside_m) {
  constexpr double kMostTurn_rad = 1.5;
  const double end_per_m = element.curvature_per_m + element.slope_per_m2 * inside_m;
  const double turn_rad =
      inside_m * std::max(std::abs(element.curvature_per_m), std::abs(end_per_m));
  const double num_steps = std::max(1.0, std::ceil(turn_rad / kMostTurn_rad));
  const double half_m = 0.5 * inside_m / num_steps;
  const auto heading_rad = [&](double v_m) {
    return element.heading_rad + (element.curvature_per_m + 0.5 * element.slope_per_m2 * v_m) * v_m;
  };
  Eigen::Matrix<double, 2, 3> moments = Eigen::Matrix<double, 2, 3>::Zero();
  for (double step = 0.0; step < num_steps; ++step) {
    for (const auto& [position, weight] : kGaussLegendre) {
      const double v_m = half_m * (2.0 * step + 1.0 + position);
      moments +=
          half_m * weight * DirectionAt(heading_rad(v_m)) * Eigen::RowVector3d(1.0, v_m, v_m * v_m);
    }
  }
  ElementPoint point{element.place_m + moments.col(0), heading_rad(inside_m), end_per_m, {}, {}};
  for (std::size_t i = 0; i < element.bends.size(); ++i) {
    const Bend& bend = element.bends[i];
    point.turns[i] = (bend.at_begin + 0.5 * bend.growth * inside_m) * inside_m;
    point.shifts_m[i] = LeftOf(bend.at_begin * moments.col(1) + 0.5 * bend.growth * moments.col(2));
  }
  return point;
}

/// Adds the derivative by each parameter of a linear function of a point's place and heading.
template <typename Row>
void AddDerivatives(const Element& element,
                    const ElementPoint& point,
                    const Eigen::Vector2d& by_place,
                    double by_heading,
                    Row row) {
  const double by_turn = by_place.dot(LeftOf(point.place_m)) + by_heading;
  row += Eigen::RowVector3d(by_place.x(), by_place.y(), by_turn) * element.motions;
  for (std::size_t i = 0; i < element.bends.size(); ++i) {
    if (element.bends[i].parameter < 0) continue;
    row[element.bends[i].parameter] +=
        by_place.dot(point.shifts_m[i]) + by_heading * point.turns[i];
  }
}

/// A plan's elements in their order, and one of no length at its end. The first `motions` are those
/// of the plan's beginning.
std::vector<Element> ElementsOf(const PlanModel& plan,
                                Eigen::Index first_length,
                                const std::vector<Eigen::Index>& curvatures,
                                const Eigen::VectorXd& rates) {
  Element element;
  element.heading_rad = plan.start.heading_rad;
  element.motions.setZero(3, rates.size());
  element.motions.leftCols(first_length).diagonal() = rates.head(first_length);
  std::vector<Element> elements;
  for (std::size_t i = 0; i < 2 * plan.plateaus.size() - 1; ++i) {
    const std::size_t plateau = i / 2;
    const bool is_clothoid = i % 2 == 1;
    const double length_m =
        is_clothoid ? plan.clothoids_m[plateau] : plan.ConstantLength_m(plateau);
    const auto bend_of = [&](std::size_t of, double at_begin, double growth) {
      const Eigen::Index parameter = curvatures[of];
      const double rate = parameter < 0 ? 0.0 : rates[parameter];
      return Bend{parameter, rate * at_begin, rate * growth};
    };
    element.curvature_per_m = plan.plateaus[plateau].curvature_per_m;
    element.slope_per_m2 = 0.0;
    const Eigen::Index length = first_length + static_cast<Eigen::Index>(i);
    if (is_clothoid) {
      element.slope_per_m2 =
          (plan.plateaus[plateau + 1].curvature_per_m - element.curvature_per_m) / length_m;
      element.bends = {bend_of(plateau, 1.0, -1.0 / length_m),
                       bend_of(plateau + 1, 0.0, 1.0 / length_m),
                       Bend{length, 0.0, -element.slope_per_m2 / length_m * rates[length]}};
    } else {
      element.bends = {bend_of(plateau, 1.0, 0.0)};
    }
    elements.push_back(element);

    const ElementPoint end = PointOf(element, length_m);
    const auto add_motion = [&](Eigen::Index parameter, const Eigen::Vector2d& shift_m,
                                double turn_rad) {
      element.motions.col(parameter).head<2>() += shift_m - turn_rad * LeftOf(end.place_m);
      element.motions(2, parameter) += turn_rad;
    };
    for (std::size_t b = 0; b < element.bends.size(); ++b) {
      if (element.bends[b].parameter < 0) continue;
      add_motion(element.bends[b].parameter, end.shifts_m[b], end.turns[b]);
    }
    add_motion(length, rates[length] * DirectionAt(end.heading_rad),
               rates[length] * end.curvature_per_m);
    element.begin_m += length_m;
    element.place_m = end.place_m;
    element.heading_rad = end.heading_rad;
    element.bends = {};
  }
  element.curvature_per_m = plan.plateaus.back().curvature_per_m;
  // The chainage of feet at the end, which is a sum in another order.
  element.begin_m = plan.length_m();
  elements.push_back(element);
  return elements;
}

}  // namespace

WindowResiduals::WindowResiduals(const PlanWindow& window)
    : window_(&window),
      longest_m_(LongestOf_m(window)),
      first_length_(window.begins_line ? 3 : 0),
      num_inputs_(first_length_ + 2 * static_cast<Eigen::Index>(window.plan.plateaus.size()) - 1),
      feet_m_(window.feet_m) {
  for (const bool is_fixed : window.has_fixed_curvature) {
    curvatures_.push_back(is_fixed ? -1 : num_inputs_++);
  }
}

Eigen::VectorXd WindowResiduals::Parameters() const {
  const PlanModel& plan = window_->plan;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(num_inputs_);
  for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
    const Eigen::Index length = LengthOf(i);
    values[length] = std::log(std::max(0.5, plan.ConstantLength_m(i)));
    if (i < plan.clothoids_m.size()) {
      values[length + 1] = std::log(std::max(0.5, plan.clothoids_m[i]));
    }
    if (curvatures_[i] < 0) continue;
    values[curvatures_[i]] = std::clamp(plan.plateaus[i].curvature_per_m / kCurvatureUnit_per_m,
                                        -0.9 * kSharpestTried, 0.9 * kSharpestTried);
  }
  return values;
}

PlanModel WindowResiduals::PlanOf(const Eigen::VectorXd& parameters) const {
  PlanModel plan = window_->plan;
  if (window_->begins_line) {
    plan.start.x_m += parameters[0];
    plan.start.y_m += parameters[1];
    plan.start.heading_rad += kHeadingUnit_rad * parameters[2];
  }
  Eigen::Index length = first_length_;
  const auto next_length_m = [&] {
    return std::exp(
        std::clamp(parameters[length++], std::log(kShortestTried_m), std::log(longest_m_)));
  };
  double clothoid_m = 0.0;
  for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
    Plateau& plateau = plan.plateaus[i];
    plateau.length_m = next_length_m() + 0.5 * clothoid_m;
    if (i < plan.clothoids_m.size()) {
      plan.clothoids_m[i] = clothoid_m = next_length_m();
      plateau.length_m += 0.5 * clothoid_m;
    }
    if (curvatures_[i] < 0) continue;
    plateau.curvature_per_m = kCurvatureUnit_per_m * std::clamp(parameters[curvatures_[i]],
                                                                -kSharpestTried, kSharpestTried);
  }
  return plan;
}

Eigen::VectorXd WindowResiduals::Rates(const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(num_inputs_);
  if (window_->begins_line) rates.head<3>() << 1.0, 1.0, kHeadingUnit_rad;
  const Eigen::Index num_elements = 2 * static_cast<Eigen::Index>(curvatures_.size()) - 1;
  for (Eigen::Index i = first_length_; i < first_length_ + num_elements; ++i) {
    const double length_m = std::exp(parameters[i]);
    if (length_m > kShortestTried_m && length_m < longest_m_) rates[i] = length_m;
  }
  for (const Eigen::Index i : curvatures_) {
    if (i >= 0 && std::abs(parameters[i]) < kSharpestTried) rates[i] = kCurvatureUnit_per_m;
  }
  return rates;
}

Eigen::Index WindowResiduals::values() const {
  return num_points() + 4 * static_cast<Eigen::Index>(curvatures_.size()) - 2 + kNumEndResiduals;
}

template <typename Add>
void WindowResiduals::VisitPriors(const PlanModel& plan, const Add& add) const {
  const double speed_kmph = window_->speed_kmph;
  const double shortest_m = UsualClothoid_m(speed_kmph, 0.0, 0.0);
  const double longest_m = UsualClothoid_m(speed_kmph, 0.0, kSharpestTried);
  for (std::size_t i = 0; i < plan.clothoids_m.size(); ++i) {
    const double clothoid_m = plan.clothoids_m[i];
    const double from_per_m = plan.plateaus[i].curvature_per_m;
    const double to_per_m = plan.plateaus[i + 1].curvature_per_m;
    const double usual_m = UsualClothoid_m(speed_kmph, from_per_m, to_per_m);
    // Between its limits, the usual length is proportional to the change of the curvature.
    const double growth =
        usual_m > shortest_m && usual_m < longest_m ? 1.0 / (to_per_m - from_per_m) : 0.0;
    const auto add_log = [&](double factor, double length_m) {
      add(factor * std::log(clothoid_m / length_m), {{LengthOf(i) + 1, factor / clothoid_m},
                                                     {curvatures_[i], factor * growth},
                                                     {curvatures_[i + 1], -factor * growth}});
    };
    add_log(2.0, usual_m);
    const double least_m = kLeastShareOfUsual * usual_m;
    if (speed_kmph > kFastLine_kmph && clothoid_m < least_m) {
      add_log(-5.0, least_m);
    } else {
      add(0.0, {});
    }
  }
  const double sharpest_per_m = SharpestCurvature_per_m(speed_kmph);
  for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
    const double constant_m = plan.ConstantLength_m(i);
    const double curvature_per_m = plan.plateaus[i].curvature_per_m;
    const bool is_short = constant_m < kShortestUsualPlateau_m;
    add(is_short ? std::log(kShortestUsualPlateau_m / constant_m) : 0.0,
        {{LengthOf(i), is_short ? -1.0 / constant_m : 0.0}});
    const bool is_sharp = std::abs(curvature_per_m) > sharpest_per_m;
    add(is_sharp ? 5.0 * std::log(std::abs(curvature_per_m) / sharpest_per_m) : 0.0,
        {{curvatures_[i], is_sharp ? 5.0 / curvature_per_m : 0.0}});
  }
}

int WindowResiduals::operator()(const Eigen::VectorXd& parameters,
                                Eigen::VectorXd& residuals) const {
  const PlanModel plan = PlanOf(parameters);
  const PlanCourse course = plan.Course();
  const double length_m = plan.length_m();
  residuals.setZero(values());
  Foot first;
  Foot last;
  num_feet_ += feet_m_.size();
  for (std::size_t i = 0; i < feet_m_.size(); ++i) {
    last = FootOn(course, length_m, window_->points_m[i], feet_m_[i]);
    feet_m_[i] = last.s_m;
    if (i == 0) first = last;
    residuals[static_cast<Eigen::Index>(i)] = Robust(last.offset_m / window_->sigma_m).residual;
  }
  Eigen::Index row = num_points();
  VisitPriors(plan, [&](double residual, const Slopes&) { residuals[row++] = residual; });
  auto ends = residuals.tail<kNumEndResiduals>();
  if (window_->begins_line) ends[0] = (first.s_m + first.beyond_m) / kLineEndTolerance_m;
  if (window_->ends_line) {
    ends[1] = (last.s_m + last.beyond_m - length_m) / kLineEndTolerance_m;
  } else {
    const PlanPoint end = course.At(length_m);
    ends[2] = (end.x_m - window_->end.x_m) / kEndTolerance_m;
    ends[3] = (end.y_m - window_->end.y_m) / kEndTolerance_m;
    ends[4] = (end.heading_rad - window_->end.heading_rad) / kEndTolerance_rad;
  }
  return 0;
}

int WindowResiduals::df(const Eigen::VectorXd& parameters, Eigen::MatrixXd& jacobian) const {
  const PlanModel plan = PlanOf(parameters);
  const Eigen::VectorXd rates = Rates(parameters);
  const std::vector<Element> elements = ElementsOf(plan, first_length_, curvatures_, rates);
  jacobian.setZero(values(), num_inputs_);
  Eigen::Index row = num_points();
  VisitPriors(plan, [&](double, const Slopes& slopes) {
    for (const auto& [parameter, slope] : slopes) {
      if (parameter >= 0) jacobian(row, parameter) = slope * rates[parameter];
    }
    ++row;
  });
  auto ends = jacobian.bottomRows<kNumEndResiduals>();
  const Eigen::Vector2d start_m(plan.start.x_m, plan.start.y_m);
  for (Eigen::Index i = 0; i < num_points(); ++i) {
    const double foot_m = feet_m_[static_cast<std::size_t>(i)];
    const auto element =
        std::upper_bound(elements.begin() + 1, elements.end(), foot_m,
                         [](double s_m, const Element& other) { return s_m < other.begin_m; }) -
        1;
    const ElementPoint foot = PointOf(*element, foot_m - element->begin_m);
    const Eigen::Vector2d ahead = DirectionAt(foot.heading_rad);
    const Eigen::Vector2d left = LeftOf(ahead);
    const Eigen::Vector2d to_point_m =
        window_->points_m[static_cast<std::size_t>(i)] - start_m - foot.place_m;
    const double offset_m = to_point_m.dot(left);
    AddDerivatives(*element, foot, -left, -to_point_m.dot(ahead), jacobian.row(i));
    jacobian.row(i) *= Robust(offset_m / window_->sigma_m).slope / window_->sigma_m;

    const Eigen::Index num_before = element - elements.begin();
    if (i == 0 && window_->begins_line) {
      AddDerivatives(*element, foot, -ahead, offset_m, ends.row(0));
      ends.row(0).segment(first_length_, num_before) +=
          rates.segment(first_length_, num_before).transpose();
      ends.row(0) /= kLineEndTolerance_m;
    }
    if (i == num_points() - 1 && window_->ends_line) {
      const auto num_left = static_cast<Eigen::Index>(elements.size()) - 1 - num_before;
      AddDerivatives(*element, foot, -ahead, offset_m, ends.row(1));
      ends.row(1).segment(first_length_ + num_before, num_left) -=
          rates.segment(first_length_ + num_before, num_left).transpose();
      ends.row(1) /= kLineEndTolerance_m;
    }
  }
  if (!window_->ends_line) {
    const ElementPoint end = PointOf(elements.back(), 0.0);
    AddDerivatives(elements.back(), end, Eigen::Vector2d::UnitX() / kEndTolerance_m, 0.0,
                   ends.row(2));
    AddDerivatives(elements.back(), end, Eigen::Vector2d::UnitY() / kEndTolerance_m, 0.0,
                   ends.row(3));
    AddDerivatives(elements.back(), end, Eigen::Vector2d::Zero(), 1.0 / kEndTolerance_rad,
                   ends.row(4));
  }
  return 0;
}

double PlanWindow::Fit() {
  constexpr Eigen::Index kMostEvaluations = 60;
  WindowResiduals residuals(*this);
  Eigen::LevenbergMarquardt<WindowResiduals> solver(residuals);
  solver.setMaxfev(kMostEvaluations);
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
