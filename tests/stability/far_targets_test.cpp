// Poles and persons far off, before the sky and before the ground: on the published raster and on
// real sensors, the rung `footprint` returns as many points on them as the reference, which sends
// 256 sub-rays into every beam. A beam whose centre passes beside such a target may still see it.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <memory>
#include <numbers>
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

constexpr std::uint32_t kPoleLabel = 7;
// Targets are equal in kind, but every one stands elsewhere between the beams.
constexpr double kGolden = std::numbers::phi - 1.0;

/// Points on the targets.
struct Points {
  double found{};     ///< By the rung that is looked at.
  double expected{};  ///< By the reference.

  Points& operator+=(const Points& more) {
    found += more.found;
    expected += more.expected;
    return *this;
  }
};

/// Those of all tilts of the sensor.
Points Sum(const std::vector<Points>& tilts) {
  Points sum;
  for (const Points& points : tilts) sum += points;
  return sum;
}

/// Half the 95 % interval of Sum().found / Sum().expected, over tilts: of a ratio of means (Cochran
/// 1977, Sampling Techniques, eq. 6.13), by Student's t.
double HalfInterval(const std::vector<Points>& tilts) {
  const Points sum = Sum(tilts);
  double squares = 0.0;
  for (const Points& points : tilts) {
    squares += std::pow(points.found - sum.found / sum.expected * points.expected, 2);
  }
  const auto num = static_cast<double>(tilts.size());
  const boost::math::students_t t(num - 1.0);
  return boost::math::quantile(t, 0.975) * std::sqrt(num / (num - 1.0) * squares) / sum.expected;
}

double CountLabel(const Frame& frame, std::uint32_t label) {
  double num = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    num += HasPoint(frame.outcome[slot]) && frame.label[slot] == label ? 1.0 : 0.0;
  }
  return num;
}

class FarTargetsOn : public testing::TestWithParam<std::string> {
 protected:
  FarTargetsOn()
      : scenario_(ReadMinimalWith(GetParam())),
        materials_(scenario_.materials),
        labels_(scenario_.labels) {}

  [[nodiscard]] ScanPattern PatternIn(const SectorSpec& sector) const {
    return BuildScanPattern(CutSector(scenario_.lidar.scan, sector));
  }

  [[nodiscard]] Points Count(const std::shared_ptr<const World>& world,
                             const ScanPattern& pattern,
                             std::uint32_t label) const {
    const FramePair frames = ScanBoth(world, pattern, materials_, scenario_.lidar, rung_);
    return {CountLabel(frames.rung, label), CountLabel(frames.reference, label)};
  }

  /// Counts with the sensor tilted by up to a degree to either side, until there are enough points:
  /// sparse channels are up to 2 deg apart, and a person at 100 m takes 1 deg.
  [[nodiscard]] std::vector<Points> CountTilted(const SimpleWorld& world,
                                                double height_m,
                                                const SectorSpec& sector,
                                                std::uint32_t label) const {
    constexpr int kMaxTilts = 12;
    constexpr double kManyPoints = 1000.0;
    std::vector<Points> tilts;
    for (int i = 0; i < kMaxTilts && (i < min_tilts_ || Sum(tilts).expected < kManyPoints); ++i) {
      const double pitch_deg = 2.0 * std::fmod(kGolden * (i + 0.5), 1.0) - 1.0;
      auto tilted = std::make_shared<SimpleWorld>(world);
      tilted->chunk_from_vehicle = MakeTransform(
          RotationFromYawPitchRoll(0.0, RadFromDeg(pitch_deg), 0.0), Vector3(0.0, 0.0, height_m));
      const ScanPattern pattern = PatternIn(sector);
      tilts.push_back(Count(tilted, only_near_ ? BeamsNear(*tilted, pattern) : pattern, label));
    }
    return tilts;
  }

  /// The beams that may meet a person: all others cannot count. The widest has a standard deviation
  /// of 0.75 mrad.
  [[nodiscard]] ScanPattern BeamsNear(const SimpleWorld& world, const ScanPattern& pattern) const {
    constexpr double kNear_rad = 0.005;
    const Vector3 sensor_m = world.chunk_from_vehicle.translation();
    const Eigen::AlignedBox3d person = person_->Bounds();
    return Only(pattern, [&](const Vector3& beam) {
      const Vector3 direction = world.chunk_from_vehicle.linear() * beam;
      return std::ranges::any_of(world.placements, [&](const Placement& placement) {
        const Vector3 foot_m = placement.chunk_from_model.translation();
        const double margin_m = kNear_rad * foot_m.x();
        const Vector3 place_m =
            sensor_m + (foot_m.x() - sensor_m.x()) / direction.x() * direction - foot_m;
        return place_m.y() > person.min().y() - margin_m &&
               place_m.y() < person.max().y() + margin_m &&
               place_m.z() > person.min().z() - margin_m &&
               place_m.z() < person.max().z() + margin_m;
      });
    });
  }

