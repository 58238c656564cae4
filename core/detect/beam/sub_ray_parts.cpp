#include "core/detect/beam/sub_ray_parts.h"

#include <algorithm>
#include <cmath>

#include "core/detect/base/beam_axes.h"

namespace railcast {

SubRayParts::SubRayParts(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec),
      kernels_(kernels),
      pattern_(DenseSubRays(static_cast<std::size_t>(spec.beam.reference_rays))) {}

void SubRayParts::Flush(const WideBeams& beams, std::size_t num_rays) {
  if (num_rays == 0) return;
  RayTile& rays = batch_.rays;
  std::fill_n(rays.range_m, num_rays, static_cast<float>(spec_.range_max_m));
  std::fill_n(rays.surface, num_rays, 0U);
  for (float* values : {rays.normal_x, rays.normal_y, rays.normal_z}) {
    std::fill_n(values, num_rays, 0.0F);
  }
  rays.mask = beams.rays.mask;
  const std::size_t num = batch_.Pad(num_rays);
  beams.caster.Cast(rays);
  batch_.Respond(beams, kernels_, num, num_rays, found_);
}

void SubRayParts::Find(const WideBeams& beams, const DetectTile& first, PartLists& lists) {
  found_.clear();
  RayTile& rays = batch_.rays;
  const BeamFrame& frame = beams.frame;
  std::size_t num_rays = 0;
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    const baseline::Direction d{beams.rays.direction_x[lane], beams.rays.direction_y[lane],
                                beams.rays.direction_z[lane]};
    const baseline::BeamAxes axes = baseline::AxesOf(d, frame);
    const float per_unit = 1.0F / baseline::LengthOf(axes);
    const float sigma_h = frame.sigma_h_rad * per_unit;
    const float sigma_v = frame.sigma_v_rad * per_unit;
    const PatternTurn turn = TurnOfPattern(spec_.seed, first.frame, first.firing[lane]);
    for (const SubRay& sub_ray : pattern_.sub_rays) {
      const SubRay turned = Turned(sub_ray, turn.cosine, turn.sine);
      const baseline::Direction aim =
          baseline::Beside(d, axes, sigma_h * turned.h, sigma_v * turned.v);
      rays.origin_x[num_rays] = beams.rays.origin_x[lane];
      rays.origin_y[num_rays] = beams.rays.origin_y[lane];
      rays.origin_z[num_rays] = beams.rays.origin_z[lane];
      rays.direction_x[num_rays] = aim.x;
      rays.direction_y[num_rays] = aim.y;
      rays.direction_z[num_rays] = aim.z;
      rays.shutter[num_rays] = beams.rays.shutter[lane];
      batch_.Describe(num_rays, sub_ray.share, sub_ray.share, 0.0F);
      if (++num_rays < kTileSize) continue;
      Flush(beams, num_rays);
      num_rays = 0;
    }
  }
  Flush(beams, num_rays);
  lists.parts.clear();
  const auto num = static_cast<std::ptrdiff_t>(pattern_.sub_rays.size());
  auto part = found_.begin();
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    lists.begin[lane] = lists.parts.size();
    lists.parts.insert(lists.parts.end(), part, part + num);
    lists.parts.push_back(CellOf(ComponentOf(first, lane), pattern_.central_share, spec_));
    part += num;
  }
  lists.begin[first.num_rays] = lists.parts.size();
}

}  // namespace railcast
