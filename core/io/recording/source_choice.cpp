#include "core/io/recording/source_choice.h"

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/recording/capture_sensor.h"
#include "core/io/recording/recording_kinds.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

bool HoldsKittiClouds(const std::filesystem::path& source) {
  if (!is_directory(source)) return IsKittiFile(source);
  const auto clouds = CloudsOfDirectory(source);
  return !clouds.empty() && IsKittiFile(clouds.front());
}

void UseTopic(const std::string& topic, std::vector<std::filesystem::path>& sources) {
  std::size_t num_bags = 0;
  for (std::filesystem::path& source : sources) {
    if (!IsBagOfTopics(source)) continue;
    source = TopicOfBag(source, topic);
    ++num_bags;
  }
  if (num_bags > 0) return;
  throw InputError(
      "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got " +
      ShownPath(sources.front()) + ")");
}

void UseColumns(const std::string& columns, std::vector<std::filesystem::path>& sources) {
  if (!IsKittiColumns(columns)) {
    throw InputError("--kitti-columns: must be 3 to 16, nuscenes, waymo or float64 (got " +
                     ShownText(columns) + ")");
  }
  std::size_t num_sources = 0;
  for (std::filesystem::path& source : sources) {
    if (!HoldsKittiClouds(source)) continue;
    source += ":" + columns;
    ++num_sources;
  }
  if (num_sources > 0) return;
  throw InputError("--kitti-columns: must come with .bin files or a directory of them (got " +
                   ShownPath(sources.front()) + ")");
}

void UseSensor(const std::string& sensor, std::vector<std::filesystem::path>& sources) {
  std::size_t num_captures = 0;
  for (std::filesystem::path& source : sources) {
    if (!FindCapture(source)) continue;
    source += ":" + sensor;
    ++num_captures;
  }
  if (num_captures == 0) {
    throw InputError("--sensor: must come with a capture, .pcap or .pcapng (got " +
                     ShownPath(sources.front()) + ")");
  }
  if (ParseSender(sensor)) return;
  throw InputError("--sensor: must be the ADDRESS or ADDRESS:PORT of a sensor, such as " +
                   std::string("192.168.1.201:2368 (got ") + ShownText(sensor) + ")");
}

}  // namespace

std::vector<std::filesystem::path> WithChoice(std::vector<std::filesystem::path> sources,
                                              const SourceChoice& choice) {
  if (!choice.topic.empty()) UseTopic(choice.topic, sources);
  if (!choice.kitti_columns.empty()) UseColumns(choice.kitti_columns, sources);
  if (!choice.sensor.empty()) UseSensor(choice.sensor, sources);
  return sources;
}

}  // namespace railcast
