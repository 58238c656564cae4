#include "core/rail/world/gauge_entries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/rail/structures/structures.h"

namespace railcast {
namespace {

constexpr double kLeastDepth_m = 1e-3;
/// Triangles that reach farther along the track are divided. In a curve of 150 m radius, the chord
/// of such a piece is 3 mm off.
constexpr double kLongestPiece_m = 2.0;
/// Triangles are not divided below this size.
constexpr double kLeastPiece_m = 0.1;
/// Tolerance of platforms' edges: chords of the platform and of such pieces.
constexpr double kEdgeTolerance_m = 5e-3;
/// The edge is looked for within this height; the wall below stands back.
constexpr double kAboutEdge_m = 0.12;
constexpr double kMostCant_m = 0.3;
/// A curve makes the clear space wider by so much at most, for a quick look.
constexpr double kMostBend_m = 0.6;

/// The farthest that a clear space reaches from the axis of straight track.
double WidestOf_m(const std::vector<HalfWidth>& rows) {
  double widest_m = 0.0;
  for (const HalfWidth& row : rows) {
    widest_m = std::max(widest_m, row.half_width_m + CantWidening_m(row.height_m, kMostCant_m));
  }
  return widest_m;
}

/// The part of a polygon on one side of a line (Sutherland, Hodgman 1974): where `normal` times a
/// point is at most the limit.
std::vector<Eigen::Vector2d> Clipped(const std::vector<Eigen::Vector2d>& polygon,
                                     const Eigen::Vector2d& normal,
                                     double limit) {
  std::vector<Eigen::Vector2d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double from_a = limit - normal.dot(a);
    const double from_b = limit - normal.dot(b);
    if (from_a >= 0.0) inside.push_back(a);
    if ((from_a >= 0.0) != (from_b >= 0.0)) {
      inside.emplace_back(a + from_a / (from_a - from_b) * (b - a));
    }
  }
  return inside;
}

/// What of a polygon on one side of the axis is between two rows of a space.
PartInside InsideOf(std::vector<Eigen::Vector2d> polygon,
                    const HalfWidth& below,
                    const HalfWidth& above) {
  const double slope =
      (above.half_width_m - below.half_width_m) / (above.height_m - below.height_m);
  const double at_rail_m = below.half_width_m - slope * below.height_m;
  const Eigen::Vector2d outwards(1.0, -slope);
  polygon = Clipped(polygon, Eigen::Vector2d::UnitY(), above.height_m);
  polygon = Clipped(polygon, -Eigen::Vector2d::UnitY(), -below.height_m);
  polygon = Clipped(polygon, outwards, at_rail_m);
  PartInside part;
  for (const Eigen::Vector2d& point : polygon) {
    part.bottom_m = std::min(part.bottom_m, point.y());
    part.top_m = std::max(part.top_m, point.y());
    part.depth_m = std::max(part.depth_m, at_rail_m - outwards.dot(point));
  }
  return part;
}

/// Leaves of a space what is above a height. @pre The space begins below it and ends above it.
void CutBelow(double height_m, std::vector<HalfWidth>& rows) {
  const auto above =
      std::ranges::find_if(rows, [&](const HalfWidth& row) { return row.height_m > height_m; });
  HalfWidth& below = *std::prev(above);
  const double share = (height_m - below.height_m) / (above->height_m - below.height_m);
  below = {height_m, std::lerp(below.half_width_m, above->half_width_m, share)};
  rows.erase(rows.begin(), std::prev(above));
}

}  // namespace

ProbedCorner CornerAt(const Alignment& alignment, const Vector3& place_m, double near_s_m) {
  return {PlaceOnLine(alignment, place_m, near_s_m), place_m};
}

GaugeProbe::GaugeProbe(const WorldTracks& tracks,
                       std::size_t track,
                       const Alignment& alignment,
                       Asked asked,
                       const PlatformSpec* platform)
    : track_(tracks.world.tracks[track]),
      course_(tracks.courses[track]),
      alignment_(alignment),
      asked_(asked),
      platform_(platform),
      contact_height_m_(ContactHeightOver_m(track_, tracks.world.catenary)),
      outline_(VehicleOutline(contact_height_m_)),
      half_widths_(ClearHalfWidths(tracks.world)),
      widest_m_(std::max(outline_.front().half_width_m, WidestOf_m(half_widths_))),
      top_m_(std::max(outline_.back().top_m, half_widths_.back().height_m)) {}

