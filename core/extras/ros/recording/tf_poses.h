#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/recording/tf_frames.h"
#include "railcast/remark.h"
#include "railcast/transform.h"

namespace railcast {

/// What the clouds of a topic say of themselves, beside their points.
struct CloudHeaders {
  std::string topic;
  std::string frame_id;
  /// How far the stamps are ahead of the times at which the bag got the messages, as AheadOf().
  std::optional<double> ahead_ns{};
  std::int64_t first_ns{}, last_ns{};  ///< The least and the greatest stamp.
};

/// How far stamps are ahead of the times at which a bag got their messages: the median of the
/// differences. Nothing if these differ too much to say anything of the clock.
[[nodiscard]] std::optional<double> AheadOf(std::vector<double> differences_ns);

/// The poses of a frame of reference of ROS in a fixed one, from the transforms that a bag holds
/// (messages of type tf2_msgs/msg/TFMessage): those of the namespace of the clouds' topic.
///
/// Between two transforms of a pair of frames the position is interpolated linearly and the
/// rotation at a constant rate, as in ScanMotion. Nothing is extrapolated.
class TfPoses {
 public:
  /// Reads the transforms between the frame of the clouds and the topmost frame above it or, if
  /// that is not fixed, a fixed one that is linked to it.
  /// @param bag Is read twice; its selection of topics is changed.
  /// @throws InputError "rule (got value)" if frames go in circles, or there are more transforms
  ///   than memory is meant for.
  TfPoses(bag::BagReader& bag, const CloudHeaders& clouds);

  /// Returns the pose of the frame at a time of the clouds; nothing where it is not known. It is
  /// never known if no fixed frame is: one called so (REP 105: map, odom, earth; world, ...), or
  /// the topmost one, if something moves below it.
  [[nodiscard]] std::optional<Transform> At(std::int64_t time_ns) const;
  /// How long before the first or after the last of all transforms that move something a time is; 0
  /// within them, and if there are none.
  [[nodiscard]] std::int64_t Beyond_ns(std::int64_t time_ns) const;
  /// How far apart the transforms are between which a time lies, if any are unusually far: more
  /// than 1 s and ten times the median of their link. Otherwise 0.
  [[nodiscard]] std::int64_t Bridged_ns(std::int64_t time_ns) const;
  /// Describes the first place within a span of time at which transforms jump, as those of two
  /// vehicles do: "120 m in 0.02 s of /tf". Empty if there is none.
  [[nodiscard]] std::string JumpWithin(std::int64_t begin_ns, std::int64_t end_ns) const;

  /// How far the clock of the clouds is from that of the transforms: "37 s ahead, as between TAI
  /// and UTC". Empty if they have the same.
  [[nodiscard]] const std::string& other_clock() const { return other_clock_; }
  /// Whether the difference is known well enough for At() to take it into account; if not, no pose
  /// is known.
  [[nodiscard]] bool is_clock_known() const { return is_clock_known_; }
  /// Whether the clouds are in a fixed frame already, so that it is not known where the sensor was.
  [[nodiscard]] bool is_fixed() const { return is_fixed_; }
  /// Whether only the name of that frame says so, for the bag has no transforms.
  [[nodiscard]] bool is_fixed_by_name() const { return is_fixed_by_name_; }
  /// On the transforms as a whole: those left out, and why there are no poses.
  [[nodiscard]] const std::vector<Remark>& remarks() const { return remarks_; }

 private:
  struct TimedPose {
    std::int64_t time_ns{};
    Vector3 position_m;
    Eigen::Quaterniond rotation;
    std::size_t topic{};  ///< Topic of the bag.
  };
  struct TfLink {
    TfStep step;
    std::vector<TimedPose> poses{};  ///< Along the step, by time; if static, the last alone.
    std::vector<double> ahead_ns{};  ///< Stamps, of the times at which the bag got them.
    std::vector<bool> jumps{};       ///< From each pose to the next.
    std::int64_t most_ns{};          ///< Transforms that are further apart are unusually far.
    std::int64_t shift_ns{};         ///< From times of the transforms to those of the clouds.
  };
  /// Indices of the poses of a link from the last before a span of time to the end of it.
  struct PoseRange {
    std::size_t first{}, end{};
  };

  void ReadPoses(bag::BagReader& bag, const std::vector<std::size_t>& topics);
  static void Finish(TfLink& link);
  [[nodiscard]] static std::vector<bool> JumpsOf(const std::vector<TimedPose>& poses);
  void CompareClocks(const CloudHeaders& clouds);
  [[nodiscard]] static PoseRange RangeOf(const TfLink& link,
                                         std::int64_t begin_ns,
                                         std::int64_t end_ns);
  [[nodiscard]] static std::optional<Transform> PoseOf(const TfLink& link, std::int64_t time_ns);

  std::vector<TfLink> links_;             ///< From the frame to the fixed one.
  std::vector<std::string> topic_names_;  ///< Names of all topics of the bag.
  std::string other_clock_;
  bool is_clock_known_ = true;
  bool is_fixed_ = false;
  bool is_fixed_by_name_ = false;
  std::vector<Remark> remarks_;
};

}  // namespace railcast
