#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "generator/extras/import/heights/profile_fit.h"

namespace railcast {

/// A corner of the polyline that gradients make.
struct Knot {
  double s_m{};
  double z_m{};
};

/// Neighbouring knots of a line with the samples between them.
struct KnotWindow {
  std::vector<Knot> knots;  ///< At least two, in order of chainage.
  std::span<const HeightSample> samples;
  bool has_fixed_begin = false;  ///< Whether the height of the first knot stays.
  bool has_fixed_end = false;

  /// Fits the heights of the knots by least squares, repeated with weights for the pseudo-Huber
  /// loss. Gradients stay below kSteepest.
  /// @returns The sum of the losses that is left.
  double Fit(double sigma_m);
};

/// The pseudo-Huber loss of an offset in units of sigma, linear beyond 2: its square where it is
/// small.
[[nodiscard]] double HeightLoss(double offset);

/// Height of the polyline at a chainage; beyond its ends that of the first or last gradient.
[[nodiscard]] double HeightOn(std::span<const Knot> knots, double s_m);

/// Rise per metre from knot i to the next one.
[[nodiscard]] inline double GradientAfter(std::span<const Knot> knots, std::size_t i) {
  return (knots[i + 1].z_m - knots[i].z_m) / (knots[i + 1].s_m - knots[i].s_m);
}

}  // namespace railcast
