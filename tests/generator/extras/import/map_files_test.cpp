#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/extras/import/map/read_map.h"
#include "railcast/error.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/import/made_pbf.h"
#include "tests/generator/extras/import/written_maps.h"
#include "tests/support/memory_limit.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kFolder = RAILCAST_SOURCE_DIR "/tests/generator/extras/import/malformed";

std::string FaultOf(const fs::path& file) {
  return MessageOf([&] { static_cast<void>(ReadMap(file)); });
}

/// The lines of NAME.expected, each with the file before it.
std::string ExpectedFaultOf(const fs::path& file) {
  std::istringstream lines(ReadFileWhole(file.string() + ".expected"));
  std::string expected;
  for (std::string line; std::getline(lines, line);) {
    expected += (expected.empty() ? "" : "\n") + file.string() + ": " + line;
  }
  return expected;
}

TEST(MalformedMaps, AreRefusedWithFilePlaceRuleAndValue) {
  int num_maps = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".expected") continue;
    ++num_maps;
    EXPECT_EQ(FaultOf(entry.path()), ExpectedFaultOf(entry.path()));
  }
  EXPECT_GE(num_maps, 10);
}

/// Two nodes and a way with railway=rail, maxspeed=90.
std::string SmallPbf(int compression = kRaw) {
  const std::string texts = BytesField(1, "") + BytesField(1, "railway") + BytesField(1, "rail") +
                            BytesField(1, "maxspeed") + BytesField(1, "90");
  const std::string way = VarintField(1, Varint(7)) + BytesField(2, Varint(1) + Varint(3)) +
                          BytesField(3, Varint(2) + Varint(4)) +
                          BytesField(8, Signed(1) + Signed(1));
  const std::string data = BytesField(1, texts) +
                           BytesField(2, NodeOfMap(1, 15.60, 48.20) + NodeOfMap(2, 15.61, 48.21)) +
                           BytesField(2, BytesField(3, way));
  return FileBlock("OSMHeader", BytesField(4, "OsmSchema-V0.6")) +
         FileBlock("OSMData", data, compression);
}

TEST(OsmPbf, IsReadAsAMap) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "map.osm.pbf";
  WriteFileWhole(file, SmallPbf());
  const RailMap map = ReadMap(file);
  ASSERT_THAT(map.ways, SizeIs(1));
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_NEAR(map.nodes[1].geographic_deg.x(), 15.61, 1e-9);
  EXPECT_NEAR(map.nodes[1].geographic_deg.y(), 48.21, 1e-9);
  EXPECT_EQ(TagOf(map.ways[0].tags, "maxspeed"), "90");
}

class OsmPbfWords : public ::testing::Test, public WrittenMaps {};

constexpr const char* kCompression =
    "must be zlib, lz4 or plain (osmium cat IN.pbf -o OUT.pbf makes it so)";

TEST_F(OsmPbfWords, MayHaveThePlacesOfNodesInItsWays) {
  const std::string places = BytesField(9, Signed(482000000) + Signed(100000)) +
                             BytesField(10, Signed(156000000) + Signed(0));
  const RailMap map = Read("map.pbf", FileOfGroups(Way({1, 2}, places)));
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_EQ(map.nodes[1].geographic_deg, Eigen::Vector2d(15.6, 48.21));
}

TEST_F(OsmPbfWords, OfDenseNodesHaveTheirTags) {
  const RailMap map = Read("map.pbf", FileOfGroups(DenseNodes(3) + Way({1, 2, 3})));
  ASSERT_THAT(map.nodes, SizeIs(3));
  EXPECT_EQ(map.nodes[2].geographic_deg, Eigen::Vector2d(15.62, 48.2));
  EXPECT_EQ(map.nodes[1].height_m, 250.0);
  EXPECT_EQ(map.nodes[2].height_m, std::nullopt);
}

TEST_F(OsmPbfWords, CutWaysWhereNodesAreMissing) {
  const RailMap map = Read("map.pbf", FileOfGroups(DenseNodes(4) + Way({1, 2, 98, 99, 3, 4})));
  ASSERT_THAT(map.ways, SizeIs(2));
  EXPECT_THAT(map.nodes, SizeIs(4));
  EXPECT_EQ(RemarkOf(map, RemarkKind::kNodesMissing)->number, 2U);
  EXPECT_EQ(RemarkOf(map, RemarkKind::kNodesMissing)->place, "way 7");
}

TEST_F(OsmPbfWords, LeaveOutWhatIsDeleted) {
  // The second of three nodes is not visible.
  const std::string visible = BytesField(5, BytesField(6, Varint(1) + Varint(0) + Varint(1)));
  const RailMap map = Read("map.pbf", FileOfGroups(DenseNodes(3, visible) + Way({1, 2, 3})));
  ASSERT_THAT(map.ways, SizeIs(1));
  EXPECT_THAT(map.nodes, SizeIs(2));
  EXPECT_EQ(RemarkOf(map, RemarkKind::kDeletedLeftOut)->place, "node 2");
}

