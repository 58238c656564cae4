#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/median.h"
#include "core/track/track_search.h"

namespace railcast {
namespace {

constexpr float kReach_m = 40.0F;  ///< In plan.

/// Squares of 0.2 m in plan, by rows, with a margin of two.
struct Squares {
  static constexpr float kSize_m = 0.2F;
  static constexpr std::size_t kSide = static_cast<std::size_t>(2.0F * kReach_m / kSize_m) + 5;
  static constexpr std::size_t kNum = kSide * kSide;

  static std::size_t At(const Eigen::Vector3f& point_m) {
    const auto cell = [](float value_m) {
      return static_cast<std::size_t>((value_m + kReach_m) / kSize_m) + 2;
    };
    return cell(point_m.y()) * kSide + cell(point_m.x());
  }
  /// A square and the eight around it.
  static std::array<std::size_t, 9> Around(std::size_t square) {
    std::array<std::size_t, 9> around{};
    for (std::size_t i = 0; i < 9; ++i) around[i] = square + (i / 3) * kSide + i % 3 - kSide - 1;
    return around;
  }
};

/// The ground in each square that has points: the median, over the square and those up to two away,
/// of what three tenths of the points of each are below. The median is right on slopes.
std::vector<float> Ground_m(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr float kNothing_m = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::pair<std::size_t, float>> heights_m;
  for (const Eigen::Vector3f& point_m : points_m)
    heights_m.emplace_back(Squares::At(point_m), point_m.z());
  std::ranges::sort(heights_m);
  std::vector<float> low_m(Squares::kNum, kNothing_m);
  std::vector<std::size_t> squares;
  for (std::size_t i = 0, end = 0; i < heights_m.size(); i = end) {
    while (end < heights_m.size() && heights_m[end].first == heights_m[i].first) ++end;
    squares.push_back(heights_m[i].first);
    low_m[squares.back()] = heights_m[i + (end - i) * 3 / 10].second;
  }
  std::vector<float> ground_m(Squares::kNum, kNothing_m);
  for (const std::size_t square : squares) {
    std::vector<float> around_m;
    for (std::size_t row = 0; row < 5; ++row) {
      for (std::size_t column = 0; column < 5; ++column) {
        const float each_m = low_m[square + row * Squares::kSide + column - 2 * Squares::kSide - 2];
        if (std::isfinite(each_m)) around_m.push_back(each_m);
      }
    }
    ground_m[square] = MedianOf(around_m);
  }
  return ground_m;
}

constexpr float kLeastRise_m = 0.06F;
constexpr float kMostRise_m = 0.4F;

/// How high the raised points of a square and those around it are above the ground.
class RisesOf {
 public:
  void Add(float rise_m) { ++counts_[StepOf(rise_m)]; }
  [[nodiscard]] int num() const { return std::accumulate(counts_.begin(), counts_.end(), 0); }
  /// Whether a height is that of the top: of the highest three steps that have a third of the
  /// points of any three. Plants above a head have fewer.
  [[nodiscard]] bool IsTop(float rise_m) const {
    int most = 0;
    for (std::size_t i = 0; i < kSteps; ++i) most = std::max(most, ThreeAt(i));
    std::size_t top = kSteps - 1;
    while (top > 0 && 3 * ThreeAt(top) < most) --top;
    // The steps above have few; those in the middle of the top may be just below.
    while (top > 0 && ThreeAt(top - 1) > ThreeAt(top)) --top;
    const std::size_t at = StepOf(rise_m);
    return at + 1 >= top && at <= top + 1;
  }

 private:
  static constexpr std::size_t kSteps = 14;
  [[nodiscard]] int ThreeAt(std::size_t step) const {
    return counts_[step] + (step > 0 ? counts_[step - 1] : 0) +
           (step + 1 < kSteps ? counts_[step + 1] : 0);
  }
  static std::size_t StepOf(float rise_m) {
    constexpr float kPer_m = kSteps / (kMostRise_m - kLeastRise_m);
    return std::min(kSteps - 1, static_cast<std::size_t>((rise_m - kLeastRise_m) * kPer_m));
  }
  std::array<std::uint16_t, kSteps> counts_{};
};

}  // namespace

std::vector<Vector3> RaisedPoints(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr float kLeastBelow_m = 0.2F;  // The sensor is above the rails.
  constexpr float kThinned_m = 0.05F;
  // Grass and slopes are raised all around.
  constexpr float kMostRaised = 0.5F;
  std::vector<Eigen::Vector3f> low_m;
  for (const Eigen::Vector3f& point_m : points_m) {
    if (point_m.z() < -kLeastBelow_m && point_m.head<2>().norm() < kReach_m)
      low_m.push_back(point_m);
  }
  const std::vector<float> ground_m = Ground_m(low_m);
  std::vector<int> num_all(Squares::kNum);
  std::vector<RisesOf> rises(Squares::kNum);
  std::vector<std::pair<float, Eigen::Vector3f>> raised;
  for (const Eigen::Vector3f& point_m : low_m) {
    const std::size_t at = Squares::At(point_m);
    const float rise_m = point_m.z() - ground_m[at];
    const bool is_raised = rise_m >= kLeastRise_m && rise_m < kMostRise_m;
    if (is_raised) raised.emplace_back(rise_m, point_m);
    for (const std::size_t square : Squares::Around(at)) {
      ++num_all[square];
      if (is_raised) rises[square].Add(rise_m);
    }
  }
  std::vector<std::pair<std::int64_t, Eigen::Vector3f>> cells;
  for (const auto& [rise_m, point_m] : raised) {
    const std::size_t at = Squares::At(point_m);
    const RisesOf& around = rises[at];
    if (static_cast<float>(around.num()) > kMostRaised * static_cast<float>(num_all[at]) ||
        !around.IsTop(rise_m)) {
      continue;
    }
    const auto cell = [&](int axis) {
      return static_cast<std::int64_t>(std::floor(point_m[axis] / kThinned_m));
    };
    cells.emplace_back(cell(0) * 100'000 + cell(1), point_m);
  }
  std::vector<Vector3> raised_m;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i == 0 || cells[i].first != cells[i - 1].first)
      raised_m.push_back(cells[i].second.cast<double>());
  }
  std::ranges::stable_sort(raised_m, {},
                           [](const Vector3& place_m) { return place_m.head<2>().norm(); });
  return raised_m;
}

}  // namespace railcast
