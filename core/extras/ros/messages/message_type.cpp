#include "core/extras/ros/messages/message_type.h"

#include <openssl/sha.h>

#include <algorithm>
#include <array>

#include "core/base/join.h"
#include "core/base/text.h"

namespace railcast::ros {
namespace {

// REP-2016's FieldType.msg numbers the types of arrays and sequences by adding to those of single
// values.
constexpr int kFirstArrayId = 48;
constexpr int kFirstSequenceId = 144;

int TypeIdOf(const FieldDescription& field) {
  if (field.is_sequence) return field.type.id + kFirstSequenceId;
  return field.type.id + (field.array_size > 0 ? kFirstArrayId : 0);
}

bool IsMessage(const FieldDescription& field) {
  return field.type.id == 1;
}

// "std_msgs/Header", as `.msg` files write "std_msgs/msg/Header".
std::string NameInDefinition(std::string_view name) {
  std::string text(name);
  const std::size_t middle = text.find("/msg/");
  return middle == std::string::npos ? text : text.erase(middle, 4);
}

std::string DefinitionLine(const FieldDescription& field) {
  std::string line = NameInDefinition(field.type.name) + std::string(field.type.bound);
  if (field.is_sequence) line += "[]";
  if (field.array_size > 0) line += "[" + NumberText(field.array_size) + "]";
  line += " " + std::string(field.name);
  if (!field.default_value.empty()) line += " " + std::string(field.default_value);
  return line + "\n";
}

std::string OwnDefinition(const MessageDescription& message) {
  std::string text;
  for (const MessageConstant& constant : message.constants) {
    text += std::string(constant.type) + " " + std::string(constant.name) + "=" +
            NumberText(constant.value) + "\n";
  }
  for (const FieldDescription& field : message.fields) text += DefinitionLine(field);
  return text;
}

std::string DefinitionOf(const std::vector<MessageDescription>& descriptions) {
  std::string text = OwnDefinition(descriptions.front());
  for (std::size_t i = 1; i < descriptions.size(); ++i) {
    text.append(80, '=').append("\nMSG: ").append(NameInDefinition(descriptions[i].name));
    text.append("\n").append(OwnDefinition(descriptions[i]));
  }
  return text;
}

std::string InQuotes(std::string_view text) {
  return '"' + std::string(text) + '"';
}

// REP-2016 hashes this very text, with a blank after every comma and colon.
std::string HashedText(const MessageDescription& message) {
  std::string text = "{\"type_name\": " + InQuotes(message.name) + ", \"fields\": [";
  for (const FieldDescription& field : message.fields) {
    if (!text.ends_with('[')) text += ", ";
    text += "{\"name\": " + InQuotes(field.name) +
            ", \"type\": {\"type_id\": " + NumberText(TypeIdOf(field)) +
            ", \"capacity\": " + NumberText(field.array_size) +
            ", \"string_capacity\": " + NumberText(field.type.string_capacity) +
            ", \"nested_type_name\": " + InQuotes(IsMessage(field) ? field.type.name : "") + "}}";
  }
  return text + "]}";
}

std::string Sha256(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  std::string hexadecimal;
  for (const unsigned char byte : digest) {
    hexadecimal += kDigits[byte >> 4U];
    hexadecimal += kDigits[byte & 15U];
  }
  return hexadecimal;
}

std::string HashOf(const std::vector<MessageDescription>& descriptions) {
  std::vector<MessageDescription> contained(descriptions.begin() + 1, descriptions.end());
  std::ranges::sort(contained, {}, &MessageDescription::name);
  return "RIHS01_" +
         Sha256("{\"type_description\": " + HashedText(descriptions.front()) +
                ", \"referenced_type_descriptions\": [" + Join(contained, ", ", HashedText) + "]}");
}

}  // namespace

std::string DdsName(std::string_view name) {
  std::string text;
  for (const char letter : name.substr(0, name.rfind('/'))) {
    text += letter == '/' ? std::string("::") : std::string(1, letter);
  }
  return text + "::dds_::" + std::string(name.substr(name.rfind('/') + 1)) + "_";
}

MessageType MakeMessageType(const std::vector<MessageDescription>& descriptions) {
  const std::string_view name = descriptions.front().name;
  return {std::string(name), DefinitionOf(descriptions), HashOf(descriptions), DdsName(name)};
}

}  // namespace railcast::ros