TEST_F(OsmPbfWords, AreRefusedIfTheyNeedWhatIsNotRead) {
  for (const std::string feature : {"Curves", "HistoricalInformation"}) {
    EXPECT_EQ(Fault("map.pbf", FileOfGroups("", BytesField(4, feature))),
              "map.pbf: block 1: must need no features but OsmSchema-V0.6, DenseNodes and "
              "LocationsOnWays (got \"" +
                  feature + "\")");
  }
}

TEST_F(OsmPbfWords, OfOtherBlocksAreTold) {
  const RailMap map =
      Read("map.pbf", FileOfGroups(DenseNodes(3) + Way({1, 2, 3})) +
                          FileBlock("Index", "anything") + FileBlock("Index", "more"));
  EXPECT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{{RemarkKind::kExtensionUnread, "", 2, "block \"Index\""}}));
}

TEST_F(OsmPbfWords, AreRefusedIfABlobHasNoData) {
  const std::string header = BytesField(1, "OSMData") + VarintField(3, Varint(2));
  EXPECT_EQ(
      Fault("map.pbf", FileOfGroups("") + std::string(3, '\0') + static_cast<char>(header.size()) +
                           header + VarintField(2, Varint(1))),
      "map.pbf: block 3: " + std::string(kCompression) + " (got PBF error: blob contains no data)");
}

TEST_F(OsmPbfWords, AreRefusedIfTheirBlobsAreCompressedInAWayThatIsNotRead) {
  const std::string rule = "map.pbf: block 2: " + std::string(kCompression) + " (got PBF error: ";
  EXPECT_EQ(Fault("map.pbf", SmallPbf(kLzma)), rule + "lzma blobs not supported)");
  EXPECT_EQ(Fault("map.pbf", SmallPbf(kZstd)), rule + "zstd blobs not supported)");
}

TEST_F(OsmPbfWords, AreRefusedIfTheirBlobsAreDamaged) {
  EXPECT_EQ(Fault("map.pbf", SmallPbf(kZlib)),
            "map.pbf: block 2: must be whole (got failed to uncompress data: data error)");
  EXPECT_EQ(Fault("map.pbf", SmallPbf(kLz4)),
            "map.pbf: block 2: must be whole (got LZ4 decompression failed: invalid block)");
}

TEST_F(OsmPbfWords, AreRefusedIfABlobIsLargerThanItSaysOrMay) {
  const std::string thousand_zeros(
      "\x78\xda\x63\x60\x18\x05\xa3\x60\x14\x0c\x77\x00\x00\x03\xe8\x00\x01", 17);
  const auto fault = [&](std::uint64_t says) {
    const std::string blob = VarintField(2, Varint(says)) + BytesField(kZlib, thousand_zeros);
    const std::string header = BytesField(1, "OSMData") + VarintField(3, Varint(blob.size()));
    return Fault("map.pbf", FileBlock("OSMHeader", "") + std::string(3, '\0') +
                                static_cast<char>(header.size()) + header + blob);
  };
  EXPECT_EQ(fault(999),
            "map.pbf: block 2: must be whole (got failed to uncompress data: buffer error)");
  EXPECT_EQ(fault((32U << 20U) + 1), "map.pbf: block 2: " + std::string(kCompression) +
                                         " (got PBF error: illegal blob size)");
}

TEST_F(OsmPbfWords, AreRefusedIfANodeHasNoPlace) {
  const std::string node = BytesField(1, VarintField(1, Signed(1)));
  EXPECT_EQ(Fault("map.pbf", FileOfGroups(BytesField(2, node) + Way({1, 2}))),
            "map.pbf: block 2: must be whole (got a node without place)");
}

TEST_F(OsmPbfWords, AreRefusedIfPlacesAreNoDegrees) {
  // An origin that is 2^32 of their units further east.
  const std::string origin = VarintField(20, Varint(429'496'729'600));
  EXPECT_EQ(Fault("map.pbf", FileOfGroups(DenseNodes(2) + Way({1, 2}) + origin)),
            "map.pbf: block 2: must have places that are degrees (got 445.0967296)");
}

TEST_F(OsmPbfWords, NeedNoMemoryForATextEachTimeThatItIsUsed) {
  if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve more than can be limited";
  constexpr std::size_t kUses = 1 << 20;  // 2 GB of text.
  const std::string texts = BytesField(1, "") + BytesField(1, std::string(1000, 'x'));
  const std::string tags =
      BytesField(2, std::string(kUses, 1)) + BytesField(3, std::string(kUses, 1));
  const std::string way = BytesField(2, BytesField(3, VarintField(1, Varint(7)) + tags));
  const fs::path file = Write(
      "map.pbf", FileBlock("OSMHeader", "") + FileBlock("OSMData", BytesField(1, texts) + way));
  EXPECT_EXIT(
      {
        LimitMemory(256 << 20);
        std::cerr << FaultOf(file);
        std::exit(0);
      },
      ::testing::ExitedWithCode(0), "got 1 other ways");
}

TEST(OsmPbf, OfMonacoIsReadWithLz4AsWithZlib) {
  const std::filesystem::path file = RAILCAST_SHARED_DATA_DIR "/osm_more/monaco.lz4.osm.pbf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  const RailMap map = ReadMap(file);
  const RailMap same = ReadMap(RAILCAST_SHARED_DATA_DIR "/osm_more/monaco.osm.pbf");
  EXPECT_GE(map.ways.size(), 13U);
  ASSERT_EQ(map.nodes.size(), same.nodes.size());
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    EXPECT_EQ(map.nodes[i].geographic_deg, same.nodes[i].geographic_deg);
  }
}

TEST(OsmPbf, NamesOpenStreetMapAsItsSource) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "map.osm.pbf";
  WriteFileWhole(file, SmallPbf());
  EXPECT_THAT(ReadMap(file).attribution, HasSubstr("OpenStreetMap contributors"));
}

