#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "railcast/remark.h"
#include "railcast/transform.h"

namespace railcast {

/// The poses of a frame of reference of ROS in the fixed one above it, from the transforms that a
/// bag holds (messages of type tf2_msgs/msg/TFMessage).
///
/// Between two transforms of a pair of frames the position is interpolated linearly and the
/// rotation at a constant rate, as in ScanMotion. Nothing is extrapolated.
class TfPoses {
 public:
  /// Reads the transforms between `frame` and the topmost frame above it.
  /// @param bag Is read twice; its selection of topics is changed.
  /// @throws InputError "rule (got value)" if a rotation is none, frames go in circles, or there
  ///   are more transforms than memory is meant for.
  TfPoses(bag::BagReader& bag, const std::string& frame);

  /// Returns the pose of the frame at a time; nothing where it is not known. It is never known if
  /// the topmost frame is neither called so (REP 105: map, odom, earth; or world) nor moved
  /// against.
  [[nodiscard]] std::optional<Transform> At(std::int64_t time_ns) const;
  /// How long before the first or after the last of all transforms that move something a time is; 0
  /// within them, and if there are none.
  [[nodiscard]] std::int64_t Beyond_ns(std::int64_t time_ns) const;
  /// How far apart the transforms are between which a time lies, if any are unusually far: more
  /// than 1 s and ten times the median of their link. Otherwise 0.
  [[nodiscard]] std::int64_t Bridged_ns(std::int64_t time_ns) const;
  /// How many transforms were left out because they lead to a frame from another one than the last
  /// transform to it; for messages, the first such pair.
  [[nodiscard]] const Remark& left_out() const { return left_out_; }

 private:
  struct TimedPose {
    std::int64_t time_ns{};
    Vector3 position_m;
    Eigen::Quaterniond rotation;
  };
  /// From a frame to the one above it.
  struct TfLink {
    std::string child;
    std::string parent;
    bool is_static{};
    std::vector<TimedPose> poses;  ///< By time; if static, the last alone.
    std::int64_t most_ns{};        ///< Transforms that are further apart are unusually far.
  };

  void ReadLinks(bag::BagReader& bag, const std::string& frame);
  void ReadPoses(bag::BagReader& bag);
  [[nodiscard]] static std::optional<Transform> PoseOf(const TfLink& link, std::int64_t time_ns);

  std::vector<TfLink> links_;  ///< From the frame upwards.
  Remark left_out_{.kind = RemarkKind::kTransformsLeftOut, .place = {}, .number = 0};
};

}  // namespace railcast
