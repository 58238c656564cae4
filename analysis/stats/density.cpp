#include "analysis/stats/statistics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/units.h"
#include "core/io/recording/firing_truth.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

/// Adds to the curve of a key; the map is only searched when the key changes.
template <typename Key>
void AddToBand(std::map<Key, Density::Curve>& curves,
               const Key& key,
               double range_m,
               const Density::Count& count) {
  const auto bin = FineRangeBins().Find(range_m);
  if (!bin) return;
  Density::Curve& curve = curves[key];
  curve.resize(FineRangeBins().size());
  AddTo(curve[*bin], count);
}

Vector3 PointIn(const Frame& frame, std::size_t row, std::size_t column) {
  const std::size_t slot = row * frame.width() + column * frame.returns;
  return {static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
          static_cast<double>(frame.z[slot])};
}

/// The range halfway between two points if they lie on a plane: 1 / range is
/// then linear in the angles. NaN if one of the points is missing.
double HalfwayRange_m(const Vector3& one, const Vector3& other) {
  return 2.0 / (1.0 / one.norm() + 1.0 / other.norm());
}

/// A firing of the grid and the surface around it.
struct Place {
  Vector3 area_m2;   ///< Area that it represents, along the surface's normal.
  double range_m{};  ///< Range of the surface as its neighbours imply.
  bool has_point{};
};

/// Returns nothing unless all four neighbours exist on one surface, or if the firing met another
/// surface in front of it.
/// @pre The firing is not in the first or last row or column.
std::optional<Place> LookAtPoint(const Frame& frame,
                                 const ScanTable& scan,
                                 std::size_t row,
                                 std::size_t column) {
  constexpr double kTolerance = 0.05;
  const Vector3 left = PointIn(frame, row, column - 1);
  const Vector3 right = PointIn(frame, row, column + 1);
  const auto column_below = scan.ColumnBeside(row, column, row - 1);
  const auto column_above = scan.ColumnBeside(row, column, row + 1);
  if (!column_below || !column_above) return std::nullopt;
  const Vector3 below = PointIn(frame, row - 1, *column_below);
  const Vector3 above = PointIn(frame, row + 1, *column_above);
  const double range_m = HalfwayRange_m(left, right);
  const auto is_near = [range_m](double other_m) {
    return std::abs(other_m / range_m - 1.0) < kTolerance;
  };
  if (!is_near(HalfwayRange_m(below, above))) return std::nullopt;
  const double own_m = PointIn(frame, row, column).norm();
  const bool has_point = std::isfinite(own_m);
  if (has_point && !is_near(own_m)) return std::nullopt;
  return Place{0.5 * (right - left).cross(0.5 * (above - below)), range_m, has_point};
}

std::string AttitudeOf(const Vector3& normal) {
  constexpr double kLevel_rad = RadFromDeg(20.0);
  constexpr double kUpright_rad = RadFromDeg(70.0);
  const double tilt_rad = std::acos(std::min(1.0, std::abs(normal.normalized().z())));
  if (tilt_rad < kLevel_rad) return "level";
  return tilt_rad > kUpright_rad ? "upright" : "slanted";
}

using NamedCurves = std::vector<std::pair<std::string, const Density::Curve*>>;

std::uint64_t NumPoints(const Density::Curve& curve) {
  std::uint64_t sum = 0;
  for (const Density::Count& count : curve) sum += count.num_points;
  return sum;
}

Table LawTable(const NamedCurves& curves) {
  Table table = TableOf(kStatsWords, "density_laws");
  for (const auto& [name, curve] : curves) {
    const PowerLaw law = Density::LawOf(*curve);
    constexpr double kReference_m = 10.0;
    table.rows.push_back({name, NumPoints(*curve), law.exponent, law.At(kReference_m)});
  }
  return table;
}

