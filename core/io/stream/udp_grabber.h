#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/grabber.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/io/net/endpoint.h"
#include "core/io/stream/stream_format.h"
#include "core/io/stream/stream_receiver.h"

namespace railcast {

/// A stream in the railcast protocol for any program that knows pcl::Grabber.
///
/// Signals, each once a frame and from one thread of the grabber's own:
/// - `void(const std::shared_ptr<const ReceivedFrame>&)`
/// - `void(const std::shared_ptr<const pcl::PCLPointCloud2>&)`: every field that was sent
/// - `void(const pcl::PointCloud<P>::ConstPtr&)`, P = PointXYZ, and, where the stream has intensity
///   or label, PointXYZI, PointXYZL
///
/// Clouds hold the points that arrived, also of incomplete frames. header.stamp is in microseconds,
/// header.seq the frame number; sensor_origin_ and sensor_orientation_ are the pose at the stamp in
/// the world, float32 as PCL has them (the ReceivedFrame's is double); the identity where points
/// are in other axes than the sensor's.
///
/// A callback that is too slow loses frames (counts().dropped_frames), never memory.
class UdpGrabber : public pcl::Grabber {
 public:
  using Counts = StreamReceiver::Counts;

  /// @param at Where to listen once started; port 0 takes a free one.
  /// @param wanted Whose frames are given, if several send to the port.
  explicit UdpGrabber(const Endpoint& at = {0x7F000001, kStreamPort},
                      const WantedStream& wanted = {});
  ~UdpGrabber() noexcept override;

  /// Does nothing while running. Counts begin at 0.
  /// @throws InputError if the port cannot be listened to.
  void start() override;
  /// The port is free and no callback begins after it returns; one that is under way is waited for.
  /// A callback may call it, too: then it waits for nothing, and what is left of its frame still
  /// comes.
  void stop() override;
  [[nodiscard]] std::string getName() const override { return "railcast::UdpGrabber"; }
  [[nodiscard]] bool isRunning() const override;
  /// Over the last seconds; 0 before the second frame and when stopped.
  [[nodiscard]] float getFramesPerSecond() const override;

  /// Where it listens, or would.
  [[nodiscard]] Endpoint at() const;
  /// Since the last start. Thread-safe.
  [[nodiscard]] Counts counts() const;

 private:
  void Work();
  void Emit(const std::shared_ptr<const ReceivedFrame>& frame);
  void NoteArrival();
  template <typename Point>
  void EmitPoints(const pcl::PCLPointCloud2& cloud, const Transform& world_from_sensor);

  const Endpoint listens_at_;
  const WantedStream wanted_;
  mutable std::mutex mutex_;  ///< Of all that follows.
  std::condition_variable changed_;
  std::shared_ptr<StreamReceiver> receiver_;   ///< Null unless running.
  std::shared_ptr<StreamReceiver> busy_with_;  ///< Whose frame the thread waits for or gives.
  Endpoint at_;
  Counts last_counts_;             ///< Of the run that was stopped.
  std::deque<double> arrivals_s_;  ///< Of the last frames, on the steady clock.
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace railcast
