// Limbs swing and bogies turn while a scan is under way: each firing must meet every piece where it
// is at its own time. The slow, simple reference places all triangles anew for each beam. The
// simple method that fails is one pose of the whole object per frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/stability/regime.h"
#include "tests/support/bare_line.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/triangle_search.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

constexpr std::uint32_t kPassingFrame = 12;

/// The range of the first of an object's pieces along a ray, each piece where `poses` has it.
double RangeOf_m(const SceneObject& object,
                 const std::vector<Transform>& poses,
                 const Vector3& origin_world,
                 const Vector3& direction_world) {
  double range_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Transform& pose = poses[i];
    range_m = std::min(range_m, SearchTriangles<double>(object.pieces[i]->parts, pose, origin_world,
                                                        direction_world)
                                    .range_m);
  }
  return range_m;
}

/// Errors of ranges on an object, in the order of their size.
struct RangeErrors {
  std::vector<double> scan_m;      ///< Of the scan.
  std::vector<double> one_pose_m;  ///< With the whole object where it is at the stamp.

  [[nodiscard]] static double Quantile(std::vector<double> errors_m, double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(errors_m.size() - 1));
    std::nth_element(errors_m.begin(), errors_m.begin() + at, errors_m.end());
    return errors_m[static_cast<std::size_t>(at)];
  }
};

RangeErrors ErrorsOn(const ObjectSpec& spec) {
  const ScenarioSpec scenario = ReadMinimalWith("vir2rail");
  // An arc to the left, with the second track on its inside.
  WorldSpec bare = BareWithSecondTrack(scenario.world);
  bare.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 700.0, 300.0}}};
  bare.objects = {spec};
  const MaterialLibrary materials(scenario.materials);
  const auto world = std::make_shared<const RailWorld>(bare, scenario.vehicle,
                                                       LabelTable(scenario.labels), materials, 7);
  const SceneObject& object = world->objects().front();
  EXPECT_GT(object.pieces.size(), 1U);
  const ScanPattern pattern = MakeRaster(36.0, 24.0, 0.2);
  const std::int64_t stamp_ns = pattern.StampNs(kPassingFrame);
  SimulatorSpec simulator{.has_full_detail = true};
  simulator.vehicle_from_sensor =
      VehicleFromSensorAimedAt(world->WorldFromVehicle(0).inverse() *
                                   (world->WorldFromObject(0, stamp_ns) * Vector3(0, 0, 1.0)),
                               3.0);
  Frame frame;
  Simulator(world, pattern, materials, simulator, 0).Scan(kPassingFrame, frame);
  const Transform world_from_sensor = world->WorldFromVehicle(0) * simulator.vehicle_from_sensor;
  const std::vector<Transform> at_stamp = world->WorldFromPieces(0, stamp_ns);
  RangeErrors errors;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.instance[slot] != object.instance) continue;
    const std::size_t firing = FiringOfSlot(pattern, 1, slot);
    const Vector3 direction = world_from_sensor.linear() * DirectionOf(pattern, firing);
    const Vector3 origin = world_from_sensor.translation();
    const auto error_m = [&](const std::vector<Transform>& poses) {
      return std::abs(RangeOf_m(object, poses, origin, direction) -
                      static_cast<double>(frame.range_m[slot]));
    };
    errors.scan_m.push_back(error_m(world->WorldFromPieces(0, stamp_ns + pattern.time_ns[firing])));
    errors.one_pose_m.push_back(error_m(at_stamp));
  }
  return errors;
}

/// Beams at the very edge of a piece may pass it here and meet it there.
void ExpectEachPieceAtItsTime(const char* what, const RangeErrors& errors, double tolerance_m) {
  ASSERT_GT(errors.scan_m.size(), 100U);
  const double of_scan_m = RangeErrors::Quantile(errors.scan_m, 0.98);
  const double of_one_pose_m = RangeErrors::Quantile(errors.one_pose_m, 0.5);
  RecordRegime(what, {"one pose a frame: half of the hits off by more than " +
                          TwoDigits(1e3 * of_one_pose_m) + " mm",
                      "98 % of the hits within " + TwoDigits(1e3 * of_scan_m) + " mm"});
  EXPECT_LT(of_scan_m, tolerance_m);
  EXPECT_GT(of_one_pose_m, 5.0 * tolerance_m);
}

TEST(MovingPieces, OfARunningPersonAreHitAtTheirTimes) {
  ObjectSpec person = ObjectAt("it", ObjectType::kPerson, 410.0, 6.5);
  person.motion = MotionSpec{};
  PathSpec path;
  PathPoint there;
  there.s_m = 406.0;
  there.d_m = -6.5;
  path.points = {there};
  path.speed_mps = 2.5;
  path.acceleration_mps2 = 5.0;
  person.motion->path = path;
  ExpectEachPieceAtItsTime("limbs of a person who runs", ErrorsOn(person), 2e-3);
}

TEST(MovingPieces, OfAWagonInACurveAreHitAtTheirTimes) {
  ObjectSpec wagon = ObjectAt("it", TypeNamed("flat_wagon"), 390.0);
  wagon.track = "second";
  wagon.motion = MotionSpec{};
  wagon.motion->profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 20.0}};
  ExpectEachPieceAtItsTime("bogies of a wagon in a curve", ErrorsOn(wagon), 2e-3);
}

}  // namespace
}  // namespace railcast
