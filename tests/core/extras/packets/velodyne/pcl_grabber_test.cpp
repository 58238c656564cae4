#include <gtest/gtest.h>
#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <fstream>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

#include "core/extras/packets/spinning/spinning_model.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/net/udp.h"
#include "core/io/write_file.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/captures.h"
#include "tests/support/scan_once.h"
#include "tests/support/sensor_file.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint32_t kLoopback = 0x7F000001;

using Sweep = pcl::PointCloud<pcl::PointXYZI>;

/// A point that PCL must make of a turn: its slot, and the azimuth that PCL assumes for it.
struct ExpectedPoint {
  std::size_t slot{};
  std::size_t laser{};
  double azimuth_deg{};
};

/// Returns the points of a frame by PCL's rules. A VLP block holds two columns, and the second has
/// the azimuth of the block plus half of the step from the packet's first azimuth to its second,
/// truncated to 0.01 deg. Other blocks have one azimuth for all their lasers, less a laser's
/// rotCorrection_ where there is a calibration.
std::vector<ExpectedPoint> PclPoints(std::string_view format,
                                     const MadeScan& scan,
                                     const Frame& frame) {
  const SpinningModel& model = *FindSpinningModel(format);
  const auto step = static_cast<std::uint32_t>(model.cycles_per_block());
  const std::size_t blocks_per_group = model.blocks_per_loop() * (format == "vlp16-dual" ? 2U : 1U);
  const std::size_t groups_per_packet = kBlocksPerPacket / blocks_per_group;
  const std::size_t groups_per_frame = frame.columns / step;
  const auto azimuth = [&](std::size_t group) {
    return scan.AzimuthUnits(static_cast<std::uint32_t>(group % groups_per_frame) * step);
  };
  const auto distance = [&](std::size_t slot) {
    const double units =
        std::floor(static_cast<double>(frame.range_m[slot]) / (1e-3 * model.unit_mm) + 0.5);
    return units < 65536.0 ? units : 0.0;  // NaN gives 0, too.
  };
  std::vector<ExpectedPoint> points;
  for (std::uint32_t column = 0; column < frame.columns; ++column) {
    const std::size_t group = frame.index * groups_per_frame + column / step;
    const std::size_t first = group / groups_per_packet * groups_per_packet;
    const std::int64_t packet_step = (azimuth(first + 1) - azimuth(first) + 36'000) % 36'000;
    double units = static_cast<double>(azimuth(group));
    if (column % step == 1) units = std::floor(units + 0.5 * static_cast<double>(packet_step));
    for (std::size_t laser = 0; laser < scan.num_lasers(); ++laser) {
      const double own_deg =
          model.has_own_angles ? scan.spinning().channels[laser].azimuth_deg : 0.0;
      const std::size_t slot =
          scan.RowOf(laser) * std::size_t{frame.width()} + std::size_t{column} * frame.returns;
      std::vector<std::size_t> slots = {slot};
      if (frame.returns == 2) slots.push_back(slot + 1);
      std::erase_if(slots, [&](std::size_t s) { return distance(s) == 0.0; });
      std::ranges::sort(slots, [&](auto a, auto b) { return distance(a) > distance(b); });
      if (slots.size() == 2 && distance(slots[0]) == distance(slots[1])) slots.pop_back();
      for (const std::size_t s : slots) points.push_back({s, laser, units * 0.01 + own_deg});
    }
  }
  return points;
}

std::size_t LaserAt(double elevation_deg, const MadeScan& scan) {
  const auto& channels = scan.spinning().channels;
  const auto nearest = std::ranges::min_element(channels, {}, [&](const ChannelSpec& channel) {
    return std::abs(channel.elevation_deg - elevation_deg);
  });
  return static_cast<std::size_t>(nearest - channels.begin());
}

/// Expects a sweep to hold exactly the points of a frame that the format can encode, with
/// railcast's ranges, rings and intensities, and azimuths by PCL's rules.
void ExpectFrame(const Sweep& sweep,
                 std::string_view format,
                 const MadeScan& scan,
                 const Frame& frame) {
  const SpinningModel& model = *FindSpinningModel(format);
  const auto expected = PclPoints(format, scan, frame);
  ASSERT_EQ(sweep.size(), expected.size());
  // Half a unit plus the float32 rounding of coordinates of up to 131 m.
  const double range_tolerance_m = 0.5 * (1e-3 * model.unit_mm) + 5e-5;
  // PCL assumes one azimuth for a firing cycle, during which the rotor turns until the last laser.
  const double last_us =
      std::ranges::max(scan.spinning().channels, {}, &ChannelSpec::time_us).time_us;
  const double azimuth_tolerance_deg = 360.0 * scan.spec().rate_hz * last_us * 1e-6 + 0.02;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    // PCL's axes: x right, y forward.
    const auto x = static_cast<double>(sweep[i].x);
    const auto y = static_cast<double>(sweep[i].y);
    const auto z = static_cast<double>(sweep[i].z);
    const double range_m = std::sqrt(x * x + y * y + z * z);
    const std::size_t slot = expected[i].slot;
    ASSERT_NEAR(range_m, frame.range_m[slot], range_tolerance_m);
    const std::size_t laser = LaserAt(DegFromRad(std::asin(z / range_m)), scan);
    ASSERT_EQ(laser, expected[i].laser);
    ASSERT_EQ(scan.RowOf(laser), frame.ring[slot]);
    ASSERT_EQ(sweep[i].intensity, static_cast<float>(ReflectivityByte(frame.intensity[slot])));
    const double azimuth_deg = DegFromRad(std::atan2(x, y));
    ASSERT_LT(std::abs(std::remainder(azimuth_deg - expected[i].azimuth_deg, 360.0)), 1e-4);
    ASSERT_LT(std::abs(std::remainder(azimuth_deg - MadeScan::AzimuthOf(frame, slot), 360.0)),
              azimuth_tolerance_deg);
  }
}

