#include "generator/import/fit/plan_model.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

/// Shorter elements would be refused by an alignment.
constexpr double kShortestElement_m = 1e-3;

}  // namespace

double PlanModel::length_m() const {
  double length_m = 0.0;
  for (const Plateau& plateau : plateaus) length_m += plateau.length_m;
  return length_m;
}

double PlanModel::ConstantLength_m(std::size_t plateau) const {
  double length_m = plateaus[plateau].length_m;
  if (plateau > 0) length_m -= 0.5 * clothoids_m[plateau - 1];
  if (plateau < clothoids_m.size()) length_m -= 0.5 * clothoids_m[plateau];
  return length_m;
}

double PlanModel::ConstantBegin_m(std::size_t plateau) const {
  double s_m = plateau > 0 ? 0.5 * clothoids_m[plateau - 1] : 0.0;
  for (std::size_t i = 0; i < plateau; ++i) s_m += plateaus[i].length_m;
  return s_m;
}

PiecewiseLinear PlanModel::Curvature() const {
  std::vector<LinearPiece> pieces;
  double s_m = 0.0;
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const double curvature_per_m = plateaus[i].curvature_per_m;
    const double constant_m = ConstantLength_m(i);
    if (constant_m > 0.0) {
      pieces.push_back({s_m, curvature_per_m, curvature_per_m});
      s_m += constant_m;
    }
    if (i < clothoids_m.size()) {
      pieces.push_back({s_m, curvature_per_m, plateaus[i + 1].curvature_per_m});
      s_m += clothoids_m[i];
    }
  }
  return {std::move(pieces), s_m};
}

std::vector<AlignmentElement> PlanModel::Elements() const {
  std::vector<AlignmentElement> elements;
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const double curvature_per_m = plateaus[i].curvature_per_m;
    const double constant_m = std::max(ConstantLength_m(i), kShortestElement_m);
    if (curvature_per_m == 0.0) {
      elements.push_back({ElementType::kStraight, constant_m, {}});
    } else {
      elements.push_back({ElementType::kArc, constant_m, 1.0 / curvature_per_m});
    }
    if (i < clothoids_m.size()) {
      elements.push_back({ElementType::kClothoid, clothoids_m[i], {}});
    }
  }
  return elements;
}

}  // namespace railcast
