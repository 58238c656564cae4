#include "core/extras/ros/messages/frame_topics.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/motion_topics.h"
#include "core/extras/ros/messages/scene_topics.h"
#include "core/io/image/jpeg.h"
#include "core/io/image/png.h"
#include "railcast/scene.h"

namespace railcast::ros {
namespace {

constexpr std::string_view kMapFrame = "map";
constexpr std::string_view kVehicleFrame = "base_link";

bool IsLetterOfName(char letter) {
  return IsDigit(letter) || (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         letter == '_';
}

/// Names that frames of reference and topics have already.
constexpr auto kOwnNames = std::to_array<const char*>(
    {"map", "base_link", "tf", "tf_static", "odometry", "clock", "objects", "track"});

void CheckNames(const TopicsSpec& spec) {
  std::set<std::string> names(kOwnNames.begin(), kOwnNames.end());
  const auto add = [&names](const std::string& name) {
    if (names.insert(RosName(name)).second) return;
    throw InputError(
        "names of sensors and the camera: must differ in ROS, from \"map\" and "
        "\"base_link\", too (got " +
        Quoted(name) + " as \"" + RosName(name) + "\")");
  };
  for (const TopicSensor& sensor : spec.sensors) add(sensor.name);
  if (spec.camera) add(spec.camera->spec.name);
  for (const ImuSpec& imu : spec.motion.imus) add(imu.name);
  for (const GnssSpec& gnss : spec.motion.gnss) add(gnss.name);
  for (const OdometerSpec& odometer : spec.motion.odometers) add(odometer.name);
}

Header HeaderAt(std::int64_t time_ns, std::string_view frame_id) {
  return {TimeOf(time_ns), std::string(frame_id)};
}

TransformStamped StampedTransform(std::int64_t time_ns,
                                  std::string_view parent,
                                  std::string_view child,
                                  const Transform& parent_from_child) {
  return {HeaderAt(time_ns, parent),
          std::string(child),
          {VectorOf(parent_from_child.translation()), QuaternionOf(parent_from_child)}};
}

CameraInfo CameraInfoOf(const CameraSpec& spec, std::int64_t time_ns) {
  const Intrinsics k = IntrinsicsOf(spec);
  const DistortionSpec d = spec.distortion.value_or(DistortionSpec{});
  CameraInfo info;
  info.header = HeaderAt(time_ns, RosName(spec.name));
  info.height = spec.height_px;
  info.width = spec.width_px;
  info.distortion_model = "plumb_bob";
  info.d = {d.k1, d.k2, d.p1, d.p2, d.k3};
  info.k = {k.focal_px, 0.0, k.cx_px, 0.0, k.focal_px, k.cy_px, 0.0, 0.0, 1.0};
  info.r = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.p = {k.focal_px, 0.0, k.cx_px, 0.0, 0.0, k.focal_px, k.cy_px, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

Image RawImage(const CameraImage& image, Header header) {
  Image message{std::move(header), image.height_px, image.width_px, "rgb8", 0, 0, image.rgb};
  message.step = 3 * image.width_px;
  return message;
}

CompressedImage PackedImage(const CameraImage& image, ImageEncoding encoding, Header header) {
  constexpr int kJpegQuality = 90;
  const ImageSize size{image.width_px, image.height_px};
  const bool is_png = encoding == ImageEncoding::kPng;
  const std::string bytes =
      is_png ? EncodePngRgb(size, image.rgb) : EncodeJpeg(size, image.rgb, kJpegQuality);
  return {std::move(header), is_png ? "png" : "jpeg", {bytes.begin(), bytes.end()}};
}

TfMessage StaticTransforms(const TopicsSpec& spec, std::int64_t time_ns) {
  TfMessage message;
  for (const TopicSensor& sensor : spec.sensors) {
    message.transforms.push_back(
        StampedTransform(time_ns, kVehicleFrame, RosName(sensor.name), sensor.vehicle_from_sensor));
  }
  if (spec.camera) {
    message.transforms.push_back(StampedTransform(
        time_ns, kVehicleFrame, RosName(spec.camera->spec.name), spec.camera->vehicle_from_camera));
  }
  for (std::size_t i = 0; i < spec.vehicle_from_imu.size(); ++i) {
    message.transforms.push_back(StampedTransform(
        time_ns, kVehicleFrame, RosName(spec.motion.imus.at(i).name), spec.vehicle_from_imu[i]));
  }
  for (const GnssSpec& gnss : spec.motion.gnss) {
    const auto& [x_m, y_m, z_m] = gnss.antenna_m;
    const Transform antenna = MakeTransform(Eigen::Matrix3d::Identity(), Vector3(x_m, y_m, z_m));
    message.transforms.push_back(
        StampedTransform(time_ns, kVehicleFrame, RosName(gnss.name), antenna));
  }
  return message;
}

}  // namespace

FrameTopics::FrameTopics(TopicsSpec spec) : spec_(std::move(spec)) {
  CheckNames(spec_);
  if (spec_.output.handedness != Handedness::kRight) {
    throw InputError("/output/handedness: must be right for messages of ROS 2 (got left)");
  }
  for (const TopicSensor& sensor : spec_.sensors) {
    std::vector<std::size_t>& clouds = places_.points.emplace_back();
    for (std::uint32_t i = 0; i < NumClouds(spec_.clouds.layout, sensor.num_returns); ++i) {
      clouds.push_back(Add<PointCloud2>(PointsTopic(sensor.name, i)));
    }
  }
  places_.tf_static = Add<TfMessage>("/tf_static", true);
  places_.tf = Add<TfMessage>("/tf");
  places_.odometry = Add<Odometry>("/odometry");
  places_.clock = Add<Clock>("/clock");
  places_.objects = Add<SceneUpdate>("/objects");
  if (!spec_.rails_m.empty()) places_.track = Add<SceneUpdate>("/track", true);
  if (spec_.camera) AddCameraTopics();
  const auto topic = [](const std::string& name) { return "/" + RosName(name); };
  for (const ImuSpec& imu : spec_.motion.imus) places_.imus.push_back(Add<Imu>(topic(imu.name)));
  for (const GnssSpec& gnss : spec_.motion.gnss) {
    places_.gnss.push_back(Add<NavSatFix>(topic(gnss.name)));
  }
  for (const OdometerSpec& odometer : spec_.motion.odometers) {
    places_.odometers.push_back(Add<TwistStamped>(topic(odometer.name)));
  }
}

template <typename Message>
std::size_t FrameTopics::Add(std::string name, bool is_latched) {
  topics_.push_back({std::move(name), TypeOf<Message>(), is_latched});
  return topics_.size() - 1;
}

void FrameTopics::AddCameraTopics() {
  const std::string base = "/" + RosName(spec_.camera->spec.name);
  places_.image = spec_.camera->encoding == ImageEncoding::kRaw
                      ? Add<Image>(base + "/image")
                      : Add<CompressedImage>(base + "/image/compressed");
  places_.camera_info = Add<CameraInfo>(base + "/camera_info");
}

std::vector<TopicMessage> FrameTopics::First(std::int64_t time_ns) const {
  std::vector<TopicMessage> messages;
  messages.push_back({places_.tf_static, time_ns, ToCdr(StaticTransforms(spec_, time_ns))});
  if (places_.track) {
    messages.push_back(
        {*places_.track, time_ns, ToCdr(RailsUpdate(spec_.rails_m, MapFromWorld(), time_ns))});
  }
  return messages;
}

std::vector<TopicMessage> FrameTopics::Of(const FrameContent& content) const {
  const TopicSensor& sensor = spec_.sensors.at(content.sensor);
  const std::int64_t time_ns = content.frame.stamp_ns;
  std::vector<TopicMessage> messages;
  if (content.sensor == 0) AddMotion(content, messages);
  AddClouds(content, messages);
  // Half a period longer than until the next update, so that nothing flickers.
  const auto lifetime_ns = static_cast<std::int64_t>(1.5e9 / sensor.rate_hz);
  messages.push_back(
      {places_.objects, time_ns,
       ToCdr(BoxesUpdate(content.boxes, spec_.labels, MapFromWorld(), time_ns, lifetime_ns))});
  if (content.image != nullptr && spec_.camera) AddImage(*content.image, messages);
  if (content.sensor == 0 && content.motion != nullptr) AddSamples(*content.motion, messages);
  return messages;
}

void FrameTopics::AddClouds(const FrameContent& content,
                            std::vector<TopicMessage>& messages) const {
  const TopicSensor& sensor = spec_.sensors[content.sensor];
  const std::vector<std::size_t>& topics = places_.points[content.sensor];
  // Rungs without beams have one return in every mode.
  const std::uint32_t num_clouds = NumClouds(spec_.clouds.layout, content.frame.returns);
  Check(num_clouds <= topics.size(), "a frame has no more returns than its sensor");
  for (std::uint32_t i = 0; i < num_clouds; ++i) {
    messages.push_back({topics[i], content.frame.stamp_ns,
                        ToCdr(MakeCloud(content.frame, spec_.clouds, FrameIdOf(content.sensor),
                                        sensor.channel_of_row, i))});
  }
}

TopicMessage FrameTopics::PoseAt(std::int64_t time_ns, const Transform& world_from_vehicle) const {
  const TfMessage pose = {
      {StampedTransform(time_ns, kMapFrame, kVehicleFrame, MapFromWorld() * world_from_vehicle)}};
  return {places_.tf, time_ns, ToCdr(pose)};
}

void FrameTopics::AddMotion(const FrameContent& content,
                            std::vector<TopicMessage>& messages) const {
  const std::int64_t time_ns = content.frame.stamp_ns;
  const RigidMotion& vehicle = content.vehicle;
  const Transform map_from_vehicle = MapFromWorld() * vehicle.world_from_body;
  const Eigen::Matrix3d vehicle_from_world = vehicle.world_from_body.linear().transpose();
  messages.push_back({places_.clock, time_ns, ToCdr(Clock{TimeOf(time_ns)})});
  messages.push_back(PoseAt(time_ns, vehicle.world_from_body));
  Odometry odometry;
  odometry.header = HeaderAt(time_ns, kMapFrame);
  odometry.child_frame_id = kVehicleFrame;
  odometry.pose.pose = PoseOf(map_from_vehicle);
  odometry.twist.twist = {VectorOf(vehicle_from_world * vehicle.velocity_mps),
                          VectorOf(vehicle_from_world * vehicle.angular_velocity_radps)};
  messages.push_back({places_.odometry, time_ns, ToCdr(odometry)});
}

void FrameTopics::AddSamples(const MotionSamples& samples,
                             std::vector<TopicMessage>& messages) const {
  for (std::size_t i = 0; i < samples.imus.size(); ++i) {
    for (const ImuSample& sample : samples.imus[i]) {
      messages.push_back(
          {places_.imus.at(i), sample.time_ns, ToCdr(ImuMessage(sample, spec_.motion.imus[i]))});
    }
  }
  for (std::size_t i = 0; i < samples.gnss.size(); ++i) {
    for (const GnssSample& sample : samples.gnss[i]) {
      messages.push_back(
          {places_.gnss.at(i), sample.time_ns, ToCdr(FixMessage(sample, spec_.motion.gnss[i]))});
    }
  }
  for (std::size_t i = 0; i < samples.odometers.size(); ++i) {
    for (const OdometerSample& sample : samples.odometers[i]) {
      messages.push_back({places_.odometers.at(i), sample.time_ns, ToCdr(SpeedMessage(sample))});
    }
  }
}

void FrameTopics::AddImage(const CameraImage& image, std::vector<TopicMessage>& messages) const {
  const TopicCamera& camera = *spec_.camera;
  const Header header = HeaderAt(image.stamp_ns, RosName(camera.spec.name));
  messages.push_back({*places_.image, image.stamp_ns,
                      camera.encoding == ImageEncoding::kRaw
                          ? ToCdr(RawImage(image, header))
                          : ToCdr(PackedImage(image, camera.encoding, header))});
  messages.push_back(
      {*places_.camera_info, image.stamp_ns, ToCdr(CameraInfoOf(camera.spec, image.stamp_ns))});
}

Transform FrameTopics::MapFromWorld() const {
  const auto& [x_m, y_m, z_m] = spec_.output.origin_m;
  return MakeTransform(Eigen::Matrix3d::Identity(), -Vector3(x_m, y_m, z_m));
}

std::string FrameTopics::FrameIdOf(std::size_t sensor) const {
  switch (spec_.output.frame) {
    case OutputFrame::kVehicle:
      return std::string(kVehicleFrame);
    case OutputFrame::kWorld:
      return std::string(kMapFrame);
    case OutputFrame::kSensor:
      break;
  }
  return RosName(spec_.sensors[sensor].name);
}

std::string RosName(std::string_view name) {
  if (name.empty()) return "lidar";
  std::string text(name);
  std::ranges::replace_if(
      text, [](char letter) { return !IsLetterOfName(letter); }, '_');
  // A name of ROS does not begin with a digit.
  return IsDigit(text.front()) ? "_" + text : text;
}

std::string PointsTopic(std::string_view sensor, std::uint32_t cloud) {
  return "/" + RosName(sensor) + "/points" + (cloud == 0 ? "" : NumberText(cloud + 1));
}

}  // namespace railcast::ros
