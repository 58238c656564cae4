// Measures what the C interface costs beside the C++ interface.
//
//   railcast-c-bench [NUM_FRAMES]
//
// In each case both make the same frames in turn, in one process and on one thread, and read all
// fields; which of them comes first changes from frame to frame. Times are the thread's own, so
// that other programs on the machine disturb them less. The median over the frames of the ratios is
// printed, with its 95 % interval. Cases: a scenario in its own world, and
// a scene of the host that costs next to nothing to trace, a wall, so that the way to the callback
// and back weighs most.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "core/program/program.h"
#include "railcast/c_api.h"
#include "railcast/error.h"
#include "railcast/frame.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr railcast_pose kPose{{10.0, 0.0, 2.5}, {0.0, 0.0, 0.0, 1.0}};

void CastAtWall(const railcast_rays& rays) {
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const float range_m = (60.0F - rays.origin_x[i]) / rays.direction_x[i];
    if (!(range_m > 0.0F && range_m < rays.range_m[i])) continue;
    rays.range_m[i] = range_m;
    rays.normal_x[i] = -1.0F;
    rays.surface[i] = 1;
  }
}

class WallCaster final : public RayCaster {
 public:
  void Cast(RayTile& tile) const override {
    CastAtWall({tile.num_rays, tile.origin_x, tile.origin_y, tile.origin_z, tile.direction_x,
                tile.direction_y, tile.direction_z, tile.shutter, tile.range_m, tile.surface,
                tile.normal_x, tile.normal_y, tile.normal_z});
  }
};

void Ensure(railcast_status status) {
  if (status != RAILCAST_OK) throw InputError(railcast_last_error());
}

using Step = std::function<void(std::uint32_t frame)>;

double ThreadTime_s() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double Time_s(const Step& step, std::uint32_t frame) {
  const double begin_s = ThreadTime_s();
  step(frame);
  return ThreadTime_s() - begin_s;
}

void Compare(const std::string& what, std::uint32_t num_frames, const Step& cpp, const Step& c) {
  std::vector<double> ratios;
  std::vector<double> times_ms;
  cpp(0);
  c(0);
  for (std::uint32_t i = 0; i < num_frames; ++i) {
    const std::uint32_t frame = i % 8;
    const double first_s = Time_s(i % 2 == 0 ? cpp : c, frame);
    const double second_s = Time_s(i % 2 == 0 ? c : cpp, frame);
    ratios.push_back(i % 2 == 0 ? second_s / first_s : first_s / second_s);
    times_ms.push_back(1e3 * (i % 2 == 0 ? first_s : second_s));
  }
  std::sort(ratios.begin(), ratios.end());
  std::sort(times_ms.begin(), times_ms.end());
  // The ranks between which the median lies with 95 % confidence.
  const double middle = 0.5 * num_frames;
  const double half_width = 0.98 * std::sqrt(num_frames);
  const auto at = [&](double rank) {
    return ratios[static_cast<std::size_t>(std::clamp(rank, 0.0, num_frames - 1.0))];
  };
  std::printf("%-12s C++ %.3f ms, C / C++ %.4f (%.4f to %.4f)\n", what.c_str(),
              times_ms[times_ms.size() / 2], at(middle), at(middle - half_width),
              at(middle + half_width));
}

// Reads the address of every field.
void ReadFields(railcast_sim* sim) {
  const Frame table;
  ForEachField(table, [&](const char* name, const char*, const auto&) {
    railcast_field field{};
    Ensure(railcast_get_field(sim, name, &field));
  });
}

int Main(int argc, char** argv) {
  const auto num_frames = static_cast<std::uint32_t>(argc > 1 ? std::stoul(argv[1]) : 400);
  const std::string file = std::string(RAILCAST_SCENARIOS_DIR) + "/bench.json";
  for (const std::string rung : {"plausibility", "surface"}) {
    const std::string text =
        R"({"version": 1, "file": "minimal.json", "fidelity": ")" + rung + "\"}";
    const railcast_config config{text.c_str(), file.c_str(), nullptr, 1};
    const ScenarioSpec scenario = ReadScenarioText(text, file);
    const auto simulator = MakeSimulator(scenario, 1);
    Frame frame;
    railcast_sim* sim = nullptr;
    Ensure(railcast_create(&config, &sim));
    const std::unique_ptr<railcast_sim, decltype(&railcast_destroy)> owner(sim, &railcast_destroy);
    Compare(
        rung, num_frames, [&](std::uint32_t i) { simulator->Scan(i, frame); },
        [&](std::uint32_t i) {
          Ensure(railcast_step(sim, i));
          ReadFields(sim);
        });

    const std::uint16_t concrete = MaterialLibrary(scenario.materials).Index("concrete");
    const std::vector<Surface> surfaces = {{}, {.material = concrete}};
    const WallCaster caster;
    const railcast_surface table[] = {{}, {"concrete", "building", 0, 0}};
    const railcast_scene scene{[](void*, const railcast_rays* rays) {
                                 CastAtWall(*rays);
                                 return 0;
                               },
                               nullptr, table, 2};
    const railcast_motion motion{kPose, kPose, {0.0, 0.0, 0.0}};
    railcast_sim* host = nullptr;
    Ensure(railcast_create_with_scene(&config, &scene, &host));
    const std::unique_ptr<railcast_sim, decltype(&railcast_destroy)> host_owner(host,
                                                                                &railcast_destroy);
    auto world = std::make_shared<SimpleWorld>();
    world->chunk_from_vehicle =
        MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Map<const Vector3>(kPose.position_m)) *
        simulator->spec().vehicle_from_sensor.inverse();
    simulator->UseWorld(world);
    Compare(
        rung + "_host", num_frames,
        [&](std::uint32_t i) {
          simulator->Scan(i, {caster, Transform::Identity(), surfaces}, frame);
        },
        [&](std::uint32_t i) {
          Ensure(railcast_step_host(host, i, &motion));
          ReadFields(host);
        });
  }
  return kExitSuccess;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-c-bench", [&] { return railcast::Main(argc, argv); }, std::cerr);
}
