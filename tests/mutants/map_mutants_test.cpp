#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "generator/extras/import/map/read_map.h"
#include "tests/generator/extras/import/made_pbf.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

Reading ReadMapWhole(const std::filesystem::path& file) {
  const RailMap map = ReadMap(file);
  Reading reading{.remarks = map.remarks};
  std::vector<double>& values = reading.values;
  const auto add_tags = [&](const MapTags& tags) {
    for (const auto& [key, value] : tags) {
      values.push_back(
          static_cast<double>(std::hash<std::string>{}(key + "=" + value) % 1'000'003));
    }
  };
  const auto add_place = [&](const Eigen::Vector2d& place_deg) {
    constexpr double kMetres = 1e5;  // Of a degree.
    values.insert(values.end(), {kMetres * place_deg.x(), kMetres * place_deg.y()});
  };
  for (const MapWay& way : map.ways) {
    values.push_back(static_cast<double>(way.nodes.size()));
    for (const std::size_t index : way.nodes) {
      const MapNode& node = map.nodes.at(index);
      values.push_back(static_cast<double>(index));
      add_place(node.geographic_deg);
      values.push_back(node.height_m.value_or(-9999.0));
      values.push_back(node.cant_mm.value_or(-9999.0));
      add_tags(node.tags);
    }
    add_tags(way.tags);
  }
  for (const MapThing& thing : map.things) {
    for (const Eigen::Vector2d& place_deg : thing.geographic_deg) add_place(place_deg);
    add_tags(thing.tags);
  }
  return reading;
}

// A key may have a list of values.
constexpr const char* kLists = "each value of a list holds";
constexpr const char* kNoHeights = "a map without heights is one";

std::string Utf16(const std::string& text, bool has_mark, bool is_big_endian) {
  std::string bytes;
  for (const char letter : (has_mark ? "\xFF" : "") + text) {
    const std::string pair = letter == '\xFF' ? "\xFF\xFE" : std::string{letter, '\0'};
    bytes += is_big_endian ? std::string(pair.rbegin(), pair.rend()) : pair;
  }
  return bytes;
}

/// What happens to any text.
void TryTexts(Mutants& mutants) {
  const std::string& good = mutants.good();
  for (const bool is_big : {false, true}) {
    mutants.Try("UTF-16", is_big ? "big" : "little", Utf16(good, true, is_big));
    mutants.Try("UTF-16 without a mark", is_big ? "big" : "little", Utf16(good, false, is_big));
  }
  mutants.Try("a byte order mark", "", "\xEF\xBB\xBF" + good);
  mutants.Try("empty", "", "");
  mutants.Try("an end that is doubled", "", good + good.substr(good.size() / 2));
  mutants.Try("a file behind another", "", good + good);
  for (std::size_t size = 1; size + 3 < good.size(); size += 5) {
    mutants.Try("cut off", NumberText(size), good.substr(0, size));
  }
}

/// Five nodes to the east, each 700 m from the one before.
constexpr std::array<const char*, 5> kLons = {"15.601", "15.611", "15.621", "15.631", "15.641"};
constexpr std::array<const char*, 5> kLats = {"48.201", "48.202", "48.203", "48.204", "48.205"};

std::string OsmXml() {
  std::string text = "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6'>\n";
  for (std::size_t i = 0; i < 5; ++i) {
    text += "<node id='" + NumberText(i + 1) + "' lat='" + kLats.at(i) + "' lon='" + kLons.at(i) +
            "'>\n<tag k='ele' v='250.5'/>\n</node>\n";
  }
  text += "<node id='6' lat='48.2025' lon='15.6125'><tag k='railway' v='signal'/></node>\n";
  text +=
      "<way id='7'>\n<nd ref='1'/>\n<nd ref='2'/>\n<nd ref='3'/>\n<tag k='railway' "
      "v='rail'/>\n<tag k='maxspeed' v='120'/>\n</way>\n";
  text +=
      "<way id='8'>\n<nd ref='3'/>\n<nd ref='4'/>\n<nd ref='5'/>\n<tag k='railway' "
      "v='rail'/>\n<tag k='tunnel' v='yes'/>\n</way>\n";
  return text +
         "<way id='9'>\n<nd ref='1'/>\n<nd ref='6'/>\n<tag k='railway' "
         "v='platform'/>\n</way>\n</osm>\n";
}

