#include "core/track/found_track.h"

#include <algorithm>
#include <cmath>

#include "core/track/track_search.h"

namespace railcast {

double BendSigma_per_m(double curvature_per_m) {
  return std::hypot(1.5e-4, 0.1 * curvature_per_m);
}

double FoundTrack::Margin_m(double x_m) const {
  const double bend_per_m = 1.96 * BendSigma_per_m(curvature_per_m.value);
  const double half_square_m2 = 0.5 * x_m * x_m;
  const double across_m =
      std::hypot(sideways_m.margin, yaw_rad.margin * x_m, curvature_per_m.margin * half_square_m2);
  const double up_m =
      std::hypot(height_m.margin, pitch_rad.margin * x_m, bend_per_m * half_square_m2);
  return std::max(across_m, up_m);
}

double FoundTrack::KnownFor_m(double margin_m) const {
  constexpr double kStep_m = 0.5;
  constexpr double kMost_m = 200.0;
  double known_m = 0.0;
  while (known_m < kMost_m && Margin_m(known_m + kStep_m) <= margin_m) known_m += kStep_m;
  return known_m;
}

}  // namespace railcast
