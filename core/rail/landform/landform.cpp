#include "core/rail/landform/landform.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

bool IsGroundCovered(const DemHeights& elevation,
                     const AxisPoint& axis,
                     double right_m,
                     double left_m,
                     double step_m) {
  const Eigen::Vector2d left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad));
  const auto num_steps = static_cast<int>(std::ceil((right_m + left_m) / step_m));
  for (int i = 0; i <= num_steps; ++i) {
    const double d_m = std::lerp(-right_m, left_m, static_cast<double>(i) / num_steps);
    if (!elevation.Covers(axis.position_m.head<2>() + d_m * left)) return false;
  }
  return true;
}

}  // namespace

DemHeights::DemHeights(const ElevationSpec& spec)
    : grid_(std::make_shared<const ElevationGrid>(spec.file)), origin_m_(spec.origin_m) {}

double DemHeights::Height_m(const Eigen::Vector2d& place_m) const {
  return grid_->Height_m(place_m.x() + origin_m_[0], place_m.y() + origin_m_[1]) - origin_m_[2];
}

bool DemHeights::Covers(const Eigen::Vector2d& place_m) const {
  return grid_->Covers(place_m.x() + origin_m_[0], place_m.y() + origin_m_[1]);
}

std::optional<std::string> CoverageFault(const DemHeights& elevation,
                                         const Alignment& alignment,
                                         const StripWidth& width) {
  constexpr double kLeastStep_m = 5.0;
  constexpr double kMostStep_m = 50.0;
  const double step_m = std::clamp(elevation.cell_m(), kLeastStep_m, kMostStep_m);
  const auto num_steps = static_cast<int>(std::ceil(alignment.length_m() / step_m));
  std::optional<double> first_s_m;
  const std::string rule = "must cover the ground of the whole line: ";
  for (int i = 0; i <= num_steps; ++i) {
    const double s_m = alignment.length_m() * i / num_steps;
    const bool is_covered = IsGroundCovered(elevation, alignment.At(s_m), width.At(s_m, -1.0),
                                            width.At(s_m, 1.0), step_m);
    if (is_covered && !first_s_m) first_s_m = s_m;
    const std::string place = "at chainage " + NumberText(std::round(s_m)) + " m";
    if (is_covered && *first_s_m > 0.0) return rule + "begins " + place;
    if (!is_covered && first_s_m) return rule + "ends " + place;
  }
  if (first_s_m) return std::nullopt;
  return rule + "has none of it (are its coordinates those of the line, and is origin_m right?)";
}

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
