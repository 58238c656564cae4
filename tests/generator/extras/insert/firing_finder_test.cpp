#include "generator/extras/insert/firing_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/extras/packets/spinning/spinning_model.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scenario/sensors.h"
#include "tests/analysis/extras/fit/real_capture.h"
#include "tests/core/extras/packets/hesai/sent_turns.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/found_firings.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

RecordedFirings FindIn(const ScanSpec& scan, RecordedFrame recorded) {
  return FiringFinder({}, scan, false).Find(std::move(recorded));
}

/// The message of the fault behind "NAME: its firings cannot be found: ".
std::string WhyNot(const ScanSpec& scan, const fs::path& file) {
  const std::string message = MessageOf([&] { (void)FindIn(scan, ReadAll(file).at(0)); });
  const std::string place = ShownPath(file) + ": its firings cannot be found: ";
  EXPECT_TRUE(message.starts_with(place)) << message;
  return message.substr(std::min(message.size(), place.size()));
}

/// Every point must be the return of the firing of its cell, in the entry that it was read from.
void ExpectPointsOnTheirBeams(const RecordedFirings& found, double most_deg) {
  const Frame& frame = found.recorded.frame;
  const ScanPattern& pattern = found.pattern;
  double most_rad = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    const std::uint32_t i = found.firing_of_cell.at(slot / frame.returns);
    ASSERT_NE(i, kNoFiring);
    Vector3 way_m(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                  static_cast<double>(frame.z[slot]));
    if (!pattern.origin_x_m.empty()) {
      way_m -= Vector3(static_cast<double>(pattern.origin_x_m[i]),
                       static_cast<double>(pattern.origin_y_m[i]),
                       static_cast<double>(pattern.origin_z_m[i]));
    }
    const Vector3 direction(static_cast<double>(pattern.direction_x[i]),
                            static_cast<double>(pattern.direction_y[i]),
                            static_cast<double>(pattern.direction_z[i]));
    most_rad = std::max(most_rad, std::asin(way_m.normalized().cross(direction).norm()));
  }
  EXPECT_LE(DegFromRad(most_rad), most_deg);
}

struct CloudCase {
  const char* sensor;
  CloudLayout layout;
  double most_without_deg;  ///< Bound on all firings without a return: measured + a tenth.
};

class FiringsOfClouds : public testing::TestWithParam<CloudCase> {};

// Nothing but x, y, z, ring and time, as a driver's cloud has them.
TEST_P(FiringsOfClouds, AreThoseThatTheSensorFired) {
  const auto& [name, layout, most_without_deg] = GetParam();
  const ScanSpec scan = SensorOfTest(name);
  const ScanPattern pattern = BuildScanPattern(scan);
  const std::vector<MadeFiring> truth = FireInThePlain(pattern);
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "cloud.pcd";
  WriteCloudOf(truth, pattern, {.layout = layout}, file);
  RecordedFrame recorded = ReadAll(file).at(0);
  const Frame before = recorded.frame;
  // Turned by half a step, so that the scan of the file is not that of the sensor's file.
  ScanSpec turned = scan;
  std::get<SpinningSpec>(turned.pattern).start_azimuth_deg += 0.07;
  const RecordedFirings found = FindIn(turned, std::move(recorded));
  EXPECT_FALSE(found.are_points_alone);
  EXPECT_EQ(found.pattern.rows, pattern.rows);
  const AimErrors errors = ErrorsOf(truth, found);
  errors.Print(std::string(name) + (layout == CloudLayout::kPoints ? ", points" : ", all slots"));
  EXPECT_LE(AimErrors::Share(errors.with_point_deg, 1.0), 1e-4);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 0.5), 0.5 * most_without_deg + 1e-3);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 1.0), most_without_deg);
  const double ratio =
      static_cast<double>(found.pattern.num_firings()) / static_cast<double>(pattern.num_firings());
  // Whether the last column still fits into the turn is uncertain.
  EXPECT_NEAR(ratio, 1.0, 1.5 / pattern.columns);
  ExpectPointsOnTheirBeams(found, 2e-3);
  // Each slot has the entry that its point came from.
  std::size_t num_points = 0;
  for (std::size_t slot = 0; slot < found.entry_of_slot.size(); ++slot) {
    if (std::isnan(found.recorded.frame.x[slot])) continue;
    ++num_points;
    ASSERT_NE(found.entry_of_slot[slot], kNoEntry);
  }
  EXPECT_EQ(num_points,
            static_cast<std::size_t>(std::ranges::count_if(truth, &MadeFiring::has_point)));
}

