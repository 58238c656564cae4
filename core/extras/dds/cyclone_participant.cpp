#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsrt/log.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/extras/dds/domain_config.h"
#include "core/extras/dds/participant.h"
#include "core/extras/dds/raw_type.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/discovery_messages.h"
#include "core/extras/ros/messages/message_type.h"

namespace railcast::dds {
namespace {

using EntityGid = ros::Gid<ros::kGidSize>;

/// The topic on which ROS 2's participants tell the names of their nodes; it has no leading "/".
TopicSpec NodesTopic() {
  const ros::MessageType& type = ros::TypeOf<ros::ParticipantEntitiesInfo<>>();
  return {
      .name = "ros_discovery_info", .type = type.dds_name, .hash = type.hash, .is_latched = true};
}

/// The message of a participant with one node, as ROS 2 reads it since Iron. Humble's has longer
/// ids: there `ros2 node list` does not show the node, and `ros2 topic` shows all.
std::vector<std::byte> NodesMessage(const EntityGid& participant,
                                    const std::string& node,
                                    const std::vector<EntityGid>& writers,
                                    const std::vector<EntityGid>& readers) {
  ros::ParticipantEntitiesInfo<> info;
  info.gid = participant;
  info.node_entities_info_seq.push_back({.node_namespace = {"/"},
                                         .node_name = {node},
                                         .reader_gid_seq = readers,
                                         .writer_gid_seq = writers});
  return ros::ToCdr(info);
}

// Prefix of all topics of ROS 2; `ros_discovery_info` alone has none.
constexpr const char* kTopicPrefix = "rt";

/// Cyclone DDS reports faults by return codes and writes what is behind them to a log, the whole
/// process's, on stderr. Here the last line of it is kept for the message of an error.
class LogKeeper {
 public:
  static LogKeeper& Get() {
    static LogKeeper keeper;
    return keeper;
  }
  [[nodiscard]] std::string TakeLast() {
    const std::lock_guard lock(mutex_);
    return std::exchange(last_, "");
  }

 private:
  LogKeeper() {
    ::dds_set_log_sink(Keep, this);
    ::dds_set_trace_sink(Keep, this);
  }
  static void Keep(void* keeper, const dds_log_data_t* line) {
    auto& self = *static_cast<LogKeeper*>(keeper);
    const std::lock_guard lock(self.mutex_);
    self.last_.assign(line->message, ::strcspn(line->message, "\n"));
  }

  std::mutex mutex_;
  std::string last_;
};

/// @param doing "writing /points"
dds_entity_t Made(dds_entity_t entity, const std::string& doing) {
  if (entity >= 0) return entity;
  const std::string why = LogKeeper::Get().TakeLast();
  throw InputError("DDS: " + doing + ": " + ::dds_strretcode(entity) +
                   (why.empty() ? "" : ", " + why));
}

/// An entity with all that was made of it, its threads too.
class Entity {
 public:
  Entity(dds_entity_t entity, const std::string& doing) : entity_(Made(entity, doing)) {}
  ~Entity() { ::dds_delete(entity_); }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;

  [[nodiscard]] dds_entity_t get() const { return entity_; }

 private:
  dds_entity_t entity_;
};

using Qos = std::unique_ptr<dds_qos_t, decltype(&::dds_delete_qos)>;

Qos MakeQos() {
  return {::dds_create_qos(), ::dds_delete_qos};
}

/// ROS 2's defaults, and what it reads beside them: the hash of the type.
Qos QosOf(const TopicSpec& topic) {
  Qos qos = MakeQos();
  const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
  ::dds_qset_data_representation(qos.get(), 1, &plain);
  ::dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
  ::dds_qset_durability(
      qos.get(), topic.is_latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  ::dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, topic.is_latched ? 1 : kDepth);
  if (topic.hash.empty()) return qos;
  const std::string data = "typehash=" + topic.hash + ";";
  ::dds_qset_userdata(qos.get(), data.data(), data.size());
  return qos;
}

/// What ROS 2 expects of each participant: the name of a security enclave.
Qos QosOfParticipant() {
  Qos qos = MakeQos();
  constexpr std::string_view kData = "enclave=/;";
  ::dds_qset_userdata(qos.get(), kData.data(), kData.size());
  return qos;
}

std::string ConfigOf(const ParticipantSpec& spec) {
  static_cast<void>(LogKeeper::Get());
  return DomainConfig(spec, InterfaceAddresses());
}

EntityGid GidOf(dds_entity_t entity) {
  dds_guid_t guid{};
  Made(::dds_get_guid(entity, &guid), "asking for an id");
  EntityGid gid;
  static_assert(sizeof guid.v == sizeof gid.data);
  std::memcpy(gid.data.data(), guid.v, sizeof guid.v);
  return gid;
}

class CycloneParticipant final : public Participant {
 public:
  explicit CycloneParticipant(const ParticipantSpec& spec)
      : node_(spec.node),
        domain_(::dds_create_domain(spec.domain, ConfigOf(spec).c_str()),
                "joining domain " + std::to_string(spec.domain)),
        participant_(::dds_create_participant(spec.domain, QosOfParticipant().get(), nullptr),
                     "joining domain " + std::to_string(spec.domain)) {}

