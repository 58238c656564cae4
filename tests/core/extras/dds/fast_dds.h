#pragma once

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv6TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// Readers and writers of Fast DDS, by which ROS 2 speaks unless told otherwise, set up as ROS 2
// sets them up; on loopback alone.

namespace railcast {

using MessageBytes = std::vector<std::byte>;

inline constexpr int kDdsPatience_ms = 20'000;

/// Waits for `holds`, asked every 5 ms. Returns whether it came to hold.
template <typename Holds>
bool WaitUntilTrue(const Holds& holds, int timeout_ms = kDdsPatience_ms) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// A type whose samples are the bytes on the wire.
class FastBytesType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit FastBytesType(const std::string& name) {
    setName(name.c_str());
    constexpr std::uint32_t kMostBytes = 2 << 20;
    m_typeSize = kMostBytes;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<MessageBytes*>(data);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    const auto* begin = reinterpret_cast<const std::byte*>(payload->data);
    static_cast<MessageBytes*>(data)->assign(begin, begin + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<MessageBytes*>(data)->size()); };
  }
  void* createData() override { return new MessageBytes; }
  void deleteData(void* data) override { delete static_cast<MessageBytes*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

/// The time since a message was written, as its writer says.
inline std::int64_t LatencyNs(const eprosima::fastdds::dds::SampleInfo& info) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() -
         info.source_timestamp.to_ns();
}

/// What arrived on a topic.
class FastReader final : public eprosima::fastdds::dds::DataReaderListener {
 public:
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    MessageBytes message;
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const std::lock_guard lock(mutex_);
      messages_.push_back(message);
      arrived_.notify_all();
    }
  }
  void on_subscription_matched(
      eprosima::fastdds::dds::DataReader*,
      const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override {
    const std::lock_guard lock(mutex_);
    num_writers_ = status.current_count;
    arrived_.notify_all();
  }
  [[nodiscard]] bool WaitForWriter() {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, std::chrono::milliseconds(kDdsPatience_ms),
                             [&] { return num_writers_ > 0; });
  }
  /// Waits until this many have arrived and returns all that have.
  std::vector<MessageBytes> WaitFor(std::size_t num, int timeout_ms = kDdsPatience_ms) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                      [&] { return messages_.size() >= num; });
    return messages_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<MessageBytes> messages_;
  int num_writers_ = 0;
};

/// Waits until a writer has a reader: what is written before is lost.
[[nodiscard]] inline bool WaitForReader(const eprosima::fastdds::dds::DataWriter& writer) {
  constexpr int kStep_ms = 10;
  eprosima::fastdds::dds::PublicationMatchedStatus status;
  for (int waited_ms = 0; waited_ms < kDdsPatience_ms; waited_ms += kStep_ms) {
    writer.get_publication_matched_status(status);
    if (status.current_count > 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(kStep_ms));
  }
  return false;
}

/// What a participant tells others of one of its writers.
struct SeenWriter {
  std::string type;
  std::string user_data;
  bool is_reliable = false;
  bool is_latched = false;
};

