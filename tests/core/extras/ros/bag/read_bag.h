#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"

namespace railcast::bag {

/// A message of a bag with its topic's name.
struct HeldMessage {
  std::string topic;
  std::int64_t time_ns{};
  std::string data;

  bool operator==(const HeldMessage&) const = default;
};

[[nodiscard]] inline std::vector<HeldMessage> MessagesOf(BagReader& bag) {
  std::vector<HeldMessage> messages;
  while (const auto message = bag.Next()) {
    messages.push_back(
        {bag.topics()[message->topic].name,
         message->time_ns,
         {reinterpret_cast<const char*>(message->data.data()), message->data.size()}});
  }
  return messages;
}

[[nodiscard]] inline std::vector<HeldMessage> MessagesIn(const std::filesystem::path& path) {
  return MessagesOf(*OpenBag(path));
}

/// A topic whose messages are strings.
[[nodiscard]] inline BagTopic TopicNamed(const std::string& name, bool is_latched = false) {
  return {.name = name,
          .type = "std_msgs/msg/String",
          .definition = "string data\n",
          .hash = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
          .is_latched = is_latched};
}

inline void WriteText(BagWriter& bag,
                      std::size_t topic,
                      std::int64_t time_ns,
                      const std::string& text) {
  bag.Write({topic, time_ns, std::as_bytes(std::span(text))});
}

}  // namespace railcast::bag
