#include "generator/extras/import/fit/line_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "generator/extras/import/fit/line_draft.h"
#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/fit/plan_window.h"

namespace railcast {
namespace {

/// What one more parameter must lower the sum of squares by. The Bayesian information criterion
/// asks for ln(number of points), some 6; mapped points err together, and half as many elements
/// explain them nearly as well.
constexpr double kPrice = 10.0;
/// Distance of points, in units of sigma, within which an element explains them.
constexpr double kTolerance = 2.0;
/// A changed plateau is fitted with this many on either side.
constexpr std::size_t kReach = 2;

/// Arcs flatter than this are straights unless many points say otherwise.
constexpr double kFlat_per_m = 1.0 / 20e3;
/// The price of a radius so flat, once the line is found.
constexpr double kPriceOfFlatArc = 40.0;

bool IsFlatArc(const Plateau& plateau) {
  return plateau.curvature_per_m != 0.0 && std::abs(plateau.curvature_per_m) < kFlat_per_m;
}

double PriceOf(const PlanModel& plan, double price_of_flat_arc) {
  double price = kPrice * static_cast<double>(plan.plateaus.size() + plan.clothoids_m.size());
  for (const Plateau& plateau : plan.plateaus) {
    if (plateau.curvature_per_m == 0.0) continue;
    price += IsFlatArc(plateau) ? price_of_flat_arc : kPrice;
  }
  return price;
}

template <typename Value>
void Erase(std::vector<Value>& values, std::size_t i) {
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
}
template <typename Value>
void Insert(std::vector<Value>& values, std::size_t i, const Value& value) {
  values.insert(values.begin() + static_cast<std::ptrdiff_t>(i), value);
}

/// A plateau's neighbours take its place.
void Remove(PlanWindow& window, std::size_t i) {
  PlanModel& plan = window.plan;
  plan.plateaus[i - 1].length_m += 0.5 * plan.plateaus[i].length_m;
  plan.plateaus[i + 1].length_m += 0.5 * plan.plateaus[i].length_m;
  Erase(plan.plateaus, i);
  Erase(plan.clothoids_m, i);
  Erase(window.has_fixed_curvature, i);
  plan.clothoids_m[i - 1] = UsualClothoid_m(window.speed_kmph, plan.plateaus[i - 1].curvature_per_m,
                                            plan.plateaus[i].curvature_per_m);
}

/// A plateau and the next one become one.
void Join(PlanWindow& window, std::size_t i) {
  PlanModel& plan = window.plan;
  Plateau& plateau = plan.plateaus[i];
  const Plateau& next = plan.plateaus[i + 1];
  const double length_m = plateau.length_m + next.length_m;
  plateau = {(plateau.curvature_per_m * plateau.length_m + next.curvature_per_m * next.length_m) /
                 length_m,
             length_m};
  Erase(plan.plateaus, i + 1);
  Erase(plan.clothoids_m, i);
  Erase(window.has_fixed_curvature, i + 1);
  window.has_fixed_curvature[i] = false;
}

/// A plateau becomes two that turn by `turn_rad` more and less.
void Divide(PlanWindow& window, std::size_t i, double share, double turn_rad) {
  PlanModel& plan = window.plan;
  Plateau& plateau = plan.plateaus[i];
  const Plateau whole = plateau;
  plateau.length_m = share * whole.length_m;
  Plateau rest{whole.curvature_per_m, whole.length_m - plateau.length_m};
  plateau.curvature_per_m += turn_rad / plateau.length_m;
  rest.curvature_per_m -= turn_rad / rest.length_m;
  Insert(plan.plateaus, i + 1, rest);
  Insert(plan.clothoids_m, i, std::min(15.0, 0.25 * whole.length_m));
  window.has_fixed_curvature[i] = false;
  Insert(window.has_fixed_curvature, i + 1, false);
}

/// The change of a line about one plateau that gains most.
struct Change {
  double gain{};  ///< Not positive: none.
  LineDraft::Part part;
};

std::ptrdiff_t NumFlatArcs(const PlanModel& plan) {
  return std::ranges::count_if(plan.plateaus, IsFlatArc);
}

/// The distances of a window's points from its plan.
std::vector<double> DistancesOf_m(const PlanWindow& window) {
  const PlanCourse course = window.plan.Course();
  const double length_m = window.plan.length_m();
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < window.points_m.size(); ++i) {
    const Foot foot = FootOn(course, length_m, window.points_m[i], window.feet_m[i]);
    distances_m.push_back(std::abs(foot.offset_m));
  }
  return distances_m;
}
class ChangeSearch {
 public:
  ChangeSearch(const LineDraft& line, std::size_t plateau, double price_of_flat_arc)
      : price_of_flat_arc_(price_of_flat_arc),
        before_(line.PartOf(plateau >= kReach ? plateau - kReach : 0,
                            std::min(line.num_plateaus() - 1, plateau + kReach))),
        at_(plateau - before_.first) {}

