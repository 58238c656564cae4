#include "generator/extras/import/map/read_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "generator/extras/import/map/map_projection.h"
#include "railcast/error.h"
#include "tests/core/io/message_of.h"
#include "tests/generator/extras/import/written_maps.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class Maps : public ::testing::Test, public WrittenMaps {
 protected:
  std::string OverpassFault(const std::string& elements) {
    return Fault("map.json", R"({"version": 0.6, "elements": [)" + elements + "]}");
  }
};

constexpr const char* kNodes = R"(
  {"type": "node", "id": 1, "lon": 15.60, "lat": 48.20},
  {"type": "node", "id": 2, "lon": 15.61, "lat": 48.20, "tags": {"railway": "switch"}},
  {"type": "node", "id": 3, "lon": 15.62, "lat": 48.21},)";

TEST_F(Maps, AreReadFromOverpassJson) {
  const RailMap map =
      ReadMap(Write("map.json", R"({"elements": [
    {"type": "way", "id": 7, "nodes": [1, 2, 2, 3],
     "tags": {"railway": "rail", "maxspeed": "120"}},
    {"type": "way", "id": 8, "nodes": [1, 3], "tags": {"railway": "platform"}},)" +
                                    std::string(kNodes) + R"({"type": "relation", "id": 9}]})"));
  ASSERT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(map.ways[0].id, 7);
  EXPECT_THAT(map.ways[0].nodes, ::testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(TagOf(map.ways[0].tags, "maxspeed"), "120");
  EXPECT_EQ(TagOf(map.nodes[1].tags, "railway"), "switch");
  EXPECT_EQ(map.nodes[2].geographic_deg, Eigen::Vector2d(15.62, 48.21));
  EXPECT_THAT(map.attribution, HasSubstr("OpenStreetMap contributors"));
}

TEST_F(Maps, AreReadFromOverpassJsonWithGeometries) {
  // As `out geom;` gives it, and as `out tags geom;` does, without the ids of nodes.
  for (const std::string ids : {R"("nodes": [1, 2],)", ""}) {
    const std::string more = ids.empty() ? "" : R"("nodes": [2, 3],)";
    const RailMap map = ReadMap(Write("map.json", R"({"elements": [
    {"type": "way", "id": 7, )" + ids + R"("tags": {"railway": "rail"},
     "bounds": {"minlat": 48.20, "minlon": 15.60, "maxlat": 48.20, "maxlon": 15.61},
     "geometry": [{"lat": 48.20, "lon": 15.60}, {"lat": 48.20, "lon": 15.61}]},
    {"type": "way", "id": 8, )" + more + R"("tags": {"railway": "rail"},
     "geometry": [{"lat": 48.20, "lon": 15.61}, {"lat": 48.21, "lon": 15.62}]}]})"));
    ASSERT_THAT(map.ways, SizeIs(2)) << ids;
    ASSERT_THAT(map.nodes, SizeIs(3)) << ids;
    EXPECT_EQ(map.ways[0].nodes.back(), map.ways[1].nodes.front()) << ids;
    EXPECT_EQ(map.nodes[2].geographic_deg, Eigen::Vector2d(15.62, 48.21)) << ids;
  }
}

TEST_F(Maps, TakeTheTagsOfANodeThatAnAnswerRepeatsWithThem) {
  const RailMap map = ReadMap(Write("map.json", R"({"elements": [)" + std::string(kNodes) + R"(
    {"type": "node", "id": 3, "lon": 15.62, "lat": 48.21,
     "tags": {"railway": "signal", "ele": "251.5"}},
    {"type": "way", "id": 7, "nodes": [1, 2, 3], "tags": {"railway": "rail"}}]})"));
  ASSERT_THAT(map.nodes, SizeIs(3));
  EXPECT_EQ(map.nodes[2].height_m, 251.5);
  EXPECT_THAT(map.things, SizeIs(1));
}

