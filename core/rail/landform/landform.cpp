#include "core/rail/landform/landform.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/chunk/chunk_context.h"

namespace railcast {
namespace {

struct AxisInPlan {
  Eigen::Vector2d place_m;
  Eigen::Vector2d left;
  double curvature_per_m{};
};

/// Points of the axis by the cells of a square grid as wide as the farthest that one looks. Of a
/// line that coils up, a cell holds only some, so that a search takes limited time.
class AxisIndex {
 public:
  AxisIndex(const std::vector<AxisInPlan>& points, double cell_m)
      : points_(points), cell_m_(cell_m) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [column, row] = CellOf(points[i].place_m);
      cells_[KeyOf(column, row)].push_back(i);
    }
    constexpr std::size_t kMostVisits = 200'000'000;
    const std::size_t most = std::max<std::size_t>(20, kMostVisits / points.size());
    for (auto& [key, cell] : cells_) {
      const std::size_t step = 1 + cell.size() / most;
      if (step == 1) continue;
      std::vector<std::size_t> fewer;
      for (std::size_t i = 0; i < cell.size(); i += step) fewer.push_back(cell[i]);
      cell = std::move(fewer);
    }
  }

  /// Calls `visit(point)` for all points within a cell's width, and for some that are farther away.
  template <class Visit>
  void ForEachNear(const Eigen::Vector2d& place_m, const Visit& visit) const {
    const auto [column, row] = CellOf(place_m);
    for (std::int64_t i = column - 1; i <= column + 1; ++i) {
      for (std::int64_t j = row - 1; j <= row + 1; ++j) {
        const auto found = cells_.find(KeyOf(i, j));
        if (found == cells_.end()) continue;
        for (const std::size_t point : found->second) visit(points_[point]);
      }
    }
  }

 private:
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> CellOf(const Eigen::Vector2d& place_m) const {
    return {static_cast<std::int64_t>(std::floor(place_m.x() / cell_m_)),
            static_cast<std::int64_t>(std::floor(place_m.y() / cell_m_))};
  }
  static std::uint64_t KeyOf(std::int64_t column, std::int64_t row) {
    return (static_cast<std::uint64_t>(column) << 32U) ^
           (static_cast<std::uint64_t>(row) & 0xffffffffU);
  }

