#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"

// Messages of Foxglove's package foxglove_msgs that describe what a 3D view shows beside clouds.
// VisitFields() as in geometry_messages.h. Lengths in metres.

namespace railcast::ros {

struct Color {
  static constexpr std::string_view kName = "foxglove_msgs/msg/Color";
  double r{}, g{}, b{}, a{};  ///< 0 to 1

  static void VisitFields(auto& self, auto&& visit) {
    visit("r", self.r);
    visit("g", self.g);
    visit("b", self.b);
    visit("a", self.a);
  }
  bool operator==(const Color&) const = default;
};

struct KeyValuePair {
  static constexpr std::string_view kName = "foxglove_msgs/msg/KeyValuePair";
  std::string key;
  std::string value;

  static void VisitFields(auto& self, auto&& visit) {
    visit("key", self.key);
    visit("value", self.value);
  }
  bool operator==(const KeyValuePair&) const = default;
};

struct ArrowPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/ArrowPrimitive";
  Pose pose;
  double shaft_length_m{};
  double shaft_diameter_m{};
  double head_length_m{};
  double head_diameter_m{};
  Color color;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("shaft_length", self.shaft_length_m);
    visit("shaft_diameter", self.shaft_diameter_m);
    visit("head_length", self.head_length_m);
    visit("head_diameter", self.head_diameter_m);
    visit("color", self.color);
  }
  bool operator==(const ArrowPrimitive&) const = default;
};

struct CubePrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/CubePrimitive";
  Pose pose;
  RosVector3 size;
  Color color;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("size", self.size);
    visit("color", self.color);
  }
  bool operator==(const CubePrimitive&) const = default;
};

struct SpherePrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SpherePrimitive";
  Pose pose;
  RosVector3 size;
  Color color;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("size", self.size);
    visit("color", self.color);
  }
  bool operator==(const SpherePrimitive&) const = default;
};

struct CylinderPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/CylinderPrimitive";
  Pose pose;
  RosVector3 size;
  double bottom_scale{};
  double top_scale{};
  Color color;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("size", self.size);
    visit("bottom_scale", self.bottom_scale);
    visit("top_scale", self.top_scale);
    visit("color", self.color);
  }
  bool operator==(const CylinderPrimitive&) const = default;
};

struct LinePrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/LinePrimitive";
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

  static void VisitFields(auto& self, auto&& visit) {
    visit("type", self.type);
    visit("pose", self.pose);
    visit("thickness", self.thickness);
    visit("scale_invariant", self.scale_invariant);
    visit("points", self.points);
    visit("color", self.color);
    visit("colors", self.colors);
    visit("indices", self.indices);
  }
  bool operator==(const LinePrimitive&) const = default;
};

struct TriangleListPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/TriangleListPrimitive";
  Pose pose;
  std::vector<Point> points;
  Color color;
  std::vector<Color> colors;
  std::vector<std::uint32_t> indices;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("points", self.points);
    visit("color", self.color);
    visit("colors", self.colors);
    visit("indices", self.indices);
  }
  bool operator==(const TriangleListPrimitive&) const = default;
};

struct TextPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/TextPrimitive";
  Pose pose;
  bool billboard{};  ///< Whether the text always faces the viewer.
  double font_size{};
  bool scale_invariant{};  ///< Whether the size is in pixels.
  Color color;
  std::string text;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("billboard", self.billboard);
    visit("font_size", self.font_size);
    visit("scale_invariant", self.scale_invariant);
    visit("color", self.color);
    visit("text", self.text);
  }
  bool operator==(const TextPrimitive&) const = default;
};

struct ModelPrimitive {
  static constexpr std::string_view kName = "foxglove_msgs/msg/ModelPrimitive";
  Pose pose;
  RosVector3 scale;
  Color color;
  bool override_color{};
  std::string url;
  std::string media_type;
  std::vector<std::uint8_t> data;

  static void VisitFields(auto& self, auto&& visit) {
    visit("pose", self.pose);
    visit("scale", self.scale);
    visit("color", self.color);
    visit("override_color", self.override_color);
    visit("url", self.url);
    visit("media_type", self.media_type);
    visit("data", self.data);
  }
  bool operator==(const ModelPrimitive&) const = default;
};

/// Something that a view shows until another entity of the same id replaces it.
struct SceneEntity {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SceneEntity";
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

  static void VisitFields(auto& self, auto&& visit) {
    visit("timestamp", self.timestamp);
    visit("frame_id", self.frame_id);
    visit("id", self.id);
    visit("lifetime", self.lifetime);
    visit("frame_locked", self.frame_locked);
    visit("metadata", self.metadata);
    visit("arrows", self.arrows);
    visit("cubes", self.cubes);
    visit("spheres", self.spheres);
    visit("cylinders", self.cylinders);
    visit("lines", self.lines);
    visit("triangles", self.triangles);
    visit("texts", self.texts);
    visit("models", self.models);
  }
  bool operator==(const SceneEntity&) const = default;
};

struct SceneEntityDeletion {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SceneEntityDeletion";
  static constexpr std::uint8_t kMatchingId = 0;
  static constexpr std::uint8_t kAll = 1;
  static constexpr auto kConstants = std::to_array<MessageConstant>({
      {"uint8", "MATCHING_ID", kMatchingId},
      {"uint8", "ALL", kAll},
  });
  Time timestamp;
  std::uint8_t type{};  ///< One of the constants.
  std::string id;

  static void VisitFields(auto& self, auto&& visit) {
    visit("timestamp", self.timestamp);
    visit("type", self.type);
    visit("id", self.id);
  }
  bool operator==(const SceneEntityDeletion&) const = default;
};

struct SceneUpdate {
  static constexpr std::string_view kName = "foxglove_msgs/msg/SceneUpdate";
  std::vector<SceneEntityDeletion> deletions;
  std::vector<SceneEntity> entities;

  static void VisitFields(auto& self, auto&& visit) {
    visit("deletions", self.deletions);
    visit("entities", self.entities);
  }
  bool operator==(const SceneUpdate&) const = default;
};

}  // namespace railcast::ros