/// Collects the sweeps that a grabber delivers.
class Sweeps {
 public:
  explicit Sweeps(pcl::HDLGrabber& grabber)
      : connection_(grabber.registerCallback(
            std::function<void(const Sweep::ConstPtr&)>([this](const Sweep::ConstPtr& sweep) {
              const std::lock_guard lock(mutex_);
              sweeps_.push_back(sweep);
              arrived_.notify_one();
            }))) {}
  ~Sweeps() { connection_.disconnect(); }
  Sweeps(const Sweeps&) = delete;
  Sweeps& operator=(const Sweeps&) = delete;

  /// Returns the sweeps as soon as there are `count` of them, or fewer if that takes a minute.
  [[nodiscard]] std::vector<Sweep::ConstPtr> First(std::size_t count) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, std::chrono::minutes(1), [&] { return sweeps_.size() >= count; });
    return {sweeps_.begin(),
            sweeps_.begin() + static_cast<std::ptrdiff_t>(std::min(count, sweeps_.size()))};
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Sweep::ConstPtr> sweeps_;
  boost::signals2::connection connection_;
};

/// The frames of a scan in each format. One more than needed, since a sweep is delivered when the
/// next begins.
std::vector<Frame> MadeFrames(std::string_view format, const MadeScan& scan) {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 4; ++i) {
    frames.push_back(scan.MakeFrame(i, format == "vlp16-dual" ? 2 : 1));
  }
  return frames;
}

/// The sensor stands between walls, so that some beams meet near surfaces, some far ones, and some
/// nothing.
std::vector<Frame> SimulatedFrames(const MadeScan& scan) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back({MakeFloor(-2.0F, 60.0F), 1, 1});
  world->ground.parts.push_back({MakeWall(30.0F, 10.0F), 2, 2});
  world->ground.parts.push_back({MakeWall(-7.0F, 3.0F), 3, 3});
  world->velocity_chunk_mps = Vector3(5.0, 0.0, 0.0);
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 4; ++i) {
    frames.push_back(ScanOnce(world, BuildScanPattern(scan.spec()), {}, i));
  }
  return frames;
}

std::unique_ptr<pcl::HDLGrabber> GrabberOfFile(std::string_view format,
                                               const std::string& calibration,
                                               const std::string& file) {
  if (format.starts_with("vlp16")) return std::make_unique<pcl::VLPGrabber>(file);
  return std::make_unique<pcl::HDLGrabber>(calibration, file);
}

