#include "generator/extras/import/fit/line_draft.h"

#include <algorithm>
#include <cmath>

#include "generator/extras/import/fit/plan_model.h"

namespace railcast {

LineDraft::LineDraft(std::span<const Eigen::Vector2d> points_m, const LinePrior& prior)
    : points_m_(points_m), prior_(prior), along_m_{0.0} {
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    along_m_.push_back(along_m_.back() + (points_m[i] - points_m[i - 1]).norm());
  }
  constexpr std::size_t kNumRefitted = 4;
  for (std::size_t begin = 0; begin + 1 < points_m.size();) {
    const Arc arc = LongestArc(begin, 2.0 * prior.sigma_m);
    Append(begin, arc);
    begin = arc.end;
    const std::size_t last = num_plateaus() - 1;
    Part part = PartOf(last >= kNumRefitted ? last - kNumRefitted + 1 : 0, last);
    part.window.Fit();
    num_feet_ += part.window.num_feet;
    Replace(part);
  }
}

LineDraft::Arc LineDraft::LongestArc(std::size_t begin, double tolerance_m) const {
  Arc longest{begin + 1, 0.0};
  for (std::size_t end = begin + 2; end < points_m_.size(); ++end) {
    const auto middle_m = 0.5 * (along_m_[begin] + along_m_[end]);
    const auto middle =
        std::lower_bound(along_m_.begin() + static_cast<std::ptrdiff_t>(begin) + 1,
                         along_m_.begin() + static_cast<std::ptrdiff_t>(end) - 1, middle_m) -
        along_m_.begin();
    const double curvature_per_m = CircleCurvature_per_m(
        points_m_[begin], points_m_[static_cast<std::size_t>(middle)], points_m_[end]);
    const Eigen::Vector2d chord_m = points_m_[end] - points_m_[begin];
    const double chord_length_m = chord_m.norm();
    double before_m = 0.0;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const Eigen::Vector2d to_point_m = points_m_[i] - points_m_[begin];
      const double x_m = to_point_m.dot(chord_m) / chord_length_m;
      const double y_m = CrossProduct(chord_m, to_point_m) / chord_length_m;
      // A line that turns back is no arc, and an arc's points lie between its ends.
      if (!(x_m > before_m && x_m < chord_length_m)) return longest;
      before_m = x_m;
      // The parabola through the chord's ends that has the circle's curvature.
      const double arc_y_m = -0.5 * curvature_per_m * x_m * (chord_length_m - x_m);
      if (!(std::abs(y_m - arc_y_m) < tolerance_m)) return longest;
    }
    longest = {end, curvature_per_m};
  }
  return longest;
}

void LineDraft::Append(std::size_t begin, const Arc& arc) {
  constexpr double kShortest_m = 8.0;
  const double length_m = std::max(kShortest_m, along_m_[arc.end] - along_m_[begin]);
  if (plan_.plateaus.empty()) {
    const Eigen::Vector2d chord_m = points_m_[arc.end] - points_m_[begin];
    plan_.start = {
        .x_m = points_m_[begin].x(),
        .y_m = points_m_[begin].y(),
        .heading_rad = std::atan2(chord_m.y(), chord_m.x()) - 0.5 * arc.curvature_per_m * length_m};
    feet_m_.push_back(0.0);
  } else {
    const Plateau& before = plan_.plateaus.back();
    const double usual_m = UsualClothoid_m(prior_.speed_kmph(along_m_[begin]),
                                           before.curvature_per_m, arc.curvature_per_m);
    plan_.clothoids_m.push_back(std::min({usual_m, 0.5 * length_m, 0.5 * before.length_m}));
  }
  plan_.plateaus.push_back({arc.curvature_per_m, length_m});
  for (std::size_t i = begin + 1; i <= arc.end; ++i) {
    feet_m_.push_back(plan_.length_m() - (along_m_[arc.end] - along_m_[i]));
  }
}

