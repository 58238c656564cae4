// Words in maps that change what the rest of them means, in every format alike.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "generator/extras/import/lines/line_places.h"
#include "tests/generator/extras/import/written_maps.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class MapWords : public ::testing::Test, public WrittenMaps {};

/// Nodes 1 to 5, each 0.01 degrees east of the one before.
std::string NodesInXml(const std::string& more_of_third = "") {
  std::string text;
  for (int i = 1; i <= 5; ++i) {
    text += "<node id='" + std::to_string(i) + "' lat='48.2' lon='15.6" + std::to_string(i) + "'" +
            (i == 3 ? more_of_third : "") + "/>";
  }
  return text;
}
std::string NodesInJson(const std::string& more_of_third = "") {
  std::string text;
  for (int i = 1; i <= 5; ++i) {
    text += R"({"type": "node", "id": )" + std::to_string(i) + R"(, "lat": 48.2, "lon": 15.6)" +
            std::to_string(i) + (i == 3 ? more_of_third : "") + "},";
  }
  return text;
}
std::string WayInXml(const std::vector<int>& nodes, const std::string& more = "", int id = 7) {
  std::string text = "<way id='" + std::to_string(id) + "'" + more + ">";
  for (const int node : nodes) text += "<nd ref='" + std::to_string(node) + "'/>";
  return text + "<tag k='railway' v='rail'/></way>";
}
std::string WayInJson(const std::vector<int>& nodes, const std::string& more = "", int id = 7) {
  std::string text;
  for (const int node : nodes) text += (text.empty() ? "" : ", ") + std::to_string(node);
  return R"({"type": "way", "id": )" + std::to_string(id) + R"(, "nodes": [)" + text +
         R"(], "tags": {"railway": "rail"})" + more + "}";
}
std::string Xml(const std::string& elements) {
  return "<?xml version='1.0'?><osm version='0.6'>" + elements + "</osm>";
}
std::string JsonMap(const std::string& elements, const std::string& more = "") {
  return R"({"version": 0.6, "elements": [)" + elements + "]" + more + "}";
}

/// How many nodes each way has.
std::vector<std::size_t> Sizes(const RailMap& map) {
  std::vector<std::size_t> sizes;
  for (const MapWay& way : map.ways) sizes.push_back(way.nodes.size());
  return sizes;
}

TEST_F(MapWords, LeaveOutDeletedWays) {
  for (const RailMap& map :
       {Read("a.osm",
             Xml(NodesInXml() + WayInXml({1, 2, 3}) + WayInXml({3, 4, 5}, " action='delete'", 8))),
        Read("b.osm",
             Xml(NodesInXml() + WayInXml({1, 2, 3}) + WayInXml({3, 4, 5}, " visible='false'", 8))),
        Read("c.json", JsonMap(NodesInJson() + WayInJson({1, 2, 3}) + "," +
                               WayInJson({3, 4, 5}, R"(, "visible": false)", 8)))}) {
    EXPECT_EQ(Sizes(map), std::vector<std::size_t>{3});
    EXPECT_EQ(map.remarks, (std::vector<Remark>{{RemarkKind::kDeletedLeftOut, "way 8"}}));
  }
}

TEST_F(MapWords, NameTracksThatAreNotRead) {
  const auto of_kind = [](std::string text, const std::string& kind) {
    const std::size_t at = text.rfind("rail");
    return text.replace(at, 4, kind);
  };
  const std::string way = WayInXml({3, 4, 5}, "", 8);
  const std::string way_json = WayInJson({3, 4, 5}, "", 8);
  for (const std::string kind : {"construction", "Rail", "disused;razed"}) {
    for (const RailMap& map :
         {Read("a.osm", Xml(NodesInXml() + WayInXml({1, 2, 3}) + of_kind(way, kind))),
          Read("b.json",
               JsonMap(NodesInJson() + WayInJson({1, 2, 3}) + "," + of_kind(way_json, kind)))}) {
      EXPECT_EQ(Sizes(map), std::vector<std::size_t>{3});
      EXPECT_EQ(map.remarks,
                (std::vector<Remark>{{RemarkKind::kLinesLeftOut, "way 8", 1, "railway=" + kind}}));
    }
  }
  const RailMap gone =
      Read("c.osm", Xml(NodesInXml() + WayInXml({1, 2, 3}) + of_kind(way, "abandoned")));
  EXPECT_THAT(gone.remarks, testing::IsEmpty());
}

