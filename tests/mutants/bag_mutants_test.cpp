#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/mutants/made_scan_points.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

constexpr std::int64_t kFirst_ns = 1'700'000'000 * kSecond_ns;
constexpr std::size_t kMessages = 3;

/// The scan as a message, with times since the stamp as float64 in seconds.
ros::PointCloud2 ScanMessage(std::size_t number, const std::vector<ScanPoint>& points) {
  const std::string rows = BinaryRows(points);
  const auto stamp_ns = kFirst_ns + static_cast<std::int64_t>(number) * kSecond_ns / 10;
  return {.header = {TimeAt(stamp_ns), "lidar"},
          .height = 1,
          .width = static_cast<std::uint32_t>(points.size()),
          .fields = {{"x", 0, 7, 1},
                     {"y", 4, 7, 1},
                     {"z", 8, 7, 1},
                     {"intensity", 12, 7, 1},
                     {"ring", 16, 4, 1},
                     {"time", 18, 8, 1}},
          .is_bigendian = false,
          .point_step = kRow_bytes,
          .row_step = static_cast<std::uint32_t>(rows.size()),
          .data = {rows.begin(), rows.end()},
          .is_dense = true};
}

using Change = std::function<void(std::size_t number, ros::PointCloud2& message)>;

/// A bag of three turns, of which the sensor moves 1 m each.
/// @param point Of which the points are made.
std::string BagBytes(const Change& change = {},
                     const std::function<void(ScanPoint&)>& point = {},
                     const std::string& type = std::string(ros::PointCloud2::kName)) {
  MadeBag bag;
  for (std::size_t i = 0; i < kMessages; ++i) {
    const auto time_ns = kFirst_ns + static_cast<std::int64_t>(i) * kSecond_ns / 10;
    bag.Link("/tf", "map", "lidar", time_ns,
             {{static_cast<double>(i), 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}});
    std::vector<ScanPoint> points = MakeScanPoints(static_cast<double>(i));
    if (point)
      for (ScanPoint& one : points) point(one);
    ros::PointCloud2 message = ScanMessage(i, points);
    if (change) change(i, message);
    bag.Add("/points", time_ns + kSecond_ns / 100, message, type);
  }
  return ReadFileWhole(bag.Closed());
}

