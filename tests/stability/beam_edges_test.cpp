// Edges through beams, on the published raster and on real sensors, whose channels are sparse,
// staggered and fired one after another: nothing about an edge may depend on where the neighbouring
// beams happen to be. The yardstick is the rung `reference` with 256 sub-rays in every beam.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint32_t kFrontLabel = 7;
constexpr std::uint32_t kBackLabel = 8;
constexpr std::uint16_t kDark = 1;
constexpr std::uint16_t kGrey = 2;
constexpr std::uint16_t kRetro = 4;
constexpr float kFar_m = 40.0F;  // Beyond every sector at the ranges used here.

MaterialLibrary EdgeMaterials() {
  return MaterialLibrary({{"dark", 0.1},
                          {"grey", 0.5},
                          {"white", 1.0},
                          {.name = "sheet", .reflectivity = 0.2, .retroreflectance = 1000.0}});
}

// A plate that faces the sensor.
Mesh MakePlate(float x_m, float right_m, float left_m, float low_m, float high_m) {
  return {
      {{x_m, right_m, low_m}, {x_m, left_m, low_m}, {x_m, left_m, high_m}, {x_m, right_m, high_m}},
      {{0, 1, 2}, {0, 2, 3}}};
}

std::shared_ptr<SimpleWorld> WorldOf(const Mesh& front, std::uint16_t material, float back_m) {
  auto world = std::make_shared<SimpleWorld>();
  const std::uint16_t behind = material == kRetro ? kDark : kGrey;
  world->ground.parts = {{front, material, kFrontLabel},
                         {MakeWall(back_m, kFar_m), behind, kBackLabel}};
  return world;
}

/// Where a beam meets the plane at distance x_m.
Vector3 AtPlane(const Vector3& direction, double x_m) {
  return x_m / direction.x() * direction;
}

// More than four standard deviations of the widest beam, 0.75 mrad, also where it meets the plane
// under 50 deg: 0.01 cos^2(50 deg) = 4.1 mrad.
constexpr double kNear_per_m = 0.01;

/// Whether two places on a plane at distance x_m are so near that a beam at one may reach the
/// other.
bool AreNear(double one_m, double other_m, double x_m) {
  return std::abs(one_m - other_m) < kNear_per_m * x_m;
}

/// A pattern and what it sees.
struct EdgeScan {
  ScanPattern pattern;
  FramePair frames;

  [[nodiscard]] Vector3 DirectionOfSlot(std::size_t slot) const {
    return DirectionOf(pattern, FiringOfSlot(pattern, frames.reference.returns, slot));
  }
};

/// A sensor's view of `half_azimuth_deg_` to either side, with all of its channels.
class EdgesOn : public testing::TestWithParam<std::string> {
 protected:
  EdgesOn()
      : lidar_(ReadMinimalWith(GetParam()).lidar),
        pattern_(BuildScanPattern(CutSector(lidar_.scan, {half_azimuth_deg_, -90.0, 90.0}))) {}

  /// Firings spread over the sector, from each of which an edge is placed.
  [[nodiscard]] std::vector<std::size_t> Firings(std::size_t num) const {
    std::vector<std::size_t> inner;
    for (std::size_t i = 0; i < pattern_.num_firings(); ++i) {
      if (std::abs(Azimuth_rad(i)) < 0.8 * RadFromDeg(half_azimuth_deg_)) inner.push_back(i);
    }
    std::ranges::sort(inner, {}, [&](std::size_t i) { return pattern_.direction_z[i]; });
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < num; ++k) {
      chosen.push_back(inner[(2 * k + 1) * inner.size() / (2 * num)]);
    }
    return chosen;
  }

  [[nodiscard]] double Azimuth_rad(std::size_t firing) const {
    return std::atan2(static_cast<double>(pattern_.direction_y[firing]),
                      static_cast<double>(pattern_.direction_x[firing]));
  }
  [[nodiscard]] Vector3 At(std::size_t firing, double x_m) const {
    return AtPlane(DirectionOf(pattern_, firing), x_m);
  }
  /// Scans with the beams that `is_near` says may be on an edge: all others fill themselves with
  /// one surface.
  [[nodiscard]] EdgeScan Scan(std::shared_ptr<const World> world, const auto& is_near) const {
    EdgeScan scan{Only(pattern_, is_near), {}};
    scan.frames =
        ScanBoth(std::move(world), scan.pattern, EdgeMaterials(), lidar_, Fidelity::kFootprint);
    return scan;
  }

  // The lasers of QT128 look 6 deg and more aside.
  double half_azimuth_deg_ = GetParam() == "qt128" ? 8.0 : 2.0;
  LidarSpec lidar_;
  ScanPattern pattern_;
};

