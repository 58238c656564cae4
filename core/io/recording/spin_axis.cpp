#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/io/recording/ring_table.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

/// Indices of two points that may be of one ring, the one that the file has first in front.
using PointPair = std::pair<std::size_t, std::size_t>;

/// The points of a turn, and their directions from the origin.
struct TurnPoints {
  std::vector<Vector3> points_m;
  std::vector<Vector3> directions;
};

/// A sensor as far as it is known.
struct SpinGuess {
  Eigen::Matrix3d sensor_from_spin;
  double outwards_m{}, up_m{};  ///< As SpinningSpec::beam_origin_m.
};

/// The elevation of a point from where its beam leaves, and by how much it grows as the axis is
/// turned about x and y, and as the beams leave farther outwards and up.
struct SpinView {
  double elevation_rad{};
  Eigen::Vector4d slope;
};

SpinView ViewOf(const SpinGuess& guess, const Vector3& point_m) {
  const Vector3 at_m = guess.sensor_from_spin.transpose() * point_m;
  constexpr double kNearest_m = 1e-6;
  const double from_axis_m = std::max(kNearest_m, at_m.head<2>().norm());
  const double out_m = from_axis_m - guess.outwards_m;
  const double up_m = at_m.z() - guess.up_m;
  const double tilt_m = out_m + up_m * at_m.z() / from_axis_m;
  return {std::atan2(up_m, out_m),
          Eigen::Vector4d(at_m.y() * tilt_m, -at_m.x() * tilt_m, up_m, -out_m) /
              (out_m * out_m + up_m * up_m)};
}

/// A step of least squares, so that the points of each pair have one elevation.
/// @param most_rad Pairs that differ by more are of two rings.
void Refine(const TurnPoints& turn,
            const std::vector<PointPair>& pairs,
            double most_rad,
            SpinGuess& guess) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const auto& [i, j] : pairs) {
    const SpinView one = ViewOf(guess, turn.points_m[i]);
    const SpinView other = ViewOf(guess, turn.points_m[j]);
    const double apart_rad = one.elevation_rad - other.elevation_rad;
    if (std::abs(apart_rad) > most_rad) continue;
    const Eigen::Vector4d slope = one.slope - other.slope;
    normal += slope * slope.transpose();
    right -= slope * apart_rad;
  }
  // Where nothing shows where beams leave, that is within 0.1 m.
  constexpr double kUsual_m = 0.1;
  normal.diagonal().tail<2>().array() += std::pow(most_rad / kUsual_m, 2);
  const Eigen::Vector4d by = normal.inverse() * right;
  if (!by.allFinite()) return;
  guess.outwards_m += by[2];
  guess.up_m += by[3];
  guess.sensor_from_spin *= RotationFromYawPitchRoll(0.0, by[1], by[0]).transpose();
}

/// Places spread over a turn, whatever the order of its points, by steps of the golden ratio.
std::vector<std::size_t> SpreadOver(const TurnPoints& turn, std::size_t num) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < num; ++k) {
    const double share = kGolden * static_cast<double>(k);
    places.push_back(static_cast<std::size_t>((share - std::floor(share)) *
                                              static_cast<double>(turn.points_m.size())));
  }
  return places;
}

/// Pairs of some points and their nearest neighbours, most of which are of one ring, since sensors
/// have more columns than rings.
std::vector<PointPair> NeighboursIn(const TurnPoints& turn) {
  constexpr std::size_t kNumPoints = 256;
  constexpr std::size_t kNumNeighbours = 4;
  constexpr double kFarthest_rad = 0.02;
  constexpr double kReturns_rad = 1e-5;  // Points of one firing say nothing.
  std::vector<PointPair> pairs;
  std::vector<std::pair<double, std::size_t>> near;
  for (const std::size_t i : SpreadOver(turn, kNumPoints)) {
    near.clear();
    for (std::size_t j = 0; j < turn.directions.size(); ++j) {
      const double squared = (turn.directions[j] - turn.directions[i]).squaredNorm();
      if (squared > kFarthest_rad * kFarthest_rad) continue;
      if (squared > kReturns_rad * kReturns_rad) near.emplace_back(squared, j);
    }
    const std::size_t num = std::min(kNumNeighbours, near.size());
    std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(num));
    for (std::size_t n = 0; n < num; ++n) pairs.push_back(std::minmax(i, near[n].second));
  }
  return pairs;
}

