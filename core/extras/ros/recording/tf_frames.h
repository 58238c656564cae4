#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "railcast/remark.h"
#include "railcast/transform.h"

namespace railcast {

/// The topics of transforms in a bag.
struct TfTopics {
  std::vector<std::size_t> chosen;  ///< Indices of those that a topic of clouds belongs to.
  std::string names;                ///< Names of these topics, as messages show them.
  std::vector<std::string> others;  ///< Names of all others.

  /// @pre There are others.
  [[nodiscard]] Remark RemarkOnOthers() const;
};

/// Chooses among a bag's topics of type tf2_msgs/msg/TFMessage `tf` and `tf_static` of the
/// innermost namespace around a topic of clouds that has them: of "/a/b/points" those of "/a/b",
/// "/a" or none.
[[nodiscard]] TfTopics TfTopicsFor(const std::string& clouds,
                                   const std::vector<bag::BagTopic>& topics);

/// tf2 takes "/map" for "map".
[[nodiscard]] std::string PlainFrame(const std::string& frame);

/// Says what is wrong with a transform that tf2 would ignore, too; empty if nothing is.
[[nodiscard]] std::string FaultOf(const ros::TransformStamped& transform);

/// Calls `visit(transform, message)` for each transform of some topics.
template <typename Visit>
void ForEachTransform(bag::BagReader& bag,
                      const std::vector<std::size_t>& topics,
                      const Visit& visit) {
  bag.Select(topics);
  while (const auto message = topics.empty() ? std::nullopt : bag.Next()) {
    AtPlace(ShownText(bag.topics()[message->topic].name) + ": ", [&] {
      for (const auto& transform : ros::FromCdr<ros::TfMessage>(message->data).transforms) {
        visit(transform, *message);
      }
    });
  }
}

/// A step between two frames of reference, of which one is the other's parent.
struct TfStep {
  std::string child;
  std::string parent;
  bool is_static{};
  bool is_downwards{};  ///< It leads from the parent to the child.
};

/// The frames of reference that transforms link, each with the one above it. Of several the last is
/// taken.
class TfTree {
 public:
  /// Takes a transform.
  /// @throws InputError if there are more frames than memory is meant for.
  void Add(const ros::TransformStamped& transform, const bag::BagTopic& topic);

  /// Whether there are no transforms.
  [[nodiscard]] bool is_empty() const { return frames_.empty(); }
  /// Whether a frame is fixed: it is called so (REP 105: map, odom, earth; world, ...), or
  /// something travels below it and it does not itself.
  [[nodiscard]] bool IsFixed(const std::string& frame) const;
  /// Returns the steps from a frame to a fixed one: the topmost above it, if that is called so or
  /// anything moves in between, else the farthest of those called so that are linked to it. None if
  /// there is no such frame.
  /// @throws InputError if frames go in circles.
  [[nodiscard]] std::vector<TfStep> WayToFixed(const std::string& frame) const;
  /// Says why there is none; nothing if there are no frames at all.
  [[nodiscard]] std::optional<Remark> WhyNoWay(const std::string& frame,
                                               const TfTopics& topics) const;

 private:
  struct ToFrame {
    std::string parent;
    bool is_static{};
    ros::RosTransform last;
    Vector3 lowest_m, highest_m;  ///< Bounds of its positions.
  };

  /// The steps to the topmost frame; no more than there are frames.
  [[nodiscard]] std::vector<TfStep> WayUp(const std::string& frame) const;
  [[nodiscard]] std::vector<TfStep> WayToNamed(const std::string& frame) const;

  std::map<std::string, ToFrame, std::less<>> frames_;  ///< By name.
};

/// Reads the frames of some topics. Transforms that are none are left out, with a remark.
[[nodiscard]] TfTree ReadTree(bag::BagReader& bag,
                              const std::vector<std::size_t>& topics,
                              std::vector<Remark>& remarks);

}  // namespace railcast