void TryMessages(Mutants& mutants) {
  const auto each = [&](const std::string& what, const std::string& detail,
                        const std::function<void(ros::PointCloud2&)>& change) {
    mutants.Try(what + " in one message", detail, BagBytes([&](std::size_t i, auto& message) {
                  if (i == 1) change(message);
                }));
    mutants.Try(what, detail, BagBytes([&](std::size_t, auto& message) { change(message); }));
  };
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::uint8_t type = 0; type < 12; ++type) {
      each("type of a field changed", NumberText(i) + " " + NumberText(type),
           [&](auto& message) { message.fields[i].datatype = type; });
    }
    for (const std::uint32_t offset :
         {0U, 1U, 2U, 4U, 8U, 12U, 16U, 18U, 20U, 24U, 26U, 1'000'000U}) {
      each("offset of a field changed", NumberText(i) + " " + NumberText(offset),
           [&](auto& message) { message.fields[i].offset = offset; });
    }
    for (const std::uint32_t count : {0U, 2U, 3U, 100U, 4'000'000'000U}) {
      each("count of a field changed", NumberText(i) + " " + NumberText(count),
           [&](auto& message) { message.fields[i].count = count; });
    }
    for (const std::string name : {"", "X", "x", "other", "time", "ring"}) {
      if (i > 2 && name != "x") continue;
      each("name of a field changed", NumberText(i) + " " + name,
           [&](auto& message) { message.fields[i].name = name; });
    }
  }
  for (const std::uint32_t num : {0U, 1U, 2U, 16U, 25U, 27U, 28U, 32U, 240U, 479U, 481U, 960U,
                                  12'480U, 12'479U, 4'000'000'000U}) {
    each("width changed", NumberText(num), [&](auto& message) { message.width = num; });
    each("height changed", NumberText(num), [&](auto& message) { message.height = num; });
    each("point_step changed", NumberText(num), [&](auto& message) { message.point_step = num; });
    each("row_step changed", NumberText(num), [&](auto& message) { message.row_step = num; });
  }
  for (const int more : {-13'000, -5000, -25, -1, 1, 7, 25, 2600}) {
    each("size of the data changed", NumberText(more), [&](auto& message) {
      const auto size = std::max(0, static_cast<int>(message.data.size()) + more);
      message.data.resize(static_cast<std::size_t>(size), 7);
    });
    each("bytes lost or put in", NumberText(more), [&](auto& message) {
      if (more > 0)
        message.data.insert(message.data.begin() + 2605, static_cast<std::size_t>(more), 7);
      if (more < 0 && more > -6000)
        message.data.erase(message.data.begin() + 2605, message.data.begin() + 2605 - more);
      message.data.resize(12'480);
    });
  }
  each("is_bigendian changed", "", [](auto& message) { message.is_bigendian = true; });
  each("is_dense changed", "", [](auto& message) { message.is_dense = false; });
}

void TryTimes(Mutants& mutants) {
  const auto with = [&](const std::string& what, const std::string& detail, double scale,
                        double first) {
    mutants.Try(what, detail,
                BagBytes({}, [&](ScanPoint& point) { point[5] = first + scale * point[5]; }));
  };
  with("times in milliseconds", "", 1e3, 0.0);
  with("times in microseconds", "", 1e6, 0.0);
  with("times in nanoseconds", "", 1e9, 0.0);
  with("times that are all one", "0", 0.0, 0.0);
  with("times that are all one", "5", 0.0, 5.0);
  for (const double first : {0.5, 10.0, 3600.0, 1e6, 1.6e9}) {
    with("times since something else than the stamp", NumberText(first), 1.0, first);
  }
  with("whole times in seconds", "", 1.0, 1.7e9);
  with("whole times in milliseconds", "", 1e3, 1.7e12);
  with("whole times in microseconds", "", 1e6, 1.7e15);
  for (const std::size_t number : {1U, 2U}) {
    for (const std::int64_t off_ns :
         {-kSecond_ns, -kSecond_ns / 10, kSecond_ns, 3600 * kSecond_ns, -kFirst_ns}) {
      mutants.Try("stamp of a message changed", NumberText(number) + " " + NumberText(off_ns),
                  BagBytes([&](std::size_t i, auto& message) {
                    if (i == number)
                      message.header.stamp = TimeAt(std::max<std::int64_t>(
                          0, kFirst_ns + static_cast<std::int64_t>(i) * kSecond_ns / 10 + off_ns));
                  }));
    }
  }
}

void TryPositions(Mutants& mutants) {
  const auto with = [&](const std::string& what, const std::string& detail,
                        const std::function<void(ScanPoint&)>& change) {
    mutants.Try(what, detail, BagBytes({}, change));
  };
  for (const double scale : {1e3, 1e-3}) {
    with("positions in another unit", NumberText(scale), [&](ScanPoint& point) {
      for (std::size_t axis = 0; axis < 3; ++axis) point.at(axis) *= scale;
    });
  }
  for (const std::string type :
       {"sensor_msgs/msg/PointCloud", "sensor_msgs/PointCloud2", "sensor_msgs/msg/LaserScan",
        "PointCloud2", "my_msgs/msg/PointCloud2", "foxglove.PointCloud", ""}) {
    mutants.Try("name of the type changed", type, BagBytes({}, {}, type));
  }
}

void TryBytes(Mutants& mutants) {
  const std::string& good = mutants.good();
  for (std::size_t place = 0; place < good.size();
       place += place < 700 || place + 2500 > good.size() ? 1 : 53) {
    std::string bytes = good;
    bytes[place] = static_cast<char>(bytes[place] ^ (1U << place % 8));
    mutants.Try("a bit changed", NumberText(place), bytes);
  }
  TryCuts(mutants, good.size() / 150);
}

TEST(BagMutants, OfMcapAreNeverReadWrongWithoutAWord) {
  Mutants mutants("MCAP", "run.mcap", BagBytes(), ReadRecordingWhole);
  TryMessages(mutants);
  TryTimes(mutants);
  TryPositions(mutants);
  TryBytes(mutants);
  constexpr const char* kSmall = "intensities of 8 and 16 bits have any value";
  mutants.Excuse("type of a field changed", kSmall);
  mutants.Excuse("type of a field changed in one message", kSmall);
  mutants.Excuse("stamp of a message changed", "clocks are set, and stamps are what they say");
  CheckSection("Bags", {&mutants});
}

/// The same as a database of rosbag2, in whose tables something is changed.
std::string DatabaseBytes(const std::string& sql = {}) {
  const TemporaryDirectory folder;
  const auto writer = bag::CreateRosbag2(folder.path() / "bag");
  const std::size_t topic = writer->Add(
      {.name = "/points", .type = "sensor_msgs/msg/PointCloud2", .definition = {}, .hash = {}});
  for (std::size_t i = 0; i < kMessages; ++i) {
    const auto cdr = ros::ToCdr(ScanMessage(i, MakeScanPoints(static_cast<double>(i))));
    writer->Write({topic, kFirst_ns + static_cast<std::int64_t>(i) * kSecond_ns / 10, cdr});
  }
  writer->Close();
  const auto file = folder.path() / "bag/bag_0.db3";
  if (!sql.empty()) bag::SqliteDatabase(file, bag::SqliteAccess::kChange, "bag").Run(sql);
  return ReadFileWhole(file);
}

TEST(BagMutants, OfDatabasesAreNeverReadWrongWithoutAWord) {
  Mutants mutants("rosbag2 .db3", "run.db3", DatabaseBytes(), ReadRecordingWhole);
  const auto with = [&](const std::string& what, const std::string& sql) {
    mutants.Try(what, sql, DatabaseBytes(sql));
  };
  for (const char* id : {"1", "2", "3"}) {
    const std::string where = std::string(" WHERE id = ") + id;
    for (const char* size : {"0", "3", "4", "11", "60", "100", "5000", "12600"}) {
      with("data of a message cut",
           "UPDATE messages SET data = substr(data, 1, " + std::string(size) + ")" + where);
    }
    for (const char* more : {"00", "0102030405", "00000000000000000000"}) {
      with("bytes behind the data of a message",
           "UPDATE messages SET data = data || x'" + std::string(more) + "'" + where);
    }
    for (const char* head : {"00000000", "00020000", "00030000", "00060000", "ffffffff"}) {
      with("another encoding of a message",
           "UPDATE messages SET data = x'" + std::string(head) + "' || substr(data, 5)" + where);
    }
    with("a message that is text", "UPDATE messages SET data = 'text'" + where);
    for (const char* topic : {"0", "7", "'x'"}) {
      with("the topic of a message changed",
           "UPDATE messages SET topic_id = " + std::string(topic) + where);
    }
    for (const char* time : {"'x'", "1.5", "-5"}) {
      with("a time that is none", "UPDATE messages SET timestamp = " + std::string(time) + where);
    }
  }
  for (const char* type : {"sensor_msgs/PointCloud2", "sensor_msgs/msg/Image", "my/msg/PointCloud2",
                           "", "sensor_msgs/msg/PointCloud"}) {
    with("the type of a topic changed", "UPDATE topics SET type = '" + std::string(type) + "'");
  }
  for (const char* format : {"cbor", "CDR", "", "ros1"}) {
    with("the encoding of a topic changed",
         "UPDATE topics SET serialization_format = '" + std::string(format) + "'");
  }
  for (const char* sql : {"DROP TABLE topics", "DROP TABLE messages", "DELETE FROM topics",
                          "ALTER TABLE messages RENAME COLUMN data TO bytes",
                          "ALTER TABLE topics RENAME COLUMN type TO kind"}) {
    with("tables changed", sql);
  }
  for (std::size_t size = 1; size < mutants.good().size(); size += 997) {
    mutants.Try("cut off", NumberText(size), mutants.good().substr(0, size));
  }
  CheckSection("Databases", {&mutants});
}

}  // namespace
}  // namespace railcast
