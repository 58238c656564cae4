#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/io/write_file.h"
#include "generator/import/map/read_map.h"
#include "railcast/error.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/import/written_maps.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

// The encoding of https://wiki.openstreetmap.org/wiki/PBF_Format, with blobs that are not
// compressed.

std::string Varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>((value & 0x7F) | 0x80);
  return bytes + static_cast<char>(value);
}
std::string Signed(std::int64_t value) {
  return Varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}
std::string Number(int field, const std::string& value) {
  return Varint(static_cast<std::uint64_t>(field) << 3) + value;
}
std::string Bytes(int field, const std::string& value) {
  return Varint((static_cast<std::uint64_t>(field) << 3) | 2) + Varint(value.size()) + value;
}

/// The fields of a blob that hold its data, by how this is compressed.
constexpr int kRaw = 1;
constexpr int kLz4 = 6;
constexpr int kZstd = 7;

std::string FileBlock(const std::string& type, const std::string& content, int compression = kRaw) {
  const std::string raw_size = compression == kRaw ? "" : Number(2, Varint(content.size()));
  const std::string blob = raw_size + Bytes(compression, content);
  const std::string header = Bytes(1, type) + Number(3, Varint(blob.size()));
  std::string block(3, '\0');
  return block + static_cast<char>(header.size()) + header + blob;
}

std::string NodeOfMap(std::int64_t id, double longitude_deg, double latitude_deg) {
  const auto units = [](double angle_deg) {
    return Signed(static_cast<std::int64_t>(angle_deg * 1e7 + 0.5));
  };
  return Bytes(
      1, Number(1, Signed(id)) + Number(8, units(latitude_deg)) + Number(9, units(longitude_deg)));
}

constexpr const char* kTexts[] = {"", "railway", "rail", "maxspeed", "90", "ele", "250"};

std::string FileOfGroups(const std::string& groups, const std::string& header = "") {
  std::string texts;
  for (const char* text : kTexts) texts += Bytes(1, text);
  return FileBlock("OSMHeader", Bytes(4, "OsmSchema-V0.6") + header) +
         FileBlock("OSMData", Bytes(1, texts) + groups);
}

/// A way with railway=rail through the nodes with these ids.
std::string Way(const std::vector<std::int64_t>& nodes, const std::string& more = "") {
  std::string differences;
  std::int64_t before = 0;
  for (const std::int64_t node : nodes) differences += Signed(node - std::exchange(before, node));
  return Bytes(2, Bytes(3, Number(1, Varint(7)) + Bytes(2, Varint(1)) + Bytes(3, Varint(2)) +
                               Bytes(8, differences) + more));
}

/// Two nodes and a way with railway=rail, maxspeed=90.
std::string SmallPbf(int compression = kRaw) {
  const std::string texts =
      Bytes(1, "") + Bytes(1, "railway") + Bytes(1, "rail") + Bytes(1, "maxspeed") + Bytes(1, "90");
  const std::string way = Number(1, Varint(7)) + Bytes(2, Varint(1) + Varint(3)) +
                          Bytes(3, Varint(2) + Varint(4)) + Bytes(8, Signed(1) + Signed(1));
  const std::string data = Bytes(1, texts) +
                           Bytes(2, NodeOfMap(1, 15.60, 48.20) + NodeOfMap(2, 15.61, 48.21)) +
                           Bytes(2, Bytes(3, way));
  return FileBlock("OSMHeader", Bytes(4, "OsmSchema-V0.6")) +
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

TEST_F(OsmPbfWords, MayHaveThePlacesOfNodesInItsWays) {
  const std::string places =
      Bytes(9, Signed(482000000) + Signed(100000)) + Bytes(10, Signed(156000000) + Signed(0));
  const RailMap map = Read("map.pbf", FileOfGroups(Way({1, 2}, places)));
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_EQ(map.nodes[1].geographic_deg, Eigen::Vector2d(15.6, 48.21));
}

/// Nodes 1 to `num` as dense ones, each 0.01 degrees east of the one before; the second has a
/// height.
std::string DenseNodes(int num, const std::string& more = "") {
  std::string ids;
  std::string latitudes;
  std::string longitudes;
  std::string words;
  for (int i = 0; i < num; ++i) {
    ids += Signed(1);
    latitudes += Signed(i == 0 ? 482000000 : 0);
    longitudes += Signed(i == 0 ? 156000000 : 100000);
    words += i == 1 ? Varint(5) + Varint(6) + Varint(0) : Varint(0);
  }
  return Bytes(2, Bytes(2, Bytes(1, ids) + Bytes(8, latitudes) + Bytes(9, longitudes) +
                               Bytes(10, words) + more));
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
  const std::string visible = Bytes(5, Bytes(6, Varint(1) + Varint(0) + Varint(1)));
  const RailMap map = Read("map.pbf", FileOfGroups(DenseNodes(3, visible) + Way({1, 2, 3})));
  ASSERT_THAT(map.ways, SizeIs(1));
  EXPECT_THAT(map.nodes, SizeIs(2));
  EXPECT_EQ(RemarkOf(map, RemarkKind::kDeletedLeftOut)->place, "node 2");
}

TEST_F(OsmPbfWords, AreRefusedIfTheyNeedWhatIsNotRead) {
  for (const std::string feature : {"Curves", "HistoricalInformation"}) {
    EXPECT_EQ(Fault("map.pbf", FileOfGroups("", Bytes(4, feature))),
              "map.pbf: must need no features but OsmSchema-V0.6, DenseNodes and LocationsOnWays "
              "(got \"" +
                  feature + "\")");
  }
}

TEST_F(OsmPbfWords, AreRefusedIfABlobHasNoData) {
  const std::string header = Bytes(1, "OSMData") + Number(3, Varint(2));
  EXPECT_EQ(Fault("map.pbf", FileOfGroups("") + std::string(3, '\0') +
                                 static_cast<char>(header.size()) + header + Number(2, Varint(0))),
            "map.pbf: must be a .pbf file to its end (got damaged data)");
}

TEST(OsmPbf, IsRefusedIfItsBlobsAreCompressedInAWayThatIsNotRead) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "map.osm.pbf";
  const auto fault = [&](int compression) -> std::string {
    WriteFileWhole(file, SmallPbf(compression));
    try {
      static_cast<void>(ReadMap(file));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string rule = file.string() +
                           ": must have blobs that are zlib or plain (osmium cat IN.pbf -o OUT.pbf "
                           "makes them so) (got ";
  EXPECT_EQ(fault(kLz4), rule + "lz4)");
  EXPECT_EQ(fault(kZstd), rule + "zstd)");
}

TEST(OsmPbf, OfMonacoIsReadWithZlibAndRefusedWithLz4) {
  const std::filesystem::path file = RAILCAST_SHARED_DATA_DIR "/osm_more/monaco.lz4.osm.pbf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  EXPECT_THROW(static_cast<void>(ReadMap(file)), InputError);
  const std::filesystem::path same = RAILCAST_SHARED_DATA_DIR "/osm_more/monaco.osm.pbf";
  EXPECT_GE(ReadMap(same).ways.size(), 13U);
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
  try {
    static_cast<void>(ReadMap(file));
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("map.osm.pbf: must be "));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace railcast
