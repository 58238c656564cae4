#include "core/extras/ros/recording/tf_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/support/clouds.h"

namespace railcast {
namespace {

constexpr std::int64_t kTenth_ns = kSecond_ns / 10;

ros::RosTransform At(double x_m, double y_m = 0.0) {
  return {{x_m, y_m, 0.0}, {}};
}

/// What a bag's frames and its remarks say.
struct ReadBag {
  std::vector<double> x_m;  ///< Of the sensor; NaN without a pose.
  std::vector<std::string> remarks;
};

ReadBag Read(const std::filesystem::path& source) {
  const auto recording = OpenRecording(source);
  ReadBag read;
  for (const RecordedFrame& frame : ReadAll(*recording)) {
    read.x_m.push_back(frame.has_pose ? frame.frame.world_from_sensor.translation().x()
                                      : std::nan(""));
  }
  for (const Remark& remark : recording->info().remarks->List()) {
    read.remarks.push_back(std::string(remark.type().name) + " " + std::to_string(remark.number) +
                           ": " + remark.detail);
  }
  return read;
}

using Texts = std::vector<std::string>;
using Metres = std::vector<double>;

void ExpectMetres(const Metres& found, const Metres& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_same =
        std::isnan(expected[i]) ? std::isnan(found[i]) : std::abs(found[i] - expected[i]) < 1e-6;
    EXPECT_TRUE(is_same) << i << ": " << found[i] << ", not " << expected[i];
  }
}

const double kNone = std::nan("");

/// Adds a cloud each second, at 0.5 s, 1.5 s, ...
void AddClouds(const std::string& topic, int num, std::int64_t ahead_ns, MadeBag& bag) {
  for (int i = 0; i < num; ++i) {
    const std::int64_t time_ns = i * kSecond_ns + kSecond_ns / 2;
    bag.Add(topic, time_ns, CloudOf(kBagPoints, time_ns + ahead_ns));
  }
}

TEST(TfPoses, AreOfTheNamespaceOfTheClouds) {
  for (const BagKind kind : {BagKind::kMcap, BagKind::kRosbag2}) {
    for (const std::string clouds : {"/a/points", "/a/lidar/front/points", "/points"}) {
      MadeBag bag(kind);
      for (int i = 0; i < 4; ++i) {
        bag.Link("/tf", "odom", "lidar", i * kSecond_ns, At(1.0 * i));
        bag.Link("/a/tf", "odom", "lidar", i * kSecond_ns, At(100.0 + i));
        bag.Link("/b/tf", "odom", "lidar", i * kSecond_ns, At(200.0 + i));
      }
      AddClouds(clouds, 2, 0, bag);
      const ReadBag read = Read(bag.Closed());
      const bool is_global = clouds == "/points";
      ExpectMetres(read.x_m, is_global ? Metres{0.5, 1.5} : Metres{100.5, 101.5});
      EXPECT_EQ(read.remarks,
                Texts{is_global ? "transforms-elsewhere 2: /a/tf, /b/tf; the clouds' are /tf"
                                : "transforms-elsewhere 2: /tf, /b/tf; the clouds' are /a/tf"});
    }
  }
}

TEST(TfPoses, AreNotTakenFromAnotherNamespace) {
  MadeBag bag;
  for (int i = 0; i < 4; ++i) bag.Link("/b/tf", "map", "lidar", i * kSecond_ns, At(i));
  AddClouds("/a/points", 1, 0, bag);
  const ReadBag read = Read(bag.Closed());
  ExpectMetres(read.x_m, {kNone});
  EXPECT_EQ(read.remarks, Texts{"transforms-elsewhere 1: /b/tf"});
}

// Of two or three vehicles, whose transforms come in turns, also at the same times.
TEST(TfPoses, AreNotKnownBetweenTransformsThatJump) {
  for (const double apart_m : {5.0, 80.0}) {
    for (const int num_vehicles : {2, 3}) {
      for (const bool is_at_once : {false, true}) {
        MadeBag bag;
        for (int i = 0; i < 30 * num_vehicles; ++i) {
          const int vehicle = i % num_vehicles;
          const std::int64_t time_ns = (is_at_once ? i - vehicle : i) * kTenth_ns / num_vehicles;
          bag.Link("/tf", "map", "lidar", time_ns, At(1e-9 * double(time_ns), vehicle * apart_m));
        }
        AddClouds("/points", 2, kTenth_ns / 50, bag);
        const ReadBag read = Read(bag.Closed());
        ExpectMetres(read.x_m, {kNone, kNone});
        ASSERT_EQ(read.remarks.size(), 1U) << apart_m << num_vehicles << is_at_once;
        EXPECT_TRUE(read.remarks[0].starts_with("poses-jumped 2: ")) << read.remarks[0];
        EXPECT_TRUE(read.remarks[0].ends_with(" of /tf")) << read.remarks[0];
      }
    }
  }
}

TEST(TfPoses, SayHowFarTransformsJump) {
  MadeBag bag;
  for (int i = 0; i < 20; ++i) {
    bag.Link("/tf", "map", "lidar", i * kTenth_ns, At(i < 10 ? 0.0 : 30.0));
  }
  bag.Add("/points", 0, CloudOf(kBagPoints, 0));
  bag.Add("/points", 9 * kTenth_ns, CloudOf(kBagPoints, 9 * kTenth_ns + kTenth_ns / 2));
  bag.Add("/points", 15 * kTenth_ns, CloudOf(kBagPoints, 15 * kTenth_ns));
  const ReadBag read = Read(bag.Closed());
  ExpectMetres(read.x_m, {0.0, kNone, 30.0});
  EXPECT_EQ(read.remarks, Texts{"poses-jumped 1: 30 m in 0.1 s of /tf"});
}

// A train at 80 m/s, and one that starts and stops.
TEST(TfPoses, AreKnownAtAnySpeedOfATrain) {
  for (const bool is_fast : {true, false}) {
    MadeBag bag;
    double x_m = 0.0;
    for (int i = 0; i < 61; ++i) {
      bag.Link("/tf", "map", "lidar", i * kSecond_ns / 2, At(x_m));
      x_m += is_fast ? 40.0 : std::max(0.0, 10.0 - 0.5 * std::abs(i - 30));
    }
    AddClouds("/points", 30, 0, bag);
    const ReadBag read = Read(bag.Closed());
    for (const double at_m : read.x_m) EXPECT_FALSE(std::isnan(at_m)) << is_fast;
    EXPECT_EQ(read.remarks, Texts{});
  }
}

struct ClockCase {
  double ahead_s;  ///< The clock of the clouds.
  bool is_known;
  const char* remark;
};

TEST(TfPoses, AreThoseOfTheTimesOnTheirClock) {
  for (const auto& [ahead_s, is_known, remark] : std::vector<ClockCase>{
           {0.0, true, ""},
           {0.9, true, ""},
           {37.0, true, "clocks-shifted 3: 37 s ahead, as between TAI and UTC"},
           {-18.0, true, "clocks-shifted 3: 18 s behind, as between GPS and UTC"},
           {19.0, true, "clocks-shifted 3: 19 s ahead, as between TAI and GPS"},
           {7200.0, true, "clocks-shifted 3: 7200 s ahead, as between two zones of time"},
           {-19800.0, true, "clocks-shifted 3: 19800 s behind, as between two zones of time"},
           {5.5, false, "clocks-differ 3: 5.45 s ahead, which no two known clocks are apart"},
           {-1.7e9, false,
            "clocks-differ 3: 1.7e+09 s behind, which no two known clocks are apart"}}) {
    for (const BagKind kind : {BagKind::kMcap, BagKind::kRosbag2}) {
      MadeBag bag(kind);
      const std::int64_t begin_ns = 1'700'000'000 * kSecond_ns;
      const auto ahead_ns = static_cast<std::int64_t>(ahead_s * double(kSecond_ns));
      for (int i = 0; i < 120; ++i) {
        bag.Link("/tf", "map", "lidar", begin_ns + i * kSecond_ns, At(10.0 * i));
      }
      for (int i = 50; i < 53; ++i) {  // Got 50 ms after their stamps.
        const std::int64_t stamp_ns = begin_ns + i * kSecond_ns;
        bag.Add("/points", stamp_ns + kTenth_ns / 2, CloudOf(kBagPoints, stamp_ns + ahead_ns));
      }
      const ReadBag read = Read(bag.Closed());
      const double by_m = std::abs(ahead_s) < 1.0 ? 10.0 * ahead_s : 0.0;
      ExpectMetres(read.x_m, is_known ? Metres{500.0 + by_m, 510.0 + by_m, 520.0 + by_m}
                                      : Metres{kNone, kNone, kNone});
      EXPECT_EQ(read.remarks, *remark == '\0' ? Texts{} : Texts{remark}) << ahead_s;
    }
  }
}

// Of localisation that was run later on the recorded clouds, or that was recorded before them.
TEST(TfPoses, AreKnownOfAReplayWithTheStampsOfTheClouds) {
  struct Replay {
    double later_s;
    bool is_known;
  };
  const std::int64_t begin_ns = 1'700'000'000 * kSecond_ns;
  for (const auto& [later_s, is_known] : std::vector<Replay>{
           {1000.0, true}, {86'400.0, true}, {31.5e6, true}, {-7200.0, true}, {60.0, false}}) {
    for (const int first : {0, 30}) {  // Of the clouds, in s.
      MadeBag bag;
      for (int i = 0; i < 60; ++i) {
        const std::int64_t stamp_ns = begin_ns + i * kSecond_ns;
        bag.Add("/tf", stamp_ns + static_cast<std::int64_t>(later_s * double(kSecond_ns)),
                ros::TfMessage{{{{TimeAt(stamp_ns), "map"}, "lidar", At(10.0 * i)}}});
      }
      for (int i = first; i < first + 29; ++i) {
        const std::int64_t stamp_ns = begin_ns + i * kSecond_ns;
        bag.Add("/points", stamp_ns, CloudOf(kBagPoints, stamp_ns));
      }
      const ReadBag read = Read(bag.Closed());
      ASSERT_EQ(read.x_m.size(), 29U);
      EXPECT_EQ(std::isnan(read.x_m[4]), !is_known) << later_s;
      if (is_known) {
        EXPECT_NEAR(read.x_m[4], 10.0 * (first + 4), 1e-6);
      }
      EXPECT_EQ(read.remarks.empty(), is_known) << later_s;
    }
  }
}

// The times at which messages were got say nothing where they stand still.
TEST(TfPoses, DoNotTellClocksApartByTimesThatNobodyNoted) {
  EXPECT_EQ(AheadOf({}), std::nullopt);
  EXPECT_EQ(AheadOf({5e9, 6e9, 7e9}), std::nullopt);
  EXPECT_EQ(AheadOf({37e9, 37.01e9, 99e9}), 37.01e9);
}

TEST(TfPoses, LeaveOutTransformsThatAreNone) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [invalid, fault] : std::vector<std::pair<ros::RosTransform, std::string>>{
           {{{kNaN, 0, 0}, {}}, "a position that is none"},
           {{{5, 0, 0}, {0, 0, 0, 0}}, "a quaternion of length 0"},
           {{{5, 0, 0}, {kNaN, 0, 0, 1}}, "a quaternion of length nan"},
           {{{5, 0, 0}, {0, 0, 0, 0.5}}, "a quaternion of length 0.5"}}) {
    for (const BagKind kind : {BagKind::kMcap, BagKind::kRosbag2}) {
      MadeBag bag(kind);
      bag.Link("/tf_static", "base_link", "lidar", 0, At(2.0));
      bag.Link("/tf_static", "base_link", "lidar", 0, invalid);
      for (int i = 0; i < 4; ++i) {
        bag.Link("/tf", "map", "base_link", i * kSecond_ns, i == 1 ? invalid : At(i));
      }
      AddClouds("/points", 2, 0, bag);
      const ReadBag read = Read(bag.Closed());
      ExpectMetres(read.x_m, {2.5, 3.5});
      EXPECT_EQ(read.remarks, Texts{"transforms-invalid 2: \"lidar\": " + fault});
    }
  }
}

TEST(TfPoses, FollowTheTreeInBothDirections) {
  for (const std::string fixed : {"map", "world", "robot1/odom"}) {
    MadeBag bag;
    bag.Link("/tf_static", "lidar", "base_link", 0, {{-2.0, 0, 0}, {}});
    bag.Link("/tf_static", "base_link", "imu_link", 0, At(7.0));
    const double half = std::sqrt(0.5);
    for (int i = 0; i < 4; ++i) {
      // Of a vehicle at x = i m, turned to the left.
      bag.Link("/tf", "base_link", fixed, i * kSecond_ns, {{0, 1.0 * i, 0}, {0, 0, -half, half}});
    }
    AddClouds("/points", 3, 0, bag);
    const auto frames = ReadAll(bag.Closed());
    ASSERT_EQ(frames.size(), 3U);
    for (int i = 0; i < 3; ++i) {
      const RecordedFrame& frame = frames[static_cast<std::size_t>(i)];
      ASSERT_TRUE(frame.has_pose) << fixed;
      EXPECT_TRUE(
          frame.frame.world_from_sensor.translation().isApprox(Vector3(0.5 + i, 2.0, 0.0), 1e-9));
    }
  }
}

TEST(TfPoses, SayWhyThereAreNone) {
  for (const auto& [frame_id, reason] : std::vector<std::pair<std::string, std::string>>{
           {"", "the clouds have no frame_id"},
           {"radar", "no transform leads to \"radar\""},
           {"wheel", "nothing moves \"mast\""}}) {
    MadeBag bag;
    bag.Link("/tf_static", "mast", "lidar", 0, At(2.0));
    for (int i = 0; i < 3; ++i) bag.Link("/tf", "map", "base_link", i * kSecond_ns, At(i));
    auto cloud = CloudOf(kBagPoints, kSecond_ns);
    cloud.header.frame_id = frame_id == "wheel" ? "mast" : frame_id;
    bag.Add("/points", kSecond_ns, cloud);
    const ReadBag read = Read(bag.Closed());
    ExpectMetres(read.x_m, {kNone});
    const std::string linked = frame_id == "wheel" ? ", nor is it linked to a fixed frame" : "";
    EXPECT_EQ(read.remarks, Texts{"poses-unknown 1: " + reason + linked +
                                  "; frames of /tf_static, /tf: base_link, lidar, map, mast"});
  }
}

// Named so, or by the transforms: what travels below it is a vehicle.
TEST(TfPoses, AreNoneOfCloudsInAFixedFrame) {
  for (const auto& [frame_id, is_fixed] :
       std::vector<std::pair<std::string, bool>>{{"map", true},
                                                 {"/odom", true},
                                                 {"robot1/World", true},
                                                 {"camera_init", true},
                                                 {"yard", true},
                                                 {"base_link", false},
                                                 {"wheel", false}}) {
    for (const BagKind kind : {BagKind::kMcap, BagKind::kRosbag2}) {
      MadeBag bag(kind);
      for (int i = 0; i < 3; ++i) {
        bag.Link("/tf", "yard", "base_link", i * kSecond_ns, At(40.0 + i));
        bag.Link("/tf", "base_link", "wheel", i * kSecond_ns, At(1.0));
      }
      auto cloud = CloudOf(kBagPoints, kSecond_ns);
      cloud.header.frame_id = frame_id;
      bag.Add("/points", kSecond_ns, cloud);
      const auto recording = OpenRecording(bag.Closed());
      const auto frames = ReadAll(*recording);
      EXPECT_EQ(frames.at(0).has_pose, !is_fixed) << frame_id;
      EXPECT_EQ(frames.at(0).why_no_ranges.empty(), !is_fixed) << frame_id;
      EXPECT_EQ(RemarkTexts(recording->info().remarks->List()),
                is_fixed ? Texts{"ranges-unknown 1"} : Texts{});
    }
  }
}

/// A turn of 8 rings, seen from a sensor at some place.
ros::PointCloud2 TurnFrom(double x_m, const std::string& frame_id) {
  constexpr int kColumns = 360;
  std::vector<std::array<float, 3>> points;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth_rad = -2.0 * std::numbers::pi * column / kColumns;
    for (int ring = 0; ring < 8; ++ring) {
      const double elevation_rad = 0.03 * ring;
      const double level_m = 20.0 + 5.0 * std::sin(3.0 * azimuth_rad);
      points.push_back({static_cast<float>(x_m + level_m * std::cos(azimuth_rad)),
                        static_cast<float>(level_m * std::sin(azimuth_rad)),
                        static_cast<float>(level_m * std::tan(elevation_rad))});
    }
  }
  ros::PointCloud2 cloud = CloudOf(points, 0);
  cloud.header.frame_id = frame_id;
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.data[17 * i + 15] = static_cast<std::uint8_t>(i % 8);
    cloud.data[17 * i + 16] = 0;
  }
  return cloud;
}

// Raw turns are sent as of "map" to be shown; without transforms nothing says where it is.
TEST(TfPoses, AreNotMissedByRawTurnsThatAreCalledFixed) {
  for (const std::string frame_id : {"map", "world", "robot1/odom"}) {
    for (const double x_m : {0.0, 12.0}) {
      for (const bool has_transforms : {false, true}) {
        MadeBag bag;
        if (has_transforms) bag.Link("/b/tf", "base_link", "lidar", 0, At(0.0));
        bag.Add("/a/points", 0, TurnFrom(x_m, frame_id));
        const RecordedFrame frame = ReadAll(bag.Closed()).at(0);
        const bool is_raw = x_m == 0.0 && !has_transforms;
        EXPECT_EQ(frame.is_grid, is_raw) << frame_id << x_m;
        EXPECT_EQ(frame.why_no_ranges.empty(), is_raw) << frame_id << x_m;
        EXPECT_EQ(frame.frame.rows, is_raw ? 8U : 1U);
      }
    }
  }
}

}  // namespace
}  // namespace railcast
