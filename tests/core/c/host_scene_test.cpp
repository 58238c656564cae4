#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "railcast/c_api.h"
#include "railcast/ray_caster.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/c/c_sim.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr railcast_surface kNothing{};
constexpr float kFloat32Steps_m = 1e-4F;  // A few steps of float32 at 40 to 100 m.

// A wall across the way, its plane at x = wall_x_m in the axes of the rays; surface 1.
struct Wall {
  float wall_x_m = 40.0F;
  std::atomic<int> num_calls = 0;
  std::atomic<bool> is_of_other_thread = false;
  std::thread::id caller = std::this_thread::get_id();

  static int Cast(void* user, const railcast_rays* rays) {
    auto& wall = *static_cast<Wall*>(user);
    ++wall.num_calls;
    if (std::this_thread::get_id() != wall.caller) wall.is_of_other_thread = true;
    for (std::size_t i = 0; i < rays->num_rays; ++i) {
      const float range_m = (wall.wall_x_m - rays->origin_x[i]) / rays->direction_x[i];
      if (!(range_m > 0.0F && range_m < rays->range_m[i])) continue;
      rays->range_m[i] = range_m;
      rays->normal_x[i] = -1.0F;
      rays->surface[i] = 1;
    }
    return 0;
  }
};

// A simulation of minimal.json's sensor, with fewer beams, in a scene of the host.
struct HostSim {
  explicit HostSim(railcast_cast_rays cast_rays,
                   void* user,
                   int num_threads = 2,
                   const std::string& rung = "geometry")
      : scenario(ScenarioText::Of("minimal.json").WithRaster(20.0, 10.0, 0.5)) {
    scenario.Replace("\"version\": 1", "\"version\": 1, \"fidelity\": \"" + rung + "\"");
    const railcast_config config = scenario.Config(num_threads);
    const railcast_scene scene{cast_rays, user, surfaces, 2};
    railcast_sim* made = nullptr;
    EXPECT_EQ(railcast_create_with_scene(&config, &scene, &made), RAILCAST_OK)
        << railcast_last_error();
    sim.reset(made);
  }

  template <typename T>
  [[nodiscard]] std::vector<T> Values(const char* name) const {
    railcast_field field{};
    EXPECT_EQ(railcast_get_field(sim.get(), name, &field), RAILCAST_OK) << railcast_last_error();
    const T* const values = static_cast<const T*>(field.values);
    return {values, values + field.num_values};
  }

  ScenarioText scenario;
  railcast_surface surfaces[2] = {kNothing, {"concrete", "building", 7, 0}};
  Sim sim;
};

railcast_motion Standing(double x_m, double y_m, double z_m) {
  railcast_motion motion{};
  for (railcast_pose* pose : {&motion.world_from_sensor, &motion.world_from_sensor_end}) {
    *pose = {{x_m, y_m, z_m}, {0.0, 0.0, 0.0, 1.0}};
  }
  return motion;
}

TEST(HostScene, WallStandsWhereTheCallbackPutsIt) {
  Wall wall;
  const HostSim host(&Wall::Cast, &wall);
  const railcast_motion motion = Standing(10.0, 0.0, 3.0);
  ASSERT_EQ(railcast_step_host(host.sim.get(), 5, &motion), RAILCAST_OK) << railcast_last_error();
  for (const float x : host.Values<float>("x")) EXPECT_NEAR(x, 30.0F, kFloat32Steps_m);
  const LabelTable labels(ReadScenario(host.scenario.file).labels);
  for (const std::uint32_t label : host.Values<std::uint32_t>("label")) {
    EXPECT_EQ(label, labels.Id("building"));
  }
  for (const std::uint32_t instance : host.Values<std::uint32_t>("instance")) {
    EXPECT_EQ(instance, 7U);
  }
}

TEST(HostScene, RangesKeepTheirMillimetresFarFromTheWorldsOrigin) {
  constexpr double kFar_m = 2'000'000.0;  // float32 steps are 0.25 m there.
  Wall wall;
  const HostSim host(&Wall::Cast, &wall);
  railcast_motion motion = Standing(kFar_m + 10.0, kFar_m, 3.0);
  motion.scene_origin_m[0] = kFar_m;
  motion.scene_origin_m[1] = kFar_m;
  ASSERT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_OK) << railcast_last_error();
  for (const float x : host.Values<float>("x")) EXPECT_NEAR(x, 30.0F, kFloat32Steps_m);
  motion.scene_origin_m[0] = 0.0;
  EXPECT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(),
            std::string("motion.scene_origin_m: must lie within 8192 m of the sensor, since "
                        "float32 loses millimetres beyond (got 2000010)"));
}

