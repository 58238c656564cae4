#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/ros/bag/bag.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A bag, one of its topics and a series of that.
struct BagSource {
  std::filesystem::path bag;
  std::string topic{};   ///< Empty: the only one that can be opened.
  std::string series{};  ///< As NextOfSeries() takes it; empty: the only one.
};

/// Finds the bag that `source` names, with or without a topic and a series behind it:
/// "run.mcap:/points#front", "run.mcap:/#front". Returns nothing if it names none.
[[nodiscard]] std::optional<BagSource> FindBag(const std::filesystem::path& source);

/// Returns the index of the topic to open.
/// @param topic Empty: the only one that can be opened.
/// @throws InputError as OpenBagRecording().
[[nodiscard]] std::size_t PickTopic(const std::vector<bag::BagTopic>& topics,
                                    const std::filesystem::path& bag,
                                    const std::string& topic);

/// Whether the messages of a topic are clouds of Livox's drivers.
[[nodiscard]] bool IsOfLivox(const bag::BagTopic& topic);

/// Opens a topic of a bag: clouds (sensor_msgs/msg/PointCloud2 or Livox's) with the poses that its
/// transforms say, or the packets of a sensor whose captures can be opened, as ROS drivers record
/// them.
/// @param source As messages and RecordingInfo name it: the bag, with the topic if that was given.
/// @throws InputError with one line that lists the topics if there is no such topic, or if several
///   are there and none is given; likewise the series.
[[nodiscard]] std::unique_ptr<Recording> OpenBagRecording(const std::filesystem::path& source,
                                                          const BagSource& bag);

/// Finds the packets of a sensor in a topic of a bag. Returns nothing if the topic holds clouds.
/// @throws InputError as OpenBagRecording().
[[nodiscard]] std::optional<DatagramPlace> FindBagPackets(const BagSource& bag);

/// Whether the messages of a topic hold points: clouds, or the packets of a sensor.
[[nodiscard]] bool HoldsPoints(const bag::BagTopic& topic);

}  // namespace railcast
