#include "generator/extras/import/network/track_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/standing_world.h"

namespace railcast {
namespace {

using ::testing::SizeIs;

/// A crossing with a turnout 10 m behind it, and yard tracks of which 30 and 54 m run along the
/// line: three of eight switches were missing.
TEST(TrackNetwork, HasEachSwitchOnATrackInKarlsruhe) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/osm_more/karlsruhe-kirchfeld.osm.pbf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  const TrackLine track = FindLines(map, 1000.0).front();
  const ImportedLine line = ImportLine(map, track, {});
  LineWorld world = MakeLineWorld(map, track, line);
  AddSideTracks(map, track, line, {}, world);
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, world), std::nullopt);
  EXPECT_EQ(world.quality.num_switches, 8U);
  EXPECT_THAT(world.switches, SizeIs(8));
  EXPECT_THAT(world.crossings, SizeIs(1));
}

}  // namespace
}  // namespace railcast