Table CurveTable(const NamedCurves& curves) {
  Table table = TableOf(kStatsWords, "density_by_range");
  for (const auto& [name, curve] : curves) {
    for (std::size_t i = 0; i < curve->size(); ++i) {
      const Density::Count& count = (*curve)[i];
      if (count.num_points == 0) continue;
      table.rows.push_back({name, count.range_m(), count.area_m2,
                            PoissonRate(count.num_points, count.area_m2),
                            PoissonRate(count.num_points, count.solid_angle_sr)});
    }
  }
  return table;
}

// Charts the curves with most points; more would hide each other.
Chart CurveChart(NamedCurves curves) {
  constexpr std::size_t kMaxSeries = 6;
  std::stable_sort(curves.begin(), curves.end(), [](const auto& a, const auto& b) {
    return NumPoints(*a.second) > NumPoints(*b.second);
  });
  if (curves.size() > kMaxSeries) curves.resize(kMaxSeries);
  return ChartOfTable(kStatsWords, "density_by_range", CurveTable(curves));
}

}  // namespace

PowerLaw Density::LawOf(const Curve& curve) {
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Count& count = curve[i];
    if (count.num_points < kMinSamples || !(count.area_m2 > 0.0)) continue;
    const auto num = static_cast<double>(count.num_points);
    points.push_back({count.range_m(), num / count.area_m2, 1.0 / std::sqrt(num)});
  }
  return FitPowerLaw(points);
}

void Density::Add(const RecordedFrame& recorded, const ScanTable* scan) {
  if (!recorded.is_grid || scan == nullptr) return;
  const bool has_truth = HasOutcomes(recorded) && recorded.Has("label") &&
                         recorded.Has("true_range_m") && recorded.Has("incidence_rad");
  if (has_truth) {
    AddFromTruth(recorded, *scan);
  } else {
    AddFromPoints(recorded.frame, *scan);
  }
}

void Density::AddFromTruth(const RecordedFrame& recorded, const ScanTable& scan) {
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    if (!KnowsSurface(frame, slot)) continue;
    const double solid_angle_sr = scan.SolidAngle_sr(slot / frame.width());
    const double range_m = static_cast<double>(frame.true_range_m[slot]);
    const double cosine = std::cos(static_cast<double>(frame.incidence_rad[slot]));
    // The area of a surface seen edge-on is undefined.
    constexpr double kLeastCosine = 1e-4;
    if (!(solid_angle_sr > 0.0) || !(cosine > kLeastCosine)) continue;
    AddToBand(by_label_, frame.label[slot], range_m,
              {1, frame.outcome[slot] == Outcome::kReturned ? 1U : 0U,
               solid_angle_sr * range_m * range_m / cosine, solid_angle_sr, std::log(range_m)});
  }
}

void Density::AddFromPoints(const Frame& frame, const ScanTable& scan) {
  for (std::size_t row = 1; row + 1 < frame.rows; ++row) {
    const double solid_angle_sr = scan.SolidAngle_sr(row);
    if (!(solid_angle_sr > 0.0)) continue;
    for (std::size_t column = 1; column + 1 < frame.columns; ++column) {
      const auto place = LookAtPoint(frame, scan, row, column);
      if (!place || !(place->area_m2.norm() > 0.0)) continue;
      AddToBand(by_attitude_, AttitudeOf(place->area_m2), place->range_m,
                {1, place->has_point ? 1U : 0U, place->area_m2.norm(), solid_angle_sr,
                 std::log(place->range_m)});
    }
  }
}

Section Density::MakeSection(const Names& names) const {
  Section section =
      SectionOf(kStatsWords, "density",
                {{"by_label", !by_label_.empty()}, {"by_attitude", !by_attitude_.empty()}});
  NamedCurves curves;
  for (const auto& [label, curve] : by_label_) curves.emplace_back(names.OfLabel(label), &curve);
  for (const auto& [attitude, curve] : by_attitude_) curves.emplace_back(attitude, &curve);
  section.tables = {LawTable(curves), CurveTable(curves)};
  section.charts = {CurveChart(curves)};
  return section;
}

}  // namespace railcast