TEST_F(Maps, AreReadFromOpenStreetMapsXml) {
  const RailMap map = ReadMap(Write("map.osm", R"(<?xml version="1.0"?>
<osm version="0.6">
  <node id="1" lat="48.20" lon="15.60"/>
  <node id="2" lat="48.20" lon="15.61"/>
  <node id="3" lat="48.21" lon="15.62"/>
  <node id="4" lat="48.19" lon="15.62"/>
  <way id="7"><nd ref="1"/><nd ref="2"/><tag k="railway" v="rail"/><tag k="maxspeed" v="90"/>
    <tag k="name" v="The &quot;old&quot; line"/></way>
  <way id="8"><nd ref="2"/><nd ref="3"/><tag k="railway" v="rail"/></way>
  <way id="9"><nd ref="2"/><nd ref="4"/><tag k="highway" v="primary"/></way>
</osm>)"));
  ASSERT_THAT(map.ways, SizeIs(2));
  EXPECT_EQ(map.ways[0].nodes.back(), map.ways[1].nodes.front()) << "they share node 2";
  EXPECT_EQ(TagOf(map.ways[0].tags, "maxspeed"), "90");
  EXPECT_EQ(TagOf(map.ways[0].tags, "name"), "The \"old\" line");
  EXPECT_THAT(map.attribution, HasSubstr("OpenStreetMap contributors"));
}

TEST_F(Maps, OfOpenStreetMapMayHaveTheirNodesInAnyOrder) {
  const RailMap map = ReadMap(Write("map.osm", R"(<?xml version="1.0"?>
<osm version="0.6">
  <node id="30" lat="48.21" lon="15.62"/>
  <node id="1" lat="48.20" lon="15.60"/>
  <node id="-2" lat="48.20" lon="15.61"/>
  <way id="7"><nd ref="1"/><nd ref="-2"/><nd ref="30"/><tag k="railway" v="rail"/></way>
</osm>)"));
  ASSERT_THAT(map.ways, SizeIs(1));
  ASSERT_THAT(map.ways[0].nodes, SizeIs(3));
  EXPECT_EQ(map.nodes[map.ways[0].nodes[1]].geographic_deg, Eigen::Vector2d(15.61, 48.20));
}

TEST_F(Maps, NameOpenStreetMapIfTheySayThatTheyAreOfIt) {
  const auto attribution = [&](const std::string& head, const std::string& properties) {
    return ReadMap(Write("map.geojson", R"({"type": "FeatureCollection", )" + head + R"(
      "features": [{"type": "Feature", "properties": {)" +
                                            properties + R"(}, "geometry": {"type": "LineString",
      "coordinates": [[15.6, 48.2], [15.61, 48.2]]}}]})"))
        .attribution;
  };
  const std::string copyright =
      R"("copyright": "The data included in this document is from www.openstreetmap.org.",)";
  EXPECT_EQ(attribution("", ""), "");
  EXPECT_THAT(attribution(copyright, ""), HasSubstr("ODbL"));
  EXPECT_THAT(attribution("", R"("@id": "way/7")"), HasSubstr("ODbL"));
  EXPECT_THAT(attribution("", R"("osm_id": "7")"), HasSubstr("ODbL"));
}

TEST_F(Maps, AreReadFromGeoJson) {
  const RailMap map = ReadMap(Write("map.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"railway": "rail", "maxspeed": "60"},
     "geometry": {"type": "LineString", "coordinates": [[15.6, 48.2], [15.61, 48.2]]}},
    {"type": "Feature", "properties": {"railway": "station"},
     "geometry": {"type": "Point", "coordinates": [15.6, 48.2]}}]})"));
  ASSERT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(TagOf(map.ways[0].tags, "maxspeed"), "60");
}

TEST_F(Maps, OfGeoJsonHaveNoTrackOfAPoint) {
  const RailMap map = ReadMap(Write("map.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"railway": "rail"},
     "geometry": {"type": "LineString", "coordinates": [[15.6, 48.2], [15.61, 48.2]]}},
    {"type": "Feature", "properties": {"railway": "rail"},
     "geometry": {"type": "Point", "coordinates": [15.6, 48.2]}}]})"));
  EXPECT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{{RemarkKind::kLinesLeftOut, "/features/1", 1, "it has no line"}}));
}

