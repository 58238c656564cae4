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

#include "railcast/io/stream.h"

namespace railcast {

/// Receives a stream in the railcast protocol through the pcl::Grabber interface.
///
/// Signals, each emitted once per frame from one thread owned by the grabber:
/// - `void(const std::shared_ptr<const ReceivedFrame>&)`
/// - `void(const std::shared_ptr<const pcl::PCLPointCloud2>&)`: every field that was sent
/// - `void(const pcl::PointCloud<P>::ConstPtr&)`, P = PointXYZ, PointXYZI, PointXYZL and those of
///   railcast/io/point_types.h, if the stream has all fields of P. By default, streams have those
///   of LabelledPoint.
///
/// Clouds hold the points that arrived, even if the frame is incomplete. header.stamp is in
/// microseconds and header.seq is the frame number. sensor_origin_ and sensor_orientation_ are the
/// world pose at the stamp, in float32 as PCL defines them (double precision: ReceivedFrame); they
/// are the identity if the points are not in the sensor's axes.
///
/// If a callback is too slow, frames are dropped (counts().dropped_frames); memory stays bounded.
///
///     UdpGrabber grabber;
///     std::function<void(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr&)> show = ...;
///     grabber.registerCallback(show);
///     grabber.start();
class UdpGrabber : public pcl::Grabber {
 public:
  using Counts = StreamReceiver::Counts;

  /// @param at Endpoint to listen at once started; port 0 selects a free port.
  /// @param wanted The stream to receive if several arrive at the port.
  explicit UdpGrabber(const Endpoint& at = {0x7F000001, kStreamPort},
                      const WantedStream& wanted = {});
  ~UdpGrabber() noexcept override;

  /// Starts receiving, with all counts reset to 0. Does nothing if already running.
  /// @throws InputError if the port cannot be opened.
  void start() override;
  /// Stops receiving. When it returns, the port is free, a callback in progress has finished, and
  /// no further one begins. If a callback itself calls stop(), the call returns at once and the
  /// remaining signals of the current frame are still emitted.
  void stop() override;
  [[nodiscard]] std::string getName() const override { return "railcast::UdpGrabber"; }
  [[nodiscard]] bool isRunning() const override;
  /// Average over the last few seconds; 0 before the second frame and when stopped.
  [[nodiscard]] float getFramesPerSecond() const override;

  /// The endpoint at which the grabber listens, or will listen once started.
  [[nodiscard]] Endpoint at() const;
  /// Counts since the last start. Thread-safe.
  [[nodiscard]] Counts counts() const;

 private:
  void Work();
  void Emit(const std::shared_ptr<const ReceivedFrame>& frame);
  void NoteArrival();
  template <typename Point>
  void EmitPoints(const pcl::PCLPointCloud2& cloud, const StreamHeader& header);

  const Endpoint listens_at_;
  const WantedStream wanted_;
  mutable std::mutex mutex_;  ///< Guards all members below.
  std::condition_variable changed_;
  std::shared_ptr<StreamReceiver> receiver_;  ///< Null unless running.
  /// Receiver whose frame the thread is waiting for or emitting.
  std::shared_ptr<StreamReceiver> busy_with_;
  Endpoint at_;
  Counts last_counts_;             ///< Final counts of the run that was stopped last.
  std::deque<double> arrivals_s_;  ///< Arrival times of the last frames, on the steady clock.
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace railcast
