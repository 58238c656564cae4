#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/dds/participant.h"
#include "core/extras/ros/messages/point_layout.h"
#include "generator/extras/dds/ros_writers.h"
#include "generator/extras/replay/replay_feed.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"
#include "railcast/io/stream.h"
#include "railcast/scenario.h"

namespace railcast {

/// How the frames of a recording are replayed.
struct FrameReplaySpec {
  double pace = 1.0;  ///< How many times faster than recorded.
  /// Frames a second, instead of the recording's stamps; absent = as the stamps say.
  std::optional<double> rate_hz;
  ReplayedFrames frames;
};

/// The frames of a recording with the times at which they are replayed.
class FrameSource {
 public:
  /// @throws InputError if there is no such frame.
  FrameSource(std::unique_ptr<Recording> recording, const FrameReplaySpec& spec);

  [[nodiscard]] const RecordingInfo& info() const { return recording_->info(); }
  /// Name of the sensor, or "lidar" if it is not known.
  [[nodiscard]] std::string name() const;

  /// The first frame, before Load().
  [[nodiscard]] const RecordedFrame& first() const { return *next_; }
  /// Reads the next frame. Returns false if there is none.
  /// @throws InputError if it cannot be read, or if it has the stamp of the frame before it.
  [[nodiscard]] bool Load();

  // What belongs to the loaded frame:
  /// With its stamp as it is to be stated.
  [[nodiscard]] const RecordedFrame& StampedFrame();
  [[nodiscard]] std::int64_t begin_ns() const { return begin_ns_; }
  /// Until the next frame begins, but at most a tenth of a second; that, too, where there is none.
  [[nodiscard]] std::int64_t span_ns() const { return span_ns_; }
  /// When something of the frame is to be sent that was recorded so long after its stamp.
  [[nodiscard]] std::int64_t DueNs(std::int64_t since_stamp_ns) const {
    return begin_ns_ + times_.Lasting(since_stamp_ns);
  }

  /// Lets stamps be the times of day at which frames begin.
  /// @param begin_ns When the first one begins, since 1970-01-01 00:00:00 UTC.
  void SetClock(std::int64_t begin_ns) { utc_begin_ns_ = begin_ns; }

 private:
  [[nodiscard]] std::optional<RecordedFrame> Read();

  std::unique_ptr<Recording> recording_;
  FrameReplaySpec spec_;
  ReplayTimes times_;
  std::uint64_t num_read_{};
  std::optional<RecordedFrame> frame_;
  std::optional<RecordedFrame> next_;
  std::int64_t begin_ns_{};
  std::int64_t span_ns_{};
  std::optional<std::int64_t> utc_begin_ns_;
  std::exception_ptr fault_;  ///< Why there is no next frame.
};

/// Sends the frames of a recording as they are encoded.
class FrameFeed : public ReplayFeed {
 public:
  [[nodiscard]] std::string name() const override { return source_.name(); }
  [[nodiscard]] bool Load() override { return source_.Load(); }
  [[nodiscard]] std::int64_t begin_ns() const override { return source_.begin_ns(); }
  void SetClock(std::int64_t begin_ns) override { source_.SetClock(begin_ns); }

 protected:
  explicit FrameFeed(FrameSource source) : source_(std::move(source)) {}

  FrameSource source_;
};

/// Sends frames over UDP, in protocol railcast or in the packets of a real sensor.
class UdpFrameFeed final : public FrameFeed {
 public:
  /// @param protocol Not ros2.
  /// @param to With ports.
  /// @param fields With protocol railcast; absent = those that are sent by default and are there.
  /// @throws InputError if the recording lacks what the protocol needs, or a receiver cannot be
  ///   sent to.
  UdpFrameFeed(FrameSource source,
               Protocol protocol,
               const std::vector<Endpoint>& to,
               const std::optional<FieldSelection>& fields,
               std::uint32_t run);

  [[nodiscard]] std::string Description() const override;
  void SetClock(std::int64_t begin_ns) override;
  void Take(Datagrams& datagrams) override;
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) override {
    sender_.Send(datagrams, items);
  }
  [[nodiscard]] UdpSender::Counts delivered() const override { return sender_.counts(); }

 private:
  Protocol protocol_;
  std::vector<Endpoint> to_;
  std::int64_t first_stamp_ns_;  ///< As recorded.
  std::unique_ptr<FrameEncoder> encoder_;
  UdpSender sender_;
};

/// Sends frames on topics of ROS 2: `/SENSOR/points`, `/clock` and, where poses are known, `/tf`
/// from `map` to the sensor.
class TopicFrameFeed final : public FrameFeed {
 public:
  /// @throws InputError if the recording lacks one of the fields.
  TopicFrameFeed(FrameSource source, ros::CloudSpec clouds);

  /// As MessageFeed::Join().
  void Join(std::unique_ptr<dds::Participant> participant, const std::string& place);

  [[nodiscard]] std::string Description() const override;
  [[nodiscard]] std::string_view sends() const override { return "messages"; }
  void Take(Datagrams& datagrams) override;
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) override {
    writers_->Send(datagrams, items, counts_);
  }
  void Finish() override { writers_->Finish(); }
  [[nodiscard]] UdpSender::Counts delivered() const override { return counts_; }

 private:
  ros::CloudSpec clouds_;
  std::uint32_t num_clouds_;  ///< Clouds of a frame.
  std::string frame_id_;
  std::unique_ptr<RosWriters> writers_;
  std::string place_;
  UdpSender::Counts counts_;
};

/// The fields to send of a recording's frames.
/// @param wanted Absent = those that are sent by default and are there; all = all that are there.
/// @throws InputError "--fields: ..." if the frame lacks one.
[[nodiscard]] FieldSelection FieldsOf(const RecordedFrame& frame,
                                      const std::optional<FieldSelection>& wanted);

}  // namespace railcast
