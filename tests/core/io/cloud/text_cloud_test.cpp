#include "core/io/cloud/text_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/clouds.h"
#include "tests/support/faults.h"

namespace railcast {
namespace {

using testing::ElementsAre;

Cloud CloudOfText(const std::string& text, const std::string& columns = {}) {
  return ParseTextCloud("a.xyz", text, columns);
}

std::string FaultOfText(const std::string& text, const std::string& columns = {}) {
  return MessageBehind("a.xyz: ", [&] { (void)CloudOfText(text, columns); });
}

std::vector<std::string> FieldNamesOf(const Cloud& cloud) {
  std::vector<std::string> names;
  for (const CloudField& field : cloud.fields) names.push_back(field.name);
  return names;
}

TEST(TextCloud, HasNumbersBetweenBlanksCommasOrSemicolons) {
  for (const char* text :
       {"1 2.5 -3\n4 5 6\n", "1,2.5,-3\n4,5,6\n", "1;2.5;-3\n4;5;6\n", "  1\t2.5   -3\n\t4 5 6  \n",
        "1, 2.5, -3\n4, 5, 6\n", "1 ; 2.5 ; -3 ;\n4;5;6;\n", "+1 25e-1 -3.000\n4 5 6",
        "\"1\",\"2.5\",\"-3\"\n\"4\",\"5\",\"6\"\n"}) {
    SCOPED_TRACE(text);
    const Cloud cloud = CloudOfText(text);
    EXPECT_EQ(cloud.num_points(), 2U);
    EXPECT_THAT(FieldNumbers(cloud, "x"), ElementsAre(1.0, 4.0));
    EXPECT_THAT(FieldNumbers(cloud, "y"), ElementsAre(2.5, 5.0));
    EXPECT_THAT(FieldNumbers(cloud, "z"), ElementsAre(-3.0, 6.0));
    EXPECT_TRUE(cloud.remarks.empty());
  }
}

TEST(TextCloud, HasAsManyPointsAsItStates) {
  for (const char* text : {"2\n1 2 3\n4 5 6\n", "// made by hand\n2\r\n\r\n1 2 3\r\n4 5 6\r\n",
                           "//X,Y,Z\n2,,\n1,2,3\n4,5,6\n", "2\nx y z\n1 2 3\n4 5 6\n"}) {
    EXPECT_EQ(CloudOfText(text).num_points(), 2U) << text;
  }
  EXPECT_EQ(CloudOfText("0\n").num_points(), 0U);
  EXPECT_EQ(FaultOfText("3\n1 2 3\n4 5 6\n"),
            "must have as many lines of points as it states, 3 (got 2)");
  EXPECT_EQ(FaultOfText("1\n1 2 3\n4 5 6\n"),
            "must have as many lines of points as it states, 1 (got 2)");
  EXPECT_EQ(FaultOfText("2\n1 2 3\n4 5 6\n1\n7 8 9\n"),
            "line 4: begins another cloud; a file must hold one (got 1)");
  // Those of PTX, which has more in front of its points.
  EXPECT_EQ(FaultOfText("2\n1\n0 0 0\n"), "line 2: must have at least 3 numbers (got 1)");
}

TEST(TextCloud, HasTheColumnsOfItsHeader) {
  const std::map<std::string, std::vector<std::string>> headers = {
      {"x y z intensity", {"x", "y", "z", "intensity"}},
      {"# x y z intensity", {"x", "y", "z", "intensity"}},
      {"//X,Y,Z,Intensity", {"x", "y", "z", "intensity"}},
      {"// X Y Z Scalar_field", {"x", "y", "z", "scalar_field"}},
      {"\"x\",\"y\",\"z\",\"ring\"", {"x", "y", "z", "ring"}},
      {"X [m];Y [m];Z [m];Slot ID", {"x", "y", "z", "slot_id"}},
      {"TIMESTAMP (ns), X (m), Y (m), Z (m)", {"timestamp", "x", "y", "z"}},
      {"x [m] y [m] z [m] time [s]", {"x", "y", "z", "time"}},
      {"z,y,,x,", {"z", "y", "_", "x"}},
  };
  for (const auto& [header, names] : headers) {
    const Cloud cloud = CloudOfText(header + "\n1 2 3 4\n");
    EXPECT_EQ(FieldNamesOf(cloud), names) << header;
    EXPECT_EQ(cloud.num_points(), 1U);
  }
  EXPECT_THAT(FieldNamesOf(CloudOfText("//X Y Z R G B\n1 2 3 4 5 6\n")),
              ElementsAre("x", "y", "z", "red", "green", "blue"));
  // Prose that has another number of words than the points have numbers names no columns.
  EXPECT_THAT(FieldNamesOf(CloudOfText("# x y z of the site\n1 2 3\n")),
              ElementsAre("x", "y", "z"));
}

TEST(TextCloud, RefusesHeadersThatFitNoPoints) {
  EXPECT_EQ(FaultOfText("x,y,z\n1,2,3,4\n"),
            "line 2: must have 3 numbers, as many as columns are named (got 4)");
  EXPECT_EQ(FaultOfText("east north height\n1 2 3\n"),
            "line 1: must be numbers, or names of columns with x, y and z once each; --columns "
            "x,y,z,... names them (got east north height)");
  EXPECT_EQ(FaultOfText("x,y,z,x\n1,2,3,4\n").substr(0, 24), "line 1: must be numbers,");
  EXPECT_EQ(FaultOfText("//X Y Z\n1 2 3\n//X Y Z\n4 5 6\n"),
            "line 3: names columns behind points; a file must hold one cloud");
  for (const char* none : {"", "\n\r\n", "# x y z\n"}) {
    EXPECT_EQ(FaultOfText(none), "must have lines of numbers");
  }
  EXPECT_EQ(CloudOfText("x,y,z\n").num_points(), 0U);
}

TEST(TextCloud, IsInMetres) {
  const std::string fault = "positions must be in metres, but ";
  EXPECT_EQ(FaultOfText("x [mm],y [mm],z [mm]\n1,2,3\n"), fault + "the unit of x is \"mm\"");
  EXPECT_EQ(FaultOfText("x y z(deg)\n1 2 3\n"), fault + "the unit of z is \"deg\"");
  EXPECT_EQ(FaultOfText("//X(ft) Y(ft) Z(ft)\n1 2 3\n"), fault + "the unit of x is \"ft\"");
  EXPECT_EQ(FaultOfText("# units: cm\n1 2 3\n"), fault + "a comment says \"# units: cm\"");
  EXPECT_EQ(FaultOfText("x [mm] y z\n1 2 3\n", "x,y,z"), fault + "the unit of x is \"mm\"");
  EXPECT_EQ(FaultOfText("# units: m\nx [Metres] y z range [mm]\n1 2 3 4\n"), "no error");
}

TEST(TextCloud, GuessesNoNames) {
  const Cloud cloud = CloudOfText("2\n1 2 3 0.5 tree\n4 5 6 0.25 -\n");
  EXPECT_THAT(FieldNamesOf(cloud), ElementsAre("x", "y", "z"));
  ASSERT_EQ(cloud.remarks.size(), 1U);
  EXPECT_EQ(cloud.remarks[0].Text(),
            "2 fields of clouds left out: columns without names; --columns x,y,z,... names them "
            "(the first in a.xyz)");
}

TEST(TextCloud, HasTheColumnsThatAreChosen) {
  const Cloud cloud = CloudOfText("1 2 3 4 5\n", "intensity,_,x,z,y");
  EXPECT_THAT(FieldNumbers(cloud, "x"), ElementsAre(3.0));
  EXPECT_THAT(FieldNumbers(cloud, "y"), ElementsAre(5.0));
  EXPECT_THAT(FieldNumbers(cloud, "intensity"), ElementsAre(1.0));
  EXPECT_TRUE(cloud.remarks.empty());
  EXPECT_THAT(FieldNamesOf(CloudOfText("a b c d\n1 2 3 4\n", "x,y,z,ring")),
              ElementsAre("x", "y", "z", "ring"));
  EXPECT_EQ(FaultOfText("1 2 3 4 5\n", "x,y,z"),
            "line 1: must have 3 numbers, as many as columns are named (got 5)");
  EXPECT_EQ(FaultOfText("1 2 3\n", "5"), "columns must be names, as in x,y,z,intensity (got 5)");
  for (const char* names : {"x,y,z", "X,Y,Z,Ring", "_,x,y,_,z"}) EXPECT_TRUE(IsTextColumns(names));
  for (const char* none :
       {"", "x", "x,y", "x,y,z,", "x,y,z,x", "x,y,z,a b", "5", "x;y;z", "a,b,c"}) {
    EXPECT_FALSE(IsTextColumns(none)) << none;
  }
}

TEST(TextCloud, RefusesWhatIsNoPoint) {
  EXPECT_EQ(FaultOfText("1 2\n"), "line 1: must have at least 3 numbers (got 2)");
  EXPECT_EQ(FaultOfText("# a\n\n1 2 3\n4 5 6 7\n"),
            "line 4: must have 3 numbers, as the first point has (got 4)");
  EXPECT_EQ(FaultOfText("1 2 3\n4 5\n"),
            "line 2: must have 3 numbers, as the first point has (got 2)");
  EXPECT_EQ(FaultOfText("1 2 3\nx y z\n"), "line 2: x: no value of its type (got x)");
  EXPECT_EQ(FaultOfText("1,2,3\n1 2 3\n"),
            "line 2: must have 3 numbers, as the first point has (got 1)");
  EXPECT_EQ(FaultOfText("1 2 3 # here\n"), "no error");
  EXPECT_EQ(FaultOfText("ncols 3\n"), "line 1: must have at least 3 numbers (got 2)");
  for (const std::string line : {"1,5;2,5;3,5", "1,5 2,5 3,5", "1,5\t2\t3,5"}) {
    EXPECT_EQ(FaultOfText(line + "\n").substr(0, 54),
              "line 1: numbers must have decimal points, not commas (");
  }
}

TEST(TextCloud, LeavesOutNamedColumnsThatAreNoNumbers) {
  const Cloud cloud = CloudOfText("x,y,z,class,ring\n1,2,3,tree,4\n4,5,6,bush,5\n");
  EXPECT_EQ(RemarkTexts(cloud.remarks), (std::vector<std::string>{"fields-left-out 1"}));
  EXPECT_EQ(cloud.remarks[0].place, "a.xyz: line 2");
  EXPECT_EQ(cloud.remarks[0].detail, "class: no value of its type (got tree)");
  EXPECT_THAT(FieldNumbers(cloud, "ring"), ElementsAre(4.0, 5.0));
}

TEST(TextCloud, HasNoPointWhereNumbersAreAbsent) {
  for (const std::string line : {"nan nan nan 7", "NaN 2 3 7", "1 - 3 7", "1 2 inf 7", "1,2,,7",
                                 "1;;3;7", "1.#QNAN 2 3 7", "0 0 0 7"}) {
    SCOPED_TRACE(line);
    const char separator = line.find(',') != std::string::npos   ? ','
                           : line.find(';') != std::string::npos ? ';'
                                                                 : ' ';
    std::string good = "1 2 3 7\n";
    std::ranges::replace(good, ' ', separator);
    const RecordedFrame recorded =
        MakeCloudFrame(CloudOfText(good + line + "\n" + good, "x,y,z,intensity"), "a.xyz");
    EXPECT_EQ(std::ranges::count(recorded.frame.x, 1.0F), 2);
    EXPECT_EQ(std::ranges::count_if(recorded.frame.x, [](float x) { return !std::isnan(x); }), 2);
    EXPECT_TRUE(recorded.remarks.empty());
  }
}

TEST(TextCloud, IsReadAsEditorsOfAllSystemsStoreIt) {
  const std::string text = "2\n1 2 3\n4 5 6";
  std::string wide = "\xFF\xFE";
  for (const char letter : text) wide += {letter, '\0'};
  for (const std::string& bytes :
       {text, "\xEF\xBB\xBF" + text, wide, wide.substr(2), text + "\n\n  \n"}) {
    EXPECT_THAT(FieldNumbers(CloudOfText(bytes), "z"), ElementsAre(3.0, 6.0));
  }
}

TEST(TextCloud, KeepsTheDigitsOfMapsAndClocks) {
  const std::string text = "x y z time ring\n665187.522077 5648349.895035 241.767693 0.000001 3\n";
  const Cloud cloud = CloudOfText(text + text.substr(text.find('\n') + 1));
  EXPECT_THAT(FieldNumbers(cloud, "x"), ElementsAre(665187.522077, 665187.522077));
  EXPECT_THAT(FieldNumbers(cloud, "y"), ElementsAre(5648349.895035, 5648349.895035));
  EXPECT_EQ(cloud.Find("z")->type, NumberType::kFloat);
  EXPECT_EQ(cloud.Find("time")->type, NumberType::kDouble);
  EXPECT_EQ(FieldNumbers(CloudOfText("x,y,z,stamp\n1,2,3,1700000000123456\n"), "stamp")[0],
            1700000000123456.0);
}

// Livox Viewer writes hexadecimal codes, CloudCompare its names behind slashes, Leica the colours
// behind the intensity.
TEST(TextCloud, IsReadAsProgramsWriteIt) {
  const Cloud livox = CloudOfText(
      "Version,Slot ID,LiDAR Index,Rsvd,Error Code,Timestamp Type,Data "
      "Type,Timestamp,X,Y,Z,Reflectivity,Tag,Ori_x,Ori_y,Ori_z,Ori_radius,Ori_theta,Ori_phi\n"
      "5,1,1,0,0x00000000,0,0,2444124311890,4.971,-0.365,0.411,51,0,4971,-365,411,0,0,0\n");
  EXPECT_EQ(FieldNumbers(livox, "timestamp")[0], 2444124311890.0);
  const RecordedFrame of_livox = MakeCloudFrame(livox, "a.xyz");
  EXPECT_FLOAT_EQ(of_livox.frame.x[0], 4.971F);
  EXPECT_FLOAT_EQ(of_livox.frame.intensity[0], 51.0F);
  const RecordedFrame compared =
      MakeCloudFrame(CloudOfText("//X Y Z R G B Intensity\n1\n1.5 2 3 9 8 7 0.25\n"), "a.xyz");
  EXPECT_FLOAT_EQ(compared.frame.intensity[0], 0.25F);
  EXPECT_EQ(compared.remarks[0].detail, "red, green, blue");
  const Cloud leica =
      CloudOfText("1\r\n-0.41 -2.08 8.01 -1277 52 44 65\r\n", "x,y,z,intensity,r,g,b");
  EXPECT_THAT(FieldNumbers(leica, "intensity"), ElementsAre(-1277.0));
}

class TextRecording : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::string& text = "1 2 3\n") {
    WriteFileWhole(folder_.path() / name, text);
    return folder_.path() / name;
  }
  static std::string Fault(const std::filesystem::path& source) {
    return MessageBehind(source.string() + ": ", [&] { (void)ReadAll(source); });
  }

