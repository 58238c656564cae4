#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Messages of ROS 2's packages builtin_interfaces, std_msgs, geometry_msgs, tf2_msgs, nav_msgs and
// rosgraph_msgs. Fields, names and units are ROS's (REP 103: SI, radians; rotations are unit
// quaternions). VisitFields() is the one list of a message's fields, in the order of its `.msg`
// file: the CDR encoding, the definition's text and the type's hash all come from it.

namespace railcast::ros {

struct Time {
  static constexpr std::string_view kName = "builtin_interfaces/msg/Time";
  std::int32_t sec{};
  std::uint32_t nanosec{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("sec", self.sec);
    visit("nanosec", self.nanosec);
  }
  bool operator==(const Time&) const = default;
};

struct Duration {
  static constexpr std::string_view kName = "builtin_interfaces/msg/Duration";
  std::int32_t sec{};
  std::uint32_t nanosec{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("sec", self.sec);
    visit("nanosec", self.nanosec);
  }
  bool operator==(const Duration&) const = default;
};

struct Header {
  static constexpr std::string_view kName = "std_msgs/msg/Header";
  Time stamp;
  std::string frame_id;

  static void VisitFields(auto& self, auto&& visit) {
    visit("stamp", self.stamp);
    visit("frame_id", self.frame_id);
  }
  bool operator==(const Header&) const = default;
};

struct RosVector3 {
  static constexpr std::string_view kName = "geometry_msgs/msg/Vector3";
  double x{}, y{}, z{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
  bool operator==(const RosVector3&) const = default;
};

struct Point {
  static constexpr std::string_view kName = "geometry_msgs/msg/Point";
  double x{}, y{}, z{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
  bool operator==(const Point&) const = default;
};

struct Quaternion {
  static constexpr std::string_view kName = "geometry_msgs/msg/Quaternion";
  double x{}, y{}, z{}, w{1.0};

  static void VisitFields(auto& self, auto&& visit) {
    visit("x", self.x, "0");
    visit("y", self.y, "0");
    visit("z", self.z, "0");
    visit("w", self.w, "1");
  }
  bool operator==(const Quaternion&) const = default;
};

struct RosTransform {
  static constexpr std::string_view kName = "geometry_msgs/msg/Transform";
  RosVector3 translation;
  Quaternion rotation;

  static void VisitFields(auto& self, auto&& visit) {
    visit("translation", self.translation);
    visit("rotation", self.rotation);
  }
  bool operator==(const RosTransform&) const = default;
};

struct TransformStamped {
  static constexpr std::string_view kName = "geometry_msgs/msg/TransformStamped";
  Header header;
  std::string child_frame_id;
  RosTransform transform;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("child_frame_id", self.child_frame_id);
    visit("transform", self.transform);
  }
  bool operator==(const TransformStamped&) const = default;
};

struct TfMessage {
  static constexpr std::string_view kName = "tf2_msgs/msg/TFMessage";
  std::vector<TransformStamped> transforms;

  static void VisitFields(auto& self, auto&& visit) { visit("transforms", self.transforms); }
  bool operator==(const TfMessage&) const = default;
};

struct Pose {
  static constexpr std::string_view kName = "geometry_msgs/msg/Pose";
  Point position;
  Quaternion orientation;

  static void VisitFields(auto& self, auto&& visit) {
    visit("position", self.position);
    visit("orientation", self.orientation);
  }
  bool operator==(const Pose&) const = default;
};

struct PoseWithCovariance {
  static constexpr std::string_view kName = "geometry_msgs/msg/PoseWithCovariance";
  Pose pose;
  std::array<double, 36> covariance{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("covariance", self.covariance);
  }
  bool operator==(const PoseWithCovariance&) const = default;
};

struct Twist {
  static constexpr std::string_view kName = "geometry_msgs/msg/Twist";
  RosVector3 linear;
  RosVector3 angular;

  static void VisitFields(auto& self, auto&& visit) {
    visit("linear", self.linear);
    visit("angular", self.angular);
  }
  bool operator==(const Twist&) const = default;
};

struct TwistStamped {
  static constexpr std::string_view kName = "geometry_msgs/msg/TwistStamped";
  Header header;
  Twist twist;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("twist", self.twist);
  }
  bool operator==(const TwistStamped&) const = default;
};

struct TwistWithCovariance {
  static constexpr std::string_view kName = "geometry_msgs/msg/TwistWithCovariance";
  Twist twist;
  std::array<double, 36> covariance{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("twist", self.twist);
    visit("covariance", self.covariance);
  }
  bool operator==(const TwistWithCovariance&) const = default;
};

struct Odometry {
  static constexpr std::string_view kName = "nav_msgs/msg/Odometry";
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;  ///< In the axes of child_frame_id.

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("child_frame_id", self.child_frame_id);
    visit("pose", self.pose);
    visit("twist", self.twist);
  }
  bool operator==(const Odometry&) const = default;
};

struct Clock {
  static constexpr std::string_view kName = "rosgraph_msgs/msg/Clock";
  Time clock;

  static void VisitFields(auto& self, auto&& visit) { visit("clock", self.clock); }
  bool operator==(const Clock&) const = default;
};

}  // namespace railcast::ros