TEST_F(Maps, AreReadFromGeoJsonThatSpeaksOfElements) {
  const RailMap map = ReadMap(Write("map.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"elements": "3"},
     "geometry": {"type": "LineString", "coordinates": [[15.6, 48.2], [15.61, 48.2]]}}]})"));
  EXPECT_THAT(map.ways, SizeIs(1));
}

TEST_F(Maps, AreReadFromGpxAndKmlWhereAllLinesAreTracks) {
  const RailMap gpx = ReadMap(Write("map.gpx", R"(<?xml version="1.0"?>
<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<trk><name>Ride</name><trkseg><trkpt lat="48.20" lon="15.60"/><trkpt lat="48.20" lon="15.61"/>
<trkpt lat="48.21" lon="15.62"/></trkseg></trk></gpx>)"));
  ASSERT_GE(gpx.ways.size(), 1U);
  EXPECT_THAT(gpx.ways[0].nodes, SizeIs(3));
  EXPECT_EQ(TagOf(gpx.ways[0].tags, "name"), "Ride");

  const RailMap kml = ReadMap(Write("map.kml", R"(<?xml version="1.0"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>Branch</name>
<LineString><coordinates>15.60,48.20 15.61,48.20 15.62,48.21</coordinates></LineString>
</Placemark></Document></kml>)"));
  ASSERT_THAT(kml.ways, SizeIs(1));
  EXPECT_THAT(kml.ways[0].nodes, SizeIs(3));
  EXPECT_EQ(TagOf(kml.ways[0].tags, "name"), "Branch");
}

TEST_F(Maps, AreRefusedInOneLineEachWhereTheyAreWrong) {
  EXPECT_EQ(Fault("map.json", R"({"elements": 3})"),
            "map.json: /elements: must be a list, as the Overpass API returns it (got number)");
  EXPECT_EQ(OverpassFault(""),
            "map.json: must have a way with railway=rail or another kind of track (got 0 other "
            "ways)");
  EXPECT_EQ(OverpassFault(R"({"type": "node", "id": 1, "lon": 15.6, "lat": 98.2})"),
            "map.json: /elements/0/lat: must be a number of degrees from -90 to 90 (got 98.2)");
  EXPECT_EQ(OverpassFault(R"({"type": "node", "id": 1, "lon": "15.6", "lat": 48.2})"),
            "map.json: /elements/0/lon: must be a number of degrees from -180 to 180 (got string)");
  EXPECT_EQ(OverpassFault(R"({"type": "node", "lon": 15.6, "lat": 48.2})"),
            "map.json: /elements/0/id: must be a whole number (got none)");
  EXPECT_EQ(
      OverpassFault(R"({"type": "way", "id": 7, "nodes": [1, 2], "tags": {"railway": "rail"}})"),
      "map.json: must have the nodes of its tracks (ask Overpass for the nodes, too: >; out;) (got "
      "no two neighbours of any track)");
  EXPECT_EQ(OverpassFault(R"({"type": "way", "id": 7, "tags": {"railway": "rail"}})"),
            "map.json: /elements/0/nodes: must be a list of node ids (got none)");
  EXPECT_EQ(OverpassFault(std::string(kNodes) +
                          R"({"type": "way", "id": 7, "nodes": [1], "tags": {"railway": "rail"}})"),
            "map.json: /elements/3: must have two different nodes or more (got 1)");
  EXPECT_THAT(Fault("map.json", R"({"elements": [)"), HasSubstr("map.json: must be JSON: "));
  EXPECT_THAT(
      Fault("map.txt", "hello"),
      HasSubstr(
          "map.txt: must be a map: Overpass JSON, .osm, .pbf, GeoJSON, GPX, KML or railML 3"));
  EXPECT_THAT(Fault("map.kml", R"(<?xml version="1.0"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>Field</name><Polygon>
<outerBoundaryIs><LinearRing><coordinates>15.60,48.20 15.61,48.20 15.62,48.21 15.60,48.20
</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>)"),
              HasSubstr("must be a line, since it is to be a track (got a polygon)"));
  EXPECT_THAT(Fault("map.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {}, "geometry": {"type": "LineString",
     "coordinates": [[612345.0, 5345678.0], [612445.0, 5345678.0]]}}]})"),
              HasSubstr("must have longitudes and latitudes in degrees (got 612345, 5345678)"));
}

