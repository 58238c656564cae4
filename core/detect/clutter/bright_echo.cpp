#include "core/detect/clutter/bright_echo.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/weather_optics.h"
#include "core/detect/clutter/added_echo.h"

namespace railcast {
namespace {

// The square of the angle between two directions, by their chord: too small by angle^2 / 12, which
// is 1 in 10,000 for 2 degrees.
float Angle2_rad2(const DetectTile& tile, std::size_t lane, const HaloSource& source) {
  const float dx = tile.direction_x[lane] - source.x;
  const float dy = tile.direction_y[lane] - source.y;
  const float dz = tile.direction_z[lane] - source.z;
  return dx * dx + dy * dy + dz * dz;
}

// Twice the extinction coefficient of the air; 0 where the effect is off.
float BothWays_per_m(const DetectorSpec& spec) {
  if (!spec.effects.extinction) return 0.0F;
  return static_cast<float>(2.0 * Extinction_per_m(spec.weather, spec.beam.wavelength_nm));
}

}  // namespace

Ghost::Ghost(const DetectorSpec& spec)
    : label_(spec.clutter_labels.ghost),
      power_min_(static_cast<float>(LeastPower(spec.receiver))),
      both_ways_per_m_(BothWays_per_m(spec)),
      range_min_m_(static_cast<float>(spec.range_min_m)) {
  if (!spec.effects.ghost) return;
  const double radius_m = 0.5e-3 * spec.cover.aperture_mm;
  gain_ = static_cast<float>(spec.receiver.ghost_reflectance * radius_m * radius_m *
                             LeastPower(spec.receiver));
}

void Ghost::AddEchoes(EchoTiles& echoes) const {
  if (!is_on()) return;
  std::array<float, kTileSize> ratio{};
  std::array<float, kTileSize> range_m{};
  const auto look_at = [&](const DetectTile& tile, std::size_t lane, std::size_t beam) {
    if (!IsRetroreflected(tile, lane, range_min_m_) || tile.power_ratio[lane] <= ratio[beam]) {
      return;
    }
    ratio[beam] = tile.power_ratio[lane];
    range_m[beam] = tile.true_range_m[lane] + tile.peak_shift_m[lane];
  };
  const std::size_t num_beams = echoes.first.num_rays;
  for (std::size_t beam = 0; beam < num_beams; ++beam) look_at(echoes.first, beam, beam);
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    look_at(tile, lane, echoes.beam_of(i));
  }
  for (std::size_t beam = 0; beam < num_beams; ++beam) {
    const float ghost = gain_ * ratio[beam] * ratio[beam];
    if (ghost < kLeastStrayRatio) continue;
    const float far_m = 2.0F * range_m[beam];
    AddEcho(beam,
            {label_, EchoTiles::kGhost, far_m, ghost,
             IntensityInClearAir(ghost, power_min_, both_ways_per_m_, far_m)},
            echoes);
  }
}

Halo::Halo(const DetectorSpec& spec)
    : label_(spec.clutter_labels.halo),
      power_min_(static_cast<float>(LeastPower(spec.receiver))),
      both_ways_per_m_(BothWays_per_m(spec)),
      share_at_1_rad_(
          static_cast<float>(spec.receiver.halo_share_at_1_deg * std::pow(RadFromDeg(1.0), 4))),
      same_echo_m_(static_cast<float>(2.0 * PulseSigma_m(spec.beam))),
      range_min_m_(static_cast<float>(spec.range_min_m)) {}

void Halo::CollectSources(EchoTiles& echoes, std::vector<HaloSource>& sources) const {
  echoes.ForEachTile([&](const DetectTile& tile) {
    for (std::size_t i = 0; i < tile.num_rays; ++i) {
      if (!IsRetroreflected(tile, i, range_min_m_)) continue;
      sources.push_back({tile.direction_x[i], tile.direction_y[i], tile.direction_z[i],
                         tile.true_range_m[i] + tile.peak_shift_m[i], tile.power_ratio[i]});
    }
  });
}

bool Halo::Reaches(const DetectTile& first, const std::vector<HaloSource>& sources) const {
  std::array<float, 3> least{};
  std::array<float, 3> most{};
  const std::array<const float*, 3> directions{first.direction_x, first.direction_y,
                                               first.direction_z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax_element(directions[axis], directions[axis] + first.num_rays);
    least[axis] = *low;
    most[axis] = *high;
  }
  return std::any_of(sources.begin(), sources.end(), [&](const HaloSource& source) {
    const float reach2 = std::sqrt(share_at_1_rad_ * source.power_ratio / kLeastStrayRatio);
    const std::array<float, 3> place{source.x, source.y, source.z};
    float distance2 = 0.0F;  // From the source to the box around the tile's directions.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float outside = std::max({least[axis] - place[axis], place[axis] - most[axis], 0.0F});
      distance2 += outside * outside;
    }
    return distance2 <= reach2;
  });
}

void Halo::AddEchoes(EchoTiles& echoes, const std::vector<HaloSource>& sources) const {
  const DetectTile& first = echoes.first;
  // The echoes that the beams have of their own, before halos are added to them.
  std::array<std::vector<float>, kTileSize> own_m;
  for (std::size_t beam = 0; beam < first.num_rays; ++beam) {
    if (first.surface[beam] != 0) own_m[beam].push_back(first.true_range_m[beam]);
  }
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    own_m[echoes.beam_of(i)].push_back(tile.true_range_m[lane]);
  }
  for (std::size_t beam = 0; beam < first.num_rays; ++beam) {
    float ratio = 0.0F;
    float range_m = 0.0F;
    for (const HaloSource& source : sources) {
      const float angle2 = Angle2_rad2(first, beam, source);
      const float share = share_at_1_rad_ / std::max(angle2 * angle2, share_at_1_rad_);
      if (share * source.power_ratio <= ratio) continue;
      ratio = share * source.power_ratio;
      range_m = source.range_m;
    }
    const bool is_own = std::any_of(own_m[beam].begin(), own_m[beam].end(), [&](float own) {
      return std::fabs(own - range_m) < same_echo_m_;
    });
    if (ratio < kLeastStrayRatio || is_own) continue;
    AddEcho(beam,
            {label_, EchoTiles::kHalo, range_m, ratio,
             IntensityInClearAir(ratio, power_min_, both_ways_per_m_, range_m)},
            echoes);
  }
}

}  // namespace railcast
