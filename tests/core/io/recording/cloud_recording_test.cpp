#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/clouds.h"
#include "tests/support/faults.h"
#include "tests/support/run_command.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Returns an ASCII PCD file.
/// @param lines One for each point.
std::string AsciiPcd(const std::string& fields,
                     const std::string& sizes,
                     const std::string& types,
                     const std::vector<std::string>& lines) {
  std::string text = "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types +
                     "\nWIDTH " + std::to_string(lines.size()) + "\nHEIGHT 1\nPOINTS " +
                     std::to_string(lines.size()) + "\nDATA ascii\n";
  for (const std::string& line : lines) text.append(line).append("\n");
  return text;
}

RecordedFrame ReadText(const std::string& name, const std::string& text) {
  auto frames = ReadAll(WrittenFile(name, text).path());
  EXPECT_EQ(frames.size(), 1U);
  return std::move(frames.at(0));
}

std::string MessageOfText(const std::string& name, const std::string& text) {
  const WrittenFile file(name, text);
  return MessageBehind(file.path().string() + ": ", [&] { (void)ReadAll(file.path()); });
}

// As when another program moves the points of a cloud and keeps its other fields.
TEST(CloudRecording, TellsOfRangesThatAreNotThoseOfThePoints) {
  const auto remarks_at = [](const std::string& range_m) {
    const WrittenFile file("a.pcd", AsciiPcd("x y z range_m", "4 4 4 4", "F F F F",
                                             {"3 4 0 5.5", "6 8 0 " + range_m, "nan nan nan nan"}));
    const auto recording = OpenRecording(file.path());
    EXPECT_EQ(ReadAll(*recording).at(0).frame.range_m[1], std::stof(range_m));
    return recording->info().remarks->List();
  };
  EXPECT_TRUE(remarks_at("9.5").empty()) << "beams need not leave at the origin";
  const std::vector<Remark> remarks = remarks_at("30");
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].kind, RemarkKind::kRangesDiffer);
  EXPECT_EQ(remarks[0].number, 1U);
  EXPECT_EQ(remarks[0].detail, "30 m at 10 m");
}

// As drivers for Velodyne make them: a row for each firing, a column for each laser. Those for
// RoboSense leave out the rings.
TEST(CloudRecording, TurnsAnOrganisedCloudWhoseColumnsAreRings) {
  for (const bool has_rings : {true, false}) {
    std::string text = "VERSION 0.7\nFIELDS x y z " + std::string(has_rings ? "ring" : "extra") +
                       "\nSIZE 4 4 4 2\nTYPE F F F U\nWIDTH 3\nHEIGHT 4\nPOINTS 12\nDATA ascii\n";
    for (int firing = 0; firing < 4; ++firing) {
      for (const int ring : {1, 0, 2}) {
        const std::string place = " " + NumberText(firing) + " " + NumberText(ring) + " ";
        // The rings of lost returns are not stated everywhere.
        text +=
            firing == 2 && ring == 0 ? "nan nan nan 9\n" : "10" + place + NumberText(ring) + "\n";
      }
    }
    const RecordedFrame recorded = ReadText("a.pcd", text);
    const Frame& frame = recorded.frame;
    EXPECT_TRUE(recorded.is_grid);
    ASSERT_EQ(frame.rows, 3U) << has_rings;
    ASSERT_EQ(frame.columns, 4U);
    for (std::uint32_t ring = 0; ring < 3; ++ring) {
      for (std::uint32_t column = 0; column < 4; ++column) {
        const std::uint32_t slot = 4 * ring + column;
        if (ring == 0 && column == 2) {
          EXPECT_TRUE(std::isnan(frame.x[slot]));
          continue;
        }
        EXPECT_EQ(frame.z[slot], static_cast<float>(ring));
        EXPECT_EQ(frame.y[slot], static_cast<float>(column));
        EXPECT_EQ(frame.column[slot], column);
      }
    }
  }
}

