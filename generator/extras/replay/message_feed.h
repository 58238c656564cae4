#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/extras/dds/participant.h"
#include "core/extras/ros/bag/bag.h"
#include "generator/extras/dds/ros_writers.h"
#include "generator/extras/replay/replay_feed.h"

namespace railcast {

/// Sends the messages of a bag of ROS 2 as they are. A frame ends with each message of the first
/// topic that holds points and with what has the same time, or a second after it began. What
/// follows the last points within a second belongs to their frame, such as the transform that ends
/// railcast's bags. Where no topic holds points, each message is a frame, with those of the same
/// time.
class MessageFeed final : public ReplayFeed {
 public:
  static constexpr std::int64_t kLongest_ns = 1'000'000'000;

  /// @param topic The only one to send; empty = all.
  /// @throws InputError if there is no such topic, or nothing to send.
  MessageFeed(const std::filesystem::path& bag,
              const std::string& topic,
              double pace,
              const ReplayedFrames& frames);

  /// Begins to take part in the domain.
  /// @param place As messages name it: "domain 42, on loopback".
  /// @throws InputError as RosWriters does.
  void Join(std::unique_ptr<dds::Participant> participant, const std::string& place);

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] std::string Description() const override;
  [[nodiscard]] std::string_view sends() const override { return "messages"; }
  [[nodiscard]] bool Load() override;
  [[nodiscard]] std::int64_t begin_ns() const override { return begin_ns_; }
  void Take(Datagrams& datagrams) override { std::swap(datagrams, loaded_); }
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) override;
  void Finish() override { writers_->Finish(); }
  [[nodiscard]] UdpSender::Counts delivered() const override { return counts_; }
  [[nodiscard]] std::string LeftOut() const override;

 private:
  /// A message that was read.
  struct PendingMessage {
    std::size_t topic{};  ///< Index in topics_.
    std::int64_t time_ns{};
    std::vector<std::byte> cdr;
  };

  void ChooseTopics(const std::string& wanted);
  [[nodiscard]] std::optional<PendingMessage> FromBag();
  void Read();
  /// Whether from next_ on nothing but messages without points is left, of the second after a time.
  [[nodiscard]] bool IsTail(std::int64_t after_ns);
  /// Calls `use` for each message of the next frame.
  /// @pre next_
  template <typename Use>
  void TakeFrame(const Use& use);
  void Skip(std::uint64_t num_frames);

  std::string name_;
  std::unique_ptr<bag::BagReader> bag_;
  std::vector<dds::TopicSpec> topics_;
  std::vector<std::size_t> topic_of_;  ///< For each topic of the bag; its index in topics_.
  std::string left_out_;               ///< Names of topics.
  std::optional<std::size_t> points_;  ///< The topic that ends frames.
  ReplayTimes times_;
  ReplayedFrames frames_;
  std::optional<PendingMessage> next_;  ///< Absent at the end.
  std::deque<PendingMessage> ahead_;    ///< Read after next_.
  std::exception_ptr fault_ahead_;      ///< What reading threw after these.
  Datagrams loaded_;
  std::int64_t begin_ns_{};
  std::unique_ptr<RosWriters> writers_;
  std::string place_;
  UdpSender::Counts counts_;
};

}  // namespace railcast