TEST_F(MapWords, OfGeoJsonNameFeaturesWithoutATrack) {
  const auto feature = [](const std::string& railway, const std::string& geometry) {
    return R"({"type": "Feature", "properties": {"railway": ")" + railway + R"("}, "geometry": )" +
           geometry + "}";
  };
  const std::string line =
      R"({"type": "LineString", "coordinates": [[15.61, 48.2], [15.62, 48.2]]})";
  const RailMap map =
      Read("a.geojson", R"({"type": "FeatureCollection", "features": [)" + feature("rail", line) +
                            "," + feature("rail", "null") + "," + feature("disused", line) + "]}");
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{
                {RemarkKind::kLinesLeftOut, "/features/1", 1, "it has no line"},
                {RemarkKind::kLinesLeftOut, "/features/2/geometry", 1, "railway=disused"}}));
}

TEST_F(MapWords, LeadWaysPastDeletedNodes) {
  for (const RailMap& map :
       {Read("a.osm", Xml(NodesInXml(" action='delete'") + WayInXml({1, 2, 3, 4}))),
        Read("b.json",
             JsonMap(NodesInJson(R"(, "action": "delete")") + WayInJson({1, 2, 3, 4})))}) {
    EXPECT_EQ(Sizes(map), std::vector<std::size_t>{3});
    EXPECT_EQ(map.remarks, (std::vector<Remark>{{RemarkKind::kDeletedLeftOut, "node 3"}}));
  }
  const RailMap ended = Read("c.osm", Xml(NodesInXml(" action='delete'") + WayInXml({1, 2, 3})));
  EXPECT_EQ(Sizes(ended), std::vector<std::size_t>{2});
}

TEST_F(MapWords, AboutLifeThatNobodyWritesAreRefused) {
  EXPECT_EQ(Fault("a.osm", Xml(NodesInXml() + WayInXml({1, 2}, " action='hide'"))),
            "a.osm: line 1, way 7/action: must be create, modify or delete (got \"hide\")");
  EXPECT_EQ(Fault("b.json", JsonMap(NodesInJson() + WayInJson({1, 2}, R"(, "visible": "no")"))),
            "b.json: /elements/5/visible: must be true or false (got \"no\")");
}

TEST_F(MapWords, OfNodesThatNoTrackHasMakeNone) {
  for (const RailMap& map : {Read("a.osm", Xml(NodesInXml() + WayInXml({2, 1}))),
                             Read("b.json", JsonMap(NodesInJson() + WayInJson({2, 1})))}) {
    ASSERT_THAT(map.nodes, SizeIs(2));
    EXPECT_EQ(map.nodes[0].geographic_deg.x(), 15.62);
  }
}

TEST_F(MapWords, OfHistoriesAndChangesAreRefused) {
  const std::string rule = "must be the same wherever it is: histories are not read (got ";
  const std::string life = rule + "deleted, and not deleted)";
  const std::string xml = NodesInXml() + WayInXml({1, 2}, " version='1'");
  const std::string gone = "<way id='7' version='2' visible='false'/>";
  EXPECT_EQ(Fault("a.osm", Xml(xml + gone)), "a.osm: line 1, way 7: " + life);
  EXPECT_EQ(Fault("b.osm", Xml(gone + xml)), "b.osm: line 1, way 7: " + life);
  EXPECT_EQ(Fault("c.osm", Xml(xml + "<node id='1' visible='false'/>")),
            "c.osm: line 1, node 1: " + life);
  EXPECT_EQ(Fault("d.json", JsonMap(NodesInJson() + WayInJson({1, 2}) +
                                    R"(, {"type": "way", "id": 7, "visible": false})")),
            "d.json: /elements/6: " + life);
  EXPECT_EQ(Fault("e.osm", Xml(xml + "<way id='7'><tag k='railway' v='abandoned'/></way>")),
            "e.osm: line 1, way 7: " + rule + "other tags than before)");
  EXPECT_EQ(Fault("f.osm", Xml("<action type='delete'><old>" + xml + "</old></action>")),
            "f.osm: line 1: must be a map, and no changes from one to another (got <action>)");
  // Answers may repeat elements, and leave out their tags.
  EXPECT_THAT(Read("g.osm", Xml(xml + WayInXml({1, 2}) + "<way id='7'/>")).ways, SizeIs(1));
}