INSTANTIATE_TEST_SUITE_P(FiringFinder,
                         FiringsOfClouds,
                         testing::Values(CloudCase{"vlp16", CloudLayout::kPoints, 1e-4},
                                         CloudCase{"vlp16", CloudLayout::kByLaser, 1e-4},
                                         CloudCase{"vlp16", CloudLayout::kByFiring, 1e-4},
                                         CloudCase{"vlp32c", CloudLayout::kPoints, 0.1},
                                         CloudCase{"vlp32c", CloudLayout::kByLaser, 1e-4},
                                         CloudCase{"vlp32c", CloudLayout::kByFiring, 1e-4},
                                         CloudCase{"vls128", CloudLayout::kPoints, 0.020},
                                         CloudCase{"vls128", CloudLayout::kByLaser, 1e-4},
                                         CloudCase{"pandar64", CloudLayout::kPoints, 1e-4},
                                         CloudCase{"pandar64", CloudLayout::kByLaser, 1e-4},
                                         CloudCase{"xt32", CloudLayout::kPoints, 1e-4},
                                         CloudCase{"xt32", CloudLayout::kByLaser, 1e-4},
                                         CloudCase{"qt128", CloudLayout::kPoints, 1e-4},
                                         CloudCase{"qt128", CloudLayout::kByLaser, 1e-4},
                                         CloudCase{"os1", CloudLayout::kPoints, 0.028},
                                         CloudCase{"os1", CloudLayout::kByLaser, 0.011},
                                         CloudCase{"at128", CloudLayout::kPoints, 1e-4},
                                         CloudCase{"at128", CloudLayout::kByLaser, 1e-4}),
                         [](const auto& test) {
                           return test.param.sensor + LayoutName(test.param.layout);
                         });

struct OwnCase {
  const char* sensor;
  const char* format;
  const char* fidelity;
};

class FiringsOfOwnRuns : public testing::TestWithParam<OwnCase> {};

