#include "generator/extras/replay/message_feed.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/messages/message_type.h"
#include "core/extras/ros/recording/bag_recording.h"

namespace railcast {
namespace {

/// Some recorders leave out the first slash.
std::string FullName(const std::string& topic) {
  return topic.starts_with('/') ? topic : '/' + topic;
}

/// Whether it is a topic of ROS 2: bags of MCAP hold others, too.
bool IsOfRos(const bag::BagTopic& topic) {
  return topic.encoding == "cdr" && dds::IsTopicName(FullName(topic.name)) &&
         dds::IsTopicName('/' + topic.type) && std::ranges::count(topic.type, '/') == 2;
}

/// Whether a time is more than a frame's longest after another. Hostile bags have any time.
bool IsTooLate(std::int64_t time_ns, std::int64_t begin_ns) {
  std::int64_t since_ns = 0;
  return __builtin_sub_overflow(time_ns, begin_ns, &since_ns) ||
         since_ns > MessageFeed::kLongest_ns;
}

}  // namespace

MessageFeed::MessageFeed(const std::filesystem::path& bag,
                         const std::string& topic,
                         double pace,
                         const ReplayedFrames& frames)
    : name_(ShownPath(bag.filename())), bag_(bag::OpenBag(bag)), times_(pace), frames_(frames) {
  for (const Remark& remark : bag_->remarks()) Publish(remark);
  AtPlace(ShownPath(bag) + ": ", [&] { ChooseTopics(topic); });
  Read();
  Skip(frames.start);
  if (!next_) throw NoSuchFrame(ShownPath(bag), frames.start);
}

void MessageFeed::ChooseTopics(const std::string& wanted) {
  std::vector<std::size_t> chosen;
  std::string names;
  std::map<std::pair<std::string, std::string>, std::size_t> known;  // By name and type.
  topic_of_.resize(bag_->topics().size());
  for (std::size_t i = 0; i < bag_->topics().size(); ++i) {
    const bag::BagTopic& topic = bag_->topics()[i];
    std::string& list = IsOfRos(topic) ? names : left_out_;
    list += (list.empty() ? "" : ", ") + ShownText(topic.name);
    if (!IsOfRos(topic) || (!wanted.empty() && FullName(topic.name) != FullName(wanted))) continue;
    chosen.push_back(i);
    // The same topic may be recorded of several nodes.
    const auto [same, is_new] =
        known.try_emplace({FullName(topic.name), topic.type}, topics_.size());
    topic_of_[i] = same->second;
    if (!is_new) continue;
    if (!points_ && HoldsPoints(topic)) points_ = topics_.size();
    topics_.push_back({.name = FullName(topic.name),
                       .type = ros::DdsName(topic.type),
                       .hash = topic.hash,
                       .is_latched = topic.is_latched});
  }
  if (names.empty()) throw InputError("must have a topic of ROS 2, in CDR (got none)");
  if (chosen.empty()) {
    throw InputError("--topic: must be one of " + names + " (got " + ShownText(wanted) + ")");
  }
  if (!wanted.empty()) left_out_.clear();
  bag_->Select(chosen);
}

void MessageFeed::Join(std::unique_ptr<dds::Participant> participant, const std::string& place) {
  writers_ = std::make_unique<RosWriters>(std::move(participant), topics_);
  writers_->participant().Announce();
  place_ = place;
}

std::string MessageFeed::Description() const {
  return name_ + ": " + NumberText(topics_.size()) +
         (topics_.size() == 1 ? " topic in " : " topics in ") + place_;
}

std::optional<MessageFeed::PendingMessage> MessageFeed::FromBag() {
  const auto message = bag_->Next();
  if (!message) return std::nullopt;
  return PendingMessage{
      topic_of_[message->topic], message->time_ns, {message->data.begin(), message->data.end()}};
}

void MessageFeed::Read() {
  next_.reset();
  if (!ahead_.empty()) {
    next_ = std::move(ahead_.front());
    ahead_.pop_front();
  } else if (fault_ahead_) {
    std::rethrow_exception(fault_ahead_);
  } else {
    next_ = FromBag();
  }
}

bool MessageFeed::IsTail(std::int64_t after_ns) {
  const auto belongs = [&](const PendingMessage& message) {
    return message.topic != *points_ && !IsTooLate(message.time_ns, after_ns);
  };
  if (!points_ || !ahead_.empty() || !belongs(*next_)) return false;
  try {
    while (auto message = FromBag()) {
      ahead_.push_back(std::move(*message));
      if (!belongs(ahead_.back())) return false;
    }
  } catch (...) {
    // What was read before is sent first.
    fault_ahead_ = std::current_exception();
    return false;
  }
  return true;
}

template <typename Use>
void MessageFeed::TakeFrame(const Use& use) {
  const std::int64_t begin_ns = next_->time_ns;
  bool has_points = false;
  bool is_tail = false;
  while (next_) {
    const std::int64_t time_ns = next_->time_ns;
    use(*next_);
    has_points = has_points || !points_ || next_->topic == *points_;
    Read();
    if (!next_) return;
    const bool is_over = has_points && next_->time_ns != time_ns;
    is_tail = is_tail || (is_over && IsTail(time_ns));
    if (!is_tail && (is_over || IsTooLate(next_->time_ns, begin_ns))) return;
  }
}

void MessageFeed::Skip(std::uint64_t num_frames) {
  for (; num_frames > 0 && next_; --num_frames) {
    TakeFrame([&](const PendingMessage& message) {
      // What late subscribers get holds from there on.
      if (topics_[message.topic].is_latched) AppendMessage(message.topic, message.cdr, 0, loaded_);
    });
  }
}

bool MessageFeed::Load() {
  if (!next_ || frames_.count == 0U) return false;
  if (frames_.count) --*frames_.count;
  begin_ns_ = times_.Of(next_->time_ns);
  TakeFrame([&](const PendingMessage& message) {
    AppendMessage(message.topic, message.cdr, times_.Of(message.time_ns), loaded_);
  });
  return true;
}

void MessageFeed::Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  writers_->Send(datagrams, items, counts_);
}

std::string MessageFeed::LeftOut() const {
  return left_out_.empty() ? "" : "topics that are not of ROS 2: " + left_out_;
}

}  // namespace railcast