TEST_F(MapWords, AreToldOfPlatformsAndSignalsThatAreLeftOut) {
  const std::string platform = "<tag k='railway' v='platform'/>";
  EXPECT_EQ(Read("a.osm",
                 Xml(NodesInXml() + WayInXml({1, 2}) + "<way id='8'><nd ref='1'/><nd ref='98'/>" +
                     platform + "</way><relation id='9'>" + platform + "</relation>"))
                .remarks,
            (std::vector<Remark>{
                {RemarkKind::kOutlinesLeftOut, "relation 9", 1, "it has several parts"},
                {RemarkKind::kOutlinesLeftOut, "way 8", 1, "1 of its nodes are missing"}}));
  const std::string signal = "<node id='6' visible='false'><tag k='railway' v='signal'/></node>";
  EXPECT_EQ(Read("b.osm", Xml(NodesInXml() + signal + WayInXml({1, 2, 6}))).remarks,
            (std::vector<Remark>{{RemarkKind::kDeletedLeftOut, "node 6"}}));
}

TEST_F(MapWords, CutWaysWhereNodesAreMissing) {
  const std::string geometry = R"(, "geometry": [{"lat": 48.2, "lon": 15.61},
    {"lat": 48.2, "lon": 15.62}, null, null, {"lat": 48.2, "lon": 15.64},
    {"lat": 48.2, "lon": 15.65}])";
  for (const RailMap& map :
       {Read("a.osm", Xml(NodesInXml() + WayInXml({1, 2, 98, 99, 4, 5}))),
        Read("b.json", JsonMap(NodesInJson() + WayInJson({1, 2, 98, 99, 4, 5}))),
        Read("c.json", JsonMap(WayInJson({1, 2, 98, 99, 4, 5}, geometry)))}) {
    EXPECT_EQ(Sizes(map), (std::vector<std::size_t>{2, 2}));
    EXPECT_EQ(map.remarks, (std::vector<Remark>{{RemarkKind::kNodesMissing, "way 7", 2}}));
  }
}

TEST_F(MapWords, OfOverpassThatTheAnswerIsNotWholeAreQuoted) {
  const std::string remark = "runtime error: Query timed out in \"query\" at line 3";
  const std::string rule =
      "remark: the answer is not whole; ask again with a smaller area or a "
      "longer timeout (got \"runtime error: Query timed out in \"query\" at line 3\")";
  const std::string json = R"(, "remark": "runtime error: Query timed out in \"query\" at line 3")";
  EXPECT_EQ(Fault("a.json", JsonMap(NodesInJson() + WayInJson({1, 2}), json)), "a.json: /" + rule);
  EXPECT_EQ(Fault("b.json", JsonMap("", json)), "b.json: /" + rule);
  EXPECT_EQ(
      Fault("c.osm", Xml(NodesInXml() + WayInXml({1, 2}) + "<remark> " + remark + " </remark>")),
      "c.osm: line 1, " + rule);
  EXPECT_EQ(Fault("d.osm", Xml("<remark>" + remark + "</remark>")), "d.osm: line 1, " + rule);
}

TEST_F(MapWords, OfNodesInOnePlaceMeanOneNode) {
  const std::string ninth_xml = "<node id='9' lat='48.2' lon='15.63'/>";
  const std::string ninth_json = R"({"type": "node", "id": 9, "lat": 48.2, "lon": 15.63},)";
  for (const RailMap& map :
       {Read("a.osm",
             Xml(NodesInXml() + ninth_xml + WayInXml({1, 2, 3}) + WayInXml({9, 4, 5}, "", 8))),
        Read("b.json", JsonMap(NodesInJson() + ninth_json + WayInJson({1, 2, 3}) + "," +
                               WayInJson({9, 4, 5}, "", 8)))}) {
    ASSERT_THAT(map.ways, SizeIs(2));
    EXPECT_EQ(map.ways[0].nodes.back(), map.ways[1].nodes.front());
    EXPECT_EQ(
        map.remarks,
        (std::vector<Remark>{{RemarkKind::kPlacesJoined, "node 9", 1, "it is where node 3 is"}}));
  }
}

