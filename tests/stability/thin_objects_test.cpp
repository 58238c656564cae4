// Thin objects that are no catenary: hanging wires, poles and rods, near and far. A beam may see
// them although their share of it is small, and may miss them although it meets them: the rung
// `footprint` has the echoes of the reference, beam by beam. The reference sends 1,024 sub-rays
// into every beam.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/base/units.h"
#include "core/detect/base/normal_table.h"
#include "core/fidelity/frame_comparison.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/object_models.h"
#include "railcast/scenario.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kRowHalfAzimuth_deg = 4.0;
constexpr double kGoldenStep = std::numbers::phi - 1.0;
constexpr int kManySubRays = 1024;
constexpr std::uint32_t kWhitePoleLabel = 7;
constexpr double kWhitePoleRadius_m = 0.005;

/// ThinEchoes of thin objects.
struct ThinEchoes {
  double expected{};  ///< Of the reference.
  double missed{};    ///< Of the reference alone.
  double added{};     ///< Of the rung alone.

  ThinEchoes& operator+=(const ThinEchoes& more) {
    expected += more.expected;
    missed += more.missed;
    added += more.added;
    return *this;
  }
};

/// Whether a beam may meet an object's box: its axis passes it at less than 10 mrad, which is more
/// than ten standard deviations of its profile.
bool PassesBy(const Vector3& direction, const Placement& placement) {
  Eigen::AlignedBox3d box = placement.model->Bounds();
  box.translate(Vector3(placement.chunk_from_model.translation()));
  for (const double share : {0.0, 0.5, 1.0}) {
    const double x_m = std::lerp(box.min().x(), box.max().x(), share);
    const Vector3 place_m = x_m / direction.x() * direction;
    if (box.exteriorDistance(place_m) < 0.01 * x_m) return true;
  }
  return false;
}

ThinEchoes CompareThin(const Frame& rung, const Frame& reference, std::uint32_t label) {
  ThinEchoes echoes;
  const auto has_echo = [&](const Frame& frame, std::size_t slot) {
    return HasPoint(frame.outcome[slot]) && frame.label[slot] == label;
  };
  for (std::size_t slot = 0; slot < reference.num_slots(); ++slot) {
    const bool is_expected = has_echo(reference, slot);
    const bool is_found = has_echo(rung, slot);
    echoes.expected += is_expected ? 1.0 : 0.0;
    echoes.missed += is_expected && !is_found ? 1.0 : 0.0;
    echoes.added += is_found && !is_expected ? 1.0 : 0.0;
  }
  return echoes;
}

class ThinObjectsOn : public testing::TestWithParam<std::string> {
 protected:
  ThinObjectsOn()
      : scenario_(ReadMinimalWith(GetParam())),
        materials_(scenario_.materials),
        labels_(scenario_.labels) {}

  [[nodiscard]] std::shared_ptr<const Model> ModelOf(const ObjectSpec& object) const {
    return MakeObjectModel(object, RailSurfaces(labels_, materials_), labels_, materials_);
  }

  [[nodiscard]] std::shared_ptr<const Model> PoleOf(double diameter_m) const {
    ObjectSpec pole;
    pole.type = ObjectType::kPole;
    pole.size_m = {diameter_m, diameter_m, 4.0};
    return ModelOf(pole);
  }

  [[nodiscard]] std::shared_ptr<const Model> WhitePole() const {
    auto pole = std::make_shared<Model>();
    pole->name = "white_pole";
    pole->parts = {{MakeCylinder(kWhitePoleRadius_m, 6.0, 16), materials_.Index("white_paint"),
                    kWhitePoleLabel}};
    return pole;
  }

  /// Objects side by side, every one at another place between the beams, with the ground 2.5 m
  /// below the sensor.
  [[nodiscard]] std::shared_ptr<SimpleWorld> RowOf(const std::shared_ptr<const Model>& model,
                                                   double range_m) const {
    const auto world =
        WorldOfParts({{MakeFloor(-2.5F, 600.0F), materials_.Index("soil"), labels_.Id("ground")}});
    constexpr double kApart_m = 0.5;
    const double half_m = 0.9 * range_m * std::tan(RadFromDeg(kRowHalfAzimuth_deg));
    const int num = std::min(static_cast<int>(2.0 * half_m / kApart_m), 24);
    for (int i = 0; i < num; ++i) {
      Eigen::Affine3d place = Eigen::Affine3d::Identity();
      const double shift = 0.5 * std::fmod(kGoldenStep * i, 1.0);
      place.translation() = Vector3(range_m, (i - 0.5 * (num - 1) + shift) * kApart_m, -2.5);
      world->placements.push_back({model, place});
    }
    return world;
  }

  [[nodiscard]] Simulator MakeSimulator(const std::shared_ptr<SimpleWorld>& world,
                                        const EffectSet& effects) const {
    const ScanPattern pattern =
        BuildScanPattern(CutSector(scenario_.lidar.scan, {kRowHalfAzimuth_deg, -20.0, 12.0}));
    const auto is_near = [&](const Vector3& direction) {
      return std::ranges::any_of(world->placements, [&](const Placement& placement) {
        return PassesBy(direction, placement);
      });
    };
    return {world, Only(pattern, is_near), materials_, SpecOf(scenario_.lidar, effects), 0};
  }

