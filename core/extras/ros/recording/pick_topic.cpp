#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/unread_formats.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/extras/ros/recording/message_packets.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/recording/recording_kinds.h"

namespace railcast {
namespace {

/// A topic with its type and, if points of this type are known but not read, what to do.
std::string Described(const bag::BagTopic& topic) {
  const std::string_view advice = AdviceOnType(topic.type, topic.encoding);
  return ShownText(topic.name) + " of " + ShownText(topic.type) +
         (advice.empty() ? "" : ", " + std::string(advice));
}

/// The topics of a bag of which none can be read.
std::string Described(const std::vector<bag::BagTopic>& topics) {
  constexpr std::size_t kMost = 40;
  std::string text;
  for (std::size_t i = 0; i < std::min(topics.size(), kMost); ++i) {
    text += (i == 0 ? "" : "; ") + Described(topics[i]);
  }
  if (topics.size() > kMost) text += "; and " + NumberText(topics.size() - kMost) + " others";
  return text.empty() ? "none" : text;
}

/// Throws if a topic's messages are of several types or encodings, of which one would be read.
void CheckIsOne(const std::vector<bag::BagTopic>& topics,
                std::size_t picked,
                const std::string& place) {
  for (const bag::BagTopic& other : topics) {
    if (&other == &topics[picked] || other.name != topics[picked].name) continue;
    throw InputError(place + ShownText(other.name) + ": must be a topic of one type (got " +
                     ShownText(topics[picked].type) + " as cdr and " + ShownText(other.type) +
                     " as " + ShownText(other.encoding) + ")");
  }
}

}  // namespace

std::optional<BagSource> FindBag(const std::filesystem::path& source) {
  if (bag::IsBag(source)) return BagSource{source};
  const std::string& text = source.native();
  for (std::size_t mark = text.find(kTopicMark); mark != std::string::npos;
       mark = text.find(kTopicMark, mark + 1)) {
    const std::filesystem::path bag = text.substr(0, mark);
    if (!bag::IsBag(bag)) continue;
    const std::string behind = text.substr(mark + 1);
    const std::size_t end = std::min(behind.find(kSeriesMark), behind.size());
    return BagSource{bag, end == 1 ? "" : behind.substr(0, end),
                     end == behind.size() ? "" : behind.substr(end + 1)};
  }
  return std::nullopt;
}

bool IsOfLivox(const bag::BagTopic& topic) {
  const auto& older = ros::LivoxCloud::kOlderNames;
  return topic.type == ros::LivoxCloud::kName ||
         std::ranges::find(older, topic.type) != older.end();
}

bool HoldsPoints(const bag::BagTopic& topic) {
  return topic.encoding == "cdr" && (topic.type == ros::PointCloud2::kName || IsOfLivox(topic) ||
                                     FindPacketsOf(topic.type) != nullptr);
}

std::size_t PickTopic(const std::vector<bag::BagTopic>& topics,
                      const std::filesystem::path& bag,
                      const std::string& name) {
  const std::string place = ShownPath(bag) + ": ";
  std::string names;
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (!HoldsPoints(topics[i])) continue;
    candidates.push_back(i);
    names += (names.empty() ? "" : ", ") + ShownText(topics[i].name);
    // Some recorders leave out the first slash.
    if (topics[i].name != name && '/' + topics[i].name != name) continue;
    CheckIsOne(topics, i, place);
    return i;
  }
  if (candidates.empty()) {
    throw InputError(place + "must have a topic of type " + std::string(ros::PointCloud2::kName) +
                     " or of a sensor's packets (got " + Described(topics) + ")");
  }
  if (!name.empty()) {
    const auto other = std::ranges::find(topics, name, &bag::BagTopic::name);
    throw InputError(place + "--topic: must be one of " + names + " (got " +
                     (other == topics.end() ? ShownText(name) : Described(*other)) + ")");
  }
  if (candidates.size() > 1) {
    throw InputError(place + "--topic: must be one of " + names + " (got none)");
  }
  CheckIsOne(topics, candidates.front(), place);
  return candidates.front();
}

}  // namespace railcast