TEST(HostScene, MovingSensorNearsTheWallFromFiringToFiring) {
  Wall wall;
  const HostSim host(&Wall::Cast, &wall);
  railcast_motion motion = Standing(0.0, 0.0, 3.0);
  motion.world_from_sensor_end.position_m[0] = 4.0;
  ASSERT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_OK) << railcast_last_error();
  railcast_scan scan{};
  ASSERT_EQ(railcast_get_scan(host.sim.get(), &scan), RAILCAST_OK);
  const std::vector<float> x = host.Values<float>("x");
  const std::vector<std::uint32_t> time_ns = host.Values<std::uint32_t>("time_ns");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double share = static_cast<double>(time_ns[i]) / scan.duration_ns;
    EXPECT_NEAR(x[i], 40.0 - 4.0 * share, kFloat32Steps_m);
  }
}

TEST(HostScene, GivesTheFramesOfTheCppInterface) {
  // With noise, so that the draws are compared, too, and with sub-rays.
  Wall wall;
  const HostSim host(&Wall::Cast, &wall, 2, "footprint");
  const railcast_motion motion = Standing(10.0, 0.0, 3.0);
  ASSERT_EQ(railcast_step_host(host.sim.get(), 5, &motion), RAILCAST_OK) << railcast_last_error();

  class Caster final : public RayCaster {
   public:
    void Cast(RayTile& tile) const override {
      const railcast_rays rays{tile.num_rays,    tile.origin_x,    tile.origin_y,    tile.origin_z,
                               tile.direction_x, tile.direction_y, tile.direction_z, tile.shutter,
                               tile.range_m,     tile.surface,     tile.normal_x,    tile.normal_y,
                               tile.normal_z};
      Wall own;
      static_cast<void>(Wall::Cast(&own, &rays));
    }
  };
  const ScenarioSpec scenario = ReadScenarioText(host.scenario.text, host.scenario.file);
  const auto simulator = MakeSimulator(scenario, 2);
  auto world = std::make_shared<SimpleWorld>();
  world->chunk_from_vehicle = MakeTransform(Eigen::Matrix3d::Identity(), {10.0, 0.0, 3.0}) *
                              simulator->spec().vehicle_from_sensor.inverse();
  simulator->UseWorld(world);
  const std::uint16_t concrete = MaterialLibrary(scenario.materials).Index("concrete");
  const std::vector<Surface> surfaces = {
      {},
      {.label = LabelTable(scenario.labels).Id("building"),
       .instance = 7,
       .reflectivity = static_cast<float>(
           MaterialLibrary(scenario.materials).materials()[concrete].reflectivity),
       .material = concrete}};
  const Caster caster;
  Frame frame;
  simulator->Scan(5, {caster, Transform::Identity(), surfaces}, frame);
  EXPECT_TRUE(SimBytes(host.sim.get()) == FrameBytes(frame));
}

TEST(HostScene, CallsBackInTheCallersThreadIfThereIsOneThread) {
  Wall wall;
  const HostSim host(&Wall::Cast, &wall, 1);
  const railcast_motion motion = Standing(0.0, 0.0, 3.0);
  ASSERT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_OK);
  EXPECT_GT(wall.num_calls, 1);
  EXPECT_FALSE(wall.is_of_other_thread);
}

TEST(HostScene, SurfacesMayBeReplacedBetweenSteps) {
  Wall wall;
  const HostSim host(&Wall::Cast, &wall);
  const railcast_motion motion = Standing(0.0, 0.0, 3.0);
  const railcast_surface own[] = {kNothing, {"concrete", "building", 0, 1}};
  ASSERT_EQ(railcast_set_surfaces(host.sim.get(), own, 2), RAILCAST_OK);
  ASSERT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_OK);
  for (const std::uint8_t outcome : host.Values<std::uint8_t>("outcome")) {
    EXPECT_STREQ(railcast_outcome_name(outcome), "ego");
  }
  const railcast_surface wrong[] = {
      kNothing, {"concret", "building", 0, 0}, {"concrete", nullptr, 0, 0}};
  EXPECT_EQ(railcast_set_surfaces(host.sim.get(), wrong, 3), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(),
            std::string("surfaces[1].material: unknown material, the nearest is \"concrete\" (got "
                        "\"concret\")\nsurfaces[2].label: must not be null"));
  EXPECT_EQ(railcast_set_surfaces(host.sim.get(), own + 1, 1), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(),
            std::string("surfaces[0]: must be all zero, since it stands for nothing"));
  EXPECT_EQ(railcast_set_surfaces(host.sim.get(), own, 0), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(), std::string("num_surfaces: must be > 0 (got 0)"));
}

