#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "core/detect/detector/detector.h"
#include "railcast/outcome.h"
#include "railcast/ray_caster.h"
#include "railcast/transform.h"
#include "tests/support/ray_cast.h"

namespace railcast {

/// Beams along +x that meet surfaces at normal incidence, for tests of a detector without a scene.
struct FacingBeams {
  std::uint32_t frame = 1;
  std::uint32_t num_firings = 1U << 18U;  ///< A multiple of kTileSize.
  LaneOptics optics = LaneOpticsOf({.diffuse = 0.5F, .specular_roughness = 0.3F});
  /// Range of the surface by firing; NaN = no surface.
  std::function<double(std::uint32_t)> range_m = [](std::uint32_t) { return std::nan(""); };
  std::function<std::uint32_t(std::uint32_t)> channel = [](std::uint32_t) { return 0U; };
  std::uint32_t num_channels = 1;
  /// Where the beam starts, by firing: fog differs from place to place.
  std::function<float(std::uint32_t)> origin_y_m = [](std::uint32_t) { return 0.0F; };
};

/// The rays of 256 firings from `begin` on.
inline void AimRays(const FacingBeams& beams, std::uint32_t begin, RayTile& rays) {
  rays.num_rays = kTileSize;
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    SetRay(rays, i, {{0.0F, beams.origin_y_m(begin + i), 0.0F}, Eigen::Vector3f::UnitX()}, 0.0F);
  }
}

/// Fills the hits of 256 firings from `begin` on with everything that Detector::Respond expects.
inline void FillHits(const FacingBeams& beams, std::uint32_t begin, EchoTiles& echoes) {
  echoes.ClearMore();
  DetectTile& tile = echoes.first;
  tile.num_rays = kTileSize;
  tile.frame = beams.frame;
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    const auto range_m = static_cast<float>(beams.range_m(begin + i));
    const bool is_hit = !std::isnan(range_m);
    tile.firing[i] = begin + i;
    tile.echo[i] = 0;
    tile.channel[i] = beams.channel(begin + i);
    tile.direction_x[i] = 1.0F;
    tile.direction_y[i] = 0.0F;
    tile.direction_z[i] = 0.0F;
    tile.surface[i] = is_hit ? 1 : 0;
    tile.true_range_m[i] = range_m;
    tile.cos_incidence[i] = is_hit ? 1.0F : range_m;
    tile.normal_up[i] = 0.0F;
    tile.spread_m[i] = 0.0F;
    tile.share[i] = 1.0F;
    tile.peak_shift_m[i] = 0.0F;
    tile.reflectivity[i] = beams.optics.diffuse;
    tile.diffuse_a[i] = beams.optics.a;
    tile.diffuse_b[i] = beams.optics.b;
    tile.specular_f0[i] = beams.optics.f0;
    tile.specular_alpha2[i] = beams.optics.alpha2;
    tile.retro[i] = beams.optics.retro;
    tile.outcome[i] = static_cast<std::uint32_t>(is_hit ? Outcome::kReturned : Outcome::kNoSurface);
    tile.clutter[i] = kNoClutter;
  }
}

/// The result of one echo.
struct FacingEcho {
  std::uint32_t firing{};
  std::uint32_t echo{};
  std::uint32_t clutter{};  ///< Label, or kNoClutter.
  Outcome outcome{};
  float true_range_m{}, range_m{}, power_ratio{}, intensity{};

  bool operator==(const FacingEcho&) const = default;
};

/// Detects all firings and returns all echoes. In each tile, the first echoes of the firings
/// precede the echoes that were added.
inline std::vector<FacingEcho> DetectFacing(const DetectorSpec& spec, const FacingBeams& beams) {
  const Detector detector(spec, {.num_channels = beams.num_channels});
  auto echoes = std::make_unique<EchoTiles>();
  auto rays = std::make_unique<RayTile>();
  std::vector<FacingEcho> all;
  const auto store = [&](const DetectTile& tile, std::size_t i) {
    all.push_back({tile.firing[i], tile.echo[i], tile.clutter[i],
                   static_cast<Outcome>(tile.outcome[i]), tile.true_range_m[i], tile.range_m[i],
                   tile.power_ratio[i], tile.intensity[i]});
  };
  for (std::uint32_t begin = 0; begin < beams.num_firings; begin += kTileSize) {
    FillHits(beams, begin, *echoes);
    detector.Respond(echoes->first);
    AimRays(beams, begin, *rays);
    detector.Detect({*rays, Transform::Identity(), 0.0}, *echoes);
    for (std::size_t i = 0; i < kTileSize; ++i) store(echoes->first, i);
    for (std::size_t i = 0; i < echoes->num_more(); ++i) {
      const auto [tile, lane] = echoes->more(i);
      store(tile, lane);
    }
  }
  return all;
}

/// Selects the echoes that no surface sends.
inline std::vector<FacingEcho> ClutterOf(const std::vector<FacingEcho>& all) {
  std::vector<FacingEcho> clutter;
  for (const FacingEcho& echo : all) {
    if (echo.clutter != kNoClutter) clutter.push_back(echo);
  }
  return clutter;
}

}  // namespace railcast
