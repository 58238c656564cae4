#include "generator/extras/import/lines/imported_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/rail/line/plan_course.h"
#include "generator/extras/import/fit/line_fit.h"
#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/lines/line_tags.h"
#include "generator/extras/import/lines/speed_limits.h"

namespace railcast {
namespace {

constexpr double kContradiction_m = 1.5;

/// The points of a line with what belongs to them.
struct LinePoints {
  std::vector<Eigen::Vector2d> places_m;
  std::vector<double> along_m;
  std::vector<StepSpeed> speeds;  ///< Behind each point but the last one.
  /// As many; where the map has none, no more than the curves allow.
  std::vector<double> built_for_kmph;
};

LinePoints PointsOf(const RailMap& map, const TrackLine& line, double running_kmph) {
  LinePoints points;
  for (const std::size_t node : line.nodes) {
    const Eigen::Vector2d& place_m = map.nodes[node].place_m;
    const double step_m = points.places_m.empty() ? 0.0 : (place_m - points.places_m.back()).norm();
    points.along_m.push_back(points.along_m.empty() ? 0.0 : points.along_m.back() + step_m);
    points.places_m.push_back(place_m);
  }
  points.speeds = SpeedsAlong(map, line, running_kmph);
  points.built_for_kmph = SpeedsOfCurves_kmph(points.places_m, points.along_m);
  for (std::size_t i = 0; i < points.speeds.size(); ++i) {
    const StepSpeed& speed = points.speeds[i];
    double& built_for_kmph = points.built_for_kmph[i];
    built_for_kmph =
        speed.is_mapped ? speed.speed_kmph : std::min(built_for_kmph, speed.speed_kmph);
  }
  return points;
}

/// Counts how often a sequence of curvatures changes its sign; straights do not count.
class SignChanges {
 public:
  void Add(double curvature) {
    if (curvature * last_ < 0.0) ++num_;
    if (curvature != 0.0) last_ = curvature;
  }
  [[nodiscard]] double PerKm(double length_m) const { return 1e3 * num_ / length_m; }

 private:
  int num_ = 0;
  double last_ = 0.0;
};

/// The last of ascending values, but not the very last one, that is at most `value`; the first one
/// if none is.
std::size_t StepAt(const std::vector<double>& values, double value) {
  const auto after = std::ranges::upper_bound(values, value);
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 2;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - values.begin() - 1, 0, last));
}

struct Wiggles {
  double tightest_radius_m{};  ///< 0 for a cusp.
  double sign_changes_per_km{};
};

Wiggles WigglesOfSpline(const std::vector<Eigen::Vector2d>& places_m) {
  constexpr double kStep_m = 2.0;
  ErrorList faults;
  const PlanSpline spline(places_m, faults);
  // With a cusp, which is a fault, the spline cannot be evaluated: its points can.
  Wiggles wiggles{faults.empty() ? spline.tightest_radius_m() : 0.0, 0.0};
  double length_m = 0.0;
  SignChanges changes;
  if (faults.empty()) {
    length_m = spline.length_m();
    for (double s_m = 0.0; s_m < length_m; s_m += kStep_m) {
      changes.Add(spline.At(s_m).curvature_per_m);
    }
  } else {
    for (std::size_t i = 1; i < places_m.size(); ++i) {
      const Eigen::Vector2d to_m = places_m[i] - places_m[i - 1];
      length_m += to_m.norm();
      if (i + 1 == places_m.size()) break;
      const Eigen::Vector2d next_m = places_m[i + 1] - places_m[i];
      changes.Add(to_m.x() * next_m.y() - to_m.y() * next_m.x());
    }
  }
  wiggles.sign_changes_per_km = changes.PerKm(length_m);
  return wiggles;
}

/// The middle and the size of the sharpest arc.
std::pair<double, double> SharpestOf(const PlanModel& plan) {
  double sharpest_per_m = 0.0;
  double s_m = 0.0;
  for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
    const double curvature_per_m = std::abs(plan.plateaus[i].curvature_per_m);
    if (curvature_per_m <= sharpest_per_m) continue;
    sharpest_per_m = curvature_per_m;
    s_m = plan.ConstantBegin_m(i) + 0.5 * plan.ConstantLength_m(i);
  }
  return {s_m, sharpest_per_m};
}

