#include "core/scenario/json_reader.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/inputs.h"
#include "core/scenario/descriptions.h"

namespace railcast {
namespace {

/// Reads an element of a list. Elements are written in place; only few types may be given as a
/// file.
void ReadElement(JsonSource& source, const Node& node, const ValueRef& value, bool may_be_file) {
  if (value.type->kind != ValueType::Kind::kStruct || may_be_file) {
    return ReadValue(source, node, value, Anything{});
  }
  if (auto list = source.PlainMembers(node)) {
    ReadMembers(source, node, std::move(*list), value);
  }
}

// Reads the elements of `list`, each by the rule.
void ReadTexts(JsonSource& source, const Node& node, const ValueRef& list, const RuleRef& rule) {
  if (!CheckListOfAtLeast(source, node, {})) return;
  list.type->renew(list.place, node.json->size());
  for (std::size_t i = 0; i < node.json->size(); ++i) {
    ReadValue(source, node.Child(i), {list.type->at(list.place, i), list.type->of()}, rule);
  }
}

void ReadElements(JsonSource& source,
                  const Node& node,
                  const ValueRef& list,
                  const AtLeastElements& rule) {
  if (!CheckListOfAtLeast(source, node, rule)) return;
  list.type->renew(list.place, node.json->size());
  for (std::size_t i = 0; i < node.json->size(); ++i) {
    ReadElement(source, node.Child(i), {list.type->at(list.place, i), list.type->of()},
                list.type->element_may_be_file);
  }
}

void ReadList(JsonSource& source, const Node& node, const ValueRef& list, const RuleRef& rule) {
  if (const auto* const at_least = rule.As<AtLeastElements>()) {
    return ReadElements(source, node, list, *at_least);
  }
  if (const auto* const needed = rule.As<NonEmptyListIf>()) {
    return ReadElements(source, node, list, {needed->applies ? 1U : 0U, needed->instead});
  }
  if (const auto* const each = rule.As<EachNumber>()) {
    ReadElements(source, node, list, {.count = each->at_least});
    if (node.json->is_array() && !CheckEachNumber(source, node, *each)) {
      list.type->renew(list.place, 0);
    }
    return;
  }
  if (list.type->of()->kind == ValueType::Kind::kText) return ReadTexts(source, node, list, rule);
  ReadElements(source, node, list, {.count = 0});
}

void ReadArray(JsonSource& source, const Node& node, const ValueRef& array, const RuleRef& rule) {
  const std::size_t size = array.type->size(array.place);
  if (!CheckListOf(source, node, size)) return;
  for (std::size_t i = 0; i < size; ++i) {
    ReadValue(source, node.Child(i), {array.type->at(array.place, i), array.type->of()}, rule);
  }
}

void ReadMap(JsonSource& source, const Node& node, const ValueRef& map, const RuleRef& rule) {
  const auto list = source.PlainMembers(node);
  if (!list) return;
  for (const Member& member : list->members) {
    ReadValue(source, member.value, {map.type->member(map.place, member.key), map.type->of()},
              rule);
  }
}

/// Reads one of several structs, which "type" distinguishes. It is written in place, because a type
/// may have a key "file" of its own.
void ReadVariant(JsonSource& source, const Node& node, const ValueRef& variant) {
  const auto list = source.PlainMembers(node);
  if (!list) return;
  if (!node.json->contains("type")) return source.Missing(node, "type");
  const auto alternatives = variant.type->alternatives();
  std::vector<std::string> names;
  for (const auto& alternative : alternatives) names.emplace_back(alternative.name);
  std::string type;
  ReadText(source, node.Child("type"), type, OneOf(names));
  const auto found = std::ranges::find(names, type);
  if (found == names.end()) return;
  const auto index = static_cast<std::size_t>(found - names.begin());
  variant.type->renew(variant.place, index);
  JsonReader reader(source, node, *list);
  reader.Required("type", type, "Which of the alternatives it is.");
  alternatives[index].type->describe(reader, variant.type->at(variant.place, index));
  reader.Finish();
}

}  // namespace

void ReadMembers(JsonSource& source, const Node& object, MemberList list, const ValueRef& value) {
  JsonReader reader(source, object, std::move(list));
  value.type->describe(reader, value.place);
  reader.Finish();
}

void ReadValue(JsonSource& source, const Node& node, const ValueRef& value, const RuleRef& rule) {
  using Kind = ValueType::Kind;
  const ValueType& type = *value.type;
  switch (type.kind) {
    case Kind::kBool:
      return ReadBool(source, node, *static_cast<bool*>(value.place));
    case Kind::kNumber:
      return ReadNumber(source, node, *static_cast<double*>(value.place), rule);
    case Kind::kWhole:
      return ReadWhole(source, node, value, rule);
    case Kind::kSigned:
      return ReadSigned(source, node, *static_cast<std::int64_t*>(value.place));
    case Kind::kText:
      return ReadText(source, node, *static_cast<std::string*>(value.place), rule);
    case Kind::kName:
      return ReadName(source, node, value);
    case Kind::kObjectType:
      return ReadObjectType(source, node, *static_cast<ObjectType*>(value.place));
    case Kind::kOptional:
      type.renew(value.place, 1);
      return ReadValue(source, node, {type.at(value.place, 0), type.of()}, rule);
    case Kind::kArray:
      return ReadArray(source, node, value, rule);
    case Kind::kList:
      return ReadList(source, node, value, rule);
    case Kind::kMap:
      return ReadMap(source, node, value, rule);
    case Kind::kJson:
      *static_cast<Json*>(value.place) = *node.json;
      return;
    case Kind::kVariant:
      return ReadVariant(source, node, value);
    case Kind::kOwn:
      return type.read(source, node, value.place);
    case Kind::kStruct:
      break;
  }
  // Unless it is written in place, the object of a struct may be given as a file, or name a base
  // file with the keys that it lacks.
  auto list = type.is_written_in_place ? source.PlainMembers(node) : source.Members(node);
  if (list) ReadMembers(source, node, std::move(*list), value);
}

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

void JsonReader::Visit(const Key& key, const ValueRef& value) {
  const Node* const node = Find(key.name);
  if (node == nullptr && key.is_required && list_.is_complete) missing_.emplace_back(key.name);
  keys_.emplace_back(key.name);
  if (node == nullptr) return;
  if (key.is_nullable && node->json->is_null()) return value.type->renew(value.place, 0);
  ReadValue(source_, *node, value, key.rule);
}

void JsonReader::Preset(std::string_view key,
                        std::optional<std::string>& file,
                        KeyDoc doc,
                        const FilePreset& preset) {
  std::string name;
  Optional(key, name, doc, ExistingFile{});
  const Node* const node = Find(key);
  if (node == nullptr) return;
  file = name;
  ErrorList faults;
  if (!name.empty()) {
    static_cast<void>(Attempt("", faults, [&] {
      const InputBytes text = ReadInput(name);
      AtPlace(name + ": ", [&] { preset.use(*text); });
      return true;
    }));
  }
  for (const Fault& fault : faults.faults()) {
    source_.errors().Add(source_.sources().Locate(fault, node->resolved_pointer));
  }
  if (!name.empty() && faults.empty()) return;
  source_.unknown().Add(object_.resolved_pointer + PointerStep(preset.gives));
}

void JsonReader::VisitLibrary(const Key& key, const ValueRef& list) {
  const Node* node = Find(key.name);
  if (node == nullptr || !node->json->is_string()) return Visit(key, list);
  keys_.emplace_back(key.name);
  // In the file the list has the same key as in this object.
  const auto root = source_.FileRoot(*node, object_.resolved_pointer);
  if (!root || !source_.CheckRoot(*root)) return;
  JsonReader reader(source_, *root, source_.PlainMembers(*root).value());
  reader.Visit(key, list);
  reader.Finish();
  source_.sources().Add(node->resolved_pointer, root->file->shown, PointerStep(key.name));
}

void JsonReader::Types(std::string_view key, std::vector<ModelSpec>& models, KeyDoc doc) {
  const Node* node = Find(key);
  if (node == nullptr) {
    keys_.emplace_back(key);
    return;
  }
  const std::string list = node->resolved_pointer;
  RequiredLibrary(key, models, doc);
  Unique(key, models, "name", &ModelSpec::name);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const std::string place = list + "/" + std::to_string(i);
    if (!source_.unknown().IsKnown(place)) continue;  // Nor are objects that are one.
    if (!source_.types().Find(models[i].name)) {
      source_.types().Add(models[i], i);
      continue;
    }
    source_.errors().Add({source_.sources().Place(place + "/name"),
                          "must not be the name of a type that railcast has",
                          ValueText(models[i].name)});
    source_.unknown().Add(place + "/name");
  }
}

