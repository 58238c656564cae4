#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/units.h"
#include "core/track/track_search.h"

namespace railcast {
namespace {

constexpr double kMostAcross_m = 14.0;
constexpr double kLeastScore = 2.5;

/// Numbers of raised points in strips along a curve.
class Strips {
 public:
  explicit Strips(double width_m)
      : width_m_(width_m),
        below_(static_cast<std::size_t>(2.0 * kMostAcross_m / width_m) + 2 * kMargin + 1) {}

  void Count(const std::vector<Vector3>& raised_m,
             std::size_t num,
             double heading_rad,
             double curvature_per_m) {
    std::ranges::fill(below_, 0);
    const double cosine = std::cos(heading_rad);
    const double sine = std::sin(heading_rad);
    for (std::size_t i = 0; i < num; ++i) {
      const Vector3& place_m = raised_m[i];
      const double along_m = cosine * place_m.x() + sine * place_m.y();
      const double left_m =
          cosine * place_m.y() - sine * place_m.x() - 0.5 * curvature_per_m * along_m * along_m;
      if (std::abs(left_m) >= kMostAcross_m) continue;
      ++below_[static_cast<std::size_t>((left_m + kMostAcross_m) / width_m_) + kMargin + 1];
    }
    for (std::size_t i = 1; i < below_.size(); ++i) below_[i] += below_[i - 1];
    ridges_.assign(num_strips(), 0.0F);
    const auto beside = std::max<std::size_t>(3, static_cast<std::size_t>(0.2 / width_m_));
    for (std::size_t i = 0; i < ridges_.size(); ++i) {
      const std::size_t at = i + kMargin;
      const int on = ThreeAt(at);
      const int off = std::max(ThreeAt(at - beside), ThreeAt(at + beside));
      if (on > off)
        ridges_[i] = static_cast<float>(on - off) / std::sqrt(static_cast<float>(on + off + 4));
    }
  }

  [[nodiscard]] std::size_t num_strips() const { return below_.size() - 2 * kMargin - 1; }
  [[nodiscard]] double Middle_m(std::size_t strip) const {
    return (static_cast<double>(strip) + 0.5) * width_m_ - kMostAcross_m;
  }
  /// The score of the pair whose right ridge is in a strip.
  [[nodiscard]] double Score(std::size_t strip, std::size_t apart) const {
    return strip + apart < ridges_.size() ? std::min(ridges_[strip], ridges_[strip + apart]) : 0.0F;
  }
  [[nodiscard]] std::size_t Apart(double apart_m) const {
    return static_cast<std::size_t>(std::lround(apart_m / width_m_));
  }

 private:
  static constexpr std::size_t kMargin = 8;
  [[nodiscard]] int ThreeAt(std::size_t strip) const {
    return below_[strip + 2] - below_[strip - 1];
  }

