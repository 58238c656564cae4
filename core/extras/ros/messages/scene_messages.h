#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"

// Messages of Foxglove's package foxglove_msgs that describe what a 3D view shows beside clouds.
// `kFields` as in geometry_messages.h. Lengths in metres.

namespace railcast::ros {

struct Color {
  static constexpr std::string_view kName = "foxglove_msgs/msg/Color";
  static constexpr std::array kFields = {"r", "g", "b", "a"};
  double r{}, g{}, b{}, a{};  ///< 0 to 1

  bool operator==(const Color&) const = default;
};

struct KeyValuePair {
  static constexpr std::string_view kName = "foxglove_msgs/msg/KeyValuePair";
  static constexpr std::array kFields = {"key", "value"};
  std::string key;
  std::string value;

  bool operator==(const KeyValuePair&) const = default;
};

struct ArrowPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/ArrowPrimitive";
  static constexpr std::array kFields = {"pose",        "shaft_length",  "shaft_diameter",
                                         "head_length", "head_diameter", "color"};
  Pose pose;
  double shaft_length_m{};
  double shaft_diameter_m{};
  double head_length_m{};
  double head_diameter_m{};
  Color color;

  bool operator==(const ArrowPrimitive&) const = default;
};

struct CubePrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/CubePrimitive";
  static constexpr std::array kFields = {"pose", "size", "color"};
  Pose pose;
  RosVector3 size;
  Color color;

  bool operator==(const CubePrimitive&) const = default;
};

struct SpherePrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SpherePrimitive";
  static constexpr std::array kFields = {"pose", "size", "color"};
  Pose pose;
  RosVector3 size;
  Color color;

  bool operator==(const SpherePrimitive&) const = default;
};

struct CylinderPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/CylinderPrimitive";
  static constexpr std::array kFields = {"pose", "size", "bottom_scale", "top_scale", "color"};
  Pose pose;
  RosVector3 size;
  double bottom_scale{};
  double top_scale{};
  Color color;

  bool operator==(const CylinderPrimitive&) const = default;
};

struct LinePrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/LinePrimitive";
  static constexpr std::array kFields = {"type",   "pose",  "thickness", "scale_invariant",
                                         "points", "color", "colors",    "indices"};
  static constexpr std::uint8_t kLineStrip = 0;
  static constexpr auto kConstants = std::to_array<MessageConstant>({
      {"uint8", "LINE_STRIP", kLineStrip},
      {"uint8", "LINE_LOOP", 1},
      {"uint8", "LINE_LIST", 2},
  });
  std::uint8_t type{};  ///< One of the constants.
  Pose pose;
  double thickness{};
  bool scale_invariant{};  ///< Whether the thickness is in pixels.
  std::vector<Point> points;
  Color color;
  std::vector<Color> colors;
  std::vector<std::uint32_t> indices;

  bool operator==(const LinePrimitive&) const = default;
};

struct TriangleListPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/TriangleListPrimitive";
  static constexpr std::array kFields = {"pose", "points", "color", "colors", "indices"};
  Pose pose;
  std::vector<Point> points;
  Color color;
  std::vector<Color> colors;
  std::vector<std::uint32_t> indices;

  bool operator==(const TriangleListPrimitive&) const = default;
};

struct TextPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/TextPrimitive";
  static constexpr std::array kFields = {"pose",  "billboard", "font_size", "scale_invariant",
                                         "color", "text"};
  Pose pose;
  bool billboard{};  ///< Whether the text always faces the viewer.
  double font_size{};
  bool scale_invariant{};  ///< Whether the size is in pixels.
  Color color;
  std::string text;

  bool operator==(const TextPrimitive&) const = default;
};

struct ModelPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/ModelPrimitive";
  static constexpr std::array kFields = {"pose", "scale",      "color", "override_color",
                                         "url",  "media_type", "data"};
  Pose pose;
  RosVector3 scale;
  Color color;
  bool override_color{};
  std::string url;
  std::string media_type;
  std::vector<std::uint8_t> data;

  bool operator==(const ModelPrimitive&) const = default;
};

/// Something that a view shows until another entity of the same id replaces it.
struct SceneEntity {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SceneEntity";
  static constexpr std::array kFields = {
      "timestamp", "frame_id", "id",        "lifetime", "frame_locked", "metadata", "arrows",
      "cubes",     "spheres",  "cylinders", "lines",    "triangles",    "texts",    "models"};
  Time timestamp;
  std::string frame_id;
  std::string id;
  Duration lifetime;  ///< 0 = until replaced or deleted.
  bool frame_locked{};
  std::vector<KeyValuePair> metadata;
  std::vector<ArrowPrimitive> arrows;
  std::vector<CubePrimitive> cubes;
  std::vector<SpherePrimitive> spheres;
  std::vector<CylinderPrimitive> cylinders;
  std::vector<LinePrimitive> lines;
  std::vector<TriangleListPrimitive> triangles;
  std::vector<TextPrimitive> texts;
  std::vector<ModelPrimitive> models;

  bool operator==(const SceneEntity&) const = default;
};

struct SceneEntityDeletion {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SceneEntityDeletion";
  static constexpr std::array kFields = {"timestamp", "type", "id"};
  static constexpr std::uint8_t kMatchingId = 0;
  static constexpr std::uint8_t kAll = 1;
  static constexpr auto kConstants = std::to_array<MessageConstant>({
      {"uint8", "MATCHING_ID", kMatchingId},
      {"uint8", "ALL", kAll},
  });
  Time timestamp;
  std::uint8_t type{};  ///< One of the constants.
  std::string id;

  bool operator==(const SceneEntityDeletion&) const = default;
};

struct SceneUpdate {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SceneUpdate";
  static constexpr std::array kFields = {"deletions", "entities"};
  std::vector<SceneEntityDeletion> deletions;
  std::vector<SceneEntity> entities;

  bool operator==(const SceneUpdate&) const = default;
};

}  // namespace railcast::ros
