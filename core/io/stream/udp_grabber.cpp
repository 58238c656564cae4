#include "railcast/io/udp_grabber.h"

#include <pcl/common/io.h>
#include <pcl/conversions.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/out_of_memory.h"
#include "core/base/units.h"
#include "core/io/cloud/cloud.h"
#include "core/io/stream/stream_clouds.h"
#include "railcast/io/point_types.h"

namespace railcast {
namespace {

constexpr int kWait_ms = 1000;
constexpr std::size_t kNumArrivals = 32;

using FrameSignal = void(const std::shared_ptr<const ReceivedFrame>&);
using CloudSignal = void(const std::shared_ptr<const pcl::PCLPointCloud2>&);
template <typename Point>
using PointSignal = void(const typename pcl::PointCloud<Point>::ConstPtr&);

/// Whether a stream has every field of a type of points, with its type.
template <typename Point>
bool SendsFieldsOf(const StreamHeader& header) {
  return std::ranges::all_of(pcl::getFields<Point>(), [&](const pcl::PCLPointField& wanted) {
    const StreamField* const field = header.Find(wanted.name);
    return field != nullptr && static_cast<std::uint8_t>(field->type) == wanted.datatype;
  });
}

}  // namespace

pcl::PCLPointCloud2 MakePclCloud(const ReceivedFrame& received) {
  pcl::PCLPointCloud2 cloud = ToPcl(MakeCloud(received));
  cloud.header.seq = received.header.frame;
  cloud.header.stamp = static_cast<std::uint64_t>(received.header.stamp_ns / kNsPerUs);
  cloud.header.frame_id = "railcast_" + std::to_string(received.header.sensor);
  return cloud;
}

UdpGrabber::UdpGrabber(const Endpoint& at, const WantedStream& wanted)
    : listens_at_(at), wanted_(wanted), at_(at) {
  createSignal<FrameSignal>();
  createSignal<CloudSignal>();
  createSignal<PointSignal<pcl::PointXYZ>>();
  createSignal<PointSignal<pcl::PointXYZI>>();
  createSignal<PointSignal<pcl::PointXYZL>>();
  createSignal<PointSignal<LabelledPoint>>();
  createSignal<PointSignal<FramePoint>>();
  thread_ = StartThread("starting a grabber", [this] { Work(); });
}

UdpGrabber::~UdpGrabber() noexcept {
  UdpGrabber::stop();
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void UdpGrabber::start() {
  const std::lock_guard lock(mutex_);
  if (receiver_) return;
  receiver_ = std::make_shared<StreamReceiver>(listens_at_, wanted_);
  at_ = receiver_->at();
  arrivals_s_.clear();
  changed_.notify_all();
}

void UdpGrabber::stop() {
  std::unique_lock lock(mutex_);
  if (!receiver_) return;
  receiver_->Stop();
  last_counts_ = receiver_->counts();
  const auto stopped = std::move(receiver_);
  receiver_.reset();
  if (thread_.get_id() == std::this_thread::get_id()) return;
  changed_.wait(lock, [&] { return busy_with_ != stopped; });
}

bool UdpGrabber::isRunning() const {
  const std::lock_guard lock(mutex_);
  return receiver_ != nullptr;
}

float UdpGrabber::getFramesPerSecond() const {
  const std::lock_guard lock(mutex_);
  if (!receiver_ || arrivals_s_.size() < 2) return 0.0F;
  const double elapsed_s = arrivals_s_.back() - arrivals_s_.front();
  return static_cast<float>(static_cast<double>(arrivals_s_.size() - 1) / elapsed_s);
}

Endpoint UdpGrabber::at() const {
  const std::lock_guard lock(mutex_);
  return at_;
}

UdpGrabber::Counts UdpGrabber::counts() const {
  const std::lock_guard lock(mutex_);
  return receiver_ ? receiver_->counts() : last_counts_;
}

void UdpGrabber::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return receiver_ || is_ending_; });
    if (is_ending_) return;
    busy_with_ = receiver_;
    const auto receiver = receiver_;
    lock.unlock();
    auto frame = receiver->Next(kWait_ms);
    lock.lock();
    if (frame && receiver_ == receiver) {
      NoteArrival();
      lock.unlock();
      Emit(std::make_shared<const ReceivedFrame>(std::move(*frame)));
      lock.lock();
    }
    busy_with_.reset();
    changed_.notify_all();
  }
}

void UdpGrabber::NoteArrival() {
  const std::chrono::duration<double> now = std::chrono::steady_clock::now().time_since_epoch();
  arrivals_s_.push_back(now.count());
  if (arrivals_s_.size() > kNumArrivals) arrivals_s_.pop_front();
}

template <typename Point>
void UdpGrabber::EmitPoints(const pcl::PCLPointCloud2& cloud, const StreamHeader& header) {
  if (num_slots<PointSignal<Point>>() == 0 || !SendsFieldsOf<Point>(header)) return;
  const auto points = std::make_shared<pcl::PointCloud<Point>>();
  pcl::fromPCLPointCloud2(cloud, *points);
  // The pose is known only where the points are in the sensor's own axes.
  const bool has_pose = header.axes == StreamAxes::kSensor && !header.is_left_handed;
  const Transform world_from_sensor = has_pose ? header.world_from_sensor : Transform::Identity();
  const Eigen::Vector3f origin_m = world_from_sensor.translation().cast<float>();
  points->sensor_origin_ = Eigen::Vector4f(origin_m.x(), origin_m.y(), origin_m.z(), 0.0F);
  points->sensor_orientation_ = Eigen::Quaterniond(world_from_sensor.linear()).cast<float>();
  (*find_signal<PointSignal<Point>>())(points);
}

void UdpGrabber::Emit(const std::shared_ptr<const ReceivedFrame>& frame) {
  (*find_signal<FrameSignal>())(frame);
  const auto cloud = std::make_shared<const pcl::PCLPointCloud2>(MakePclCloud(*frame));
  (*find_signal<CloudSignal>())(cloud);
  EmitPoints<pcl::PointXYZ>(*cloud, frame->header);
  EmitPoints<pcl::PointXYZI>(*cloud, frame->header);
  EmitPoints<pcl::PointXYZL>(*cloud, frame->header);
  EmitPoints<LabelledPoint>(*cloud, frame->header);
  EmitPoints<FramePoint>(*cloud, frame->header);
}

}  // namespace railcast