/// Changes that are the same in XML and JSON but for how a member is written.
/// @param member Writes a name and a value as the format has them.
std::vector<TextChange> ElementWords(
    const std::function<std::string(const std::string&, const std::string&)>& member) {
  std::vector<TextChange> words;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string lat = kLats.at(i);
    const std::string lon = kLons.at(i);
    for (const char* other : {"48,202", "", "N48.202", "91.5", "nan", "4.8e400", "48.202.1",
                              "48:12:07", "148.2", "0"}) {
      words.push_back({"a latitude that is none", member("lat", lat), member("lat", other)});
    }
    for (const char* other : {"15,602", "", "15.602E", "191.5", "inf", "0x15", "15 36 07"}) {
      words.push_back({"a longitude that is none", member("lon", lon), member("lon", other)});
    }
    words.push_back({"a member lost", member("lat", lat), ""});
    words.push_back({"a member lost", member("lon", lon), ""});
    words.push_back({"the name of a member changed", member("lat", lat), member("latitude", lat)});
    words.push_back({"a node in another place, which is near no other", member("lat", lat),
                     member("lat", "58.2")});
  }
  return words;
}

TEST(MapMutants, OfOsmXmlAreNeverReadWrongWithoutAWord) {
  Mutants mutants("OSM XML", "a.osm", OsmXml(), ReadMapWhole);
  TryTexts(mutants);
  TryChanges(mutants, ElementWords([](const std::string& name, const std::string& value) {
               return " " + name + "='" + value + "'";
             }));
  std::vector<TextChange> words = {
      {"an element marked as deleted", "' lat=", "' visible='false' lat="},
      {"an element marked as deleted", "' lat=", "' action='delete' lat="},
      {"an element marked in an unknown way", "' lat=", "' action='gone' lat="},
      {"an element marked as deleted", "<way id", "<way visible='false' id"},
      {"an element marked as deleted", "<way id", "<way action='delete' id"},
      {"a reference to no node", "<nd ref='", "<nd ref='99"},
      {"a reference that is none", "<nd ref='", "<nd ref='x"},
      {"a reference that is none", "<nd ref='", "<nd ref='-"},
      {"a reference lost", "<nd ref=", "<nd reference="},
      {"a reference doubled", "<nd ref='2'/>", "<nd ref='2'/><nd ref='2'/>"},
      {"an id that is none", " id='", " id='x"},
      {"an id lost", " id='", " ident='"},
      {"the name of an element changed", "<node ", "<Node "},
      {"the name of an element changed", "<nd ", "<Nd "},
      {"the name of an element changed", "<tag ", "<Tag "},
      {"another version", "version='0.6'", "version='0.5'"},
      {"another version", "version='0.6'", "version='0.7'"},
      {"another version", " version='0.6'", ""},
      {"changes in place of a map", "<osm ", "<osmChange "},
      {"a remark of a server", "<node id='1'",
       "<remark>runtime error: Query timed out</remark><node id='1'"},
      {"a height with its unit", "v='250.5'", "v='250.5 m'"},
      {"a height with its unit", "v='250.5'", "v='822 ft'"},
      {"a height with a comma", "v='250.5'", "v='250,5'"},
      {"a height that is none", "v='250.5'", "v='high'"},
      {"a height that cannot be", "v='250.5'", "v='25000'"},
      {"a track in other letters", "v='rail'", "v='Rail'"},
      {"a track with a blank", "v='rail'", "v='rail '"},
      {"a track of several values", "v='rail'", "v='rail;tram'"},
      {"the name of a key in other letters", "k='railway'", "k='Railway'"},
      {"an encoding that is not that of the file", "encoding='UTF-8'", "encoding='UTF-16'"},
      {"an encoding that nobody knows", "encoding='UTF-8'", "encoding='X-7'"}};
  for (const char* id : {"1", "2", "3", "7"})
    words.push_back({"an id twice", "id='5'", std::string("id='") + id + "'"});
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string node = "<node id='" + NumberText(i + 1) + "' lat='" + kLats.at(i) +
                             "' lon='" + kLons.at(i) + "'>\n<tag k='ele' v='250.5'/>\n</node>\n";
    words.push_back({"a node lost", node, ""});
    words.push_back({"a node doubled", node, node + node});
  }
  TryChanges(mutants, words);
  std::string exchanged = AllReplaced(mutants.good(), " lat=", " LAT=");
  exchanged = AllReplaced(AllReplaced(exchanged, " lon=", " lat="), " LAT=", " lon=");
  mutants.Try("latitudes and longitudes exchanged", "", exchanged);
  mutants.Excuse("the name of a key in other letters", "of things beside tracks many are not read");
  for (const char* change : {"a track with a blank", "a track with a blank everywhere",
                             "a track of several values", "a track of several values everywhere"}) {
    mutants.Excuse(change, kLists);
  }
  CheckSection("OpenStreetMap's XML", {&mutants});
}