class FastParticipant final : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  /// @param receive_buffer_bytes 0 = the system's default.
  explicit FastParticipant(std::uint32_t domain,
                           std::uint32_t receive_buffer_bytes = 0,
                           bool is_ipv6 = false) {
    using eprosima::fastrtps::rtps::IPLocator;
    using namespace eprosima::fastdds::rtps;
    eprosima::fastdds::dds::DomainParticipantQos qos;
    std::shared_ptr<UDPTransportDescriptor> udp;
    if (is_ipv6) {
      udp = std::make_shared<UDPv6TransportDescriptor>();
    } else {
      udp = std::make_shared<UDPv4TransportDescriptor>();
    }
    udp->interfaceWhiteList.emplace_back(is_ipv6 ? "::1" : "127.0.0.1");
    constexpr std::uint32_t kMostParticipants = 10;
    udp->maxInitialPeersRange = kMostParticipants;
    udp->receiveBufferSize = receive_buffer_bytes;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    eprosima::fastrtps::rtps::Locator_t loopback;
    if (is_ipv6) {
      loopback.kind = LOCATOR_KIND_UDPv6;
      IPLocator::setIPv6(loopback, "::1");
    } else {
      IPLocator::setIPv4(loopback, "127.0.0.1");
    }
    qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(loopback);
    qos.wire_protocol().builtin.initialPeersList.push_back(loopback);
    qos.wire_protocol().default_unicast_locator_list.push_back(loopback);
    participant_ =
        eprosima::fastdds::dds::DomainParticipantFactory::get_instance()->create_participant(
            domain, qos, this, eprosima::fastdds::dds::StatusMask::none());
  }
  ~FastParticipant() override {
    // No callback may come once the listeners are gone.
    participant_->set_listener(nullptr);
    for (auto* reader : readers_) reader->set_listener(nullptr);
    participant_->delete_contained_entities();
    eprosima::fastdds::dds::DomainParticipantFactory::get_instance()->delete_participant(
        participant_);
  }
  FastParticipant(const FastParticipant&) = delete;
  FastParticipant& operator=(const FastParticipant&) = delete;

  /// @param topic As DDS has it: "rt/points".
  FastReader& Read(const std::string& topic, const std::string& type, bool is_latched = false) {
    auto reader = std::make_unique<FastReader>();
    FastReader& made = *reader;
    listeners_.push_back(std::move(reader));
    Read(topic, type, made, is_latched);
    return made;
  }
  /// @param listener Must outlive this object.
  void Read(const std::string& topic,
            const std::string& type,
            eprosima::fastdds::dds::DataReaderListener& listener,
            bool is_latched = false) {
    using namespace eprosima::fastdds::dds;
    DataReaderQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.type_consistency().representation.m_value.push_back(XCDR_DATA_REPRESENTATION);
    SetCommon(qos, is_latched);
    readers_.push_back(participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT)
                           ->create_datareader(TopicOf(topic, type), qos, &listener));
  }

  eprosima::fastdds::dds::DataWriter& Write(const std::string& topic, const std::string& type) {
    using namespace eprosima::fastdds::dds;
    DataWriterQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.representation().m_value.push_back(XCDR_DATA_REPRESENTATION);
    qos.publish_mode().kind =
        ASYNCHRONOUS_PUBLISH_MODE;  // Which alone sends messages in fragments.
    SetCommon(qos, false);
    DataWriter* writer = participant_->create_publisher(PUBLISHER_QOS_DEFAULT)
                             ->create_datawriter(TopicOf(topic, type), qos);
    return *writer;
  }

  /// Waits until a writer of this topic has been seen.
  [[nodiscard]] SeenWriter WaitForWriter(const std::string& topic) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(kDdsPatience_ms),
                      [&] { return seen_.contains(topic); });
    return seen_[topic];
  }
  /// The user data of a participant that has been seen.
  [[nodiscard]] std::string WaitForParticipant() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(kDdsPatience_ms),
                      [&] { return !user_data_.empty(); });
    return user_data_;
  }

  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& found) override {
    using namespace eprosima::fastdds::dds;
    const auto& info = found.info;
    const std::lock_guard lock(mutex_);
    seen_[info.topicName().to_string()] = {
        info.typeName().to_string(),
        {info.m_qos.m_userData.begin(), info.m_qos.m_userData.end()},
        info.m_qos.m_reliability.kind == RELIABLE_RELIABILITY_QOS,
        info.m_qos.m_durability.kind == TRANSIENT_LOCAL_DURABILITY_QOS};
    changed_.notify_all();
  }
  void on_participant_discovery(
      eprosima::fastdds::dds::DomainParticipant*,
      eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& found) override {
    const std::lock_guard lock(mutex_);
    user_data_.assign(found.info.m_userData.begin(), found.info.m_userData.end());
    changed_.notify_all();
  }

 private:
  template <typename Qos>
  static void SetCommon(Qos& qos, bool is_latched) {
    using namespace eprosima::fastdds::dds;
    constexpr int kRosDepth = 20;
    qos.durability().kind = is_latched ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().kind = KEEP_LAST_HISTORY_QOS;
    qos.history().depth = is_latched ? 1 : kRosDepth;
    qos.endpoint().history_memory_policy =
        eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
  }

  eprosima::fastdds::dds::Topic* TopicOf(const std::string& name, const std::string& type) {
    using namespace eprosima::fastdds::dds;
    TypeSupport support(new FastBytesType(type));
    support.register_type(participant_);
    return participant_->create_topic(name, type, TOPIC_QOS_DEFAULT);
  }

  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  std::vector<eprosima::fastdds::dds::DataReader*> readers_;
  std::vector<std::unique_ptr<FastReader>> listeners_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, SeenWriter> seen_;
  std::string user_data_;
};

/// The bytes of a message without its padding to whole words, if it has any: as many as expected.
inline MessageBytes WithoutPadding(MessageBytes got, std::size_t expected_size) {
  constexpr std::size_t kMaxPadding = 3;
  if (got.size() > expected_size && got.size() <= expected_size + kMaxPadding) {
    got.resize(expected_size);
  }
  return got;
}

}  // namespace railcast