  [[nodiscard]] ThinEchoes CompareRow(const std::shared_ptr<const Model>& model,
                                      double range_m) const {
    const std::shared_ptr<SimpleWorld> row = RowOf(model, range_m);
    Simulator simulator = MakeSimulator(row, EffectsOfRung(Fidelity::kFootprint));
    const Frame rung = FrameBy(simulator);
    SimulatorSpec spec = SpecOf(scenario_.lidar, YardstickEffects());
    spec.detector.beam.reference_rays = kManySubRays;
    simulator.Use(spec);
    const Frame reference = FrameBy(simulator);
    const ThinEchoes echoes = CompareThin(rung, reference, model->parts.front().label);
    return echoes;
  }

  ScenarioSpec scenario_;
  MaterialLibrary materials_;
  LabelTable labels_;
};

// References of 1,000 and of 1,024 sub-rays differ in 0.7 to 3 % of these echoes.
TEST_P(ThinObjectsOn, HaveTheEchoesOfTheReferenceBeamByBeam) {
  ObjectSpec wire;
  wire.type = TypeNamed("hanging_wire");
  ThinEchoes all;
  const auto compare = [&](const std::shared_ptr<const Model>& model, double range_m) {
    SCOPED_TRACE(model->name + " at " + std::to_string(range_m) + " m");
    const ThinEchoes echoes = CompareRow(model, range_m);
    EXPECT_LE(echoes.missed, 3.0 + 0.03 * echoes.expected);
    EXPECT_LE(echoes.added, 3.0 + 0.03 * echoes.expected);
    all += echoes;
  };
  compare(ModelOf(wire), 20.0);
  compare(ModelOf(wire), 60.0);
  compare(PoleOf(0.05), 8.0);
  compare(PoleOf(0.01), 10.0);
  compare(PoleOf(0.01), 30.0);
  ASSERT_GT(all.expected, 250.0);
  RecordRegime("hanging wires at 20 and 60 m, poles of 5 cm at 8 m, of 1 cm at 10 and 30 m",
               {"all or nothing, as a ray meets it",
                TwoDigits(100.0 * all.missed / all.expected) + " % of the echoes missed, " +
                    TwoDigits(100.0 * all.added / all.expected) + " % added",
                "the yardstick"});
  EXPECT_LT(all.missed / all.expected, 0.03);
  EXPECT_LT(all.added / all.expected, 0.03);
}

// White poles of 1 cm at 110 m are at the threshold or below: 24 of them have 25, 35 and 128 echoes
// in a reference of 4,095 sub-rays, and 64 sub-rays alone add 33, 44 and 49 that are none.
TEST_P(ThinObjectsOn, AtTheThresholdAddHardlyAnyEcho) {
  const double added = CompareRow(WhitePole(), 110.0).added;
  RecordRegime("24 white poles of 1 cm at 110 m, at the detection threshold",
               {"all or nothing, as a ray meets it",
                std::to_string(std::lround(added)) + " echoes added", "the yardstick"});
  EXPECT_LE(added, 9.0);
}

// An upright pole that passes a beam from end to end takes a strip of its profile.
TEST_P(ThinObjectsOn, TakeTheShareOfTheClosedForm) {
  constexpr double kRange_m = 110.0;
  // Before the sky, and away from the upper ends at 0.032.
  constexpr double kLow_rad = 0.004, kHigh_rad = 0.025;
  const std::shared_ptr<SimpleWorld> row = RowOf(WhitePole(), kRange_m);
  EffectSet effects = EffectsOfRung(Fidelity::kFootprint);
  effects.noise = effects.range_noise = effects.pointing_jitter = false;  // Directions as aimed.
  Frame frame;
  MakeSimulator(row, effects).Scan(0, frame);
  const BeamSpec beam = SpecOf(scenario_.lidar, YardstickEffects()).detector.beam;
  const double sigma_rad = 0.25e-3 * beam.divergence_mrad[0];
  int num = 0;
  double sum = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot]) || frame.label[slot] != kWhitePoleLabel) continue;
    const Eigen::Vector3d point(frame.x[slot], frame.y[slot], frame.z[slot]);
    const double elevation_rad = std::asin(point.z() / point.norm());
    if (elevation_rad < kLow_rad || elevation_rad > kHigh_rad) continue;
    double expected = 0.0;
    for (const Placement& pole : row->placements) {
      const Vector3 foot_m = pole.chunk_from_model.translation();
      const double distance_m = std::hypot(foot_m.x(), foot_m.y());
      const double aside =
          std::remainder(std::atan2(point.y(), point.x()) - std::atan2(foot_m.y(), foot_m.x()),
                         2.0 * std::numbers::pi) *
          std::cos(elevation_rad) / sigma_rad;
      const double half = kWhitePoleRadius_m * std::cos(elevation_rad) / distance_m / sigma_rad;
      if (std::fabs(aside) > 4.0) continue;
      expected += NormalShare(aside - half, aside + half);
    }
    const double ratio = static_cast<double>(frame.footprint_share[slot]) / expected;
    EXPECT_NEAR(ratio, 1.0, 0.12);
    sum += ratio;
    ++num;
  }
  if (num == 0) GTEST_SKIP() << "no echo of these poles";
  EXPECT_NEAR(sum / num, 1.0, 0.02);  // Of echoes at the threshold, the stronger are detected.
}

INSTANTIATE_TEST_SUITE_P(SomeSensors,
                         ThinObjectsOn,
                         testing::Values("vir2rail", "vlp32c", "pandar64", "vls128"),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