LineQuality QualityOf(const LinePoints& points,
                      const LineFit& fit,
                      const std::vector<ChainageValue>& limits_kmph) {
  std::vector<double> distances_m;
  for (const double offset_m : fit.offsets_m) distances_m.push_back(std::abs(offset_m));
  std::ranges::sort(distances_m);
  LineQuality quality;
  quality.num_points = points.places_m.size();
  quality.num_elements = fit.plan.Elements().size();
  quality.length_m = fit.plan.length_m();
  quality.median_m = QuantileOf(distances_m, 0.5);
  quality.p99_m = QuantileOf(distances_m, 0.99);
  quality.largest_m = distances_m.back();

  const Wiggles before = WigglesOfSpline(points.places_m);
  quality.tightest_radius_before_m = before.tightest_radius_m;
  quality.sign_changes_before_per_km = before.sign_changes_per_km;
  const auto [s_m, sharpest_per_m] = SharpestOf(fit.plan);
  quality.tightest_radius_m =
      sharpest_per_m > 0.0 ? 1.0 / sharpest_per_m : std::numeric_limits<double>::infinity();
  quality.needed_radius_m = 1.0 / SharpestCurvature_per_m(SpeedAt_kmph(limits_kmph, s_m));

  SignChanges changes;
  for (const Plateau& plateau : fit.plan.plateaus) changes.Add(plateau.curvature_per_m);
  quality.sign_changes_per_km = changes.PerKm(quality.length_m);
  return quality;
}

}  // namespace

double QuantileOf(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

ImportedLine ImportLine(const RailMap& map,
                        const TrackLine& line,
                        const ImportOptions& options,
                        const TellShare& tell) {
  const LinePoints points = PointsOf(map, line, options.otherwise_kmph);
  const auto speed_kmph = [&](double along_m) {
    return points.built_for_kmph[StepAt(points.along_m, along_m)];
  };
  const LineFit exact =
      FitLine(points.places_m, {.sigma_m = options.sigma_m, .speed_kmph = speed_kmph}, tell);

  ImportedLine imported;
  imported.name = line.name;
  AlignmentSpec& alignment = imported.alignment;
  const std::vector<AlignmentElement> elements = exact.plan.Elements();
  alignment.course = AlignmentElementsSpec{elements};
  alignment.attribution = map.attribution;
  alignment.gauge_mm = GaugeAlong_mm(map, line);
  constexpr double kPlaceSteps_per_m = 1e4;
  constexpr double kHeadingSteps_per_deg = 1e9;
  constexpr double kDegPerRad = 180.0 / std::numbers::pi;
  PlanPoint start = exact.plan.start;
  start.x_m = RoundedTo(start.x_m, kPlaceSteps_per_m);
  start.y_m = RoundedTo(start.y_m, kPlaceSteps_per_m);
  alignment.origin_m = {start.x_m, start.y_m, 0.0};
  alignment.heading_deg =
      RoundedTo(std::remainder(start.heading_rad, 2.0 * std::numbers::pi) * kDegPerRad,
                kHeadingSteps_per_deg);
  start.heading_rad = alignment.heading_deg / kDegPerRad;
  // Measured on what is written.
  const LineFit fit = MeasureFit(PlanOf(start, elements), points.places_m, exact.chainages_m);
  alignment.speed_limits_kmph = SpeedLimitsOf(points.speeds, fit.chainages_m, fit.plan);
  // Finds what an alignment refuses before anything is written.
  AtPlace("line " + line.name + ": ", [&] { return Alignment(alignment); });
  imported.quality = QualityOf(points, fit, alignment.speed_limits_kmph);
  imported.chainages_m = fit.chainages_m;
  imported.offsets_m = fit.offsets_m;
  imported.height_sigma_m = options.height_sigma_m;
  for (std::size_t i = 0; i < fit.offsets_m.size(); ++i) {
    if (std::abs(fit.offsets_m[i]) <= kContradiction_m) continue;
    imported.contradictions.push_back(
        {fit.chainages_m[i], fit.offsets_m[i], map.nodes[line.nodes[i]].geographic_deg});
  }
  return imported;
}

}  // namespace railcast
