// Objects that stand inside each other, as mistakes in a scenario or coupled wagons may: no beam
// sees a surface inside of another object, and rounding decides nothing that shows where two faces
// lie in one plane.
#include <gtest/gtest.h>

#include <memory>

#include "core/fidelity/frame_comparison.h"
#include "core/scene/shapes.h"
#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

struct Block {
  Vector3 low_m, high_m;

  [[nodiscard]] bool HasInside(const Vector3& point_m, double margin_m) const {
    return ((point_m - low_m).array() > margin_m).all() &&
           ((high_m - point_m).array() > margin_m).all();
  }
};

// The second stands a metre into the first, the third is inside of both, and the fourth shares the
// first one's front.
const Block kBlocks[] = {{{10, -3, -2}, {14, 1, 2}},
                         {{11, 0, -1}, {16, 4, 3}},
                         {{12, 0.2, -0.5}, {13, 0.8, 0.5}},
                         {{10, -2, -3}, {12, 0, 0}}};

std::shared_ptr<SimpleWorld> OverlappingBlocks() {
  auto world = std::make_shared<SimpleWorld>();
  std::uint32_t label = 1;
  for (const Block& block : kBlocks) {
    auto model = std::make_shared<Model>();
    model->parts = {{MakeBox({block.low_m, block.high_m}), 2, label++}};
    world->AddObject(model, Transform::Identity());
  }
  return world;
}

Frame ScanBlocks(const EffectSet& effects, int num_threads = 0) {
  SimulatorSpec spec{.detector = {.range_max_m = 100.0, .effects = WithoutRangeErrors(effects)}};
  spec.detector.effects.pointing_jitter = false;
  spec.detector.beam.reference_rays = 64;
  spec.detector.receiver.return_mode = ReturnMode::kTriple;
  return ScanOnce(OverlappingBlocks(), MakeRaster(60.0, 40.0, 0.5), spec, 0, num_threads);
}

TEST(OverlappingObjects, ShowNothingThatIsInsideOfAnother) {
  RecordRegime("objects that stand inside each other", {"-", "nothing inside of another is seen"});
  for (const Fidelity rung : {Fidelity::kGeometry, Fidelity::kSurface, Fidelity::kFootprint}) {
    const Frame frame = ScanBlocks(EffectsOfRung(rung));
    std::size_t num_points = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (!HasPoint(frame.outcome[slot])) continue;
      ++num_points;
      // An echo of two surfaces lies between them. Those of one surface lie on it.
      if (frame.mixed_share[slot - slot % frame.returns] > 0.0F) continue;
      const Vector3 point_m = PointAt(frame, slot);
      for (const Block& block : kBlocks) {
        EXPECT_FALSE(block.HasInside(point_m, 0.02)) << NameOf(rung) << point_m.transpose();
      }
      EXPECT_NE(frame.label[slot], 3U) << "it is inside";
    }
    EXPECT_GT(num_points, 3000U) << NameOf(rung);
  }
}

TEST(OverlappingObjects, AreTheSameAtAnyNumberOfThreads) {
  const Frame one = ScanBlocks(EffectsOfRung(Fidelity::kFootprint), 1);
  const Frame two = ScanBlocks(EffectsOfRung(Fidelity::kFootprint), 2);
  EXPECT_EQ(one.label, two.label);
  EXPECT_EQ(one.instance, two.instance);
}

}  // namespace
}  // namespace railcast