// At 20 m/s in a curve, in the order and with the fields in which railcast writes them.
TEST_P(FiringsOfOwnRuns, AreThoseOfTheScanToTheLastBit) {
  const auto& [sensor, format, fidelity] = GetParam();
  const TemporaryDirectory directory;
  const MadeSequence made = MakeSequence(
      directory.path() / "run", {.format = format, .fidelity = fidelity, .sensor = sensor});
  const ScanSpec& scan = made.scenario.lidar.scan;
  const FiringFinder finder(OpenRecording(directory.path() / "run")->info(), scan, false);
  const std::vector<RecordedFrame> frames = ReadAll(directory.path() / "run");
  ASSERT_EQ(frames.size(), made.frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const RecordedFirings found = finder.Find(frames[f]);
    const ScanPattern pattern =
        PatternOfFrame(BuildScanPattern(scan), static_cast<std::uint32_t>(f));
    EXPECT_EQ(found.pattern.time_ns, pattern.time_ns);
    if (frames[f].axes == PointAxes::kSensorAtStamp) {
      ExpectPointsOnTheirBeams(found, 0.01);
    } else {
      EXPECT_EQ(found.pattern.direction_x, pattern.direction_x);
    }
    const Frame& truth = made.frames[f];
    const Frame& frame = found.recorded.frame;
    ASSERT_EQ(std::size_t{frame.rows} * frame.columns, std::size_t{truth.rows} * truth.columns);
    std::size_t num_wrong = 0;
    for (std::size_t cell = 0; cell < found.firing_of_cell.size(); ++cell) {
      num_wrong +=
          std::isnan(frame.x[cell * frame.returns]) != std::isnan(truth.x[cell * truth.returns]);
    }
    EXPECT_EQ(num_wrong, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(FiringFinder,
                         FiringsOfOwnRuns,
                         testing::Values(OwnCase{"vir2rail", "pcd", "plausibility"},
                                         OwnCase{"vir2rail", "kitti", "geometry"},
                                         OwnCase{"vlp16", "ply", "plausibility"},
                                         OwnCase{"vlp16", "kitti", "geometry"},
                                         OwnCase{"rosette", "pcd", "plausibility"},
                                         OwnCase{"rosette", "kitti", "geometry"},
                                         OwnCase{"mid40_like", "kitti", "geometry"}),
                         [](const auto& test) {
                           return std::string(test.param.sensor) + "_" + test.param.format;
                         });

/// Firings of a capture, which must be those of the scan that it was made of.
void ExpectFiringsOfScan(const ScanPattern& pattern,
                         const Frame& frame,
                         const RecordedFirings& found,
                         const std::string& what,
                         double most_deg) {
  ASSERT_EQ(found.pattern.num_firings(), pattern.num_firings());
  EXPECT_TRUE(found.entry_of_slot.empty());
  std::vector<MadeFiring> truth;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t cell = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    truth.push_back(
        {.direction = {pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i]},
         .row = pattern.row[i],
         .has_point = !std::isnan(frame.x[cell])});
  }
  const AimErrors errors = ErrorsOf(truth, found);
  errors.Print(what);
  EXPECT_LE(AimErrors::Share(errors.with_point_deg, 1.0), most_deg);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 1.0), most_deg);
  ExpectPointsOnTheirBeams(found, 1e-3);
}

// Azimuths of packets are rounded to 0.01 deg, and the speeds that lasers are led by likewise.
constexpr double kPacketError_deg = 0.012;
// Pandar64's decoder takes no account of when a laser fires within its cycle, up to 0.09 deg.
constexpr double kPandar64Error_deg = 0.1;

class FiringsOfVelodyne : public testing::TestWithParam<const char*> {};

TEST_P(FiringsOfVelodyne, AreThoseOfThePackets) {
  const MadeScan scan(ReadSensor(GetParam()));
  const std::vector<Frame> frames = {scan.MakeFrame(0), scan.MakeFrame(1)};
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  const Datagrams datagrams = EncodeAll(GetParam(), scan, frames);
  PcapWriter writer(file, kVelodyneDataPort, kVelodynePositionPort);
  writer.Write(datagrams, datagrams.items);
  writer.Finish();
  const RecordedFirings found = FindIn(scan.spec(), ReadAll(file).at(0));
  ExpectFiringsOfScan(BuildScanPattern(scan.spec()), frames[0], found,
                      std::string("capture of ") + GetParam(), kPacketError_deg);
}

INSTANTIATE_TEST_SUITE_P(FiringFinder,
                         FiringsOfVelodyne,
                         testing::Values("vlp16", "hdl32e", "vlp32c"));

class FiringsOfHesai : public testing::TestWithParam<const char*> {};

TEST_P(FiringsOfHesai, AreThoseOfThePackets) {
  const SpinningModel& model = *FindSpinningModel(GetParam());
  const MadeScan scan(ReadSensor(FileOf(model)));
  const std::vector<Frame> frames = {scan.MakeFrame(0), scan.MakeFrame(1), scan.MakeFrame(2)};
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  const Datagrams datagrams = Encoded(model, scan, frames);
  PcapWriter writer(file, kVelodyneDataPort, kVelodynePositionPort);
  writer.Write(datagrams, datagrams.items);
  writer.Finish();
  const RecordedFirings found = FindIn(scan.spec(), ReadAll(file).at(1));
  ExpectFiringsOfScan(
      BuildScanPattern(scan.spec()), frames[1], found, std::string("capture of ") + GetParam(),
      std::string(GetParam()) == "pandar64" ? kPandar64Error_deg : kPacketError_deg);
}

INSTANTIATE_TEST_SUITE_P(FiringFinder,
                         FiringsOfHesai,
                         testing::Values("pandar64", "xt32", "qt128"));

