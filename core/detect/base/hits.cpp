#include "core/detect/base/hits.h"

#include <algorithm>
#include <limits>

#include "railcast/outcome.h"

namespace railcast {

void ResolveHits(const RayTile& rays, const SurfaceTable& table, DetectTile& tile) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const Surface& surface = table.surfaces[rays.surface[i]];
    const bool hit = rays.surface[i] != 0;
    const Outcome outcome = !hit             ? Outcome::kNoSurface
                            : surface.is_ego ? Outcome::kEgo
                                             : Outcome::kReturned;
    tile.surface[i] = rays.surface[i];
    tile.true_range_m[i] = hit ? rays.range_m[i] : kNaN;
    tile.reflectivity[i] = hit ? surface.reflectivity : kNaN;
    tile.outcome[i] = static_cast<std::uint32_t>(outcome);
  }
  std::fill_n(tile.echo, tile.num_rays, 0U);
  std::fill_n(tile.clutter, tile.num_rays, kNoClutter);
  std::fill_n(tile.share, tile.num_rays, 1.0F);
  if (table.optics.empty()) return;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const LaneOptics& optics = table.optics[table.surfaces[rays.surface[i]].material];
    tile.reflectivity[i] = optics.diffuse;
    tile.diffuse_a[i] = optics.a;
    tile.diffuse_b[i] = optics.b;
    tile.specular_f0[i] = optics.f0;
    tile.specular_alpha2[i] = optics.alpha2;
    tile.retro[i] = optics.retro;
  }
  std::fill_n(tile.peak_shift_m, tile.num_rays, 0.0F);
}

}  // namespace railcast