std::unique_ptr<pcl::HDLGrabber> GrabberOfPort(std::string_view format,
                                               const std::string& calibration,
                                               std::uint16_t port) {
  const auto loopback = boost::asio::ip::address::from_string("127.0.0.1");
  if (format.starts_with("vlp16")) return std::make_unique<pcl::VLPGrabber>(loopback, port);
  return std::make_unique<pcl::HDLGrabber>(loopback, port, calibration);
}

/// Returns the number of bytes in the receive buffer of a UDP port of this machine.
std::size_t WaitingBytes(std::uint16_t port) {
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    unsigned local_port = 0;
    unsigned long waiting = 0;
    if (std::sscanf(line.c_str(), " %*u: %*x:%x %*x:%*x %*x %*x:%lx", &local_port, &waiting) == 2 &&
        local_port == port) {
      return waiting;
    }
  }
  return 0;
}

class PclGrabber : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string_view format() const { return GetParam(); }
  [[nodiscard]] const MadeScan& scan() const { return scan_; }
  /// Returns the calibration file for HDLGrabber; an empty name for sensors that it knows.
  [[nodiscard]] std::string CalibrationFile() const {
    if (format() != "hdl64e") return {};
    const auto file = directory_.path() / "db.xml";
    WriteFileWhole(file, CalibrationXml(scan_.spinning()));
    return file.string();
  }

  void ExpectFromCapture(const std::vector<Frame>& frames) const {
    const Datagrams datagrams = EncodeAll(format(), scan_, frames);
    const auto file = directory_.path() / "a.pcap";
    WriteDatagrams(file, datagrams);
    const auto grabber = GrabberOfFile(format(), CalibrationFile(), file.string());
    Sweeps sweeps(*grabber);
    grabber->start();
    ExpectSweeps(sweeps.First(frames.size() - 1), frames);
    grabber->stop();
  }

  void ExpectSweeps(const std::vector<Sweep::ConstPtr>& sweeps,
                    const std::vector<Frame>& frames) const {
    ASSERT_EQ(sweeps.size(), frames.size() - 1);
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      ExpectFrame(*sweeps[i], format(), scan_, frames[i]);
    }
  }

 private:
  TemporaryDirectory directory_;
  MadeScan scan_{ReadSensor(std::string(SensorOf(GetParam())))};
};

TEST_P(PclGrabber, ReadsOurCaptures) {
  ExpectFromCapture(MadeFrames(format(), scan()));
}

TEST_P(PclGrabber, ReadsCapturesOfSimulatedScans) {
  ExpectFromCapture(SimulatedFrames(scan()));
}

TEST_P(PclGrabber, HearsOurPacketsOnLoopback) {
  const std::vector<Frame> frames = MadeFrames(format(), scan());
  const Datagrams datagrams = EncodeAll(format(), scan(), frames);
  const std::uint16_t port = UdpReceiver(Endpoint{kLoopback, 0}).at().port;
  const auto grabber = GrabberOfPort(format(), CalibrationFile(), port);
  Sweeps sweeps(*grabber);
  grabber->start();
  UdpSender sender({Endpoint{kLoopback, port}}, port);
  for (const Datagrams::Item& item : datagrams.items) {
    sender.Send(datagrams, {&item, 1});
    // The receiver sets the pace, since its buffer holds 92 packets.
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (WaitingBytes(port) > 0) {
      if (std::chrono::steady_clock::now() > end) FAIL() << "nobody reads the packets";
      std::this_thread::yield();
    }
  }
  ExpectSweeps(sweeps.First(frames.size() - 1), frames);
  // stop() waits for one more datagram.
  const auto stopped = std::async(std::launch::async, [&] { grabber->stop(); });
  while (stopped.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
    sender.Send(datagrams, {datagrams.items.data(), 1});
  }
}

INSTANTIATE_TEST_SUITE_P(Velodyne,
                         PclGrabber,
                         testing::Values("vlp16", "vlp16-dual", "hdl32e", "hdl64e"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace railcast
