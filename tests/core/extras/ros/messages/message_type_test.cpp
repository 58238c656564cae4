#include "core/extras/ros/messages/message_type.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/scene_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"

namespace railcast::ros {
namespace {

// The hashes that the packages of ROS 2 Jazzy install (share/PACKAGE/msg/TYPE.json).
template <typename Message>
std::string HashDigits() {
  return TypeOf<Message>().hash;
}

TEST(MessageType, HasTheHashThatTheSensorPackagesOfRos2Install) {
  EXPECT_EQ(HashDigits<PointCloud2>(),
            "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5");
  EXPECT_EQ(HashDigits<PointField>(),
            "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01");
  EXPECT_EQ(HashDigits<Imu>(),
            "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b");
  EXPECT_EQ(HashDigits<NavSatFix>(),
            "RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404");
  EXPECT_EQ(HashDigits<NavSatStatus>(),
            "RIHS01_d1ed3befa628e09571bd273b888ba1c1fd187c9a5e0006b385d7e5e9095a3204");
  EXPECT_EQ(HashDigits<Image>(),
            "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47");
  EXPECT_EQ(HashDigits<CompressedImage>(),
            "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a");
  EXPECT_EQ(HashDigits<CameraInfo>(),
            "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275");
  EXPECT_EQ(HashDigits<RegionOfInterest>(),
            "RIHS01_ad16bcba5f9131dcdba6fbded19f726f5440e3c513b4fb586dd3027eeed8abb1");
}

TEST(MessageType, HasTheHashThatTheGeometryPackagesOfRos2Install) {
  EXPECT_EQ(HashDigits<TfMessage>(),
            "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087");
  EXPECT_EQ(HashDigits<TransformStamped>(),
            "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206");
  EXPECT_EQ(HashDigits<Odometry>(),
            "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0");
  EXPECT_EQ(HashDigits<Clock>(),
            "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564");
  EXPECT_EQ(HashDigits<TwistStamped>(),
            "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64");
  EXPECT_EQ(HashDigits<Header>(),
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
  EXPECT_EQ(HashDigits<Quaternion>(),
            "RIHS01_8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684");
}

TEST(MessageType, HasTheHashOfFoxglovesDescriptionByTheSameRule) {
  // Foxglove publishes none; this is REP-2016's rule, in another program, on its .proto files.
  EXPECT_EQ(HashDigits<SceneUpdate>(),
            "RIHS01_48c640ae3c3c25188e497ddea0ea11c2e189b50db3ef425f2c518d2355e5ff60");
}

TEST(MessageType, HasTheNamesOfRosAndOfDds) {
  EXPECT_EQ(TypeOf<PointCloud2>().name, "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(TypeOf<PointCloud2>().dds_name, "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_EQ(TypeOf<TfMessage>().dds_name, "tf2_msgs::msg::dds_::TFMessage_");
}

TEST(MessageType, DefinesItselfAndWhatItContains) {
  const std::string line(80, '=');
  EXPECT_EQ(TypeOf<Clock>().definition,
            "builtin_interfaces/Time clock\n" + line +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

/// The lines of a definition that mean something: types with their package, without comments.
using Lines = std::vector<std::string>;

std::string Trimmed(std::string line) {
  line = line.substr(0, line.find('#'));
  std::istringstream words(line);
  std::string all;
  for (std::string word; words >> word;) all += (all.empty() ? "" : " ") + word;
  return all;
}

// "uint8 INT8=1" for "uint8 INT8 = 1".
std::string WithoutBlanksAround(std::string line) {
  for (const char* const blank : {" =", "= "}) {
    const std::size_t at = line.find(blank);
    if (at != std::string::npos) line.replace(at, 2, "=");
  }
  return line;
}

// "std_msgs/Header header" for "Header header" in package std_msgs.
std::string WithPackage(const std::string& line, const std::string& package) {
  const std::string type = line.substr(0, line.find_first_of(" ["));
  const bool is_message = type.find('/') == std::string::npos && std::isupper(type[0]) != 0;
  return is_message ? package + "/" + line : line;
}

struct Definition {
  Lines fields;
  Lines constants;

  bool operator==(const Definition&) const = default;
};

/// The definitions in a ros2msg text, by "package/Name"; that of the type itself comes first in it.
std::map<std::string, Definition> Parse(const std::string& text, std::string name) {
  std::map<std::string, Definition> parsed;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("====")) continue;
    if (line.starts_with("MSG: ")) {
      name = line.substr(5);
      continue;
    }
    line = WithoutBlanksAround(Trimmed(line));
    if (line.empty()) continue;
    Definition& definition = parsed[name];
    (line.find('=') == std::string::npos ? definition.fields : definition.constants)
        .push_back(WithPackage(line, name.substr(0, name.find('/'))));
  }
  return parsed;
}

const std::filesystem::path kSchemas =
    std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "ros_schemas";

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

template <typename Message>
void CompareWithRos() {
  const std::string name(Message::kName);
  const std::string package = name.substr(0, name.find('/'));
  const std::string short_name = package + name.substr(name.rfind('/'));
  for (const auto& [type, own] : Parse(TypeOf<Message>().definition, short_name)) {
    const std::size_t slash = type.find('/');
    const std::filesystem::path file = kSchemas / "ros2humble_msgdefs" / type.substr(0, slash) /
                                       "msg" / (type.substr(slash + 1) + ".msg");
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    const Definition theirs = Parse(ReadText(file), type)[type];
    EXPECT_EQ(own.fields, theirs.fields) << type;
    EXPECT_EQ(own.constants, theirs.constants) << type;
  }
}

TEST(MessageType, HasTheFieldsAndConstantsOfRos2) {
  if (!std::filesystem::exists(kSchemas)) GTEST_SKIP() << "there is no " << kSchemas;
  CompareWithRos<PointCloud2>();
  CompareWithRos<Imu>();
  CompareWithRos<NavSatFix>();
  CompareWithRos<Image>();
  CompareWithRos<CompressedImage>();
  CompareWithRos<CameraInfo>();
  CompareWithRos<TfMessage>();
  CompareWithRos<Odometry>();
  CompareWithRos<Clock>();
  CompareWithRos<TwistStamped>();
}

// The ros2msg line of a field of a .proto file; empty for other lines.
std::string LineOfProto(const std::string& line) {
  static const std::map<std::string, std::string> types = {
      {"double", "float64"},
      {"string", "string"},
      {"bool", "bool"},
      {"bytes", "uint8[]"},
      {"fixed32", "uint32"},
      {"Type", "uint8"},
      {"google.protobuf.Timestamp", "builtin_interfaces/Time"},
      {"google.protobuf.Duration", "builtin_interfaces/Duration"},
      {"foxglove.Pose", "geometry_msgs/Pose"},
      {"foxglove.Vector3", "geometry_msgs/Vector3"},
      {"foxglove.Point3", "geometry_msgs/Point"}};
  std::istringstream words(line);
  std::string type, name, equals;
  words >> type;
  const bool is_repeated = type == "repeated";
  if (is_repeated) words >> type;
  words >> name >> equals;
  if (equals != "=" || type.starts_with("//")) return {};
  const auto known = types.find(type);
  std::string text = known != types.end() ? known->second : type;
  if (text.starts_with("foxglove.")) text = "foxglove_msgs/" + text.substr(9);
  return text + (is_repeated ? "[] " : " ") + name;
}

TEST(MessageType, HasTheFieldsOfFoxglovesScene) {
  if (!std::filesystem::exists(kSchemas)) GTEST_SKIP() << "there is no " << kSchemas;
  int num_compared = 0;
  for (const auto& [type, own] :
       Parse(TypeOf<SceneUpdate>().definition, "foxglove_msgs/SceneUpdate")) {
    if (!type.starts_with("foxglove_msgs/")) continue;
    const std::string file = type.substr(14) + ".proto";
    std::istringstream lines(ReadText(kSchemas / "foxglove/schemas/proto/foxglove" / file));
    Lines theirs;
    for (std::string line; std::getline(lines, line);) {
      const std::string field = LineOfProto(line);
      if (!field.empty()) theirs.push_back(field);
    }
    EXPECT_EQ(own.fields, theirs) << type;
    ++num_compared;
  }
  EXPECT_EQ(num_compared, 13);
}

}  // namespace
}  // namespace railcast::ros