TEST(MapMutants, OfOverpassAreNeverReadWrongWithoutAWord) {
  std::string text = "{\"version\": 0.6, \"elements\": [\n";
  for (std::size_t i = 0; i < 5; ++i) {
    text += "{\"type\": \"node\", \"id\": " + NumberText(i + 1) + ", \"lat\": " + kLats.at(i) +
            ", \"lon\": " + kLons.at(i) + ", \"tags\": {\"ele\": \"250.5\"}},\n";
  }
  text +=
      "{\"type\": \"way\", \"id\": 7, \"nodes\": [1, 2, 3], \"tags\": {\"railway\": \"rail\", "
      "\"maxspeed\": \"120\"}},\n";
  text +=
      "{\"type\": \"way\", \"id\": 8, \"nodes\": [3, 4, 5], \"tags\": {\"railway\": \"rail\", "
      "\"tunnel\": \"yes\"}}\n]}\n";
  Mutants mutants("Overpass JSON", "a.json", text, ReadMapWhole);
  TryTexts(mutants);
  TryChanges(mutants, ElementWords([](const std::string& name, const std::string& value) {
               return ", \"" + name + "\": " + value;
             }));
  std::vector<TextChange> words = {
      {"an element marked as deleted", ", \"lat\"", ", \"visible\": false, \"lat\""},
      {"an element marked as deleted", ", \"nodes\"", ", \"action\": \"delete\", \"nodes\""},
      {"an element marked in an unknown way", ", \"nodes\"", ", \"action\": \"gone\", \"nodes\""},
      {"a reference to no node", ", 3]", ", 99]"},
      {"a reference to no node", "[3, ", "[99, "},
      {"a reference that is none", ", 3]", ", \"3\"]"},
      {"a reference that is none", ", 3]", ", null]"},
      {"a reference that is none", ", 3]", ", 3.5]"},
      {"a reference doubled", "[1, ", "[1, 1, "},
      {"the nodes of a way lost", "\"nodes\"", "\"node\""},
      {"the nodes of a way lost", ", \"nodes\": [1, 2, 3]", ""},
      {"an id that is none", "\"id\": ", "\"id\": -0.5, \"old\": "},
      {"an id that is none", "\"id\": 7", "\"id\": \"7\""},
      {"an id lost", "\"id\": ", "\"ident\": "},
      {"a type that is none", "\"type\": \"node\"", "\"type\": \"Node\""},
      {"a type that is none", "\"type\": \"way\"", "\"type\": \"ways\""},
      {"a type lost", "\"type\": \"node\", ", ""},
      {"a remark of a server", "\"version\": 0.6",
       "\"version\": 0.6, \"remark\": \"runtime error: Query timed out\""},
      {"another version", "0.6", "0.5"},
      {"a height with its unit", "250.5\"", "250.5 m\""},
      {"a height with a comma", "250.5", "250,5"},
      {"a height that is a number", "\"250.5\"", "250.5"},
      {"a height that is none", "250.5", "high"},
      {"tags that are a list", "\"tags\": {\"ele\": \"250.5\"}", "\"tags\": [\"ele\"]"},
      {"a track in other letters", "\"rail\"", "\"Rail\""},
      {"a track of several values", "\"rail\"", "\"rail;tram\""},
      {"not a number", "48.203", "NaN"},
      {"the elements lost", "\"elements\"", "\"element\""}};
  for (const char* id : {"1", "2", "3"})
    words.push_back({"an id twice", "\"id\": 5", std::string("\"id\": ") + id});
  TryChanges(mutants, words);
  mutants.Excuse("a track of several values", kLists);
  mutants.Excuse("a track of several values everywhere", kLists);
  CheckSection("Overpass", {&mutants});
}

