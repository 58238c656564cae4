// Times other programs' ways of tracing rays beside ours (peers.h): the same mesh, the same rays,
// in turns in one process. Prints a table in Markdown.
//
//   railcast-peers [SCENARIO] [--plants] [--turns N] [--threads N]
//
// The mesh is what `railcast-generate world` exports, the rays are the beams of the scenario's
// sensor where it stands at time 0. Rows of one thread are in time that the processor spent on it,
// the others in time by the clock.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/simulate/firing_tiles.h"
#include "core/trace/trace_program.h"
#include "generator/world/world_export.h"
#include "railcast/scenario.h"
#include "tests/bench/peers.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

constexpr float kSame_m = 1e-3F;

struct PeersOptions {
  std::string scenario = RAILCAST_SCENARIOS_DIR "/st_gallen_approach.json";
  bool has_plants = false;
  int num_turns = 15;
  int num_threads = 0;
};

// Rays in the order in which railcast traces them, so that neighbours follow each other.
std::vector<Ray> AimedRays(const ScenarioSpec& scenario, const Transform& export_from_sensor) {
  const FiringTiles tiles(BuildScanPattern(scenario.lidar.scan));
  std::vector<Ray> rays;
  const auto firings = std::make_unique<DetectTile>();
  for (std::size_t tile = 0; tile < tiles.num_tiles(); ++tile) {
    tiles.Describe(tile, *firings);
    for (std::size_t lane = 0; lane < tiles.num_firings(tile); ++lane) {
      const Eigen::Vector3f direction(firings->direction_x[lane], firings->direction_y[lane],
                                      firings->direction_z[lane]);
      rays.push_back({export_from_sensor.translation().cast<float>(),
                      export_from_sensor.linear().cast<float>() * direction});
    }
  }
  return rays;
}

PeerScene MakePeerScene(ScenarioSpec scenario, bool has_plants) {
  if (!has_plants) {
    scenario.world.vegetation.trees_per_hectare = 0.0;
    scenario.world.vegetation.grass = false;
  }
  scenario.vehicle.ego_boxes_m.clear();
  const auto world = MakeWorld(scenario);
  const std::vector<int> chunks =
      world->ChunksInReach(world->HomeChunk(0), scenario.lidar.range_max_m);
  ExportedWorld exported = ExportWorld(*world, chunks, ChunksOfObjects(*world, 0), 0);
  const Transform export_from_sensor = exported.world_from_export.inverse() *
                                       world->WorldFromVehicle(0) *
                                       VehicleFromSensor(scenario.lidar.mount);
  return {.mesh = {"world", std::move(exported.parts)},
          .rays = AimedRays(scenario, export_from_sensor),
          .range_max_m = static_cast<float>(scenario.lidar.range_max_m)};
}

/// A peer's answers and the time of each turn.
struct Result {
  std::vector<float> ranges_m;
  std::vector<double> times_ms;
};

std::vector<Result> Measure(const std::vector<Peer>& peers, std::size_t num_rays, int num_turns) {
  std::vector<Result> results(peers.size(), {std::vector<float>(num_rays), {}});
  for (int turn = 0; turn < num_turns; ++turn) {
    for (std::size_t i = 0; i < peers.size(); ++i) {
      peers[i].trace(results[i].ranges_m);  // Warms the caches.
      const double begin_ms = CpuTime_ms();
      const double time_ms = TimeOf_ms([&] { peers[i].trace(results[i].ranges_m); });
      const bool is_alone = peers[i].num_threads == 1;
      results[i].times_ms.push_back(is_alone ? CpuTime_ms() - begin_ms : time_ms);
    }
  }
  return results;
}

std::size_t CountSame(const std::vector<float>& ranges_m,
                      const std::vector<float>& ours_m,
                      float range_max_m) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const float range_m = std::min(ranges_m[i], range_max_m);
    if (std::abs(range_m - ours_m[i]) <= kSame_m) ++count;
  }
  return count;
}

void Print(const std::vector<Peer>& peers, const std::vector<Result>& results, float range_max_m) {
  std::printf(
      "| | threads | build s | p50 ms | x raw trace | same range within 1 mm |\n"
      "|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const std::size_t raw = peers[i].num_threads == 1 ? 0 : 1;  // Its first two rows.
    std::vector<double> ratios;
    for (std::size_t turn = 0; turn < results[i].times_ms.size(); ++turn) {
      ratios.push_back(results[i].times_ms[turn] / results[raw].times_ms[turn]);
    }
    char build_text[32] = "";
    if (!std::isnan(peers[i].build_s)) {
      std::snprintf(build_text, sizeof(build_text), "%.2f", peers[i].build_s);
    }
    std::printf("| %s | %d | %s | %.2f | %.2f | %zu |\n", peers[i].name.c_str(),
                peers[i].num_threads, build_text, Median(results[i].times_ms), Median(ratios),
                CountSame(results[i].ranges_m, results[0].ranges_m, range_max_m));
  }
}

int RunPeers(PeersOptions options) {
  if (options.num_threads == 0) {
    options.num_threads = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
  }
  const PeerScene scene =
      MakePeerScene(PickSensor(ReadScenario(options.scenario), std::nullopt), options.has_plants);
  const std::vector<Peer> peers = MakePeers(scene, options.num_threads);
  const std::vector<Result> results = Measure(peers, scene.rays.size(), options.num_turns);
  const auto num_hits = std::ranges::count_if(
      results[0].ranges_m, [&](float range_m) { return range_m < scene.range_max_m; });
  std::printf("%zu triangles, %zu rays, %zu hits; Embree %s, %s; %d turns\n\n",
              scene.mesh.num_triangles(), scene.rays.size(), static_cast<std::size_t>(num_hits),
              EmbreeVersion().c_str(), IsaInUse("").c_str(), options.num_turns);
  Print(peers, results, scene.range_max_m);
  return kExitSuccess;
}

void Add(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<PeersOptions>();
  app.AddOption("SCENARIO", options->scenario, "Scenario file; default: the demo")
      .Check(NonEmpty());
  app.AddFlag("--plants", options->has_plants, "Keep trees and grass, all leaves as triangles");
  app.AddOption("--turns", options->num_turns, "Turns that each peer takes")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  app.AddOption("--threads", options->num_threads, "Threads of the second rows; 0 = all cores")
      .Check(Whole({0, 1024}))
      .ShowDefault();
  command = [options](const std::string&) { return RunPeers(*options); };
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {"railcast-peers", "Times other ways of tracing rays beside railcast's.", "", railcast::Add},
      argc, argv);
}
