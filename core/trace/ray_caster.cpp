#include "railcast/ray_caster.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/trace/beam_tile.h"

namespace railcast {
namespace {

// Returns the entry for what ray `i` of a tile hit: a facet found before, or a new one.
std::uint32_t FacetOf(const RayTile& tile, std::size_t i, BeamRays& beam) {
  for (std::uint32_t f = 1; f < beam.num_facets; ++f) {
    const Facet& facet = beam.facets[f];
    if (facet.surface == tile.surface[i] && facet.normal_x == tile.normal_x[i] &&
        facet.normal_y == tile.normal_y[i] && facet.normal_z == tile.normal_z[i]) {
      return f;
    }
  }
  Check(beam.num_facets < BeamRays::kMaxFacets, "a beam has room for a facet per sub-ray");
  beam.facets[beam.num_facets] = {tile.surface[i], tile.normal_x[i], tile.normal_y[i],
                                  tile.normal_z[i]};
  return beam.num_facets++;
}

}  // namespace

void RayCaster::CastBeam(BeamRays& beam) const {
  RayTile tile{};
  tile.num_rays = beam.num_rays;
  tile.mask = beam.mask;
  CopySubRays(beam, beam.num_rays, tile);
  std::copy_n(beam.range_m, beam.num_rays, tile.range_m);
  Cast(tile);
  for (std::size_t i = 0; i < beam.num_rays; ++i) {
    if (tile.surface[i] == 0) continue;
    beam.range_m[i] = tile.range_m[i];
    beam.facet[i] = FacetOf(tile, i, beam);
  }
}

bool RayCaster::NeedsWidth(const BeamRays& /*beam*/) const {
  return true;
}

}  // namespace railcast
