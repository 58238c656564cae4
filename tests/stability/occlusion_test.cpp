// The hidden share of persons who stand free before the sky or behind a wall that hides one half of
// them, on every preset and rung, at rest and in motion. Counting the firings that show a person in
// beams with a width against those whose central ray meets it, as is obvious, gives shares down to
// -5 for free persons, since beams meet what their centres pass by.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/object_models.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

/// Within the range of all sensors.
constexpr double kNear_m = 18.0;

enum class Wall { kNone, kLeftHalf, kRightHalf, kWhole };

constexpr Fidelity kRungs[] = {Fidelity::kGeometry, Fidelity::kPlausibility, Fidelity::kSurface,
                               Fidelity::kFootprint, Fidelity::kReference};

ObjectView operator+(const ObjectView& a, const ObjectView& b) {
  return {a.firings_alone + b.firings_alone, a.firings_visible + b.firings_visible,
          a.rays_alone + b.rays_alone, a.rays_visible + b.rays_visible};
}

class OcclusionOn : public testing::TestWithParam<std::string> {
 protected:
  OcclusionOn()
      : scenario_(ReadMinimalWith(GetParam())),
        materials_(scenario_.materials),
        labels_(scenario_.labels) {
    ObjectSpec person;
    person.type = ObjectType::kPerson;
    person_ = MakeObjectModel(person, RailSurfaces(labels_, materials_), labels_, materials_);
    constexpr double kHalfAzimuth_deg = 8.0;  // Channels of QT128 are offset by 6 degrees.
    constexpr double kHalfElevation_deg = 6.0;
    pattern_ = BuildScanPattern(CutSector(
        scenario_.lidar.scan, {kHalfAzimuth_deg, -kHalfElevation_deg, kHalfElevation_deg}));
  }

  /// A person whose middle is straight ahead, and the wall at 9/10 of the way. In motion, the
  /// sensor moves at 30 m/s, and so do both; they also move sideways, the wall 9/10 as fast, so
  /// that it hides the same part all the time.
  [[nodiscard]] std::shared_ptr<SimpleWorld> World(double range_m, Wall wall, bool moves) const {
    constexpr double kSpeed_mps = 30.0;
    constexpr double kAside_mps = 2.0;
    constexpr float kHalfWall_m = 40.0F;
    auto world = std::make_shared<SimpleWorld>();
    const double ahead_mps = moves ? kSpeed_mps : 0.0;
    const double aside_mps = moves ? kAside_mps : 0.0;
    world->velocity_chunk_mps = {ahead_mps, 0.0, 0.0};
    const double middle_m = person_->Bounds().center().z();
    world->AddObject(person_, Transform(Eigen::Translation3d(range_m, 0.0, -middle_m)),
                     {ahead_mps, aside_mps, 0.0});
    if (wall == Wall::kNone) return world;
    const double side = wall == Wall::kLeftHalf ? 1.0 : wall == Wall::kRightHalf ? -1.0 : 0.0;
    world->AddObject(
        std::make_shared<const Model>(
            Model{"wall",
                  {{MakeWall(0.0F, kHalfWall_m), materials_.Index("soil"), labels_.Id("ground")}}}),
        Transform(
            Eigen::Translation3d(0.9 * range_m, side * static_cast<double>(kHalfWall_m), 0.0)),
        {ahead_mps, 0.9 * aside_mps, 0.0});
    return world;
  }

  /// What the beams see of the person on each rung, in all of some tilts of the sensor, since
  /// sparse rows and columns meet a person by chance.
  [[nodiscard]] std::vector<ObjectView> Views(double range_m, Wall wall, bool moves) const {
    std::vector<ObjectView> views(std::size(kRungs));
    for (int tilt = 0; tilt < 4; ++tilt) {
      const auto world = World(range_m, wall, moves);
      world->chunk_from_vehicle =
          MakeTransform(RotationFromYawPitchRoll(RadFromDeg(0.2 * tilt - 0.3),
                                                 RadFromDeg(0.45 * tilt - 0.7), 0.0),
                        Vector3::Zero());
      Simulator simulator(world, pattern_, materials_, SpecOf(kRungs[0]), 1);
      for (std::size_t i = 0; i < views.size(); ++i) {
        simulator.Use(SpecOf(kRungs[i]));
        views[i] = views[i] + simulator.ViewObjects(3).at(0);
      }
    }
    return views;
  }