TEST_F(MapWords, OfPlacesMayStandInTheWaysOfXml) {
  const RailMap map = Read("a.osm", Xml(R"(<way id='7'><nd ref='1' lat='48.2' lon='15.6'/>
    <nd ref='2' lat='48.2' lon='15.61'/><tag k='railway' v='rail'/></way>
    <way id='8'><nd lat='48.2' lon='15.61'/><nd lat='48.2' lon='15.62'/>
    <tag k='railway' v='rail'/></way>)"));
  EXPECT_EQ(Sizes(map), (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(map.ways[0].nodes.back(), map.ways[1].nodes.front());
}

TEST_F(MapWords, OfOtherXmlAreNamed) {
  EXPECT_EQ(Fault("a.osc", "<osmChange version='0.6'><delete/></osmChange>"),
            "a.osc: must be a map: of OpenStreetMap (<osm>), GPX, KML or railML 3 (got "
            "<osmChange>)");
  EXPECT_EQ(Fault("b.xml", "<railml xmlns='http://www.railml.org/schemas/2016'/>"),
            "b.xml: must be railML 3, which has coordinates of its net (got railML 2)");
}

std::string Feature(const std::string& properties, double latitude_deg = 48.2) {
  return R"({"type": "Feature", "properties": )" + properties +
         R"(, "geometry": {"type": "LineString", "coordinates": [[15.6, )" +
         std::to_string(latitude_deg) + "], [15.61, " + std::to_string(latitude_deg) + "]]}}";
}
std::string Features(const std::string& features) {
  return R"({"type": "FeatureCollection", "features": [)" + features + "]}";
}

TEST_F(MapWords, ThatAreNestedDeepAreRefused) {
  constexpr std::size_t kMany = 300000;
  std::string tags;
  for (std::size_t i = 0; i < kMany; ++i) tags += R"({"tags":)";
  const std::string lists = std::string(kMany, '[') + std::string(kMany, ']');
  const std::string objects = tags + "1" + std::string(kMany, '}');
  for (const std::string& text :
       {R"({"type": "FeatureCollection", "crs": )" + lists + "}", Features(Feature(objects)),
        R"({"elements": [{"type": "node", "id": 1, "visible": )" + lists + "}]}"}) {
    EXPECT_THAT(Fault("a.json", text),
                HasSubstr("a.json: must be JSON: nested deeper than 64 levels"));
  }
  // No levels are those in texts.
  EXPECT_THAT(
      Read("b.json", Features(Feature(R"({"name": "\")" + std::string(99, '[') + "\"}"))).ways,
      SizeIs(1));
}

TEST_F(MapWords, OfOsmtogeojsonStandInTags) {
  const RailMap map = Read(
      "a.geojson",
      Features(Feature(R"({"type": "way", "id": 7, "tags": {"railway": "rail", "ref": "101"}})") +
               "," + Feature(R"({"type": "way", "id": 8, "tags": {"highway": "primary"}})", 48.3)));
  ASSERT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(TagOf(map.ways[0].tags, "ref"), "101");
  EXPECT_THAT(map.attribution, HasSubstr("OpenStreetMap"));
}

TEST_F(MapWords, OfRoadsAndRiversMeanNoTracks) {
  const std::string road = Feature(R"({"highway": "primary"})");
  const RailMap map = Read("a.geojson", Features(Feature(R"({"name": "x"})", 48.3) + "," + road));
  EXPECT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(map.remarks, (std::vector<Remark>{{RemarkKind::kLinesLeftOut, "/features/1/geometry", 1,
                                               "highway=primary"}}));
  EXPECT_EQ(Fault("b.geojson", Features(road + "," + Feature(R"({"waterway": "river"})"))),
            "b.geojson: must have a line that is a track (got 2 other lines)");
  const RailMap classes = Read("c.geojson", Features(Feature(R"({"fclass": "rail"})", 48.3) + "," +
                                                     Feature(R"({"fclass": "primary"})")));
  EXPECT_THAT(classes.ways, SizeIs(1));
  EXPECT_EQ(Fault("d.geojson", Features("")),
            "d.geojson: must have a line that is a track (got no lines)");
}

TEST_F(MapWords, OfLinesWithoutRailwayBesideOthersAreTold) {
  const RailMap map = Read("a.geojson", Features(Feature(R"({"railway": "rail"})") + "," +
                                                 Feature(R"({"railway": "abandoned"})", 48.3) +
                                                 "," + Feature(R"({"name": "x"})", 48.4)));
  EXPECT_THAT(map.ways, SizeIs(1));
  EXPECT_EQ(map.remarks, (std::vector<Remark>{{RemarkKind::kLinesLeftOut, "/features/2/geometry", 1,
                                               "it has no railway"}}));
}

TEST_F(MapWords, OfGeofabrikSayWhichKindTracksAreAndWhatIsNotThere) {
  const RailMap map =
      Read("a.geojson", Features(Feature(R"({"fclass": "tram", "bridge": "F", "tunnel": "F"})") +
                                 "," + Feature(R"({"railway": "rail", "tunnel": false})", 48.3)));
  ASSERT_THAT(map.ways, SizeIs(2));
  EXPECT_EQ(TagOf(map.ways[0].tags, "railway"), "tram");
  for (const std::string_view value :
       {TagOf(map.ways[0].tags, "bridge"), TagOf(map.ways[1].tags, "tunnel"), std::string_view("0"),
        std::string_view("no"), std::string_view()}) {
    EXPECT_FALSE(IsThere(value)) << value;
  }
  for (const char* value : {"yes", "T", "viaduct", "1"}) EXPECT_TRUE(IsThere(value)) << value;
}

TEST_F(MapWords, OfCoordinateSystemsOtherThanWgs84AreRefused) {
  const auto with = [](const std::string& system) {
    return R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": ")" +
           system + R"("}}, "features": [)" + Feature("{}") + "]}";
  };
  EXPECT_THAT(Read("a.geojson", with("urn:ogc:def:crs:OGC:1.3:CRS84")).ways, SizeIs(1));
  EXPECT_THAT(Fault("b.geojson", with("urn:ogc:def:crs:EPSG::25833")),
              HasSubstr("b.geojson: /crs: must be WGS 84"));
  for (const char* const code : {"http://www.opengis.net/def/crs/EPSG/0/4326", "EPSG:4258"}) {
    const auto remark = RemarkOf(Read("c.geojson", with(code)), RemarkKind::kTagsUnread);
    ASSERT_TRUE(remark) << code;
    EXPECT_EQ(remark->place, "/crs");
    EXPECT_THAT(remark->detail,
                HasSubstr("the order of axes; longitude is taken to be first (got {"));
  }
}