TEST(HostScene, BadPosesAreRefused) {
  Wall wall;
  const HostSim host(&Wall::Cast, &wall);
  railcast_motion motion{};
  EXPECT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(
      railcast_last_error(),
      std::string("motion.world_from_sensor.quaternion_xyzw: must be of unit length (got 0)"));
  motion = Standing(0.0, 0.0, std::numeric_limits<double>::infinity());
  EXPECT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(),
            std::string("motion.world_from_sensor.position_m[2]: must be finite (got inf)"));
  EXPECT_EQ(railcast_step_host(host.sim.get(), 0, nullptr), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_step(host.sim.get(), 0), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(), std::string("sim: must be made by railcast_create()"));
}

// What a callback does wrong with ray 3 of each call, and the message about it.
struct BadWrite {
  void (*write)(const railcast_rays& rays);
  int result = 0;
  const char* message;
};

int WriteBadly(void* user, const railcast_rays* rays) {
  const auto& bad = *static_cast<const BadWrite*>(user);
  if (bad.write != nullptr) bad.write(*rays);
  return bad.result;
}

TEST(HostScene, WrongResultsOfTheCallbackEndTheStep) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  BadWrite bad[] = {
      {nullptr, 3, "the callback returned 3"},
      {[](const railcast_rays& r) { r.surface[3] = 2; }, 0, "surface: must be less than 2 (got 2)"},
      {[](const railcast_rays& r) { r.range_m[3] = 5.0F; }, 0,
       "range_m: must stay as it is where surface is 0 (got 5)"},
      {[](const railcast_rays& r) {
         r.surface[3] = 1;
         r.range_m[3] = kNaN;
       },
       0, "range_m: must be in [0, 300] (got nan)"},
      {[](const railcast_rays& r) {
         r.surface[3] = 1;
         r.range_m[3] = 5.0F;
         r.normal_x[3] = r.normal_y[3] = r.normal_z[3] = 0.0F;
       },
       0, "the normal's length must be >= 1e-15 and <= 1e15 (got 0)"},
  };
  for (BadWrite& wrong : bad) {
    const HostSim host(&WriteBadly, &wrong);
    const railcast_motion motion = Standing(0.0, 0.0, 3.0);
    EXPECT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_BAD_CALLBACK);
    EXPECT_THAT(railcast_last_error(), testing::EndsWith(wrong.message));
    railcast_frame frame{};
    EXPECT_EQ(railcast_get_frame(host.sim.get(), &frame), RAILCAST_BAD_ARGUMENT);
  }
}

TEST(HostScene, ExceptionOfTheCallbackIsAStatus) {
  const auto cast = [](void*, const railcast_rays*) -> int { throw 42; };
  const HostSim host(cast, nullptr);
  const railcast_motion motion = Standing(0.0, 0.0, 3.0);
  EXPECT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_BAD_CALLBACK);
  EXPECT_EQ(railcast_last_error(), std::string("the callback threw an exception"));
}

TEST(HostScene, StepWithinAStepIsRefused) {
  struct Reentrant {
    railcast_sim* sim{};
    std::atomic<int> num_refusals = 0;
  } reentrant;
  const auto cast = [](void* user, const railcast_rays*) {
    auto& own = *static_cast<Reentrant*>(user);
    const railcast_motion motion = Standing(0.0, 0.0, 3.0);
    if (railcast_step_host(own.sim, 0, &motion) == RAILCAST_BAD_ARGUMENT) ++own.num_refusals;
    return 0;
  };
  const HostSim host(cast, &reentrant);
  reentrant.sim = host.sim.get();
  const railcast_motion motion = Standing(0.0, 0.0, 3.0);
  EXPECT_EQ(railcast_step_host(host.sim.get(), 0, &motion), RAILCAST_OK);
  EXPECT_GT(reentrant.num_refusals, 0);
}

TEST(HostScene, NeedsACallbackAndARung) {
  ScenarioText scenario = ScenarioText::Of("minimal.json");
  railcast_config config = scenario.Config();
  railcast_scene scene{};
  railcast_sim* made = nullptr;
  EXPECT_EQ(railcast_create_with_scene(&config, nullptr, &made), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_create_with_scene(&config, &scene, &made), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(), std::string("scene.cast_rays: must not be null"));
  Wall wall;
  scene = {&Wall::Cast, &wall, nullptr, 0};
  EXPECT_EQ(railcast_create_with_scene(&config, &scene, &made), RAILCAST_BAD_ARGUMENT);
  EXPECT_EQ(railcast_last_error(), std::string("surfaces: must not be null"));
  scenario.Replace("\"version\": 1", "\"version\": 1, \"fidelity\": \"auto\"");
  config = scenario.Config();
  EXPECT_EQ(railcast_create_with_scene(&config, &scene, &made), RAILCAST_BAD_INPUT);
  EXPECT_EQ(railcast_last_error(),
            scenario.file +
                ": /fidelity: must be a rung where the host brings the scene, since "
                "auto measures the scenario's own (got \"auto\")");
  EXPECT_EQ(made, nullptr);
}

}  // namespace
}  // namespace railcast
