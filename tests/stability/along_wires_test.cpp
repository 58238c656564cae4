// Wires before wires. From below the contact wire its droppers are straight behind it: it hides
// them, although it fills little of any beam. Simple rules fail: a wire that hides nothing, or that
// dims all that is behind it by its share of the beam. Across the line, wires hide next to nothing
// of each other.
#include <gtest/gtest.h>

#include <memory>

#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint16_t kWireMaterial = 3;
constexpr std::uint32_t kContactWireLabel = 7;
constexpr std::uint32_t kDropperLabel = 8;
constexpr double kContactRadius_m = 0.006;
constexpr double kDropperRadius_m = 0.003;

void AddWire(const Vector3& begin_m,
             const Vector3& end_m,
             std::uint32_t label,
             SimpleWorld& world) {
  const double radius_m = label == kDropperLabel ? kDropperRadius_m : kContactRadius_m;
  world.wires.push_back({.material = kWireMaterial,
                         .label = label,
                         .radius_m = radius_m,
                         .points_m = {begin_m, end_m}});
  Mesh tube = MakeCylinder(radius_m, (end_m - begin_m).norm() / 2.0, 16);
  const auto along_wire = Eigen::Quaternionf::FromTwoVectors(
      Eigen::Vector3f::UnitZ(), (end_m - begin_m).normalized().cast<float>());
  const Eigen::Vector3f middle_m = (0.5 * (begin_m + end_m)).cast<float>();
  for (auto& vertex : tube.vertices) vertex = along_wire * vertex + middle_m;
  world.ground.parts.push_back({tube, kWireMaterial, label, true});
}

// A contact wire along x from above the sensor on, in pieces, and droppers upwards from it.
std::shared_ptr<SimpleWorld> ContactLine(double aside_m) {
  auto world = std::make_shared<SimpleWorld>();
  for (int i = 0; i < 10; ++i) {
    const double x_m = 2.0 + 5.0 * i;
    AddWire({x_m, aside_m, 2.0}, {x_m + 5.0, aside_m, 2.0}, kContactWireLabel, *world);
    AddWire({x_m + 2.5, aside_m, 2.02}, {x_m + 2.5, aside_m, 3.5}, kDropperLabel, *world);
  }
  return world;
}

struct Found {
  double contact_wire{};
  double droppers{};
};

Found CountIn(const std::shared_ptr<SimpleWorld>& world, const EffectSet& effects) {
  SimulatorSpec spec{.detector = {.range_max_m = 100.0, .effects = WithoutRangeErrors(effects)}};
  spec.detector.effects.pointing_jitter = false;
  spec.detector.beam = {.divergence_mrad = {3.0, 3.0}, .reference_rays = 1024};
  spec.detector.receiver.return_mode = ReturnMode::kTriple;
  const Frame frame = ScanOnce(world, MakeRaster(2.0, 40.0, 0.1), spec);
  Found found;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    found.contact_wire += frame.label[slot] == kContactWireLabel ? 1.0 : 0.0;
    found.droppers += frame.label[slot] == kDropperLabel ? 1.0 : 0.0;
  }
  return found;
}

TEST(AlongWires, TheContactWireHidesTheDroppersStraightBehindIt) {
  const auto world = ContactLine(0.0);
  const Found expected = CountIn(world, YardstickEffects());
  const Found found = CountIn(world, EffectsOfRung(Fidelity::kFootprint));
  ASSERT_GT(expected.contact_wire, 300.0);
  EXPECT_EQ(expected.droppers, 0.0);
  EXPECT_EQ(found.droppers, 0.0);
  EXPECT_NEAR(found.contact_wire / expected.contact_wire, 1.0, 0.05) << expected.contact_wire;
  RecordRegime(
      "a contact wire in line with its droppers",
      {"all or nothing, as a ray meets it",
       TwoDigits(found.droppers) + " droppers seen, of the contact wire " +
           TwoDigits(100.0 * found.contact_wire / expected.contact_wire) + " % of the echoes",
       TwoDigits(expected.droppers) + " droppers seen"});
}

TEST(AlongWires, DroppersBesideTheContactWireAreSeen) {
  const auto world = ContactLine(0.3);
  const Found expected = CountIn(world, YardstickEffects());
  const Found found = CountIn(world, EffectsOfRung(Fidelity::kFootprint));
  ASSERT_GT(expected.droppers, 60.0);
  EXPECT_NEAR(found.droppers / expected.droppers, 1.0, 0.05) << expected.droppers;
}

}  // namespace
}  // namespace railcast
