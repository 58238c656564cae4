#include "railcast/io/udp_grabber.h"

#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <atomic>
#include <future>
#include <mutex>

#include "core/io/stream/stream_clouds.h"
#include "railcast/io/point_types.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

using Xyz = pcl::PointCloud<pcl::PointXYZ>;
using Xyzi = pcl::PointCloud<pcl::PointXYZI>;
using Xyzl = pcl::PointCloud<pcl::PointXYZL>;
using Labelled = pcl::PointCloud<LabelledPoint>;

/// A client that knows only the interface pcl::Grabber and keeps the last cloud of each kind.
template <typename Cloud>
class Client {
 public:
  explicit Client(pcl::Grabber& grabber) {
    const std::function<void(const std::shared_ptr<const Cloud>&)> keep =
        [this](const std::shared_ptr<const Cloud>& cloud) {
          const std::lock_guard lock(mutex_);
          last_ = cloud;
          ++count_;
        };
    connection_ = grabber.registerCallback(keep);
  }
  ~Client() { connection_.disconnect(); }

  std::shared_ptr<const Cloud> WaitFor(int count) {
    Eventually([&] {
      const std::lock_guard lock(mutex_);
      return count_ >= count;
    });
    const std::lock_guard lock(mutex_);
    EXPECT_EQ(count_, count);
    return last_;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const Cloud> last_;
  int count_ = 0;
  boost::signals2::connection connection_;
};

/// Fails if `work` hangs, that is, takes longer than on any machine.
void ExpectToReturn(const std::function<void()>& work) {
  auto done = std::async(std::launch::async, work);
  if (done.wait_for(std::chrono::seconds(20)) == std::future_status::ready) return;
  // The future's destructor would wait forever.
  std::fprintf(stderr, "it hangs\n");
  std::abort();
}

TEST(UdpGrabber, ServesAnyClientOfPcl) {
  UdpGrabber udp(kAnyLoopbackPort);
  pcl::Grabber& grabber = udp;
  Client<Xyz> xyz(grabber);
  Client<Xyzi> xyzi(grabber);
  Client<Xyzl> xyzl(grabber);
  Client<Labelled> all_usual(grabber);
  Client<pcl::PCLPointCloud2> fields(grabber);
  Client<ReceivedFrame> frames(grabber);
  EXPECT_EQ(grabber.getName(), "railcast::UdpGrabber");
  EXPECT_FALSE(grabber.isRunning());
  grabber.start();
  EXPECT_TRUE(grabber.isRunning());
  LiveStream(udp.at()).Send(9);
  const ReceivedFrame expected = ReceiveWhole(StreamFrame(9));
  const auto frame = frames.WaitFor(1);
  const auto points = xyz.WaitFor(1);
  const auto bright = xyzi.WaitFor(1);
  const auto labelled = xyzl.WaitFor(1);
  const auto usual = all_usual.WaitFor(1);
  EXPECT_EQ(fields.WaitFor(1)->width, expected.num_points());
  EXPECT_EQ(frame->points, expected.points);
  EXPECT_EQ(points->header.seq, 9U);
  EXPECT_EQ(points->header.stamp, 900'000U);
  ASSERT_EQ(points->size(), expected.num_points());
  for (std::size_t i = 0; i < points->size(); ++i) {
    EXPECT_EQ((*points)[i].x, expected.At<float>(*expected.header.Find("x"), i));
    EXPECT_EQ((*bright)[i].intensity, expected.At<float>(*expected.header.Find("intensity"), i));
    EXPECT_EQ((*labelled)[i].label, expected.At<std::uint32_t>(*expected.header.Find("label"), i));
    EXPECT_EQ((*usual)[i].label, (*labelled)[i].label);
    EXPECT_EQ((*usual)[i].ring, expected.At<std::uint16_t>(*expected.header.Find("ring"), i));
  }
  const Transform pose = StreamFrame(9).world_from_sensor;
  EXPECT_EQ(points->sensor_origin_.head<3>(), pose.translation().cast<float>());
  EXPECT_TRUE(
      points->sensor_orientation_.toRotationMatrix().isApprox(pose.linear().cast<float>(), 1e-6F));
  grabber.stop();
  EXPECT_FALSE(grabber.isRunning());
}

TEST(UdpGrabber, GivesNoPoseForPointsInOtherAxes) {
  UdpGrabber grabber(kAnyLoopbackPort);
  Client<Xyz> xyz(grabber);
  grabber.start();
  StreamSpec spec;
  spec.output.frame = OutputFrame::kVehicle;
  LiveStream(grabber.at(), spec).Send(9);
  const auto points = xyz.WaitFor(1);
  EXPECT_EQ(points->sensor_origin_, Eigen::Vector4f::Zero());
  EXPECT_TRUE(points->sensor_orientation_.isApprox(Eigen::Quaternionf::Identity()));
}

TEST(UdpGrabber, GivesNoIntensityThatWasNotSent) {
  UdpGrabber grabber(kAnyLoopbackPort);
  Client<Xyz> xyz(grabber);
  Client<Xyzi> xyzi(grabber);
  Client<Xyzl> xyzl(grabber);
  grabber.start();
  StreamSpec spec;
  spec.fields = FieldSelection("x,y,z");
  LiveStream stream(grabber.at(), spec);
  stream.Send(0);
  xyz.WaitFor(1);
  grabber.stop();
  xyzi.WaitFor(0);
  xyzl.WaitFor(0);
}

TEST(UdpGrabber, StartsAndStopsAgainAndAgain) {
  UdpGrabber grabber(kAnyLoopbackPort);
  Client<ReceivedFrame> frames(grabber);
  ExpectToReturn([&] { grabber.stop(); });
  for (int i = 1; i <= 5; ++i) {
    grabber.start();
    grabber.start();
    LiveStream(grabber.at()).Send(0);
    frames.WaitFor(i);
    ExpectToReturn([&] { grabber.stop(); });
    EXPECT_EQ(grabber.counts().stream.complete_frames, 1U);
    LiveStream(grabber.at()).Send(1);
  }
  frames.WaitFor(5);
}

TEST(UdpGrabber, MayBeStoppedAndStartedByItsOwnCallback) {
  UdpGrabber grabber(kAnyLoopbackPort);
  std::atomic<int> count = 0;
  const std::function<void(const Xyz::ConstPtr&)> stop = [&](const Xyz::ConstPtr&) {
    grabber.stop();
    if (++count == 1) grabber.start();
  };
  grabber.registerCallback(stop);
  grabber.start();
  const Endpoint first = grabber.at();
  LiveStream(first).Send(0);
  ASSERT_TRUE(Eventually([&] { return count == 1 && grabber.isRunning(); }));
  LiveStream(grabber.at()).Send(0);
  ASSERT_TRUE(Eventually([&] { return count == 2 && !grabber.isRunning(); }));
  ExpectToReturn([&] { grabber.stop(); });
}

TEST(UdpGrabber, StopsBesideSendersAndSlowCallbacks) {
  UdpGrabber grabber(kAnyLoopbackPort);
  std::atomic<int> count = 0;
  const std::function<void(const Xyz::ConstPtr&)> sleep = [&](const Xyz::ConstPtr&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ++count;
  };
  grabber.registerCallback(sleep);
  grabber.start();
  const Endpoint at = grabber.at();
  std::atomic<bool> goes_on = true;
  std::thread sender([&] {
    LiveStream stream(at);
    for (std::uint32_t index = 0; goes_on; ++index) {
      stream.Send(index);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  EXPECT_TRUE(Eventually([&] { return grabber.counts().dropped_frames > 0 && count > 2; }));
  EXPECT_GT(grabber.getFramesPerSecond(), 0.0F);
  ExpectToReturn([&] { grabber.stop(); });
  const int count_at_stop = count;
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_EQ(count, count_at_stop);
  EXPECT_EQ(grabber.getFramesPerSecond(), 0.0F);
  goes_on = false;
  sender.join();
}

TEST(UdpGrabber, SaysThatAPortIsTaken) {
  UdpGrabber first(kAnyLoopbackPort);
  first.start();
  UdpGrabber second(first.at());
  EXPECT_EQ(MessageOf([&] { second.start(); }),
            "cannot listen: Address already in use (got " + EndpointText(first.at()) + ")");
  EXPECT_FALSE(second.isRunning());
}

TEST(MakePclCloud, HoldsEveryFieldByItsName) {
  StreamSpec spec;
  spec.fields = FieldSelection();
  spec.sensor = 2;
  const ReceivedFrame received = ReceiveWhole(StreamFrame(7), spec);
  const pcl::PCLPointCloud2 cloud = MakePclCloud(received);
  EXPECT_EQ(cloud.header.seq, 7U);
  EXPECT_EQ(cloud.header.stamp, 700'000U);  // Frame 7 at 10 Hz, in microseconds.
  EXPECT_EQ(cloud.header.frame_id, "railcast_2");
  EXPECT_EQ(cloud.width, received.num_points());
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_TRUE(cloud.is_dense);
  EXPECT_EQ(cloud.fields.size(), 19U);
  pcl::PointCloud<pcl::PointXYZL> points;
  pcl::fromPCLPointCloud2(cloud, points);
  ASSERT_EQ(points.size(), received.num_points());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].y, received.At<float>(*received.header.Find("y"), i));
    EXPECT_EQ(points[i].label, received.At<std::uint32_t>(*received.header.Find("label"), i));
  }
}

TEST(MakePclCloud, SaysWhereSlotsHaveNoPoint) {
  StreamSpec spec;
  spec.fields = FieldSelection("x,y,z");
  spec.has_all_slots = true;
  EXPECT_FALSE(MakePclCloud(ReceiveWhole(StreamFrame(0), spec)).is_dense);
}

}  // namespace
}  // namespace railcast