LineDraft::Part LineDraft::PartOf(std::size_t first, std::size_t last) const {
  Part part{first, last, {}, {}};
  PlanWindow& window = part.window;
  window.begins_line = first == 0;
  window.ends_line = last + 1 == num_plateaus();
  window.sigma_m = prior_.sigma_m;
  const double begin_m = window.begins_line ? 0.0 : MiddleOf_m(first);
  const double end_m = window.ends_line ? plan_.length_m() : MiddleOf_m(last);
  const PlanCourse course = plan_.Course();
  window.plan.start = course.At(begin_m);
  window.end = course.At(end_m);
  for (std::size_t i = first; i <= last; ++i) {
    Plateau plateau = plan_.plateaus[i];
    const bool is_half = (i == first && !window.begins_line) || (i == last && !window.ends_line);
    if (is_half) plateau.length_m -= 0.5 * plan_.ConstantLength_m(i);
    if (i == first && !window.begins_line) plateau.length_m -= 0.5 * plan_.clothoids_m[i - 1];
    if (i == last && !window.ends_line) plateau.length_m -= 0.5 * plan_.clothoids_m[i];
    window.plan.plateaus.push_back(plateau);
    // The other half of a plateau keeps its curvature, so this one must, too.
    window.has_fixed_curvature.push_back(is_half || plateau.curvature_per_m == 0.0);
    if (i < last) window.plan.clothoids_m.push_back(plan_.clothoids_m[i]);
  }
  double speed_kmph = 0.0;
  for (std::size_t i = 0; i < feet_m_.size(); ++i) {
    if (!window.begins_line && feet_m_[i] < begin_m) continue;
    if (!window.ends_line && feet_m_[i] >= end_m) continue;
    part.points.push_back(i);
    window.points_m.push_back(points_m_[i]);
    window.feet_m.push_back(feet_m_[i] - begin_m);
    speed_kmph += prior_.speed_kmph(along_m_[i]);
  }
  const auto num_points = static_cast<double>(window.points_m.size());
  window.speed_kmph = num_points > 0.0 ? speed_kmph / num_points : prior_.speed_kmph(begin_m);
  return part;
}

void LineDraft::Replace(const Part& part) {
  const PlanModel& fitted = part.window.plan;
  PlanModel next;
  next.start = part.window.begins_line ? fitted.start : plan_.start;
  const auto begin = [](auto& values) { return values.begin(); };
  const auto first = static_cast<std::ptrdiff_t>(part.first);
  const auto last = static_cast<std::ptrdiff_t>(part.last);
  next.plateaus.assign(begin(plan_.plateaus), begin(plan_.plateaus) + first);
  next.clothoids_m.assign(begin(plan_.clothoids_m), begin(plan_.clothoids_m) + first);
  for (Plateau plateau : fitted.plateaus) next.plateaus.push_back(plateau);
  next.clothoids_m.insert(next.clothoids_m.end(), fitted.clothoids_m.begin(),
                          fitted.clothoids_m.end());
  // The halves outside of the part stay.
  if (!part.window.begins_line) {
    next.plateaus[part.first].length_m +=
        0.5 * (plan_.ConstantLength_m(part.first) + plan_.clothoids_m[part.first - 1]);
  }
  if (!part.window.ends_line) {
    next.plateaus.back().length_m +=
        0.5 * (plan_.ConstantLength_m(part.last) + plan_.clothoids_m[part.last]);
    next.plateaus.insert(next.plateaus.end(), begin(plan_.plateaus) + last + 1,
                         plan_.plateaus.end());
    next.clothoids_m.insert(next.clothoids_m.end(), begin(plan_.clothoids_m) + last,
                            plan_.clothoids_m.end());
  }
  const std::vector<double> before_m = feet_m_;
  MoveFeet(part, next.length_m() - plan_.length_m());
  plan_ = std::move(next);
  const PlanCourse course = plan_.Course();
  for (const std::size_t i : part.points) {
    // As far from the foot of the point before as it was: the solver may have led feet astray.
    const double guess_m = i == 0 ? 0.0 : feet_m_[i - 1] + before_m[i] - before_m[i - 1];
    feet_m_[i] = FootOn(course, plan_.length_m(), points_m_[i], guess_m).s_m;
  }
  num_feet_ += part.points.size();
}

void LineDraft::MoveFeet(const Part& part, double longer_m) {
  const double end_m = part.window.ends_line ? plan_.length_m() : MiddleOf_m(part.last);
  for (double& foot_m : feet_m_) {
    if (foot_m >= end_m) foot_m += longer_m;
  }
}

}  // namespace railcast
