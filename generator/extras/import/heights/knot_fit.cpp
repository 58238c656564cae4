#include "generator/extras/import/heights/knot_fit.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

constexpr double kDelta = 2.0;  // In units of sigma.

/// Symmetric linear equations of which each has its neighbours' unknowns only.
struct TridiagonalSystem {
  std::vector<double> diagonal;
  std::vector<double> beside;  ///< Between unknowns i and i + 1.
  std::vector<double> right;

  explicit TridiagonalSystem(std::size_t size)
      : diagonal(size, 0.0), beside(size, 0.0), right(size, 0.0) {}

  /// Adds weight * (a x_i + b x_(i + 1) - value)^2 to what is minimised.
  void AddRow(std::size_t i, double a, double b, double value, double weight) {
    diagonal[i] += weight * a * a;
    right[i] += weight * a * value;
    if (b == 0.0) return;
    diagonal[i + 1] += weight * b * b;
    right[i + 1] += weight * b * value;
    beside[i] += weight * a * b;
  }

  /// Gaussian elimination (Thomas). @pre The matrix is positive definite.
  [[nodiscard]] std::vector<double> Solved() {
    const std::size_t size = diagonal.size();
    for (std::size_t i = 1; i < size; ++i) {
      const double factor = beside[i - 1] / diagonal[i - 1];
      diagonal[i] -= factor * beside[i - 1];
      right[i] -= factor * right[i - 1];
    }
    std::vector<double> unknowns(size);
    for (std::size_t i = size; i-- > 0;) {
      const double after = i + 1 < size ? beside[i] * unknowns[i + 1] : 0.0;
      unknowns[i] = (right[i] - after) / diagonal[i];
    }
    return unknowns;
  }
};

/// One step of the repeated least squares; weights come from the heights before it.
void ImproveHeights(KnotWindow& window, double sigma_m) {
  constexpr double kKept = 1e12;      // Weight of a height that stays.
  constexpr double kAnywhere = 1e-6;  // Weight of a height that no sample holds.
  constexpr double kLimit = 1e10;     // For a gradient's limit, per (1/m)^2 and in units of sigma.
  constexpr double kHeldAt = 0.9995 * kSteepest;
  std::vector<Knot>& knots = window.knots;
  TridiagonalSystem system(knots.size());
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const bool stays =
        (i == 0 && window.has_fixed_begin) || (i + 1 == knots.size() && window.has_fixed_end);
    system.AddRow(i, 1.0, 0.0, knots[i].z_m, stays ? kKept : kAnywhere);
  }
  std::size_t at = 0;
  for (const HeightSample& sample : window.samples) {
    while (at + 2 < knots.size() && sample.s_m > knots[at + 1].s_m) ++at;
    const double share = (sample.s_m - knots[at].s_m) / (knots[at + 1].s_m - knots[at].s_m);
    const double offset =
        (sample.z_m - HeightOn(std::span(knots).subspan(at, 2), sample.s_m)) / sigma_m;
    const double weight = 1.0 / std::sqrt(1.0 + offset * offset / (kDelta * kDelta));
    system.AddRow(at, 1.0 - share, share, sample.z_m, weight / (sigma_m * sigma_m));
  }
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double gradient = GradientAfter(knots, i);
    // One that the samples pull back from the limit is free again.
    if (std::abs(gradient) <= kHeldAt) continue;
    const double length_m = knots[i + 1].s_m - knots[i].s_m;
    system.AddRow(i, -1.0, 1.0, std::copysign(kHeldAt, gradient) * length_m,
                  kLimit / (length_m * length_m));
  }
  const std::vector<double> heights_m = system.Solved();
  for (std::size_t i = 0; i < knots.size(); ++i) knots[i].z_m = heights_m[i];
}

}  // namespace

double HeightLoss(double offset) {
  const double ratio = offset / kDelta;
  return 2.0 * kDelta * kDelta * (std::sqrt(1.0 + ratio * ratio) - 1.0);
}

double HeightOn(std::span<const Knot> knots, double s_m) {
  const auto after = std::ranges::upper_bound(knots, s_m, {}, &Knot::s_m);
  const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(after - knots.begin(), 1, std::ssize(knots) - 1));
  return knots[i - 1].z_m + GradientAfter(knots, i - 1) * (s_m - knots[i - 1].s_m);
}

double KnotWindow::Fit(double sigma_m) {
  constexpr int kNumSteps = 4;
  for (int step = 0; step < kNumSteps; ++step) ImproveHeights(*this, sigma_m);
  double loss = 0.0;
  std::size_t at = 0;
  for (const HeightSample& sample : samples) {
    while (at + 2 < knots.size() && sample.s_m > knots[at + 1].s_m) ++at;
    const double ratio =
        (sample.z_m - HeightOn(std::span(knots).subspan(at, 2), sample.s_m)) / (sigma_m * kDelta);
    loss += 2.0 * kDelta * kDelta * (std::sqrt(1.0 + ratio * ratio) - 1.0);
  }
  return loss;
}

}  // namespace railcast
