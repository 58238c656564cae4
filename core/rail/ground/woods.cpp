#include "core/rail/ground/woods.h"

#include <cmath>
#include <numbers>

namespace railcast {

Woods::Woods(const VegetationSpec& spec, std::uint64_t seed)
    : share_(spec.woods_share),
      size_m_(spec.woods_size_m),
      outline_(seed, RandomUse::kWoods, 0),
      edge_(seed, RandomUse::kWoods, 1) {}

bool Woods::HaveTreeAt(const Eigen::Vector2d& place_m, float draw) const {
  if (share_ >= 1.0) return true;
  if (share_ <= 0.0) return false;
  /// Width of the edge, as a share of the land: trees become fewer over it.
  constexpr double kEdge = 0.1;
  const Eigen::Vector2d at = place_m / size_m_;
  const double noise =
      std::sqrt(0.5) * (outline_.At(at.x(), at.y()) + edge_.At(3.0 * at.x(), 3.0 * at.y()));
  // The noise is about normal, so that this is about uniform in [0, 1].
  const double rank = 0.5 * std::erfc(noise * std::numbers::sqrt2 / 2.0);
  return rank + kEdge * (static_cast<double>(draw) - 0.5) < share_;
}

}  // namespace railcast
