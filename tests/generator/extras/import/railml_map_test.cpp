#include "generator/extras/import/map/map_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/map/read_map.h"
#include "railcast/error.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

using ::testing::SizeIs;

class RailMl : public ::testing::Test {
 protected:
  RailMap Read(const std::string& inside, const std::string& crs = "EPSG:4326") {
    WriteFileWhole(file(), Text(inside, crs));
    return ReadMap(file());
  }
  std::string Fault(const std::string& inside, const std::string& crs = "EPSG:4326") {
    return FaultOf(Text(inside, crs));
  }
  std::string FaultOf(const std::string& text) {
    WriteFileWhole(file(), text);
    try {
      static_cast<void>(ReadMap(file()));
    } catch (const InputError& error) {
      return std::string(error.what()).substr(directory_.path().string().size() + 1);
    }
    return "no error";
  }
  static std::string Text(const std::string& inside, const std::string& crs) {
    return R"(<?xml version="1.0"?><railML xmlns="https://www.railml.org/schemas/3.2" version="3.2">
<common><positioning><geometricPositioningSystems>
<geometricPositioningSystem id="gps" crsDefinition=")" +
           crs + R"("/></geometricPositioningSystems></positioning></common><infrastructure>)" +
           inside + "</infrastructure></railML>";
  }
  static std::string Point(const std::string& intrinsic, const std::string& coordinate) {
    return R"(<intrinsicCoordinate intrinsicCoord=")" + intrinsic +
           R"("><geometricCoordinate positioningSystemRef="gps" )" + coordinate +
           "/></intrinsicCoordinate>";
  }
  static std::string Net(const std::string& id, const std::string& points) {
    return R"(<topology><netElements><netElement id=")" + id +
           R"("><associatedPositioningSystem positioningSystemRef="gps">)" + points +
           "</associatedPositioningSystem></netElement></netElements></topology>";
  }
  static std::string Track() {
    return Net("ne1", Point("0", R"(x="15.60" y="48.20" z="250.5")") +
                          Point("0.5", R"(x="15.61" y="48.20" z="251.5")") +
                          Point("1", R"(x="15.62" y="48.21" z="252.5")"));
  }
  static std::string Speed(const std::string& speed, const std::string& range) {
    return R"(<functionalInfrastructure><speedSections><speedSection id="s1" maxSpeed=")" + speed +
           R"("><linearLocation><associatedNetElement netElementRef="ne1" )" + range +
           "/></linearLocation></speedSection></speedSections></functionalInfrastructure>";
  }
  static std::string Cant(const std::string& begin_mm,
                          const std::string& change_mm,
                          const std::string& range) {
    return R"(<geometry><superelevationCurves><superelevationCurve id="c1" superelevation=")" +
           begin_mm + R"(" deltaSuperelevation=")" + change_mm +
           R"("><linearLocation><associatedNetElement netElementRef="ne1" )" + range +
           "/></linearLocation></superelevationCurve></superelevationCurves></geometry>";
  }

 private:
  [[nodiscard]] std::filesystem::path file() const { return directory_.path() / "net.xml"; }
  TemporaryDirectory directory_;
};

TEST_F(RailMl, GivesNetElementsWithTheirHeights) {
  const RailMap map = Read(Track());
  ASSERT_THAT(map.ways, SizeIs(1));
  ASSERT_THAT(map.nodes, SizeIs(3));
  EXPECT_EQ(map.nodes[1].geographic_deg, Eigen::Vector2d(15.61, 48.20));
  EXPECT_EQ(map.nodes[1].height_m, 251.5);
}

TEST_F(RailMl, DividesNetElementsWhereTheSpeedChanges) {
  const RailMap map =
      Read(Track() + Speed("120", R"(intrinsicCoordBegin="0.25" intrinsicCoordEnd="0.5")"));
  ASSERT_THAT(map.ways, SizeIs(3));
  EXPECT_EQ(TagOf(map.ways[0].tags, "maxspeed"), "");
  EXPECT_EQ(TagOf(map.ways[1].tags, "maxspeed"), "120");
  EXPECT_EQ(TagOf(map.ways[2].tags, "maxspeed"), "");
  const MapNode& begin = map.nodes[map.ways[1].nodes.front()];
  EXPECT_NEAR(begin.geographic_deg.x(), 15.605, 1e-9);
  EXPECT_NEAR(begin.height_m.value(), 251.0, 1e-9);
  EXPECT_EQ(map.ways[0].nodes.back(), map.ways[1].nodes.front());
}

TEST_F(RailMl, GivesSurveyedCants) {
  // A ramp, and 90 mm behind it; nothing is said of the rest.
  const RailMap map =
      Read(Track() + Cant("0", "90", R"(intrinsicCoordBegin="0.2" intrinsicCoordEnd="0.6")") +
           Cant("90", "0", R"(intrinsicCoordBegin="0.6" intrinsicCoordEnd="0.8")"));
  ASSERT_THAT(map.ways, SizeIs(1));
  std::vector<double> cants_mm;
  for (const std::size_t node : map.ways[0].nodes) {
    cants_mm.push_back(map.nodes[node].cant_mm.value());
  }
  EXPECT_THAT(cants_mm,
              ::testing::Pointwise(::testing::DoubleNear(1e-9), {0.0, 0.0, 67.5, 90.0, 90.0, 0.0}));
  EXPECT_EQ(Read(Track()).nodes[0].cant_mm, std::nullopt);
  // The element before it, which ends at its first point, says nothing.
  const RailMap two =
      Read(Net("ne0", Point("0", R"(x="15.59" y="48.20")") + Point("1", R"(x="15.60" y="48.20")")) +
           Track() + Cant("90", "0", ""));
  EXPECT_EQ(two.nodes[0].cant_mm, std::nullopt);
  EXPECT_EQ(two.nodes[1].cant_mm, 90.0);
}

