#include "core/scenario/shared_scenery.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

ScenarioSpec Base() {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "station.json");
  spec.lidar.scan.pattern = RasterSpec{120.0, 30.0, 2.0};
  spec.lidar.range_max_m = 60.0;
  return spec;
}

// Scenarios that differ in one thing each.
std::vector<ScenarioSpec> Scenarios() {
  std::vector<ScenarioSpec> all(10, Base());
  all[1].vehicle.start_s_m += 20.0;
  all[2].world.vegetation.trees_per_hectare = 90.0;
  all[3].world.objects.clear();
  all[4].world.seed += 1;
  all[5].world.terrain.roughness_sigma_m = 0.1;
  all[6].materials.insert(all[6].materials.begin(), {.name = "first", .reflectivity = 0.5});
  all[7].weather.rain_rate_mmph = 20.0;
  all[7].vehicle.motion = {};
  // The last two are the first once more.
  return all;
}

const RailWorld& WorldOf(const Simulator& simulator) {
  return dynamic_cast<const RailWorld&>(simulator.world());
}

std::shared_ptr<const RailWorld> MakeWorldOf(const ScenarioSpec& spec, SharedLines& lines) {
  return std::make_shared<const RailWorld>(spec.world, spec.vehicle, LabelTable(spec.labels),
                                           MaterialLibrary(spec.materials), spec.world.seed,
                                           &lines);
}

TEST(SharedScenery, LeavesEveryByteOfFramesAsItIs) {
  SharedScenery shared;
  int number = 0;
  for (ScenarioSpec& spec : Scenarios()) {
    SCOPED_TRACE(number);
    spec.fidelity = number++ % 2 == 0 ? Fidelity::kSurface : Fidelity::kFootprint;
    Frame alone;
    Frame among_others;
    MakeSimulators(spec, 1).front()->Scan(2, alone);
    MakeSimulators(spec, 2, shared).front()->Scan(2, among_others);
    EXPECT_TRUE(FrameBytes(alone) == FrameBytes(among_others));
  }
}

TEST(SharedScenery, BuildsTheLineOfScenariosOnceThatDifferInOtherThings) {
  SharedScenery shared;
  std::vector<std::shared_ptr<const void>> lines;
  for (const ScenarioSpec& spec : Scenarios()) {
    lines.push_back(WorldOf(*MakeSimulators(spec, 1, shared).front()).bare_line());
  }
  ASSERT_NE(lines[1], nullptr);
  for (const std::size_t same : {2U, 3U, 7U, 8U, 9U}) EXPECT_EQ(lines[same], lines[1]) << same;
  for (const std::size_t first : {0U, 4U, 5U, 6U}) EXPECT_EQ(lines[first], nullptr) << first;
}

// Blades and frogs lie as the vehicle runs.
TEST(SharedScenery, HasTurnoutsAsEachVehiclesRouteHasThem) {
  ScenarioSpec branches = ReadScenario(ScenariosDir() / "yard.json");
  branches.lidar.scan.pattern = RasterSpec{60.0, 20.0, 1.0};
  branches.vehicle.motion = {};
  ScenarioSpec runs_on = branches;
  runs_on.vehicle.route.clear();
  SharedScenery shared;
  std::vector<std::string> frames;
  for (const ScenarioSpec& spec : {branches, runs_on, branches, runs_on}) {
    Frame alone;
    Frame among_others;
    MakeSimulators(spec, 1).front()->Scan(0, alone);
    MakeSimulators(spec, 1, shared).front()->Scan(0, among_others);
    frames.push_back(FrameBytes(among_others));
    EXPECT_TRUE(FrameBytes(alone) == frames.back());
  }
  EXPECT_NE(frames[0], frames[1]);
}

// It may change between scenarios, each of which keeps its own.
TEST(SharedScenery, SharesNoLineWithAFileOfHeights) {
  const TemporaryDirectory folder;
  {
    std::ofstream grid(folder.path() / "dem.asc");
    grid << "ncols 60\nnrows 60\nxllcorner -1500\nyllcorner -1500\ncellsize 50\n";
    for (int cell = 0; cell < 60 * 60; ++cell) grid << "0 ";
  }
  ScenarioSpec spec = Base();
  spec.world.terrain.elevation = ElevationSpec{(folder.path() / "dem.asc").string(), {}};
  SharedLines lines;
  static_cast<void>(MakeWorldOf(spec, lines));
  EXPECT_EQ(MakeWorldOf(spec, lines)->bare_line(), nullptr);
}

TEST(SharedScenery, KeepsNoChunksBeyondItsTriangles) {
  SharedLines lines;
  static_cast<void>(MakeWorldOf(Base(), lines));  // Nothing is kept of a line that is new.
  const auto world = MakeWorldOf(Base(), lines);
  const TraceStock::ChunkForm form{.chunk = 2};
  TraceStock all("", SharedScenery::kMostTriangles);
  const auto kept = all.GetChunk(*world, form);
  EXPECT_EQ(all.GetChunk(*world, form), kept);
  EXPECT_EQ(all.GetChunk(*MakeWorldOf(Base(), lines), form), kept);
  TraceStock none("", kept->num_triangles - 1);
  EXPECT_NE(none.GetChunk(*world, form), none.GetChunk(*world, form));
}

}  // namespace
}  // namespace railcast
