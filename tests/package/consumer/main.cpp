// A host program with a world of its own: it knows nothing of railcast but the installed core.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/frame/frame.h"
#include "core/scan/scan_pattern.h"
#include "core/scene/material.h"
#include "core/scene/world.h"
#include "core/simulate/simulator.h"

namespace {

constexpr double kWallDistance_m = 40.0;

/// A wall across the way, far wider and higher than the field of view.
class WallWorld final : public railcast::World {
 public:
  railcast::Transform WorldFromVehicle(std::int64_t) const override {
    return railcast::Transform::Identity();
  }
  int HomeChunk(std::int64_t) const override { return 0; }
  std::vector<int> ChunksInReach(int, double) const override { return {0}; }
  railcast::Transform WorldFromChunk(int) const override { return railcast::Transform::Identity(); }
  railcast::Chunk BuildChunk(int) const override {
    constexpr auto kX_m = static_cast<float>(kWallDistance_m);
    const railcast::Mesh wall{{{kX_m, -99, -99}, {kX_m, 99, -99}, {kX_m, 99, 99}, {kX_m, -99, 99}},
                              {{0, 1, 2}, {0, 2, 3}}};
    return {.ground = {"wall", {{.mesh = wall, .material = 1, .label = 7}}}, .placements = {}};
  }
  const std::vector<railcast::SceneObject>& objects() const override { return objects_; }
  railcast::Transform WorldFromObject(std::size_t, std::int64_t) const override {
    return railcast::Transform::Identity();
  }

 private:
  std::vector<railcast::SceneObject> objects_;
};

/// The same wall, found by the host itself.
class WallCaster final : public railcast::RayCaster {
 public:
  void Cast(railcast::RayTile& rays) const override {
    for (std::size_t i = 0; i < rays.num_rays; ++i) {
      const float range_m =
          (static_cast<float>(kWallDistance_m) - rays.origin_x[i]) / rays.direction_x[i];
      if (!(range_m > 0.0F && range_m < rays.range_m[i])) continue;
      rays.range_m[i] = range_m;
      rays.normal_x[i] = -1.0F;
      rays.surface[i] = 1;
    }
  }
};

railcast::Frame ScanTheWall(bool host_traces) {
  const railcast::RasterSpec raster{
      .horizontal_fov_deg = 60.0, .vertical_fov_deg = 30.0, .angular_resolution_deg = 0.5};
  railcast::Simulator simulator(std::make_shared<WallWorld>(),
                                railcast::BuildScanPattern({.rate_hz = 10.0, .pattern = raster}),
                                railcast::MaterialLibrary({{"concrete", 0.4}}),
                                railcast::SimulatorSpec{}, 2);
  railcast::Frame frame;
  if (host_traces) {
    const WallCaster caster;
    const std::vector<railcast::Surface> surfaces = {{}, {.label = 7, .material = 1}};
    simulator.Scan(0, {caster, railcast::Transform::Identity(), surfaces}, frame);
  } else {
    simulator.Scan(0, frame);
  }
  return frame;
}

bool AllReturnFromTheWall(const railcast::Frame& frame) {
  // float32 carries 40 m to 4e-6 m; a few such steps lie between ray and point.
  constexpr double kTolerance_m = 4e-5;
  std::size_t num_on_wall = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.outcome[slot] == railcast::Outcome::kReturned && frame.label[slot] == 7 &&
        std::abs(static_cast<double>(frame.x[slot]) - kWallDistance_m) <= kTolerance_m) {
      ++num_on_wall;
    }
  }
  std::printf("%zu of %zu firings returned from the wall\n", num_on_wall, frame.num_slots());
  return num_on_wall == 120 * 60 && frame.num_slots() == 120 * 60;
}

}  // namespace

int main() {
  const bool by_us = AllReturnFromTheWall(ScanTheWall(false));
  const bool by_the_host = AllReturnFromTheWall(ScanTheWall(true));
  return by_us && by_the_host ? 0 : 1;
}
