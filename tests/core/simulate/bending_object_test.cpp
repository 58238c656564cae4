#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/units.h"
#include "railcast/simulator.h"
#include "tests/core/simulate/turning_leaf.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr double kDistance_m = TurningLeaf::kDistance_m;
constexpr double kTurn_radps = TurningLeaf::kTurn_radps;

/// With a second leaf that stands still, `gap_m` behind the hinge.
class HingedWorld : public TurningLeaf {
 public:
  explicit HingedWorld(double gap_m, bool moves = true) : TurningLeaf(moves), gap_m_(gap_m) {
    objects_.front().pieces = {objects_.front().model, objects_.front().model};
  }
  [[nodiscard]] std::vector<Transform> WorldFromPieces(std::size_t object,
                                                       std::int64_t time_ns) const override {
    return {WorldFromObject(object, time_ns),
            Transform(Eigen::Translation3d(kDistance_m + gap_m_, 0.0, 0.0))};
  }

 private:
  double gap_m_;
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

/// HingedWorld whose sensor's place is known, so that it may be coarser far away.
class KnownHingedWorld final : public HingedWorld {
 public:
  using HingedWorld::HingedWorld;
  [[nodiscard]] std::vector<Transform> VehiclePosesIn(int) const override {
    return {Transform::Identity()};
  }
};

TEST(BendingObjects, AreOffByAnEighthOfTheFiringsSpacingAtMost) {
  const ScanPattern pattern = MakeRaster(10.0, 5.0, 0.5);
  const auto world = std::make_shared<KnownHingedWorld>(1000.0);
  const Frame coarser = ScanOnce(world, pattern);
  const Frame full = ScanOnce(world, pattern, {.has_full_detail = true});
  const double spacing_m = RadFromDeg(0.5) * kDistance_m;
  double most_m = 0.0;
  for (std::size_t slot = 0; slot < full.num_slots(); ++slot) {
    ASSERT_EQ(coarser.instance[slot], full.instance[slot]) << slot;
    if (full.instance[slot] != 1) continue;
    const double off_m = std::abs(static_cast<double>(coarser.range_m[slot] - full.range_m[slot]));
    most_m = std::max(most_m, off_m);
  }
  EXPECT_LT(most_m, spacing_m / 8.0);
  // Of a leaf that turns, little can be seen of it.
  EXPECT_GT(most_m, 1e-5);
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