/// The axis at a right angle to the most ways from a point to its neighbour: a circle about an axis
/// has no other. Directions of a half sphere are tried, 1 deg apart.
std::optional<Vector3> AxisOf(const TurnPoints& turn, const std::vector<PointPair>& neighbours) {
  constexpr int kNumTried = 16'000;
  constexpr double kGolden_rad = std::numbers::pi * (3.0 - 2.23606797749979);
  constexpr double kBeside_rad = 0.02;
  // A fiftieth of ways without order are as near to a right angle.
  constexpr double kLeastShare = 0.1;
  std::vector<Vector3> ways;
  for (const auto& [i, j] : neighbours) {
    ways.push_back((turn.directions[j] - turn.directions[i]).normalized());
  }
  auto most = static_cast<std::ptrdiff_t>(kLeastShare * static_cast<double>(ways.size()));
  std::optional<Vector3> best;
  for (int i = 0; i < kNumTried; ++i) {
    const double up = (i + 0.5) / kNumTried;
    const double level = std::sqrt(1.0 - up * up);
    const Vector3 axis(level * std::cos(i * kGolden_rad), level * std::sin(i * kGolden_rad), up);
    const auto num = std::ranges::count_if(
        ways, [&](const Vector3& way) { return std::abs(way.dot(axis)) < kBeside_rad; });
    if (num <= most) continue;
    most = num;
    best = axis;
  }
  return best;
}

/// Pairs of one ring among points spread over the turn, up to `reach_rad` apart.
std::vector<PointPair> PairsOfRings(const TurnPoints& turn,
                                    const SpinGuess& guess,
                                    double reach_rad,
                                    double most_rad) {
  constexpr std::size_t kNumPoints = 2'000;
  std::vector<std::pair<double, std::size_t>> spread;
  for (const std::size_t i : SpreadOver(turn, kNumPoints)) {
    spread.emplace_back(ViewOf(guess, turn.points_m[i]).elevation_rad, i);
  }
  std::ranges::sort(spread);
  std::vector<PointPair> pairs;
  constexpr std::size_t kMostOfOne = 64;
  std::size_t end = 0;
  for (std::size_t k = 0; k < spread.size(); ++k) {
    const auto& [elevation_rad, i] = spread[k];
    while (end < spread.size() && spread[end].first - elevation_rad <= most_rad) ++end;
    const std::size_t stride = 1 + (end - k) / kMostOfOne;
    for (std::size_t n = k + 1; n < end; n += stride) {
      const std::size_t j = spread[n].second;
      if ((turn.directions[i] - turn.directions[j]).norm() < reach_rad) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

/// Whether the axis is rather to point the other way: down, or if it is level, so that the sensor
/// would turn to the left, as hardly any does, by the order of its points in the file.
bool PointsDown(const SpinGuess& guess,
                const TurnPoints& turn,
                const std::vector<PointPair>& neighbours) {
  constexpr double kLevel = 0.5;  // The sine of 30 deg.
  constexpr double kOneRing_rad = 2e-4;
  const Vector3 axis = guess.sensor_from_spin.col(2);
  std::int64_t num = 0;
  std::int64_t balance = 0;
  for (const auto& [i, j] : neighbours) {
    const double apart_rad = ViewOf(guess, turn.points_m[i]).elevation_rad -
                             ViewOf(guess, turn.points_m[j]).elevation_rad;
    if (std::abs(apart_rad) > kOneRing_rad) continue;
    ++num;
    balance += turn.directions[i].cross(turn.directions[j]).dot(axis) > 0.0 ? 1 : -1;
  }
  const bool has_sense = 2 * std::abs(balance) > num;
  if (has_sense && std::abs(axis.z()) < kLevel) return balance > 0;
  return axis.dot(Vector3(0.05, 0.1, 1.0)) < 0.0;  // Level axes point ahead or to the left.
}

}  // namespace

std::optional<Eigen::Matrix3d> FindSpinAxis(const PointPositions& positions) {
  constexpr std::size_t kFewest = 100;
  constexpr std::size_t kMost = std::size_t{1} << 20U;  // Beyond that, it is no turn of a sensor.
  if (positions.size() > kMost) return std::nullopt;
  TurnPoints turn;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions.IsPoint(i)) continue;
    turn.points_m.emplace_back(positions.x[i], positions.y[i], positions.z[i]);
    turn.directions.push_back(turn.points_m.back().normalized());
  }
  if (turn.points_m.size() < kFewest) return std::nullopt;
  const std::vector<PointPair> neighbours = NeighboursIn(turn);
  const std::optional<Vector3> first = AxisOf(turn, neighbours);
  if (!first) return std::nullopt;
  SpinGuess guess{Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), *first).toRotationMatrix()};
  for (const double most_rad : {3e-4, 2e-4, 2e-4}) Refine(turn, neighbours, most_rad, guess);
  // Points farther apart show the axis better, once it is known well enough to tell their rings.
  constexpr std::pair<double, double> kPasses[] = {
      {0.4, 1e-3}, {0.4, 7e-4}, {2.0, 7e-4}, {2.0, 5e-4}, {2.0, 5e-4}};
  for (const auto& [reach_rad, most_rad] : kPasses) {
    Refine(turn, PairsOfRings(turn, guess, reach_rad, most_rad), most_rad, guess);
  }
  Vector3 axis = guess.sensor_from_spin.col(2);
  if (PointsDown(guess, turn, neighbours)) axis = -axis;
  // As a mount turns a sensor: azimuths need no third angle.
  return RotationFromYawPitchRoll(std::atan2(axis.y(), axis.x()),
                                  std::atan2(axis.head<2>().norm(), axis.z()), 0.0);
}

}  // namespace railcast