TEST_F(Maps, AreRefusedIfTheyAreCutOff) {
  const std::string message = Fault("map.gpx", R"(<?xml version="1.0"?>
<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<trk><name>Ride</name><trkseg><trkpt lat="48.20" lon="15.60"/><trkpt lat="48.20" lon="15.61"/>
</trkseg></trk><trk><name>Cut)");
  EXPECT_EQ(message, "map.gpx: line 4: must be XML to its end (got no element found)");
}

constexpr const char* kOsmNodes = R"(<?xml version="1.0"?><osm version="0.6">
  <node id="1" lat="48.20" lon="15.60"/><node id="2" lat="48.20" lon="15.61"/>
)";

TEST_F(Maps, OfOpenStreetMapHaveNoLinesOfRelations) {
  const RailMap map = ReadMap(Write("map.osm", std::string(kOsmNodes) + R"(
  <way id="7"><nd ref="1"/><nd ref="2"/><tag k="railway" v="rail"/></way>
  <relation id="9"><member type="way" ref="7" role=""/><tag k="type" v="route"/>
    <tag k="route" v="railway"/><tag k="railway" v="rail"/></relation></osm>)"));
  EXPECT_THAT(map.ways, SizeIs(1));
}

TEST_F(Maps, OfOpenStreetMapMustHaveRailways) {
  EXPECT_EQ(
      Fault("map.osm", std::string(kOsmNodes) + R"(
  <way id="7"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/></way></osm>)"),
      "map.osm: must have a way with railway=rail or another kind of track (got 1 other ways)");
}

TEST_F(Maps, AreRefusedInOtherFormatsThatGdalKnows) {
  EXPECT_THAT(
      Fault("map.csv", "id,WKT\n1,\"LINESTRING (15.6 48.2,15.61 48.2)\"\n"),
      HasSubstr(
          "map.csv: must be a map: Overpass JSON, .osm, .pbf, GeoJSON, GPX, KML or railML 3"));
}

TEST_F(Maps, MustHaveTwoDifferentPointsInEachTrack) {
  EXPECT_THAT(Fault("map.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {}, "geometry": {"type": "LineString",
     "coordinates": [[15.6, 48.2], [15.6, 48.2]]}}]})"),
              HasSubstr("must have two different points or more (got 1)"));
}

TEST_F(Maps, TakeAWayThatAnAnswerRepeatsOnce) {
  const std::string way =
      R"({"type": "way", "id": 7, "nodes": [1, 2], "tags": {"railway": "rail"}})";
  const RailMap map = ReadMap(
      Write("map.json", R"({"elements": [)" + std::string(kNodes) + way + "," + way + "]}"));
  EXPECT_THAT(map.ways, SizeIs(1));
}

TEST_F(Maps, NameIdsThatAreTooLarge) {
  EXPECT_EQ(OverpassFault(R"({"type": "node", "id": 9223372036854775808, "lon": 15, "lat": 48})"),
            "map.json: /elements/0/id: must be a whole number of 64 bits (got "
            "9223372036854775808)");
  EXPECT_EQ(OverpassFault(std::string(kNodes) + R"({"type": "way", "id": 7,
    "nodes": [1, 18446744073709551615], "tags": {"railway": "rail"}})"),
            "map.json: /elements/3/nodes/1: must be a node id of 64 bits (got "
            "18446744073709551615)");
}

