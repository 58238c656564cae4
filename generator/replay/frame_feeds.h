#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/dds/participant.h"
#include "core/io/ros/point_layout.h"
#include "generator/live/ros_writers.h"
#include "generator/replay/frame_source.h"
#include "generator/replay/replay_feed.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/stream.h"
#include "railcast/scenario.h"

namespace railcast {

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
  std::uint32_t num_clouds_;  ///< Of a frame.
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