  TemporaryDirectory folder_;
};

TEST_F(TextRecording, IsOfFilesOfItsEndings) {
  for (const char* name : {"a.xyz", "b.PTS", "c.asc", "d.pc", "e.txt", "f.csv"}) {
    const auto frames = ReadAll(Write(name));
    ASSERT_EQ(frames.size(), 1U) << name;
    EXPECT_FLOAT_EQ(frames[0].frame.range_m[0], std::sqrt(14.0F));
  }
  EXPECT_EQ(Fault(Write("notes.txt", "Dear reader,\n")).substr(0, 23), "line 1: must be numbers");
  EXPECT_EQ(Fault(Write("dem.asc", "ncols 3\nnrows 4\n")),
            "is a grid of heights, which is not read: railcast-generate import takes it by "
            "--heights");
}

TEST_F(TextRecording, IsOfTablesOfPosesOnlyWhereTheirColumnsAreNamed) {
  const auto table = Write("table.csv", "1,2,3,4,5,6,7,8\n");
  EXPECT_EQ(Fault(table).substr(0, 51), "is text with 8 numbers a line, which is not read: i");
  EXPECT_EQ(ReadAll(table.string() + ":x,y,z,_,_,_,_,_").size(), 1U);
}

TEST_F(TextRecording, HasTheFramesOfAFolderButNoTables) {
  for (const char* name : {"0.xyz", "1.xyz", "2.xyz", "poses.txt", "weather.csv"}) Write(name);
  EXPECT_EQ(ReadAll(folder_.path()).size(), 3U);
  const TemporaryDirectory tables;
  WriteFileWhole(tables.path() / "0.csv", "1,2,3\n");
  EXPECT_EQ(MessageBehind((tables.path() / "0.csv").string() + ": ",
                          [&] { (void)ReadAll(tables.path()); }),
            "is text with 3 numbers a line, which is not read in a folder: if it is a cloud, name "
            "the file itself");
}