  const std::vector<AxisInPlan>& points_;
  double cell_m_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

std::vector<AxisInPlan> SampledAxis(const Alignment& alignment) {
  const auto num_steps =
      static_cast<std::size_t>(std::ceil(alignment.length_m() / StripWidth::kStep_m));
  std::vector<AxisInPlan> points;
  for (std::size_t i = 0; i <= num_steps; ++i) {
    const AxisPoint axis = alignment.At(static_cast<double>(i) * StripWidth::kStep_m);
    points.push_back({axis.position_m.head<2>(),
                      {-std::sin(axis.heading_rad), std::cos(axis.heading_rad)},
                      axis.curvature_per_m});
  }
  return points;
}

/// The least of each value and its neighbours up to `reach` away, and then their mean over as many:
/// smoother, and nowhere greater.
std::vector<double> SmoothedBelow(const std::vector<double>& values, std::size_t reach) {
  const auto over = [&](const std::vector<double>& of, const auto& fold) {
    std::vector<double> result;
    for (std::size_t i = 0; i < of.size(); ++i) {
      const std::size_t first = i - std::min(i, reach);
      const std::size_t last = std::min(i + reach, of.size() - 1);
      result.push_back(fold(of.begin() + static_cast<std::ptrdiff_t>(first),
                            of.begin() + static_cast<std::ptrdiff_t>(last) + 1));
    }
    return result;
  };
  const auto least =
      over(values, [](auto begin, auto end) { return *std::min_element(begin, end); });
  return over(least, [](auto begin, auto end) {
    double sum = 0.0;
    for (auto it = begin; it != end; ++it) sum += *it;
    return sum / static_cast<double>(end - begin);
  });
}

/// @param side 1 for the left, -1 for the right.
std::vector<double> GroundReaches_m(const std::vector<AxisInPlan>& points,
                                    const AxisIndex& index,
                                    double half_width_m,
                                    double side) {
  std::vector<double> reaches_m;
  for (const AxisInPlan& point : points) {
    double reach_m = half_width_m;
    if (side * point.curvature_per_m > 0.0) {
      reach_m = std::min(reach_m, StripWidth::kShareOfRadius / (side * point.curvature_per_m));
    }
    index.ForEachNear(point.place_m, [&](const AxisInPlan& other) {
      const Eigen::Vector2d across_m = other.place_m - point.place_m;
      const double aside_m = side * across_m.dot(point.left);
      // The circle through the other point that touches the axis here has a radius of
      // |across|^2 / (2 aside). On a straight, rounding leaves some 1e-9 m aside.
      if (aside_m < 1e-6) return;
      reach_m =
          std::min(reach_m, StripWidth::kShareOfRadius * across_m.squaredNorm() / (2.0 * aside_m));
    });
    reaches_m.push_back(reach_m);
  }
  constexpr double kMost_m = StripWidth::kNarrowing * StripWidth::kStep_m;
  for (std::size_t i = 1; i < reaches_m.size(); ++i) {
    reaches_m[i] = std::min(reaches_m[i], reaches_m[i - 1] + kMost_m);
  }
  for (std::size_t i = reaches_m.size() - 1; i > 0; --i) {
    reaches_m[i - 1] = std::min(reaches_m[i - 1], reaches_m[i] + kMost_m);
  }
  constexpr std::size_t kSmoothing = 4;  // Steps to either side.
  return SmoothedBelow(reaches_m, kSmoothing);
}

bool IsGroundCovered(const DemHeights& elevation,
                     const AxisPoint& axis,
                     double right_m,
                     double left_m,
                     double step_m) {
  const Eigen::Vector2d left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad));
  const auto num_steps = static_cast<int>(std::ceil((right_m + left_m) / step_m));
  for (int i = 0; i <= num_steps; ++i) {
    const double d_m = std::lerp(-right_m, left_m, static_cast<double>(i) / num_steps);
    if (!elevation.Covers(axis.position_m.head<2>() + d_m * left)) return false;
  }
  return true;
}

// What permits the coarser forms of a chunk (docs/results/detail.md). Ballast has cells of up to
// 0.48 m across in the first, 2.5 spacings; along the track, where it is as fine as ever, most
// beams run. Beams that are narrower than the spacing find the ground's edges behind its bumps:
// their width counts, too.
constexpr double kCoarseRaySpacings_m[kMostCoarse] = {0.19,
                                                      std::numeric_limits<double>::infinity()};
constexpr double kCoarseBeamWidth_m = 0.2;
constexpr double kCoarseSightAngle_rad = 0.5;

}  // namespace

StripWidth::StripWidth(const Alignment& alignment, double half_width_m)
    : half_width_m_(half_width_m), least_m_(half_width_m) {
  if (half_width_m < alignment.tightest_radius_m()) return;
  const std::vector<AxisInPlan> points = SampledAxis(alignment);
  // A circle that is to narrow the strip has a radius of at most half_width / kShareOfRadius, and
  // its points are at most twice as far away.
  const AxisIndex index(points, 2.0 * half_width_m / kShareOfRadius);
  left_m_ = GroundReaches_m(points, index, half_width_m, 1.0);
  right_m_ = GroundReaches_m(points, index, half_width_m, -1.0);
  for (const auto* reaches_m : {&left_m_, &right_m_}) {
    least_m_ = std::min(least_m_, *std::min_element(reaches_m->begin(), reaches_m->end()));
  }
}