bool GaugeProbe::MayReach(const Eigen::AlignedBox2d& bounds_m) {
  const double begin_s_m = std::max(bounds_m.min().x(), course_.begin_s_m());
  const double end_s_m = std::min(bounds_m.max().x(), course_.end_s_m());
  if (begin_s_m > end_s_m) return false;
  const auto at_m = [&](double step, double num_steps) {
    return num_steps > 0.0 ? std::lerp(begin_s_m, end_s_m, step / num_steps) : begin_s_m;
  };
  constexpr double kStep_m = 5.0;
  double least_m = std::numeric_limits<double>::infinity();
  double most_m = -least_m;
  const double num_steps = std::ceil((end_s_m - begin_s_m) / kStep_m);
  for (double step = 0.0; step <= num_steps; ++step) {
    const double d_m = course_.OffsetWithin_m(at_m(step, num_steps));
    least_m = std::min(least_m, d_m);
    most_m = std::max(most_m, d_m);
  }
  // What differs between its places and the track's cross-sections: their angle, cant, gradients,
  // and what a track goes aside between samples.
  constexpr double kMargin_m = 6.0;
  const double reach_m = widest_m_ + kMostBend_m + kMargin_m;
  if (bounds_m.min().y() > most_m + reach_m || bounds_m.max().y() < least_m - reach_m) return false;
  constexpr double kCurveStep_m = 2.0;
  constexpr double kBetweenSamples = 1.2;
  sharpest_per_m_ = 0.0;
  const double num_curves = std::ceil((end_s_m - begin_s_m) / kCurveStep_m);
  for (double step = 0.0; step <= num_curves; ++step) {
    const double curvature_per_m = course_.CurvatureAt(alignment_, at_m(step, num_curves));
    sharpest_per_m_ = std::max(sharpest_per_m_, kBetweenSamples * std::abs(curvature_per_m));
  }
  // Outside of a curve it is wider than inside.
  reach_m_ = widest_m_ + CurveWidening_m(sharpest_per_m_, -1.0);
  return true;
}

void GaugeProbe::Add(const ProbedCorners& triangle) {
  ++num_comparisons_;
  const auto [first, last] = std::ranges::minmax(triangle, {}, &ProbedCorner::s_m);
  if (last.s_m < course_.begin_s_m() || first.s_m > course_.end_s_m()) return;
  const double length_m = last.s_m - first.s_m;
  if (IsSurelyOutside(triangle, length_m)) return;
  const double middle_s_m = 0.5 * (first.s_m + last.s_m);
  const Transform track_from_world = course_.WorldFromTrack(alignment_, middle_s_m).inverse();
  ProbedTriangle here;
  std::ranges::transform(triangle, here.begin(), [&](const ProbedCorner& corner) {
    return track_from_world * corner.place_m;
  });
  if (IsFar(here)) return;
  if (length_m > kLongestPiece_m) return Divide(triangle);
  for (const GaugePart& part : outline_) {
    if (Measure(here, part, middle_s_m)) entry_.is_in_way = true;
  }
  if (asked_ == Asked::kWhatIsInTheWay) return;
  MeasureClearSpace(here, middle_s_m);
  if (platform_ != nullptr) MeasurePlatform(here, middle_s_m);
}

std::optional<GaugeEntry> GaugeProbe::Entry(const std::string& name) const {
  if (!(entry_.depth_m > kLeastDepth_m)) return std::nullopt;
  GaugeEntry entry = entry_;
  entry.name = name;
  entry.track = track_.name;
  constexpr int kClear_m = 5;
  for (const int at_m : metres_) {
    if (entry.stretches.empty() || at_m > entry.stretches.back().end_s_m + kClear_m) {
      entry.stretches.push_back({std::max<double>(at_m, entry.begin_s_m), 0.0});
    }
    entry.stretches.back().end_s_m = std::min(at_m + 1.0, entry.end_s_m);
  }
  return entry;
}

bool GaugeProbe::IsSurelyOutside(const ProbedCorners& triangle, double length_m) const {
  constexpr double kMargin_m = 1.0;
  constexpr double kSteepest = 0.1;  // Steepest gradients and cant.
  const auto [rightmost, leftmost] = std::ranges::minmax(triangle, {}, &ProbedCorner::d_m);
  const double reach_m =
      reach_m_ + kMargin_m + length_m + length_m * length_m / alignment_.tightest_radius_m();
  if (rightmost.d_m > course_.most_d_m() + reach_m) return true;
  if (leftmost.d_m < course_.least_d_m() - reach_m) return true;
  const double width_m =
      std::max(leftmost.d_m - course_.least_d_m(), course_.most_d_m() - rightmost.d_m);
  const double lowest_m = std::ranges::min(triangle, {}, &ProbedCorner::h_m).h_m;
  return lowest_m > top_m_ + kMargin_m + kSteepest * (length_m + width_m);
}

bool GaugeProbe::IsFar(const ProbedTriangle& here) const {
  constexpr double kMargin_m = 0.1;
  constexpr double kSharpestTurn = 0.7;
  double along_m = 0.0;
  for (const Vector3& corner : here) along_m = std::max(along_m, std::abs(corner.x()));
  const double turn = sharpest_per_m_ * along_m;
  if (turn > kSharpestTurn) return false;
  const double cosine = std::sqrt(1.0 - turn * turn);
  const double reach_m = reach_m_ / cosine + turn * along_m / (1.0 + cosine) + kMargin_m;
  const auto is_beyond = [&](double sign) {
    return std::ranges::all_of(here,
                               [&](const Vector3& corner) { return sign * corner.y() > reach_m; });
  };
  return is_beyond(1.0) || is_beyond(-1.0);
}

