#include "core/scenario/json_reader.h"

#include <set>

namespace railcast {

JsonReader::JsonReader(JsonSource& source, Node object, MemberList list)
    : source_(source), object_(std::move(object)), list_(std::move(list)) {}

void JsonReader::OneOfTwo(std::string_view key, std::string_view other) {
  const auto layer_of = [&](std::string_view which) {
    const auto it = std::find_if(list_.members.begin(), list_.members.end(),
                                 [&](const Member& member) { return member.key == which; });
    return it == list_.members.end() ? std::nullopt : std::optional(it->layer);
  };
  const auto layer = layer_of(key);
  const auto other_layer = layer_of(other);
  if (!layer || !other_layer || *layer == *other_layer) return;
  const std::string_view beneath = *layer > *other_layer ? key : other;
  std::erase_if(list_.members, [&](const Member& member) { return member.key == beneath; });
}

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

void JsonReader::Switches(std::string_view key,
                          std::map<std::string, bool>& switches,
                          const char* doc,
                          const std::vector<std::string>& names) {
  keys_.emplace_back(key);
  const Node* node = Find(key);
  if (node == nullptr) return;
  auto list = source_.Members(*node);
  if (!list) return;
  JsonReader reader(source_, *node, std::move(*list));
  for (const std::string& name : names) {
    if (reader.Find(name) != nullptr) reader.Optional(name, switches[name], doc);
  }
  reader.keys_ = names;
  reader.Finish();
}

void JsonReader::Ensure(const std::vector<std::string>& keys, bool holds, const std::string& rule) {
  if (!holds) broken_rules_.push_back({keys, rule});
}

void JsonReader::Finish() {
  std::vector<const Member*> strangers;
  std::set<std::string> meant;
  for (const Member& member : list_.members) {
    if (std::find(keys_.begin(), keys_.end(), member.key) != keys_.end()) continue;
    strangers.push_back(&member);
    if (const auto nearest = Nearest(member.key, keys_)) meant.insert(*nearest);
  }
  // Do not report a required key as missing if one of the unknown keys is a misspelling of it.
  for (const std::string& key : missing_) {
    if (!meant.contains(key)) source_.Missing(object_, key);
  }
  for (const Member* stranger : strangers) {
    source_.FaultWithoutValue(stranger->value, Unknown("key", stranger->key, keys_));
  }
  const bool is_complete = list_.is_complete && strangers.empty();
  // An unknown key or a file that could not be read may have meant any of the absent keys, whose
  // values are therefore unknown.
  for (const std::string& key : keys_) {
    if (is_complete || Find(key) != nullptr) continue;
    source_.unknown().Add(object_.resolved_pointer + PointerStep(key));
  }
  for (const auto& [keys, rule] : broken_rules_) {
    const auto is_known = [&](const std::string& key) { return IsKnown(key); };
    if (!std::all_of(keys.begin(), keys.end(), is_known)) continue;
    if (keys.front().empty()) {
      source_.FaultWithoutValue(object_, rule);
    } else if (const Node* node = Find(keys.front())) {
      source_.Fault(*node, rule);
    } else {
      Node absent = object_;
      absent.pointer += PointerStep(keys.front());
      absent.resolved_pointer += PointerStep(keys.front());
      source_.FaultWithoutValue(absent, rule);
    }
  }
}

bool JsonReader::IsKnown(std::string_view key) const {
  return source_.unknown().IsKnown(object_.resolved_pointer + PointerStep(key));
}

const Node* JsonReader::Find(std::string_view key) const {
  const auto it = std::find_if(list_.members.begin(), list_.members.end(),
                               [&](const Member& member) { return member.key == key; });
  return it == list_.members.end() ? nullptr : &it->value;
}

}  // namespace railcast