// Drivers store the highest ring first.
TEST(CloudRecording, TurnsAnOrganisedCloudSoThatTheLowestRowComesFirst) {
  pcl::PointCloud<pcl::PointXYZI> cloud(5, 4);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      pcl::PointXYZI& point = cloud.at(column, row);
      point.x = 10.0F;
      point.y = static_cast<float>(column);
      point.z = 2.0F - static_cast<float>(row);
      point.intensity = static_cast<float>(10 * row + column);
    }
  }
  cloud.at(2, 1).x = kNaN;
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcd";
  ASSERT_EQ(pcl::io::savePCDFileBinary(file.string(), cloud), 0);
  const auto frames = ReadAll(file);
  const Frame& frame = frames.at(0).frame;
  EXPECT_TRUE(frames[0].is_grid);
  EXPECT_FALSE(frames[0].has_pose);
  EXPECT_EQ(frame.rows, 4U);
  EXPECT_EQ(frame.columns, 5U);
  EXPECT_EQ(frame.intensity[0], 30.0F);
  EXPECT_EQ(frame.ring[0], 0U);
  EXPECT_EQ(frame.intensity[3 * 5 + 4], 4.0F);
  EXPECT_EQ(frame.column[3 * 5 + 4], 4U);
  EXPECT_TRUE(std::isnan(frame.x[2 * 5 + 2]));
  EXPECT_TRUE(std::isnan(frame.range_m[2 * 5 + 2]));
  EXPECT_EQ(frame.return_count[2 * 5 + 2], 0U);
  EXPECT_FLOAT_EQ(frame.range_m[0], std::sqrt(101.0F));
  EXPECT_TRUE(std::isnan(frame.power_ratio[0]));
  EXPECT_THAT(frames[0].fields,
              testing::UnorderedElementsAre("x", "y", "z", "intensity", "range_m", "ring", "column",
                                            "return_index", "return_count"));
}

/// A turn of 4 rings and 90 columns: x y z i ring time, as Velodyne drivers write it.
std::vector<std::string> RingLines() {
  std::vector<std::string> lines;
  for (int column = 0; column < 90; ++column) {
    const double azimuth_rad = -RadFromDeg(4.0 * column);
    for (int ring = 0; ring < 4; ++ring) {
      lines.push_back(std::to_string(20.0 * std::cos(azimuth_rad)) + " " +
                      std::to_string(20.0 * std::sin(azimuth_rad)) + " " + std::to_string(-ring) +
                      " " + std::to_string(ring) + " " + std::to_string(ring) + " " +
                      std::to_string(0.001 * column));
    }
  }
  return lines;
}

TEST(CloudRecording, MakesATableOfAForeignCloudWithRings) {
  for (const char* ring_name : {"ring", "channel", "laser", "line"}) {
    const std::string fields = std::string("x y z reflectivity ") + ring_name + " time";
    const RecordedFrame recorded =
        ReadText("a.pcd", AsciiPcd(fields, "8 8 8 1 2 4", "F F F U U F", RingLines()));
    const Frame& frame = recorded.frame;
    EXPECT_TRUE(recorded.is_grid);
    EXPECT_EQ(frame.rows, 4U);
    EXPECT_EQ(frame.columns, 90U);
    // Ring 3 of the file is the lowest.
    EXPECT_EQ(frame.intensity[0], 3.0F);
    EXPECT_EQ(frame.ring[0], 0U);
    EXPECT_EQ(frame.time_ns[0], 0U);
    // 0.089 s rounded to float32.
    EXPECT_NEAR(frame.time_ns[89], 89'000'000, 4);
    EXPECT_NEAR(frame.duration_ns, 89'000'000, 4);
    EXPECT_TRUE(recorded.Has("time_ns"));
  }
}

