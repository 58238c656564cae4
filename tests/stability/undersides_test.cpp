// Snow lies on the upper side of things. The sign of a normal does not tell which side that is,
// since meshes are wound either way; the side that the sensor sees does. Without it, snow lies on
// ceilings, the undersides of bridges and canopies.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint16_t kDarkPaint = 1;  // Reflectivity 0.1.
constexpr std::uint16_t kFreshSnow = 3;
constexpr std::uint32_t kFloorLabel = 4;
constexpr std::uint32_t kCeilingLabel = 5;

Mesh WoundEither(Mesh mesh, bool is_inwards) {
  for (auto& triangle : mesh.triangles) {
    if (is_inwards) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

Frame BetweenFloorAndCeiling(bool is_inwards, Fidelity rung, double snow_cover) {
  const auto world =
      WorldOfParts({{WoundEither(MakeFloor(-2.0F, 60.0F), is_inwards), kDarkPaint, kFloorLabel},
                    {WoundEither(MakeFloor(3.0F, 60.0F), is_inwards), kDarkPaint, kCeilingLabel}});
  SimulatorSpec spec{.detector = {.effects = EffectsOfRung(rung)}, .snow_material = kFreshSnow};
  spec.detector.weather.snow_cover = snow_cover;
  spec.detector.beam.reference_rays = 64;
  return ScanOnce(world, MakeRaster(10.0, 60.0, 1.0), spec);
}

TEST(Undersides, CarryNoSnow) {
  RecordRegime("lying snow and meshes wound either way",
               {"the sign of the normal: snow on ceilings and the undersides of bridges",
                "on upper sides alone"});
  for (const Fidelity rung : {Fidelity::kSurface, Fidelity::kFootprint, Fidelity::kReference}) {
    for (const bool is_inwards : {false, true}) {
      const Frame bare = BetweenFloorAndCeiling(is_inwards, rung, 0.0);
      const Frame snowy = BetweenFloorAndCeiling(is_inwards, rung, 1.0);
      int num_on_floor = 0;
      int num_on_ceiling = 0;
      for (std::size_t slot = 0; slot < bare.num_slots(); ++slot) {
        if (!HasPoint(bare.outcome[slot]) || !HasPoint(snowy.outcome[slot])) continue;
        if (bare.label[slot] == kFloorLabel) {
          EXPECT_GT(snowy.intensity[slot], 2.0F * bare.intensity[slot]);
          ++num_on_floor;
        } else {
          EXPECT_EQ(snowy.intensity[slot], bare.intensity[slot]);
          ++num_on_ceiling;
        }
      }
      EXPECT_GT(num_on_floor, 100) << NameOf(rung);
      EXPECT_GT(num_on_ceiling, 100) << NameOf(rung);
    }
  }
}

}  // namespace
}  // namespace railcast
