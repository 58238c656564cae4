#include "core/extras/ros/bag/bag_metadata.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast::bag {
namespace {

constexpr const char* kInformation = "rosbag2_bagfile_information";

YAML::Node DurationNode(std::int64_t seconds, std::int64_t nanoseconds) {
  YAML::Node node;
  node["sec"] = seconds;
  node["nsec"] = nanoseconds;
  return node;
}

YAML::Node QosNode(bool is_latched, MetadataVersion version) {
  const bool has_names = version == MetadataVersion::kJazzy;
  const auto policy = [&](const char* name, int number) {
    return has_names ? YAML::Node(name) : YAML::Node(number);
  };
  // ROS 2's infinity.
  const auto infinity = [] { return DurationNode(9223372036, 854775807); };
  YAML::Node qos;
  // As recorders write it, since DDS does not tell them.
  qos["history"] = policy("unknown", 3);
  qos["depth"] = 0;
  qos["reliability"] = policy("reliable", 1);
  qos["durability"] = is_latched ? policy("transient_local", 1) : policy("volatile", 2);
  qos["deadline"] = infinity();
  qos["lifespan"] = infinity();
  qos["liveliness"] = policy("automatic", 1);
  qos["liveliness_lease_duration"] = infinity();
  qos["avoid_ros_namespace_conventions"] = false;
  YAML::Node profiles(YAML::NodeType::Sequence);
  profiles.push_back(qos);
  return profiles;
}

YAML::Node TopicNode(const CountedTopic& counted, MetadataVersion version) {
  const BagTopic& topic = counted.topic;
  YAML::Node node;
  node["topic_metadata"]["name"] = topic.name;
  node["topic_metadata"]["type"] = topic.type;
  node["topic_metadata"]["serialization_format"] = topic.encoding;
  node["topic_metadata"]["offered_qos_profiles"] =
      version == MetadataVersion::kJazzy ? QosNode(topic.is_latched, version)
                                         : YAML::Node(QosText(topic.is_latched, version));
  node["topic_metadata"]["type_description_hash"] = topic.hash;
  node["message_count"] = counted.num_messages;
  return node;
}

YAML::Node MetadataNode(const BagMetadata& metadata, MetadataVersion version) {
  std::uint64_t num_messages = 0;
  YAML::Node topics(YAML::NodeType::Sequence);
  for (const CountedTopic& topic : metadata.topics) {
    num_messages += topic.num_messages;
    topics.push_back(TopicNode(topic, version));
  }
  YAML::Node node;
  node["version"] = static_cast<int>(version);
  node["storage_identifier"] = metadata.storage;
  node["duration"]["nanoseconds"] = metadata.duration_ns;
  node["starting_time"]["nanoseconds_since_epoch"] = metadata.start_ns;
  node["message_count"] = num_messages;
  node["topics_with_message_count"] = topics;
  node["compression_format"] = "";
  node["compression_mode"] = "";
  node["relative_file_paths"].push_back(metadata.file);
  YAML::Node file;
  file["path"] = metadata.file;
  file["starting_time"]["nanoseconds_since_epoch"] = metadata.start_ns;
  file["duration"]["nanoseconds"] = metadata.duration_ns;
  file["message_count"] = num_messages;
  node["files"].push_back(file);
  node["custom_data"] = YAML::Node();
  node["ros_distro"] = version == MetadataVersion::kJazzy ? "jazzy" : "";
  return node;
}

/// Returns the path in the directory of a file that metadata.yaml names; old versions put the
/// directory's name before the file's.
std::filesystem::path PartIn(const std::filesystem::path& directory, const std::string& name) {
  std::filesystem::path file = directory / std::filesystem::path(name).filename();
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) return file;
  throw InputError("relative_file_paths: must name files of the folder (got " + Quoted(name) + ")");
}

BagParts PartsOf(const YAML::Node& information, const std::filesystem::path& directory) {
  BagParts parts;
  for (const YAML::Node& file : information["relative_file_paths"]) {
    parts.files.push_back(PartIn(directory, file.as<std::string>()));
  }
  const YAML::Node mode = information["compression_mode"];
  parts.are_messages_compressed = mode && mode.IsScalar() && mode.Scalar() == "MESSAGE";
  const YAML::Node format = information["compression_format"];
  if (format && format.IsScalar() && !format.Scalar().empty() && format.Scalar() != "zstd") {
    throw InputError("compression_format: must be \"\" or \"zstd\" (got " +
                     Quoted(format.Scalar()) + ")");
  }
  return parts;
}

}  // namespace

std::string QosText(bool is_latched, MetadataVersion version) {
  return YAML::Dump(QosNode(is_latched, version));
}

bool IsLatchedQos(const std::string& profiles) {
  return profiles.find("durability: transient_local") != std::string::npos ||
         profiles.find("durability: 1") != std::string::npos;
}

std::string MetadataText(const BagMetadata& metadata, MetadataVersion version) {
  return YAML::Dump(MetadataNode(metadata, version));
}

std::string MetadataFileText(const BagMetadata& metadata, MetadataVersion version) {
  YAML::Node file;
  file[kInformation] = MetadataNode(metadata, version);
  return YAML::Dump(file) + "\n";
}

BagParts ReadBagParts(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / kMetadataFile;
  const std::string text = ReadFileWhole(file);
  return AtPlace(ShownPath(file) + ": ", [&] {
    try {
      const YAML::Node information = YAML::Load(text)[kInformation];
      if (!information || !information.IsMap()) {
        throw InputError("must hold " + std::string(kInformation));
      }
      return PartsOf(information, directory);
    } catch (const YAML::Exception& error) {
      throw InputError("must be YAML as rosbag2 writes it (" + ShownText(error.what()) + ")");
    }
  });
}

}  // namespace railcast::bag
