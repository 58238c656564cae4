#include "core/scenario/json_reader.h"

namespace railcast {

JsonReader::JsonReader(JsonSource& source, Node object, std::vector<Member> members)
    : source_(source),
      object_(std::move(object)),
      members_(std::move(members)),
      num_faults_before_(source.errors().lines().size()) {}

void JsonReader::Alternative(std::string_view key,
                             double& value,
                             const Multiple& multiple,
                             const char* doc,
                             const Limits& limits) {
  double given = 0.0;
  Optional(key, given, doc, limits);
  const Node* node = Find(key);
  if (node == nullptr) return;
  if (Find(multiple.of_key) != nullptr) {
    source_.Fault(*node, "must not be given together with \"" + std::string(multiple.of_key) + '"');
  }
  value = multiple.factor * given;
}

void JsonReader::Opaque(std::string_view key, std::optional<std::string>& text, const char*) {
  keys_.emplace_back(key);
  const Node* node = Find(key);
  if (node == nullptr) return;
  const auto root = node->json->is_string() ? source_.FileRoot(*node) : *node;
  if (!root) return;
  if (!root->json->is_object()) return source_.Fault(*root, "must be an object");
  text = root->json->dump();
}

void JsonReader::Switches(std::string_view key,
                          std::map<std::string, bool>& switches,
                          const char* doc,
                          const std::vector<std::string>& names) {
  keys_.emplace_back(key);
  const Node* node = Find(key);
  if (node == nullptr) return;
  auto members = source_.Members(*node);
  if (!members) return;
  JsonReader reader(source_, *node, std::move(*members));
  for (const std::string& name : names) {
    if (reader.Find(name) != nullptr) reader.Optional(name, switches[name], doc);
  }
  reader.keys_ = names;
  reader.Finish();
}

void JsonReader::Ensure(std::string_view key, bool holds, const std::string& rule) {
  if (holds || has_faults()) return;
  if (key.empty()) return source_.FaultWithoutValue(object_, rule);
  if (const Node* node = Find(key)) return source_.Fault(*node, rule);
  Node absent = object_;
  absent.pointer += PointerStep(key);
  source_.FaultWithoutValue(absent, rule);
}

void JsonReader::Finish() {
  for (const Member& member : members_) {
    if (std::find(keys_.begin(), keys_.end(), member.key) != keys_.end()) continue;
    source_.FaultWithoutValue(member.value, Unknown("key", member.key, keys_));
  }
}

const Node* JsonReader::Find(std::string_view key) const {
  const auto it = std::find_if(members_.begin(), members_.end(),
                               [&](const Member& member) { return member.key == key; });
  return it == members_.end() ? nullptr : &it->value;
}

}  // namespace railcast