TEST(MapMutants, OfPbfAreNeverReadWrongWithoutAWord) {
  const std::string way = Way({1, 2, 3, 4, 5});
  Mutants mutants("OSM PBF", "a.osm.pbf", FileOfGroups(DenseNodes(5) + way), ReadMapWhole);
  for (std::size_t size = 1; size < mutants.good().size(); ++size) {
    mutants.Try("cut off", NumberText(size), mutants.good().substr(0, size));
    mutants.Try("a byte lost", NumberText(size), std::string(mutants.good()).erase(size, 1));
  }
  mutants.Try("a file behind another", "", mutants.good() + mutants.good());
  for (const std::size_t num : {1U, 3U, 4U, 5U, 100U})
    mutants.Try("zeros behind the end", NumberText(num), mutants.good() + std::string(num, '\0'));
  for (const auto& [type, other] : {std::pair{"OSMData", "OSMMore"}, {"OSMHeader", "OSMExtras"}})
    mutants.Try("type of a block changed", type, Replaced(mutants.good(), type, other));
  mutants.Try("a feature that is needed", "", Replaced(mutants.good(), "-V0.6", "-V0.7"));
  for (const std::int64_t node : {0, 6, 99, -1})
    mutants.Try("a reference to no node", NumberText(node),
                FileOfGroups(DenseNodes(5) + Way({1, 2, node, 4, 5})));
  mutants.Try("a reference doubled", "", FileOfGroups(DenseNodes(5) + Way({1, 2, 2, 3, 4, 5})));
  mutants.Try("a node lost", "", FileOfGroups(DenseNodes(4) + way));
  mutants.Try("nodes doubled", "", FileOfGroups(DenseNodes(5) + DenseNodes(5) + way));
  mutants.Try("a way doubled", "", FileOfGroups(DenseNodes(5) + way + way));
  for (const std::string text : {"rail", "railway", "250"}) {
    mutants.Try("a word changed", text,
                Replaced(mutants.good(), BytesField(1, text), BytesField(1, "X" + text.substr(1))));
  }
  mutants.TryHarmless("a granularity",
                      FileOfGroups(DenseNodes(5) + way + VarintField(17, Varint(100))));
  mutants.TryHarmless("a granularity",
                      FileOfGroups(DenseNodes(5, {}, 10) + way + VarintField(17, Varint(10))));
  mutants.TryHarmless("an offset of 0",
                      FileOfGroups(DenseNodes(5) + way + VarintField(19, Varint(0))));
  CheckSection("OSM PBF", {&mutants});
}

TEST(MapMutants, OfGeoJsonAreNeverReadWrongWithoutAWord) {
  std::string text =
      "{\"type\": \"FeatureCollection\", \"features\": [\n{\"type\": \"Feature\", \"properties\": "
      "{\"railway\": \"rail\", \"maxspeed\": \"120\"},\n\"geometry\": {\"type\": \"LineString\", "
      "\"coordinates\": [";
  for (std::size_t i = 0; i < 5; ++i)
    text += std::string(i == 0 ? "" : ", ") + "[" + kLons.at(i) + ", " + kLats.at(i) + ", 250.5]";
  text +=
      "]}},\n{\"type\": \"Feature\", \"properties\": {\"railway\": \"rail\"},\n\"geometry\": "
      "{\"type\": \"LineString\", \"coordinates\": [[15.641, 48.205, 250.5], [15.651, 48.206, "
      "250.5]]}}\n]}\n";
  Mutants mutants("GeoJSON", "a.geojson", text, ReadMapWhole);
  TryTexts(mutants);
  std::vector<TextChange> words = {
      {"another coordinate system", "\"features\"",
       "\"crs\": {\"type\": \"name\", \"properties\": {\"name\": "
       "\"urn:ogc:def:crs:EPSG::25833\"}}, \"features\""},
      {"another coordinate system", "\"features\"",
       "\"crs\": {\"type\": \"name\", \"properties\": {\"name\": \"EPSG:3857\"}}, \"features\""},
      {"another coordinate system", "\"features\"",
       "\"crs\": {\"type\": \"link\", \"properties\": {\"href\": \"http://x\"}}, \"features\""},
      {"a type that is none", "\"LineString\"", "\"Linestring\""},
      {"another type", "\"LineString\"", "\"MultiPoint\""},
      {"another type", "\"LineString\"", "\"MultiLineString\""},
      {"another type", "\"LineString\"", "\"Polygon\""},
      {"another type", "\"LineString\"", "\"Point\""},
      {"a type that is none", "\"Feature\"", "\"feature\""},
      {"a type that is none", "\"FeatureCollection\"", "\"Features\""},
      {"a member lost", "\"coordinates\"", "\"coordinate\""},
      {"a member lost", "\"geometry\"", "\"geom\""},
      {"a member lost", "\"features\"", "\"feature\""},
      {"a geometry that is null", "\"geometry\": {", "\"geometry\": null, \"old\": {"},
      {"a coordinate lost", "[15.621, 48.203, 250.5]", "[15.621]"},
      {"a coordinate that is none", "15.621", "\"15.621\""},
      {"a coordinate that is none", "15.621", "null"},
      {"a coordinate that is none", "48.203", "148.203"},
      {"a coordinate too many", "250.5", "250.5, 7, 8"},
      {"a place that is empty", "[15.621, 48.203, 250.5]", "[]"},
      {"a height that is none", "250.5", "null"},
      {"a height that cannot be", "250.5", "25000"},
      {"a height lost", ", 250.5", ""},
      {"a point exchanged", "[15.621, 48.203", "[48.203, 15.621"},
      {"a track in other letters", "\"rail\"", "\"Rail\""}};
  TryChanges(mutants, words);
  std::string exchanged = mutants.good();
  for (std::size_t i = 0; i < 5; ++i)
    exchanged = AllReplaced(exchanged, std::string(kLons.at(i)) + ", " + kLats.at(i),
                            std::string(kLats.at(i)) + ", " + kLons.at(i));
  mutants.Try("latitudes and longitudes exchanged", "",
              AllReplaced(exchanged, "15.651, 48.206", "48.206, 15.651"));
  mutants.Excuse("a height lost everywhere", kNoHeights);
  CheckSection("GeoJSON", {&mutants});
}