  /// Whether an arc of the part is flat.
  [[nodiscard]] bool HasFlatArc() const {
    return std::ranges::any_of(before_.window.plan.plateaus, IsFlatArc);
  }
  [[nodiscard]] Change BestChange() {
    cost_ = before_.window.Fit() + PriceOf(before_.window.plan, price_of_flat_arc_);
    const std::size_t num_plateaus = before_.window.plan.plateaus.size();
    if (!before_.window.has_fixed_curvature[at_]) {
      Try([&](PlanWindow& window) {
        window.plan.plateaus[at_].curvature_per_m = 0.0;
        window.has_fixed_curvature[at_] = true;
      });
    }
    if (at_ > 0 && at_ + 1 < num_plateaus) {
      Try([&](PlanWindow& window) { Remove(window, at_); });
    }
    if (at_ + 1 < num_plateaus && IsWhole(at_) && IsWhole(at_ + 1)) {
      Try([&](PlanWindow& window) { Join(window, at_); });
    }
    if (IsWhole(at_)) TryDivisions();
    return best_;
  }

  /// The cheapest change with fewer flat arcs that leaves no point farther off than a tolerance, or
  /// than it was before; absent if there is none.
  [[nodiscard]] std::optional<LineDraft::Part> WithFewerFlatArcs(double tolerance_m) {
    const std::vector<double> before_m = DistancesOf_m(before_.window);
    const auto leaves_points = [&](const PlanWindow& window) {
      return !std::ranges::equal(DistancesOf_m(window), before_m, [&](double now_m, double was_m) {
        return now_m <= std::max(tolerance_m, was_m);
      });
    };
    const std::ptrdiff_t num_flat = NumFlatArcs(before_.window.plan);
    std::optional<LineDraft::Part> best;
    double least_cost = 0.0;
    const auto consider = [&](const auto& work) {
      LineDraft::Part part = before_;
      work(part.window);
      const double cost = part.window.Fit() + PriceOf(part.window.plan, price_of_flat_arc_);
      if (NumFlatArcs(part.window.plan) >= num_flat || leaves_points(part.window)) return;
      if (best && cost >= least_cost) return;
      best = std::move(part);
      least_cost = cost;
    };
    const auto straighten = [](PlanWindow& window, std::size_t i) {
      window.plan.plateaus[i].curvature_per_m = 0.0;
      window.has_fixed_curvature[i] = true;
    };
    const std::size_t num_plateaus = before_.window.plan.plateaus.size();
    consider([&](PlanWindow& window) { straighten(window, at_); });
    if (at_ > 0 && at_ + 1 < num_plateaus) {
      consider([&](PlanWindow& window) { Remove(window, at_); });
    }
    for (std::size_t first = at_ - std::min<std::size_t>(at_, 1); first <= at_; ++first) {
      if (first + 1 >= num_plateaus || !IsWhole(first) || !IsWhole(first + 1)) continue;
      consider([&](PlanWindow& window) {
        Join(window, first);
        straighten(window, first);
      });
    }
    return best;
  }

 private:
  [[nodiscard]] bool IsWhole(std::size_t i) const {
    return (i > 0 || before_.window.begins_line) &&
           (i + 1 < before_.window.plan.plateaus.size() || before_.window.ends_line);
  }
  template <typename Work>
  void Try(const Work& work) {
    LineDraft::Part part = before_;
    work(part.window);
    const double cost = part.window.Fit() + PriceOf(part.window.plan, price_of_flat_arc_);
    const double gain = cost_ - cost;
    if (gain > best_.gain) best_ = {gain, std::move(part)};
  }
  void TryDivisions() {
    const PlanWindow& window = before_.window;
    const double begin_m = window.plan.ConstantBegin_m(at_);
    const double length_m = window.plan.ConstantLength_m(at_);
    constexpr double kShortest_m = 60.0;
    if (length_m < kShortest_m) return;
    const PlanCourse course = window.plan.Course();
    const double line_m = window.plan.length_m();
    double worst_m = 0.0;
    double worst_s_m = 0.0;
    for (std::size_t i = 0; i < window.points_m.size(); ++i) {
      const Foot foot = FootOn(course, line_m, window.points_m[i], window.feet_m[i]);
      const double inside_m = foot.s_m - begin_m;
      if (inside_m < 0.1 * length_m || inside_m > 0.9 * length_m) continue;
      if (std::abs(foot.offset_m) <= std::abs(worst_m)) continue;
      worst_m = foot.offset_m;
      worst_s_m = foot.s_m;
    }
    if (std::abs(worst_m) < kTolerance * window.sigma_m) return;
    const double share = (worst_s_m - begin_m) / length_m;
    const double turn_rad = 4.0 * std::abs(worst_m) / length_m;
    Try([&](PlanWindow& changed) { Divide(changed, at_, share, turn_rad); });
    Try([&](PlanWindow& changed) { Divide(changed, at_, share, -turn_rad); });
  }

