#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Messages of ROS 2's packages builtin_interfaces, std_msgs, geometry_msgs, tf2_msgs, nav_msgs and
// rosgraph_msgs. Fields, names and units are ROS's (REP 103: SI, radians; rotations are unit
// quaternions). The members of a message are its fields, in the order of its `.msg` file, which
// `kFields` names: the CDR encoding, the definition's text and the type's hash all come from them.

namespace railcast::ros {

struct Time {
  static constexpr std::string_view kName = "builtin_interfaces/msg/Time";
  static constexpr std::array kFields = {"sec", "nanosec"};
  std::int32_t sec{};
  std::uint32_t nanosec{};

  bool operator==(const Time&) const = default;
};

struct Duration {
  static constexpr std::string_view kName = "builtin_interfaces/msg/Duration";
  static constexpr std::array kFields = {"sec", "nanosec"};
  std::int32_t sec{};
  std::uint32_t nanosec{};

  bool operator==(const Duration&) const = default;
};

struct Header {
  static constexpr std::string_view kName = "std_msgs/msg/Header";
  static constexpr std::array kFields = {"stamp", "frame_id"};
  Time stamp;
  std::string frame_id;

  bool operator==(const Header&) const = default;
};

struct RosVector3 {
  static constexpr std::string_view kName = "geometry_msgs/msg/Vector3";
  static constexpr std::array kFields = {"x", "y", "z"};
  double x{}, y{}, z{};

  bool operator==(const RosVector3&) const = default;
};

struct Point {
  static constexpr std::string_view kName = "geometry_msgs/msg/Point";
  static constexpr std::array kFields = {"x", "y", "z"};
  double x{}, y{}, z{};

  bool operator==(const Point&) const = default;
};

struct Quaternion {
  static constexpr std::string_view kName = "geometry_msgs/msg/Quaternion";
  static constexpr std::array kFields = {"x", "y", "z", "w"};
  static constexpr std::array kDefaults = {"0", "0", "0", "1"};
  double x{}, y{}, z{}, w{1.0};

  bool operator==(const Quaternion&) const = default;
};

struct RosTransform {
  static constexpr std::string_view kName = "geometry_msgs/msg/Transform";
  static constexpr std::array kFields = {"translation", "rotation"};
  RosVector3 translation;
  Quaternion rotation;

  bool operator==(const RosTransform&) const = default;
};

struct TransformStamped {
  static constexpr std::string_view kName = "geometry_msgs/msg/TransformStamped";
  static constexpr std::array kFields = {"header", "child_frame_id", "transform"};
  Header header;
  std::string child_frame_id;
  RosTransform transform;

  bool operator==(const TransformStamped&) const = default;
};

struct TfMessage {
  static constexpr std::string_view kName = "tf2_msgs/msg/TFMessage";
  static constexpr std::array kFields = {"transforms"};
  std::vector<TransformStamped> transforms;

  bool operator==(const TfMessage&) const = default;
};

struct Pose {
  static constexpr std::string_view kName = "geometry_msgs/msg/Pose";
  static constexpr std::array kFields = {"position", "orientation"};
  Point position;
  Quaternion orientation;

  bool operator==(const Pose&) const = default;
};

struct PoseWithCovariance {
  static constexpr std::string_view kName = "geometry_msgs/msg/PoseWithCovariance";
  static constexpr std::array kFields = {"pose", "covariance"};
  Pose pose;
  std::array<double, 36> covariance{};

  bool operator==(const PoseWithCovariance&) const = default;
};

struct Twist {
  static constexpr std::string_view kName = "geometry_msgs/msg/Twist";
  static constexpr std::array kFields = {"linear", "angular"};
  RosVector3 linear;
  RosVector3 angular;

  bool operator==(const Twist&) const = default;
};

struct TwistStamped {
  static constexpr std::string_view kName = "geometry_msgs/msg/TwistStamped";
  static constexpr std::array kFields = {"header", "twist"};
  Header header;
  Twist twist;

  bool operator==(const TwistStamped&) const = default;
};

struct TwistWithCovariance {
  static constexpr std::string_view kName = "geometry_msgs/msg/TwistWithCovariance";
  static constexpr std::array kFields = {"twist", "covariance"};
  Twist twist;
  std::array<double, 36> covariance{};

  bool operator==(const TwistWithCovariance&) const = default;
};

struct Odometry {
  static constexpr std::string_view kName = "nav_msgs/msg/Odometry";
  static constexpr std::array kFields = {"header", "child_frame_id", "pose", "twist"};
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;  ///< In the axes of child_frame_id.

  bool operator==(const Odometry&) const = default;
};

struct Clock {
  static constexpr std::string_view kName = "rosgraph_msgs/msg/Clock";
  static constexpr std::array kFields = {"clock"};
  Time clock;

  bool operator==(const Clock&) const = default;
};

}  // namespace railcast::ros