void GaugeProbe::Divide(const ProbedCorners& triangle) {
  std::size_t longest = 0;
  const auto length_m = [&](std::size_t i) {
    return std::abs(triangle[(i + 1) % 3].s_m - triangle[i].s_m);
  };
  for (std::size_t i = 1; i < 3; ++i) {
    if (length_m(i) > length_m(longest)) longest = i;
  }
  const std::size_t next = (longest + 1) % 3;
  // Beyond the centre of a curve, chainages of neighbouring places are far apart.
  if ((triangle[next].place_m - triangle[longest].place_m).norm() < kLeastPiece_m) return;
  const ProbedCorner middle =
      CornerAt(alignment_, 0.5 * (triangle[longest].place_m + triangle[next].place_m),
               0.5 * (triangle[longest].s_m + triangle[next].s_m));
  for (const std::size_t replaced : {longest, next}) {
    ProbedCorners half = triangle;
    half[replaced] = middle;
    Add(half);
  }
}

void GaugeProbe::MeasureClearSpace(const ProbedTriangle& here, double s_m) {
  const TrackBend bend = BendAt(course_, alignment_, s_m);
  for (const double side : {-1.0, 1.0}) {
    std::vector<HalfWidth> rows = ClearSpace(half_widths_, contact_height_m_, bend, side);
    if (platform_ != nullptr) CutBelow(platform_->height_m + kAboutEdge_m, rows);
    static_cast<void>(Measure(here, side, rows, s_m));
  }
}

void GaugeProbe::MeasurePlatform(const ProbedTriangle& here, double s_m) {
  const double side = here[0].y() > 0.0 ? 1.0 : -1.0;
  const double edge_m =
      kLeastPlatformEdge_m - kEdgeTolerance_m + PlatformWidening_m(alignment_, course_, side, s_m);
  const double top_m = platform_->height_m + kAboutEdge_m;
  static_cast<void>(
      Measure(here, GaugePart{edge_m, platform_->height_m - kAboutEdge_m, top_m}, s_m));
}

bool GaugeProbe::Measure(const ProbedTriangle& here, const GaugePart& part, double s_m) {
  const std::vector<HalfWidth> rows = {{part.bottom_m, part.half_width_m},
                                       {part.top_m, part.half_width_m}};
  const bool is_on_the_right = Measure(here, -1.0, rows, s_m);
  return Measure(here, 1.0, rows, s_m) || is_on_the_right;
}

bool GaugeProbe::Measure(const ProbedTriangle& here,
                         double side,
                         const std::vector<HalfWidth>& rows,
                         double s_m) {
  std::vector<Eigen::Vector2d> whole;
  for (const Vector3& corner : here) whole.emplace_back(side * corner.y(), corner.z());
  whole = Clipped(whole, -Eigen::Vector2d::UnitX(), 0.0);
  Eigen::AlignedBox2d bounds_m;
  for (const Eigen::Vector2d& point : whole) bounds_m.extend(point);
  bool is_inside = false;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double widest_m = std::max(rows[i - 1].half_width_m, rows[i].half_width_m);
    const Eigen::AlignedBox2d between_m(Eigen::Vector2d(0.0, rows[i - 1].height_m),
                                        Eigen::Vector2d(widest_m, rows[i].height_m));
    if (rows[i].height_m > rows[i - 1].height_m && between_m.intersects(bounds_m)) {
      is_inside = Take(InsideOf(whole, rows[i - 1], rows[i]), rows, s_m) || is_inside;
    }
  }
  return is_inside;
}

bool GaugeProbe::Take(const PartInside& part, const std::vector<HalfWidth>& rows, double s_m) {
  // What only touches a space from above or below is not in it.
  const bool touches = part.top_m - rows.front().height_m < kLeastDepth_m ||
                       rows.back().height_m - part.bottom_m < kLeastDepth_m;
  if (part.depth_m <= kLeastDepth_m || touches) return false;
  if (entry_.depth_m == 0.0) {
    entry_.begin_s_m = entry_.end_s_m = s_m;
    entry_.bottom_m = part.bottom_m;
    entry_.top_m = part.top_m;
  }
  metres_.insert(static_cast<int>(std::floor(s_m)));
  entry_.begin_s_m = std::min(entry_.begin_s_m, s_m);
  entry_.end_s_m = std::max(entry_.end_s_m, s_m);
  entry_.bottom_m = std::max(0.0, std::min(entry_.bottom_m, part.bottom_m));
  entry_.top_m = std::max(entry_.top_m, part.top_m);
  if (part.depth_m > entry_.depth_m) {
    entry_.depth_m = part.depth_m;
    entry_.deepest_s_m = s_m;
  }
  return true;
}

}  // namespace railcast