  std::size_t AddWriter(const TopicSpec& topic) override {
    writers_.push_back(MakeWriter(topic, kTopicPrefix + topic.name));
    return writers_.size() - 1;
  }

  std::size_t AddReader(const TopicSpec& topic) override {
    const Typed of = MakeTopic(topic, kTopicPrefix + topic.name);
    readers_.push_back(
        Made(::dds_create_reader(participant_.get(), of.entity, QosOf(topic).get(), nullptr),
             "reading " + topic.name));
    return readers_.size() - 1;
  }

  void Announce() override {
    std::vector<EntityGid> writers;
    std::vector<EntityGid> readers;
    for (const Typed& writer : writers_) writers.push_back(GidOf(writer.entity));
    for (const dds_entity_t reader : readers_) readers.push_back(GidOf(reader));
    const TopicSpec topic = NodesTopic();
    if (!nodes_) nodes_ = MakeWriter(topic, topic.name);
    const auto message = NodesMessage(GidOf(participant_.get()), node_, writers, readers);
    Made(WriteTo(*nodes_, message), "telling the name of the node");
  }

  bool Write(std::size_t writer, std::span<const std::byte> cdr) override {
    return WriteTo(writers_.at(writer), cdr) == DDS_RETCODE_OK;
  }

  std::optional<std::vector<std::byte>> Take(std::size_t reader) override {
    while (true) {
      ddsi_serdata* sample = nullptr;
      dds_sample_info_t info{};
      if (::dds_takecdr(readers_.at(reader), &sample, 1, &info, DDS_ANY_STATE) <= 0) return {};
      std::optional<std::vector<std::byte>> bytes;
      if (info.valid_data) bytes = BytesOf(sample);
      ::ddsi_serdata_unref(sample);
      // Others tell that a writer has gone.
      if (bytes) return bytes;
    }
  }

  void WaitForMessage(std::size_t reader, int timeout_ms) override {
    const std::string doing = "waiting for a message";
    const Entity waits(::dds_create_waitset(participant_.get()), doing);
    const Entity has_any(::dds_create_readcondition(readers_.at(reader), DDS_ANY_STATE), doing);
    Made(::dds_waitset_attach(waits.get(), has_any.get(), 0), doing);
    ::dds_waitset_wait(waits.get(), nullptr, 0, DDS_MSECS(timeout_ms));
  }

  std::size_t NumReaders(std::size_t writer) const override {
    dds_publication_matched_status_t status{};
    Made(::dds_get_publication_matched_status(writers_.at(writer).entity, &status),
         "asking for the readers");
    return status.current_count;
  }

  void WaitForReaders(int timeout_ms) override {
    const dds_time_t end_ns = ::dds_time() + DDS_MSECS(timeout_ms);
    for (const Typed& writer : writers_) {
      const dds_duration_t left_ns = std::max<dds_duration_t>(0, end_ns - ::dds_time());
      ::dds_wait_for_acks(writer.entity, left_ns);
    }
  }

 private:
  /// A topic or a writer, and the type as the domain has it.
  struct Typed {
    dds_entity_t entity{};
    const ddsi_sertype* type = nullptr;
  };

  [[nodiscard]] Typed MakeTopic(const TopicSpec& topic, const std::string& name) const {
    ddsi_sertype* type = MakeRawType(topic.type);
    const dds_entity_t entity = ::dds_create_topic_sertype(participant_.get(), name.c_str(), &type,
                                                           nullptr, nullptr, nullptr);
    if (entity < 0) ::ddsi_sertype_unref(type);
    return {Made(entity, "topic " + topic.name + " of " + topic.type), type};
  }

  [[nodiscard]] Typed MakeWriter(const TopicSpec& topic, const std::string& name) const {
    const Typed of = MakeTopic(topic, name);
    return {Made(::dds_create_writer(participant_.get(), of.entity, QosOf(topic).get(), nullptr),
                 "writing " + topic.name),
            of.type};
  }

  static dds_return_t WriteTo(const Typed& writer, std::span<const std::byte> cdr) {
    return ::dds_writecdr(writer.entity, MakeRawSample(writer.type, cdr));
  }

  std::string node_;
  Entity domain_;
  Entity participant_;
  std::vector<Typed> writers_;
  std::vector<dds_entity_t> readers_;
  std::optional<Typed> nodes_;  ///< Writes `ros_discovery_info`.
};

}  // namespace

std::unique_ptr<Participant> Join(const ParticipantSpec& spec) {
  return std::make_unique<CycloneParticipant>(spec);
}

}  // namespace railcast::dds