RailMap TwoNodes(const Eigen::Vector2d& a_deg, const Eigen::Vector2d& b_deg) {
  RailMap map;
  map.nodes.push_back({.geographic_deg = a_deg, .tags = {}});
  map.nodes.push_back({.geographic_deg = b_deg, .tags = {}});
  map.ways.push_back({1, {0, 1}, {}});
  return map;
}

/// Length of the meridian from 48.20 to 48.21 degrees on WGS 84, by its radius of curvature
/// a (1 - e^2) / (1 - e^2 sin^2)^1.5 in the middle.
double HundredthOfADegree_m() {
  constexpr double kSquaredEccentricity = 6.69437999e-3;
  const double sine = std::sin(48.205 * M_PI / 180.0);
  return 0.01 * M_PI / 180.0 * 6378137.0 * (1.0 - kSquaredEccentricity) /
         std::pow(1.0 - kSquaredEccentricity * sine * sine, 1.5);
}

TEST(MapProjection, KeepsLengths) {
  RailMap map = TwoNodes({15.6, 48.20}, {15.6, 48.21});
  const MapProjection projection = ProjectMap("", map);
  EXPECT_NEAR((map.nodes[1].place_m - map.nodes[0].place_m).norm(), HundredthOfADegree_m(), 1e-3);
  EXPECT_THAT(projection.definition, HasSubstr("+proj=tmerc"));
  EXPECT_EQ(projection.origin_m, Eigen::Vector2d::Zero());
}

TEST(MapProjection, SubtractsWholeMetresFromAGivenSystem) {
  RailMap map = TwoNodes({15.6, 48.20}, {15.6, 48.21});
  const MapProjection projection = ProjectMap("EPSG:32633", map);
  EXPECT_GT(projection.origin_m.y(), 5e6);
  EXPECT_EQ(projection.origin_m, Eigen::Vector2d(projection.origin_m.array().round()));
  EXPECT_LT(map.nodes[0].place_m.norm(), 1500.0);
  // UTM shrinks by 0.9996 on its meridian, which is 15 degrees.
  EXPECT_NEAR((map.nodes[1].place_m - map.nodes[0].place_m).norm(), 0.9996 * HundredthOfADegree_m(),
              0.05);
}

TEST(MapProjection, DoesNotBlameASystemThatWasNotGiven) {
  RailMap map = TwoNodes({-90.0, 0.0}, {90.0, 0.0});
  try {
    static_cast<void>(ProjectMap("", map));
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "the map must lie about its middle at 0, 0 degrees (got also -90, 0 degrees)");
  }
}

TEST(MapProjection, RefusesSystemsThatAreNotInMetres) {
  const auto fault = [](const std::string& definition) -> std::string {
    RailMap map = TwoNodes({15.6, 48.20}, {15.6, 48.21});
    return MessageOf([&] { static_cast<void>(ProjectMap(definition, map)); });
  };
  EXPECT_EQ(fault("EPSG:99999"),
            "--crs: must be a coordinate system that PROJ knows, such as EPSG:31256 (got "
            "EPSG:99999)");
  EXPECT_EQ(fault("EPSG:4326"),
            "--crs: must be a projected system, with axes in metres (got EPSG:4326)");
  EXPECT_EQ(fault("EPSG:2263"), "--crs: must have axes in metres (got EPSG:2263)");
  EXPECT_EQ(fault("EPSG:4978"),
            "--crs: must be a projected system, with axes in metres (got EPSG:4978)");
  EXPECT_EQ(fault("EPSG:3857"),
            "--crs: must have a scale from 0.99 to 1.01 in the middle of the map (got EPSG:3857 "
            "with 1.502)");
}

TEST_F(Maps, OfFormatsThatAreNotReadAreNamed) {
  EXPECT_EQ(Fault("a.kmz", "PK\3\4"),
            "a.kmz: is packed KML, which is not read: unzip a.kmz doc.kml");
  EXPECT_EQ(Fault("a.shp", "x"),
            "a.shp: is a shapefile, which is not read: ogr2ogr a.geojson a.shp");
}

}  // namespace
}  // namespace railcast