/// A scan that says nothing of channels, so that those of the packets' decoder count.
const ScanSpec kNoChannels = {
    .rate_hz = 10.0,
    .pattern = RasterSpec{
        .horizontal_fov_deg = 60.0, .vertical_fov_deg = 30.0, .angular_resolution_deg = 1.0}};

class BeamsOfRealPackets : public testing::TestWithParam<const char*> {};

TEST_P(BeamsOfRealPackets, HoldEveryPoint) {
  const fs::path file = fs::path(RAILCAST_SHARED_DATA_DIR) / GetParam();
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  for (const RecordedFrame& recorded : ReadAll(file)) {
    const RecordedFirings found = FindIn(kNoChannels, recorded);
    EXPECT_EQ(found.pattern.num_firings(),
              std::size_t{recorded.frame.rows} * recorded.frame.columns);
    ExpectPointsOnTheirBeams(found, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(
    FiringFinder,
    BeamsOfRealPackets,
    testing::Values("lidar_packets_nebula/vlp16_dual.pcap",
                    "lidar_ouster/OS-1-128_767798045_1024x10_20230712_120049.pcap",
                    "lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.pcap",
                    "ouster_more/OS-0-32-U1_v2.2.0_1024x10.pcap",
                    "ouster_more/OS-2-32-U0_v2.0.0_1024x10.pcap"));

struct RealCase {
  const char* capture;  ///< In the shared data; of Hesai the name of a bag.
  const char* sensor;
  double most_without_deg;  ///< Of 99.9 % of the firings without a return.
};

class FiringsOfRealTurns : public testing::TestWithParam<RealCase> {};

// The cloud of a real turn, from which a fifth of the points was taken: the firings of the packets
// are known, those of the hidden points included.
TEST_P(FiringsOfRealTurns, AreFoundAgainFromTheirPoints) {
  const auto& [capture, sensor, most_without_deg] = GetParam();
  const fs::path file = fs::path(RAILCAST_SHARED_DATA_DIR) / capture;
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const ScanSpec scan = ReadSensor(sensor);
  const RecordedFirings truth = FindIn(scan, ReadAll(file).at(1));
  ExpectPointsOnTheirBeams(truth, 1e-3);
  const ScanPattern& pattern = truth.pattern;
  const Frame& frame = truth.recorded.frame;
  std::vector<MadeFiring> firings;
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t cell = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    const std::size_t slot = cell * frame.returns;
    const bool is_hidden = UnitFloat(RandomWords(7, RandomUse::kNoise, 0, i)[0]) < 0.2F;
    firings.push_back(
        {.direction = {pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i]},
         .point_m = {frame.x[slot], frame.y[slot], frame.z[slot]},
         .time_ns = pattern.time_ns[i],
         .row = pattern.row[i],
         .column = pattern.column[i],
         .has_point = !std::isnan(frame.x[slot]) && !is_hidden});
  }
  const TemporaryDirectory directory;
  const fs::path cloud = directory.path() / "cloud.pcd";
  WriteCloudOf(firings, pattern, {}, cloud);
  const RecordedFirings found = FindIn(scan, ReadAll(cloud).at(0));
  const AimErrors errors = ErrorsOf(firings, found);
  errors.Print(capture);
  std::cout << "  " << pattern.num_firings() << " firings, found " << found.pattern.num_firings()
            << "\n";
  EXPECT_LE(AimErrors::Share(errors.with_point_deg, 1.0), 1e-3);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 0.999), most_without_deg);
  // Of a part of a turn, the cloud does not say that the sensor has not fired in the rest; nor that
  // a laser does not work.
  const double whole = std::string(sensor) == "vlp32c" ? 29'088.0 / 57'856.0 : 1.0;
  EXPECT_NEAR(whole * static_cast<double>(found.pattern.num_firings()) /
                  static_cast<double>(std::size_t{pattern.rows} * pattern.columns),
              1.0, 0.005);
}

