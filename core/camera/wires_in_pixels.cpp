#include "core/camera/wires_in_pixels.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace railcast {
namespace {

Eigen::Vector3f PixelDirectionOf(const RayTile& rays, std::size_t ray) {
  return {rays.direction_x[ray], rays.direction_y[ray], rays.direction_z[ray]};
}

Eigen::Vector3f PointOnWire(const RayTile& rays, const WireCapture& wire) {
  const Eigen::Vector3f origin(rays.origin_x[wire.lane], rays.origin_y[wire.lane],
                               rays.origin_z[wire.lane]);
  return origin + wire.range_m * PixelDirectionOf(rays, wire.lane);
}

/// Points a ray from each of up to kTileSize wires to the sun.
void PutRaysToSun(const RayTile& pixels,
                  const Eigen::Vector3f& to_sun,
                  float reach_m,
                  std::span<const WireCapture> wires,
                  RayTile& rays) {
  rays.num_rays = (wires.size() + kPacketSize - 1) / kPacketSize * kPacketSize;
  rays.mask = kAllButWires;
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const WireCapture& wire = wires[std::min(i, wires.size() - 1)];
    PutRay(PointOnWire(pixels, wire), to_sun, reach_m, i, rays);
  }
}

/// The mean over the half of the wire's surface that is seen, each part by its width in the image.
Radiance WireColorOf(const WireCapture& wire,
                     const Eigen::Vector3f& direction,
                     const Radiance& reflectance,
                     bool is_lit,
                     const Daylight& daylight) {
  Eigen::Vector3f front = wire.axis.dot(direction) * wire.axis - direction;
  // Where a wire is seen end-on, its sides all face the camera alike.
  front = front.norm() > 1e-4F ? front.normalized() : Eigen::Vector3f(-direction);
  const Eigen::Vector3f side = wire.axis.cross(front);
  Radiance sum = Radiance::Zero();
  constexpr std::array<float, 4> kPlaces = {-0.75F, -0.25F, 0.25F, 0.75F};
  for (const float place : kPlaces) {
    const Eigen::Vector3f normal = std::sqrt(1.0F - place * place) * front + place * side;
    sum += daylight.Surface(reflectance, normal, is_lit);
  }
  return sum / static_cast<float>(kPlaces.size());
}

}  // namespace

void WiresInPixels::Find(const RayTile& pixels, const BeamShape& shape, const SceneOfFrame& scene) {
  captures_.clear();
  if (scene.wires == nullptr) return;
  CaptureWires(pixels, shape, *scene.wires, captures_);
  std::size_t next = 0;
  for (std::size_t lane = 0; lane < kTileSize; ++lane) {
    first_[lane] = next;
    while (next < captures_.size() && captures_[next].lane == lane) ++next;
  }
  first_[kTileSize] = next;
}

void WiresInPixels::Shade(const RayTile& pixels,
                          const SceneOfFrame& scene,
                          const std::vector<Vector3>& colors,
                          const Daylight& daylight,
                          float reach_m) {
  colors_.clear();
  RayTile to_sun;
  for (std::size_t first = 0; first < captures_.size(); first += kTileSize) {
    const std::span<const WireCapture> wires =
        std::span(captures_).subspan(first, std::min(kTileSize, captures_.size() - first));
    if (daylight.has_sun()) {
      PutRaysToSun(pixels, daylight.to_sun(), reach_m, wires, to_sun);
      scene.caster.Cast(to_sun);
    }
    for (std::size_t i = 0; i < wires.size(); ++i) {
      const WireCapture& wire = wires[i];
      const Radiance reflectance = colors[scene.surfaces[wire.surface].material].cast<float>();
      const bool is_lit = daylight.has_sun() && to_sun.surface[i] == 0;
      const Radiance radiance =
          WireColorOf(wire, PixelDirectionOf(pixels, wire.lane), reflectance, is_lit, daylight);
      colors_.push_back(daylight.ThroughAir(radiance, wire.range_m));
    }
  }
}

Radiance WiresInPixels::Over(const RayTile& behind, std::size_t ray, const Radiance& color) const {
  const std::span<const WireCapture> wires =
      std::span(captures_).subspan(first_[ray], first_[ray + 1] - first_[ray]);
  Radiance sum = Radiance::Zero();
  float rest = 1.0F;
  for (std::size_t i = 0; i < wires.size(); ++i) {
    if (wires[i].range_m >= behind.range_m[ray]) break;
    const float shown = wires[i].share * (1.0F - HiddenShare(wires[i], wires.first(i)));
    const float share = std::min(rest, shown);
    sum += share * colors_[first_[ray] + i];
    rest -= share;
  }
  return sum + rest * color;
}

}  // namespace railcast
