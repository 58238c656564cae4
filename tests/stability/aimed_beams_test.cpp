// A beam aimed at the middle of anything that a scenario can place says what it is: for every type
// of object, standing and moving, on the way to it and while the sensor itself is moving.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/scenario/object_types.h"
#include "railcast/rail_world.h"
#include "railcast/simulator.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/stability/regime.h"
#include "tests/support/bare_line.h"
#include "tests/support/scan_once.h"
#include "tests/support/sensor_sector.h"

namespace railcast {
namespace {

constexpr double kSensorAbove_m = 3.5;
constexpr double kBeyond_m = 60.0;  // Farther than any object here: no chunks beyond are built.

/// A place on a surface, and what it is.
struct Target {
  Vector3 point_world = Vector3::Zero();
  std::uint32_t label{};
};

/// The middle of the triangle that is nearest to the middle of the object's box.
Target MiddleOf(const World& world, std::size_t index, std::int64_t time_ns) {
  const SceneObject& object = world.objects()[index];
  const std::vector<std::shared_ptr<const Model>> whole = {object.model};
  const auto& pieces = object.pieces.empty() ? whole : object.pieces;
  const std::vector<Transform> poses = world.WorldFromPieces(index, time_ns);
  const Vector3 middle_world =
      world.WorldFromObject(index, time_ns) * object.model->Bounds().center();
  Target nearest;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    for (const Part& part : pieces[piece]->parts) {
      for (const auto& [a, b, c] : part.mesh.triangles) {
        const Eigen::Vector3f sum =
            part.mesh.vertices[a] + part.mesh.vertices[b] + part.mesh.vertices[c];
        const Vector3 point_world = poses[piece] * (sum.cast<double>() / 3.0);
        const double distance_m = (point_world - middle_world).norm();
        if (distance_m >= least_m) continue;
        least_m = distance_m;
        nearest = {point_world, part.label};
      }
    }
  }
  return nearest;
}

class AimedBeamsAt : public testing::TestWithParam<ObjectType> {
 protected:
  /// An object 26 m ahead of where the sensor is at first, on or beside the second track.
  [[nodiscard]] ObjectSpec Object(bool moves) const {
    ObjectSpec object;
    object.name = "it";
    object.type = GetParam();
    object.track = "second";
    object.s_m = 426.0;
    object.d_m = IsRailVehicle(object.type) ? 0.0 : 7.0;
    if (object.type == ObjectType::kBox || object.type == ObjectType::kPole) {
      object.size_m = {1.0, 1.0, 2.0};
    }
    if (object.type == ObjectType::kMesh) {
      std::ofstream(mesh_)
          << "v 0 0 0\nv 2 0 0\nv 0 0 3\nv 0 1 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
      object.file = mesh_.string();
    }
    if (!moves) return object;
    object.motion = MotionSpec{};
    if (IsRailVehicle(object.type)) {
      object.motion->profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 5.0}};
      return object;
    }
    PathPoint there;
    there.s_m = 423.0;
    there.d_m = 4.5;
    PathSpec path;
    path.points = {there};
    path.speed_mps = 1.5;
    object.motion->path = path;
    return object;
  }

  [[nodiscard]] std::shared_ptr<const RailWorld> WorldWith(const ObjectSpec& object) const {
    WorldSpec world = BareWithSecondTrack(scenario_.world);
    world.objects = {object};
    VehicleSpec vehicle = scenario_.vehicle;
    vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 4.0}};
    return std::make_shared<const RailWorld>(world, vehicle, labels_, materials_, 7);
  }

  /// What one beam returns that is sent at the stamp of a frame.
  [[nodiscard]] Frame Aim(const std::shared_ptr<SceneStore>& scenes,
                          const RailWorld& world,
                          const ScanPattern& pattern,
                          std::uint32_t frame_index) const {
    const std::int64_t time_ns = pattern.StampNs(frame_index);
    SimulatorSpec spec{.vehicle_from_sensor =
                           VehicleFromSensorAimedAt(world.WorldFromVehicle(time_ns).inverse() *
                                                        MiddleOf(world, 0, time_ns).point_world,
                                                    kSensorAbove_m)};
    spec.detector.range_max_m = kBeyond_m;
    return FrameBy(Simulator(scenes, pattern, materials_, spec, 0), frame_index);
  }

  void ExpectItIsReturned(bool moves) const {
    RecordRegime("a beam aimed at each type of object, standing and moving",
                 {"-", "says what it is"});
    const auto world = WorldWith(Object(moves));
    ASSERT_EQ(world->objects().front().moves, moves);
    const ScanPattern pattern = MakeRaster(1.0, 1.0, 1.0);
    ASSERT_EQ(pattern.num_firings(), 1U);
    const auto scenes = MakeSceneStore(world, materials_);
    for (const std::uint32_t frame_index : {0U, 7U, 20U}) {
      const Frame frame = Aim(scenes, *world, pattern, frame_index);
      const SceneObject& object = world->objects().front();
      const Target target = MiddleOf(*world, 0, pattern.StampNs(frame_index));
      ASSERT_TRUE(HasPoint(frame.outcome[0])) << frame_index;
      EXPECT_EQ(frame.instance[0], object.instance) << frame_index;
      EXPECT_EQ(frame.label[0], target.label) << frame_index;
      EXPECT_EQ(frame.label[0], object.label) << frame_index;
    }
  }

  const TemporaryDirectory folder_;
  const std::filesystem::path mesh_ = folder_.path() / "it.obj";
  const ScenarioSpec scenario_ = ReadMinimalWith("vir2rail");
  const LabelTable labels_{scenario_.labels};
  const MaterialLibrary materials_{scenario_.materials};
};

TEST_P(AimedBeamsAt, ReturnWhatStands) {
  ExpectItIsReturned(false);
}

TEST_P(AimedBeamsAt, ReturnWhatMoves) {
  ExpectItIsReturned(true);
}

std::vector<ObjectType> AllTypes() {
  const ObjectTypes all;
  std::vector<ObjectType> types;
  for (const std::string& name : all.Names()) types.push_back(*all.Find(name));
  return types;
}

INSTANTIATE_TEST_SUITE_P(EveryType,
                         AimedBeamsAt,
                         testing::ValuesIn(AllTypes()),
                         [](const auto& type) { return std::string(NameOf(type.param)); });

}  // namespace
}  // namespace railcast
