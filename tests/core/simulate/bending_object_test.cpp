#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/units.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr double kDistance_m = 20.0;
constexpr double kTurn_radps = 4.0;  // As fast as a shank swings.

/// A square of 8 m in the plane x = 0, 4 m to each side of a hinge along z.
std::shared_ptr<const Model> Leaf() {
  Mesh mesh;
  mesh.vertices = {{0, -4, -4}, {0, 4, -4}, {0, 4, 4}, {0, -4, 4}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return std::make_shared<const Model>(Model{"leaf", {{mesh, 3, 3}}});
}

/// An object before the sensor whose first piece turns about its hinge and whose second stands
/// still, `gap_m` behind it.
class HingedWorld final : public World {
 public:
  explicit HingedWorld(double gap_m, bool moves = true) : gap_m_(gap_m) {
    const auto leaf = Leaf();
    objects_.push_back({.name = "gate",
                        .type = "mesh",
                        .label = 3,
                        .instance = 1,
                        .model = leaf,
                        .moves = moves,
                        .pieces = {leaf, leaf},
                        .pose_step_ns = 10'000'000});
  }
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t) const override {
    return Transform::Identity();
  }
  [[nodiscard]] int HomeChunk(std::int64_t) const override { return 0; }
  [[nodiscard]] std::vector<int> ChunksInReach(int, double) const override { return {0}; }
  [[nodiscard]] Transform WorldFromChunk(int) const override { return Transform::Identity(); }
  [[nodiscard]] Chunk BuildChunk(int) const override { return {}; }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t, std::int64_t) const override {
    return Transform(Eigen::Translation3d(kDistance_m, 0.0, 0.0));
  }
  [[nodiscard]] std::vector<Transform> WorldFromPieces(std::size_t object,
                                                       std::int64_t time_ns) const override {
    const Transform hinge = WorldFromObject(object, time_ns);
    const double angle_rad = objects_.front().moves ? kTurn_radps * SecondsFromNs(time_ns) : 0.0;
    return {hinge * Eigen::AngleAxisd(angle_rad, Vector3::UnitZ()),
            hinge * Eigen::Translation3d(gap_m_, 0.0, 0.0)};
  }

 private:
  double gap_m_;
  std::vector<SceneObject> objects_;
};

TEST(BendingObjects, AreHitWhereEachPieceIsWhenTheBeamComes) {
  const ScanPattern pattern = MakeRaster(10.0, 5.0, 0.5);
  // The standing piece is out of range.
  const Frame frame = ScanOnce(std::make_shared<HingedWorld>(1000.0), pattern);
  std::size_t num_hits = 0;
  double earliest_s = 1.0;
  double latest_s = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.instance[slot] != 1) continue;
    const std::size_t firing = FiringOfSlot(pattern, 1, slot);
    const double time_s = SecondsFromNs(pattern.time_ns[firing]);
    const Vector3 normal(std::cos(kTurn_radps * time_s), std::sin(kTurn_radps * time_s), 0.0);
    const double range_m = kDistance_m * normal.x() / normal.dot(DirectionOf(pattern, firing));
    // Between poses 10 ms apart, rotations are interpolated linearly: 4 m (0.02 rad)^2 / 2 = 0.8
    // mm.
    ASSERT_NEAR(frame.range_m[slot], range_m, 1e-3) << firing;
    ++num_hits;
    earliest_s = std::min(earliest_s, time_s);
    latest_s = std::max(latest_s, time_s);
  }
  EXPECT_EQ(num_hits, pattern.num_firings());
  EXPECT_GT(latest_s - earliest_s, 0.05) << "the sweep sees the piece turn by more than 0.2 rad";
}

TEST(BendingObjects, ShowAllTheirPiecesUnderOneInstance) {
  for (const bool moves : {false, true}) {
    const ScanPattern pattern = MakeRaster(40.0, 5.0, 0.5);
    const auto world = std::make_shared<HingedWorld>(-5.0, moves);
    const Frame frame = ScanOnce(world, pattern);
    // The standing piece is 15 m before the sensor and hides the other one.
    std::size_t num_near = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (frame.instance[slot] != 1) continue;
      const double depth_m = DirectionOf(pattern, FiringOfSlot(pattern, 1, slot)).x() *
                             static_cast<double>(frame.range_m[slot]);
      if (std::abs(depth_m - 15.0) < 1e-3) ++num_near;
    }
    EXPECT_GT(num_near, 0.5 * static_cast<double>(pattern.num_firings()));
  }
}

TEST(BendingObjects, CountEachFiringOnceHoweverManyPiecesItGoesThrough) {
  const ScanPattern pattern = MakeRaster(10.0, 5.0, 0.5);
  for (const bool moves : {false, true}) {
    Simulator simulator(std::make_shared<HingedWorld>(1.0, moves), pattern, TestMaterials(), {}, 1);
    const auto num_firings = static_cast<std::uint32_t>(pattern.num_firings());
    EXPECT_EQ(simulator.ViewObjects(0),
              (std::vector<ObjectView>{{num_firings, num_firings, num_firings, num_firings}}));
  }
}

}  // namespace
}  // namespace railcast