  [[nodiscard]] SimulatorSpec SpecOf(Fidelity rung) const {
    SimulatorSpec spec = railcast::SpecOf(scenario_.lidar, EffectsOfRung(rung));
    spec.detector.effects.pointing_jitter = EffectsOfRung(rung).pointing_jitter;
    return spec;
  }

  [[nodiscard]] static bool IsWide(std::size_t rung) {
    return kRungs[rung] >= Fidelity::kFootprint;
  }

  ScenarioSpec scenario_;
  MaterialLibrary materials_;
  LabelTable labels_;
  std::shared_ptr<const Model> person_;
  ScanPattern pattern_;
};

TEST_P(OcclusionOn, IsZeroForAFreePerson) {
  RecordRegime("hidden share of a person who stands free, beams with a width",
               {"visible beams counted against central rays: shares below 0", "0"});
  for (const double range_m : {kNear_m, 50.0, 80.0, 140.0}) {
    if (range_m + 1.0 > scenario_.lidar.range_max_m) continue;
    for (const bool moves : {false, true}) {
      const std::vector<ObjectView> views = Views(range_m, Wall::kNone, moves);
      for (std::size_t i = 0; i < views.size(); ++i) {
        SCOPED_TRACE(testing::Message() << range_m << " m, rung " << i << ", moves " << moves);
        EXPECT_TRUE(!IsWide(i) || views[i].firings_alone > 0U);
        EXPECT_EQ(views[i].firings_visible, views[i].firings_alone);
        EXPECT_EQ(views[i].occlusion().value_or(0.0), 0.0);
      }
    }
  }
}

// What the wall leaves free if it stands on one side, it hides on the other: the two shares add up
// to 1 but for rays along its edge. Each is half to within a column of beams: even of the sparsest,
// 0.8 degrees apart, the four tilts put some eight columns on a person who is 0.5 m wide.
TEST_P(OcclusionOn, IsAHalfForAPersonBehindAWallThatHidesOneHalf) {
  for (const bool moves : {false, true}) {
    const std::vector<ObjectView> left = Views(kNear_m, Wall::kLeftHalf, moves);
    const std::vector<ObjectView> right = Views(kNear_m, Wall::kRightHalf, moves);
    for (std::size_t i = 0; i < left.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "rung " << i << ", moves " << moves);
      ASSERT_GT(left[i].rays_alone, 20U);
      EXPECT_EQ(left[i].rays_alone, right[i].rays_alone);
      EXPECT_NEAR(left[i].occlusion().value(), 0.5, 0.17);
      EXPECT_NEAR(left[i].occlusion().value() + right[i].occlusion().value(), 1.0, 0.02);
      EXPECT_LE(left[i].firings_visible, left[i].firings_alone);
    }
  }
}

TEST_P(OcclusionOn, IsOneForAPersonBehindAWall) {
  for (const bool moves : {false, true}) {
    for (const ObjectView& view : Views(kNear_m, Wall::kWhole, moves)) {
      EXPECT_GT(view.rays_alone, 20U);
      EXPECT_EQ(view.firings_visible, 0U);
      EXPECT_EQ(view.occlusion(), 1.0);
    }
  }
}

std::vector<std::string> AllSensors() {
  std::vector<std::string> sensors = ScannedSensors();
  sensors.emplace_back("rosette");
  return sensors;
}

INSTANTIATE_TEST_SUITE_P(Presets,
                         OcclusionOn,
                         testing::ValuesIn(AllSensors()),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
