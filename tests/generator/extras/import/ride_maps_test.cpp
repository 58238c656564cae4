// Lines that a receiver on the way has recorded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "generator/extras/import/map/map_lines.h"
#include "tests/generator/extras/import/written_maps.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class RideMaps : public ::testing::Test, public WrittenMaps {};

/// How many nodes each way has.
std::vector<std::size_t> NumbersOfNodes(const RailMap& map) {
  std::vector<std::size_t> numbers;
  for (const MapWay& way : map.ways) numbers.push_back(way.nodes.size());
  return numbers;
}

/// Points of GPX from one longitude on, 0.01 degrees apart.
std::string GpxPoints(int num, int longitude_percent, const std::string& name = "trkpt") {
  std::string points;
  for (int i = 0; i < num; ++i) {
    points += "<" + name + " lat='48.2' lon='" + std::to_string(longitude_percent + i) + "e-2'/>";
  }
  return points;
}

TEST_F(RideMaps, OfSegmentsWithoutTwoPlacesAreLeftOut) {
  const std::string standing =
      "<trkseg/><trkseg>" + GpxPoints(1, 1500) + GpxPoints(1, 1500) + "</trkseg>";
  const RailMap map = Read(
      "a.gpx", "<gpx><trk>" + standing + "<trkseg>" + GpxPoints(3, 1560) + "</trkseg></trk></gpx>");
  EXPECT_EQ(NumbersOfNodes(map), std::vector<std::size_t>{3});
  EXPECT_THAT(map.nodes, SizeIs(3));
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{
                {RemarkKind::kLinesLeftOut, "line 1, trkseg", 1, "its different points are 0"},
                {RemarkKind::kLinesLeftOut, "line 1, trkseg", 1, "its different points are 1"}}));
  EXPECT_THAT(Fault("b.gpx", "<gpx><trk>" + standing + "</trk></gpx>"),
              HasSubstr("b.gpx: line 1, trkseg: must have two different points or more (got 1)"));
}

TEST_F(RideMaps, OfTracksWithoutSegmentsAreLinesOfTheirOwn) {
  const RailMap map = Read(
      "a.gpx", "<gpx><trk>" + GpxPoints(3, 1560) + "</trk><trk><trkseg>" + GpxPoints(4, 1570) +
                   "</trkseg></trk><trk><name>third</name>" + GpxPoints(5, 1580) + "</trk></gpx>");
  EXPECT_EQ(NumbersOfNodes(map), (std::vector<std::size_t>{3, 4, 5}));
  EXPECT_EQ(TagOf(map.ways[2].tags, "name"), "third");
  EXPECT_EQ(Fault("b.gpx", "<gpx>" + GpxPoints(1, 1560) + "</gpx>"),
            "b.gpx: line 1, trkpt: must be in a track or route (got in <gpx>)");
}

TEST_F(RideMaps, OfGarminsRoutesHaveTheirShape) {
  const RailMap map =
      Read("a.gpx",
           "<gpx xmlns:gpxx='x'><rte><rtept lat='48.2' lon='15.6'><extensions>"
           "<gpxx:RoutePointExtension>" +
               GpxPoints(3, 1560, "gpxx:rpt") + "</gpxx:RoutePointExtension></extensions></rtept>" +
               GpxPoints(1, 1563, "rtept") + "</rte></gpx>");
  EXPECT_EQ(NumbersOfNodes(map), std::vector<std::size_t>{4});
}

TEST_F(RideMaps, OfPointsWithoutAFixLeaveThemOut) {
  const RailMap map = Read("a.gpx",
                           "<gpx><trk><trkseg><trkpt lat='48.2' lon='15.6'><fix>3d</fix></trkpt>\n"
                           "<trkpt lat='0' lon='0'><fix>none</fix><ele>7</ele></trkpt>\n"
                           "<trkpt lat='48.2' lon='15.61'/></trkseg></trk></gpx>");
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_EQ(map.nodes[1].geographic_deg, Eigen::Vector2d(15.61, 48.2));
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{{RemarkKind::kPointsWithheld, "line 2", 1, "<fix> none"}}));
}