INSTANTIATE_TEST_SUITE_P(
    FiringFinder,
    FiringsOfRealTurns,
    testing::Values(RealCase{"lidar_packets_nebula/vlp16_dual.pcap", "vlp16", 0.04},
                    RealCase{"lidar_packets_nebula/vlp32c_single.pcap", "vlp32c", 0.035},
                    RealCase{"lidar_packets_nebula/vls128_single.pcap", "vls128", 0.21},
                    RealCase{"lidar_packets_nebula/pandar64.pcap", "pandar64", 0.1},
                    RealCase{"lidar_hesai/captures/xt32.db3", "xt32", 0.001},
                    RealCase{"lidar_hesai/captures/qt128.db3", "qt128", 0.001}),
    [](const auto& test) { return std::string(test.param.sensor); });

constexpr const char* kNoCommonStep =
    "the azimuths of its rings have no common step, as where several sensors are mixed, the "
    "sensor's motion is undone or points were thinned out";

/// A cloud of VLP-16 whose points `change` changes.
template <typename Change>
fs::path ChangedCloud(const TemporaryDirectory& directory, Change&& change, CloudStyle style = {}) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor("vlp16"));
  std::vector<MadeFiring> firings = FireInThePlain(pattern);
  change(firings);
  const fs::path file = directory.path() / "cloud.pcd";
  WriteCloudOf(firings, pattern, style, file);
  return file;
}

// Neither ring nor time, and nothing at all in a sixth of the turn, on the left.
TEST(FiringFinder, KnowsColumnsThatReturnedNothing) {
  const TemporaryDirectory directory;
  const ScanSpec scan = ReadSensor("vlp16");
  const fs::path file = ChangedCloud(
      directory,
      [](std::vector<MadeFiring>& firings) {
        for (MadeFiring& firing : firings) {
          if (firing.direction[1] > 0.866F * std::hypot(firing.direction[0], firing.direction[1])) {
            firing.has_point = false;
          }
        }
      },
      {.has_ring = false, .has_time = false});
  RecordedFrame recorded = ReadAll(file).at(0);
  EXPECT_LT(recorded.frame.columns, 1600U);
  const RecordedFirings found = FindIn(scan, std::move(recorded));
  const ScanPattern pattern = BuildScanPattern(scan);
  EXPECT_EQ(found.pattern.columns, pattern.columns);
  const AimErrors errors = ErrorsOf(FireInThePlain(pattern), found);
  // Half a step, where the turn ends and begins, as its cycles are no whole number; no more in the
  // gap, which is elsewhere.
  EXPECT_LE(AimErrors::Share(errors.with_point_deg, 1.0), 0.1);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 1.0), 0.1);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 0.5), 0.02);
  // The rotor goes evenly from the stamp on, wherever it was then.
  const auto [first, last] = std::ranges::minmax(found.pattern.time_ns);
  EXPECT_LT(first, 1000U);
  EXPECT_NEAR(last, 100e6, 1e5);
}

TEST(FiringFinder, RefusesAnotherSensorInNumbers) {
  const TemporaryDirectory directory;
  const fs::path file = ChangedCloud(directory, [](auto&) {});
  const ScanSpec vlp16 = ReadSensor("vlp16");
  ScanSpec few = vlp16;
  std::get<SpinningSpec>(few.pattern).channels.resize(8);
  EXPECT_EQ(WhyNot(few, file), "the sensor has 8 channels, the recording 14 rings");
  ScanSpec fast = vlp16;
  fast.rate_hz = 20.0;
  std::get<SpinningSpec>(fast.pattern).columns = 904;
  EXPECT_EQ(WhyNot(fast, file),
            "the sensor turns by 0.3981 deg from firing to firing of a channel, the recording's "
            "by 0.1991 deg");
  ScanSpec high = vlp16;
  for (ChannelSpec& channel : std::get<SpinningSpec>(high.pattern).channels) {
    channel.elevation_deg += 5.4;
  }
  EXPECT_EQ(WhyNot(high, file), "ring 0 of 14 lies at -15 deg, the sensor's channel at -9.6 deg");
}