// 2 ms and 2 s from point to point: a scan and a drive.
TEST(CloudRecording, TakesMicrosecondsOfTheCalendarForNothingElse) {
  for (const std::int64_t step_us : {2'000, 2'000'000}) {
    std::vector<std::string> lines;
    for (int i = 0; i < 50; ++i) {
      lines.push_back("1 2 " + std::to_string(i) + " " +
                      std::to_string(1'700'000'000'000'000 + step_us * i));
    }
    const RecordedFrame recorded =
        ReadText("a.pcd", AsciiPcd("x y z timestamp", "4 4 4 8", "F F F U", lines));
    EXPECT_EQ(recorded.Has("time_ns"), step_us == 2'000);
    EXPECT_EQ(recorded.frame.duration_ns, step_us == 2'000 ? 98'000'000U : 0U);
  }
}

TEST(CloudRecording, OfOneColumnIsReadAsOfOneRow) {
  const auto lines = RingLines();
  std::string text = AsciiPcd("x y z i ring time", "8 8 8 1 2 4", "F F F U U F", lines);
  for (const auto& [row, column] :
       {std::pair("\nWIDTH ", "\nHEIGHT "), {"\nHEIGHT 1\n", "\nWIDTH 1\n"}}) {
    text.replace(text.find(row), std::string_view(row).size(), column);
  }
  const Frame frame = ReadText("a.pcd", text).frame;
  EXPECT_EQ(frame.rows, 4U);
  EXPECT_EQ(frame.columns, 90U);
}

TEST(CloudRecording, TakesNoTimeWhoseUnitIsUncertain) {
  std::vector<std::string> lines;
  for (int i = 0; i < 50; ++i)
    lines.push_back("1 2 " + std::to_string(i) + " " + std::to_string(i));
  // A span of 49 is no plausible scan duration in seconds.
  EXPECT_FALSE(
      ReadText("a.pcd", AsciiPcd("x y z time", "4 4 4 4", "F F F F", lines)).Has("time_ns"));
  EXPECT_FALSE(ReadText("a.pcd", AsciiPcd("x y z t", "4 4 4 4", "F F F U", lines)).Has("time_ns"));
  for (int i = 0; i < 50; ++i) lines[static_cast<std::size_t>(i)] += "000000";
  EXPECT_TRUE(ReadText("a.pcd", AsciiPcd("x y z t", "4 4 4 4", "F F F U", lines)).Has("time_ns"));
}

TEST(CloudRecording, HasOneRowOfPointsWhereThereAreNoRings) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nproperty int scalar_label\nproperty int instance\nend_header\n"
      "1 2 3 7 1\nnan 0 0 8 2\n0 0 0 9 3\n4 5 6 10 4\n";
  const RecordedFrame recorded = ReadText("a.ply", text);
  EXPECT_FALSE(recorded.is_grid);
  EXPECT_EQ(recorded.frame.rows, 1U);
  EXPECT_EQ(recorded.frame.columns, 2U);
  EXPECT_THAT(recorded.frame.x, testing::ElementsAre(1.0F, 4.0F));
  EXPECT_THAT(recorded.frame.label, testing::ElementsAre(7U, 10U));
  EXPECT_THAT(recorded.frame.instance, testing::ElementsAre(1U, 4U));
  EXPECT_FLOAT_EQ(recorded.frame.range_m[0], std::sqrt(14.0F));
  EXPECT_THAT(recorded.fields,
              testing::UnorderedElementsAre("x", "y", "z", "label", "instance", "range_m"));
}

TEST(CloudRecording, HasNoGridWherePointsAreOfSeveralSensors) {
  // Ring 0 and column 0 of each.
  const std::vector<std::string> lines = {"1 2 3 0 0 0", "4 5 6 0 0 1"};
  const RecordedFrame recorded = ReadText(
      "a.pcd", AsciiPcd("x y z ring column sensor_index", "4 4 4 2 4 1", "F F F U U U", lines));
  EXPECT_FALSE(recorded.is_grid);
  EXPECT_THAT(recorded.frame.x, testing::ElementsAre(1.0F, 4.0F));
  ASSERT_EQ(recorded.foreign.size(), 1U);
  EXPECT_EQ(recorded.foreign[0].name, "sensor_index");
  EXPECT_THAT(recorded.foreign[0].values, testing::ElementsAre(0.0F, 1.0F));
}

TEST(CloudRecording, ReadsWhatPclWritesAsPly) {
  pcl::PointCloud<pcl::PointXYZL> cloud;
  for (std::uint32_t i = 1; i <= 3; ++i) {
    pcl::PointXYZL point;
    point.x = static_cast<float>(i);
    point.y = point.z = 0.5F;
    point.label = 10 * i;
    cloud.push_back(point);
  }
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.ply";
  ASSERT_EQ(pcl::io::savePLYFileBinary(file.string(), cloud), 0);
  const auto frames = ReadAll(file);
  EXPECT_THAT(frames.at(0).frame.x, testing::ElementsAre(1.0F, 2.0F, 3.0F));
  EXPECT_THAT(frames[0].frame.label, testing::ElementsAre(10U, 20U, 30U));
}

TEST(CloudRecording, ReadsWhatOpen3dWrites) {
  if (!HasOpen3d()) GTEST_SKIP() << "python3-open3d is not installed";
  const TemporaryDirectory directory;
  for (const std::string name : {"a.pcd", "a.ply"}) {
    const auto file = directory.path() / name;
    const std::string command =
        "/usr/bin/python3 -c \"import open3d as o, numpy as n; "
        "p = o.t.geometry.PointCloud(n.arange(9, dtype=n.float32).reshape(3, 3) + 1); "
        "p.point['intensity'] = o.core.Tensor(n.array([[1], [2], [3]], n.float32)); "
        "o.t.io.write_point_cloud('" +
        file.string() + "', p)\" >/dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto frames = ReadAll(file);
    EXPECT_THAT(frames.at(0).frame.z, testing::ElementsAre(3.0F, 6.0F, 9.0F)) << name;
    EXPECT_THAT(frames[0].frame.intensity, testing::ElementsAre(1.0F, 2.0F, 3.0F)) << name;
  }
}

TEST(CloudRecording, OfOneFrameOfOursHasItsSlots) {
  const Frame truth = ExampleFrame(3, 6, 41);
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "a.pcd", PcdBytes(truth));
  WriteFileWhole(directory.path() / "b.ply", PlyBytes(truth));
  const auto frames = ReadAll(directory.path());
  ASSERT_EQ(frames.size(), 2U);
  for (const RecordedFrame& recorded : frames) {
    const Frame& frame = recorded.frame;
    EXPECT_TRUE(recorded.is_grid);
    ASSERT_EQ(frame.rows, 6U);
    ASSERT_EQ(frame.columns, 41U);
    for (std::size_t i = 0; i < frame.num_slots(); ++i) {
      ASSERT_EQ(frame.ring[i], truth.ring[i]);
      ASSERT_EQ(std::isnan(frame.x[i]), !HasPoint(truth.outcome[i]));
      if (!HasPoint(truth.outcome[i])) continue;
      ASSERT_EQ(frame.x[i], truth.x[i]);
      ASSERT_EQ(frame.material[i], truth.material[i]);
    }
  }
  EXPECT_EQ(frames[0].frame.outcome, truth.outcome);
}

TEST(CloudRecording, TakesTheFilesOfADirectoryInNaturalOrder) {
  const TemporaryDirectory directory;
  for (const char* name : {"scan10.ply", "scan9.ply", "scan09b.ply", "scan100.ply", "a.txt"}) {
    WriteFileWhole(directory.path() / name,
                   "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n1 2 3\n");
  }
  const auto recording = OpenRecording(directory.path());
  EXPECT_EQ(recording->info().kind, "directory of point clouds");
  EXPECT_EQ(recording->info().num_frames, 3U);
  std::vector<std::string> names;
  for (const RecordedFrame& recorded : ReadAll(*recording)) {
    names.push_back(std::filesystem::path(recorded.name).filename());
    EXPECT_EQ(recorded.frame.index, names.size() - 1);
  }
  // scan09b is of another series.
  EXPECT_THAT(names, testing::ElementsAre("scan9.ply", "scan10.ply", "scan100.ply"));
}

TEST(CloudRecording, OfAReceivedStreamHasItsPoses) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory.path() / "frames");
  WriteFileWhole(directory.path() / "frames/000000.pcd", PcdBytes(ExampleFrame(0)));
  const std::string header = "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost_points\n";
  WriteFileWhole(directory.path() / "frames.csv",
                 header + "frames/000000.pcd,7,12,1200000000,5,6,7,0,0,1,0,54,0\n");
  const auto recording = OpenRecording(directory.path());
  EXPECT_EQ(recording->info().kind, "received stream");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].has_pose);
  EXPECT_EQ(frames[0].frame.index, 12U);
  EXPECT_EQ(frames[0].frame.stamp_ns, 1'200'000'000);
  EXPECT_EQ(frames[0].frame.world_from_sensor.translation(), Vector3(5.0, 6.0, 7.0));
  EXPECT_EQ(frames[0].frame.world_from_sensor_end.translation(), Vector3(5.0, 6.0, 7.0));
  WriteFileWhole(directory.path() / "frames.csv",
                 header + "frames/000000.pcd,7,12,1200000000,5,6,7,0,0,1,0,54,0," +
                     "99000000,8,6.5,7,0,0,0,1\n");
  const Frame moving = ReadAll(directory.path()).at(0).frame;
  EXPECT_EQ(moving.duration_ns, 99'000'000U);
  EXPECT_EQ(moving.world_from_sensor.translation(), Vector3(5.0, 6.0, 7.0));
  EXPECT_EQ(moving.world_from_sensor_end.translation(), Vector3(8.0, 6.5, 7.0));
  EXPECT_EQ(moving.world_from_sensor_end.linear(), Eigen::Matrix3d::Identity());
  // Times of arrival, with and without a pose at the last firing.
  for (const std::string end : {"99000000,8,6.5,7,0,0,0,1", ",,,,,,,"}) {
    WriteFileWhole(directory.path() / "frames.csv",
                   header + "frames/000000.pcd,7,12,1200000000,5,6,7,0,0,1,0,54,0," + end +
                       ",1795000000000000000,1795000000090000000,\n");
    EXPECT_EQ(ReadAll(directory.path()).at(0).frame.duration_ns,
              end.starts_with(',') ? 0U : 99'000'000U);
  }
  for (const char* line : {"7,12,x,5", "7,12,1200000000,,6,7,0,0,1,0,54,0"}) {
    WriteFileWhole(directory.path() / "frames.csv", header + "frames/000000.pcd," + line + "\n");
    EXPECT_EQ(MessageOf([&] { (void)ReadAll(directory.path()); }),
              directory.path().string() +
                  "/frames.csv:2: must be a line as railcast-analyze receive writes it");
  }
}

