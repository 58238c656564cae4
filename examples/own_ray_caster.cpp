// own_ray_caster.cpp: scans the wall of own_world.cpp, but the program itself finds the hits.
#include <railcast/railcast.h>

#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <vector>

class StandingVehicle final : public railcast::World {
 public:
  railcast::Transform WorldFromVehicle(std::int64_t) const override {
    return railcast::Transform::Identity();
  }
  int HomeChunk(std::int64_t) const override { return 0; }
  std::vector<int> ChunksInReach(int, double) const override { return {}; }
  railcast::Transform WorldFromChunk(int) const override { return railcast::Transform::Identity(); }
  railcast::Chunk BuildChunk(int) const override { return {}; }
  const std::vector<railcast::SceneObject>& objects() const override { return objects_; }
  railcast::Transform WorldFromObject(std::size_t, std::int64_t) const override {
    return railcast::Transform::Identity();
  }

 private:
  std::vector<railcast::SceneObject> objects_;
};

class WallCaster final : public railcast::RayCaster {
 public:
  void Cast(railcast::RayTile& rays) const override {
    for (std::size_t i = 0; i < rays.num_rays; ++i) {
      const float range_m = (40.0F - rays.origin_x[i]) / rays.direction_x[i];
      if (!(range_m > 0.0F && range_m < rays.range_m[i])) continue;
      rays.range_m[i] = range_m;
      rays.normal_x[i] = -1.0F;
      rays.surface[i] = 1;  // An index into the surfaces below; 0 is nothing.
    }
  }
};

int main() {
  const railcast::RasterSpec raster{
      .horizontal_fov_deg = 60.0, .vertical_fov_deg = 30.0, .angular_resolution_deg = 0.5};
  railcast::SimulatorSpec spec;
  spec.detector.effects = railcast::EffectsOfRung(railcast::Fidelity::kSurface);
  railcast::Simulator simulator(std::make_shared<StandingVehicle>(),
                                railcast::BuildScanPattern({.rate_hz = 10.0, .pattern = raster}),
                                railcast::MaterialLibrary({{"concrete", 0.4}}), spec, 0);
  const WallCaster caster;
  const std::vector<railcast::Surface> surfaces = {{}, {.label = 7, .material = 1}};
  railcast::Frame frame;
  simulator.Scan(0, {caster, railcast::Transform::Identity(), surfaces}, frame);
  std::size_t num_on_wall = 0;
  for (const std::uint32_t label : frame.label) num_on_wall += label == 7 ? 1 : 0;
  std::cout << num_on_wall << " of " << frame.num_slots() << " slots are on the wall\n";
  return num_on_wall == frame.num_slots() ? 0 : 1;
}