TEST_F(TextRecording, HasColumnsOfItsOwnKindAlone) {
  const auto fault = [&](const std::filesystem::path& file, const std::string& columns) {
    return MessageBehind(file.string() + ": ",
                         [&] { (void)ReadAll(file.string() + ":" + columns); });
  };
  EXPECT_EQ(fault(Write("a.xyz"), "5"), "columns must be names, as in x,y,z,intensity (got 5)");
  for (const char* name : {"a.pcd", "a.bin"}) {
    EXPECT_EQ(fault(Write(name), "x,y,z"),
              "must be a cloud in text for its columns to be chosen (got x,y,z)");
  }
  std::filesystem::create_directory(folder_.path() / "empty");
  EXPECT_EQ(fault(folder_.path() / "empty", "x,y,z"),
            "must hold clouds in text for their columns to be chosen");
}

/// The points turned so that an axis becomes z.
std::string TurnedText(const Cloud& cloud, const Vector3& up) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(up, Vector3::UnitZ()).toRotationMatrix();
  const auto x = FieldNumbers(cloud, "x"), y = FieldNumbers(cloud, "y"),
             z = FieldNumbers(cloud, "z");
  std::string text;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3 place_m = turn * Vector3(x[i], y[i], z[i]);
    for (const double number : place_m) text += NumberText(number) + ' ';
    text += '\n';
  }
  return text;
}