void JsonReader::CheckUnique(std::string_view key,
                             std::string_view of,
                             const std::vector<UniqueValue>& members) {
  const std::string list = object_.resolved_pointer + PointerStep(key) + "/";
  const auto place = [&](std::size_t i) { return list + std::to_string(i) + PointerStep(of); };
  std::set<UniqueValue> seen;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!source_.unknown().IsKnown(place(i))) continue;
    if (seen.insert(members[i]).second) continue;
    const Json value = std::visit([](const auto& member) { return Json(member); }, members[i]);
    source_.errors().Add({source_.sources().Place(place(i)), "must be unique", ValueText(value)});
    source_.unknown().Add(place(i));
  }
}

void JsonReader::Alternative(std::string_view key,
                             double& value,
                             const Multiple& multiple,
                             KeyDoc doc,
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
                          KeyDoc doc,
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

void JsonReader::Ensure(std::initializer_list<std::string_view> keys,
                        bool holds,
                        std::string_view rule) {
  if (!holds) broken_rules_.push_back({{keys.begin(), keys.end()}, std::string(rule)});
}

void JsonReader::Finish() {
  std::vector<const Member*> strangers;
  std::set<std::string> meant;
  for (const Member& member : list_.members) {
    if (std::find(keys_.begin(), keys_.end(), member.key) != keys_.end()) continue;
    strangers.push_back(&member);
    if (missing_.empty()) continue;
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