TEST(CloudRecording, ReadsAKittiSequence) {
  const TemporaryDirectory directory;
  const auto made = MakeSequence(directory.path() / "run", {.format = "kitti"});
  const auto recording = OpenRecording(directory.path() / "run");
  EXPECT_EQ(recording->info().kind, "KITTI sequence");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 2U);
  std::vector<std::uint32_t> labels;
  for (std::size_t i = 0; i < made.frames[0].num_slots(); ++i) {
    if (!HasPoint(made.frames[0].outcome[i])) continue;
    labels.push_back(
        LabelTable(made.scenario.labels).Find(made.frames[0].label[i])->semantic_kitti);
  }
  std::vector<std::uint32_t> found;
  const Frame& frame = frames[0].frame;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isnan(frame.x[i])) found.push_back(frame.label[i]);
  }
  std::ranges::sort(labels);
  std::ranges::sort(found);
  EXPECT_EQ(found, labels);
}

TEST(CloudRecording, LeavesOutFieldsWhoseValuesCannotBe) {
  const TemporaryDirectory folder;
  const auto remark_of = [&](const std::string& field, const char* type, const std::string& value) {
    const auto file = folder.path() / "a.pcd";
    WriteFileWhole(file, AsciiPcd("x y z " + field, "4 4 4 4", std::string("F F F ") + type,
                                  {"1 2 3 " + value, "1 2 4 0"}));
    const RecordedFrame frame = MakeCloudFrame(ReadCloud(file), "a.pcd");
    EXPECT_EQ(frame.Has(field), frame.is_grid && field == "ring") << field;
    return frame.remarks.size() == 1 ? frame.remarks[0].detail : "";
  };
  const std::string rule = "label: must be a whole number from 0 to 4294967295 (got ";
  EXPECT_EQ(remark_of("label", "I", "-1"), rule + "-1)");
  EXPECT_EQ(remark_of("label", "F", "0.5"), rule + "0.5)");
  EXPECT_EQ(remark_of("label", "F", "nan"), rule + "nan)");
  EXPECT_EQ(remark_of("label", "U", "wagon"), "label: no value of its type (got wagon)");
  EXPECT_EQ(remark_of("outcome", "U", "11"),
            "outcome: must be a whole number from 0 to 10 (got 11)");
  EXPECT_EQ(remark_of("ring", "I", "-1"), "ring: must be a whole number from 0 to 65535 (got -1)");
}

