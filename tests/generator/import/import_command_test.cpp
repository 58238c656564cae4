#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kMap = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}}]})";

TEST(Import, WritesAnAlignmentAndTheReports) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  const fs::path out = directory.path() / "out";
  WriteFileWhole(map, kMap);
  const Ended run = Generate("import " + map.string() + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("projection: +proj=tmerc"));
  EXPECT_THAT(run.said, HasSubstr("| hill-line | 2.2"));
  EXPECT_THAT(ReadFileWhole(out / "hill-line.alignment.json"), HasSubstr(R"("type": "elements")"));
  EXPECT_THAT(ReadFileWhole(out / "lines.csv"), HasSubstr("hill-line,22"));
  EXPECT_THAT(ReadFileWhole(out / "contradictions.csv"), HasSubstr("line,s_m,offset_m"));
}

TEST(Import, GivesTheSameBytesAgain) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}},
  {"type": "Feature", "properties": {"railway": "rail", "name": "Dale Line"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.25], [15.61, 48.251], [15.62, 48.2503], [15.64, 48.251]]}},
  {"type": "Feature", "properties": {"railway": "rail", "name": "Marsh Line"},
   "geometry": {"type": "LineString", "coordinates": [[15.60, 48.15], [15.62, 48.15]]}}]})");
  std::map<std::string, std::string> texts[2];
  for (const int run : {0, 1}) {
    const fs::path out = directory.path() / std::to_string(run);
    ASSERT_EQ(Generate("import " + map.string() + " --out " + out.string()).status, 0);
    for (const fs::directory_entry& file : fs::directory_iterator(out)) {
      texts[run][file.path().filename()] = ReadFileWhole(file.path());
    }
  }
  EXPECT_THAT(texts[0], ::testing::SizeIs(5)) << "three lines, lines.csv and contradictions.csv";
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(Import, RefusesAFolderThatIsNotEmpty) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, kMap);
  const Ended run = Generate("import " + map.string() + " --out " + directory.path().string());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("--out: must be a new or an empty folder (got " +
                                  directory.path().string() + ")"));
}

TEST(Import, NamesTheMapThatIsTooLarge) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, R"({"type": "LineString", "coordinates": [[-90, 0], [90, 0]]})");
  const Ended run = Generate("import " + map.string() + " --out " + directory.path().string());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said,
              HasSubstr("map.geojson: the map must lie about its middle at 0, 0 degrees"));
}

TEST(Import, RefusesWhatItCannotUseInOneLine) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, kMap);
  const std::string out = " --out " + (directory.path() / "out").string();
  const Ended no_line = Generate("import " + map.string() + out + " --min-length 5000");
  EXPECT_EQ(no_line.status, 1);
  EXPECT_THAT(no_line.said, HasSubstr("must have a line of at least --min-length 5000 m"));
  const Ended no_file = Generate("import " + (directory.path() / "none.json").string() + out);
  EXPECT_EQ(no_file.status, 1);
  EXPECT_THAT(no_file.said, HasSubstr("none.json: "));
  const Ended no_system = Generate("import " + map.string() + out + " --crs EPSG:99999");
  EXPECT_EQ(no_system.status, 1);
  EXPECT_THAT(no_system.said, HasSubstr("--crs: must be a coordinate system that PROJ knows"));
  EXPECT_FALSE(fs::exists(directory.path() / "out"));
}

}  // namespace
}  // namespace railcast
