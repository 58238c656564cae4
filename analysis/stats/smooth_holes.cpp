#include "analysis/stats/smooth_holes.h"

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

namespace railcast {
namespace {

constexpr std::size_t kReach = 4;  // Neighbours on either side.
constexpr std::size_t kNumNeighbours = 2 * kReach;
constexpr double kSmooth_m = 0.03;
constexpr double kLikeFactor = 1.5;
constexpr double kIntensityStep = 0.01;

using Neighbours = Eigen::Array<double, static_cast<int>(kNumNeighbours), 1>;

// The places of the neighbours in columns from the firing.
const Neighbours& Places() {
  static const Neighbours kPlaces{{-4.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0}};
  return kPlaces;
}

// Standard deviation of the ranges about their line, which has two parameters.
double DeviationFromLine_m(const Neighbours& ranges_m) {
  const Neighbours& places = Places();
  const double slope_m = (places * ranges_m).sum() / places.square().sum();
  const Neighbours rest_m = ranges_m - ranges_m.mean() - slope_m * places;
  return std::sqrt(rest_m.square().sum() / static_cast<double>(kNumNeighbours - 2));
}

bool IsOneBrightness(const Neighbours& intensities) {
  return intensities.maxCoeff() <= 1.0 &&
         intensities.maxCoeff() <= kLikeFactor * intensities.minCoeff() + 1.01 * kIntensityStep;
}

}  // namespace

const Bins& SmoothHoles::Intensities() {
  static const Bins kBins({0.0, 0.005, 0.015, 0.025, 0.035, 0.045, 0.055, 0.075, 0.105, 0.155,
                           0.205, 0.305, 0.505, 1.005});
  return kBins;
}

void SmoothHoles::AddFiring(const Frame& frame, std::size_t row, std::size_t column) {
  if (column < kReach || column + kReach >= frame.columns) return;
  const Neighbours& places = Places();
  const std::size_t firing = row * frame.width() + column * frame.returns;
  Neighbours ranges_m;
  Neighbours intensities;
  for (Eigen::Index i = 0; i < places.size(); ++i) {
    const auto away = static_cast<std::ptrdiff_t>(places[i]) * std::ptrdiff_t{frame.returns};
    const auto slot = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(firing) + away);
    ranges_m[i] = static_cast<double>(frame.range_m[slot]);
    intensities[i] = static_cast<double>(frame.intensity[slot]);
  }
  // Negated so that NaN counts as no surface.
  if (!(DeviationFromLine_m(ranges_m) <= kSmooth_m) || !IsOneBrightness(intensities)) return;
  const auto bin = Intensities().Find(intensities.mean());
  if (!bin) return;
  by_intensity_.resize(Intensities().size());
  by_intensity_[*bin].Add(
      {{1, std::isfinite(frame.range_m[firing]) ? 0U : 1U}, intensities.mean()});
}

}  // namespace railcast