TEST(MapMutants, OfGpxAndKmlAreNeverReadWrongWithoutAWord) {
  std::string gpx =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"t\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\"><trk><name>R</name><trkseg>\n";
  std::string kml;
  for (std::size_t i = 0; i < 5; ++i) {
    gpx += std::string("<trkpt lat=\"") + kLats.at(i) + "\" lon=\"" + kLons.at(i) +
           "\"><ele>250.5</ele><time>2026-01-01T00:00:0" + NumberText(i) + "Z</time></trkpt>\n";
    kml += std::string(kml.empty() ? "" : " ") + kLons.at(i) + "," + kLats.at(i) + ",250.5";
  }
  Mutants of_gpx("GPX", "a.gpx", gpx + "</trkseg></trk></gpx>\n", ReadMapWhole);
  TryTexts(of_gpx);
  TryChanges(of_gpx, ElementWords([](const std::string& name, const std::string& value) {
               return " " + name + "=\"" + value + "\"";
             }));
  TryChanges(of_gpx, {{"a height that is none", "250.5", "x"},
                      {"a height that is none", "250.5", ""},
                      {"a height with a comma", "250.5", "250,5"},
                      {"a height with its unit", "250.5", "250.5 m"},
                      {"a height that cannot be", "250.5", "25000"},
                      {"a height lost", "<ele>250.5</ele>", ""},
                      {"the name of an element changed", "<trkseg>", "<Trkseg>"},
                      {"the name of an element changed", "trkpt", "point"},
                      {"another version", "version=\"1.1\"", "version=\"2.0\""}});
  const std::string body =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml "
      "xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><name>B</"
      "name><LineString><altitudeMode>absolute</altitudeMode>\n<coordinates>" +
      kml + "</coordinates></LineString></Placemark></Document></kml>\n";
  Mutants of_kml("KML", "a.kml", body, ReadMapWhole);
  TryTexts(of_kml);
  TryChanges(of_kml, {{"heights above the ground", "absolute", "relativeToGround"},
                      {"heights above the ground", "absolute", "clampToGround"},
                      {"heights above the ground", "<altitudeMode>absolute</altitudeMode>",
                       "<altitudeMode>relativeToSeaFloor</altitudeMode>"},
                      {"heights above the ground", "<altitudeMode>absolute</altitudeMode>", ""},
                      {"an unknown mode of heights", "absolute", "Absolute"},
                      {"a height lost", ",250.5", ""},
                      {"a height that is none", "250.5", "x"},
                      {"a height that cannot be", "250.5", "25000"},
                      {"a coordinate lost", "15.621,48.203,250.5", "15.621"},
                      {"a coordinate that is none", "15.621", "15.6.21"},
                      {"a coordinate that is none", "48.203", "148.203"},
                      {"blanks behind commas", ",", ", "},
                      {"a point exchanged", "15.621,48.203", "48.203,15.621"},
                      {"semicolons for commas", ",", ";"},
                      {"the name of an element changed", "LineString", "Linestring"},
                      {"another element", "LineString", "LinearRing"},
                      {"the name of an element changed", "coordinates", "coords"}});
  of_gpx.Excuse("a height lost everywhere", kNoHeights);
  of_gpx.Excuse("a height that is none everywhere", kNoHeights);
  of_kml.Excuse("a height lost everywhere", kNoHeights);
  CheckSection("GPX and KML", {&of_gpx, &of_kml});
}

