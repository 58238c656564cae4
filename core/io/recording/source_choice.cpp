#include "core/io/recording/with_topic.h"

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/io/recording.h"

namespace railcast {

std::vector<std::filesystem::path> WithTopic(std::vector<std::filesystem::path> sources,
                                             const std::string& topic) {
  if (topic.empty()) return sources;
  std::size_t num_bags = 0;
  for (std::filesystem::path& source : sources) {
    if (!IsBagOfTopics(source)) continue;
    source = TopicOfBag(source, topic);
    ++num_bags;
  }
  if (num_bags > 0) return sources;
  throw InputError(
      "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got " +
      ShownPath(sources.front()) + ")");
}

}  // namespace railcast
