#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/median.h"
#include "core/track/track_search.h"

namespace railcast {
namespace {

constexpr double kCluster_m = 0.5;  ///< Points of a head within it share their errors.
constexpr double kFarthest_m = 40.0;
constexpr double kNone = 1e-9;  ///< Standard deviation of what there is not.

/// A track's axes beside the sensor, and the shape of its heads in them.
struct Laid {
  Transform track_from_local = Transform::Identity();
  double curvature_per_m{};
  double bend_per_m{};   ///< Vertical curvature.
  double twist_per_m{};  ///< Change of the roll along the track.
  double apart_m{};

  [[nodiscard]] Vector3 Place_m(const Vector3& point_m) const {
    Vector3 place_m = track_from_local * point_m;
    place_m.y() -= ArcRise_m(curvature_per_m, place_m.x());
    place_m.z() -= ArcRise_m(bend_per_m, place_m.x()) + twist_per_m * place_m.x() * place_m.y();
    return place_m;
  }
  /// From the middle of the nearer head.
  [[nodiscard]] double Across_m(const Vector3& place_m) const {
    return place_m.y() - std::copysign(0.5 * apart_m, place_m.y());
  }
};

/// Single points far beyond all others, which may be of something else, would turn the whole track.
/// @param usual_m How far most points of the heads are at most.
double WeightOf(const Vector3& point_m, double usual_m) {
  const double ratio2 = point_m.squaredNorm() / (usual_m * usual_m);
  return 1.0 / (1.0 + ratio2 * ratio2);
}

int ClusterOf(const Vector3& place_m) {
  return 2 * static_cast<int>(std::floor(place_m.x() / kCluster_m)) + (place_m.y() > 0.0 ? 1 : 0);
}

/// Takes the heights that were found into the axes.
void Lift(const ClusteredFit::Row& heights, Laid& laid) {
  Transform change = Transform::Identity();
  change.linear() = RotationFromYawPitchRoll(0.0, -heights[1], heights[2]);
  change.translation().z() = heights[0];
  laid.track_from_local = change.inverse() * laid.track_from_local;
  laid.bend_per_m += heights[3];
  laid.twist_per_m += heights[4];
}

void Shift(const ClusteredFit& sides, Laid& laid) {
  Transform change = Transform::Identity();
  change.linear() = RotationFromYawPitchRoll(sides.solution[1], 0.0, 0.0);
  change.translation().y() = sides.solution[0];
  laid.track_from_local = change.inverse() * laid.track_from_local;
  laid.curvature_per_m += sides.solution[2];
  laid.apart_m += 2.0 * sides.solution[3];
}

/// Moves the origin along the track to where the sensor is.
void MoveBesideSensor(Laid& laid) {
  const double x_m = laid.track_from_local.translation().x();
  Transform step = Transform::Identity();
  step.linear() = RotationFromYawPitchRoll(laid.curvature_per_m * x_m, -laid.bend_per_m * x_m,
                                           laid.twist_per_m * x_m);
  step.translation() =
      Vector3(x_m, ArcRise_m(laid.curvature_per_m, x_m), ArcRise_m(laid.bend_per_m, x_m));
  laid.track_from_local = step.inverse() * laid.track_from_local;
}

ClusteredFit::Row HeightRow(const Vector3& place_m) {
  return {1.0, place_m.x(), place_m.y(), 0.5 * place_m.x() * place_m.x(),
          place_m.x() * place_m.y()};
}

/// @param has_twist Whether the cant may change: by 1 in 400 of the gauge, as in steep ramps.
ClusteredFit::Row HeightPrior(double curvature_per_m, bool has_twist) {
  return {1.0, 0.1, 0.1, BendSigma_per_m(curvature_per_m), has_twist ? 2.5e-3 : kNone};
}
const ClusteredFit::Row kSidePrior{0.5, 0.1, 3e-3, 0.05, kNone};

/// The middle of the highest 4 cm in which there are half as many points as in any: the ground
/// beside a head may have more of them than its top, and plants above it have fewer.
double TopOf(std::vector<double>& heights_m) {
  constexpr double kWindow_m = 0.04;
  std::ranges::sort(heights_m);
  std::vector<std::size_t> ends;
  std::size_t most = 0;
  for (std::size_t begin = 0, end = 0; begin < heights_m.size(); ++begin) {
    while (end < heights_m.size() && heights_m[end] < heights_m[begin] + kWindow_m) ++end;
    ends.push_back(end);
    most = std::max(most, end - begin);
  }
  std::size_t begin = heights_m.size() - 1;
  while (2 * (ends[begin] - begin) < most) --begin;
  // The first such window from above is the lower half of the top's.
  std::size_t best = begin;
  for (std::size_t i = begin + 1; i-- > 0 && heights_m[i] > heights_m[begin] - kWindow_m;)
    if (ends[i] - i > ends[best] - best) best = i;
  return 0.5 * (heights_m[best] + heights_m[ends[best] - 1]);
}

/// Where points near the top of a head are, from its middle towards the sensor, by head (left,
/// right) and side on which the sensor is (left, right).
using EdgePoints = std::array<std::array<std::vector<double>, 2>, 2>;

/// Moves both heads so that their edges that face the sensor are where a head's are: of the points
/// near the top, a twelfth are beyond them or within 3 mm.
void LayEdges(EdgePoints& towards_m, Laid& laid) {
  constexpr double kInside_m = 0.003;
  std::array<double, 2> shift_m{};
  for (std::size_t head = 0; head < 2; ++head) {
    // In a curve the sensor sees the same rail from either side.
    const std::size_t side = towards_m[head][0].size() >= towards_m[head][1].size() ? 0 : 1;
    std::vector<double>& each_m = towards_m[head][side];
    if (each_m.empty()) continue;
    const auto at = each_m.end() - 1 - static_cast<std::ptrdiff_t>(each_m.size() / 12);
    std::ranges::nth_element(each_m, at);
    shift_m[head] = (side == 0 ? 1.0 : -1.0) * (*at - 0.5 * kHeadWidth_m + kInside_m);
  }
  Transform change = Transform::Identity();
  change.translation().y() = 0.5 * (shift_m[0] + shift_m[1]);
  laid.track_from_local = change.inverse() * laid.track_from_local;
  laid.apart_m += shift_m[0] - shift_m[1];
}

/// Lays the plane of the heads on the raised points of both ridges up to `reach_m`.
/// @return False where these are too few.
bool LayPlane(const std::vector<Vector3>& raised_m, double reach_m, Laid& laid) {
  constexpr double kNear_m = 0.08;
  constexpr double kOn_m = 0.06;
  constexpr std::size_t kFewest = 4;
  std::vector<Vector3> near_m;
  std::array<std::vector<double>, 2> heights_m;
  for (const Vector3& point_m : raised_m) {
    const Vector3 place_m = laid.Place_m(point_m);
    const double across_m = std::abs(laid.Across_m(place_m));
    if (across_m > kNear_m || std::abs(place_m.x()) > reach_m) continue;
    near_m.push_back(point_m);
    if (across_m < kOn_m) heights_m[place_m.y() > 0.0 ? 0 : 1].push_back(place_m.z());
  }
  if (std::min(heights_m[0].size(), heights_m[1].size()) < kFewest) return false;
  const double left_m = TopOf(heights_m[0]);
  const double right_m = TopOf(heights_m[1]);
  Lift({0.5 * (left_m + right_m), 0.0, (left_m - right_m) / laid.apart_m, 0.0, 0.0}, laid);
  for (const double scale_m : {0.12, 0.08, 0.05, 0.05}) {
    ClusteredFit heights(HeightPrior(laid.curvature_per_m, false));
    for (const Vector3& point_m : near_m) {
      const Vector3 place_m = laid.Place_m(point_m);
      const double off = place_m.z() / scale_m;
      if (std::abs(off) >= 1.0) continue;
      const double robust = (1.0 - off * off) * (1.0 - off * off);
      heights.Add(HeightRow(place_m), place_m.z(), robust * WeightOf(point_m, reach_m),
                  ClusterOf(place_m));
    }
    if (!heights.Solve()) return false;
    Lift(heights.solution, laid);
  }
  return true;
}

/// How far along a guess its nearest points go, so that they tell where it goes on.
double FirstReach_m(const std::vector<Vector3>& raised_m, const Laid& laid) {
  constexpr std::size_t kNearest = 60;
  std::vector<double> along_m;
  for (const Vector3& point_m : raised_m) {
    const Vector3 place_m = laid.Place_m(point_m);
    if (std::abs(laid.Across_m(place_m)) < 0.12) along_m.push_back(std::abs(place_m.x()));
    if (along_m.size() == kNearest) break;
  }
  return along_m.empty() ? 0.0 : *std::ranges::max_element(along_m) + 2.0;
}

}  // namespace

TrackFit FitTrack(const std::vector<Vector3>& points_m,
                  const std::vector<Vector3>& raised_m,
                  const TrackGuess& guess) {
  constexpr int kMostSteps = 14;
  constexpr int kTwistTried = 8;       // When the whole track is within reach.
  constexpr double kGrowth = 1.3;      // How much farther each step reaches.
  constexpr double kCrown_m = 0.0015;  // A head's points are lower than its top.
  constexpr double kDepth_m = 0.025;   // Points up to so far below the top count.
  constexpr double kMostOff_m = 0.05;  // Above the heads, or below.
  constexpr double kBand_m = 0.03;     // Half the width of a head that is nearly level.
  TrackFit result;
  Laid laid;
  laid.apart_m = guess.apart_m;
  laid.curvature_per_m = guess.curvature_per_m;
  Transform local_from_track = Transform::Identity();
  local_from_track.linear() = RotationFromYawPitchRoll(guess.heading_rad, 0.0, 0.0);
  local_from_track.translation() = local_from_track.linear() * Vector3(0, guess.sideways_m, 0);
  laid.track_from_local = local_from_track.inverse();

  const auto lacks = [&](const std::string& why) {
    result.why_not = why;
    return result;
  };
  double reach_m = std::min(kFarthest_m, FirstReach_m(raised_m, laid));
  if (!LayPlane(raised_m, reach_m, laid)) return lacks("its ridges have too few points");
  // What is near it, and what of that is near its heads as far as they may yet move.
  std::vector<Vector3> corridor_m;
  std::vector<Vector3> near_heads_m;
  for (const Vector3& point_m : points_m) {
    const Vector3 place_m = laid.Place_m(point_m);
    const double margin_m = 1.0 + 0.1 * std::abs(place_m.x());
    if (std::abs(place_m.x()) < kFarthest_m &&
        std::abs(place_m.y()) < 0.5 * laid.apart_m + margin_m && std::abs(place_m.z()) < margin_m) {
      corridor_m.push_back(point_m);
      const double moved_m = 0.2 + 0.1 * std::abs(place_m.x());
      if (std::abs(laid.Across_m(place_m)) < kBand_m + moved_m && std::abs(place_m.z()) < moved_m)
        near_heads_m.push_back(point_m);
    }
  }
  ClusteredFit heights(HeightPrior(laid.curvature_per_m, false));
  ClusteredFit sides(kSidePrior);
  double scatter_m = 0.02;
  double usual_m = reach_m;
  bool has_twist = false;
  for (int step = 0; step < kMostSteps;
       ++step, reach_m = std::min(kFarthest_m, kGrowth * reach_m)) {
    // Where it goes on is known to some centimetres.
    const bool is_whole = reach_m >= kFarthest_m;
    const double across_m = is_whole ? 0.06 : 0.09;
    const double window_m = is_whole ? std::clamp(3.0 * scatter_m, 0.015, 0.05) : kMostOff_m;
    heights = ClusteredFit(HeightPrior(laid.curvature_per_m, has_twist));
    sides = ClusteredFit(kSidePrior);
    result.track.points = {};
    std::vector<double> off_m;
    std::array<double, 2> near_middle{};
    std::vector<double> ranges_m;
    EdgePoints edges_m;
    const double sensor_m = laid.track_from_local.translation().y();
    for (const Vector3& point_m : near_heads_m) {
      const Vector3 place_m = laid.Place_m(point_m);
      if (std::abs(place_m.x()) > reach_m || std::abs(place_m.z()) > kMostOff_m) continue;
      const double off_across_m = laid.Across_m(place_m);
      const double side = std::copysign(1.0, place_m.y());
      const double weight = WeightOf(point_m, usual_m);
      if (std::abs(off_across_m) < kBand_m && std::abs(place_m.z()) < window_m) {
        const double off = place_m.z() / window_m;
        off_m.push_back(std::abs(place_m.z()));
        heights.Add(HeightRow(place_m), place_m.z(), (1.0 - off * off) * weight,
                    ClusterOf(place_m));
      }
      if (std::abs(off_across_m) > across_m || place_m.z() < -kDepth_m) continue;
      const std::size_t head = side > 0.0 ? 0 : 1;
      ++result.track.points[head];
      ranges_m.push_back(point_m.norm());
      near_middle[head] += std::exp(-0.5 * (off_across_m * off_across_m / (0.025 * 0.025) +
                                            place_m.z() * place_m.z() / (0.01 * 0.01)));
      const double aside_m =
          sensor_m + ArcRise_m(laid.curvature_per_m, place_m.x()) - side * 0.5 * laid.apart_m;
      if (std::abs(aside_m) > 0.5 * kHeadWidth_m) {
        edges_m[head][aside_m > 0.0 ? 0 : 1].push_back(std::copysign(1.0, aside_m) * off_across_m);
      }
      sides.Add({1.0, place_m.x(), 0.5 * place_m.x() * place_m.x(), side, 0.0}, off_across_m,
                weight, ClusterOf(place_m));
    }
    if (!heights.Solve() || !sides.Solve()) return lacks("its ridges have too few points");
    usual_m = 1.5 * MedianOf(ranges_m);
    scatter_m = std::clamp(1.48 * MedianOf(off_m), 0.004, 0.02);
    Lift(heights.solution, laid);
    Shift(sides, laid);
    // Twist costs certainty of the roll beside the sensor, so that it must be seen.
    if (step == kTwistTried) has_twist = true;
    if (step == kTwistTried + 2) {
      has_twist = std::abs(laid.twist_per_m) > 3.5 * std::sqrt(heights.covariance(4, 4));
      if (!has_twist) laid.twist_per_m = 0.0;
    }
    if (step + 1 == kMostSteps) {
      LayEdges(edges_m, laid);
      laid.track_from_local.translation().z() -= kCrown_m;
    }
    MoveBesideSensor(laid);
    result.quality = std::min(near_middle[0], near_middle[1]);
  }

  FoundTrack& track = result.track;
  track.track_from_sensor = laid.track_from_local;
  track.curvature_per_m.value = laid.curvature_per_m;
  track.gauge_m.value = laid.apart_m - kHeadWidth_m;
  // Beside the scatter of points: errors that a channel's points share, and how much of a head's
  // edges is seen from where.
  constexpr double kShape_m = 0.006;
  double sum_m2 = 0.0;
  std::vector<Vector3> places_m;
  std::size_t num = 0;
  for (const Vector3& point_m : corridor_m) {
    const Vector3& place_m = places_m.emplace_back(laid.Place_m(point_m));
    if (std::abs(laid.Across_m(place_m)) > kBand_m || std::abs(place_m.z()) > kDepth_m) continue;
    sum_m2 += place_m.x() * place_m.x();
    ++num;
  }
  const double length_m = std::sqrt(sum_m2 / static_cast<double>(std::max<std::size_t>(1, num)));
  const auto half = [](double variance, double shape) {
    return std::hypot(1.96 * std::sqrt(std::max(0.0, variance)), shape);
  };
  track.height_m.margin = half(heights.covariance(0, 0), kShape_m);
  track.pitch_rad.margin = half(heights.covariance(1, 1), 5e-4);
  track.roll_rad.margin = half(heights.covariance(2, 2), 1e-3);
  track.sideways_m.margin = half(sides.covariance(0, 0), kShape_m);
  track.yaw_rad.margin = half(sides.covariance(1, 1), 8e-4);
  track.curvature_per_m.margin = half(
      sides.covariance(2, 2), std::min(3e-4, 1.5 * kShape_m / std::max(1.0, length_m * length_m)));
  track.gauge_m.margin = half(4.0 * sides.covariance(3, 3), 0.009);

  result.why_not = WhyNoRails(places_m, laid.apart_m, scatter_m, track);
  return result;
}

}  // namespace railcast