  [[nodiscard]] bool Reaches(double range_m) const { return range_m < scenario_.lidar.range_max_m; }

  /// Expects the counts to agree within 5 %, where a hundred points or more can tell.
  void ExpectAgreement(const Points& points, const std::string& what) {
    SCOPED_TRACE(what + ": " + std::to_string(points.found) + " of " +
                 std::to_string(points.expected));
    if (points.expected < 100.0) return;
    RecordRegime(what, {"-", TwoDigits(100.0 * points.found / points.expected) + " % of the points",
                        "the yardstick"});
    ++num_judged_;
    EXPECT_NEAR(points.found / points.expected, 1.0, 0.05);
  }

  /// Persons one beside and above the other, without ground.
  [[nodiscard]] std::vector<Points> CountBeforeSky(double range_m) const {
    constexpr double kHalf_deg = 6.0;
    constexpr double kApart_m = 2.3;
    constexpr double kStacked_m = 3.1;
    SimpleWorld world;
    const double half_m = range_m * std::tan(RadFromDeg(kHalf_deg));
    const int num_columns = static_cast<int>(1.8 * half_m / kApart_m);
    for (int i = 0; i < num_columns; ++i) {
      const double y_m = (i - 0.5 * (num_columns - 1)) * kApart_m;
      const double shift_m = kStacked_m * std::fmod(kGolden * i, 1.0);
      for (double z_m = shift_m - half_m; z_m < half_m; z_m += kStacked_m) {
        AddPerson({range_m, y_m, z_m}, world);
      }
    }
    return CountTilted(world, 0.0, {kHalf_deg, -kHalf_deg, kHalf_deg}, labels_.Id("person"));
  }

  /// Persons in a row on level ground, seen from the height of a vehicle's roof.
  [[nodiscard]] std::vector<Points> CountBeforeGround(double range_m) const {
    constexpr double kSensorHeight_m = 4.6;
    constexpr double kHalfAzimuth_deg = 12.0;
    constexpr double kApart_m = 1.7;
    SimpleWorld world;
    world.ground.parts = {
        {MakeFloor(0.0F, 600.0F), materials_.Index("soil"), labels_.Id("ground")}};
    const double half_m = 0.9 * range_m * std::tan(RadFromDeg(kHalfAzimuth_deg));
    for (double y_m = -half_m; y_m < half_m; y_m += kApart_m) AddPerson({range_m, y_m, 0.0}, world);
    // Where the persons stand, tilted by a degree to either side: beams beside it cost as much.
    constexpr double kBesides_deg = 1.5;
    constexpr double kHead_m = 2.0;
    const double low_deg = DegFromRad(std::atan(-kSensorHeight_m / range_m)) - kBesides_deg;
    const double high_deg =
        DegFromRad(std::atan((kHead_m - kSensorHeight_m) / range_m)) + kBesides_deg;
    return CountTilted(world, kSensorHeight_m, {kHalfAzimuth_deg, low_deg, high_deg},
                       labels_.Id("person"));
  }

  void AddPerson(const Vector3& place_m, SimpleWorld& world) const {
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    place.translation() = place_m;
    world.placements.push_back({person_, place});
  }

  [[nodiscard]] static std::string PersonAt(const char* before, double range_m) {
    return "persons before the " + std::string(before) + " at " +
           std::to_string(std::lround(range_m)) + " m";
  }

  [[nodiscard]] std::shared_ptr<const Model> Person() const {
    ObjectSpec person;
    person.type = ObjectType::kPerson;
    return MakeObjectModel(person, RailSurfaces(labels_, materials_), labels_, materials_);
  }

  ScenarioSpec scenario_;
  MaterialLibrary materials_;
  LabelTable labels_;
  std::shared_ptr<const Model> person_ = Person();
  Fidelity rung_ = Fidelity::kFootprint;
  bool only_near_ = true;
  int min_tilts_ = 1;
  int num_judged_ = 0;
};