std::string Kml(const std::string& mode, const std::string& coordinates) {
  return "<?xml version='1.0'?><kml xmlns='http://www.opengis.net/kml/2.2'><Placemark><name>T"
         "</name><LineString>" +
         (mode.empty() ? "" : "<altitudeMode>" + mode + "</altitudeMode>") + "<coordinates>" +
         coordinates + "</coordinates></LineString></Placemark></kml>";
}

TEST_F(MapWords, OfAltitudesThatAreAbsoluteAreObeyedAndOthersTold) {
  const std::string places = "15.60,48.20,250 15.61,48.20,251";
  const RailMap absolute = Read("a.kml", Kml("absolute", places));
  EXPECT_TRUE(absolute.nodes[1].height_m == 251.0 && absolute.remarks.empty());
  const std::string offset = "</altitudeMode><altitudeOffset>8</altitudeOffset><altitudeMode>";
  EXPECT_EQ(Read("a.kml", Kml(offset + "absolute", places)).nodes[1].height_m, 259.0);
  for (const std::string mode : {"relativeToGround", "clampToGround", ""}) {
    const RailMap map = Read("b.kml", Kml(mode, places));
    EXPECT_EQ(map.nodes[1].height_m, std::nullopt);
    ASSERT_TRUE(RemarkOf(map, RemarkKind::kHeightsUnused)) << mode;
    EXPECT_THAT(RemarkOf(map, RemarkKind::kHeightsUnused)->detail, HasSubstr(mode));
  }
  EXPECT_TRUE(Read("c.kml", Kml("", "15.60,48.20,0 15.61,48.20,0")).remarks.empty());
}

TEST_F(MapWords, OfTracksInKmlHaveTheirHeights) {
  const RailMap map = Read("a.kml", R"(<kml xmlns:gx="http://www.google.com/kml/ext/2.2"><Placemark>
    <gx:Track><altitudeMode>absolute</altitudeMode><when>2026-01-01T00:00:00Z</when>
    <gx:coord>15.6 48.2 250</gx:coord><gx:coord>15.61 48.2 251</gx:coord></gx:Track>
    </Placemark></kml>)");
  ASSERT_THAT(map.nodes, SizeIs(2));
  EXPECT_EQ(map.nodes[1].height_m, 251.0);
}