TEST_F(RailMl, TakesOtherCoordinateSystems) {
  // 500 km east is the meridian of UTM zone 33.
  const RailMap map = Read(
      Net("ne1", Point("0", R"(x="500000" y="5340000")") + Point("1", R"(x="501000" y="5340000")")),
      "EPSG:32633");
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_NEAR(map.nodes[0].geographic_deg.x(), 15.0, 1e-6);
  EXPECT_NEAR(map.nodes[0].geographic_deg.y(), 48.2, 0.05);
}

TEST_F(RailMl, IsRefusedWhereAllPointsOfASystemInMetresMayBeDegrees) {
  EXPECT_EQ(Fault(Track(), "EPSG:31256"),
            "net.xml: line 3, geometricPositioningSystem gps: must have a point that is in metres, "
            "and no "
            "degrees (got 15.6, 48.2)");
  const RailMap map =
      Read(Net("ne1", Point("0", R"(x="50" y="20")") + Point("1", R"(x="950" y="20")")),
           "+proj=tmerc +lat_0=48.2 +lon_0=15.6 +ellps=WGS84 +units=m");
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_NEAR(map.nodes[0].geographic_deg.y(), 48.2, 0.001) << "20 m from the origin";
}

TEST_F(RailMl, NamesAWayByTheNameInItsNetElement) {
  std::string track = Track();
  const std::string begin = R"(<netElement id="ne1">)";
  track.insert(track.find(begin) + begin.size(), R"(<name name="Hauptgleis" language="de"/>)");
  const RailMap map = Read(track);
  ASSERT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(map.ways[0].tags.at("name"), "Hauptgleis");
}

TEST_F(RailMl, IsRefusedByNameInItsOlderVersion) {
  EXPECT_EQ(FaultOf(R"(<railml xmlns="https://www.railml.org/schemas/2018" version="2.4">
<infrastructure><tracks/></infrastructure></railml>)"),
            "net.xml: must be railML 3, which has coordinates of its net (got railML 2.4)");
}

TEST_F(RailMl, IsRefusedInOneLineWhereItIsWrong) {
  EXPECT_EQ(Fault(""), "net.xml: must have a netElement with geometricCoordinates (got none)");
  EXPECT_EQ(
      Fault(Track(), "EPSG:99999"),
      "net.xml: line 3, geometricPositioningSystem gps/crsDefinition: must be a coordinate system "
      "that PROJ knows, such as EPSG:4326 (got EPSG:99999)");
  EXPECT_EQ(Fault(R"(<netElement id="ne1"><intrinsicCoordinate intrinsicCoord="0">
<geometricCoordinate positioningSystemRef="map" x="15.6" y="48.2"/></intrinsicCoordinate>
</netElement>)"),
            "net.xml: line 4, netElement ne1/positioningSystemRef: must be a "
            "geometricPositioningSystem of "
            "this file (got map)");
  EXPECT_EQ(Fault(Net("ne1", Point("0", R"(x="15.6")"))),
            "net.xml: line 3, netElement ne1/y: must be a number (got none)");
  EXPECT_EQ(Fault(Net("ne1", Point("0", R"(x="15.6" y="north")"))),
            "net.xml: line 3, netElement ne1/y: must be a number (got north)");
  EXPECT_EQ(
      Fault(Net("ne1", Point("0", R"(x="612345" y="5345678")"))),
      "net.xml: line 3, netElement ne1: must be a place in its coordinate system (got 612345, "
      "5345678)");
  EXPECT_EQ(Fault(Net("ne1", Point("0", R"(x="15.6" y="48.2")"))),
            "net.xml: line 3, netElement ne1: must have two different points or more (got 1)");
  EXPECT_EQ(
      Fault(Net("ne1", Point("0", R"(x="15.6" y="48.2" z="99999")"))),
      "net.xml: line 3, netElement ne1/z: must have heights from -1000 to 10000 m (got 99999)");
  EXPECT_EQ(Fault(Track() + Track()),
            "net.xml: line 3, netElement ne1: must be there once (got twice)");
  EXPECT_EQ(Fault(Track() + Speed("-5", "")),
            "net.xml: line 3, speedSection s1/maxSpeed: must be > 0 (got -5)");
  EXPECT_EQ(
      Fault(Track() + Speed("80", R"(intrinsicCoordBegin="0.7" intrinsicCoordEnd="0.2")")),
      "net.xml: line 3, speedSection s1: must have intrinsicCoordBegin < intrinsicCoordEnd, both "
      "from 0 to 1 (got 0.7, 0.2)");
  EXPECT_EQ(
      Fault(Track() + Cant("90", "250", "")),
      "net.xml: line 3, superelevationCurve c1: must have cants from 0 to 300 mm (got 90, 340)");
  EXPECT_EQ(Fault(Track() + Cant("", "0", "")),
            "net.xml: line 3, superelevationCurve c1/superelevation: must be a number (got none)");
  const std::string cut = FaultOf(R"(<?xml version="1.0"?><railML version="3.2"><common>)");
  EXPECT_THAT(cut, ::testing::HasSubstr("net.xml: line 1: must be XML to its end ("));
}

}  // namespace
}  // namespace railcast