TEST(CloudRecording, NamesWhatIsWrongWithAFile) {
  EXPECT_EQ(MessageOfText("a.pcd", AsciiPcd("x y q", "4 4 4", "F F F", {"1 2 3"})),
            "has no field z");
  const std::vector<std::string> twice = {"1 2 3 0 5", "1 2 4 1 5", "1 2 5 0 5"};
  EXPECT_EQ(MessageOfText("a.pcd", AsciiPcd("x y z ring column", "4 4 4 2 4", "F F F U U", twice)),
            "point 2: must be the only one of its ring, column and return_index (got 0, 5, 0)");
  EXPECT_EQ(MessageOfText("a.pcd", AsciiPcd("x y z ring column", "4 4 4 2 4", "F F F U U",
                                            {"1 2 3 999 99999999"})),
            "ring, column: must make no more than 1048577 slots (got 1000 x 100000000 x 1)");
  EXPECT_EQ(MessageOfText("a.bin", std::string(17, 'a')),
            "must have 16 bytes for each point (got 17)");
  EXPECT_EQ(MessageOfText("a.txt", ""), "must have lines of numbers");
  EXPECT_EQ(MessageOfText("a.dat", ""),
            "must be a directory or a .pcd, .ply, .bin, .las, .xyz, .pts, .asc, .pc, .txt, .csv, "
            ".pcap, .pcapng, .mcap or .db3 file");
}

TEST(OpenRecording, NamesADirectoryOrFileThatIsNoRecording) {
  const TemporaryDirectory directory;
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(directory.path()); }),
            directory.path().string() +
                ": must be a sequence or hold .pcd, .ply, .bin, .las, .xyz, .pts, .asc or .pc "
                "files (got neither)");
  const auto missing = directory.path() / "missing";
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(missing); }),
            missing.string() + ": no such file or directory");
}

}  // namespace
}  // namespace railcast
