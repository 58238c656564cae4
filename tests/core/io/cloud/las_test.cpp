#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/io/cloud/las_reader.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/cloud/made_las.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/clouds.h"
#include "tests/support/faults.h"

namespace railcast {
namespace {

class LasFile : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& bytes, const std::string& name = "site.las") {
    WriteFileWhole(folder_.path() / name, bytes);
    return folder_.path() / name;
  }
  Cloud Read(const std::string& bytes) { return ReadLas(Write(bytes)); }
  std::string MessageAbout(const std::string& bytes) {
    const auto file = Write(bytes);
    return MessageBehind(file.string() + ": ", [&] { (void)ReadLas(file); });
  }

  TemporaryDirectory folder_;
};

using LasValues = std::vector<double>;

TEST_F(LasFile, IsReadInEveryVersionAndFormat) {
  for (int format = 0; format <= 10; ++format) {
    for (int version = format >= 6 ? 4 : 0; version <= 4; ++version) {
      SCOPED_TRACE(std::to_string(version) + " " + std::to_string(format));
      const Cloud cloud = Read(MadeLas{.minor_version = version, .format = format}.Bytes(3));
      ASSERT_EQ(cloud.num_points(), 3U);
      EXPECT_EQ(FieldNumbers(cloud, "x"), (LasValues{5001.0, 5002.0, 5003.0}));
      EXPECT_EQ(FieldNumbers(cloud, "y"), (LasValues{299'998.0, 299'996.0, 299'994.0}));
      EXPECT_EQ(FieldNumbers(cloud, "z"), LasValues(3, 345 * 0.001));
      EXPECT_EQ(FieldNumbers(cloud, "intensity"), (LasValues{100, 200, 300}));
      EXPECT_EQ(FieldNumbers(cloud, "return_index"), (LasValues{0, 1, 2}));
      EXPECT_EQ(FieldNumbers(cloud, "return_count"), (LasValues{3, 3, 3}));
      EXPECT_EQ(FieldNumbers(cloud, "label"), (LasValues{1, 2, 3}));
      EXPECT_EQ(FieldNumbers(cloud, "user_data"), (LasValues{41, 42, 43}));
      EXPECT_EQ(FieldNumbers(cloud, "flags"), (LasValues{0x42, 0x42, 0x42}));
      EXPECT_NEAR(FieldNumbers(cloud, "scan_angle")[0], -12.0, 1e-6);
      EXPECT_EQ(FieldNumbers(cloud, "point_source_id"), (LasValues{7, 7, 7}));
      const bool has_time = format == 1 || format >= 3;
      EXPECT_EQ(cloud.Find("gps_time") != nullptr, has_time);
      if (!has_time) continue;
      EXPECT_NEAR(FieldNumbers(cloud, "gps_time")[2], 7.15, 1e-9);
    }
  }
}

TEST_F(LasFile, TellsWhatItLeavesOut) {
  const auto left_out = [&](int format, std::size_t extra_bytes) {
    const Cloud cloud =
        Read(MadeLas{.minor_version = 4, .format = format, .extra_bytes = extra_bytes}.Bytes(1));
    return cloud.remarks.empty() ? "nothing" : cloud.remarks[0].detail;
  };
  EXPECT_EQ(left_out(6, 0), "nothing");
  EXPECT_EQ(left_out(2, 0), "colour");
  EXPECT_EQ(left_out(10, 5), "colour, near infrared, waveform, 5 extra bytes");
}

TEST_F(LasFile, LeavesOutPointsThatAreWithheld) {
  for (const auto& [format, place, mark] :
       std::vector<std::tuple<int, std::size_t, char>>{{0, 15, '\x80'}, {6, 15, '\x04'}}) {
    const MadeLas las{.minor_version = 4, .format = format};
    std::string bytes = las.Bytes(3);
    bytes[las.points_begin() + las.point_bytes() + place] |= mark;
    const Cloud cloud = Read(bytes);
    EXPECT_EQ(FieldNumbers(cloud, "label"), (LasValues{1, 3}));
    EXPECT_EQ(RemarkTexts(cloud.remarks), std::vector<std::string>{"points-withheld 1"});
  }
}

TEST_F(LasFile, TellsOfPointsBeyondThoseThatItsHeaderStates) {
  const std::vector<std::string> expected = {"points-beyond 2"};
  EXPECT_EQ(RemarkTexts(Read(MadeLas{}.Bytes(5, 3)).remarks), expected);
  EXPECT_EQ(MessageAbout(MadeLas{}.Bytes(3, 5)),
            "must hold the points that its header states, 5 (got 3)");
  // What belongs to the waveforms is none.
  const MadeLas las{.minor_version = 3, .format = 4};
  std::string bytes = las.Bytes(5, 3);
  PutNumber(bytes, 227, std::uint64_t{las.points_begin() + 3 * las.point_bytes()});
  EXPECT_EQ(RemarkTexts(Read(bytes).remarks), std::vector<std::string>{"fields-left-out 1"});
}

TEST_F(LasFile, IsRefusedIfItsCoordinatesAreNoMetres) {
  const auto with = [&](const std::string& record) {
    return MadeLas{.records = record, .num_records = 1}.Bytes(1);
  };
  const std::string rule = "coordinates: must be metres in plan and height (got ";
  const std::string advice = "); pdal translate with filters.reprojection makes them such";
  EXPECT_EQ(MessageAbout(with(LasRecord(34735, GeoKey(1024, 2)))), rule + "degrees" + advice);
  EXPECT_EQ(MessageAbout(with(LasRecord(34735, GeoKey(3076, 9003)))),
            rule + "unit EPSG:9003" + advice);
  EXPECT_EQ(MessageAbout(with(LasRecord(2112, "GEOGCS[\"WGS 84\"]"))), rule + "degrees" + advice);
  EXPECT_EQ(MessageAbout(with(LasRecord(2112, "PROJCS[\"X\",UNIT[\"US survey foot\",0.3]]"))),
            rule + "US survey foot" + advice);
  EXPECT_EQ(Read(with(LasRecord(2112, "UNIT[\"" + std::string(60'000, 'u')))).num_points(), 1U);
  EXPECT_EQ(Read(with(LasRecord(34735, GeoKey(3076, 9001)))).num_points(), 1U);
  // The unit of a system of EPSG's stands in its register: feet in New York.
  const auto remarks = Read(with(LasRecord(34735, GeoKey(3072, 2263)))).remarks;
  ASSERT_FALSE(remarks.empty());
  EXPECT_EQ(remarks.front().kind, RemarkKind::kUnitsAssumed);
  EXPECT_EQ(remarks.front().detail, "EPSG:2263");
  EXPECT_EQ(MessageAbout(with(LasRecord(34735, GeoKey(2048, 4326)))), rule + "degrees" + advice);
  const auto unstated = Read(MadeLas{.records = {}, .num_records = 0}.Bytes(1)).remarks;
  ASSERT_EQ(unstated.size(), 1U);
  EXPECT_EQ(unstated.front().kind, RemarkKind::kUnitsAssumed);
  EXPECT_EQ(unstated.front().detail, "");
  EXPECT_EQ(
      Read(with(LasRecord(2112, "PROJCS[\"X\",GEOGCS[\"Y\"],UNIT[\"metre\",1]]"))).num_points(),
      1U);
}

TEST_F(LasFile, IsRefusedIfRecordsBehindThePointsAreCut) {
  const std::string whole = MadeLas{.minor_version = 4, .format = 6}.Bytes(2);
  for (const std::uint64_t size : {std::uint64_t{11}, ~std::uint64_t{0} - 59}) {
    std::string bytes = whole;
    PutNumber(bytes, 235, std::uint64_t{whole.size()});
    PutNumber(bytes, 243, std::numeric_limits<std::uint32_t>::max());
    std::string head(60, '\0');
    PutNumber(head, 20, size);
    bytes += head + "ten bytes.";
    EXPECT_EQ(MessageAbout(bytes), "records behind the points: must lie in the file (got " +
                                       std::to_string(bytes.size()) + ")");
  }
}

TEST_F(LasFile, IsRefusedIfItIsNoneOrCompressed) {
  std::string bytes = MadeLas{}.Bytes(2);
  EXPECT_EQ(MessageAbout("LASS"), "must begin with LASF");
  EXPECT_EQ(MessageAbout(bytes.substr(0, 150)), "must have its whole header (got 150 bytes)");
  bytes[104] = '\x81';
  EXPECT_EQ(MessageAbout(bytes),
            "is compressed LAS (LAZ), which is not read: pdal translate or las2las makes a .las of "
            "it");
  bytes[104] = 11;
  EXPECT_EQ(MessageAbout(bytes), "point format: must be 0 to 10 (got 11)");
  bytes[104] = 1;
  EXPECT_EQ(MessageAbout(bytes),
            "length of points: must be at least that of their format, 28 (got 20)");
  bytes[25] = 5;
  EXPECT_EQ(MessageAbout(bytes), "version: must be 1.0 to 1.4 (got 1.5)");
}

// Whatever it is given, it reads it or says why not.
TEST_F(LasFile, IsReadOrRefusedWithALineWhateverByteIsDamaged) {
  const std::string whole = MadeLas{.minor_version = 4,
                                    .format = 6,
                                    .records = LasRecord(34735, GeoKey(3076, 9001)),
                                    .num_records = 1}
                                .Bytes(2);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(~bytes[i]);
    const auto file = Write(bytes);
    const std::string message = MessageOf([&] { (void)ReadLas(file); });
    EXPECT_TRUE(message == "no error" || message.starts_with(file.string() + ": ")) << message;
  }
}

TEST_F(LasFile, IsARecordingWithTheNamesOfItsClassesAndItsOrigin) {
  (void)Write(MadeLas{.minor_version = 4, .format = 7}.Bytes(3), "10.LAS");
  (void)Write(MadeLas{.format = 1}.Bytes(2), "9.las");
  const auto recording = OpenRecording(folder_.path());
  EXPECT_EQ(recording->info().labels.Find(2U)->name, "ground");
  EXPECT_EQ(recording->info().labels.Find(10U)->name, "rail");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 2U);
  const RecordedFrame& last = frames[1];
  ASSERT_EQ(last.frame.num_slots(), 3U);
  EXPECT_EQ(last.origin_m, Vector3(5000.0, 300'000.0, 0.0));
  EXPECT_NEAR(last.frame.x[0], 1.0, 1e-6);
  EXPECT_EQ(last.frame.label, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(last.frame.return_count[0], 3);
  EXPECT_EQ(last.frame.time_ns, (std::vector<std::uint32_t>{0, 50'000'000, 100'000'000}));
  EXPECT_FALSE(recording->info().remarks->List().empty());
}

}  // namespace
}  // namespace railcast