TEST_F(MapWords, OfTracksInKmlMayLackPlaces) {
  const auto track = [](const std::string& coord) {
    return R"(<kml xmlns:gx="http://www.google.com/kml/ext/2.2"><gx:Track>
<gx:coord>15.6 48.2 250</gx:coord>)" +
           coord + "<gx:coord>15.61  48.2\n251</gx:coord></gx:Track></kml>";
  };
  const RailMap map = Read("a.kml", track("<gx:coord/>"));
  EXPECT_EQ(Sizes(map), std::vector<std::size_t>{2});
  EXPECT_EQ(RemarkOf(map, RemarkKind::kFieldsLeftOut),
            (Remark{RemarkKind::kFieldsLeftOut, "line 2", 1, "<coord> is empty"}));
  EXPECT_EQ(Fault("b.kml", track("<gx:coord>15.6</gx:coord>")),
            "b.kml: line 2, coord: must be longitude, latitude in degrees and, if known, height in "
            "m (got \"15.6\")");
}

TEST_F(MapWords, OfLinksInKmlAreTold) {
  const RailMap map =
      Read("b.kml",
           "<kml><NetworkLink><Link><href>c.kml</href></Link></NetworkLink><LineString>"
           "<coordinates>15.6,48.2 15.61,48.2</coordinates></LineString></kml>");
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{{RemarkKind::kFilesLeftOut, "NetworkLink", 1, "\"c.kml\""}}));
  EXPECT_EQ(Fault("a.kml", "<kml><NetworkLink><Link><href>b.kml</href></Link></NetworkLink></kml>"),
            "a.kml: must hold its lines itself (got links to other files, the first \"b.kml\")");
}

TEST_F(MapWords, OfDataInKmlAreTags) {
  const RailMap map = Read("a.kml", R"(<kml><Placemark><ExtendedData>
    <Data name="railway"><value>rail</value></Data>
    <SchemaData><SimpleData name="maxspeed">80</SimpleData></SchemaData></ExtendedData>
    <LineString><coordinates>15.6,48.2 15.61,48.2</coordinates></LineString></Placemark></kml>)");
  EXPECT_EQ(TagOf(map.ways.at(0).tags, "railway"), "rail");
  EXPECT_EQ(TagOf(map.ways.at(0).tags, "maxspeed"), "80");
}

/// A track of GPX with these heights; NaN: none.
std::string Gpx(const std::vector<double>& heights_m) {
  std::string points;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    points += "<trkpt lat='48.2' lon='15.6" + std::to_string(i) + "'>" +
              (std::isnan(heights_m[i]) ? "" : "<ele>" + std::to_string(heights_m[i]) + "</ele>") +
              "</trkpt>";
  }
  return "<gpx><trk><name>ride</name><trkseg>" + points + "</trkseg></trk></gpx>";
}

TEST_F(MapWords, OfHeightsAreReadInEveryFormat) {
  const std::string xml_height =
      "<node id='8' lat='48.2' lon='15.68'><tag k='ele' v='250'/></node>";
  const std::string json_height =
      R"({"type": "node", "id": 8, "lat": 48.2, "lon": 15.68, "tags": {"ele": "250"}},)";
  for (const RailMap& map :
       {Read("a.gpx", Gpx({250.0, 251.0})),
        Read("b.kml", Kml("absolute", "15.60,48.20,250 15.61,48.20,251")),
        Read("c.geojson", R"({"type": "LineString",
          "coordinates": [[15.6, 48.2, 250], [15.61, 48.2, 251]]})"),
        Read("d.osm", Xml(NodesInXml() + xml_height + WayInXml({8, 1}))),
        Read("e.json", JsonMap(json_height + NodesInJson() + WayInJson({8, 1})))}) {
    EXPECT_EQ(map.nodes[map.ways[0].nodes[0]].height_m, 250.0);
  }
}

