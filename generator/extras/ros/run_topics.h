#pragma once

#include <cstddef>
#include <vector>

#include "core/extras/ros/messages/frame_topics.h"
#include "generator/run/frame_maker.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {

/// What messages of ROS 2 say about a scenario: its sensors, its camera and its rails.
[[nodiscard]] ros::TopicsSpec TopicsSpecOf(const ScenarioSpec& scenario,
                                           const RailWorld& world,
                                           const ros::CloudSpec& clouds,
                                           ros::ImageEncoding images);

/// The messages of a frame that a FrameMaker made. Thread-safe.
/// @throws InputError as FrameTopics::Of() does.
[[nodiscard]] std::vector<ros::TopicMessage> MessagesOf(const ros::FrameTopics& topics,
                                                        std::size_t sensor,
                                                        const MadeFrame& made);

}  // namespace railcast
