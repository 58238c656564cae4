#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"

namespace railcast::bag {

/// The file of a rosbag2 directory that says what it holds.
inline constexpr const char* kMetadataFile = "metadata.yaml";

/// The forms in which ROS 2 writes what a bag holds.
enum class MetadataVersion {
  /// Humble to Rolling read it; policies of QoS are numbers. For MCAP, which has one file for all.
  kIron = 8,
  kJazzy = 9,  ///< Policies of QoS are names.
};

/// A topic and how many messages it has.
struct CountedTopic {
  BagTopic topic;
  std::uint64_t num_messages{};
};

/// What a bag of one file says of itself.
struct BagMetadata {
  std::string storage;                                               ///< "mcap" or "sqlite3"
  std::string file;                                                  ///< Name of the file.
  std::int64_t start_ns = std::numeric_limits<std::int64_t>::max();  ///< So without messages.
  std::int64_t duration_ns{};
  std::vector<CountedTopic> topics;
};

/// Returns the profiles of QoS that a topic was offered with, as YAML: reliable, and transient
/// local where it is latched.
[[nodiscard]] std::string QosText(bool is_latched, MetadataVersion version);

/// Whether profiles of QoS, as YAML of any version, keep messages for late subscribers.
[[nodiscard]] bool IsLatchedQos(const std::string& profiles);

/// Returns the metadata as YAML, as ROS 2 embeds it in bags.
[[nodiscard]] std::string MetadataText(const BagMetadata& metadata, MetadataVersion version);

/// Returns the content of metadata.yaml.
[[nodiscard]] std::string MetadataFileText(const BagMetadata& metadata, MetadataVersion version);

/// What metadata.yaml says of how to read a bag.
struct BagParts {
  std::vector<std::filesystem::path> files;
  bool are_messages_compressed{};  ///< Each by zstd.
};

/// Reads the metadata.yaml of any version in a directory.
/// @throws InputError "file: place: rule (got value)" if it is none or is damaged, or if a file
///   that it names is not there.
[[nodiscard]] BagParts ReadBagParts(const std::filesystem::path& directory);

}  // namespace railcast::bag
