#include "core/io/recording/source_choice.h"

#include <arpa/inet.h>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/text_cloud.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/recording_kinds.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

/// Whether a source is a cloud of a kind, or a directory of them.
bool HoldsClouds(const std::filesystem::path& source,
                 bool (*is_of_kind)(const std::filesystem::path& file)) {
  if (is_regular_file(source)) return is_of_kind(source);
  const auto clouds = CloudsOfDirectory(source).files;
  return !clouds.empty() && is_of_kind(clouds.front());
}

/// Puts columns behind the sources of a kind of clouds.
/// @return Whether there are any.
bool PutColumns(const std::string& columns,
                bool (*is_of_kind)(const std::filesystem::path& file),
                std::vector<std::filesystem::path>& sources) {
  bool has_any = false;
  for (std::filesystem::path& source : sources) {
    if (!HoldsClouds(source, is_of_kind)) continue;
    source += ":" + columns;
    has_any = true;
  }
  return has_any;
}

void UseTopic(const std::string& topic, std::vector<std::filesystem::path>& sources) {
  std::size_t num_bags = 0;
  for (std::filesystem::path& source : sources) {
    if (!IsBagOfTopics(source)) continue;
    source = TopicOfBag(source, topic);
    ++num_bags;
  }
  if (num_bags > 0) return;
  for (const std::filesystem::path& source : sources) CheckExtraIsThere(source);
  throw InputError(
      "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got " +
      ShownPath(sources.front()) + ")");
}

/// Whether a source is a bag, with or without a topic behind it.
bool IsOfBag(const std::filesystem::path& source) {
  const std::string& text = source.native();
  for (std::size_t mark = text.find(kTopicMark);; mark = text.find(kTopicMark, mark + 1)) {
    if (IsBagOfTopics(text.substr(0, mark))) return true;
    if (mark == std::string::npos) return false;
  }
}

void UseFrameId(const std::string& frame_id, std::vector<std::filesystem::path>& sources) {
  std::size_t num_bags = 0;
  for (std::filesystem::path& source : sources) {
    if (!IsOfBag(source)) continue;
    // The name without a mark is that of its only topic.
    if (IsBagOfTopics(source)) source += kTopicMark;
    source += kSeriesMark + frame_id;
    ++num_bags;
  }
  if (num_bags > 0) return;
  throw InputError(
      "--frame-id: must come with a bag of ROS 2, .mcap, .db3 or a directory of them "
      "(got " +
      ShownPath(sources.front()) + ")");
}

void UseKittiColumns(const std::string& columns, std::vector<std::filesystem::path>& sources) {
  if (!IsKittiColumns(columns)) {
    throw InputError("--kitti-columns: must be 3 to 16, nuscenes, waymo or float64 (got " +
                     ShownText(columns) + ")");
  }
  if (PutColumns(columns, IsKittiFile, sources)) return;
  throw InputError("--kitti-columns: must come with .bin files or a directory of them (got " +
                   ShownPath(sources.front()) + ")");
}

void UseTextColumns(const std::string& columns, std::vector<std::filesystem::path>& sources) {
  if (!IsTextColumns(columns)) {
    throw InputError(
        "--columns: must be the names of columns, x, y and z among them, each once, and _ for "
        "those that are not used, as in x,y,z,_,intensity (got " +
        ShownText(columns) + ")");
  }
  if (PutColumns(columns, IsTextCloud, sources)) return;
  throw InputError("--columns: must come with clouds in text, " +
                   JoinInProse(TextCloudEndings(true), " or ") + ", or a directory of them (got " +
                   ShownPath(sources.front()) + ")");
}

void UseSensor(const std::string& sensor, std::vector<std::filesystem::path>& sources) {
  std::size_t num_captures = 0;
  for (std::filesystem::path& source : sources) {
    if (!RecordingExtras::Get().IsOf("--sensor", source)) continue;
    source += ":" + sensor;
    ++num_captures;
  }
  if (num_captures == 0) {
    for (const std::filesystem::path& source : sources) CheckExtraIsThere(source);
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
  if (!choice.frame_id.empty()) UseFrameId(choice.frame_id, sources);
  if (!choice.kitti_columns.empty()) UseKittiColumns(choice.kitti_columns, sources);
  if (!choice.columns.empty()) UseTextColumns(choice.columns, sources);
  if (!choice.sensor.empty()) UseSensor(choice.sensor, sources);
  return sources;
}

std::optional<Endpoint> ParseSender(std::string_view text) {
  std::string host(text);
  std::string_view port;
  const std::size_t bracket = text.find(']');
  const bool is_in_brackets = text.starts_with('[') && bracket != std::string_view::npos;
  const std::size_t colon = is_in_brackets ? text.find(':', bracket) : text.rfind(':');
  const bool has_port = is_in_brackets || text.find(':') == colon;
  if (has_port && colon != std::string_view::npos) {
    if (is_in_brackets && colon != bracket + 1) return std::nullopt;
    port = text.substr(colon + 1);
    host.resize(colon);
  }
  if (is_in_brackets) host = host.substr(1, bracket - 1);
  Endpoint sender;
  if (!port.empty() || host.size() < text.size() - (is_in_brackets ? 2U : 0U)) {
    const auto number = ParseNumber<std::uint16_t>(port);
    if (!number || *number == 0) return std::nullopt;
    sender.port = *number;
  }
  in_addr ipv4{};
  if (::inet_pton(AF_INET, host.c_str(), &ipv4) == 1) {
    sender.address = IpAddress(ntohl(ipv4.s_addr));
    return sender;
  }
  if (::inet_pton(AF_INET6, host.c_str(), sender.address.bytes.data()) == 1) return sender;
  return std::nullopt;
}

}  // namespace railcast