double StripWidth::At(double s_m, double side) const {
  if (!narrows()) return half_width_m_;
  const std::vector<double>& reaches_m = side > 0.0 ? left_m_ : right_m_;
  const double steps = std::clamp(s_m / kStep_m, 0.0, static_cast<double>(reaches_m.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(steps), reaches_m.size() - 2);
  return std::lerp(reaches_m[before], reaches_m[before + 1], steps - static_cast<double>(before));
}

DemHeights::DemHeights(const ElevationSpec& spec)
    : grid_(std::make_shared<const ElevationGrid>(spec.file)), origin_m_(spec.origin_m) {}

double DemHeights::Height_m(const Eigen::Vector2d& place_m) const {
  return grid_->Height_m(place_m.x() + origin_m_[0], place_m.y() + origin_m_[1]) - origin_m_[2];
}

bool DemHeights::Covers(const Eigen::Vector2d& place_m) const {
  return grid_->Covers(place_m.x() + origin_m_[0], place_m.y() + origin_m_[1]);
}

std::optional<std::string> CoverageFault(const DemHeights& elevation,
                                         const Alignment& alignment,
                                         const StripWidth& width) {
  constexpr double kLeastStep_m = 5.0;
  constexpr double kMostStep_m = 50.0;
  const double step_m = std::clamp(elevation.cell_m(), kLeastStep_m, kMostStep_m);
  const auto num_steps = static_cast<int>(std::ceil(alignment.length_m() / step_m));
  std::optional<double> first_s_m;
  const std::string rule = "must cover the ground of the whole line: ";
  for (int i = 0; i <= num_steps; ++i) {
    const double s_m = alignment.length_m() * i / num_steps;
    const bool is_covered = IsGroundCovered(elevation, alignment.At(s_m), width.At(s_m, -1.0),
                                            width.At(s_m, 1.0), step_m);
    if (is_covered && !first_s_m) first_s_m = s_m;
    const std::string place = "at chainage " + NumberText(std::round(s_m)) + " m";
    if (is_covered && *first_s_m > 0.0) return rule + "begins " + place;
    if (!is_covered && first_s_m) return rule + "ends " + place;
  }
  if (first_s_m) return std::nullopt;
  return rule + "has none of it (are its coordinates those of the line, and is origin_m right?)";
}

Hills::Hills(const ReliefSpec& spec, std::uint64_t seed)
    : spec_(spec),
      long_wave_(seed, RandomUse::kRelief, 0),
      short_wave_(seed, RandomUse::kRelief, 1) {}

double Hills::Height_m(const Eigen::Vector2d& place_m) const {
  constexpr double kLongShare = 0.9;  // Share of the variance.
  const Eigen::Vector2d at = place_m / spec_.wavelength_m;
  return spec_.sigma_m * (std::sqrt(kLongShare) * long_wave_.At(at.x(), at.y()) +
                          std::sqrt(1.0 - kLongShare) * short_wave_.At(3.0 * at.x(), 3.0 * at.y()));
}

Landform::Landform(const TerrainSpec& spec,
                   StripWidth width,
                   std::optional<DemHeights> elevation,
                   std::uint64_t seed)
    : width_(std::move(width)), elevation_(std::move(elevation)) {
  if (spec.relief) hills_.emplace(*spec.relief, seed);
}

double Landform::Rise_m(const Vector3& formation_m) const {
  Check(has_terrain(), "the land has a terrain of its own");
  if (elevation_) return elevation_->Height_m(formation_m.head<2>()) - formation_m.z();
  return hills_->Height_m(formation_m.head<2>());
}

std::vector<CoarserSurfaces> CoarserSurfacesBetween(const ChainageRange& range,
                                                    const Alignment& alignment,
                                                    const StripWidth& width,
                                                    const Transform& chunk_from_world) {
  constexpr int kNumSteps = 10;
  // By how much a curve turns the track at the chunk's ends from its middle.
  const double turn_rad = 0.5 * std::abs(alignment.At(range.end_s_m).heading_rad -
                                         alignment.At(range.begin_s_m).heading_rad);
  CoarserSurfaces coarser{.area_m = {},
                          .ray_spacing_m = 0.0,
                          .beam_width_m = kCoarseBeamWidth_m,
                          .sight_angle_rad = std::max(0.0, kCoarseSightAngle_rad - turn_rad)};
  for (int i = 0; i <= kNumSteps; ++i) {
    const double s_m = std::lerp(range.begin_s_m, range.end_s_m, 1.0 * i / kNumSteps);
    for (const double side : {-1.0, 1.0}) {
      const Transform chunk_from_edge =
          chunk_from_world * alignment.WorldFromTrack(s_m, side * width.At(s_m, side));
      coarser.area_m.extend(Eigen::Vector2d(chunk_from_edge.translation().head<2>()));
    }
  }
  std::vector<CoarserSurfaces> forms(kMostCoarse, coarser);
  for (std::size_t i = 0; i < forms.size(); ++i) forms[i].ray_spacing_m = kCoarseRaySpacings_m[i];
  return forms;
}

}  // namespace railcast
