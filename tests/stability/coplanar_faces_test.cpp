#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/fidelity/frame_comparison.h"
#include "core/scene/shapes.h"
#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/plain_embree.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Where faces lie in one plane, rounding decides which of them a beam hits. The decision must be
// the same in every run and with any number of threads.

/// Triangles strewn over the plane z = -2 so that they overlap each other.
Mesh Strewn(std::uint32_t seed, std::uint32_t num_triangles) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < num_triangles; ++i) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const auto words = RandomWords(seed, RandomUse::kGrassPlacement, corner, i);
      const auto place = RandomWords(seed, RandomUse::kGrassPlacement, 3, i);
      mesh.vertices.emplace_back(60.0F * UnitFloat(place[0]) + 4.0F * UnitFloat(words[0]),
                                 60.0F * UnitFloat(place[1]) - 30.0F + 4.0F * UnitFloat(words[1]),
                                 -2.0F);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// Two floors and two layers of strewn triangles, all in one plane.
std::vector<Part> Layers() {
  return {{MakeFloor(-2.0F, 300.0F), 1, 1},
          {MakeFloor(-2.0F, 200.0F), 2, 2},
          {Strewn(1, 20'000), 3, 3},
          {Strewn(2, 20'000), 1, 4}};
}

std::shared_ptr<SimpleWorld> CoplanarWorld() {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = Layers();
  world->AddObject(std::make_shared<Model>(Model{"mat", {{MakeFloor(-2.0F, 5.0F), 2, 5}}}),
                   MakeTransform(Eigen::Matrix3d::Identity(), {15.0, 0.0, 0.0}));
  world->AddObject(std::make_shared<Model>(Model{"sledge", {{MakeFloor(-2.0F, 5.0F), 2, 6}}}),
                   MakeTransform(Eigen::Matrix3d::Identity(), {20.0, 3.0, 0.0}), {1.0, 0.0, 0.0});
  return world;
}

TEST(CoplanarFaces, HaveTheSameLabelOnEveryRunAtAnyNumberOfThreads) {
  const auto world = CoplanarWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  const Frame first = ScanOnce(world, pattern, {}, 3, 1);
  std::vector<bool> was_seen(7);
  for (const std::uint32_t label : first.label) was_seen[label] = true;
  EXPECT_EQ(was_seen, std::vector<bool>(7, true)) << "no layer hides another";
  for (const int num_threads : {1, 2, 8}) {
    Simulator simulator(world, pattern, TestMaterials(), {}, num_threads);
    Simulator second(world, pattern, TestMaterials(), {}, num_threads);
    Frame frame;
    for (int run = 0; run < 10; ++run) {
      simulator.Scan(3, frame);
      ASSERT_EQ(frame.label, first.label) << num_threads << " threads, run " << run;
      ASSERT_EQ(frame.instance, first.instance);
      second.Scan(3, frame);
      ASSERT_EQ(frame.label, first.label) << num_threads << " threads, second simulator";
    }
  }
}

std::vector<Ray> Fan() {
  std::vector<Ray> rays;
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 200; ++column) {
      rays.push_back(RayThrough(Vector3::Zero(), {2.0 + 0.29 * column, 0.56 * row - 28.0, -2.0}));
    }
  }
  return rays;
}

double ShareOfOtherSurfaces(const std::vector<RayHit>& a, const std::vector<RayHit>& b) {
  std::size_t num_other = 0;
  for (std::size_t i = 0; i < a.size(); ++i) num_other += a[i].surface != b[i].surface ? 1 : 0;
  return static_cast<double>(num_other) / static_cast<double>(a.size());
}

// Two habits of a simulator that does not promise this: it traces leftover rays one by one instead
// of in the packets used before, and it attaches meshes in the order in which their loaders finish.
// (A third habit, building with many threads, changed nothing here: 60 builds with 1, 2 and 8
// threads of 200,000 triangles, each of them there twice, gave the same answer on two cores. Embree
// does not promise it.)
TEST(CoplanarFaces, DependOnThePacketAndOnTheOrderOfMeshesWhereTheseAreLeftToChance) {
  const std::vector<Ray> rays = Fan();
  const std::vector<Part> parts = Layers();
  const std::vector<Part> reversed(parts.rbegin(), parts.rend());
  const TraceDevice device;
  const auto packets = CastRays(*SceneOf(device, Model{"layers", parts}), rays, 300.0F);
  EXPECT_EQ(CastRays(*SceneOf(device, Model{"layers", parts}), rays, 300.0F), packets);
  const auto single = PlainEmbree(parts, RTC_SCENE_FLAG_ROBUST, 1).Cast(rays);
  std::vector<RayHit> reordered = PlainEmbree(reversed, RTC_SCENE_FLAG_ROBUST, 1).Cast(rays);
  for (RayHit& hit : reordered) hit.surface = hit.surface == 0 ? 0 : 5 - hit.surface;
  const double by_packet = ShareOfOtherSurfaces(packets, single);
  const double by_order = ShareOfOtherSurfaces(single, reordered);
  RecordRegime(
      "coplanar faces",
      {"single rays instead of packets change " + TwoDigits(100.0 * by_packet) +
           " % of the labels, another order of the meshes " + TwoDigits(100.0 * by_order) + " %",
       "the same labels in every run, at any number of threads"});
  // The order of meshes decides 18 % of the labels with AVX-512, but only 0.2 % with AVX2.
  EXPECT_GT(by_packet, 0.02);
  EXPECT_GT(by_order, 0.0);
}

// Objects that stand inside each other, as mistakes in a scenario or coupled wagons may: no beam
// sees a surface inside of another object, and rounding decides nothing that shows where two faces
// lie in one plane.

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