  double price_of_flat_arc_;
  LineDraft::Part before_;
  std::size_t at_;
  double cost_{};
  Change best_;
};

/// A change that gains less is not worth its time, and might be undone by the next one.
constexpr double kLeastGain = 0.5;

/// Makes changes until none gains. Each lowers the cost, but only of the part that it fits anew, so
/// that a limit sees to the end. Where flat arcs have a price of their own, only what is near one
/// is changed.
void Improve(LineDraft& line, double price_of_flat_arc, const TellShare& tell) {
  std::vector<std::optional<Change>> changes(line.num_plateaus());
  const std::size_t most_changes = 10 * line.num_plateaus() + 100;
  // Among the first arcs, usually one in two is changed, and each change is followed by five
  // searches.
  const double usual_searches = 3.5 * static_cast<double>(line.num_plateaus());
  double num_searches = 0.0;
  const auto search = [&](std::size_t plateau) {
    ChangeSearch about(line, plateau, price_of_flat_arc);
    ++num_searches;
    if (tell) tell(num_searches / std::max(usual_searches, num_searches + 1.0));
    return price_of_flat_arc == kPrice || about.HasFlatArc() ? about.BestChange() : Change{};
  };
  for (std::size_t num_changes = 0; num_changes < most_changes; ++num_changes) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      if (!changes[i]) changes[i] = search(i);
      if (changes[i]->gain > changes[best]->gain) best = i;
    }
    if (!(changes[best]->gain >= kLeastGain)) return;
    const std::size_t num_before = line.num_plateaus();
    const LineDraft::Part part = std::move(changes[best]->part);
    line.Replace(part);

    // Searches whose parts do not touch the changed one still hold; their numbers move with it.
    std::vector<std::optional<Change>> kept(line.num_plateaus());
    for (std::size_t i = 0; i < changes.size(); ++i) {
      if (i + kReach < part.first) {
        kept[i] = std::move(changes[i]);
      } else if (i > part.last + kReach) {
        const std::size_t moved = i + line.num_plateaus() - num_before;
        kept[moved] = std::move(changes[i]);
        kept[moved]->part.first += line.num_plateaus() - num_before;
        kept[moved]->part.last += line.num_plateaus() - num_before;
      }
    }
    changes = std::move(kept);
  }
}

/// Makes flat arcs straight wherever no point is then farther off than a tolerance, or than it was
/// before. Each change leaves fewer of them.
void StraightenFlatArcs(LineDraft& line, double tolerance_m) {
  for (std::size_t i = 0; i < line.num_plateaus();) {
    std::optional<LineDraft::Part> part;
    if (IsFlatArc(line.plan().plateaus[i])) {
      part = ChangeSearch(line, i, kPriceOfFlatArc).WithFewerFlatArcs(tolerance_m);
    }
    if (part) line.Replace(*part);
    // What was not possible before may be now, but only beside a change.
    i = part ? i - std::min(i, 2 * kReach) : i + 1;
  }
}

}  // namespace

LineFit MeasureFit(const PlanModel& plan,
                   std::span<const Eigen::Vector2d> points_m,
                   std::span<const double> guesses_m) {
  LineFit fit{plan, {}, {}};
  const PlanCourse course = plan.Course();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Foot foot = FootOn(course, plan.length_m(), points_m[i], guesses_m[i]);
    fit.chainages_m.push_back(foot.s_m);
    fit.offsets_m.push_back(std::copysign(std::hypot(foot.offset_m, foot.beyond_m), foot.offset_m));
  }
  return fit;
}

LineFit FitLine(std::span<const Eigen::Vector2d> points_m,
                const LinePrior& prior,
                const TellShare& tell) {
  Check(points_m.size() >= 2, "a line has two points or more");
  LineDraft line(points_m, prior);
  Improve(line, kPrice, tell);
  // Only now, since a line that is not found yet has flat arcs where it will have none.
  Improve(line, kPriceOfFlatArc, {});
  StraightenFlatArcs(line, kTolerance * prior.sigma_m);
  return MeasureFit(line.plan(), points_m, line.feet_m());
}

}  // namespace railcast