  double width_m_;
  std::vector<int> below_;     ///< Points in strips before each one.
  std::vector<float> ridges_;  ///< More points than beside, in standard deviations.
};

struct Curve {
  double heading_rad{}, curvature_per_m{}, score{};
};

double BestScore(const Strips& strips, const std::vector<double>& apart_m) {
  double best = 0.0;
  for (const double each_m : apart_m) {
    const std::size_t apart = strips.Apart(each_m);
    for (std::size_t i = 0; i + apart < strips.num_strips(); ++i)
      best = std::max(best, strips.Score(i, apart));
  }
  return best;
}

/// The best curves of a coarse search among the nearest points, each 1.5 degrees from better ones.
std::vector<Curve> CoarseCurves(const std::vector<Vector3>& raised_m,
                                const std::vector<double>& apart_m) {
  constexpr std::size_t kMostPoints = 1200;
  constexpr double kMostLength_m = 12.0;
  constexpr std::size_t kMostCurves = 6;
  const double reach_m = raised_m.front().head<2>().norm() + kMostLength_m;
  std::size_t num = 0;
  while (num < std::min(raised_m.size(), kMostPoints) && raised_m[num].head<2>().norm() < reach_m) {
    ++num;
  }
  std::vector<Curve> curves;
  Strips strips(0.08);
  for (double heading_deg = -90.0; heading_deg < 90.0; heading_deg += 0.5) {
    for (const double curvature_per_m : {-5e-3, -2.5e-3, 0.0, 2.5e-3, 5e-3}) {
      strips.Count(raised_m, num, RadFromDeg(heading_deg), curvature_per_m);
      curves.push_back({RadFromDeg(heading_deg), curvature_per_m, BestScore(strips, apart_m)});
    }
  }
  std::ranges::stable_sort(curves, std::greater(), &Curve::score);
  std::vector<Curve> best;
  for (const Curve& curve : curves) {
    if (best.size() == kMostCurves || curve.score < kLeastScore) break;
    const bool is_other = std::ranges::none_of(best, [&](const Curve& better) {
      return std::abs(std::remainder(curve.heading_rad - better.heading_rad, std::numbers::pi)) <
             RadFromDeg(1.5);
    });
    if (is_other) best.push_back(curve);
  }
  return best;
}

/// The best curve near another one, in steps that are as fine as strips at 25 m.
Curve Refined(const Curve& coarse,
              const std::vector<Vector3>& raised_m,
              std::size_t num,
              const std::vector<double>& apart_m,
              Strips& strips) {
  Curve best = coarse;
  best.score = 0.0;
  const auto look = [&](double turn_step_deg, int num_turns, double bend_step_per_m,
                        int num_bends) {
    const Curve middle = best;
    for (int turn = -num_turns; turn <= num_turns; ++turn) {
      for (int bend = -num_bends; bend <= num_bends; ++bend) {
        Curve curve{middle.heading_rad + RadFromDeg(turn_step_deg * turn),
                    middle.curvature_per_m + bend_step_per_m * bend, 0.0};
        strips.Count(raised_m, num, curve.heading_rad, curve.curvature_per_m);
        curve.score = BestScore(strips, apart_m);
        if (curve.score > best.score) best = curve;
      }
    }
  };
  look(0.2, 4, 5e-4, 4);
  look(0.05, 3, 1e-4, 4);
  return best;
}

/// The pairs along a curve, each the best of those nearer than 0.3 m.
void AddPairs(const Curve& curve,
              const std::vector<Vector3>& raised_m,
              std::size_t num,
              const std::vector<double>& apart_m,
              Strips& strips,
              std::vector<TrackGuess>& guesses) {
  constexpr double kSame_m = 0.3;
  constexpr double kSameApart_m = 0.04;
  strips.Count(raised_m, num, curve.heading_rad, curve.curvature_per_m);
  std::vector<TrackGuess> pairs;
  for (const double each_m : apart_m) {
    const std::size_t apart = strips.Apart(each_m);
    for (std::size_t i = 0; i + apart < strips.num_strips(); ++i) {
      const double score = strips.Score(i, apart);
      if (score < std::max(kLeastScore, 0.3 * curve.score)) continue;
      pairs.push_back({curve.heading_rad, curve.curvature_per_m,
                       0.5 * (strips.Middle_m(i) + strips.Middle_m(i + apart)), each_m, score});
    }
  }
  std::ranges::stable_sort(pairs, std::greater(), &TrackGuess::score);
  const std::size_t num_before = guesses.size();
  for (const TrackGuess& pair : pairs) {
    const bool is_other =
        std::none_of(guesses.begin() + static_cast<std::ptrdiff_t>(num_before), guesses.end(),
                     [&](const TrackGuess& better) {
                       return std::abs(pair.sideways_m - better.sideways_m) < kSame_m &&
                              std::abs(pair.apart_m - better.apart_m) < kSameApart_m;
                     });
    if (is_other) guesses.push_back(pair);
  }
}

}  // namespace

std::vector<TrackGuess> GuessTracks(const std::vector<Vector3>& raised_m,
                                    const std::vector<double>& apart_m) {
  constexpr std::size_t kMostPoints = 6000;
  constexpr std::size_t kMostGuesses = 24;
  std::vector<TrackGuess> guesses;
  if (raised_m.empty()) return guesses;
  const std::size_t num = std::min(raised_m.size(), kMostPoints);
  Strips strips(0.04);
  for (const Curve& coarse : CoarseCurves(raised_m, apart_m)) {
    const Curve curve = Refined(coarse, raised_m, num, apart_m, strips);
    AddPairs(curve, raised_m, num, apart_m, strips, guesses);
  }
  std::ranges::stable_sort(guesses, std::greater(), &TrackGuess::score);
  if (guesses.size() > kMostGuesses) guesses.resize(kMostGuesses);
  return guesses;
}

}  // namespace railcast