// The axes are those about which the points lie on 64 cones, told by the points alone.
TEST_F(TextRecording, HasTheRingsOfRealTurns) {
  const std::filesystem::path frames =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "railway_frames";
  if (!exists(frames)) GTEST_SKIP() << "there is no " << frames;
  const double tilt_rad = RadFromDeg(15.0);
  for (const auto& [name, up, num_points] :
       {std::tuple("Jesenice1.pc", Vector3(0.0, std::cos(tilt_rad), -std::sin(tilt_rad)), 58172U),
        std::tuple("Vizmarje.pc", Vector3(1.0, 0.0, 0.0), 29177U)}) {
    SCOPED_TRACE(name);
    const Cloud cloud = ReadTextCloud(frames / name);
    EXPECT_EQ(cloud.num_points(), num_points);
    EXPECT_TRUE(cloud.remarks.empty());
    const auto turned = ReadAll(Write("turned.xyz", TurnedText(cloud, up)));
    ASSERT_EQ(turned.size(), 1U);
    EXPECT_TRUE(turned[0].is_grid) << turned[0].why_no_grid;
    EXPECT_EQ(turned[0].frame.rows, 64U);
  }
  // As they come, too, about an axis that leans.
  const auto vienna = ReadAll(frames / "Vienna.csv");
  ASSERT_EQ(vienna.size(), 1U);
  EXPECT_TRUE(vienna[0].is_grid) << vienna[0].why_no_grid;
  EXPECT_EQ(vienna[0].frame.rows, 64U);
  EXPECT_EQ(vienna[0].slot_of_entry.size(), 58271U);
}

}  // namespace
}  // namespace railcast
