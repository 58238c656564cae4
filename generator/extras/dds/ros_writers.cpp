#include "generator/extras/dds/ros_writers.h"

#include <utility>

namespace railcast {
namespace {

constexpr int kLastWait_ms = 1000;

}  // namespace

void AppendMessage(std::size_t topic,
                   std::span<const std::byte> cdr,
                   std::int64_t due_ns,
                   Datagrams& datagrams) {
  datagrams.Append(
      {reinterpret_cast<const char*>(cdr.data()), cdr.size()},
      {.port = DatagramPort::kData, .due_ns = due_ns, .topic = static_cast<std::uint16_t>(topic)});
}

RosWriters::RosWriters(std::unique_ptr<dds::Participant> participant,
                       const std::vector<dds::TopicSpec>& topics)
    : participant_(std::move(participant)) {
  for (const dds::TopicSpec& topic : topics) writers_.push_back(participant_->AddWriter(topic));
}

bool RosWriters::HasReaders(std::size_t topic) const {
  return participant_->NumReaders(writers_[topic]) > 0;
}

bool RosWriters::Write(std::size_t topic, std::span<const std::byte> cdr) {
  return participant_->Write(writers_.at(topic), cdr);
}

void RosWriters::Send(const Datagrams& datagrams,
                      std::span<const Datagrams::Item> items,
                      UdpSender::Counts& counts) {
  for (const Datagrams::Item& item : items) {
    const bool is_sent = Write(item.topic, std::as_bytes(datagrams.BytesOf(item)));
    ++(is_sent ? counts.sent : counts.refused);
  }
}

void RosWriters::Finish() {
  participant_->WaitForReaders(kLastWait_ms);
}

}  // namespace railcast