TEST(FiringFinder, TakesACaptureOfAnotherSensorPointByPointIfItMay) {
  const fs::path file =
      fs::path(RAILCAST_SHARED_DATA_DIR) / "lidar_packets_nebula" / "vlp16_dual.pcap";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto recording = OpenRecording(file);
  const RecordedFrame recorded = (*recording->Next())();
  const FiringFinder finder(recording->info(), ReadSensor("pandar64"), true);
  const RecordedFirings firings = finder.Find(recorded);
  EXPECT_TRUE(firings.are_points_alone);
  EXPECT_EQ(firings.recorded.frame.num_slots(), recorded.frame.num_slots());
  EXPECT_GT(firings.pattern.num_firings(), 1000U);
}

TEST(FiringFinder, RefusesMirroredAxes) {
  const TemporaryDirectory directory;
  const ScanSpec scan = ReadSensor("vlp16");
  const fs::path mirrored = ChangedCloud(directory, [](std::vector<MadeFiring>& firings) {
    for (MadeFiring& firing : firings) firing.point_m[1] = -firing.point_m[1];
  });
  EXPECT_EQ(WhyNot(scan, mirrored),
            "the sensor turns clockwise, the recording's counterclockwise, as where axes are "
            "exchanged or mirrored");
}

TEST(FiringFinder, RefusesMixedSensorsOrTakesTheirPointsAlone) {
  const TemporaryDirectory directory;
  const ScanSpec scan = ReadSensor("vlp16");
  // A second sensor of the kind, 1 m beside the first and turned by an odd angle.
  const fs::path file = ChangedCloud(directory, [](std::vector<MadeFiring>& firings) {
    std::vector<MadeFiring> others = firings;
    for (MadeFiring& firing : others) {
      const float x = firing.point_m[0];
      firing.point_m[0] = 0.8F * x - 0.6F * firing.point_m[1];
      firing.point_m[1] = 0.6F * x + 0.8F * firing.point_m[1] + 1.0F;
    }
    firings.insert(firings.end(), others.begin(), others.end());
  });
  EXPECT_EQ(WhyNot(scan, file), kNoCommonStep);
  RecordedFrame recorded = ReadAll(file).at(0);
  const RecordedFirings found = FiringFinder({}, scan, true).Find(std::move(recorded));
  EXPECT_TRUE(found.are_points_alone);
  EXPECT_EQ(found.pattern.num_firings(), found.recorded.slot_of_entry.size());
  ExpectPointsOnTheirBeams(found, 1e-4);
}

// Laser 22 by elevation of this VLS-128 returns nothing in any turn.
TEST(FiringFinder, FindsNoFiringsOfALaserThatDoesNotWork) {
  if (!exists(kVls128Capture)) GTEST_SKIP() << kVls128Capture << " is not there";
  const auto recording = OpenRecording(kVls128Capture);
  static_cast<void>(recording->Next());
  const RecordedFirings found =
      FiringFinder(recording->info(), SensorOfTest("vls128"), false).Find((*recording->Next())());
  const ScanPattern& pattern = found.pattern;
  EXPECT_EQ(std::ranges::count(pattern.row, 22), 0);
  EXPECT_EQ(pattern.num_firings(), std::size_t{127} * pattern.columns);
}

// Of eight rings nothing is left, as under the open sky; four are missing.
TEST(FiringFinder, KnowsRingsThatReturnedNothing) {
  const TemporaryDirectory directory;
  const ScanSpec scan = ReadSensor("vlp16");
  const fs::path file = ChangedCloud(directory, [](std::vector<MadeFiring>& firings) {
    for (MadeFiring& firing : firings) {
      if (firing.row > 11 || firing.row % 3 == 0) firing.has_point = false;
    }
  });
  const RecordedFirings found = FindIn(scan, ReadAll(file).at(0));
  EXPECT_EQ(found.pattern.rows, 16U);
  const AimErrors errors = ErrorsOf(FireInThePlain(BuildScanPattern(scan)), found);
  errors.Print("VLP-16 with missing rings");
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 1.0), 0.1);
}

}  // namespace
}  // namespace railcast