// Wagon walls, platform edges and persons end 6 m before what is behind them. A top edge through a
// beam's lower or upper half has 2 to 98 % of the beam on either side.
TEST_P(EdgesOn, AreNoticedWhereAPlateEndsSixMetresBeforeAWall) {
  constexpr double kPlate_m = 14.0;
  std::size_t num_mixed = 0;
  std::size_t num_noticed = 0;
  const std::vector<std::size_t> firings = Firings(7);
  for (std::size_t k = 0; k < firings.size(); ++k) {
    const double off_rad =
        0.5 * (static_cast<double>(k) - 3.0) * VerticalSigma_rad(lidar_.beam);  // -1.5 to 1.5 sigma
    const double top_m = At(firings[k], kPlate_m).z() + kPlate_m * off_rad;
    const Mesh plate = MakePlate(static_cast<float>(kPlate_m), -kFar_m, kFar_m, -kFar_m,
                                 static_cast<float>(top_m));
    const FramePair frames = Scan(WorldOf(plate, kGrey, 20.0F), [&](const Vector3& direction) {
                               return AreNear(AtPlane(direction, kPlate_m).z(), top_m, kPlate_m);
                             }).frames;
    for (std::size_t slot = 0; slot < frames.reference.num_slots(); ++slot) {
      if (frames.reference.mixed_share[slot] < 0.05F) continue;
      ++num_mixed;
      num_noticed += frames.rung.mixed_share[slot] > 1e-3F ? 1 : 0;
    }
  }
  RecordRegime(
      "a plate's top edge 6 m before a wall",
      {"sees one of the two",
       TwoDigits(100.0 * static_cast<double>(num_noticed) / static_cast<double>(num_mixed)) +
           " % of the mixed beams noticed",
       "the yardstick"});
  EXPECT_GE(num_mixed, 25U);
  EXPECT_GE(static_cast<double>(num_noticed), 0.95 * static_cast<double>(num_mixed))
      << num_noticed << " of " << num_mixed;
}

/// What the beams on the edges of a plate before a wall give.
struct MixedBeams {
  std::size_t num{};        ///< Mixed in the reference.
  std::size_t num_found{};  ///< Mixed in the footprint, too.
  std::vector<double> range_errors_m;
};

// The place of an echo between the plate (0) and the wall (1).
double PlaceOf(double range_m, const Vector3& at_plate, double step_m) {
  const double plate_m = at_plate.norm();
  return (range_m - plate_m) / (plate_m * step_m / at_plate.x());
}

