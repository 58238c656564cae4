#include "core/rail/line/cant.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace railcast {
namespace {

double SpacingOf_mm(const AlignmentSpec& spec) {
  return spec.gauge_mm + kRailHeadWidth_mm;
}

/// Balancing cant in mm over the square of the speed in km/h and the curvature in 1/m.
double BalancingCantOf(const AlignmentSpec& spec) {
  return kBalancingCant * (SpacingOf_mm(spec) / kStandardSpacing_mm);
}

double HeightByRuleMm(double curvature_per_m, double speed_kmph, const AlignmentSpec& spec) {
  const double balanced_mm =
      BalancingCantOf(spec) * speed_kmph * speed_kmph * std::abs(curvature_per_m);
  const double cant_mm = std::clamp(balanced_mm - spec.cant_deficiency_mm, 0.0, spec.cant_max_mm);
  return std::copysign(cant_mm, curvature_per_m);
}

struct StretchOfTrack {
  double begin_s_m{}, end_s_m{};
  double begin_curvature_per_m{}, end_curvature_per_m{};
};

// The chainages between which the rule is linear: where it reaches 0 or its maximum.
std::vector<double> CornersOf(const StretchOfTrack& stretch,
                              double speed_kmph,
                              const AlignmentSpec& spec) {
  std::vector<double> corners_s_m;
  const double rise_per_m = stretch.end_curvature_per_m - stretch.begin_curvature_per_m;
  for (const double balanced_mm :
       {spec.cant_deficiency_mm, spec.cant_deficiency_mm + spec.cant_max_mm}) {
    const double corner_per_m = balanced_mm / (BalancingCantOf(spec) * speed_kmph * speed_kmph);
    for (const double curvature_per_m : {-corner_per_m, corner_per_m}) {
      const double part = (curvature_per_m - stretch.begin_curvature_per_m) / rise_per_m;
      const double s_m = stretch.begin_s_m + part * (stretch.end_s_m - stretch.begin_s_m);
      // Also false if there is no change of curvature and the division yields NaN or infinity.
      if (s_m > stretch.begin_s_m && s_m < stretch.end_s_m) corners_s_m.push_back(s_m);
    }
  }
  corners_s_m.push_back(stretch.begin_s_m);
  std::sort(corners_s_m.begin(), corners_s_m.end());
  corners_s_m.erase(std::unique(corners_s_m.begin(), corners_s_m.end()), corners_s_m.end());
  return corners_s_m;
}

PiecewiseLinear HeightByRule(const PiecewiseLinear& curvature,
                             const PiecewiseLinear& speed_kmph,
                             const AlignmentSpec& spec) {
  std::vector<double> bounds_s_m{curvature.end_s_m()};
  for (const LinearPiece& piece : curvature.pieces()) bounds_s_m.push_back(piece.begin_s_m);
  for (const LinearPiece& piece : speed_kmph.pieces()) bounds_s_m.push_back(piece.begin_s_m);
  std::sort(bounds_s_m.begin(), bounds_s_m.end());
  bounds_s_m.erase(std::unique(bounds_s_m.begin(), bounds_s_m.end()), bounds_s_m.end());

  std::vector<LinearPiece> pieces;
  for (std::size_t i = 0; i + 1 < bounds_s_m.size(); ++i) {
    const StretchOfTrack stretch{bounds_s_m[i], bounds_s_m[i + 1], curvature.Value(bounds_s_m[i]),
                                 curvature.Value(bounds_s_m[i + 1])};
    const double speed = speed_kmph.Value(stretch.begin_s_m);
    const std::vector<double> corners_s_m = CornersOf(stretch, speed, spec);
    for (std::size_t k = 0; k < corners_s_m.size(); ++k) {
      const double end_s_m = k + 1 < corners_s_m.size() ? corners_s_m[k + 1] : stretch.end_s_m;
      pieces.push_back({corners_s_m[k],
                        HeightByRuleMm(curvature.Value(corners_s_m[k]), speed, spec),
                        HeightByRuleMm(curvature.Value(end_s_m), speed, spec)});
    }
  }
  return {std::move(pieces), curvature.end_s_m()};
}

}  // namespace

Cant::Cant(const PiecewiseLinear& curvature,
           const PiecewiseLinear& speed_kmph,
           const AlignmentSpec& spec)
    : height_mm_(HeightByRule(curvature, speed_kmph, spec)),
      ramp_m_(spec.cant_ramp_m),
      spacing_mm_(SpacingOf_mm(spec)) {}

Cant::Cant(PiecewiseLinear surveyed_mm, const AlignmentSpec& spec)
    : height_mm_(std::move(surveyed_mm)), ramp_m_(0.0), spacing_mm_(SpacingOf_mm(spec)) {}

double Cant::HeightMm(double s_m) const {
  if (ramp_m_ == 0.0) return height_mm_.Value(s_m);
  const double half_m = 0.5 * ramp_m_;
  return (height_mm_.Integral(s_m + half_m) - height_mm_.Integral(s_m - half_m)) / ramp_m_;
}

double Cant::RollRad(double s_m) const {
  return -std::asin(HeightMm(s_m) / spacing_mm_);
}

}  // namespace railcast