TEST(OsmPbf, IsRefusedIfItIsCutOff) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "map.osm.pbf";
  const std::string whole = SmallPbf();
  WriteFileWhole(file, whole.substr(0, whole.size() - 20));
  const std::string message = MessageOf([&] { static_cast<void>(ReadMap(file)); });
  EXPECT_THAT(message, HasSubstr("map.osm.pbf: block 2: must be whole"));
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// Nodes 0 to 6 at longitudes 0 to 6; one way through all of them.
RailMap StraightMap() {
  RailMap map;
  map.ways.push_back({7, {}, {{"name", "Main Line"}}});
  for (int i = 0; i < 7; ++i) {
    map.nodes.push_back({.geographic_deg = Eigen::Vector2d(i, 48.0), .tags = {}});
    map.ways[0].nodes.push_back(static_cast<std::size_t>(i));
  }
  return map;
}

Eigen::AlignedBox2d Between(double west_deg, double east_deg) {
  return {Eigen::Vector2d(west_deg, 47.0), Eigen::Vector2d(east_deg, 49.0)};
}

TEST(CropMap, KeepsTheStretchOfAWayThatLiesInside) {
  const RailMap cropped = CropMap(StraightMap(), Between(1.5, 4.5));
  ASSERT_THAT(cropped.nodes, SizeIs(3));
  EXPECT_EQ(cropped.nodes[0].geographic_deg.x(), 2.0);
  ASSERT_THAT(cropped.ways, SizeIs(1));
  EXPECT_THAT(cropped.ways[0].nodes, ElementsAre(0, 1, 2));
  EXPECT_EQ(cropped.ways[0].id, 7);
  EXPECT_EQ(TagOf(cropped.ways[0].tags, "name"), "Main Line");
}

TEST(CropMap, DividesAWayThatLeavesAndComesBack) {
  RailMap map = StraightMap();
  map.nodes[3].geographic_deg.y() = 50.0;
  map.nodes[5].geographic_deg.y() = 50.0;  // Behind it one point remains, which is no way.
  const RailMap cropped = CropMap(map, Between(-1.0, 5.5));
  ASSERT_THAT(cropped.ways, SizeIs(1));
  EXPECT_THAT(cropped.ways[0].nodes, ElementsAre(0, 1, 2));
  map.nodes[5].geographic_deg.y() = 48.0;
  const RailMap two = CropMap(map, Between(-1.0, 5.5));
  ASSERT_THAT(two.ways, SizeIs(2));
  EXPECT_THAT(two.ways[1].nodes, ElementsAre(3, 4));
}

TEST(CropMap, LeavesOutWhatIsSaidOfWaysOutside) {
  RailMap map = StraightMap();
  map.ways[0].place = "way 7";
  map.ways.push_back({8, {0, 1}, {}, "way 8"});
  for (const char* place : {"way 7", "way 8", "node 3", ""}) {
    map.remarks.push_back({RemarkKind::kTagsUnread, place});
  }
  const RailMap cropped = CropMap(map, Between(1.5, 4.5));
  ASSERT_THAT(cropped.remarks, SizeIs(3));
  EXPECT_EQ(cropped.remarks[0].place, "way 7");
  EXPECT_EQ(cropped.remarks[1].place, "node 3");
}

TEST(CropMap, LeavesOutThingsThatReachOutside) {
  RailMap map = StraightMap();
  for (const double end_deg : {3.0, 6.0}) {
    map.things.push_back(
        {.geographic_deg = {{2.0, 48.0}, {end_deg, 48.0}}, .places_m = {}, .tags = {}});
  }
  const RailMap cropped = CropMap(map, Between(1.5, 4.5));
  ASSERT_THAT(cropped.things, SizeIs(1));
  EXPECT_EQ(cropped.things[0].geographic_deg[1].x(), 3.0);
}

}  // namespace
}  // namespace railcast