// Pulses of 5 ns merge below 0.64 m: a beam on the edge of a plate gives one echo, between plate
// and wall.
TEST_P(EdgesOn, MixRangesWhereAPlateIsATenthToHalfAMetreBeforeAWall) {
  constexpr double kPlate_m = 20.0;
  MixedBeams mixed;
  for (const double step_m : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    for (const std::size_t firing : Firings(3)) {
      const Vector3 corner = At(firing, kPlate_m);
      const Mesh plate =
          MakePlate(static_cast<float>(kPlate_m), -kFar_m, static_cast<float>(corner.y()), -kFar_m,
                    static_cast<float>(corner.z()));
      const EdgeScan scan = Scan(WorldOf(plate, kGrey, static_cast<float>(kPlate_m + step_m)),
                                 [&](const Vector3& direction) {
                                   const Vector3 place = AtPlane(direction, kPlate_m);
                                   return AreNear(place.y(), corner.y(), kPlate_m) ||
                                          AreNear(place.z(), corner.z(), kPlate_m);
                                 });
      for (std::size_t slot = 0; slot < scan.frames.reference.num_slots(); ++slot) {
        const Vector3 at_plate = AtPlane(scan.DirectionOfSlot(slot), kPlate_m);
        const auto expected_m = static_cast<double>(scan.frames.reference.range_m[slot]);
        const auto found_m = static_cast<double>(scan.frames.rung.range_m[slot]);
        const double expected = PlaceOf(expected_m, at_plate, step_m);
        if (!(expected > 0.05 && expected < 0.95)) continue;
        const double found = PlaceOf(found_m, at_plate, step_m);
        ++mixed.num;
        mixed.num_found += found > 0.01 && found < 0.99 ? 1 : 0;
        mixed.range_errors_m.push_back(std::abs(found_m - expected_m));
      }
    }
  }
  ASSERT_GE(mixed.num, 90U);
  const auto middle =
      mixed.range_errors_m.begin() + static_cast<std::ptrdiff_t>(mixed.range_errors_m.size() / 2);
  std::nth_element(mixed.range_errors_m.begin(), middle, mixed.range_errors_m.end());
  RecordRegime(
      "a plate's corner 0.1 to 0.5 m before a wall",
      {"ranges one of the two",
       TwoDigits(100.0 * static_cast<double>(mixed.num_found) / static_cast<double>(mixed.num)) +
           " % of the mixed echoes, median error " + TwoDigits(1e3 * *middle) + " mm",
       "the yardstick"});
  EXPECT_GE(static_cast<double>(mixed.num_found), 0.9 * static_cast<double>(mixed.num))
      << mixed.num_found << " of " << mixed.num;
  EXPECT_LE(*middle, 0.010);
}

// Half a milliradian from the sheet, a beam's centre is on the wall, and its flank on a surface
// ten thousand times as bright.
TEST_P(EdgesOn, LetARetroreflectorBesideABeamOutshineTheWallThatItsCentreMeets) {
  constexpr double kSheet_m = 20.0;
  constexpr double kBeside_rad = 0.5e-3;
  for (const double step_m : {0.02, 0.3}) {
    std::size_t num_beams = 0;
    double expected = 0.0;
    double found = 0.0;
    for (const std::size_t firing : Firings(8)) {
      const double edge_m = kSheet_m * std::tan(Azimuth_rad(firing) + kBeside_rad);
      const Mesh sheet = MakePlate(static_cast<float>(kSheet_m), static_cast<float>(edge_m), kFar_m,
                                   -kFar_m, kFar_m);
      const EdgeScan scan =
          Scan(WorldOf(sheet, kRetro, static_cast<float>(kSheet_m + step_m)),
               [&](const Vector3& direction) {
                 return AreNear(AtPlane(direction, kSheet_m).y(), edge_m, kSheet_m);
               });
      for (std::size_t slot = 0; slot < scan.frames.reference.num_slots(); ++slot) {
        // Angle between the beam and the edge, which stands upright.
        const Vector3 direction = scan.DirectionOfSlot(slot);
        const double beside_rad = edge_m / kSheet_m * direction.x() - direction.y();
        if (beside_rad < 0.7 * kBeside_rad || beside_rad > 1.3 * kBeside_rad) continue;
        ++num_beams;
        expected += static_cast<double>(scan.frames.reference.intensity[slot]);
        found += static_cast<double>(scan.frames.rung.intensity[slot]);
      }
    }
    SCOPED_TRACE(step_m);
    ASSERT_GE(num_beams, 8U);
    RecordRegime("a retroreflector 0.5 mrad beside a beam's centre, " +
                     std::to_string(std::lround(100.0 * step_m)) + " cm before a wall",
                 {"does not see it", TwoDigits(100.0 * found / expected) + " % of the intensity",
                  "the yardstick"});
    // An edge cuts some 8 of 64 cells, which are counted whole: sqrt(8 / 12) / 64 of the beam where
    // the sheet fills 16 to 25 % of it, so 8 % of one beam's intensity. The radii of the cells are
    // the same in every beam: 3 %.
    EXPECT_NEAR(found / expected, 1.0,
                0.03 + 4.0 * 0.08 / std::sqrt(static_cast<double>(num_beams)));
  }
}

INSTANTIATE_TEST_SUITE_P(AllSensors,
                         EdgesOn,
                         testing::ValuesIn(ScannedSensors()),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