TEST_F(MapWords, OfFixesWhileStandingMeanOnePlaceWhereLinesAreNotMapped) {
  const std::string stop = "[15.61, 48.2], [15.61002, 48.2], [15.60999, 48.2], [15.61001, 48.2], ";
  const auto map_with = [&](const std::string& properties) {
    return Read("a.geojson", Features(R"({"type": "Feature", "properties": )" + properties +
                                      R"(, "geometry": {"type": "LineString", "coordinates": [
      [15.6, 48.2], )" + stop + "[15.62, 48.2]]}}"));
  };
  const RailMap ride = map_with("{}");
  EXPECT_EQ(Sizes(ride), std::vector<std::size_t>{3});
  EXPECT_EQ(RemarkOf(ride, RemarkKind::kFixesThinned)->number, 3U);
  EXPECT_EQ(Sizes(map_with(R"({"railway": "rail"})")), std::vector<std::size_t>{6});
}

TEST_F(MapWords, OfMissingHeightsLeaveThemToTheOthers) {
  const std::string empty =
      "<ele>250</ele></trkpt><trkpt lat='48.2' lon='15.61'><ele></ele>"
      "</trkpt><trkpt lat='48.2' lon='15.62'><ele>252</ele></trkpt>";
  for (const RailMap& map :
       {Read("a.gpx", Gpx({250.0, NAN, 252.0})),
        Read("a.gpx",
             "<gpx><trk><trkseg><trkpt lat='48.2' lon='15.6'>" + empty + "</trkseg></trk></gpx>"),
        Read("b.kml", Kml("absolute", "15.60,48.20,250 15.61,48.20 15.62,48.20,252")),
        Read("c.geojson", R"({"type": "LineString",
          "coordinates": [[15.6, 48.2, 250], [15.61, 48.2], [15.62, 48.2, 252]]})")}) {
    EXPECT_EQ(map.nodes[0].height_m, 250.0);
    EXPECT_EQ(map.nodes[1].height_m, std::nullopt);
    EXPECT_EQ(RemarkOf(map, RemarkKind::kHeightsMissing)->number, 1U);
  }
}

TEST_F(MapWords, OfHeightsThatAreNoneAreTold) {
  const std::string node = "<node id='8' lat='48.2' lon='15.68'><tag k='ele' v='820 ft'/></node>";
  const RailMap map = Read("a.osm", Xml(NodesInXml() + node + WayInXml({8, 1})));
  EXPECT_EQ(map.remarks,
            (std::vector<Remark>{{RemarkKind::kTagsUnread, "node 8", 1, "ele=820 ft"}}));
}

std::string Utf16Of(const std::string& text, bool is_big) {
  std::string bytes = is_big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char letter : text) {
    bytes += is_big ? std::string(1, '\0') + letter : letter + std::string(1, '\0');
  }
  return bytes;
}

TEST_F(MapWords, AreReadInUtf16AndBehindAByteOrderMark) {
  const std::string declared = "<?xml version='1.0' encoding='UTF-8'?>";
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.json", JsonMap(NodesInJson() + WayInJson({1, 2}))},
           {"b.osm", Xml(NodesInXml() + WayInXml({1, 2}))},
           {"c.gpx", declared + Gpx({NAN, NAN})},
           {"d.kml", Kml("", "15.60,48.20 15.61,48.20")},
           {"e.geojson", Features(Feature("{}"))}}) {
    for (const std::string& bytes :
         {"\xEF\xBB\xBF" + text, Utf16Of(text, false), Utf16Of(text, true)}) {
      EXPECT_THAT(Read(name, bytes).ways, SizeIs(1)) << name;
    }
  }
}

TEST_F(MapWords, OfServersThatGaveOnlyTheFirstFeaturesAreRefused) {
  const auto fault = [&](const std::string& member) {
    return Fault("a.geojson", Features(Feature("{}")).insert(1, member + ", "));
  };
  const std::string rule =
      "a.geojson: must hold all features that there are, and not the first ones alone, or else not "
      "say so (got ";
  EXPECT_EQ(fault(R"("properties": {"exceededTransferLimit": true})"),
            rule + "exceededTransferLimit)");
  EXPECT_EQ(fault(R"("numberMatched": 5000)"), rule + "1 of numberMatched 5000)");
  EXPECT_EQ(fault(R"("links": [{"rel": "next"}])"), rule + "a link to the next ones)");
  EXPECT_EQ(fault(R"("exceededTransferLimit": false, "totalFeatures": 1, "numberMatched": "unknown",
                  "links": [{"rel": "self"}])"),
            "no error");
  EXPECT_EQ(fault(R"("numberMatched": 1, "links": [{"rel": "next"}])"), "no error");
}

}  // namespace
}  // namespace railcast
