// own_world.cpp: scans a wall 40 m ahead that is far wider and higher than the field of view.
#include <railcast/railcast.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <vector>

class WallWorld final : public railcast::World {
 public:
  railcast::Transform WorldFromVehicle(std::int64_t) const override {
    return railcast::Transform::Identity();
  }
  int HomeChunk(std::int64_t) const override { return 0; }
  std::vector<int> ChunksInReach(int, double) const override { return {0}; }
  railcast::Transform WorldFromChunk(int) const override { return railcast::Transform::Identity(); }
  railcast::Chunk BuildChunk(int) const override {
    const railcast::Mesh wall{{{40, -99, -99}, {40, 99, -99}, {40, 99, 99}, {40, -99, 99}},
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

int main() {
  const railcast::RasterSpec raster{
      .horizontal_fov_deg = 60.0, .vertical_fov_deg = 30.0, .angular_resolution_deg = 0.5};
  railcast::Simulator simulator(std::make_shared<WallWorld>(),
                                railcast::BuildScanPattern({.rate_hz = 10.0, .pattern = raster}),
                                railcast::MaterialLibrary({{"concrete", 0.4}}),
                                railcast::SimulatorSpec{}, /*num_threads=*/0);
  railcast::Frame frame;
  simulator.Scan(0, frame);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // float32 holds 40 m to 4 um; a few such steps lie between the ray and the point.
    if (frame.label[slot] != 7 || std::abs(frame.x[slot] - 40.0F) > 4e-5F) return 1;
  }
  std::cout << frame.num_slots() << " firings returned from the wall\n";
}
