#include "core/extras/ros/messages/frame_topics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/scene_messages.h"
#include "core/io/image/jpeg.h"
#include "railcast/scene.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"

namespace railcast::ros {
namespace {

using testing::ElementsAre;

TopicsSpec TwoSensors() {
  TopicsSpec spec;
  spec.sensors = {
      {"front", MakeTransform(RotationFromYawPitchRoll(0.0, 0.1, 0.0), {1.0, 0.0, 3.0})},
      {"OS-1", Transform::Identity()}};
  spec.labels = ExampleLabels();
  spec.rails_m = {{{0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}}};
  return spec;
}

TopicsSpec WithCamera(ImageEncoding encoding) {
  TopicsSpec spec = TwoSensors();
  spec.camera = TopicCamera{{4, 2, 90.0}, Transform::Identity(), encoding};
  return spec;
}

CameraImage SmallImage() {
  CameraImage image;
  image.width_px = 4;
  image.height_px = 2;
  image.stamp_ns = 300'000'000;
  image.rgb.assign(24, 128);
  return image;
}

std::vector<std::string> NamesOfTopics(const FrameTopics& topics) {
  std::vector<std::string> names;
  for (const Topic& topic : topics.topics()) names.push_back(topic.name);
  return names;
}

/// The messages by the names of their topics.
std::map<std::string, TopicMessage> ByTopic(const FrameTopics& topics,
                                            const std::vector<TopicMessage>& messages) {
  std::map<std::string, TopicMessage> by_topic;
  for (const TopicMessage& message : messages) {
    EXPECT_TRUE(by_topic.emplace(topics.topics().at(message.topic).name, message).second);
  }
  return by_topic;
}

template <typename Message>
Message Decoded(const TopicMessage& message) {
  return FromCdr<Message>(message.cdr);
}

TEST(FrameTopics, AreNamedAfterSensorsAndTheCamera) {
  const FrameTopics topics(WithCamera(ImageEncoding::kRaw));
  EXPECT_THAT(NamesOfTopics(topics),
              ElementsAre("/front/points", "/OS_1/points", "/tf_static", "/tf", "/odometry",
                          "/clock", "/objects", "/track", "/camera/image", "/camera/camera_info"));
  EXPECT_EQ(topics.topics()[2].type.name, "tf2_msgs/msg/TFMessage");
  EXPECT_TRUE(topics.topics()[2].is_latched);
  EXPECT_FALSE(topics.topics()[3].is_latched);
}

TEST(FrameTopics, HaveAllStaticTransformsInOneMessage) {
  const FrameTopics topics(WithCamera(ImageEncoding::kRaw));
  const auto messages = ByTopic(topics, topics.First(300'000'000));
  const auto tf = Decoded<TfMessage>(messages.at("/tf_static"));
  ASSERT_EQ(tf.transforms.size(), 3U);
  EXPECT_EQ(tf.transforms[0].header.frame_id, "base_link");
  EXPECT_EQ(tf.transforms[0].child_frame_id, "front");
  EXPECT_EQ(tf.transforms[0].transform.translation, (RosVector3{1.0, 0.0, 3.0}));
  EXPECT_NEAR(tf.transforms[0].transform.rotation.y, std::sin(0.05), 1e-12);
  EXPECT_EQ(tf.transforms[1].child_frame_id, "OS_1");
  EXPECT_EQ(tf.transforms[2].child_frame_id, "camera");
  EXPECT_EQ(messages.size(), 2U);
}

TEST(FrameTopics, SayTheVehiclesMotionWithFramesOfTheFirstSensor) {
  TopicsSpec spec = TwoSensors();
  spec.output.origin_m = {100.0, 0.0, 0.0};
  const FrameTopics topics(spec);
  const Frame frame = ExampleFrame(3);
  // Northwards.
  const Eigen::Matrix3d turned{{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  RigidMotion vehicle;
  vehicle.world_from_body = MakeTransform(turned, Vector3(150.0, 2.0, 1.0));
  vehicle.velocity_mps = Vector3(0.0, 20.0, 0.0);
  vehicle.angular_velocity_radps = Vector3(0.0, 0.5, 0.1);
  const auto messages = ByTopic(topics, topics.Of({0, frame, vehicle}));
  const auto tf = Decoded<TfMessage>(messages.at("/tf"));
  ASSERT_EQ(tf.transforms.size(), 1U);
  EXPECT_EQ(tf.transforms[0].header.frame_id, "map");
  EXPECT_EQ(tf.transforms[0].child_frame_id, "base_link");
  EXPECT_EQ(tf.transforms[0].transform.translation, (RosVector3{50.0, 2.0, 1.0}));
  const auto odometry = Decoded<Odometry>(messages.at("/odometry"));
  EXPECT_EQ(odometry.pose.pose.position, (Point{50.0, 2.0, 1.0}));
  EXPECT_EQ(odometry.twist.twist.linear, (RosVector3{20.0, 0.0, 0.0}));
  EXPECT_EQ(odometry.twist.twist.angular, (RosVector3{0.5, 0.0, 0.1}));
  EXPECT_EQ(Decoded<Clock>(messages.at("/clock")).clock, (Time{0, 300'000'000}));
  for (const auto& [topic, message] : messages) EXPECT_EQ(message.time_ns, 300'000'000);
  EXPECT_EQ(ByTopic(topics, topics.Of({1, frame, vehicle})).size(), 2U);
}

TEST(FrameTopics, NameTheAxesInWhichPointsAre) {
  const Frame frame = ExampleFrame(3);
  for (const auto& [axes, name] :
       {std::pair(OutputFrame::kSensor, "OS_1"), std::pair(OutputFrame::kVehicle, "base_link"),
        std::pair(OutputFrame::kWorld, "map")}) {
    TopicsSpec spec = TwoSensors();
    spec.output.frame = axes;
    const FrameTopics topics(spec);
    const auto messages = ByTopic(topics, topics.Of({1, frame, {}}));
    EXPECT_EQ(Decoded<PointCloud2>(messages.at("/OS_1/points")).header.frame_id, name);
  }
}

TEST(FrameTopics, HaveATopicForEachReturnWhereTheDriverDoes) {
  TopicsSpec spec = TwoSensors();
  spec.sensors.pop_back();
  spec.sensors[0].num_returns = 2;
  spec.clouds.layout = PointLayout::kOuster;
  const std::vector<std::string> names = NamesOfTopics(FrameTopics(spec));
  EXPECT_EQ(names[0], "/front/points");
  EXPECT_EQ(names[1], "/front/points2");
}

TEST(FrameTopics, SendImagesWithTheLens) {
  const FrameTopics topics(WithCamera(ImageEncoding::kRaw));
  const Frame frame = ExampleFrame(3);
  const CameraImage image = SmallImage();
  const auto messages = ByTopic(topics, topics.Of({0, frame, {}, {}, &image}));
  const auto raw = Decoded<Image>(messages.at("/camera/image"));
  EXPECT_EQ(raw.encoding, "rgb8");
  EXPECT_EQ(raw.step, 12U);
  EXPECT_EQ(raw.data, image.rgb);
  const auto info = Decoded<CameraInfo>(messages.at("/camera/camera_info"));
  // 90 degrees over 4 pixels; the middle is between pixels 1 and 2.
  EXPECT_NEAR(info.k[0], 2.0, 1e-12);
  EXPECT_NEAR(info.k[2], 1.5, 1e-12);
  EXPECT_EQ(info.header, raw.header);
  EXPECT_EQ(info.d, std::vector<double>(5, 0.0));
}

TEST(FrameTopics, SendImagesAsJpegOrPng) {
  const Frame frame = ExampleFrame(3);
  const CameraImage image = SmallImage();
  const FrameTopics jpeg(WithCamera(ImageEncoding::kJpeg));
  const auto packed = Decoded<CompressedImage>(
      ByTopic(jpeg, jpeg.Of({0, frame, {}, {}, &image})).at("/camera/image/compressed"));
  EXPECT_EQ(packed.format, "jpeg");
  const std::string bytes(packed.data.begin(), packed.data.end());
  EXPECT_NEAR(DecodeJpegRgb(bytes, {4, 2}).values.at(0), 128, 2);
  const FrameTopics png(WithCamera(ImageEncoding::kPng));
  const auto lossless = Decoded<CompressedImage>(
      ByTopic(png, png.Of({0, frame, {}, {}, &image})).at("/camera/image/compressed"));
  const std::string png_bytes(lossless.data.begin(), lossless.data.end());
  EXPECT_EQ(DecodePngRgb(png_bytes).values, image.rgb);
}

TEST(FrameTopics, RefuseNamesThatBecomeOneInRos) {
  TopicsSpec spec = TwoSensors();
  spec.sensors[0].name = "OS_1";
  EXPECT_EQ(MessageOf([&] { (void)FrameTopics(spec); }),
            "names of sensors and the camera: must differ in ROS, from \"map\" and \"base_link\", "
            "too (got \"OS-1\" as \"OS_1\")");
}

TEST(FrameTopics, RefuseLeftHandedAxes) {
  TopicsSpec spec = TwoSensors();
  spec.output.handedness = Handedness::kLeft;
  EXPECT_EQ(MessageOf([&] { (void)FrameTopics(spec); }),
            "/output/handedness: must be right for messages of ROS 2 (got left)");
}

TEST(RosName, HasLettersDigitsAndUnderscores) {
  EXPECT_EQ(RosName("VLP-16 front"), "VLP_16_front");
  EXPECT_EQ(RosName("40P"), "_40P");
  EXPECT_EQ(RosName(""), "lidar");
}

}  // namespace
}  // namespace railcast::ros
