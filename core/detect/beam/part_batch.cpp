#include "core/detect/beam/part_batch.h"

#include <cmath>

#include "core/detect/base/beam_optics.h"
#include "railcast/lidar.h"

namespace railcast {

std::size_t PartBatch::Pad(std::size_t num) {
  for (; num % kPacketSize != 0; ++num) {
    const std::size_t last = num - 1;
    for (float* values :
         {rays.origin_x, rays.origin_y, rays.origin_z, rays.direction_x, rays.direction_y,
          rays.direction_z, rays.shutter, rays.range_m, rays.normal_x, rays.normal_y, rays.normal_z,
          share_, cell_, variance_m2_}) {
      values[num] = values[last];
    }
    rays.surface[num] = rays.surface[last];
  }
  rays.num_rays = num;
  return num;
}

void PartBatch::Respond(const WideBeams& beams,
                        const Kernels& kernels,
                        std::size_t num,
                        std::size_t num_wanted,
                        std::vector<Component>& parts) {
  hits_.num_rays = num;
  ResolveHits(rays, beams.table, hits_);
  kernels.incidence(rays, hits_);
  kernels.spread(rays, beams.frame, hits_);
  for (std::size_t i = 0; i < num; ++i) {
    hits_.share[i] = share_[i];
    const float whole_m = hits_.spread_m[i];
    hits_.spread_m[i] = std::sqrt(cell_[i] * whole_m * whole_m + variance_m2_[i]);
  }
  if (beams.mirrors != nullptr) DimMirrors(*beams.mirrors, rays, hits_);
  beams.detector.Respond(hits_);
  if (beams.texture != nullptr) {
    beams.texture->Apply(*beams.textures, beams.table.surfaces, rays, hits_);
  }
  for (std::size_t i = 0; i < num_wanted; ++i) parts.push_back(ComponentOf(hits_, i));
}

Component ComponentOf(const DetectTile& hits, std::size_t lane) {
  return {.range_m = hits.true_range_m[lane],
          .spread_m = hits.spread_m[lane],
          .power_ratio = hits.power_ratio[lane],
          .share = hits.share[lane],
          .intensity = hits.intensity[lane],
          .cos_incidence = hits.cos_incidence[lane],
          .reflectivity = hits.reflectivity[lane],
          .surface = hits.surface[lane]};
}

Component CellOf(const Component& whole, float share, const DetectorSpec& spec) {
  Component cell = whole;
  const float whole_spread2 = cell.spread_m * cell.spread_m;
  cell.share *= share;
  cell.intensity *= share;
  cell.power_ratio *= share;
  cell.spread_m *= std::sqrt(share);
  if (StretchLowersPower(spec)) {
    const auto pulse_variance_m2 =
        static_cast<float>(PulseSigma_m(spec.beam) * PulseSigma_m(spec.beam));
    cell.power_ratio *= std::sqrt((pulse_variance_m2 + whole_spread2) /
                                  (pulse_variance_m2 + share * whole_spread2));
  }
  return cell;
}

}  // namespace railcast