TEST_F(RideMaps, AreReadInEncodingsOfOneByteAndOthersRefused) {
  const auto text = [](const std::string& encoding, const std::string& name) {
    return "<?xml version='1.0' encoding='" + encoding + "'?><gpx><trk><name>" + name +
           "</name><trkseg>" + GpxPoints(2, 1560) + "</trkseg></trk></gpx>";
  };
  for (const auto& [encoding, name, same] :
       std::vector<std::array<std::string, 3>>{{"windows-1252", "T\xFCrnitz \x80", "Türnitz €"},
                                               {"ISO-8859-15", "T\xFCrnitz \xA4", "Türnitz €"},
                                               {"windows-1250", "Plze\xF2", "Plzeň"}}) {
    EXPECT_EQ(TagOf(Read("a.gpx", text(encoding, name)).ways.at(0).tags, "name"), same);
  }
  EXPECT_EQ(Fault("b.gpx", text("GBK", "x")),
            "b.gpx: encoding: must be UTF-8, UTF-16 or one with a byte for each letter (got "
            "\"GBK\")");
}

constexpr double kPerMetre_deg = 1.0 / 111.3e3;

TEST(ThinFixes, MakesOneOfThoseWhereAReceiverStood) {
  MapLine line;
  for (int i = 0; i <= 10; ++i) line.points_deg.emplace_back(0.0, 80.0 * i * kPerMetre_deg);
  for (int i = 0; i < 30; ++i) {
    // On a circle of 8 m.
    line.points_deg.emplace_back(8.0 * std::sin(2.0 * i) * kPerMetre_deg,
                                 (880.0 + 8.0 * std::cos(2.0 * i)) * kPerMetre_deg);
  }
  for (int i = 12; i <= 20; ++i) line.points_deg.emplace_back(0.0, 80.0 * i * kPerMetre_deg);
  EXPECT_EQ(ThinFixes(line), 29U);
  ASSERT_THAT(line.points_deg, SizeIs(21));
  EXPECT_NEAR(line.points_deg[11].y() / kPerMetre_deg, 880.0, 1.0);
  EXPECT_NEAR(line.points_deg[11].x() / kPerMetre_deg, 0.0, 1.0);
}

TEST(ThinFixes, FindsStopsOfFixesThatAreThereTwice) {
  MapLine line;
  for (int i = 0; i < 60; ++i) {
    line.points_deg.insert(line.points_deg.end(), 2,
                           {8.0 * std::sin(2.0 * (i / 2)) * kPerMetre_deg,
                            8.0 * std::cos(2.0 * (i / 2)) * kPerMetre_deg});
  }
  static_cast<void>(ThinFixes(line));
  EXPECT_THAT(line.points_deg, SizeIs(1));
}

TEST(ThinFixes, TakesManyThatAreEqualOrHardlyMove) {
  constexpr int kMany = 100000;
  MapLine equal;
  for (int i = 0; i < kMany; ++i) equal.points_deg.emplace_back(15.6, 48.2);
  equal.heights_m.resize(kMany);
  equal.heights_m[1] = 250.0;
  EXPECT_EQ(ThinFixes(equal), 0U);
  EXPECT_THAT(equal.points_deg, SizeIs(1));
  EXPECT_THAT(equal.heights_m, ::testing::ElementsAre(250.0));
  MapLine slow;
  for (int i = 0; i < kMany; ++i) slow.points_deg.emplace_back(0.0, 1e-3 * i * kPerMetre_deg);
  EXPECT_EQ(ThinFixes(slow), 0U);
}

TEST(ThinFixes, LeavesDenseOnesThatGoOn) {
  MapLine line;
  for (int i = 0; i <= 100; ++i) line.points_deg.emplace_back(0.0, 2.0 * i * kPerMetre_deg);
  EXPECT_EQ(ThinFixes(line), 0U);
}

}  // namespace
}  // namespace railcast
