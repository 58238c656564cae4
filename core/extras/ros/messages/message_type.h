#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/extras/ros/messages/named_fields.h"

namespace railcast::ros {

/// What a middleware, a bag and their readers have to know of a type of messages.
struct MessageType {
  std::string name;  ///< "sensor_msgs/msg/PointCloud2"
  /// The `ros2msg` text: its own fields, then each type that it contains after a line of 80 '='
  /// and "MSG: std_msgs/Header".
  std::string definition;
  std::string hash;      ///< REP-2016's hash of the description: "RIHS01_" and 64 hex digits.
  std::string dds_name;  ///< "sensor_msgs::msg::dds_::PointCloud2_"
};

/// Returns the name that DDS has for a type: "sensor_msgs::msg::dds_::Image_" for
/// "sensor_msgs/msg/Image".
[[nodiscard]] std::string DdsName(std::string_view name);

/// A constant of a message's definition.
struct MessageConstant {
  std::string_view type;
  std::string_view name;
  int value{};
};

/// A string whose length a message limits.
template <std::size_t kMaxLength>
struct BoundedString {
  std::string text;

  bool operator==(const BoundedString&) const = default;
};

/// The type of a field as `.msg` files and type hashes (REP-2016, FieldType.msg) name it.
struct FieldTypeText {
  std::string_view name;  ///< "float64", or that of a message: "std_msgs/msg/Header".
  int id{};               ///< Id of a single value; 1 = a message.
  std::size_t string_capacity{};
  std::string_view bound{};  ///< Follows the name of a bounded string: "<=256".
};

/// A field of a message as its type tells it.
struct FieldDescription {
  std::string_view name;
  FieldTypeText type;
  bool is_sequence{};
  std::size_t array_size{};        ///< 0 = no array.
  std::string_view default_value;  ///< Empty = none. Readers of CDR do not see it.
};

struct MessageDescription {
  std::string_view name;
  std::vector<MessageConstant> constants;
  std::vector<FieldDescription> fields;
};

/// Makes the texts of a type from its description, the first, and those of the types it contains.
[[nodiscard]] MessageType MakeMessageType(const std::vector<MessageDescription>& descriptions);

namespace message_type {

template <typename T>
struct Element {
  using Type = T;
  static constexpr bool kIsSequence = false;
  static constexpr std::size_t kArraySize = 0;
};
template <typename T>
struct Element<std::vector<T>> {
  using Type = T;
  static constexpr bool kIsSequence = true;
  static constexpr std::size_t kArraySize = 0;
};
template <typename T, std::size_t kSize>
struct Element<std::array<T, kSize>> {
  using Type = T;
  static constexpr bool kIsSequence = false;
  static constexpr std::size_t kArraySize = kSize;
};

template <typename T>
inline constexpr FieldTypeText kTypeText = {T::kName, 1};
template <>
inline constexpr FieldTypeText kTypeText<std::int8_t> = {"int8", 2};
template <>
inline constexpr FieldTypeText kTypeText<std::uint8_t> = {"uint8", 3};
template <>
inline constexpr FieldTypeText kTypeText<std::uint16_t> = {"uint16", 5};
template <>
inline constexpr FieldTypeText kTypeText<std::int32_t> = {"int32", 6};
template <>
inline constexpr FieldTypeText kTypeText<std::uint32_t> = {"uint32", 7};
template <>
inline constexpr FieldTypeText kTypeText<std::uint64_t> = {"uint64", 9};
template <>
inline constexpr FieldTypeText kTypeText<float> = {"float32", 10};
template <>
inline constexpr FieldTypeText kTypeText<double> = {"float64", 11};
template <>
inline constexpr FieldTypeText kTypeText<bool> = {"bool", 15};
template <>
inline constexpr FieldTypeText kTypeText<std::string> = {"string", 17};
template <>
inline constexpr FieldTypeText kTypeText<BoundedString<256>> = {"string", 21, 256, "<=256"};

template <typename Message>
void Describe(std::vector<MessageDescription>& descriptions);

/// Describes the type of a field, too, if it is a message that has not been described yet.
template <typename T>
void DescribeContained(std::vector<MessageDescription>& descriptions) {
  if constexpr (requires { T::kName; }) {
    for (const MessageDescription& known : descriptions) {
      if (known.name == T::kName) return;
    }
    Describe<T>(descriptions);
  }
}

template <typename Message>
void Describe(std::vector<MessageDescription>& descriptions) {
  MessageDescription own{Message::kName, {}, {}};
  if constexpr (requires { Message::kConstants; }) {
    own.constants.assign(Message::kConstants.begin(), Message::kConstants.end());
  }
  Message message;
  VisitFields(message, [&own](std::string_view name, auto& field) {
    using Values = Element<std::remove_cvref_t<decltype(field)>>;
    std::string_view default_value;
    if constexpr (requires { Message::kDefaults; }) {
      default_value = Message::kDefaults[own.fields.size()];
    }
    own.fields.push_back({name, kTypeText<typename Values::Type>, Values::kIsSequence,
                          Values::kArraySize, default_value});
  });
  descriptions.push_back(std::move(own));
  VisitFields(message, [&descriptions](std::string_view, auto& field) {
    using Values = Element<std::remove_cvref_t<decltype(field)>>;
    DescribeContained<typename Values::Type>(descriptions);
  });
}

}  // namespace message_type

/// What is to be known of a type of messages, all of it from the type's `kName`, `kConstants`,
/// `kFields` and `kDefaults`.
template <typename Message>
[[nodiscard]] const MessageType& TypeOf() {
  static const MessageType type = [] {
    std::vector<MessageDescription> descriptions;
    message_type::Describe<Message>(descriptions);
    return MakeMessageType(descriptions);
  }();
  return type;
}

}  // namespace railcast::ros
