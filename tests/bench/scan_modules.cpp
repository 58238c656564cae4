#include "tests/bench/scan_modules.h"

#include <tbb/parallel_for.h>

#include <cstring>

#include "core/base/error.h"
#include "core/simulate/scene_store.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNoPoint = 0xFFFFFFFF;  // For the firing of a place without a point.

template <typename Value>
void Append(std::vector<std::uint8_t>& bytes, Value value) {
  std::uint8_t of_value[sizeof(Value)];
  std::memcpy(of_value, &value, sizeof(Value));
  for (const std::uint8_t byte : of_value) bytes.push_back(byte);
}

// Serialises one point by itself, as the published modules 1 and 2 do.
void Append(std::vector<std::uint8_t>& bytes, const ScanModules::Point& point) {
  Append(bytes, point.firing);
  Append(bytes, point.x);
  Append(bytes, point.y);
  Append(bytes, point.z);
  Append(bytes, point.label);
}

}  // namespace

ScanModules::ScanModules(ScenarioSpec scenario, int num_threads)
    : pattern_(BuildScanPattern(scenario.lidar.scan)),
      tiles_(pattern_),
      range_max_m_(static_cast<float>(scenario.lidar.range_max_m)),
      arena_(num_threads) {
  scenario.fidelity = Fidelity::kPlausibility;
  // All modules trace the same scene.
  scenario.world.detail = SceneDetail::kFull;
  effects_ = MakeSimulator(scenario, num_threads);
  one_thread_ = MakeSimulator(scenario, 1);
  trace_of_all_ = effects_->MakeRawTrace(0);
  trace_of_one_ = one_thread_->MakeRawTrace(0);
  const MaterialLibrary materials(scenario.materials);
  scenes_ = std::make_unique<FrameScenes>(
      MakeSceneStore(effects_->shared_world(), materials),
      FrameSceneSpec{.range_max_m = scenario.lidar.range_max_m,
                     .vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount),
                     .duration_ns = tiles_.duration_ns()});
  begun_ = scenes_->Begin(0, pattern_.StampNs(0));
  scene_ = &scenes_->SceneOf(begun_);
}

template <typename Use>
void ScanModules::TraceTile(std::size_t tile, const Use& use) const {
  RayTile rays;
  DetectTile firings;
  tiles_.Aim(tile, scene_->poses, range_max_m_, rays);
  tiles_.Describe(tile, firings);
  scene_->Cast(rays);
  for (std::size_t lane = 0; lane < tiles_.num_firings(tile); ++lane) {
    if (rays.surface[lane] == 0) continue;
    const float range_m = rays.range_m[lane];
    use(tile * kTileSize + lane, Point{.firing = firings.firing[lane],
                                       .x = range_m * firings.direction_x[lane],
                                       .y = range_m * firings.direction_y[lane],
                                       .z = range_m * firings.direction_z[lane],
                                       .label = scene_->surfaces()[rays.surface[lane]].label});
  }
}

template <typename Job>
void ScanModules::ForEachTileInParallel(const Job& job) {
  arena_.execute([&] { tbb::parallel_for(std::size_t{0}, tiles_.num_tiles(), job); });
}

void ScanModules::ScanOnOneThread() {
  for (std::size_t tile = 0; tile < tiles_.num_tiles(); ++tile) {
    TraceTile(tile, [&](std::size_t /*place*/, const Point& point) { Append(bytes_, point); });
  }
}

void ScanModules::ScanUnderALock() {
  ForEachTileInParallel([&](std::size_t tile) {
    TraceTile(tile, [&](std::size_t /*place*/, const Point& point) {
      const std::lock_guard lock(mutex_);
      Append(bytes_, point);
    });
  });
}

void ScanModules::ScanIntoPlaces() {
  places_.assign(tiles_.num_tiles() * kTileSize, {.firing = kNoPoint});
  ForEachTileInParallel([&](std::size_t tile) {
    TraceTile(tile, [&](std::size_t place, const Point& point) { places_[place] = point; });
  });
  SerialiseAtOnce();
}

void ScanModules::ScanWithEffects() {
  effects_->Scan(0, frame_);
  places_.assign(tiles_.num_tiles() * kTileSize, {.firing = kNoPoint});
  ForEachTileInParallel([&](std::size_t tile) {
    DetectTile firings;
    tiles_.Describe(tile, firings);
    for (std::size_t lane = 0; lane < tiles_.num_firings(tile); ++lane) {
      const std::uint32_t slot = tiles_.slots(tile)[lane];
      if (!HasPoint(frame_.outcome[slot])) continue;
      places_[tile * kTileSize + lane] = {.firing = firings.firing[lane],
                                          .x = frame_.x[slot],
                                          .y = frame_.y[slot],
                                          .z = frame_.z[slot],
                                          .label = frame_.label[slot]};
    }
  });
  SerialiseAtOnce();
}

void ScanModules::SerialiseAtOnce() {
  std::erase_if(places_, [](const Point& point) { return point.firing == kNoPoint; });
  bytes_.resize(places_.size() * sizeof(Point));
  std::memcpy(bytes_.data(), places_.data(), bytes_.size());
}

std::span<const std::uint8_t> ScanModules::Scan(int module) {
  bytes_.clear();
  switch (module) {
    case 1:
      ScanOnOneThread();
      break;
    case 2:
      ScanUnderALock();
      break;
    case 3:
      ScanIntoPlaces();
      break;
    case 4:
      ScanWithEffects();
      break;
    default:
      throw InputError("module: must be 1 to 4 (got " + std::to_string(module) + ")");
  }
  return bytes_;
}

}  // namespace railcast
