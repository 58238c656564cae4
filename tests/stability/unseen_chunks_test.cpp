// Chunks that no firing meets are traced in their coarsest form. What they look like must not
// matter: frames are the same if there is nothing.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {
namespace {

/// A world whose chunks have no ground, ballast and rails in their coarsest form.
class BareWhereUnseen final : public World {
 public:
  explicit BareWhereUnseen(std::shared_ptr<const World> whole) : whole_(std::move(whole)) {}

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override {
    return whole_->WorldFromVehicle(time_ns);
  }
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override {
    return whole_->HomeChunk(time_ns);
  }
  [[nodiscard]] std::vector<Transform> VehiclePosesIn(int home_chunk) const override {
    return whole_->VehiclePosesIn(home_chunk);
  }
  [[nodiscard]] std::vector<int> ChunksInReach(int chunk, double range_m) const override {
    return whole_->ChunksInReach(chunk, range_m);
  }
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override {
    return whole_->WorldFromChunk(chunk);
  }
  [[nodiscard]] Chunk BuildChunk(int chunk) const override { return whole_->BuildChunk(chunk); }
  [[nodiscard]] std::vector<CoarserSurfaces> CoarserSurfacesOf(int chunk) const override {
    return whole_->CoarserSurfacesOf(chunk);
  }
  [[nodiscard]] Chunk BuildCoarserChunk(int chunk, std::size_t level) const override {
    Chunk built = whole_->BuildCoarserChunk(chunk, level);
    if (level < CoarserSurfacesOf(chunk).size()) return built;
    ++num_bare_;
    for (Part& part : built.ground.parts) part.mesh = {};
    return built;
  }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override {
    return whole_->objects();
  }
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override {
    return whole_->WorldFromObject(object, time_ns);
  }
  [[nodiscard]] std::vector<Transform> WorldFromPieces(std::size_t object,
                                                       std::int64_t time_ns) const override {
    return whole_->WorldFromPieces(object, time_ns);
  }
  [[nodiscard]] int num_bare() const { return num_bare_; }

 private:
  std::shared_ptr<const World> whole_;
  mutable std::atomic<int> num_bare_ = 0;
};

/// Ranges, 0 where there are none.
std::vector<float> RangesOf(const Frame& frame) {
  std::vector<float> ranges_m = frame.true_range_m;
  for (float& range_m : ranges_m) range_m = std::isnan(range_m) ? 0.0F : range_m;
  return ranges_m;
}

// From one chunk into the next, at 300 km/h.
TEST(UnseenChunks, MakeNoDifferenceToAnyFiring) {
  ScenarioSpec spec = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/st_gallen_approach.json");
  spec.fidelity = Fidelity::kSurface;
  spec.world.objects.clear();
  spec.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 83.0}};
  const auto whole = MakeSimulator(spec, 2);
  const auto world = std::make_shared<const BareWhereUnseen>(whole->shared_world());
  Simulator bare(world, whole->pattern(), MaterialLibrary(spec.materials), whole->spec(), 2);
  Frame expected;
  Frame frame;
  for (std::uint32_t index = 0; index < 7; ++index) {
    whole->Scan(index, expected);
    bare.Scan(index, frame);
    EXPECT_EQ(RangesOf(frame), RangesOf(expected)) << index;
    EXPECT_EQ(frame.label, expected.label) << index;
  }
  EXPECT_GE(world->num_bare(), 6);
}

}  // namespace
}  // namespace railcast