TEST(MapMutants, OfRailmlAreNeverReadWrongWithoutAWord) {
  std::string points;
  for (std::size_t i = 0; i < 5; ++i) {
    points += "<intrinsicCoordinate intrinsicCoord=\"" + NumberText(0.25 * static_cast<double>(i)) +
              "\"><geometricCoordinate positioningSystemRef=\"gps\" x=\"" + kLons.at(i) +
              "\" y=\"" + kLats.at(i) + "\" z=\"250.5\"/></intrinsicCoordinate>\n";
  }
  const std::string text =
      "<?xml version=\"1.0\"?><railML xmlns=\"https://www.railml.org/schemas/3.2\" "
      "version=\"3.2\">\n<common><positioning><geometricPositioningSystems><"
      "geometricPositioningSystem id=\"gps\" "
      "crsDefinition=\"EPSG:4326\"/></geometricPositioningSystems></positioning></"
      "common><infrastructure><topology><netElements><netElement "
      "id=\"ne1\"><associatedPositioningSystem positioningSystemRef=\"gps\">" +
      points +
      "</associatedPositioningSystem></netElement></netElements></"
      "topology>\n<functionalInfrastructure><speedSections><speedSection id=\"s1\" "
      "maxSpeed=\"120\"><linearLocation><associatedNetElement netElementRef=\"ne1\" "
      "intrinsicCoordBegin=\"0.25\" "
      "intrinsicCoordEnd=\"0.5\"/></linearLocation></speedSection></speedSections></"
      "functionalInfrastructure></infrastructure></railML>\n";
  Mutants mutants("railML", "a.xml", text, ReadMapWhole);
  TryTexts(mutants);
  TryChanges(
      mutants,
      {{"another coordinate system", "EPSG:4326", "EPSG:99999"},
       {"another coordinate system", "EPSG:4326", "EPSG:31254"},
       {"another coordinate system", "EPSG:4326", ""},
       {"another coordinate system", "EPSG:4326", "gps"},
       {"a reference to nothing", "positioningSystemRef=\"gps\" x",
        "positioningSystemRef=\"other\" x"},
       {"a reference to nothing", "positioningSystemRef=\"gps\" x", "x"},
       {"a reference to nothing", "netElementRef=\"ne1\"", "netElementRef=\"ne2\""},
       {"a coordinate that is none", "x=\"15.621\"", "x=\"15,621\""},
       {"a coordinate that is none", "y=\"48.203\"", "y=\"148.203\""},
       {"a coordinate lost", "x=\"15.621\"", ""},
       {"a height lost", " z=\"250.5\"", ""},
       {"a height that is none", "z=\"250.5\"", "z=\"x\""},
       {"a height that cannot be", "z=\"250.5\"", "z=\"25000\""},
       {"a place along a track that is none", "intrinsicCoord=\"0.5\"", "intrinsicCoord=\"1.5\""},
       {"a place along a track that is none", "intrinsicCoord=\"0.5\"", "intrinsicCoord=\"x\""},
       {"a place along a track lost", "intrinsicCoord=\"0.5\"", ""},
       {"a place along a track that is none", "intrinsicCoordBegin=\"0.25\"",
        "intrinsicCoordBegin=\"x\""},
       {"a place along a track that is none", "intrinsicCoordEnd=\"0.5\"",
        "intrinsicCoordEnd=\"7\""},
       {"a speed that is none", "maxSpeed=\"120\"", "maxSpeed=\"fast\""},
       {"a speed that is none", "maxSpeed=\"120\"", "maxSpeed=\"-5\""},
       {"a speed lost", " maxSpeed=\"120\"", ""},
       {"points exchanged", "intrinsicCoord=\"0.25\"", "intrinsicCoord=\"0.75\""},
       {"a version that is not read", "schemas/3.2\" version=\"3.2\"",
        "schemas/2018\" version=\"2.4\""}});
  mutants.Excuse("a height lost everywhere", kNoHeights);
  CheckSection("railML", {&mutants});
}

}  // namespace
}  // namespace railcast
