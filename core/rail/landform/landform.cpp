#include "core/rail/landform/landform.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace railcast {

Hills::Hills(const ReliefSpec& spec, std::uint64_t seed)
    : spec_(spec),
      long_wave_(seed, RandomUse::kRelief, 0),
      short_wave_(seed, RandomUse::kRelief, 1) {}

double Hills::Height_m(const Eigen::Vector2d& place_m) const {
  constexpr double kLongShare = 0.9;  // Of the variance.
  const Eigen::Vector2d at = place_m / spec_.wavelength_m;
  return spec_.sigma_m * (std::sqrt(kLongShare) * long_wave_.At(at.x(), at.y()) +
                          std::sqrt(1.0 - kLongShare) * short_wave_.At(3.0 * at.x(), 3.0 * at.y()));
}

Landform::Landform(const TerrainSpec& spec,
                   StripWidth width,
                   std::optional<DemHeights> elevation,
                   std::uint64_t seed)
    : width_(std::move(width)), elevation_(std::move(elevation)) {
  if (spec.relief) hills_.emplace(*spec.relief, seed);
}

double Landform::Rise_m(const Vector3& formation_m) const {
  Check(has_terrain(), "the land has a terrain of its own");
  if (elevation_) return elevation_->Height_m(formation_m.head<2>()) - formation_m.z();
  return hills_->Height_m(formation_m.head<2>());
}

}  // namespace railcast
