#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/message_type.h"
#include "core/extras/ros/messages/point_layout.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/motion_sensors.h"
#include "railcast/rigid_motion.h"
#include "railcast/transform.h"

namespace railcast::ros {

/// A topic of ROS 2 on which railcast says something.
struct Topic {
  std::string name;  ///< "/lidar/points"
  MessageType type;
  /// Whether late subscribers get the last message, too (transient local, as `/tf_static`).
  bool is_latched = false;
};

/// A message, serialized.
struct TopicMessage {
  std::size_t topic{};     ///< Index in FrameTopics::topics().
  std::int64_t time_ns{};  ///< Simulation time at which it is published.
  std::vector<std::byte> cdr;
};

/// A sensor and where it is. Its frame of reference is named as the sensor.
struct TopicSensor {
  std::string name;
  Transform vehicle_from_sensor = Transform::Identity();
  std::uint32_t num_returns = 1;
  double rate_hz = 10.0;
  std::vector<std::uint16_t> channel_of_row{};  ///< As MakeCloud() takes it.
};

/// How images are sent.
enum class ImageEncoding {
  kRaw,   ///< sensor_msgs/msg/Image, `rgb8`, on `/NAME/image`.
  kJpeg,  ///< sensor_msgs/msg/CompressedImage on `/NAME/image/compressed`.
  kPng,   ///< As kJpeg, without loss.
};

struct TopicCamera {
  CameraSpec spec;
  Transform vehicle_from_camera = Transform::Identity();  ///< Pose of its optical axes.
  ImageEncoding encoding = ImageEncoding::kRaw;
};

/// What the messages of a run say.
struct TopicsSpec {
  std::vector<TopicSensor> sensors;
  std::optional<TopicCamera> camera;  ///< Its images belong to frames of the first sensor.
  /// Their samples belong to frames of the first sensor, too.
  MotionSensorsSpec motion;
  std::vector<Transform> vehicle_from_imu;  ///< For each of motion.imus.
  CloudSpec clouds;
  OutputSpec output;  ///< Right-handed. Its origin is that of the frame of reference `map`.
  LabelTable labels;
  /// Lines along the rails, in the world frame, which `/track` shows; it is left out without any.
  std::vector<std::vector<Vector3>> rails_m;
};

/// An object and its box at a frame's stamp.
struct SceneBox {
  std::string name;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();
  Transform world_from_box = Transform::Identity();
  Vector3 velocity_world_mps = Vector3::Zero();
  std::uint32_t points{};             ///< Slots with a point on the object.
  std::optional<double> occlusion{};  ///< Share that something else hides; absent = not in sight.
};

/// A frame and what belongs to it.
struct FrameContent {
  std::size_t sensor{};  ///< Index in TopicsSpec::sensors.
  const Frame& frame;
  RigidMotion vehicle;  ///< At the stamp.
  std::span<const SceneBox> boxes{};
  const CameraImage* image{};  ///< Null = the frame has none.
  /// Null = it has none. Counts with frames of the first sensor only.
  const MotionSamples* motion{};
};

/// What railcast says about a run on topics of ROS 2, the same live and in bags:
///
/// | topic | type | |
/// |---|---|---|
/// | `/SENSOR/points` | PointCloud2 | each frame |
/// | `/tf_static` | TFMessage | once: from `base_link` to all sensors and the camera |
/// | `/tf`, `/odometry`, `/clock` | TFMessage, Odometry, Clock | each frame of the first sensor |
/// | `/tf` | TFMessage | in bags once more, at the end of the last frame |
/// | `/objects` | SceneUpdate (Foxglove) | each frame: the objects' boxes with their labels |
/// | `/track` | SceneUpdate (Foxglove) | once: the rails |
/// | `/CAMERA/image`, `/CAMERA/camera_info` | Image, CameraInfo | each image |
/// | `/imu`, `/gnss`, `/odometer` (their names) | Imu, NavSatFix, TwistStamped | each sample |
///
/// Frames of reference (REP 103, 105): `map` is the world frame minus OutputSpec::origin_m,
/// `base_link` the vehicle. Stamps are simulation time. Messages are functions of their frame
/// alone; const functions are thread-safe.
class FrameTopics {
 public:
  /// @throws InputError "rule (got value)" if two sensors' or the camera's names become the same
  ///   in ROS, where names have letters, digits and _ only, or the output is left-handed.
  explicit FrameTopics(TopicsSpec spec);

  [[nodiscard]] const std::vector<Topic>& topics() const { return topics_; }
  /// The messages before the first frame.
  /// @param time_ns Stamp of the first frame.
  [[nodiscard]] std::vector<TopicMessage> First(std::int64_t time_ns) const;
  /// The messages of a frame.
  /// @throws InputError as MakeCloud() does.
  [[nodiscard]] std::vector<TopicMessage> Of(const FrameContent& content) const;
  /// The message on `/tf` that says where the vehicle is. Frames have one for their stamps; whoever
  /// records them adds one for the end of the last, without which that frame's motion is not known.
  [[nodiscard]] TopicMessage PoseAt(std::int64_t time_ns,
                                    const Transform& world_from_vehicle) const;

 private:
  /// Indices of topics.
  struct Places {
    std::vector<std::vector<std::size_t>> points;  ///< By sensor and cloud.
    std::size_t tf_static{}, tf{}, odometry{}, clock{}, objects{};
    std::optional<std::size_t> track, image, camera_info;
    std::vector<std::size_t> imus, gnss, odometers;
  };
  template <typename Message>
  [[nodiscard]] std::size_t Add(std::string name, bool is_latched = false);
  void AddCameraTopics();
  void AddClouds(const FrameContent& content, std::vector<TopicMessage>& messages) const;
  void AddMotion(const FrameContent& content, std::vector<TopicMessage>& messages) const;
  void AddSamples(const MotionSamples& samples, std::vector<TopicMessage>& messages) const;
  void AddImage(const CameraImage& image, std::vector<TopicMessage>& messages) const;
  [[nodiscard]] Transform MapFromWorld() const;
  [[nodiscard]] std::string FrameIdOf(std::size_t sensor) const;

  TopicsSpec spec_;
  Places places_;
  std::vector<Topic> topics_;
};

/// The name as names of topics and frames of reference can be: other characters than letters,
/// digits and _ become _; "lidar" if it is empty.
[[nodiscard]] std::string RosName(std::string_view name);

/// The topic of a sensor's clouds, "/NAME/points"; those of further returns, where each return has
/// a cloud of its own, are "/NAME/points2", ...
[[nodiscard]] std::string PointsTopic(std::string_view sensor, std::uint32_t cloud = 0);

}  // namespace railcast::ros
