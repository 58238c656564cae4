#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"
#include "generator/extras/dds/ros_output.h"
#include "generator/extras/dds/twist_message.h"

namespace railcast {
namespace {

template <typename Message>
dds::TopicSpec HeardTopic(const std::string& name) {
  const ros::MessageType& type = ros::TypeOf<Message>();
  return {.name = name, .type = type.dds_name, .hash = type.hash};
}

class TwistCommands final : public TopicCommands {
 public:
  TwistCommands(dds::Participant& participant, std::string topic, double deceleration_mps2)
      : participant_(participant),
        topic_(std::move(topic)),
        reader_(participant.AddReader(HeardTopic<ros::TwistStamped>(topic_))),
        deceleration_mps2_(deceleration_mps2) {}

  [[nodiscard]] std::optional<CommandRequest> Next(int /*timeout_ms*/) override {
    while (const auto cdr = participant_.Take(reader_)) {
      try {
        return CommandRequest{{}, {}, CommandOfTwist(*cdr, deceleration_mps2_)};
      } catch (const InputError& error) {
        Refuse({}, {error.what()});
      }
    }
    return std::nullopt;
  }

  void Acknowledge(const CommandRequest& /*request*/, std::int64_t /*time_ns*/) override {
    ++num_done_;
  }

  void Refuse(const CommandRequest& /*request*/, const std::vector<std::string>& faults) override {
    ++num_refused_;
    last_fault_ = faults.front();
  }

  [[nodiscard]] std::string Text() const override {
    return "commands on " + topic_ + ": " + std::to_string(num_done_) + " done, " +
           std::to_string(num_refused_) + " refused" +
           (num_refused_ > 0 ? "; the last one: " + ShownLines(last_fault_) : "") + "\n";
  }

 private:
  dds::Participant& participant_;
  std::string topic_;
  std::size_t reader_;
  double deceleration_mps2_;
  std::uint64_t num_done_{};
  std::uint64_t num_refused_{};
  std::string last_fault_;  ///< The last fault of a refused command.
};

class StepTopic final : public TopicCommands {
 public:
  StepTopic(RosOutput& ros, std::string topic)
      : ros_(ros),
        topic_(std::move(topic)),
        reader_(ros.participant().AddReader(HeardTopic<ros::Time>(topic_))) {}

  [[nodiscard]] std::optional<CommandRequest> Next(int timeout_ms) override {
    if (timeout_ms > 0) ros_.participant().WaitForMessage(reader_, timeout_ms);
    TakeMessages();
    const bool is_due = sent_ns_ ? done_ns_ >= sent_ns_ : done_ns_ && ros_.HasReaders();
    if (is_stepping_ || !is_due) return std::nullopt;
    is_stepping_ = true;
    return CommandRequest{{}, {}, Step{}};
  }

  void Acknowledge(const CommandRequest& /*request*/, std::int64_t time_ns) override {
    // After a restart of the run, what was done before does not count.
    if (sent_ns_ && time_ns < *sent_ns_) done_ns_.reset();
    sent_ns_ = time_ns;
    is_stepping_ = false;
  }

  void Refuse(const CommandRequest& /*request*/,
              const std::vector<std::string>& /*faults*/) override {}

  [[nodiscard]] std::string Text() const override {
    if (num_refused_ == 0) return "";
    return "steps on " + topic_ + ": " + std::to_string(num_refused_) +
           " refused; the last one: " + ShownLines(last_fault_) + "\n";
  }

 private:
  void TakeMessages() {
    while (const auto cdr = ros_.participant().Take(reader_)) {
      try {
        const auto stamp = ros::FromCdr<ros::Time>(*cdr);
        const std::int64_t time_ns = stamp.sec * kNsPerS + stamp.nanosec - ros_.clock_ahead_ns();
        done_ns_ = std::max(done_ns_.value_or(time_ns), time_ns);
      } catch (const InputError& error) {
        ++num_refused_;
        last_fault_ = error.what();
      }
    }
  }

  RosOutput& ros_;
  std::string topic_;
  std::size_t reader_;
  std::optional<std::int64_t> done_ns_;  ///< The latest stamp that was done with.
  std::optional<std::int64_t> sent_ns_;  ///< The stamp of the frames that were sent last.
  bool is_stepping_ = false;             ///< A step is under way.
  std::uint64_t num_refused_{};          ///< Messages that could not be read.
  std::string last_fault_;
};

}  // namespace

std::unique_ptr<TopicCommands> HearTwists(dds::Participant& participant,
                                          const std::string& topic,
                                          double deceleration_mps2) {
  return std::make_unique<TwistCommands>(participant, topic, deceleration_mps2);
}

std::unique_ptr<TopicCommands> HearSteps(RosOutput& ros, const std::string& topic) {
  return std::make_unique<StepTopic>(ros, topic);
}

}  // namespace railcast
