#include "core/detect/beam/mirror_paths.h"

#include <algorithm>
#include <cmath>

#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/added_echo.h"
#include "railcast/lidar.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

// Echoes weaker than this are detected in at most one case of 1000.
constexpr float kLeastImageRatio = 0.3F;

/// A vector's part along a mirror's normal, twice: what a reflection takes from it.
float TwiceAlong(const MirrorHit& hit, float x, float y, float z) {
  return 2.0F * (hit.normal[0] * x + hit.normal[1] * y + hit.normal[2] * z);
}

// Repeats the last ray until the last packet is full.
void PadPacket(RayTile& rays, std::size_t num) {
  rays.num_rays = num;
  for (; rays.num_rays % kPacketSize != 0; ++rays.num_rays) {
    const std::size_t to = rays.num_rays;
    for (float* values : {rays.origin_x, rays.origin_y, rays.origin_z, rays.direction_x,
                          rays.direction_y, rays.direction_z, rays.shutter, rays.range_m,
                          rays.normal_x, rays.normal_y, rays.normal_z}) {
      values[to] = values[num - 1];
    }
    rays.surface[to] = rays.surface[num - 1];
  }
}

}  // namespace

bool HasMirrorPaths(const DetectorSpec& spec) {
  return spec.weather.puddle_share > 0.0 || spec.has_mirrors;
}

MirrorPaths::MirrorPaths(const DetectorSpec& spec, const Kernels& kernels)
    : kernels_(kernels),
      label_(spec.clutter_labels.mirror_image),
      range_min_m_(static_cast<float>(spec.range_min_m)),
      range_max_m_(static_cast<float>(spec.range_max_m)),
      same_echo_m_(static_cast<float>(2.0 * PulseSigma_m(spec.beam))),
      least_ratio_(spec.effects.detection ? kLeastImageRatio : 0.0F) {}

void MirrorPaths::Bounce(const WideBeams& beams, Work& work) const {
  const RayTile& rays = beams.rays;
  RayTile& bounced = work.bounced;
  for (std::size_t k = 0; k < work.hits.size(); ++k) {
    const MirrorHit& hit = work.hits[k];
    const std::size_t i = hit.lane;
    const float range_m = rays.range_m[i];
    const float along =
        TwiceAlong(hit, rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
    bounced.direction_x[k] = rays.direction_x[i] - along * hit.normal[0];
    bounced.direction_y[k] = rays.direction_y[i] - along * hit.normal[1];
    bounced.direction_z[k] = rays.direction_z[i] - along * hit.normal[2];
    bounced.origin_x[k] = rays.origin_x[i] + range_m * rays.direction_x[i] +
                          hit.lift_m * hit.normal[0] + hit.ahead_m * bounced.direction_x[k];
    bounced.origin_y[k] = rays.origin_y[i] + range_m * rays.direction_y[i] +
                          hit.lift_m * hit.normal[1] + hit.ahead_m * bounced.direction_y[k];
    bounced.origin_z[k] = rays.origin_z[i] + range_m * rays.direction_z[i] +
                          hit.lift_m * hit.normal[2] + hit.ahead_m * bounced.direction_z[k];
    bounced.shutter[k] = rays.shutter[i];
    bounced.range_m[k] = std::max(range_max_m_ - range_m - hit.ahead_m, 0.0F);
    bounced.surface[k] = 0;
    bounced.normal_x[k] = bounced.normal_y[k] = bounced.normal_z[k] = 0.0F;
  }
  bounced.mask = rays.mask;
  PadPacket(bounced, work.hits.size());
  beams.caster.Cast(bounced);
}

void MirrorPaths::Unfold(const WideBeams& beams, Work& work) {
  const RayTile& rays = beams.rays;
  const RayTile& bounced = work.bounced;
  RayTile& images = work.images;
  for (std::size_t k = 0; k < work.hits.size(); ++k) {
    const MirrorHit& hit = work.hits[k];
    const std::size_t i = hit.lane;
    const float along =
        TwiceAlong(hit, bounced.normal_x[k], bounced.normal_y[k], bounced.normal_z[k]);
    images.origin_x[k] = rays.origin_x[i];
    images.origin_y[k] = rays.origin_y[i];
    images.origin_z[k] = rays.origin_z[i];
    images.direction_x[k] = rays.direction_x[i];
    images.direction_y[k] = rays.direction_y[i];
    images.direction_z[k] = rays.direction_z[i];
    images.shutter[k] = rays.shutter[i];
    images.range_m[k] = rays.range_m[i] + hit.ahead_m + bounced.range_m[k];
    images.surface[k] = bounced.surface[k];
    images.normal_x[k] = bounced.normal_x[k] - along * hit.normal[0];
    images.normal_y[k] = bounced.normal_y[k] - along * hit.normal[1];
    images.normal_z[k] = bounced.normal_z[k] - along * hit.normal[2];
  }
  PadPacket(images, work.hits.size());
}

void MirrorPaths::Respond(const WideBeams& beams, Work& work) const {
  DetectTile& tile = work.tile;
  tile.num_rays = work.images.num_rays;
  ResolveHits(work.images, beams.table, tile);
  kernels_.incidence(work.images, tile);
  kernels_.spread(work.images, beams.frame, tile);
  // Snow lies on the upper side of things, not of their images.
  const RayTile& real = work.bounced;
  const auto& up = beams.mirrors->up;
  for (std::size_t k = 0; k < work.hits.size(); ++k) {
    if (real.surface[k] == 0) continue;
    const float x = real.normal_x[k];
    const float y = real.normal_y[k];
    const float z = real.normal_z[k];
    const float wound_up = x * up[0] + y * up[1] + z * up[2];
    const float along = x * real.direction_x[k] + y * real.direction_y[k] + z * real.direction_z[k];
    const float of_side = along > 0.0F ? -wound_up : wound_up;
    tile.normal_up[k] = of_side / std::sqrt(x * x + y * y + z * z);
  }
  DimMirrors(*beams.mirrors, work.bounced, tile);
  beams.detector.Respond(tile);
}

void MirrorPaths::AddEchoes(const WideBeams& beams, Work& work, EchoTiles& echoes) const {
  std::erase_if(work.hits,
                [&](const MirrorHit& hit) { return beams.rays.range_m[hit.lane] < range_min_m_; });
  if (work.hits.empty()) return;
  Bounce(beams, work);
  Unfold(beams, work);
  Respond(beams, work);
  for (std::size_t k = 0; k < work.hits.size(); ++k) {
    const MirrorHit& hit = work.hits[k];
    const float beyond_m = hit.ahead_m + work.bounced.range_m[k];
    if (work.bounced.surface[k] == 0 || beyond_m < same_echo_m_) continue;
    const float ratio = hit.there_and_back * work.tile.power_ratio[k];
    if (!(ratio >= least_ratio_)) continue;
    const AddedEcho image{label_, EchoTiles::kMirrorImage, work.tile.true_range_m[k], ratio,
                          hit.there_and_back * work.tile.intensity[k]};
    const auto [tile, lane] = AddEcho(hit.lane, image, echoes);
    tile.surface[lane] = work.bounced.surface[k];
    tile.reflectivity[lane] = echoes.first.reflectivity[hit.lane];
  }
}

}  // namespace railcast