TEST_P(FarTargetsOn, APoleBeforeTheSkyHasAsManyPointsAsInTheReference) {
  constexpr double kHalfAzimuth_deg = 12.0;
  constexpr double kHalfElevation_deg = 5.0;
  constexpr int kNumPoles = 40;
  for (const double diameter_m : {0.02, 0.05, 0.10}) {
    // All rows of a raster meet a pole at the same place of their beams, so that 120 poles are only
    // 120 samples of where a pole can stand; more turns of the row make
    // them up to 360.
    Points points;
    for (int turn = 0; turn < 9 && (turn < 3 || points.expected < 6000.0); ++turn) {
      const double range_m = 60.0 + 20.0 * (turn % 3);
      const auto world = std::make_shared<SimpleWorld>();
      for (int i = 0; i < kNumPoles; ++i) {
        const double place = (i + std::fmod(kGolden * (i + kNumPoles * turn), 1.0)) / kNumPoles;
        const double azimuth_rad = RadFromDeg(kHalfAzimuth_deg * (1.8 * place - 0.9));
        Mesh pole = MakeCylinder(diameter_m / 2.0, 30.0, 16);
        for (auto& vertex : pole.vertices) {
          vertex.x() += static_cast<float>(range_m * std::cos(azimuth_rad));
          vertex.y() += static_cast<float>(range_m * std::sin(azimuth_rad));
        }
        world->ground.parts.push_back({pole, materials_.Index("white_paint"), kPoleLabel});
      }
      points += Count(world, PatternIn({kHalfAzimuth_deg, -kHalfElevation_deg, kHalfElevation_deg}),
                      kPoleLabel);
    }
    ExpectAgreement(points, "poles of " + std::to_string(std::lround(100.0 * diameter_m)) +
                                " cm at 60 to 100 m");
  }
  EXPECT_GE(num_judged_, 1);
}

TEST_P(FarTargetsOn, APersonBeforeTheSkyHasAsManyPointsAsInTheReference) {
  for (const double range_m : {50.0, 100.0, 150.0}) {
    if (Reaches(range_m)) ExpectAgreement(Sum(CountBeforeSky(range_m)), PersonAt("sky", range_m));
  }
  EXPECT_GE(num_judged_, 1);
}

TEST_P(FarTargetsOn, APersonBeforeTheGroundHasAsManyPointsAsInTheReference) {
  for (const double range_m : {50.0, 100.0, 150.0}) {
    if (Reaches(range_m))
      ExpectAgreement(Sum(CountBeforeGround(range_m)), PersonAt("ground", range_m));
  }
  EXPECT_GE(num_judged_, 1);
}

struct ShareOfRays {
  std::string sensor;
  double range_m{};
  double share{};  ///< Points of one ray per beam / those of the reference.
};

class FarTargetsByRaysOn : public FarTargetsOn {
 protected:
  FarTargetsByRaysOn() {
    rung_ = Fidelity::kSurface;
    only_near_ = false;  // So that each beam has the draws with which the known shares were made.
    min_tilts_ = 6;      // Enough for an interval.
  }
};

// railcast-analyze detect warns of these figures. A ray beside a person sees nothing; a ray that
// meets a person reports a filled beam, which is detected where a beam's share is not: at the limit
// of detection, as that of VLP-32C at 150 m.
TEST_P(FarTargetsByRaysOn, APersonHasTooFewPointsOrTooMany) {
  const ShareOfRays shares[] = {{"vir2rail", 100.0, 0.62},
                                {"vir2rail", 150.0, 0.48},
                                {"pandar64", 100.0, 0.56},
                                {"vlp32c", 150.0, 4.3}};
  for (const ShareOfRays& known : shares) {
    if (known.sensor != GetParam()) continue;
    const std::vector<Points> tilts = CountBeforeSky(known.range_m);
    const Points points = Sum(tilts);
    const double share = points.found / points.expected;
    const double half = HalfInterval(tilts);
    RecordRegime(PersonAt("sky", known.range_m) + ", " + known.sensor,
                 {TwoDigits(100.0 * share) + " [" + TwoDigits(100.0 * (share - half)) + ", " +
                      TwoDigits(100.0 * (share + half)) + "] % of the points, over " +
                      std::to_string(tilts.size()) + " tilts",
                  "as for all sensors", "the yardstick"});
    EXPECT_TRUE(share + half < 1.0 || share - half > 1.0) << share << " +- " << half;
    // The same draws on both sides: only beams at the edge of a hit differ between machines, one
    // or two of 1000 points, or of 77.
    EXPECT_NEAR(share, known.share, 0.04 * known.share) << known.range_m;
  }
}

INSTANTIATE_TEST_SUITE_P(SomeSensors,
                         FarTargetsByRaysOn,
                         testing::Values("vir2rail", "pandar64", "vlp32c"),
                         [](const auto& sensor) { return sensor.param; });

// QT128 sees no farther than 50 m.
std::vector<std::string> FarSeeingSensors() {
  std::vector<std::string> sensors = ScannedSensors();
  std::erase(sensors, "qt128");
  return sensors;
}

INSTANTIATE_TEST_SUITE_P(AllSensors,
                         FarTargetsOn,
                         testing::ValuesIn(FarSeeingSensors()),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
